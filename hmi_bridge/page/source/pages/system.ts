// What runs here, since when, how far away it is; what this page has commanded; what was recorded; whose work is used.
import { where } from '../alarm_words';
import { Desk, Given, Page, panel, table, Values } from '../desk';
import { Inquiry } from '../inquiry';
import { Licence, page_licences } from '../licences';
import { duration } from '../numbers';
import { local_time } from '../save';
import { said_element } from '../sentences/said';
import { copy_button } from '../recording_copy';
import { MachineState } from '../state';
import { say, word } from '../texts';
import { element, mark, Rows, write } from '../view';
import { write_cycle } from './overview';

interface Recorded {
    name: string;
    alarm: string;
    source: string;
    utime: number;
    bytes: number;
    complete: boolean;
}
const latency_ms = 1000;
const recordings_ms = 5000;
const log_ms = 1000, most_lines = 500;

function recordings(desk: Desk) {
    const body = element('tbody'), none = element('p', { class: 'hint' });
    const rows = new Rows(body, (recorded: Recorded) => recorded.name, (recorded) => {
        const size = element('td', { class: 'number' }), copy = copy_button(desk, recorded.name);
        return { root: element('tr', { 'data-recorded': recorded.name }, element('td', { class: 'number' }, local_time(recorded.utime)), element('td', {}, where(recorded.source)), element('td', { lang: 'en' }, recorded.alarm), size,
            element('td', {}, element('a', { class: 'row-link', href: `#scope/recording/${encodeURIComponent(recorded.name)}` }, say('open_recording'))), element('td', {}, copy.root)), size, copy };
    }, (row, recorded) => {
        row.copy.permit(recorded.complete);
        write(row.size, recorded.complete ? `${(recorded.bytes / 1024).toFixed(0)} kB` : say('being_recorded'));
    });
    const inquiry = new Inquiry(desk, () => ({ cmd: 'recordings' }), recordings_ms, (answer) => {
        const list = (answer['recordings'] as Recorded[] | undefined) ?? [];
        rows.update(list);
        write(none, list.length === 0 ? say('no_recordings') : '');
    });
    return {
        root: panel('recordings', none, element('div', { class: 'scroll' }, table(['since', 'source', 'alarms', 'size', 'recording', 'save_recording'], body))),
        step() {
            inquiry.step();
            if (inquiry.unknown) write(none, say('not_known'));
        },
        leave: () => inquiry.leave(),
    };
}

interface LogLine {
    number: number;
    text: string;
}
function log(desk: Desk) {
    let last = 0, lines: LogLine[] = [];
    const list = element('pre', { class: 'log scroll', tabindex: '0' }), none = element('p', { class: 'hint' });
    const inquiry = new Inquiry(desk, () => ({ cmd: 'log', after: last, limit: most_lines }), log_ms, (answer) => {
        if (!answer.ok) return;
        const log = answer['log'] as { last: number; lines: LogLine[] };
        if (log.last < last) lines = [];  // another run of the machine
        last = log.last;
        if (log.lines.length === 0) return;
        const at_end = list.scrollTop + list.clientHeight >= list.scrollHeight - 4;
        lines = [...lines, ...log.lines].slice(-most_lines);
        list.textContent = lines.map((line) => line.text).join('\n');
        if (at_end) list.scrollTop = list.scrollHeight;
    });
    return {
        root: panel('log', none, list),
        step() {
            inquiry.step();
            write(none, inquiry.unknown ? say('not_known') : desk.link.allowed('log') ? '' : say('grey_role', { role: word('role', desk.link.role) }));
        },
        leave: () => inquiry.leave(),
    };
}

