// Jog is pressed and held. Whatever ends the holding ends the jog: this class is where each ending meets; the lease in the machine's cycle is
// what holds when this page itself is gone (hmi_bridge/README.md).

export type Ending =
    | 'released' | 'slid_off' | 'cancelled' | 'capture_lost' | 'blur' | 'hidden' | 'second_pointer' | 'socket' | 'late' | 'unanswered' | 'refused' | 'stale' | 'gone' | 'stopped';

export interface JogWire {
    /** One jog request; press at the first. Resolves to whether it was accepted. */
    jog(axis: string, velocity: number, press: boolean): Promise<boolean>;
    /** No connection, or bytes that do not leave. */
    blocked(): boolean;
    stale(): boolean;
}

export interface Clock {
    now(): number;
    every(period: number, step: () => void): () => void;
}

/** ms: the lease is renewed this often ... */
export const renewal = 50;
/** ... and a renewal that comes this late comes from a page that stood still: nobody knows whether the finger is still there. */
export const latest_renewal = 200;
/** Renewals without an answer: a server that hangs. */
export const most_unanswered = 4;

/** px: a finger is broad, and rolls. */
const slack = 12;

export class JogHold {
    /** Who is told that it ended, and why. */
    on_end: (ending: Ending) => void = () => undefined;

    private held_: { axis: string; velocity: number; at: number; unanswered: number; stop: () => void } | undefined;

    constructor(private readonly wire_: JogWire, private readonly clock_: Clock) {}

    get axis(): string | undefined {
        return this.held_?.axis;
    }

    /** A press while another holds is a second hand: it ends the first and begins nothing. What begins nothing for another reason is told as if it had ended. */
    press(axis: string, velocity: number): boolean {
        if (this.held_) {
            this.end('second_pointer');
            return false;
        }
        if (velocity === 0 || !Number.isFinite(velocity)) return false;
        if (this.wire_.blocked() || this.wire_.stale()) {
            this.on_end(this.wire_.blocked() ? 'socket' : 'stale');
            return false;
        }
        const held = { axis, velocity, at: this.clock_.now(), unanswered: 0, stop: () => undefined as void };
        this.held_ = held;
        held.stop = this.clock_.every(renewal, () => this.renew());
        this.send(true);
        return true;
    }

    end(ending: Ending): void {
        const held = this.held_;
        if (!held) return;
        this.held_ = undefined;
        held.stop();
        void this.wire_.jog(held.axis, 0, false);  // without a connection it goes nowhere, and the lease does it
        this.on_end(ending);
    }

    private renew(): void {
        const held = this.held_;
        if (!held) return;
        const since = this.clock_.now() - held.at;
        held.at = this.clock_.now();
        if (since > latest_renewal) this.end('late');
        else if (this.wire_.blocked()) this.end('socket');
        else if (this.wire_.stale()) this.end('stale');
        else if (held.unanswered >= most_unanswered) this.end('unanswered');
        else this.send(false);
    }

    private send(press: boolean): void {
        const held = this.held_;
        if (!held) return;
        held.unanswered++;
        void this.wire_.jog(held.axis, held.velocity, press).then((accepted) => {
            if (this.held_ !== held) return;
            held.unanswered = 0;
            if (!accepted) this.end('refused');
        });
    }
}

/** Makes a button hold a jog: by one pointer, or by the space bar or Enter. */
export function hold_to_jog(button: HTMLButtonElement, hold: JogHold, axis: () => string, velocity: () => number): void {
    let pointer: number | undefined;
    let key: string | undefined;
    button.addEventListener('pointerdown', (event) => {
        if (event.button !== 0 || button.disabled) return;
        event.preventDefault();
        button.focus();
        if (!hold.press(axis(), velocity())) return;
        pointer = event.pointerId;
        try {
            button.setPointerCapture(event.pointerId);
        } catch {
            hold.end('capture_lost');  // the finger is gone already
        }
    });
    const leave = (ending: Ending) => (event: PointerEvent) => {
        if (event.pointerId !== pointer) return;
        pointer = undefined;
        hold.end(ending);
    };
    button.addEventListener('pointerup', leave('released'));
    // The capture keeps the pointer's messages coming, so the button sees that the finger is on it no more.
    button.addEventListener('pointermove', (event) => {
        const box = button.getBoundingClientRect();
        if (event.clientX < box.left - slack || event.clientX > box.right + slack || event.clientY < box.top - slack || event.clientY > box.bottom + slack) leave('slid_off')(event);
    });
    button.addEventListener('pointercancel', leave('cancelled'));
    button.addEventListener('lostpointercapture', leave('capture_lost'));
    button.addEventListener('contextmenu', (event) => event.preventDefault());  // a long press on a touch screen
    button.addEventListener('keydown', (event) => {
        if (event.key !== ' ' && event.key !== 'Enter') {
            if (key !== undefined) hold.end('second_pointer');
            key = undefined;
            return;
        }
        event.preventDefault();
        if (event.repeat || button.disabled) return;
        if (hold.press(axis(), velocity())) key = event.key;
        else key = undefined;
    });
    button.addEventListener('keyup', (event) => {
        if (event.key !== key) return;
        event.preventDefault();
        key = undefined;
        hold.end('released');
    });
    button.addEventListener('blur', () => {
        key = undefined;
        pointer = undefined;
        hold.end('blur');
    });
}

/** Endings that no button sees. */
export function watch_page(hold: JogHold): void {
    window.addEventListener('blur', () => hold.end('blur'));
    window.addEventListener('pagehide', () => hold.end('gone'));
    document.addEventListener('freeze', () => hold.end('gone'));
    document.addEventListener('visibilitychange', () => {
        if (document.visibilityState !== 'visible') hold.end('hidden');
    });
    // Any finger, mouse or pen that goes down while an axis is held is a second one, wherever it lands; it presses nothing else.
    document.addEventListener('pointerdown', (event) => {
        if (hold.axis === undefined) return;
        event.preventDefault();
        event.stopPropagation();
        hold.end('second_pointer');
    }, { capture: true });
}
