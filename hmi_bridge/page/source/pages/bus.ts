// The bus: its state, what was lost, its clocks, each slave.
import { Desk, Page, panel, table, Values } from '../desk';
import { hex, microseconds } from '../numbers';
import { MachineState } from '../state';
import { say, word } from '../texts';
import { element, mark, Rows, write } from '../view';

export function bus(_desk: Desk): Page {
    const frames = new Values(), clocks = new Values();
    const body = element('tbody');
    const slaves = new Rows(body, (slave: MachineState['slaves'][number]) => slave.name, (slave) => {
        const state = element('td'), al = element('td'), age = element('td');
        return { root: element('tr', { 'data-slave': slave.name }, element('th', { scope: 'row' }, slave.name), state, al, age), state, al, age };
    }, (row, slave) => {
        write(row.state, `${slave.state === 'OP' ? '●' : '○'} ${slave.state}`);
        mark(row.state, 'data-tone', slave.state === 'OP' ? 'good' : 'warn');
        write(row.al, slave.al_status_code === 0 ? say('none_of_these') : hex(slave.al_status_code));
        write(row.age, slave.fresh ? `✓ ${say('fresh')}` : `⚠ ${say('aged', { count: String(slave.age) })}`);
        mark(row.age, 'data-tone', slave.fresh ? 'good' : 'bad');
    });
    return {
        root: element('div', { class: 'page bus' }, element('div', { class: 'columns' }, panel('frames', frames.root), panel('clocks', clocks.root)),
            panel('slaves', table(['name', 'state', 'al_status', 'fresh'], body))),
        update(state: MachineState) {
            const of = (name: string) => state.bus[name] ?? 0;
            const us = (name: string) => `${microseconds(Number(of(name)))} µs`;
            frames.set('bus_state', word('bus', String(of('phase'))));
            for (const key of ['frames_sent', 'frames_received', 'frames_lost', 'frames_late', 'frames_rejected', 'working_counter_errors', 'send_errors'] as const)
                frames.set(key, String(of(key)));
            frames.set('round_trip', us('round_trip_ns'));
            clocks.set('dc_lock', word('dc', String(of('dc_lock'))));
            clocks.set('dc_difference', us('dc_difference_ns'));
            clocks.set('dc_phase_error', us('dc_phase_error_ns'));
            clocks.set('sync0_margin', us('sync0_margin_least_ns'));
            clocks.set('ring', word('ring', String(of('ring'))));
            slaves.update(state.slaves);
        },
    };
}
