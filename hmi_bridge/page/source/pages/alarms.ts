// What stands, in words, with cause and remedy; and what the machine refused.
import { in_words, key_of, stops, where } from '../alarm_words';
import { Desk, Page, panel } from '../desk';
import { duration } from '../numbers';
import { said, said_element, write_said } from '../sentences/said';
import { CommandEvent, MachineState } from '../state';
import { say, word } from '../texts';
import { element, mark, Rows, write } from '../view';
import { alarm_history } from './alarm_history';
import { alarm_tabs, recording_link } from './alarm_parts';

/** `#alarms`: what stands; `#alarms/history`: what stood. */
export function alarms(desk: Desk, [kind = '']: readonly string[]): Page {
    return kind === 'history' ? alarm_history(desk) : standing_alarms(desk);
}

function standing_alarms(desk: Desk): Page {
    const acknowledge = desk.button('acknowledge', () => ({ cmd: 'acknowledge' }), 'primary');
    const reset = desk.button('reset_all', () => ({ cmd: 'reset' }));
    const none = element('p', { class: 'calm' }, `✓ ${say('no_alarms')}`);
    const list = element('div', { class: 'alarm-list' });
    const rows = new Rows(list, key_of, (alarm) => {
        const status = element('span', { class: 'alarm-status' }), since = element('span', { class: 'alarm-since' }), recorded = element('p', { class: 'recorded' });
        const root = element('article', { class: 'alarm', 'data-alarm': alarm.name },
            element('header', {}, status, element('strong', {}, where(alarm.source)), since),
            element('p', { class: 'alarm-text' }, in_words(alarm)),
            element('dl', { class: 'values' }, element('dt', {}, say('cause')), said_element('dd', alarm.cause), element('dt', {}, say('remedy')),
                said_element('dd', alarm.remedy), element('dt', {}, say('how_to_reset')), said_element('dd', alarm.reset),
                element('dt', {}, say('reaction')), element('dd', {}, word('reaction', alarm.reaction), ' · ', element('span', { lang: 'en' }, alarm.name)),
                ...(alarm.manual ? [element('dt', {}, say('manual')), element('dd', {}, alarm.manual)] : [])), recorded);
        return { root, status, since, recorded };
    }, (row, alarm) => {
        write(row.status, alarm.standing ? `⚠ ${say('standing')}` : `○ ${say('gone')}`);
        mark(row.root, 'data-tone', alarm.standing ? (stops(alarm) ? 'bad' : 'warn') : 'idle');
        if (alarm.recording && row.recorded.childElementCount === 0) row.recorded.append(recording_link(alarm.recording));
        const age = ((desk.link.state?.time_ns ?? 0) - alarm.since_ns) / 1e9;
        write(row.since, say('ago', { age: duration(Math.max(0, age)) }) + (alarm.count > 1 ? ` · ${say('count')} ${alarm.count}` : ''));
    });
    const calm = element('p', { class: 'hint' }, say('no_refusals'));
    const events = element('div', { class: 'event-list' });
    const event_rows = new Rows(events, (event: CommandEvent) => String(event.number), () => {
        const when = element('span', { class: 'alarm-since' }), what = element('span'), remedy = element('small');
        return { root: element('div', { class: 'event' }, when, what, remedy), when, what, remedy };
    }, (row, event) => {
        write(row.when, say('ago', { age: duration(Math.max(0, ((desk.link.state?.time_ns ?? 0) - event.time_ns) / 1e9)) }) + (event.times > 1 ? ` ×${event.times}` : ''));
        const { text, known } = said(event.english);
        write(row.what, `${event.axis || event.group ? (event.axis || event.group) + ': ' : ''}${text}`);
        mark(row.what, 'lang', known ? false : 'en');
        write_said(row.remedy, event.remedy);
    });
    return {
        root: element('div', { class: 'page alarms' }, element('div', { class: 'bar' }, alarm_tabs('standing'), element('span', { class: 'space' }), acknowledge, reset), none, list, panel('refusals', calm, events)),
        update(state: MachineState) {
            const known = [...state.alarms].sort((a, b) => Number(b.standing) - Number(a.standing) || b.since_ns - a.since_ns);
            rows.update(known);
            event_rows.update([...state.events].reverse());
            none.hidden = known.length > 0;
            calm.hidden = state.events.length > 0;
            desk.permit(acknowledge, 'acknowledge', known.length > 0);
            desk.permit(reset, 'reset');
        },
    };
}
