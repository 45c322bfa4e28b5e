// A curve for so many pixels: of each column the least and the greatest of every sample, so that no spike is lost. A column that lacks a cycle is a gap.
import { Track } from './store';
import { bit_of } from './signals';

export class Columns {
    /** Cycles a column. */
    per = 1;
    /** First cycle of the first column: a multiple of `per`, so that a rolling curve does not shimmer. */
    start = 0;
    count = 0;
    low = new Float64Array(0);
    high = new Float64Array(0);
}

const nothing: Track['have']['list'] = [];

/** Of [from, to), in at most `most` columns (and one more at each end); `newest`: cycles from here on cannot be there yet. */
export function thin(out: Columns, track: Track | undefined, capacity: number, from: number, to: number, most: number, newest: number, bit?: number): void {
    from = Math.max(0, Math.floor(from));
    to = Math.max(from, Math.ceil(to));
    const per = Math.max(1, Math.ceil((to - from) / Math.max(1, most)));
    out.per = per;
    out.start = Math.floor(from / per) * per;
    out.count = Math.ceil((to - out.start) / per);
    if (out.low.length < out.count) {
        out.low = new Float64Array(out.count + 64);
        out.high = new Float64Array(out.count + 64);
    }
    const list = track?.have.list ?? nothing;
    const values = track?.values;
    let at = 0;
    for (let i = 0; i < out.count; i++) {
        const a = out.start + i * per, b = Math.min(a + per, newest);
        while (at < list.length && (list[at]?.to ?? 0) <= a) at++;
        const span = list[at];
        let low = Infinity, high = -Infinity;
        // The very first column may begin before what is kept.
        const begin = span && i === 0 && span.from < b ? Math.max(a, span.from) : a;
        if (!values || !span || span.from > begin || span.to < b || b <= begin) low = high = NaN;
        else
            for (let cycle = begin, place = begin % capacity; cycle < b; cycle++) {
                let value = values[place] as number;
                if (bit !== undefined) value = bit_of(value, bit);
                if (++place === capacity) place = 0;
                if (value < low) low = value;
                if (value > high) high = value;
                if (value !== value) {
                    low = high = NaN;
                    break;
                }
            }
        out.low[i] = low;
        out.high[i] = high;
    }
}

export interface Run {
    from: number;
    to: number;
    value: number;
    /** Shorter ones than a pixel in one: there were several values. */
    many: boolean;
}

/** Stretches of one value, for bits and states; those shorter than `least` cycles are put together. Gaps are in no run. */
export function runs(track: Track | undefined, capacity: number, from: number, to: number, least: number, bit?: number): Run[] {
    const out: Run[] = [];
    for (const span of track?.have.list ?? nothing) {
        const a = Math.max(span.from, Math.floor(from)), b = Math.min(span.to, Math.ceil(to));
        if (a >= b) continue;
        const first = out.length;
        let run: Run | undefined;
        for (let cycle = a, place = a % capacity; cycle < b; cycle++) {
            let value = track?.values[place] as number;
            if (bit !== undefined) value = bit_of(value, bit);
            if (++place === capacity) place = 0;
            if (run && (run.value === value || (value !== value && run.value !== run.value))) {
                run.to = cycle + 1;
                continue;
            }
            const before = out[out.length - 2];
            if (run && run.to - run.from < least && out.length - 1 > first && before && before.many) {
                before.to = run.to;  // one more short one
                run.from = cycle;
                run.to = cycle + 1;
                run.value = value;
                continue;
            }
            if (run && run.to - run.from < least) run.many = true;
            out.push((run = { from: cycle, to: cycle + 1, value, many: false }));
        }
    }
    return out;
}
