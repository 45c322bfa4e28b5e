// All axes at a glance, a row each; programs; whether the cycle keeps time.
import { in_words, key_of, stops, where } from '../alarm_words';
import { is_old } from '../axis/is_old';
import { Desk, Page, panel, table, Values, write_lamp, write_state } from '../desk';
import { fixed, span_of } from '../numbers';
import { said_element } from '../sentences/said';
import { Alarm, AxisLayout, AxisState, MachineState, value } from '../state';
import { say, word } from '../texts';
import { element, mark, Rows, write } from '../view';

/** More than these are left to their own page. */
const most_standing = 3;

export function overview(desk: Desk): Page {
    const cells = ['state', 'position', 'travel', 'velocity', 'power', 'homed', 'owner'] as const;
    const body = element('tbody');
    const axes = new Rows(body, (axis: AxisState) => axis.name, (axis) => {
        const link = element('a', { href: `#axis/${encodeURIComponent(axis.name)}`, class: 'row-link' }, axis.name);
        const cell = (name: (typeof cells)[number], kind = '') => element('td', { 'data-value': name, class: kind });
        const made = { state: cell('state'), position: cell('position', 'number'), velocity: cell('velocity', 'number'), travel: cell('travel'), power: cell('power'), homed: cell('homed'), owner: cell('owner') };
        const root = element('tr', { 'data-axis': axis.name, onclick: () => link.click() }, element('th', { scope: 'row' }, link), ...cells.map((name) => made[name]));
        const carriage = element('i'), travel = element('div', { class: 'travel' }, carriage);
        made.travel.append(travel);
        return { root, ...made, travel, carriage };
    }, (row, axis) => {
        write_state(row.state, axis, word('axis', axis.state));
        const old = is_old(axis);
        write(row.position, `${old ? '⚠ ' : ''}${fixed(axis.actual_position)} ${axis.unit}`);
        mark(row.position, 'data-old', old);
        mark(row.position, 'title', old && say('last_known'));
        write(row.velocity, old ? '–' : `${fixed(axis.actual_velocity)} ${axis.unit}/s`);
        const part = part_of_travel(desk.axis_layout(axis.name), axis);
        row.travel.hidden = Number.isNaN(part);
        row.carriage.style.left = `${(part * 100).toFixed(1)}%`;
        write_lamp(row.power, axis.powered, say(axis.powered ? 'power_on_state' : 'power_off_state'));
        write_lamp(row.homed, axis.homed, say(axis.homed ? 'homed' : 'not_homed'));
        write(row.owner, word('owner', axis.owner));
    });

    const power = desk.button('power_all', () => ({ cmd: 'enable', axis: 'all' }));
    const no_power = desk.button('power_off_all', () => ({ cmd: 'disable', axis: 'all' }));
    const reset = desk.button('reset_all', () => ({ cmd: 'reset' }));
    const programs = program_rows(desk);
    const health = new Values(), share = share_of_cycle(), standing = standing_list();
    const root = element('div', { class: 'page overview' }, standing.root,
        panel('axes', table(['name', ...cells], body, ['position', 'velocity']), element('div', { class: 'buttons' }, power, no_power, reset)),
        element('div', { class: 'columns' }, panel('programs', programs.root), panel('cycle_health', share.root, health.root)));
    return {
        root,
        update(state: MachineState) {
            axes.update(state.axes);
            programs.update(state);
            desk.permit(power, 'enable', !state.emergency_stop, say('why_emergency'));
            desk.permit(no_power, 'disable');
            desk.permit(reset, 'reset');
            write_cycle(health, state, desk);
            share.update(state, desk.link.layout?.cycle_ns ?? 0);
            standing.update(state);
        },
    };
}

/** 0 at the negative software limit, 1 at the positive one; NaN where there are none. */
export function part_of_travel(layout: AxisLayout | undefined, axis: AxisState): number {
    const modulo = value(layout?.modulo), low = modulo > 0 ? 0 : value(layout?.position_min), high = modulo > 0 ? modulo : value(layout?.position_max);
    return high > low && axis.homed ? Math.min(1, Math.max(0, (value(axis.actual_position) - low) / (high - low))) : NaN;
}

