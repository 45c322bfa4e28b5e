// One signal over another: every sample of what is shown, with the cursors on the curve.
import uPlot from 'uplot';
import { say } from '../texts';
import { element, write } from '../view';
import { colour_of } from './colours';

import { look } from './stack';
import { range_around, Range } from './lanes';
import { Session } from './session';

/** Cycles that are drawn at most; more are more than a picture has room for. */
const most_points = 500_000;

/** Both ranges with one length a pixel. */
export function squared(x: Range, y: Range, width: number, height: number): { x: Range; y: Range } {
    const unit = Math.max((x.max - x.min) / width, (y.max - y.min) / height);
    const around = (range: Range, length: number): Range => ({ min: (range.min + range.max - unit * length) / 2, max: (range.min + range.max + unit * length) / 2 });
    return { x: around(x, width), y: around(y, height) };
}

export class XyView {
    readonly root: HTMLElement;
    private readonly host_ = element('div', { class: 'scope-chart' });
    private readonly hint_ = element('p', { class: 'hint' });
    private readonly x_ = element('select', { 'data-field': 'x', onchange: () => this.take() });
    private readonly y_ = element('select', { 'data-field': 'y', onchange: () => this.take() });
    private readonly square_ = element('input', { type: 'checkbox', onchange: () => this.take() });
    private plot_: uPlot | undefined;
    private x_range_: Range = { min: 0, max: 1 };
    private y_range_: Range = { min: 0, max: 1 };
    private points_: { x: Float64Array; y: Float64Array; from: number } = { x: new Float64Array(0), y: new Float64Array(0), from: 0 };
    private made_of_ = '';
    private drawn_ = '';
    private drawn_at_ = 0;

    constructor(private readonly session_: Session, private readonly changed_: () => void) {
        const field = (key: 'scope_x_signal' | 'scope_y_signal' | 'scope_square', input: HTMLElement): HTMLElement => element('label', {}, element('span', {}, say(key)), input);
        this.root = element('div', { class: 'scope-other xy' }, element('div', { class: 'scope-options' }, field('scope_x_signal', this.x_), field('scope_y_signal', this.y_), field('scope_square', this.square_), this.hint_), this.host_);
    }
    private take(): void {
        this.session_.setup.xy = { x: this.x_.value, y: this.y_.value, square: this.square_.checked };
        this.changed_();
        this.draw();
    }

