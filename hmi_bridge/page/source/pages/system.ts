// What runs here, since when, and who looks at it.
import { Desk, Page, panel, Values } from '../desk';
import { duration } from '../numbers';
import { MachineState } from '../state';
import { say, word } from '../texts';
import { element } from '../view';
import { write_cycle } from './overview';

export function system(desk: Desk): Page {
    const machine = new Values(), cycle = new Values();
    return {
        root: element('div', { class: 'page system' }, element('div', { class: 'columns' }, panel('system', machine.root), panel('cycle_health', cycle.root)),
            panel('safety', element('p', {}, say('safety_text')))),
        update(state: MachineState) {
            machine.set('machine_name', state.machine);
            machine.set('runtime_version', desk.link.version);
            machine.set('role', word('role', desk.link.role));
            machine.set('phase', word('phase', state.phase));
            machine.set('running_for', duration(state.time_ns / 1e9));
            machine.set('cycles', String(state.cycle));
            machine.set('commands_refused', String(state.statistics['commands_refused'] ?? 0));
            machine.set('snapshots_dropped', String(state.statistics['snapshots_dropped'] ?? 0));
            write_cycle(cycle, state, desk);
        },
    };
}