export function write_cycle(to: Values, state: MachineState, desk: Desk): void {
    const s = state.statistics;
    const of = (name: string) => s[name] ?? 0;
    to.set('cycle_time', span_of(desk.link.layout?.cycle_ns ?? 0));
    to.set('compute_worst', `${span_of(of('compute_ns'))} / ${span_of(of('compute_max_ns'))}`);
    to.set('lateness_worst', `${span_of(of('lateness_ns'))} / ${span_of(of('lateness_max_ns'))}`);
    to.set('overruns', String(of('overruns')));
    to.set('missed_ticks', String(of('missed_ticks')));
    to.set('bus_state', word('bus', String(state.bus['phase'] ?? '')));
    to.set('frames_lost', String(state.bus['frames_lost'] ?? 0));
}

/** How much of the cycle the last one took, and the worst one. */
function share_of_cycle() {
    const now = element('i', { class: 'share-now' }), worst = element('i', { class: 'share-worst' });
    const root = element('div', { class: 'share', role: 'img' }, worst, now);
    return {
        root,
        update(state: MachineState, cycle_ns: number) {
            const part = (ns: number | undefined): number => Math.min(100, ((ns ?? 0) / Math.max(1, cycle_ns)) * 100);
            const [is, was] = [part(state.statistics['compute_ns']), part(state.statistics['compute_max_ns'])];
            now.style.width = `${is.toFixed(1)}%`;
            worst.style.left = `${was.toFixed(1)}%`;
            mark(root, 'aria-label', say('share_of_cycle', { now: is.toFixed(1), worst: was.toFixed(1) }));
            mark(root, 'title', say('share_of_cycle', { now: is.toFixed(1), worst: was.toFixed(1) }));
        },
    };
}

/** What stands, in a line each, with what to do about it. */
function standing_list() {
    const list = element('div', { class: 'standing' });
    const rows = new Rows(list, key_of, (alarm: Alarm) => {
        const tone = stops(alarm) ? 'bad' : 'warn';
        return { root: element('a', { class: 'standing-alarm', href: '#alarms', 'data-tone': tone }, element('strong', {}, `⚠ ${where(alarm.source)}: ${in_words(alarm)}`), said_element('span', alarm.remedy)) };
    }, () => undefined);
    return {
        root: list,
        update(state: MachineState) {
            const standing = state.alarms.filter((alarm) => alarm.standing).sort((a, b) => Number(stops(b)) - Number(stops(a)));
            rows.update(standing.slice(0, most_standing));
            list.hidden = standing.length === 0;
        },
    };
}

/** Programs with their buttons; on the overview and on their own page. */
export function program_rows(desk: Desk): Page {
    const body = element('tbody');
    const hint = element('p', { class: 'hint' });
    const rows = new Rows(body, (program: { name: string; state: string }) => program.name, (program) => {
        const state = element('td', { 'data-value': 'state' });
        const start = desk.button('start', () => ({ cmd: 'program_start', program: program.name }));
        const stop = desk.button('stop', () => ({ cmd: 'program_stop', program: program.name }));
        const reset = desk.button('reset', () => ({ cmd: 'program_reset', program: program.name }));
        const root = element('tr', { 'data-program': program.name }, element('th', { scope: 'row' }, program.name), state,
            element('td', { class: 'buttons' }, start, stop, reset));
        return { root, state, start, stop, reset };
    }, (row, program) => {
        write(row.state, `${program.state === 'running' ? '▶' : program.state === 'fault' ? '⚠' : '◼'} ${word('program', program.state)}`);
        row.state.dataset['tone'] = program.state === 'running' ? 'good' : program.state === 'fault' ? 'bad' : 'idle';
        const now = desk.link.state;
        const why_not = now?.emergency_stop ? say('why_emergency') : now?.mode !== 'automatic' ? say('needs_automatic') : program.state === 'fault' ? say('needs_program_reset') : '';
        desk.permit(row.start, 'program_start', why_not === '', why_not);
        desk.permit(row.stop, 'program_stop', program.state === 'running', say('program_not_running'));
        desk.permit(row.reset, 'program_reset', program.state !== 'running', say('program_is_running'));
    });
    const root = element('div', {}, element('table', {}, body), hint);
    return {
        root,
        update(state) {
            rows.update(state.programs);
            write(hint, state.programs.length === 0 ? say('no_programs') : state.mode === 'automatic' ? '' : say('needs_automatic'));
        },
    };
}
