// Every text of the page, once, a file a room: English, Chinese. A test completes it: each word that the runtime can say has a line, no line lacks a
// language, no key stands in two rooms.
import { alarms } from './texts/alarms';
import { axis } from './texts/axis';
import { bus } from './texts/bus';
import { frame } from './texts/frame';
import { group } from './texts/group';
import { io } from './texts/io';
import { measure } from './texts/measure';
import { programs } from './texts/programs';
import { scope } from './texts/scope';
import { system } from './texts/system';
import { view } from './texts/view';
import { why } from './texts/why';

export type Language = 'en' | 'zh';
/** A room a line, in alphabetical order. */
export const rooms = {
    alarms,
    axis,
    bus,
    frame,
    group,
    io,
    measure,
    programs,
    scope,
    system,
    view,
    why,
};
export type Key = { [Room in keyof typeof rooms]: keyof (typeof rooms)[Room] }[keyof typeof rooms];
export const texts = Object.assign({}, ...Object.values(rooms)) as Record<Key, readonly [string, string]>;

let language: Language = 'en';
export const current_language = (): Language => language;
export function choose_language(chosen: Language): void {
    language = chosen;
}

/** The text, with {name} replaced. */
export function say(key: Key, values: Record<string, string> = {}): string {
    return texts[key][language === 'en' ? 0 : 1].replace(/\{(\w+)\}/g, (whole, name: string) => values[name] ?? whole);
}

/** The text of a word that the runtime says; a word from a newer runtime is shown as it came. */
export function word(group: string, of: string): string {
    const key = `${group}_${of}`;
    return Object.hasOwn(texts, key) ? say(key as Key) : of;
}
