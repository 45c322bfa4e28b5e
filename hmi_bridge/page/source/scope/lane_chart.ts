// One lane: uPlot gives the axes, the grid and the canvas; curves and bands are drawn from the store, gaps are hatched.
import uPlot from 'uplot';
import { colour_of, dash_of } from './colours';
import { draw_curve, extremes, Frame } from './curve';
import { Lane, next_range, Range } from './lanes';
import { key_of, Signal } from './signals';
import { Spans } from './spans';
import { state_text } from './state_words';
import { Store } from './store';
import { Columns, runs, thin } from './thin';

export const scale_width = 74;
export const right_room = 24;
export const band_height = 26;
const time_height = 26;

/** 1, 2, 5: nothing that a label of few digits would have to round. */
const steps = Array.from({ length: 25 }, (_, i) => [1, 2, 5].map((n) => Number(`${n}e${i - 12}`))).flat();

export interface Look {
    dark: boolean;
    text: string;
    quiet: string;
    grid: string;
    ground: string;
    gap: string;
    font: string;
}

/** What is drawn now: cycles. */
export interface Shot {
    store: Store;
    from: number;
    to: number;
    /** The cycles of round times, and what is written there. */
    ticks: { cycle: number; text: string }[];
    signal(name: string): Signal | undefined;
    /** Number of a curve, as in the list. */
    number(key: string): number;
    /** Where nothing can be yet. */
    newest: number;
}

export class LaneChart {
    readonly plot: uPlot;
    range: Range = { min: -1, max: 1 };
    manual: Range | undefined;
    private automatic_: Range | undefined;
    private shot_: Shot | undefined;
    private readonly columns_: Columns[];
    private size_ = '';

    constructor(readonly lane: Lane, readonly look: Look, with_time: boolean, host: HTMLElement) {
        this.columns_ = lane.channels.map(() => new Columns());
        const axis = { incrs: steps, stroke: look.quiet, font: look.font, grid: { stroke: look.grid, width: 1 }, ticks: { stroke: look.grid, width: 1, size: 4 } };
        this.plot = new uPlot({
            width: 200, height: 60, legend: { show: false }, cursor: { show: false }, padding: [with_time ? 0 : 4, right_room, with_time ? 0 : 4, 0], pxAlign: 1,
            scales: {
                x: { time: false, auto: false, range: () => this.cycles() },
                y: { auto: false, range: () => [this.range.min, this.range.max] },
            },
            axes: [
                { ...axis, size: with_time ? time_height : 0, gap: 3, ticks: { ...axis.ticks, show: with_time },
                    splits: () => this.shot_?.ticks.map((tick) => tick.cycle) ?? [], values: () => this.shot_?.ticks.map((tick) => (with_time ? tick.text : '')) ?? [] },
                lane.digital ? { ...axis, size: scale_width, grid: { show: false }, ticks: { show: false }, values: (_plot, splits) => splits.map(() => '') }
                    : { ...axis, size: scale_width, gap: 4, space: 18, values: (_plot, splits) => splits.map((s) => String(Number(s.toPrecision(10))).replace('-', '−')) },
            ],
            series: [{}, ...lane.channels.map((channel, i) => ({
                scale: 'y', show: !lane.digital && !channel.hidden, stroke: colour_of(channel.colour, look.dark), width: 1.5, dash: [...dash_of(channel.colour)], points: { show: false },
                paths: () => this.path(i),
            }))],
            hooks: { drawAxes: [() => this.draw_gaps()], draw: [() => this.draw_over()] },
        }, [[0, 1], ...lane.channels.map(() => [0, 0])], host);
    }

    set_size(width: number, height: number): void {
        const size = `${Math.round(width)}x${Math.round(height)}`;
        if (size === this.size_) return;
        this.size_ = size;
        this.plot.setSize({ width: Math.round(width), height: Math.round(height) });
    }
    /** Height that the lane wants; undefined: what is left. */
    get own_height(): number | undefined {
        return this.lane.digital ? this.lane.channels.length * band_height + 8 : undefined;
    }

    draw(shot: Shot): void {
        this.shot_ = shot;
        if (!this.lane.digital) {
            const width = Math.max(50, this.plot.bbox.width);
            let low = Infinity, high = -Infinity;
            this.lane.channels.forEach((channel, i) => {
                if (channel.hidden) return;
                const columns = this.columns_[i] as Columns;
                thin(columns, shot.store.tracks.get(channel.name), shot.store.capacity, shot.from, shot.to + 1, width, shot.newest, channel.bit);
                const seen = extremes(columns, channel.offset);
                low = Math.min(low, seen.low);
                high = Math.max(high, seen.high);
            });
            this.automatic_ = next_range(this.automatic_, low, high);
            this.range = this.manual ?? this.automatic_;
        }
        this.plot.batch(() => {
            const [min, max] = this.cycles();
            this.plot.setScale('x', { min, max });
            this.plot.setScale('y', this.range);
            this.plot.redraw(true, true);
        });
    }
    /** One curve before the others; undefined: all alike. */
    point_at(key: string | undefined): void {
        const mine = key !== undefined && this.lane.channels.some((channel) => key_of(channel) === key);
        this.lane.channels.forEach((channel, i) => {
            const series = this.plot.series[i + 1];
            if (!series) return;
            const first = key_of(channel) === key;
            series.width = mine && first ? 3 : 1.5;
            series.alpha = mine && !first ? 0.25 : 1;
        });
        this.plot.redraw(false);
    }
    forget_range(): void {
        this.automatic_ = undefined;
    }
    destroy(): void {
        this.plot.destroy();
    }

