// A set-up: what is shown and how, as it is saved in the browser and in files. What comes from a file is a stranger's: each key is looked at.
import { Window, windows } from './fft';
import { Range } from './lanes';
import { Channel } from './signals';
import { first_trigger, Trigger, trigger_kinds, trigger_modes } from './trigger';

export interface Setup {
    channels: Channel[];
    /** Lanes whose scale was set by hand, by their key. */
    scales: Record<string, Range>;
    span_s: number;
    trigger: Trigger;
    view: SetupView;
    xy: { x: string; y: string; square: boolean };
    spectrum: { lane: string; window: Window; decibel: boolean };
}
export const setup_views = ['time', 'xy', 'spectrum'] as const;
export type SetupView = (typeof setup_views)[number];

export const most_channels = 256;
export const empty_setup = (): Setup => ({ channels: [], scales: {}, span_s: 10, trigger: first_trigger(), view: 'time', xy: { x: '', y: '', square: false }, spectrum: { lane: '', window: 'hann', decibel: false } });

export const to_text = (setup: Setup): string => JSON.stringify({ taktwerk_scope: 1, ...setup }, null, 1);

type Json = Record<string, unknown>;
const object = (of: unknown): Json => (typeof of === 'object' && of !== null && !Array.isArray(of) ? (of as Json) : {});
const real = (of: unknown, otherwise: number): number => (typeof of === 'number' && Number.isFinite(of) ? of : otherwise);
const text = (of: unknown): string => (typeof of === 'string' ? of.slice(0, 200) : '');
const whole = (of: unknown, most: number): number | undefined => (typeof of === 'number' && Number.isInteger(of) && of >= 0 && of <= most ? of : undefined);

/** Undefined: no set-up at all. */
export function from_text(given: string): Setup | undefined {
    let all: Json;
    try {
        all = object(JSON.parse(given));
    } catch {
        return undefined;
    }
    if (all['taktwerk_scope'] !== 1 || !Array.isArray(all['channels'])) return undefined;
    const setup = empty_setup();
    for (const one of all['channels'].slice(0, most_channels)) {
        const { name, bit, offset, hidden, colour, apart } = object(one);
        if (text(name) === '') continue;
        const place = whole(bit, 52);
        setup.channels.push({ name: text(name), ...(place === undefined ? {} : { bit: place }), offset: real(offset, 0), hidden: hidden === true, colour: whole(colour, 1000) ?? setup.channels.length, apart: apart === true });
    }
    for (const [key, range] of Object.entries(object(all['scales']))) {
        const { min, max } = object(range);
        if (typeof min === 'number' && typeof max === 'number' && Number.isFinite(min) && Number.isFinite(max) && min < max && key !== '__proto__') setup.scales[key] = { min, max };
    }
    setup.span_s = Math.min(3600, Math.max(1e-4, real(all['span_s'], 10)));
    const trigger = object(all['trigger']), mine = setup.trigger;
    mine.kind = trigger_kinds.find((k) => k === trigger['kind']) ?? mine.kind;
    mine.mode = trigger_modes.find((m) => m === trigger['mode']) ?? mine.mode;
    mine.signal = text(trigger['signal']);
    mine.alarm = text(trigger['alarm']);
    for (const key of ['level', 'level2', 'bit', 'length_s', 'before_percent', 'holdoff_s'] as const) mine[key] = real(trigger[key], mine[key]);
    setup.view = setup_views.find((v) => v === all['view']) ?? 'time';
    const xy = object(all['xy']), lines = object(all['spectrum']);
    setup.xy = { x: text(xy['x']), y: text(xy['y']), square: xy['square'] === true };
    setup.spectrum = { lane: text(lines['lane']), window: windows.find((w) => w === lines['window']) ?? 'hann', decibel: lines['decibel'] === true };
    return setup;
}

const place = 'scope_setups';
const last_place = 'scope_last';

/** The named ones of this browser; one that cannot be read is left out. */
export class SavedSetups {
    constructor(private readonly storage_: Pick<Storage, 'getItem' | 'setItem'>) {}

    list(): Map<string, Setup> {
        const out = new Map<string, Setup>();
        try {
            for (const [name, given] of Object.entries(object(JSON.parse(this.storage_.getItem(place) ?? '{}')))) {
                const setup = from_text(text_of(given));
                if (setup) out.set(name, setup);
            }
        } catch { /* somebody else's text, or a browser that keeps nothing */ }
        return out;
    }
    save(name: string, setup: Setup): boolean {
        return this.write(new Map([...this.list(), [name, setup]]));
    }
    remove(name: string): boolean {
        const all = this.list();
        all.delete(name);
        return this.write(all);
    }
    /** What was shown when the page was left. */
    get last(): Setup | undefined {
        try {
            return from_text(this.storage_.getItem(last_place) ?? '');
        } catch {
            return undefined;
        }
    }
    set last(setup: Setup | undefined) {
        try {
            if (setup) this.storage_.setItem(last_place, to_text(setup));
        } catch { /* a browser that keeps nothing */ }
    }
    private write(all: Map<string, Setup>): boolean {
        try {
            this.storage_.setItem(place, JSON.stringify(Object.fromEntries([...all].map(([name, setup]) => [name, JSON.parse(to_text(setup)) as unknown]))));
            return true;
        } catch {
            return false;
        }
    }
}
const text_of = (given: unknown): string => JSON.stringify(given);
