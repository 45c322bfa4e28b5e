// The samples that the page keeps: one ring of numbers for each signal, all of one length, by cycle. What was never there stays told apart from what is no number.
import { Spans } from './spans';

export interface Track {
    values: Float64Array;
    readonly have: Spans;
}

/** Bytes for all signals together; a browser's tab bears ten times that. */
const most_bytes = 96 * 1024 * 1024;
const longest_s = 600;

/** Cycles that are kept for so many signals: ten minutes, or what the memory allows. Steps of two, so that one signal more seldom changes it. */
export function capacity_for(signals: number, cycle_ns: number): number {
    const places = Math.max(8, 2 ** Math.ceil(Math.log2(Math.max(1, signals))));
    return Math.floor(Math.min(most_bytes / 8 / places, (longest_s * 1e9) / cycle_ns));
}

export class Store {
    readonly tracks = new Map<string, Track>();
    /** The cycle behind the newest one of any signal. */
    newest = 0;

    constructor(private capacity_: number) {}

    get capacity(): number {
        return this.capacity_;
    }
    /** Nothing before this cycle is kept. */
    get oldest(): number {
        return Math.max(0, this.newest - this.capacity_);
    }

    put(name: string, from: number, values: Float64Array): void {
        const to = from + values.length;
        if (to > this.newest) {
            this.newest = to;
            for (const track of this.tracks.values()) track.have.cut(this.oldest);
        }
        let track = this.tracks.get(name);
        if (!track) this.tracks.set(name, (track = { values: new Float64Array(this.capacity_), have: new Spans() }));
        const first = Math.max(from, this.oldest);
        if (first >= to) return;
        const at = first % this.capacity_, piece = Math.min(to - first, this.capacity_ - at), skipped = first - from;
        track.values.set(values.subarray(skipped, skipped + piece), at);
        if (skipped + piece < values.length) track.values.set(values.subarray(skipped + piece), 0);
        track.have.add(first, to);
    }
    /** NaN where nothing is. */
    at(name: string, cycle: number): number {
        const track = this.tracks.get(name);
        return track && track.have.has(cycle) ? track.values[cycle % this.capacity_] ?? NaN : NaN;
    }
    has(name: string, from: number, to = from + 1): boolean {
        return this.tracks.get(name)?.have.has(from, to) ?? false;
    }
    /** Every sample of [from, to) in order; NaN where nothing is. */
    copy(name: string, from: number, to: number): Float64Array {
        const out = new Float64Array(Math.max(0, to - from)).fill(NaN);
        this.each(name, from, to, (samples, cycle) => out.set(samples, cycle - from));
        return out;
    }
    /** The samples that are there of [from, to), piece by piece, as they lie in the ring: not to be kept. */
    each(name: string, from: number, to: number, take: (samples: Float64Array, from: number) => void): void {
        const track = this.tracks.get(name);
        for (const span of track?.have.list ?? [])
            for (let cycle = Math.max(from, span.from), end = Math.min(to, span.to); cycle < end && track;) {
                const at = cycle % this.capacity_, piece = Math.min(end - cycle, this.capacity_ - at);
                take(track.values.subarray(at, at + piece), cycle);
                cycle += piece;
            }
    }
    /** Keeps these signals alone, this many cycles of each. */
    keep(names: readonly string[], capacity = this.capacity_): void {
        for (const name of [...this.tracks.keys()]) if (!names.includes(name)) this.tracks.delete(name);
        if (capacity === this.capacity_) return;
        const old = [...this.tracks].map(([name, track]) => [name, track.have.list, (from: number, to: number) => this.copy(name, from, to)] as const);
        const pieces = old.flatMap(([name, list, copy]) => list.map((span) => ({ name, from: Math.max(span.from, this.newest - capacity), samples: copy(Math.max(span.from, this.newest - capacity), span.to) })));
        this.tracks.clear();
        this.capacity_ = capacity;
        for (const { name, from, samples } of pieces) this.put(name, from, samples);
    }
    clear(): void {
        this.tracks.clear();
        this.newest = 0;
    }
}
