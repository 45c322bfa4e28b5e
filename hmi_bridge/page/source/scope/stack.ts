// The lanes above one another with one time below them, the cursors and the marker across.
import { say } from '../texts';
import { element, mark, write } from '../view';
import { colour_of, dash_of, is_dark } from './colours';
import { time_text } from './cursors';
import { Hands } from './hands';
import { band_height, LaneChart, Look, right_room, scale_width } from './lane_chart';
import { Lane, lanes_of, Range } from './lanes';
import { Channel, key_of } from './signals';
import { Scene, Session } from './session';
import { time_ticks } from './time_ticks';

export const gutter_width = 176;
const left_room = gutter_width + scale_width;
const lane_least = 58;
const time_height = 26;

interface Row {
    root: HTMLElement;
    chart: LaneChart;
    host: HTMLElement;
}

export function look(): Look {
    const style = getComputedStyle(document.documentElement), of = (name: string): string => style.getPropertyValue(name).trim();
    return { dark: is_dark(), text: of('--text'), quiet: of('--quiet'), grid: of('--line') + (is_dark() ? '' : '99'), ground: of('--panel'), gap: of('--warn'), font: '12px system-ui, sans-serif' };
}

/** A piece of the curve's line, as in a legend. */
export function sample_of(channel: Channel): HTMLCanvasElement {
    const canvas = element('canvas', { class: 'scope-sample', width: '52', height: '12', 'aria-hidden': 'true' });
    const ctx = canvas.getContext('2d');
    if (ctx) {
        ctx.strokeStyle = colour_of(channel.colour, is_dark());
        ctx.lineWidth = 4;
        ctx.setLineDash(dash_of(channel.colour).map((d) => d * 2));
        ctx.beginPath();
        ctx.moveTo(0, 6);
        ctx.lineTo(52, 6);
        ctx.stroke();
    }
    return canvas;
}

export class Stack {
    readonly root = element('div', { class: 'scope-stack' });
    readonly hands: Hands;
    private readonly lanes_ = element('div', { class: 'scope-lanes' });
    private readonly marker_ = element('div', { class: 'scope-marker', hidden: true }, element('span'));
    private readonly pointed_ = element('div', { class: 'scope-pointed', hidden: true }, element('span'));
    private readonly scroll_ = element('div', { class: 'scope-scroll-lanes' });
    private readonly time_ = element('div', { class: 'scope-time' });
    private time_chart_: LaneChart | undefined;
    private rows_: Row[] = [];
    private made_of_ = '';
    private drawn_ = '';
    private scene_: Scene | undefined;

    constructor(private readonly session_: Session, private readonly changed_: () => void, private readonly chosen_: (key: string) => void) {
        this.hands = new Hands(session_, () => this.width, () => {
            this.changed_();
            this.draw();
        });
        this.hands.surface.append(this.marker_, this.pointed_);
        this.scroll_.append(this.lanes_, this.hands.surface);
        this.root.append(this.scroll_, this.time_);
        this.listen();
        new ResizeObserver(() => this.draw(true)).observe(this.root);
    }