    draw(): void {
        const { scene, setup, names, cursors } = this.session_, now = performance.now();
        const offered = names.filter((name) => scene?.signals.has(name));
        const made_of = JSON.stringify([offered, setup.xy]);
        if (made_of !== this.made_of_) {
            this.made_of_ = made_of;
            const two = [setup.xy.x, setup.xy.y].map((name, i) => (offered.includes(name) ? name : offered[i] ?? ''));
            [this.x_, this.y_].forEach((select, i) => {
                select.replaceChildren(...offered.map((name) => element('option', { value: name }, name)));
                select.value = two[i] ?? '';
            });
            this.square_.checked = setup.xy.square;
        }
        const [x, y] = [this.x_.value, this.y_.value], width = this.host_.clientWidth, height = this.host_.clientHeight;
        write(this.hint_, scene && x && y ? '' : say('scope_two_needed'));
        if (!scene || !x || !y || width < 50 || height < 50) return;
        const to = Math.min(scene.store.newest, Math.floor(scene.view.to) + 1), from = Math.max(0, Math.ceil(scene.view.from), to - most_points);
        const drawn = JSON.stringify([x, y, from, to, width, height, cursors, setup.xy.square, scene.store.tracks.get(x)?.have.list, scene.store.tracks.get(y)?.have.list, look().dark]);
        if (drawn === this.drawn_ || now - this.drawn_at_ < 100) return;
        this.drawn_ = drawn;
        this.drawn_at_ = now;
        this.points_ = { x: scene.store.copy(x, from, to), y: scene.store.copy(y, from, to), from };
        const range_of = (values: Float64Array): Range => {
            let low = Infinity, high = -Infinity;
            for (const v of values) {
                if (v < low) low = v;
                if (v > high) high = v;
            }
            return range_around(low, high);
        };
        this.x_range_ = range_of(this.points_.x);
        this.y_range_ = range_of(this.points_.y);
        if (setup.xy.square) ({ x: this.x_range_, y: this.y_range_ } = squared(this.x_range_, this.y_range_, Math.max(50, width - 90), Math.max(50, height - 60)));
        this.make(width, height, ...([x, y].map((name) => `${name}${scene.signals.get(name)?.unit ? ` [${scene.signals.get(name)?.unit}]` : ''}`) as [string, string]));
    }
    private make(width: number, height: number, x_label: string, y_label: string): void {
        this.plot_?.destroy();
        const style = look(), axis = { stroke: style.quiet, font: style.font, labelFont: style.font, labelSize: 20, grid: { stroke: style.grid, width: 1 }, ticks: { stroke: style.grid, width: 1 },
            values: (_plot: uPlot, splits: number[]) => splits.map((s) => String(Number(s.toPrecision(10))).replace('-', '−')) };
        this.plot_ = new uPlot({
            width, height, legend: { show: false }, cursor: { show: false }, padding: [10, 16, 0, 0],
            scales: { x: { time: false, auto: false, range: () => [this.x_range_.min, this.x_range_.max] }, y: { auto: false, range: () => [this.y_range_.min, this.y_range_.max] } },
            axes: [{ ...axis, label: x_label }, { ...axis, label: y_label, size: 62 }],
            series: [{}, { stroke: colour_of(0, style.dark), width: 1.5, points: { show: false }, paths: (plot) => ({ stroke: this.path(plot), flags: 0 }) }],
            hooks: { draw: [(plot) => this.draw_marks(plot, style.text, style.ground)] },
        }, [[0, 1], [0, 0]], this.host_);
    }
    private place(plot: uPlot, i: number): [number, number] {
        const { left, top, width, height } = plot.bbox, x = this.x_range_, y = this.y_range_;
        return [left + (((this.points_.x[i] as number) - x.min) * width) / (x.max - x.min), top + ((y.max - (this.points_.y[i] as number)) * height) / (y.max - y.min)];
    }
    private path(plot: uPlot): Path2D {
        const path = new Path2D();
        let broken = true;
        for (let i = 0; i < this.points_.x.length; i++) {
            const [x, y] = this.place(plot, i);
            if (Number.isNaN(x + y)) broken = true;
            else if (broken) {
                path.moveTo(x, y);
                broken = false;
            } else path.lineTo(x, y);
        }
        return path;
    }
    /** The newest sample, and where the cursors are. */
    private draw_marks(plot: uPlot, ink: string, ground: string): void {
        const { cursors } = this.session_, ctx = plot.ctx, px = uPlot.pxRatio;
        ctx.save();
        ctx.font = `bold ${12 * px}px system-ui, sans-serif`;
        ctx.textAlign = 'center';
        ctx.textBaseline = 'middle';
        const mark = (i: number, text: string): void => {
            const [x, y] = i >= 0 && i < this.points_.x.length ? this.place(plot, i) : [NaN, NaN];
            if (Number.isNaN(x + y)) return;
            ctx.fillStyle = ink;
            ctx.beginPath();
            ctx.arc(x, y, (text ? 9 : 4) * px, 0, 2 * Math.PI);
            ctx.fill();
            ctx.fillStyle = ground;
            ctx.fillText(text, x, y + px * 0.5);
        };
        mark(this.points_.x.length - 1, '');
        if (cursors.shown) {
            mark(cursors.a - this.points_.from, 'A');
            mark(cursors.b - this.points_.from, 'B');
        }
        ctx.restore();
    }
    canvas(): HTMLCanvasElement | undefined {
        return this.plot_?.ctx.canvas;
    }
}

