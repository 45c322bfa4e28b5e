// The bus: its tree as it is cabled, what was lost, its clocks, and what is wrong with it in words.
import { in_words } from '../alarm_words';
import { BusSlave, BusTree } from '../bus/tree';
import { SlaveDetails } from '../bus/slave';
import { Desk, Page, panel, Values } from '../desk';
import { Inquiry } from '../inquiry';
import { microseconds } from '../numbers';
import { Alarm, MachineState } from '../state';
import { said, said_element } from '../sentences/said';
import { say, word } from '../texts';
import { element, mark, Rows, write } from '../view';

interface BusAnswer {
    phase: string;
    progress: string;
    interface: string;
    tree_known: boolean;
    slaves: BusSlave[];
    trouble: Alarm[];
    findings: { position: number; port: number; text: string }[];
    remarks: { code: string; subject: string; what: string; remedy: string }[];
    notes: string[];
}
interface Said {
    tone: 'bad' | 'warn' | 'idle';
    text: string;
    remedy: string;
}
const refresh_ms = 1000;

/** From an older runtime: the slaves in their order, without cables. */
const from_state = (state: MachineState): BusSlave[] => state.slaves.map((slave, position) => ({
    position, name: slave.name, configured: true, device: '', vendor: 0, product: 0, revision: 0, serial: 0, parent: position === 0 ? null : position - 1, state: slave.state, al_error: slave.al_status_code !== 0,
    al_status_code: slave.al_status_code, al_status_text: '', al_status_remedy: '', fresh: slave.fresh, age: slave.age,
}));

function what_is_said(bus: BusAnswer): Said[] {
    return [...bus.trouble.map((alarm): Said => ({ tone: 'bad', text: in_words(alarm), remedy: alarm.remedy })), ...bus.remarks.map((remark): Said => ({ tone: 'warn', text: `${remark.subject}: ${remark.what}`, remedy: remark.remedy })),
        ...bus.findings.map((finding): Said => ({ tone: 'warn', text: finding.text, remedy: '' })), ...bus.notes.map((note): Said => ({ tone: 'idle', text: note, remedy: '' }))];
}

export function bus(desk: Desk): Page {
    const frames = new Values(), clocks = new Values();
    let known: BusAnswer | undefined;
    let chosen = 0;
    const tree = new BusTree((slave) => { chosen = known?.slaves.indexOf(slave) ?? 0; }, (slave) => known?.slaves[chosen] === slave);
    const details = new SlaveDetails();
    const told_list = element('div', { class: 'said' }), calm = element('p', { class: 'calm' }, `✓ ${say('bus_calm')}`), old = element('p', { class: 'hint' });
    const told = new Rows(told_list, (item: Said) => item.text, (item) => {
        const text = element('strong', item.tone === 'bad' || said(item.text).known ? {} : { lang: 'en' }, `${item.tone === 'idle' ? 'ⓘ' : '⚠'} ${item.tone === 'bad' ? item.text : said(item.text).text}`);
        mark(text, 'data-tone', item.tone);
        return { root: element('div', { class: 'event-line' }, text, said_element('small', item.remedy)) };
    }, () => undefined);
    const inquiry = new Inquiry(desk, () => ({ cmd: 'bus' }), refresh_ms, (answer) => {
        if (answer.ok) known = answer['bus'] as BusAnswer;
    });
    return {
        root: element('div', { class: 'page bus' }, element('div', { class: 'columns' }, element('div', { class: 'stack' }, panel('bus_tree', old, tree.root), panel('bus_why', calm, told_list)),
            element('div', { class: 'stack' }, element('div', { class: 'columns' }, panel('frames', frames.root), panel('clocks', clocks.root)), details.root))),
        update(state: MachineState) {
            inquiry.step();
            const of = (name: string) => state.bus[name] ?? 0;
            const us = (name: string) => `${microseconds(Number(of(name)))} µs`;
            frames.set('bus_state', word('bus', String(of('phase'))));
            for (const key of ['frames_sent', 'frames_received', 'frames_lost', 'frames_late', 'frames_rejected', 'working_counter_errors', 'send_errors'] as const) frames.set(key, String(of(key)));
            frames.set('round_trip', us('round_trip_ns'));
            clocks.set('dc_lock', word('dc', String(of('dc_lock'))));
            clocks.set('dc_difference', us('dc_difference_ns'));
            clocks.set('dc_phase_error', us('dc_phase_error_ns'));
            clocks.set('sync0_margin', us('sync0_margin_least_ns'));
            clocks.set('ring', word('ring', String(of('ring'))));
            clocks.set('interface', known ? known.interface || say('bus_simulated') : '–');
            const slaves = known?.slaves ?? from_state(state);
            tree.update(slaves);
            details.update(known?.slaves[chosen]);
            const items = known ? what_is_said(known) : [];
            told.update(items);
            calm.hidden = !known || items.length > 0;
            write(old, inquiry.unknown ? say('not_known') : known && !known.tree_known ? say('tree_unknown') : '');
        },
        leave: () => inquiry.leave(),
    };
}