    // --- lanes -----------------------------------------------------------------------------------------------------------------
    private make(lanes: Lane[]): void {
        const old = new Map(this.rows_.map((row) => [row.chart.lane.key, row.chart]));
        const style = look(), scene = this.session_.scene;
        const rows = lanes.map((lane) => {
            const host = element('div', { class: 'scope-host' });
            const chart = new LaneChart(lane, style, false, host);
            const names = lane.channels.map((channel) => {
                const key = key_of(channel), signal = scene?.signals.get(channel.name), number = this.session_.setup.channels.indexOf(channel) + 1;
                return element('button', { type: 'button', class: 'scope-name', 'data-channel': key, title: `${key} ${signal?.unit ?? ''}`, onclick: () => this.chosen_(key),
                    onpointerenter: () => chart.point_at(key), onpointerleave: () => chart.point_at(undefined), onfocus: () => chart.point_at(key), onblur: () => chart.point_at(undefined) },
                    sample_of(channel), element('b', {}, String(number)), element('span', {}, key));
            });
            names.forEach((name, k) => {
                mark(name, 'data-off', lane.channels[k]?.hidden ?? false);
                if (!scene?.signals.has(lane.channels[k]?.name ?? '')) mark(name, 'data-unknown', true);
            });
            const gutter = element('div', { class: lane.digital ? 'scope-gutter bands' : 'scope-gutter' }, ...(lane.digital ? [] : [element('div', { class: 'scope-unit' }, lane.unit ? `[${lane.unit}]` : ' ')]), ...names);
            if (lane.digital) for (const name of names) name.style.height = `${band_height}px`;
            const before = old.get(lane.key);
            if (before) chart.range = before.range;
            return { root: element('div', { class: 'scope-lane', 'data-lane': lane.key }, gutter, host), chart, host };
        });
        for (const row of this.rows_) row.chart.destroy();
        this.rows_ = rows;
        this.lanes_.replaceChildren(...rows.map((row) => row.root));
        // The time stays in sight when there are more lanes than room.
        this.time_chart_?.destroy();
        this.time_chart_ = new LaneChart({ key: 'time', unit: '', digital: true, channels: [] }, style, true, this.time_);
    }
    private size(): void {
        const width = this.scroll_.clientWidth - gutter_width, height = this.root.clientHeight - time_height - 1;
        const own = this.rows_.reduce((sum, row) => sum + (row.chart.own_height ?? 0), 0);
        const shared = this.rows_.filter((row) => row.chart.own_height === undefined);
        const each = Math.max(lane_least, (height - own) / Math.max(1, shared.length));
        let total = 0;
        for (const row of this.rows_) {
            const tall = row.chart.own_height ?? each;
            total += tall;
            row.root.style.height = `${tall}px`;
            row.chart.set_size(Math.max(120, width), tall);
        }
        this.time_chart_?.set_size(Math.max(120, width), time_height);
        this.hands.surface.style.height = `${Math.max(height, Math.floor(total))}px`;
    }

