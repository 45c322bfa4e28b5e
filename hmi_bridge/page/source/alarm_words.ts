// What an alarm says, in the language of the page, and how grave it is.
import { Alarm, MachineState } from './state';
import { current_language, word } from './texts';

export const in_words = (alarm: Alarm): string => (current_language() === 'zh' && alarm.chinese ? alarm.chinese : alarm.english);
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
