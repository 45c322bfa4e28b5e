// The lanes above one another with one time below them, the cursors across, and the hands: wheel, drag, fingers, keys.
import { say } from '../texts';
import { element, mark, write } from '../view';
import { colour_of, dash_of, is_dark } from './colours';
import { time_text } from './cursors';
import { band_height, LaneChart, Look, right_room, scale_width } from './lane_chart';
import { Lane, lanes_of, Range } from './lanes';
import { Channel, key_of } from './signals';
import { Scene, Session } from './session';

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
    readonly surface = element('div', { class: 'scope-surface', tabindex: '0', role: 'application', 'aria-label': say('scope_picture') });
    private readonly lanes_ = element('div', { class: 'scope-lanes' });
    private readonly select_ = element('div', { class: 'scope-select', hidden: true });
    private readonly marker_ = element('div', { class: 'scope-marker', hidden: true }, element('span'));
    private readonly lines_ = { a: this.cursor_line('a'), b: this.cursor_line('b') };
    private readonly scroll_ = element('div', { class: 'scope-scroll-lanes' });
    private readonly time_ = element('div', { class: 'scope-time' });
    private time_chart_: LaneChart | undefined;
    private rows_: Row[] = [];
    private made_of_ = '';
    private drawn_ = '';
    private scene_: Scene | undefined;
    /** A drag draws a box to zoom into, instead of moving the time. */
    box_zoom = false;
    /** Views to come back to. */
    private readonly past_: { from: number; to: number; follow: boolean }[] = [];

    constructor(private readonly session_: Session, private readonly changed_: () => void, private readonly chosen_: (key: string) => void) {
        this.surface.append(this.select_, this.marker_, this.lines_.a, this.lines_.b);
        this.scroll_.append(this.lanes_, this.surface);
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
            const chart = new LaneChart(lane, style, false, host, (s, step) => this.tick_text(s, step));
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
        this.time_chart_ = new LaneChart({ key: 'time', unit: '', digital: true, channels: [] }, style, true, this.time_, (s, step) => this.tick_text(s, step));
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
        this.surface.style.height = `${Math.max(height, Math.floor(total))}px`;
    }

    /** Draws what has changed; cheap where nothing has. */
    draw(force = false): void {
        const { scene, setup, cursors } = this.session_;
        const known = (name: string) => scene?.signals.get(name);
        const made_of = JSON.stringify([setup.channels, scene?.kind, scene?.title, is_dark(), setup.channels.map((c) => known(c.name)?.unit)]);
        if (made_of !== this.made_of_ || scene !== this.scene_) {
            if (scene !== this.scene_) this.past_.length = 0;
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
            const edge = Math.min(Math.floor(view.to), scene.store.newest - 1);  // where the eye is
            const origin = scene.marker ? scene.marker.cycle : edge - scene.seconds(edge) / (scene.cycle_ns / 1e9);
            const shot = { store: scene.store, from: view.from, to: view.to, cycle_s: scene.cycle_ns / 1e9, origin, signal: known, newest: scene.store.newest,
                number: (key: string) => setup.channels.findIndex((c) => key_of(c) === key) + 1 };
            for (const row of this.rows_) {
                row.chart.manual = setup.scales[row.chart.lane.key];
                row.chart.draw(shot);
            }
            this.time_chart_?.draw(shot);
        }
        this.place(this.marker_, scene.marker?.cycle);
        if (scene.marker) {
            mark(this.marker_, 'data-kind', scene.marker.kind);
            write(this.marker_.firstElementChild as Element, `${scene.marker.kind === 'alarm' ? '⚠' : 'T'} ${scene.marker.kind === 'automatic' ? say('scope_automatic') : scene.marker.text}`);
        }
        for (const which of ['a', 'b'] as const) {
            const line = this.lines_[which];
            this.place(line, cursors.shown ? cursors[which] : undefined);
            mark(line, 'aria-valuenow', String(cursors[which]));
            mark(line, 'aria-valuetext', `${which.toUpperCase()} ${this.time_of(cursors[which])}`);
        }
    }
    private place(line: HTMLElement, cycle: number | undefined): void {
        const scene = this.session_.scene;
        const part = scene && cycle !== undefined ? (cycle - scene.view.from) / scene.view.span : -1;
        line.hidden = part < 0 || part > 1;
        line.style.transform = `translateX(${(part * this.width).toFixed(1)}px)`;
    }
    get width(): number {
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

    // --- hands -----------------------------------------------------------------------------------------------------------------
    private get view() {
        return this.session_.scene?.view;
    }
    remember(): void {
        const view = this.view;
        if (!view) return;
        this.past_.push({ from: view.from, to: view.to, follow: view.follow });
        if (this.past_.length > 50) this.past_.shift();
    }
    back(): void {
        const was = this.past_.pop(), view = this.view;
        if (!was || !view) return;
        view.follow = was.follow;
        view.show(was.from, was.to);
        view.tie(this.session_.scene?.store.newest ?? 0);
        this.moved();
    }
    zoom(factor: number, part = 0.5): void {
        this.view?.zoom(factor, part);
        this.moved();
    }
    move(part: number): void {
        this.view?.move(part);
        this.moved();
    }
    /** All that is there. */
    all(): void {
        const scene = this.session_.scene;
        if (!scene) return;
        this.remember();
        const firsts = [...scene.store.tracks.values()].map((t) => t.have.list[0]?.from ?? Infinity);
        const first = Math.min(...firsts);
        if (!Number.isFinite(first)) return;
        scene.view.show(first, scene.store.newest);
        this.moved();
    }
    private moved(): void {
        this.session_.changed();
        this.changed_();
        this.draw();
    }
    private part(client_x: number): number {
        const box = this.surface.getBoundingClientRect();
        return Math.min(1, Math.max(0, (client_x - box.left) / Math.max(1, this.width)));
    }
    private cycle_at(client_x: number): number {
        const view = this.view;
        return view ? Math.round(view.from + view.span * this.part(client_x)) : 0;
    }
    private cursor_line(which: 'a' | 'b'): HTMLElement {
        const line = element('div', { class: `scope-cursor ${which}`, role: 'slider', tabindex: '0', hidden: true, 'data-cursor': which, 'aria-label': say('scope_cursor', { which: which.toUpperCase() }),
            onkeydown: (event: KeyboardEvent) => {
                const step = event.key === 'ArrowLeft' ? -1 : event.key === 'ArrowRight' ? 1 : 0;
                if (step === 0) return;
                event.preventDefault();
                event.stopPropagation();
                this.session_.cursors[which] += step * (event.shiftKey ? 10 : 1) * (event.ctrlKey ? 100 : 1);
                this.moved();
            },
            onpointerdown: (event: PointerEvent) => {
                event.preventDefault();
                event.stopPropagation();
                line.focus();
                line.setPointerCapture(event.pointerId);
            },
            onpointermove: (event: PointerEvent) => {
                if (!line.hasPointerCapture(event.pointerId)) return;
                event.stopPropagation();
                this.session_.cursors[which] = this.cycle_at(event.clientX);
                this.changed_();
                this.draw();
            },
        }, element('span', {}, which.toUpperCase()));
        return line;
    }

    private listen(): void {
        const surface = this.surface;
        surface.addEventListener('wheel', (event) => {
            event.preventDefault();
            if (event.shiftKey || Math.abs(event.deltaX) > Math.abs(event.deltaY)) this.move(((event.deltaX || event.deltaY) / 100) * 0.1);
            else this.zoom(1.25 ** (event.deltaY / 100), this.part(event.clientX));
        }, { passive: false });
        const fingers = new Map<number, number>();
        let start: { x: number; from: number; to: number; box: boolean } | undefined;
        surface.addEventListener('pointerdown', (event) => {
            if (event.button !== 0) return;
            event.preventDefault();
            surface.focus({ preventScroll: true });
            surface.setPointerCapture(event.pointerId);
            fingers.set(event.pointerId, event.clientX);
            const view = this.view;
            if (!view) return;
            if (fingers.size === 1) {
                this.remember();
                start = { x: event.clientX, from: view.from, to: view.to, box: this.box_zoom || event.shiftKey };
            } else start = undefined;
        });
        surface.addEventListener('pointermove', (event) => {
            const view = this.view, before = fingers.get(event.pointerId);
            if (before === undefined || !view) return;
            if (fingers.size === 2) {  // pinch
                const other = [...fingers].find(([id]) => id !== event.pointerId)?.[1] ?? 0;
                const now = Math.abs(event.clientX - other), was = Math.abs(before - other);
                if (now > 10 && was > 10) this.zoom(was / now, this.part((event.clientX + other) / 2));
            } else if (start?.box) {
                const box = surface.getBoundingClientRect();
                this.select_.hidden = false;
                this.select_.style.left = `${Math.max(0, Math.min(start.x, event.clientX) - box.left)}px`;
                this.select_.style.width = `${Math.abs(event.clientX - start.x)}px`;
            } else if (start && Math.abs(event.clientX - start.x) > 3) {
                const by = ((start.x - event.clientX) / this.width) * (start.to - start.from);
                view.follow = false;
                view.show(start.from + by, start.to + by);
                this.moved();
            }
            fingers.set(event.pointerId, event.clientX);
        });
        const end = (event: PointerEvent): void => {
            if (!fingers.delete(event.pointerId)) return;
            const view = this.view;
            if (start?.box && view && Math.abs(event.clientX - start.x) > 6) {
                const a = this.part(Math.min(start.x, event.clientX)), b = this.part(Math.max(start.x, event.clientX));
                const { from, span } = view;
                view.follow = false;
                view.show(from + span * a, from + span * b);
                this.moved();
            } else if (start && Math.abs(event.clientX - start.x) <= 3) this.past_.pop();
            this.select_.hidden = true;
            start = undefined;
        };
        surface.addEventListener('pointerup', end);
        surface.addEventListener('pointercancel', end);
        surface.addEventListener('dblclick', () => this.back());
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
        this.moved();
    }
    range_of(key: string): Range | undefined {
        return this.rows_.find((row) => row.chart.lane.key === key)?.chart.range;
    }
    lane_of(channel_key: string): Lane | undefined {
        return this.rows_.find((row) => row.chart.lane.channels.some((c) => key_of(c) === channel_key))?.chart.lane;
    }
}
