// The connection to the server: the newest state, commands with their answers, and since when nothing new has come.
import { MachineLayout, MachineState } from './state';

export interface Refusal {
    code: string;
    subject?: string;
    what: string;
    remedy?: string;
}
export interface Answer {
    ok: boolean;
    note?: string;
    error?: Refusal;
    [more: string]: unknown;
}
export type Request = { cmd: string } & Record<string, unknown>;

/** Values older than this are not shown as live: ms. */
export const stale_after = 500;
/** Bytes that the browser has not handed on for so long wait for the network. For a moment they wait on any computer that does something else. ms. */
export const stalled_after = 100;
const reconnect_after = 500;
const answer_within = 3000;
const most_counted = 200;
/** The server compares the clocks as often: after minutes of silence it could not tell a press of now from one that a stall has held back. ms. */
const say_time_each = 2000;

export class Link {
    layout: MachineLayout | undefined;
    state: MachineState | undefined;
    role = '';
    /** Who has logged in; empty: nobody, or the server knows no users. */
    user = '';
    /** The server knows users: one may log in. */
    login = false;
    /** The commands that the role may give; undefined: not told yet. */
    may: string[] | undefined;
    machines: { machine: string; online: boolean; why: string }[] = [];
    machine = '';
    /** Why the server has nothing new, in its words. */
    why_stale = '';
    version = '';
    /** How the server gets the values: `lcm` or `socket`. */
    source = '';
    /** Why not over LCM, in the server's words; empty: they do. */
    why_not_lcm = '';
    /** Publications of LCM that did not come, and messages that were none, since the server listens. */
    lost = 0;
    refused = 0;
    /** States that came in the last second. */
    get rate(): number {
        const now = performance.now();
        while (this.came_.length > 0 && (this.came_[0] ?? now) < now - 1000) this.came_.shift();
        return this.came_.length;
    }
    opened = false;
    /** performance.now() when the machine's cycle was last seen to advance; 0: never. */
    fresh_at = 0;
    /** The same by the wall clock, for people. */
    fresh_since = new Date(0);
    on_change: () => void = () => undefined;
    on_closed: () => void = () => undefined;

    /** Also told when the connection ends. */
    on_lost(tell: () => void): void {
        this.lost_.push(tell);
    }

    private readonly lost_: (() => void)[] = [];
    private readonly came_: number[] = [];
    private socket_: WebSocket | undefined;
    /** performance.now() when nothing waited to leave and something was sent. */
    private empty_at_ = 0;
    private next_id_ = 1;
    private readonly waiting_ = new Map<number, { resolve: (answer: Answer) => void; timer: number }>();

    constructor(private readonly address_: string) {}

    open(): void {
        const socket = new WebSocket(this.address_);
        this.socket_ = socket;
        socket.onopen = () => {
            this.opened = true;
            this.say_time(socket);
            this.on_change();
        };
        socket.onmessage = (event) => this.take(String(event.data));
        socket.onclose = () => {
            if (this.socket_ !== socket) return;
            this.opened = false;
            this.socket_ = undefined;
            for (const id of [...this.waiting_.keys()]) this.answer(id, lost);
            this.on_closed();
            for (const tell of this.lost_) tell();
            this.on_change();
            setTimeout(() => this.open(), reconnect_after);
        };
    }

    get stale(): boolean {
        return !this.opened || this.fresh_at === 0 || performance.now() - this.fresh_at > stale_after;
    }
    /** A network that stalls: what is sent does not leave the browser. */
    get stalled(): boolean {
        return (this.socket_?.bufferedAmount ?? 0) > 0 && performance.now() - this.empty_at_ > stalled_after;
    }

    /** Never rejects: a connection that ends is an answer, too. Nothing is kept for later where there is no connection. */
    request(request: Request): Promise<Answer> {
        const socket = this.socket_;
        if (!socket || socket.readyState !== WebSocket.OPEN) return Promise.resolve(lost);
        const id = this.next_id_++;
        return new Promise((resolve) => {
            const timer = window.setTimeout(() => this.answer(id, silent), answer_within);
            this.waiting_.set(id, { resolve, timer });
            if (socket.bufferedAmount === 0) this.empty_at_ = performance.now();
            // `machine`: a page that shows one machine never moves another. `sent_ms`: what a stalled network delivers late is refused.
            socket.send(JSON.stringify({ type: 'command', id, machine: this.machine, sent_ms: performance.now(), ...request }));
        });
    }

    private say_time(socket: WebSocket): void {
        if (socket.readyState !== WebSocket.OPEN) return;
        if (socket.bufferedAmount === 0) this.empty_at_ = performance.now();
        if (!this.stalled) socket.send(JSON.stringify({ type: 'clock', sent_ms: performance.now() }));
        setTimeout(() => this.say_time(socket), say_time_each);
    }
    /** Anew, as another user: what the server knows of a page it knows from the beginning of its connection. */
    reopen(): void {
        this.socket_?.close();
    }
    watch(machine: string): void {
        const socket = this.socket_;
        if (socket?.readyState !== WebSocket.OPEN) return;
        if (socket.bufferedAmount === 0) this.empty_at_ = performance.now();
        socket.send(JSON.stringify({ type: 'watch', machine }));
    }
    allowed(cmd: string): boolean {
        return this.may === undefined || this.may.includes(cmd);
    }

    private take(text: string): void {
        let message: Record<string, unknown>;
        try {
            message = JSON.parse(text) as Record<string, unknown>;
        } catch {
            return;  // what cannot be read is not shown; the age says the rest
        }
        if (message['type'] === 'hello') {
            const before = this.machine;
            this.layout = (message['layout'] as MachineLayout | null) ?? undefined;
            this.role = String(message['role'] ?? '');
            this.may = Array.isArray(message['may']) ? (message['may'] as string[]) : undefined;
            this.user = String(message['user'] ?? '');
            this.login = message['login'] === true;
            this.source = String(message['source'] ?? '');
            this.why_not_lcm = String(message['why_not_lcm'] ?? '');
            this.version = String(message['version'] ?? '');
            this.machines = (message['machines'] as typeof this.machines | undefined) ?? [];
            this.machine = String(message['machine'] ?? '');
            if (this.machine !== before || !this.layout) {
                this.state = undefined;
                this.fresh_at = 0;
            }
        } else if (message['type'] === 'state') {
            if (message['machine'] !== undefined && message['machine'] !== this.machine) return;
            const state = message['state'] as MachineState;
            this.came_.push(performance.now());
            if (this.came_.length > most_counted) this.came_.shift();
            this.why_stale = '';
            this.lost = Number(message['lost'] ?? 0);
            this.refused = Number(message['refused'] ?? 0);
            if (this.state?.cycle !== state.cycle) {
                const age = Number(message['age_ms'] ?? 0);
                this.fresh_at = performance.now() - age;
                this.fresh_since = new Date(Date.now() - age);
            }
            this.state = state;
        } else if (message['type'] === 'stale') {
            this.why_stale = String(message['why'] ?? '');
        } else if (message['type'] === 'answer' || message['type'] === 'error') {
            this.answer(Number(message['id']), { ...message, ok: message['ok'] === true });
            return;
        } else return;
        this.on_change();
    }

    private answer(id: number, answer: Answer): void {
        const waiting = this.waiting_.get(id);
        if (!waiting) return;
        this.waiting_.delete(id);
        clearTimeout(waiting.timer);
        waiting.resolve(answer);
    }
}

const lost: Answer = { ok: false, error: { code: 'page.no_connection', what: '' } };
const silent: Answer = { ok: false, error: { code: 'page.no_answer', what: '' } };
