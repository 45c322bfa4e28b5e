// How samples come: the page asks for what it does not have, so nothing queues behind it; a page that was slow sees a gap, and fills it while the machine still has it.
import { Answer, Request } from '../link';
import { Doubles } from './base64';
import { Span, Spans } from './spans';
import { Store } from './store';

export type Ask = (request: Request) => Promise<Answer>;

/** The protocol's bound, and what comes in one answer: a quarter of a megabyte, so that what comes between the answers is not late. */
const most_signals = 64;
const most_numbers = 24_000;

/** A cycle and the machine time that cycle 0 would have had, counted back from it: ns. Cycles that are late make it more and more. */
interface Dated {
    cycle: number;
    zero_ns: number;
}
/** Cycles count from the start of a run. Another run is told by fewer of them; or, when it has run as long meanwhile, by its start, which lies behind all that the other was seen to do. */
export function another_run(before: Dated, now: Dated, cycle_ns: number): boolean {
    return before.cycle > 0 && now.zero_ns - before.zero_ns > 0.9 * before.cycle * cycle_ns + 0.5e9;
}

export interface Extent {
    first: number;
    last: number;
}

/** Stretches without a NaN. */
function for_each_run(values: Float64Array, take: (run: Float64Array, at: number) => void): void {
    for (let at = 0; at < values.length;) {
        let end = at;
        while (end < values.length && !Number.isNaN(values[end])) end++;
        if (end > at) take(values.subarray(at, end), at);
        at = end + 1;
    }
}

/** Reads stretches of every sample into a store. */
export class Reader {
    /** What the source has, as it last said. */
    extent: Extent | undefined;
    /** Why the last answer was none. */
    refusal: Answer['error'] | undefined;
    /** The machine began anew. */
    on_restart: () => void = () => undefined;
    private newest_ = { cycle: 0, zero_ns: 0 };
    private readonly doubles_ = new Doubles();

    /** Of cycle 0: ns. */
    get zero_ns(): number {
        return this.newest_.zero_ns;
    }
    constructor(private readonly ask_: Ask, private readonly recording_: string | undefined, readonly store: Store, private readonly cycle_ns_: number) {}

    /** Cycles that one question may be about, for so many signals. */
    static longest(signals: number): number {
        return Math.floor(most_numbers / Math.max(1, Math.min(signals, most_signals)));
    }

    /** Every sample of [from, to) that the source has, of any number of signals; what came, or undefined where no answer came. */
    async read(names: readonly string[], from: number, to: number): Promise<Span | undefined> {
        let got: Span | undefined;
        for (let at = 0; at < names.length; at += most_signals) {
            const signals = names.slice(at, at + most_signals);
            const range = got ?? { from, to };  // all signals to the same cycle
            const answer = await this.ask_({
                ...(this.recording_ === undefined ? { cmd: 'scope_read' } : { cmd: 'recording_read', recording: this.recording_ }), signals, points: Reader.longest(signals.length), from: range.from, to: range.to,
            });
            if (!answer.ok) {
                this.refusal = answer.error;
                return got;
            }
            this.refusal = undefined;
            const first = Number(answer['first']), last = Number(answer['last']);
            if (Number.isFinite(first) && Number.isFinite(last)) this.extent = { first, last };
            const begin = Number(answer['from']), end = Number(answer['to']);
            const data = answer['data'];
            if (!Array.isArray(data) || !Number.isSafeInteger(begin) || !Number.isSafeInteger(end) || begin < 0 || end < begin || (answer['per'] ?? 1) !== 1) return got;  // none that was asked for
            const zero_ns = Number(answer['time_ns'] ?? begin * this.cycle_ns_) - begin * this.cycle_ns_;
            if (this.recording_ === undefined && (last < this.newest_.cycle || (end > begin && another_run(this.newest_, { cycle: end - 1, zero_ns }, this.cycle_ns_)))) {
                this.on_restart();
                return undefined;
            }
            if (end > begin && end > this.newest_.cycle) this.newest_ = { cycle: end - 1, zero_ns };
            // More missing than what lies outside: some were overwritten while they were read, and came as NaN.
            const lost = Number(answer['missing'] ?? 0) > range.to - range.from - (end - begin);
            signals.forEach((name, i) => {
                const values = this.doubles_.decode(String(data[i] ?? '')).subarray(0, end - begin);
                if (!lost) this.store.put(name, begin, values);
                else for_each_run(values, (run, at) => this.store.put(name, begin + at, run));
            });
            got ??= { from: begin, to: end };
        }
        return got;
    }
}

/** Follows a machine that runs: each step brings what is new, and one stretch of what is older and missing. */
export class Live {
    names: readonly string[] = [];
    /** The cycle behind the newest that came. */
    private next_: number | undefined;
    /** What the machine does not have any more; asked for once. */
    private readonly lost_ = new Spans();

    constructor(private readonly reader_: Reader) {}

    get next(): number | undefined {
        return this.next_;
    }
    restart(): void {
        this.next_ = undefined;
        this.reader_.extent = undefined;
        this.reader_.store.clear();
        this.lost_.cut(Infinity);
    }

    /** True where there is more to be had at once. The source's extent has to be known. */
    async step(): Promise<boolean> {
        const extent = this.reader_.extent;
        if (this.names.length === 0 || !extent || extent.last < extent.first) return false;
        const from = this.next_ ?? extent.last;  // begins with the newest; what was before is fetched behind it
        const got = await this.reader_.read(this.names, from, from + Reader.longest(this.names.length));
        if (got) this.next_ = got.to;
        const filled = await this.fill();
        return filled || (got !== undefined && got.to - from >= Reader.longest(this.names.length));
    }

    private async fill(): Promise<boolean> {
        const extent = this.reader_.extent;
        if (!extent || this.next_ === undefined) return false;
        const store = this.reader_.store;
        const from = Math.max(extent.first, store.oldest), to = this.next_;
        // The newest hole first: it is nearest to what is looked at.
        let newest: Span | undefined;
        for (const name of this.names)
            for (const hole of store.tracks.get(name)?.have.holes(from, to) ?? [{ from, to }]) {
                const open = this.lost_.holes(hole.from, hole.to).pop();
                if (open && (!newest || open.to > newest.to)) newest = open;
            }
        if (!newest) return false;
        const hole = newest;
        const lacking = this.names.filter((name) => !store.has(name, hole.to - 1)).slice(0, most_signals);
        const begin = Math.max(hole.from, hole.to - Reader.longest(lacking.length));
        const got = await this.reader_.read(lacking, begin, hole.to);
        if (this.reader_.refusal) return false;
        const there = got && got.to > got.from ? got : { from: hole.to, to: hole.to };
        this.lost_.add(begin, Math.min(there.from, hole.to));
        this.lost_.add(Math.max(there.to, begin), hole.to);
        return got !== undefined;
    }
}

/** All of a recording, for these signals. */
export async function load(reader: Reader, names: readonly string[], from: number, to: number): Promise<boolean> {
    const lacking = names.filter((name) => !reader.store.has(name, from, to)).slice(0);
    for (let at = 0; at < lacking.length; at += most_signals) {
        const some = lacking.slice(at, at + most_signals);
        const step = Reader.longest(some.length);
        for (let begin = from; begin < to; begin += step) if (!(await reader.read(some, begin, Math.min(to, begin + step)))) return false;
    }
    return true;
}
