// What stood before, also before a restart: filtered by the machine, newest first; one click opens what was recorded around it.
import { in_words, where } from '../alarm_words';
import { Desk, Page } from '../desk';
import { Inquiry } from '../inquiry';
import { Request } from '../link';
import { duration } from '../numbers';
import { csv, file_time, local_time, save_file } from '../save';
import { said, said_element } from '../sentences/said';
import { MachineState } from '../state';
import { Key, say, word } from '../texts';
import { element, mark, Rows, write } from '../view';
import { alarm_tabs, recording_link } from './alarm_parts';

export interface PastAlarm {
    id: number;
    utime: number;
    /** When its condition went; null: it has not, or nobody knows. */
    cleared_utime: number | null;
    /** `stands`, `waits` for a person, `gone`, `unknown`: the runtime ended meanwhile. */
    state: string;
    name: string;
    source: string;
    english: string;
    chinese: string;
    cause: string;
    remedy: string;
    reaction: string;
    manual: string;
    recording: string;
}

const page_size = 100;
const most_exported = 20_000;
const refresh_ms = 5000;
const periods: [Key, number][] = [['period_all', 0], ['period_hour', 3600], ['period_day', 86_400], ['period_week', 7 * 86_400], ['period_month', 30 * 86_400]];

export const in_language = (alarm: PastAlarm): string => in_words(alarm);

/** Where an alarm may stand, as the machine says it. */
const sources = ({ link: { layout } }: Desk): string[] => ['machine', 'bus', ...(layout?.axes ?? []).map((axis) => `axis ${axis.name}`), ...(layout?.slaves ?? []).map((slave) => `slave '${slave}'`),
    ...(layout?.programs ?? []).map((program) => `program ${program}`)];

export function alarm_history(desk: Desk): Page {
    let listed: PastAlarm[] = [];
    let whole = false, refusal = '';
    const text = element('input', { type: 'search', 'aria-label': say('filter'), placeholder: say('filter_text'), 'data-input': 'text' });
    const source = element('select', { 'aria-label': say('source'), 'data-input': 'source' }, element('option', { value: '' }, say('every_source')),
        ...sources(desk).map((source) => element('option', { value: source }, where(source))));
    const period = element('select', { 'aria-label': say('period'), 'data-input': 'period' }, ...periods.map(([key, seconds]) => element('option', { value: String(seconds) }, say(key))));
    const question = (more: object = {}): Request => {
        const seconds = Number(period.value), wanted = text.value.trim();
        return { cmd: 'alarm_history', limit: page_size, ...(wanted ? { text: wanted } : {}), ...(source.value ? { source: source.value } : {}), ...(seconds ? { since_utime: (Date.now() - seconds * 1000) * 1000 } : {}), ...more };
    };
    const inquiry = new Inquiry(desk, question, refresh_ms, (answer) => {
        refusal = answer.ok ? '' : `${answer.error?.what ?? ''} ${answer.error?.remedy ?? ''}`;
        if (!answer.ok) return show();
        const newest = (answer['alarms'] as PastAlarm[] | undefined) ?? [];
        const oldest = newest.at(-1)?.id ?? 0;
        if (listed.length <= page_size) whole = answer['more'] !== true;
        listed = [...newest, ...listed.filter((alarm) => alarm.id < oldest && newest.length > 0)];
        show();
    });
    const anew = (): void => {
        listed = [];
        inquiry.ask();
    };
    for (const field of [text, source, period]) field.addEventListener('input', anew);
    const older = async (): Promise<void> => {
        const answer = await desk.link.request(question({ before: listed.at(-1)?.id }));
        if (!answer.ok) desk.refused(answer);
        listed = [...listed, ...((answer['alarms'] as PastAlarm[] | undefined) ?? [])];
        whole = answer['more'] !== true;
        show();
    };
    const more = element('button', { type: 'button', 'data-do': 'older', onclick: () => void older() }, say('older_alarms'));
    const save = element('button', { type: 'button', 'data-do': 'export', onclick: () => void export_all() }, say('export_csv'));
    const export_all = async (): Promise<void> => {
        while (listed.length < most_exported && !whole && desk.link.opened) await older();
        save_file(`${desk.link.machine}-alarms-${file_time()}.csv`, 'text/csv', csv([(['since', 'until', 'source', 'text', 'name', 'reaction', 'cause', 'remedy', 'manual', 'recording'] as const).map((key) => say(key)),
            ...listed.map((alarm) => [local_time(alarm.utime), alarm.cleared_utime ? local_time(alarm.cleared_utime) : '', where(alarm.source), in_language(alarm), alarm.name, word('reaction', alarm.reaction), said(alarm.cause).text, said(alarm.remedy).text, alarm.manual, alarm.recording])]));
    };

    const body = element('tbody');
    const rows = new Rows(body, (alarm: PastAlarm) => String(alarm.id), (alarm) => {
        const lasted = element('td', { class: 'number' });
        const details = element('details', {}, element('summary', {}, in_language(alarm)), element('dl', { class: 'values words' }, element('dt', {}, say('cause')), said_element('dd', alarm.cause || '–'),
            element('dt', {}, say('remedy')), said_element('dd', alarm.remedy || '–'), ...(alarm.manual ? [element('dt', {}, say('manual')), element('dd', {}, alarm.manual)] : []),
            element('dt', {}, say('reaction')), element('dd', {}, word('reaction', alarm.reaction), ' · ', element('span', { lang: 'en' }, alarm.name))));
        const root = element('tr', { 'data-past-alarm': alarm.name }, element('td', { class: 'number' }, local_time(alarm.utime)), lasted, element('th', { scope: 'row' }, where(alarm.source)), element('td', {}, details),
            element('td', {}, recording_link(alarm.recording)));
        return { root, lasted };
    }, (row, alarm) => {
        write(row.lasted, alarm.cleared_utime !== null ? duration((alarm.cleared_utime - alarm.utime) / 1e6) : alarm.state === 'stands' ? `⚠ ${say('standing')}` : say('not_known_when'));
        mark(row.lasted, 'data-tone', alarm.state === 'stands' ? 'bad' : false);
    });
    const none = element('p', { class: 'hint' });
    const show = (): void => {
        rows.update(listed);
        write(none, inquiry.unknown ? say('not_known') : refusal || (listed.length === 0 && inquiry.answer ? say('no_past_alarms') : ''));
        more.hidden = whole || listed.length === 0;
        save.disabled = listed.length === 0;
    };
    show();
    return {
        root: element('div', { class: 'page alarms history' }, element('div', { class: 'bar' }, alarm_tabs('history'), text, source, period, element('span', { class: 'space' }), save),
            element('section', { class: 'panel' }, none, element('table', { class: 'past' }, element('thead', {}, element('tr', {}, ...(['since', 'lasted', 'source', 'text', 'recording'] as const).map((key) => element('th', { scope: 'col' }, say(key))))), body),
                element('div', { class: 'buttons' }, more))),
        update(_state: MachineState) {
            inquiry.step();
            if (inquiry.unknown) show();
        },
        leave: () => inquiry.leave(),
    };
}
