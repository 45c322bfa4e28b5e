// How long cycle and tasks took, how often: a column per duration, its height by the logarithm of the count, so that the one in a million is seen.
import { Desk, panel } from './desk';
import { Inquiry } from './inquiry';
import { microseconds } from './numbers';
import { Key, say } from './texts';
import { drawing, element, mark, Rows, write } from './view';

/** As the machine says it (hmi_bridge/README.md, `histograms`). */
interface Times {
    count: number;
    longest_ns: number;
    /** 0: never. */
    longest_cycle: number;
    /** [first, last, count]: durations from first to last ns, both within; empty ones are left out. */
    bins: [number, number, number][];
}
interface Named extends Times {
    name: string;
}

const refresh_ms = 1000;
const width = 420, height = 48;

/** The duration that `share` (0..1) of all do not exceed: the end of its bin, never above the longest. */
export function percentile(times: Times, share: number): number {
    let left = Math.ceil(share * times.count);
    for (const [, last, count] of times.bins) if ((left -= count) <= 0) return Math.min(last, times.longest_ns);
    return times.longest_ns;
}

/** Columns along a logarithmic scale of time, one per bin, so that what is rare and long has its place. `from`, `to`: ns, the ends of the scale. */
export function columns(times: Times, from: number, to: number): { x: number; width: number; height: number }[] {
    const low = Math.log10(from), scale = width / Math.log10(to / from);
    const at = (ns: number): number => Math.min(width, Math.max(0, (Math.log10(Math.max(1, ns)) - low) * scale));
    const most = Math.log10(1 + Math.max(1, ...times.bins.map(([, , count]) => count)));
    return times.bins.map(([first, last, count]) => ({ x: at(first), width: Math.max(1.5, at(last + 1) - at(first) - 0.3), height: (Math.log10(1 + count) / most) * (height - 2) }));
}

export class Histograms {
    private readonly list_ = element('div', { class: 'histograms' });
    private readonly none_ = element('p', { class: 'hint' });
    private readonly axis_ = element('div', { class: 'histogram-axis', 'aria-hidden': 'true' });
    private readonly anew_: HTMLButtonElement;
    readonly root: HTMLElement;
    private readonly rows_: { update(items: readonly Named[]): void };
    private readonly inquiry_: Inquiry;
    private from_ = 1000;
    private to_ = 1_000_000;

    constructor(private readonly desk_: Desk) {
        this.anew_ = desk_.button('begin_anew', () => ({ cmd: 'reset_statistics' }), 'small');
        this.rows_ = new Rows(this.list_, (times: Named) => times.name, (times) => {
            const said = element('span', { class: 'number' }), drawn = drawing('svg', { class: 'histogram', viewBox: `0 0 ${width} ${height}`, preserveAspectRatio: 'none', role: 'img' });
            return { root: element('figure', { 'data-histogram': times.name }, element('figcaption', {}, element('strong', {}, times.name), said), drawn), said, drawn };
        }, (row, times) => {
            const us = (ns: number): string => microseconds(ns);
            write(row.said, say('histogram_said', { median: us(percentile(times, 0.5)), p99: us(percentile(times, 0.99)), worst: us(times.longest_ns), cycle: String(times.longest_cycle) }));
            mark(row.drawn, 'aria-label', `${times.name}: ${row.said.textContent ?? ''}`);
            const cycle = `${((Math.log10(this.cycle_ / this.from_) / Math.log10(this.to_ / this.from_)) * width).toFixed(1)}`;
            row.drawn.replaceChildren(...columns(times, this.from_, this.to_).map((c) => drawing('rect', { x: c.x.toFixed(1), y: (height - c.height).toFixed(1), width: c.width.toFixed(1), height: c.height.toFixed(1) })),
                drawing('line', { class: 'histogram-cycle', x1: cycle, x2: cycle, y1: '0', y2: String(height) }));
        });
        this.root = panel('histograms', this.none_, this.list_, this.axis_, element('div', { class: 'bar' }, element('span', { class: 'hint' }, say('histogram_hint')), element('span', { class: 'space' }), this.anew_));
        this.inquiry_ = new Inquiry(desk_, () => ({ cmd: 'histograms' }), refresh_ms, (answer) => {
            if (answer.ok) this.take(answer['histograms'] as { compute: Times; lateness: Times; tasks: Named[] });
        });
    }
    private get cycle_(): number {
        return this.desk_.link.layout?.cycle_ns ?? 1_000_000;
    }
    private take({ compute, lateness, tasks }: { compute: Times; lateness: Times; tasks: Named[] }): void {
        const named = (key: Key, times: Times): Named => ({ ...times, name: say(key) });
        const all = [named('compute', compute), named('lateness', lateness), ...tasks].filter((times) => times.count > 0);
        const power = (ns: number, round: (x: number) => number): number => 10 ** round(Math.log10(Math.max(1, ns)));
        this.from_ = Math.max(100, power(Math.min(...all.flatMap((times) => times.bins.slice(0, 1).map(([first]) => first))), Math.floor));
        this.to_ = Math.max(this.from_ * 10, power(Math.max(this.cycle_, ...all.map((times) => times.longest_ns)), Math.ceil));
        const decades = Math.round(Math.log10(this.to_ / this.from_));
        this.axis_.replaceChildren(...Array.from({ length: decades + 1 }, (_, i) => element('span', {}, round_time(this.from_ * 10 ** i))));
        this.rows_.update(all);
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

/** A power of ten of ns: 100 ns, 10 µs, 1 ms. */
function round_time(ns: number): string {
    if (ns < 1000) return `${ns} ns`;
    return ns < 1_000_000 ? `${ns / 1000} µs` : ns < 1_000_000_000 ? `${ns / 1_000_000} ms` : `${ns / 1_000_000_000} s`;
}