function commands(desk: Desk) {
    const body = element('tbody'), none = element('p', { class: 'hint' }, say('nothing_commanded'));
    const rows = new Rows(body, (given: Given) => String(given.at.getTime()) + JSON.stringify(given.request), ({ at, request, answer }) => {
        const { cmd, ...rest } = request;
        const said = element('td', {}, answer.ok ? `✓ ${say('done')}` : '⚠ ', ...(answer.ok ? [] : [answer.error?.what ? said_element('span', answer.error.what) : say('no_answer')]));
        mark(said, 'data-tone', answer.ok ? 'good' : 'bad');
        return { root: element('tr', {}, element('td', { class: 'number' }, at.toLocaleTimeString('en-GB')), element('td', { lang: 'en' }, `${cmd} ${Object.values(rest).join(' ')}`), said) };
    }, () => undefined);
    return {
        root: panel('commanded_here', none, element('div', { class: 'scroll' }, element('table', { 'data-list': 'given' }, body))),
        step() {
            rows.update(desk.given);
            none.hidden = desk.given.length > 0;
        },
    };
}

export function system(desk: Desk): Page {
    const machine = new Values(), cycle = new Values(), page = new Values();
    page.root.classList.add('words');  // a reason may be long
    const recorded = recordings(desk), given = commands(desk), logged = log(desk);
    let asked = 0, latency = NaN, worst = 0, uptime = NaN;
    const ping = new Inquiry(desk, () => {
        asked = performance.now();
        return { cmd: 'hello' };
    }, latency_ms, (answer) => {
        if (!answer.ok) return;
        const hello = (answer['hello'] ?? {}) as { uptime_s?: number; libraries?: { name: string; version: string; licence: string }[] };
        uptime = hello.uptime_s ?? NaN;
        const libraries = hello.libraries;
        if (libraries) licence_rows.update([...libraries.map((library): Licence => ({ name: library.name, version: library.version, licence: library.licence, used: 'licence_command' })), ...page_licences]);
        latency = performance.now() - asked;
        worst = Math.max(worst, latency);
    });
    const licence_body = element('tbody');
    const licence_rows = new Rows(licence_body, (of: Licence) => of.name, ({ name, version, licence, used }) =>
        ({ root: element('tr', {}, element('th', { scope: 'row', lang: 'en' }, name), element('td', {}, version), element('td', { lang: 'en' }, licence), element('td', { class: 'doc' }, say(used))) }), () => undefined);
    licence_rows.update(page_licences);
    return {
        root: element('div', { class: 'page system' },
            element('div', { class: 'columns three' }, panel('system', machine.root), panel('cycle_health', cycle.root), panel('this_page', page.root)),
            element('div', { class: 'columns' }, element('div', { class: 'stack' }, logged.root, recorded.root),
                element('div', { class: 'stack' }, given.root, panel('licences', element('div', { class: 'scroll' }, element('table', { class: 'dense' }, licence_body))), panel('safety', element('p', {}, say('safety_text')))))),
        update(state: MachineState) {
            ping.step();
            recorded.step();
            logged.step();
            given.step();
            machine.set('machine_name', state.machine);
            machine.set('runtime_version', desk.link.version);
            machine.set('phase', word('phase', state.phase));
            machine.set('running_for', Number.isNaN(uptime) ? duration(((desk.link.layout?.cycle_ns ?? 0) * state.cycle) / 1e9) : duration(uptime));
            machine.set('cycles', String(state.cycle));
            machine.set('commands_refused', String(state.statistics['commands_refused'] ?? 0));
            machine.set('snapshots_dropped', String(state.statistics['snapshots_dropped'] ?? 0));
            write_cycle(cycle, state, desk);
            page.set('user', desk.link.user || '–');
            page.set('role', word('role', desk.link.role));
            page.set('server', location.host);
            page.set('latency', Number.isNaN(latency) ? '–' : `${latency.toFixed(1)} / ${worst.toFixed(1)} ms`);
            page.set('states_a_second', desk.link.rate.toFixed(0));
            page.set('values_from', desk.link.source ? word('source', desk.link.source) : '–');
            page.set_said('why_not_lcm', desk.link.why_not_lcm || '–');
            page.set('lost_over_lcm', desk.link.source === 'lcm' ? `${desk.link.lost} / ${desk.link.refused}` : '–');
        },
        leave() {
            ping.leave();
            recorded.leave();
            logged.leave();
        },
    };
}
