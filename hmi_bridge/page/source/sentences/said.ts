// What the machine says in English alone, in the language of the page: the sentences of its alarm tables, drive files and refusals. A sentence that nobody knows
// stays as it came, marked as English.
import { current_language } from '../texts';
import { element, mark, write } from '../view';
import { axis_alarms } from './axis_alarms';
import { axis_errors } from './axis_errors';
import { bus_alarms } from './bus_alarms';
import { drive_cia402 } from './drive_cia402';
import { drive_se_808x } from './drive_se_808x';
import { drive_sv33_e } from './drive_sv33_e';
import { drive_sv_da200 } from './drive_sv_da200';
import { drive_tsvm_d6 } from './drive_tsvm_d6';
import { drive_xp200 } from './drive_xp200';
import { machine_alarms } from './machine_alarms';
import { refusals } from './refusals';

export const sentences: Readonly<Record<string, string>> = {
    ...drive_cia402, ...drive_se_808x, ...drive_sv_da200, ...drive_sv33_e, ...drive_tsvm_d6, ...drive_xp200, ...axis_errors, ...bus_alarms, ...axis_alarms, ...machine_alarms, ...refusals,
};

/** `{}`, and `{a} u/s` of an alarm table with the unit of its axis. */
const place = /\{[ab]?\}(?: u(?:\/s)?)?/g;
interface Pattern {
    english: RegExp;
    chinese: string;
    /** Nothing but places and signs: it says something only where a part of it is known. */
    bare: boolean;
}
const patterns: Pattern[] = Object.entries(sentences).filter(([english]) => english.search(place) >= 0).map(([english, chinese]) => ({
    english: new RegExp(`^${english.split(place).map((text) => text.replace(/[.*+?^$()|[\]\\{}]/g, '\\$&')).join('(.+?)')}$`, 's'), chinese, bare: !/[a-z]/i.test(english.replace(place, '')),
}));
/** Deeper than any sentence of the machine is made. */
const deepest = 6;

/** Undefined: nobody knows it. */
export function in_chinese(english: string, depth = 0): string | undefined {
    const stopped = english.endsWith('.') && !english.endsWith('..'), text = stopped ? english.slice(0, -1) : english;
    const end = stopped ? '。' : '';
    if (Object.hasOwn(sentences, text)) return sentences[text] + end;
    if (depth >= deepest) return undefined;
    for (const pattern of patterns) {
        const found = pattern.english.exec(text);
        if (!found) continue;
        const known = found.slice(1).map((part) => in_chinese(part, depth + 1)), parts = known.map((part, i) => part ?? found[i + 1] ?? '');
        if (pattern.bare && known.every((part) => part === undefined)) continue;
        let next = 0;
        return pattern.chinese.replace(/\{(\d|[ab])?\}(?: u(?:\/s)?)?/g, (_whole, number: string | undefined) => parts[/\d/.test(number ?? '') ? Number(number) : next++] ?? '') + end;
    }
    return undefined;
}

const looked_up = new Map<string, string | undefined>();
const most_kept = 500;

/** In the language of the page; `known`: it is not English left over. */
export function said(english: string): { text: string; known: boolean } {
    if (current_language() !== 'zh') return { text: english, known: true };
    if (!looked_up.has(english)) {
        if (looked_up.size >= most_kept) looked_up.clear();
        looked_up.set(english, in_chinese(english));
    }
    const chinese = looked_up.get(english);
    return { text: chinese ?? english, known: chinese !== undefined };
}
/** Writes it, and marks what stayed English as that. */
export function write_said(to: HTMLElement, english: string): void {
    const { text, known } = said(english);
    write(to, text);
    mark(to, 'lang', known || text === '' ? false : 'en');
}
export function said_element<K extends keyof HTMLElementTagNameMap>(tag: K, english: string, attributes: Record<string, string> = {}): HTMLElementTagNameMap[K] {
    const made = element(tag, attributes);
    write_said(made, english);
    return made;
}
