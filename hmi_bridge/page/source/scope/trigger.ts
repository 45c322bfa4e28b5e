// A trigger as a person sets it, as the machine is asked for it, and what came of it. It is found by the machine, on every sample.

export const trigger_kinds = ['rising', 'falling', 'either', 'above', 'below', 'inside', 'outside', 'bit', 'alarm'] as const;
export type TriggerKind = (typeof trigger_kinds)[number];
export const trigger_modes = ['single', 'normal', 'auto'] as const;
export type TriggerMode = (typeof trigger_modes)[number];

export interface Trigger {
    kind: TriggerKind;
    signal: string;
    level: number;
    level2: number;
    bit: number;
    /** Empty: any alarm that stops. */
    alarm: string;
    mode: TriggerMode;
    /** Seconds that are shown, the part of them before the trigger, and how long none is looked for afterwards. */
    length_s: number;
    before_percent: number;
    holdoff_s: number;
}

export const first_trigger = (): Trigger => ({ kind: 'rising', signal: '', level: 0.5, level2: 1, bit: 0, alarm: '', mode: 'single', length_s: 1, before_percent: 20, holdoff_s: 0 });

export const has_level = (kind: TriggerKind): boolean => kind !== 'bit' && kind !== 'alarm';
export const has_window = (kind: TriggerKind): boolean => kind === 'inside' || kind === 'outside';

/** What is wrong with it, as the key of a text; undefined: it may be asked for. */
export function trouble(trigger: Trigger, known: (name: string) => boolean): 'scope_trigger_no_signal' | 'scope_trigger_no_number' | 'scope_trigger_order' | 'scope_trigger_bit_range' | 'scope_trigger_length' | undefined {
    if (trigger.kind !== 'alarm' && !known(trigger.signal)) return 'scope_trigger_no_signal';
    if (has_level(trigger.kind) && (!Number.isFinite(trigger.level) || (has_window(trigger.kind) && !Number.isFinite(trigger.level2)))) return 'scope_trigger_no_number';
    if (has_window(trigger.kind) && !(trigger.level < trigger.level2)) return 'scope_trigger_order';
    if (trigger.kind === 'bit' && !(Number.isInteger(trigger.bit) && trigger.bit >= 0 && trigger.bit <= 52)) return 'scope_trigger_bit_range';
    if (!(trigger.length_s > 0) || !(trigger.before_percent >= 0 && trigger.before_percent <= 100) || !(trigger.holdoff_s >= 0)) return 'scope_trigger_length';
    return undefined;
}

export function arm_request(trigger: Trigger, cycle_ns: number): { cmd: string } & Record<string, unknown> {
    const cycles = (seconds: number): number => Math.round((seconds * 1e9) / cycle_ns);
    const when: Record<string, unknown> = { kind: trigger.kind };
    if (trigger.kind === 'alarm') when['alarm'] = trigger.alarm;
    else when['signal'] = trigger.signal;
    if (has_level(trigger.kind)) when['level'] = trigger.level;
    if (has_window(trigger.kind)) when['level2'] = trigger.level2;
    if (trigger.kind === 'bit') when['bit'] = trigger.bit;
    const length = Math.max(2, cycles(trigger.length_s)), pre = Math.min(length - 1, Math.round((length * trigger.before_percent) / 100));
    return { cmd: 'scope_arm', when, pre, post: length - pre, mode: trigger.mode, holdoff: cycles(trigger.holdoff_s) };
}

export interface TriggerEvent {
    cycle: number;
    from: number;
    to: number;
    complete: boolean;
    automatic: boolean;
}
export interface TriggerState {
    armed: boolean;
    looked_to: number;
    events: TriggerEvent[];
}

/** The newest event that is whole and not shown yet. */
export function next_event(state: TriggerState, shown_cycle: number): TriggerEvent | undefined {
    return [...state.events].reverse().find((event) => event.complete && event.cycle > shown_cycle);
}
export function status_of(state: TriggerState | undefined): 'off' | 'waiting' | 'filling' | 'triggered' {
    if (!state) return 'off';
    const last = state.events[state.events.length - 1];
    if (last && !last.complete) return 'filling';
    if (state.armed) return 'waiting';
    return last ? 'triggered' : 'off';
}
