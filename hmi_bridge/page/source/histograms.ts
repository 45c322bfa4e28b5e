// How long cycle and tasks took, how often: a column per duration, its height by the logarithm of the count, so that the one in a million is seen.
import { Desk, panel } from './desk';
import { Inquiry } from './inquiry';
import { microseconds } from './numbers';
import { say, word } from './texts';
import { drawing, element, mark, Rows, write } from './view';

export interface HistogramData {
    name: string;
    count: number;
    max_ns: number;
    p50_ns?: number;
    p99_ns?: number;
    /** [first, last, count]: durations from first to last ns, both within. */
    buckets: [number, number, number][];
}

const refresh_ms = 1000;
const width = 420, height = 64;

/** Columns along a logarithmic scale of time, one per bucket, so that what is rare and long has its place. */
export function columns(data: HistogramData): { x: number; width: number; height: number }[] {
    const used = data.buckets.filter(([, , count]) => count > 0);
    if (used.length === 0) return [];
    const low = Math.log10(Math.max(100, Math.min(...used.map(([first]) => first)))), high = Math.log10(Math.max(1000, ...used.map(([, last]) => last + 1)));
    const at = (ns: number) => (Math.max(0, Math.log10(Math.max(100, ns)) - low) / Math.max(1e-9, high - low)) * width;
    const most = Math.log10(1 + Math.max(...used.map(([, , count]) => count)));
    return used.map(([first, last, count]) => ({ x: at(first), width: Math.max(1.5, at(last + 1) - at(first) - 0.5), height: (Math.log10(1 + count) / most) * (height - 2) }));
}

export class Histograms {
    private readonly list_ = element('div', { class: 'histograms' });
    private readonly none_ = element('p', { class: 'hint' });
    private readonly anew_: HTMLButtonElement;
    readonly root: HTMLElement;
    private readonly rows_ = new Rows<HistogramData, { root: Element; said: Element; drawn: SVGElement }>(this.list_, (data) => data.name, (data) => {
        const said = element('span', { class: 'number' }), drawn = drawing('svg', { class: 'histogram', viewBox: `0 0 ${width} ${height}`, preserveAspectRatio: 'none', role: 'img' });
        return { root: element('figure', {}, element('figcaption', {}, element('strong', {}, word('histogram', data.name)), said), drawn), said, drawn };
    }, (row, data) => {
        const us = (ns: number | undefined) => microseconds(ns ?? 0);
        write(row.said, say('histogram_all', { count: String(data.count), median: us(data.p50_ns), p99: us(data.p99_ns), worst: us(data.max_ns) }));
        mark(row.drawn, 'aria-label', row.said.textContent ?? '');
        row.drawn.replaceChildren(...columns(data).map((c) => drawing('rect', { x: c.x.toFixed(1), y: (height - c.height).toFixed(1), width: c.width.toFixed(1), height: c.height.toFixed(1) })));
    });
    private readonly inquiry_: Inquiry;

    constructor(private readonly desk_: Desk) {
        this.anew_ = desk_.button('begin_anew', () => ({ cmd: 'reset_statistics' }), 'small');
        this.root = panel('histograms', this.none_, this.list_, element('div', { class: 'buttons' }, this.anew_));
        this.inquiry_ = new Inquiry(desk_, () => ({ cmd: 'histograms' }), refresh_ms, (answer) => {
            if (answer.ok) this.rows_.update((answer['histograms'] as HistogramData[] | undefined) ?? []);
        });
    }
    step(): void {
        this.inquiry_.step();
        write(this.none_, this.inquiry_.unknown ? say('not_known') : '');
        this.desk_.permit(this.anew_, 'reset_statistics', !this.inquiry_.unknown);
    }
    leave(): void {
        this.inquiry_.leave();
    }
}