    private cycles(): [number, number] {
        const shot = this.shot_;
        return shot ? [shot.from, shot.to] : [0, 1];
    }
    private frame(): Frame {
        const { left, top, width, height } = this.plot.bbox, shot = this.shot_;
        return { left, top, width, height, from: shot?.from ?? 0, to: shot?.to ?? 1, min: this.range.min, max: this.range.max };
    }
    private path(i: number): uPlot.Series.Paths {
        const stroke = new Path2D(), channel = this.lane.channels[i], columns = this.columns_[i], shot = this.shot_;
        if (channel && columns && shot) {
            const frame = this.frame(), kind = shot.signal(channel.name)?.kind;
            draw_curve(stroke, columns, frame, channel.offset, kind !== 'real' && kind !== undefined);
            const apart = (frame.width / (frame.to - frame.from)) / uPlot.pxRatio;
            if (columns.per === 1 && apart > 8) this.dots(stroke, columns, frame, channel.offset);
        }
        return { stroke, flags: 0 };
    }
    /** Each sample, where they lie far enough apart. */
    private dots(path: Path2D, columns: Columns, frame: Frame, offset: number): void {
        const size = 2 * uPlot.pxRatio;
        for (let k = 0; k < columns.count; k++) {
            const value = columns.low[k] as number;
            if (value !== value) continue;
            const x = frame.left + ((columns.start + k - frame.from) * frame.width) / (frame.to - frame.from);
            const y = frame.top + ((frame.max - value - offset) * frame.height) / (frame.max - frame.min);
            path.rect(x - size, y - size, 2 * size, 2 * size);
        }
    }

