// Where round times stand among cycles. A cycle that was late has its own time, so times are looked for, not counted.

export interface Tick {
    cycle: number;
    /** s, from `zero_s`. */
    seconds: number;
}

/** 1, 2 or 5 times a power of ten, so that at most `most` of them make the length. */
export function round_step(length: number, most: number): number {
    const power = 10 ** Math.floor(Math.log10(length / most));
    for (const factor of [1, 2, 5]) if (power * factor * most >= length) return power * factor;
    return power * 10;
}

/** Between the cycles `from` and `to`; `time` is that of a whole cycle and never goes back. */
export function time_ticks(from: number, to: number, most: number, time: (cycle: number) => number, cycle_s: number, zero_s = 0): { ticks: Tick[]; step: number } {
    const first = Math.ceil(from), last = Math.floor(to), begin = time(first) - zero_s, end = time(last) - zero_s;
    if (!(end > begin)) return { ticks: [], step: 1 };
    const step = round_step(end - begin, most), ticks: Tick[] = [];
    for (let n = Math.ceil(begin / step - 1e-6); n * step <= end + step * 1e-6; n++) {
        const wanted = n * step + zero_s;
        let low = first, high = last + 1;  // the last cycle that is not later
        while (high - low > 1) {
            const middle = Math.floor((low + high) / 2);
            if (time(middle) <= wanted + cycle_s * 1e-3) low = middle;
            else high = middle;
        }
        ticks.push({ cycle: low + Math.min(1, Math.max(0, (wanted - time(low)) / cycle_s)), seconds: n * step });
    }
    return { ticks, step };
}
