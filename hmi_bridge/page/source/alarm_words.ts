// What an alarm says, in the language of the page, and how grave it is.
import { said } from './sentences/said';
import { Alarm, MachineState } from './state';
import { current_language, word } from './texts';

export function in_words(alarm: Pick<Alarm, 'english' | 'chinese'>): string {
    if (current_language() !== 'zh' || !alarm.chinese) return alarm.english;
    const at = alarm.chinese.indexOf(':'), more = alarm.chinese.slice(at + 1);  // where on the bus: said in English behind the table's text
    return at < 0 ? alarm.chinese : alarm.chinese.slice(0, at + 1) + said(more).text;
}
/** `axis x`, `machine`, ...: the kind in the language of the page, the name as it is. */
export function where(source: string): string {
    const [kind = '', ...name] = source.split(' ');
    return [word('source', kind), ...name].join(' ');
}
/** It stops something, so it comes first. */
export const stops = (alarm: Alarm): boolean => alarm.reaction !== 'warn' && alarm.reaction !== 'none';
export const key_of = (alarm: Alarm): string => `${alarm.id}/${alarm.source}/${alarm.name}/${alarm.english}`;
/** Those of one axis that stand, the grave ones first. */
export const alarms_of_axis = (machine: MachineState, axis: string): Alarm[] =>
    machine.alarms.filter((alarm) => alarm.standing && alarm.source === `axis ${axis}`).sort((a, b) => Number(stops(b)) - Number(stops(a)));
