// The travel of an axis drawn to scale: software limits, the carriage where it is, the target as a hollow mark.
import { fixed } from '../numbers';
import { AxisLayout, AxisState, value } from '../state';
import { drawing, mark } from '../view';

/** What the ruler shows: the software limits and a little beyond; without limits, what lies around the axis. */
export function range_of(layout: Pick<AxisLayout, 'position_min' | 'position_max' | 'modulo'>, position: number): { from: number; to: number; low: number; high: number } {
    const low = value(layout.position_min), high = value(layout.position_max), modulo = value(layout.modulo);
    if (modulo > 0) return { from: 0, to: modulo, low: -Infinity, high: Infinity };
    if (Number.isFinite(low) && Number.isFinite(high) && high > low) {
        const beyond = (high - low) * 0.06;
        return { from: low - beyond, to: high + beyond, low, high };
    }
    const window = 100;
    const centre = Number.isFinite(position) ? Math.round(position / window) * window : 0;
    return { from: centre - window, to: centre + window, low: Number.isFinite(low) ? low : -Infinity, high: Number.isFinite(high) ? high : Infinity };
}

/** 1, 2 or 5 times a power of ten, so that at most `most` fit. */
export function tick_distance(length: number, most: number): number {
    const power = 10 ** Math.floor(Math.log10(length / most));
    for (const factor of [1, 2, 5, 10]) if (length / (power * factor) <= most) return power * factor;
    return power * 10;
}

export class Ruler {
    readonly root = drawing('svg', { class: 'ruler', role: 'img' });
    private drawn_ = '';
    private readonly scale_ = drawing('g');
    private readonly target_ = drawing('svg', { overflow: 'visible', class: 'ruler-target' }, drawing('path', { d: 'M0 36 L-7 22 L7 22 Z' }));
    private readonly carriage_ = drawing('svg', { overflow: 'visible', class: 'ruler-carriage' },
        drawing('rect', { x: '-13', y: '14', width: '26', height: '20', rx: '3' }), drawing('path', { d: 'M0 46 L-7 34 L7 34 Z' }));

    constructor() {
        this.root.append(this.scale_, this.target_, this.carriage_);
    }

    update(layout: AxisLayout, axis: AxisState): void {
        const position = value(axis.actual_position), target = value(axis.target_position);
        // As they hold now: a program may have changed those of the machine file.
        const limits = axis.position_min === undefined ? layout : { position_min: axis.position_min, position_max: axis.position_max ?? null, modulo: layout.modulo ?? 0 };
        const { from, to, low, high } = range_of(limits, position);
        const part = (at: number) => `${(Math.min(1, Math.max(0, (at - from) / (to - from))) * 100).toFixed(3)}%`;
        const drawn = [from, to, low, high, axis.homed].join();
        if (drawn !== this.drawn_) {
            this.drawn_ = drawn;
            this.scale_.replaceChildren(drawing('rect', { class: 'ruler-bar', x: '0', y: '46', width: '100%', height: '10' }));
            const mine = [Math.max(from, low), Math.min(to, high)] as const;
            const inside = drawing('rect', { class: 'ruler-inside', x: part(mine[0]), y: '46', width: `${((mine[1] - mine[0]) / (to - from)) * 100}%`, height: '10' });
            mark(inside, 'data-in-force', axis.homed);
            this.scale_.append(inside);
            const distance = tick_distance(to - from, 10);
            for (let at = Math.ceil(from / distance) * distance; at <= to; at += distance)
                this.scale_.append(drawing('line', { class: 'ruler-tick', x1: part(at), x2: part(at), y1: '56', y2: '64' }),
                    drawing('text', { x: part(at), y: '78', 'text-anchor': 'middle' }, String(Number(at.toPrecision(10))).replace('-', '−')));
            for (const limit of [low, high])
                if (Number.isFinite(limit))
                    this.scale_.append(drawing('line', { class: 'ruler-limit', x1: part(limit), x2: part(limit), y1: '12', y2: '60' }),
                        drawing('text', { class: 'ruler-limit-text', x: part(limit), y: '9', 'text-anchor': 'middle' }, fixed(limit, 0)));
        }
        mark(this.carriage_, 'x', part(position));
        mark(this.carriage_, 'visibility', Number.isFinite(position) ? 'visible' : 'hidden');
        mark(this.target_, 'x', part(target));
        mark(this.target_, 'visibility', axis.has_job && Number.isFinite(target) ? 'visible' : 'hidden');
        mark(this.root, 'aria-label', `${fixed(position)} ${axis.unit}`);
        mark(this.root, 'data-outside', position < from || position > to);
    }
}
