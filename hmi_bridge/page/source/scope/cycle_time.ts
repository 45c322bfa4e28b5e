// When a cycle was. A machine that was late has skipped time: only its own word of each cycle says when that was.
import { Store } from './store';

export const time_signal = 'time_s';

/** s of machine time. A cycle that is not there yet, or no more, counts on from the nearest that is; `zero_ns`: of cycle 0, where none is. */
export function seconds_of(store: Store, cycle: number, cycle_ns: number, zero_ns: number): number {
    let nearest = NaN;
    for (const { from, to } of store.tracks.get(time_signal)?.have.list ?? [])
        for (const edge of cycle >= from && cycle < to ? [Math.floor(cycle)] : [from, to - 1]) if (!(Math.abs(edge - cycle) >= Math.abs(nearest - cycle))) nearest = edge;
    const known = store.at(time_signal, nearest);
    return Number.isNaN(known) ? (cycle * cycle_ns + zero_ns) / 1e9 : known + ((cycle - nearest) * cycle_ns) / 1e9;
}
