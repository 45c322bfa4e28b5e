// What can be looked at: the signals of a machine, a recording or a file, as scope_signals tells them; and how they are found.
import { Language } from '../texts';

export type Kind = 'real' | 'bit' | 'state' | 'whole' | 'word';

export interface Signal {
    name: string;
    unit: string;
    kind: Kind;
    group: string;
    /** The axis, program, point or task that it belongs to. */
    of: string;
    states?: Record<string, string>;
    en: string;
    zh: string;
}

/** A curve: a signal, or one bit of a word. */
export interface Channel {
    name: string;
    bit?: number;
    offset: number;
    hidden: boolean;
    /** Place in the list of colours. */
    colour: number;
    /** A lane of its own beside those of its unit. */
    apart: boolean;
}

export const key_of = (channel: { name: string; bit?: number | undefined }): string => (channel.bit === undefined ? channel.name : `${channel.name}.${channel.bit}`);
export const is_digital = (channel: Channel, signal: Signal | undefined): boolean => channel.bit !== undefined || signal?.kind === 'bit' || signal?.kind === 'state';
export const meaning = (signal: Signal, language: Language): string => (language === 'zh' && signal.zh ? signal.zh : signal.en);
export const state_name = (signal: Signal | undefined, value: number): string => signal?.states?.[String(value)] ?? String(value);

/** The bit of a word, which may be negative; NaN stays. */
export const bit_of = (word: number, bit: number): number => (Number.isNaN(word) ? NaN : Math.floor(word / 2 ** bit) & 1);

/** Every word of the search stands in the name, the unit or a meaning. */
export function matches(signal: Signal, search: string): boolean {
    const text = `${signal.name} ${signal.unit} ${signal.en} ${signal.zh} ${signal.of}`.toLowerCase();
    return search.toLowerCase().split(/\s+/).every((word) => text.includes(word));
}

export interface Branch {
    group: string;
    of: string;
    signals: Signal[];
}
const group_order = ['axis', 'input', 'output', 'variable', 'machine', 'task', 'bus'];

/** By group, then by what they belong to, in the machine's order. */
export function tree(signals: readonly Signal[], search: string): Branch[] {
    const branches = new Map<string, Branch>();
    for (const signal of signals) {
        if (!matches(signal, search)) continue;
        // Points and tasks are one signal each.
        const of = ['input', 'output', 'task'].includes(signal.group) ? '' : signal.of, key = `${signal.group}/${of}`;
        let branch = branches.get(key);
        if (!branch) branches.set(key, (branch = { group: signal.group, of, signals: [] }));
        branch.signals.push(signal);
    }
    const place = (group: string): number => (group_order.indexOf(group) + group_order.length + 1) % (group_order.length + 1);
    return [...branches.values()].sort((a, b) => place(a.group) - place(b.group));
}

/** What somebody wants to see who has chosen nothing: how the axis follows. */
export function first_choice(signals: readonly Signal[], axis = ''): string[] {
    const name = axis || signals.find((s) => s.group === 'axis')?.of || '';
    const wanted = ['set_position', 'actual_position', 'set_velocity', 'actual_velocity', 'following_error', 'state'].map((q) => `${name}.${q}`);
    const found = wanted.filter((w) => signals.some((s) => s.name === w));
    return found.length > 0 ? found : signals.slice(0, 4).map((s) => s.name);
}