    private clipped(draw: (ctx: CanvasRenderingContext2D, frame: Frame, x: (cycle: number) => number) => void): void {
        const ctx = this.plot.ctx, frame = this.frame();
        ctx.save();
        ctx.beginPath();
        ctx.rect(frame.left, frame.top, frame.width, frame.height);
        ctx.clip();
        draw(ctx, frame, (cycle) => frame.left + ((cycle - frame.from) * frame.width) / (frame.to - frame.from));
        ctx.restore();
    }
    /** Cycles that one of the lane's signals lacks between its oldest and what is newest: never a line across, and seen at any zoom. */
    private draw_gaps(): void {
        const shot = this.shot_;
        if (!shot) return;
        const lacking = new Spans();
        for (const channel of this.lane.channels) {
            const list = shot.store.tracks.get(channel.name)?.have.list;
            const first = list?.[0];
            if (!first) continue;
            for (const hole of shot.store.tracks.get(channel.name)?.have.holes(Math.max(first.from, Math.floor(shot.from)), Math.min(shot.newest, Math.ceil(shot.to))) ?? []) lacking.add(hole.from, hole.to);
        }
        if (lacking.list.length === 0) return;
        this.clipped((ctx, frame, x) => {
            ctx.strokeStyle = this.look.gap;
            ctx.lineWidth = uPlot.pxRatio;
            for (const gap of lacking.list) {
                const least = 3 * uPlot.pxRatio, a = x(gap.from), width = Math.max(least, x(gap.to) - a);
                ctx.save();
                ctx.beginPath();
                ctx.rect(a, frame.top, width, frame.height);
                ctx.clip();
                ctx.beginPath();
                const step = 7 * uPlot.pxRatio;
                for (let at = a - frame.height; at < a + width; at += step) {
                    ctx.moveTo(at, frame.top + frame.height);
                    ctx.lineTo(at + frame.height, frame.top);
                }
                ctx.stroke();
                ctx.strokeRect(a, frame.top - 1, width, frame.height + 2);
                ctx.restore();
            }
        });
    }
    private draw_over(): void {
        if (!this.shot_) return;
        if (this.lane.digital) this.draw_bands(this.shot_);
        else this.draw_numbers(this.shot_);
    }
    /** The number of each curve at its right end: colour is never the only sign. */
    private draw_numbers(shot: Shot): void {
        if (this.lane.channels.length < 2) return;
        this.clipped((ctx, frame, x) => {
            const px = uPlot.pxRatio;
            ctx.font = `bold ${11 * px}px system-ui, sans-serif`;
            ctx.textAlign = 'center';
            ctx.textBaseline = 'middle';
            const tags: { x: number; y: number; text: string; width: number; colour: string }[] = [];
            this.lane.channels.forEach((channel, i) => {
                const columns = this.columns_[i] as Columns;
                if (channel.hidden) return;
                let k = columns.count - 1;
                while (k >= 0 && Number.isNaN(columns.low[k])) k--;
                if (k < 0) return;
                const text = String(shot.number(key_of(channel))), width = ctx.measureText(text).width + 6 * px;
                const value = ((columns.low[k] as number) + (columns.high[k] as number)) / 2 + channel.offset;
                const y = frame.top + ((frame.max - value) * frame.height) / (frame.max - frame.min);
                tags.push({ x: Math.min(frame.left + frame.width - width / 2 - px, x(columns.start + k * columns.per) - width / 2), y, text, width, colour: colour_of(channel.colour, this.look.dark) });
            });
            // Below one another, all inside.
            tags.sort((a, b) => a.y - b.y);
            if (tags.length * 14 * px > frame.height) return;  // a wall of numbers: pointing at a name tells which curve it is
            const deep = 14 * px, bottom = frame.top + frame.height - deep / 2;
            tags.forEach((tag, i) => (tag.y = Math.max(tag.y, frame.top + deep / 2, (tags[i - 1]?.y ?? -Infinity) + deep)));
            for (let i = tags.length - 1; i >= 0; i--) (tags[i] as { y: number }).y = Math.min((tags[i] as { y: number }).y, i === tags.length - 1 ? bottom : (tags[i + 1] as { y: number }).y - deep);
            for (const tag of tags) {
                ctx.fillStyle = tag.colour;
                ctx.fillRect(tag.x - tag.width / 2, tag.y - deep / 2, tag.width, deep - px);
                ctx.fillStyle = this.look.ground;
                ctx.fillText(tag.text, tag.x, tag.y);
            }
        });
    }
    private draw_bands(shot: Shot): void {
        this.clipped((ctx, frame, x) => {
            const px = uPlot.pxRatio, height = band_height * px;
            const least = (frame.to - frame.from) / Math.max(1, frame.width / (2 * px));
            ctx.textBaseline = 'middle';
            ctx.textAlign = 'left';
            ctx.font = `${12 * px}px system-ui, "Noto Sans CJK SC", "Microsoft YaHei", sans-serif`;
            this.lane.channels.forEach((channel, row) => {
                const signal = shot.signal(channel.name), top = frame.top + row * height + 3 * px, deep = height - 7 * px;
                ctx.fillStyle = this.look.grid;
                ctx.fillRect(frame.left, top + deep + 3 * px, frame.width, px);
                if (channel.hidden) return;
                const colour = colour_of(channel.colour, this.look.dark);
                ctx.strokeStyle = colour;
                ctx.lineWidth = 1.5 * px;
                const state = signal?.kind === 'state' && channel.bit === undefined;
                for (const run of runs(shot.store.tracks.get(channel.name), shot.store.capacity, shot.from, Math.min(shot.to + 1, shot.newest), least, channel.bit)) {
                    if (Number.isNaN(run.value)) continue;
                    const a = x(run.from), b = Math.max(x(run.to), a + px);
                    if (state || run.many) this.band(ctx, a, top, b - a, deep, colour, run.many ? '' : state_text(signal, run.value), run.many, frame.left);
                    else {
                        const y = run.value !== 0 ? top + px : top + deep;
                        if (run.value !== 0) {
                            ctx.globalAlpha = 0.25;
                            ctx.fillStyle = colour;
                            ctx.fillRect(a, top, b - a, deep + px);
                            ctx.globalAlpha = 1;
                        }
                        ctx.beginPath();
                        ctx.moveTo(a, top + deep);
                        ctx.lineTo(a, y);
                        ctx.lineTo(b, y);
                        ctx.lineTo(b, top + deep);
                        ctx.stroke();
                    }
                }
            });
        });
    }
    /** A stretch of one state with its name in it; hatched where it changed more often than there are pixels. */
    private band(ctx: CanvasRenderingContext2D, left: number, top: number, width: number, height: number, colour: string, name: string, many: boolean, edge: number): void {
        const px = uPlot.pxRatio;
        ctx.globalAlpha = many ? 0.7 : 0.16;
        ctx.fillStyle = colour;
        ctx.fillRect(left, top, width, height);
        ctx.globalAlpha = 1;
        ctx.strokeRect(left, top, width, height);
        const visible = Math.max(left, edge), room = left + width - visible - 10 * px;
        if (name === '' || room < 8 * px) return;
        let text = name;
        while (text.length > 1 && ctx.measureText(text).width > room) text = text.slice(0, text.endsWith('…') ? -2 : -1) + '…';
        if (text === '…' && name.length > 1) return;
        ctx.fillStyle = this.look.text;
        ctx.fillText(text, visible + 5 * px, top + height / 2 + px * 0.5);
    }
}
