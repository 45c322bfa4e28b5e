// A machine's recorder for tests without a machine: answers scope_* as hmi_bridge/README.md says, with values that a test can compute itself.
import { Answer, Request } from '@page/link';
import { Signal } from '@page/scope/signals';

type Value = (cycle: number) => number;

export const base64 = (values: number[]): string => Buffer.from(new Uint8Array(new Float64Array(values).buffer)).toString('base64');

export class FakeScope {
    first = 0;
    /** The newest cycle that is there. */
    last = 0;
    depth = 20_000;
    /** Machine time of cycle 0. */
    zero_ns = 0;
    readonly asked: Request[] = [];
    constructor(readonly signals: Signal[], readonly values: Record<string, Value>, readonly cycle_ns = 1_000_000) {}

    pass(cycles: number): void {
        this.last += cycles;
        this.first = Math.max(0, this.last - this.depth + 1);
    }
    readonly ask = (request: Request): Promise<Answer> => {
        this.asked.push(request);
        return Promise.resolve(this.answer(request));
    };
    answer(request: Request): Answer {
        if (request.cmd === 'scope_signals') return { ok: true, scope: { cycle_ns: this.cycle_ns, first: this.first, last: this.last, depth: this.depth, signals: this.signals } };
        if (request.cmd !== 'scope_read') return { ok: false, error: { code: 'request.unknown_command', what: request.cmd } };
        const names = request['signals'] as string[], points = Number(request['points'] ?? 200_000);
        const wanted_from = Number(request['from'] ?? this.last + 1 - points), wanted_to = Number(request['to'] ?? this.last + 1);
        const from = Math.min(Math.max(wanted_from, this.first), this.last + 1);
        const to = Math.max(from, Math.min(wanted_to, this.last + 1, from + Math.floor(200_000 / names.length)));
        const missing = Math.max(0, Math.min(from, wanted_to) - wanted_from);
        const data = names.map((name) => base64(Array.from({ length: to - from }, (_, i) => (this.values[name] as Value)(from + i))));
        return { ok: true, from, to, per: 1, first: this.first, last: this.last, time_ns: this.zero_ns + from * this.cycle_ns, missing, data };
    }
}
