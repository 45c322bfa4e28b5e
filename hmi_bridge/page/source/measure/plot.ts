// Curves over one axis below, each with its own scale: what the results of a measurement are drawn with.
import uPlot from 'uplot';
import { colour_of, dash_of, is_dark } from '../scope/colours';
import { element } from '../view';

export interface Drawn {
    readonly name: string;
    readonly values: readonly (number | null)[];
    /** No line between the points. */
    readonly points?: boolean;
}
export interface Marked {
    readonly x: number;
    readonly text: string;
}
export interface PlotOf {
    readonly title: string;
    readonly below: string;
    readonly x: readonly number[];
    readonly curves: readonly Drawn[];
    /** Powers of ten below. */
    readonly logarithmic?: boolean;
    readonly marks?: readonly Marked[];
}

const height = 240;

/** It is as wide as where it stands. `destroy` when it is shown no more. */
export class Plot {
    readonly root: HTMLElement;
    private readonly host_ = element('div', { class: 'measure-plot' });
    private readonly watch_: ResizeObserver;
    private plot_: uPlot | undefined;

    constructor(private readonly of_: PlotOf) {
        this.root = element('figure', { class: 'measure-figure' }, element('figcaption', {}, of_.title), this.host_);
        this.watch_ = new ResizeObserver(() => this.fit());
        this.watch_.observe(this.host_);
    }
    destroy(): void {
        this.watch_.disconnect();
        this.plot_?.destroy();
    }
    private fit(): void {
        const width = Math.floor(this.host_.clientWidth);
        if (width < 50) return;
        if (this.plot_) this.plot_.setSize({ width, height });
        else this.plot_ = this.make(width);
    }
    private make(width: number): uPlot {
        const style = getComputedStyle(document.documentElement), text = style.getPropertyValue('--text').trim(), line = style.getPropertyValue('--line').trim();
        const scale = (label?: string): uPlot.Axis => ({ stroke: text, grid: { stroke: line, width: 1 }, ticks: { stroke: line, width: 1 }, font: '12px system-ui', labelFont: '12px system-ui', ...(label ? { label, labelSize: 18 } : {}), size: label ? 34 : 62 });
        const series: uPlot.Series[] = this.of_.curves.map((curve, place) => ({
            label: curve.name, stroke: colour_of(place, is_dark()), width: 1.5, dash: [...(place > 0 ? [6, 3] : dash_of(place))], spanGaps: false,
            points: { show: curve.points === true || curve.values.length < 60, size: 6 }, ...(curve.points ? { paths: () => null } : {}),
        }));
        return new uPlot({
            width, height, series: [{ label: this.of_.below }, ...series], axes: [scale(this.of_.below), scale()],
            scales: { x: { time: false, distr: this.of_.logarithmic ? 3 : 1 } }, legend: { show: true, live: true }, cursor: { drag: { x: false, y: false } },
            hooks: { draw: [(plot) => this.mark(plot, text)] },
        }, [this.of_.x as number[], ...this.of_.curves.map((curve) => curve.values as number[])], this.host_);
    }
    private mark(plot: uPlot, colour: string): void {
        const { ctx, bbox } = plot;
        ctx.save();
        ctx.strokeStyle = ctx.fillStyle = colour;
        ctx.setLineDash([4, 4]);
        ctx.font = `${12 * devicePixelRatio}px system-ui`;
        (this.of_.marks ?? []).forEach(({ x, text }, place) => {
            const at = plot.valToPos(x, 'x', true);
            if (at < bbox.left || at > bbox.left + bbox.width) return;
            ctx.beginPath();
            ctx.moveTo(at, bbox.top);
            ctx.lineTo(at, bbox.top + bbox.height);
            ctx.stroke();
            ctx.fillText(text, at + 4 * devicePixelRatio, bbox.top + (14 + 15 * (place % 4)) * devicePixelRatio);
        });
        ctx.restore();
    }
}
