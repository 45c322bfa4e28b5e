// What the alarms that stand and those that stood have in common.
import { sub_tabs } from '../desk';
import { say } from '../texts';
import { element } from '../view';

export const alarm_tabs = (shown: 'standing' | 'history'): HTMLElement => sub_tabs('alarms', [['alarms', 'alarms_standing'], ['alarms/history', 'alarms_history']], shown === 'standing' ? 'alarms' : 'alarms/history');
/** One click opens what was recorded around the alarm, in the scope. */
export function recording_link(name: string | undefined): HTMLElement {
    return name ? element('a', { class: 'row-link', href: `#scope/recording/${encodeURIComponent(name)}`, 'data-recording': name }, say('open_recording')) : element('span', {}, '–');
}
