// The tool's way seen from above (XY) and from the front (XZ), to one scale, with the tool where it is.
import { tick_distance } from '../axis/ruler';
import { element, drawing, mark } from '../view';
import { TrailPoint } from './trail';

type Place = [number, number, number];

export interface Window2 {
    from: [number, number];
    /** Pixels a unit. */
    scale: number;
}

/** A window of that many pixels around the points, both directions to one scale. */
export function window_around(points: readonly (readonly [number, number])[], width: number, height: number): Window2 {
    const low: [number, number] = [Infinity, Infinity], high: [number, number] = [-Infinity, -Infinity];
    for (const point of points)
        for (const i of [0, 1] as const) {
            low[i] = Math.min(low[i], point[i]);
            high[i] = Math.max(high[i], point[i]);
        }
    if (!Number.isFinite(low[0])) return { from: [-1, -1], scale: Math.min(width, height) / 2 };
    const least = 1, margin = 1.16;
    const scale = Math.min(width / (Math.max(high[0] - low[0], least) * margin), height / (Math.max(high[1] - low[1], least) * margin));
    return { from: [(low[0] + high[0]) / 2 - width / scale / 2, (low[1] + high[1]) / 2 - height / scale / 2], scale };
}

/** Points nearer to each other than half a pixel are one. */
export function path_text(points: readonly (readonly [number, number])[]): string {
    let text = '', last: readonly [number, number] | undefined;
    for (const [i, point] of points.entries()) {
        if (last && i + 1 < points.length && Math.hypot(point[0] - last[0], point[1] - last[1]) < 0.5) continue;
        text += `${last ? 'L' : 'M'}${point[0].toFixed(1)} ${point[1].toFixed(1)}`;
        last = point;
    }
    return text;
}

const left = 46, foot = 22, right = 10, head = 14;

/** One of the two pictures: `across` and `up` are places in X Y Z. */
class Plane {
    readonly root: SVGElement;
    private readonly grid_ = drawing('g');
    private readonly way_ = drawing('path', { class: 'way' });
    private readonly set_ = drawing('circle', { class: 'tool-set', r: '6' });
    private readonly actual_ = drawing('path', { class: 'tool-actual', d: 'M-7 0H7M0 -7V7' });
    private drawn_ = '';

    constructor(private readonly across_: 0 | 1 | 2, private readonly up_: 0 | 1 | 2, private readonly width_: number, private readonly height_: number, private readonly unit_: string) {
        this.root = drawing('svg', { class: 'path-plane', viewBox: `0 0 ${width_} ${height_}`, role: 'img', 'data-plane': `${'XYZ'[across_]}${'XYZ'[up_]}` }, this.grid_, this.way_, this.set_, this.actual_);
    }
    update(points: readonly TrailPoint[], set: Place, actual: Place): void {
        const flat = (at: Place): [number, number] => [at[this.across_], at[this.up_]];
        const way = points.map((point) => flat(point.at)), now = [flat(set), flat(actual)];
        const inner = [this.width_ - left - right, this.height_ - head - foot] as const;
        const window = window_around([...way, ...now.filter((at) => at.every(Number.isFinite))], ...inner);
        const pixel = (at: [number, number]): [number, number] => [left + (at[0] - window.from[0]) * window.scale, this.height_ - foot - (at[1] - window.from[1]) * window.scale];
        this.grid(window, inner);
        mark(this.way_, 'd', path_text(way.map(pixel)) || false);
        for (const [of, at] of [[this.set_, now[0]], [this.actual_, now[1]]] as const) {
            const to = pixel(at ?? [NaN, NaN]);
            mark(of, 'visibility', to.every(Number.isFinite) ? 'visible' : 'hidden');
            if (to.every(Number.isFinite)) mark(of, 'transform', `translate(${to[0].toFixed(1)} ${to[1].toFixed(1)})`);
        }
        mark(this.root, 'aria-label', `${'XYZ'[this.across_]} ${(now[0]?.[0] ?? NaN).toFixed(1)}, ${'XYZ'[this.up_]} ${(now[0]?.[1] ?? NaN).toFixed(1)} ${this.unit_}`);
    }
    private grid(window: Window2, inner: readonly [number, number]): void {
        const drawn = [window.from[0].toFixed(2), window.from[1].toFixed(2), window.scale.toFixed(3)].join();
        if (drawn === this.drawn_) return;
        this.drawn_ = drawn;
        const bottom = this.height_ - foot, parts: SVGElement[] = [];
        const distance = tick_distance(inner[0] / window.scale, 8);
        const text = (at: number): string => String(Number(at.toPrecision(10))).replace('-', '−');
        for (let at = Math.ceil(window.from[0] / distance) * distance; (at - window.from[0]) * window.scale <= inner[0]; at += distance) {
            const x = (left + (at - window.from[0]) * window.scale).toFixed(1);
            parts.push(drawing('line', { class: 'path-grid', x1: x, x2: x, y1: String(head), y2: String(bottom) }), drawing('text', { x, y: String(bottom + 15), 'text-anchor': 'middle' }, text(at)));
        }
        for (let at = Math.ceil(window.from[1] / distance) * distance; (at - window.from[1]) * window.scale <= inner[1]; at += distance) {
            const y = bottom - (at - window.from[1]) * window.scale;
            parts.push(drawing('line', { class: 'path-grid', x1: String(left), x2: String(left + inner[0]), y1: y.toFixed(1), y2: y.toFixed(1) }), drawing('text', { x: String(left - 5), y: (y + 4).toFixed(1), 'text-anchor': 'end' }, text(at)));
        }
        parts.push(drawing('text', { class: 'path-name', x: String(left + inner[0]), y: String(bottom - 5), 'text-anchor': 'end' }, `${'XYZ'[this.across_]} [${this.unit_}]`),
            drawing('text', { class: 'path-name', x: String(left + 5), y: String(head + 11) }, `${'XYZ'[this.up_]} [${this.unit_}]`));
        this.grid_.replaceChildren(...parts);
    }
}

export class PathView {
    readonly root: HTMLElement;
    private readonly planes_: Plane[];

    constructor(unit: string) {
        this.planes_ = [new Plane(0, 1, 600, 330, unit), new Plane(0, 2, 600, 190, unit)];
        this.root = element('div', { class: 'path-view' }, ...this.planes_.map((plane) => plane.root));
    }
    update(points: readonly TrailPoint[], set: Place, actual: Place): void {
        for (const plane of this.planes_) plane.update(points, set, actual);
    }
}