    /** Draws what has changed; cheap where nothing has. */
    draw(force = false): void {
        const { scene, setup, cursors } = this.session_;
        const known = (name: string) => scene?.signals.get(name);
        const made_of = JSON.stringify([setup.channels, scene?.kind, scene?.title, is_dark(), setup.channels.map((c) => known(c.name)?.unit)]);
        if (made_of !== this.made_of_ || scene !== this.scene_) {
            if (scene !== this.scene_) this.hands.forget();
            this.made_of_ = made_of;
            this.scene_ = scene;
            this.make(lanes_of(setup.channels, known));
            force = true;
        }
        if (!scene || this.root.clientWidth === 0) return;
        const view = scene.view, counts = setup.channels.map((c) => scene.store.tracks.get(c.name)?.have.list.length ?? 0);
        // A pixel that does not move need not be drawn again.
        const pixel = view.span / Math.max(100, this.root.clientWidth - left_room);
        const drawn = [Math.round(view.from / pixel), Math.round(view.to / pixel), view.span, counts.join(), view.follow ? 0 : scene.store.newest > view.to ? view.to : scene.store.newest, JSON.stringify(setup.scales), scene.marker?.cycle].join();
        if (force || drawn !== this.drawn_) {
            this.drawn_ = drawn;
            this.size();
            const cycle_s = scene.cycle_ns / 1e9, zero_s = scene.marker ? scene.seconds(scene.marker.cycle) : 0;
            const { ticks, step } = time_ticks(view.from, view.to, Math.max(2, this.width / 90), (cycle) => scene.seconds(cycle), cycle_s, zero_s);
            const shot = { store: scene.store, from: view.from, to: view.to, ticks: ticks.map((tick) => ({ cycle: tick.cycle, text: this.tick_text(tick.seconds, step) })), signal: known, newest: scene.store.newest,
                number: (key: string) => setup.channels.findIndex((c) => key_of(c) === key) + 1 };
            for (const row of this.rows_) {
                row.chart.manual = setup.scales[row.chart.lane.key];
                row.chart.draw(shot);
            }
            this.time_chart_?.draw(shot);
        }
        const { pointed } = this.hands;
        this.place(this.pointed_, pointed);
        if (pointed !== undefined) write(this.pointed_.firstElementChild as Element, this.time_of(pointed));
        this.place(this.marker_, scene.marker?.cycle);
        if (scene.marker) {
            mark(this.marker_, 'data-kind', scene.marker.kind);
            write(this.marker_.firstElementChild as Element, `${scene.marker.kind === 'alarm' ? '⚠' : 'T'} ${scene.marker.kind === 'automatic' ? say('scope_automatic') : scene.marker.text}`);
        }
        for (const which of ['a', 'b'] as const) {
            const line = this.hands.lines[which];
            this.place(line, cursors.shown ? cursors[which] : undefined);
            mark(line, 'aria-valuenow', String(cursors[which]));
            mark(line, 'aria-valuetext', `${which.toUpperCase()} ${this.time_of(cursors[which])}`);
        }
    }
    private place(line: HTMLElement, cycle: number | undefined): void {
        const scene = this.session_.scene;
        const part = scene && cycle !== undefined ? (cycle - scene.view.from) / scene.view.span : -1;
        line.hidden = part < 0 || part > 1;
        mark(line, 'data-left', part > 0.75);  // its label keeps inside
        line.style.transform = `translateX(${(part * this.width).toFixed(1)}px)`;
    }
    private get width(): number {
        return this.scroll_.clientWidth - left_room - right_room;
    }
    /** From above to below, the time last. */
    get charts(): readonly LaneChart[] {
        return [...this.rows_.map((row) => row.chart), ...(this.time_chart_ ? [this.time_chart_] : [])];
    }
    time_of(cycle: number): string {
        const scene = this.session_.scene;
        if (!scene) return '';
        return time_text(scene.seconds(cycle) - (scene.marker ? scene.seconds(scene.marker.cycle) : 0), scene.cycle_ns);
    }
    private tick_text(seconds: number, step: number): string {
        const decimals = Math.max(0, Math.min(9, Math.ceil(-Math.log10(step) - 1e-9)));
        const text = seconds.toFixed(decimals);
        return (this.session_.scene?.marker && seconds > 0 ? '+' : '') + (Number(text) === 0 ? text.replace('-', '') : text.replace('-', '−')) + ' s';
    }

    private listen(): void {
        // Over the numbers of a scale the wheel zooms the values.
        this.lanes_.addEventListener('wheel', (event) => {
            const row = this.rows_.find((r) => r.root.contains(event.target as Node));
            if (!row || row.chart.lane.digital || !row.host.contains(event.target as Node)) return;
            event.preventDefault();
            const box = row.chart.plot.over.getBoundingClientRect(), { min, max } = row.chart.range;
            const about = max - ((event.clientY - box.top) / box.height) * (max - min), factor = 1.2 ** (event.deltaY / 100);
            this.set_scale(row.chart.lane.key, event.shiftKey ? { min: min + (max - min) * 0.1 * Math.sign(event.deltaY), max: max + (max - min) * 0.1 * Math.sign(event.deltaY) }
                : { min: about - (about - min) * factor, max: about + (max - about) * factor });
        }, { passive: false });
        this.lanes_.addEventListener('dblclick', (event) => {
            const row = this.rows_.find((r) => r.host.contains(event.target as Node));
            if (row) this.set_scale(row.chart.lane.key, undefined);
        });
    }
    set_scale(key: string, range: Range | undefined): void {
        if (range) this.session_.setup.scales[key] = range;
        else {
            delete this.session_.setup.scales[key];
            this.rows_.find((row) => row.chart.lane.key === key)?.chart.forget_range();
        }
        this.session_.changed();
        this.changed_();
        this.draw();
    }
    range_of(key: string): Range | undefined {
        return this.rows_.find((row) => row.chart.lane.key === key)?.chart.range;
    }
    lane_of(channel_key: string): Lane | undefined {
        return this.rows_.find((row) => row.chart.lane.channels.some((c) => key_of(c) === channel_key))?.chart.lane;
    }
}
