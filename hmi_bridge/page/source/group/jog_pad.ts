// A person's hand on a group: a pair of buttons for each direction of a frame, or for each axis. Each holds the jog while it is pressed (jog.ts), as the buttons
// of a single axis do; an increment ends by itself. What ended the last one is said.
import { Desk, panel } from '../desk';
import { hold_to_jog } from '../jog';
import { GroupLayout, GroupState, MachineState } from '../state';
import { Key, say } from '../texts';
import { element, mark, write } from '../view';
import { why_emergency } from '../axis/why';

/** What a held button asks for; as text it is what a JogHold holds. */
export interface GroupJog {
    group: string;
    frame: string;
    direction: string;
    distance?: number;
}

const components = ['x', 'y', 'z', 'rx', 'ry', 'rz'] as const;
const frames_with_arm = ['mcs', 'tcs', 'acs', 'wcs', 'pcs', 'pcs_2', 'pcs_3', 'pcs_4', 'pcs_5', 'pcs_6', 'pcs_7', 'pcs_8'] as const;
const increments = [0, 0.1, 1, 10, 100] as const;
const first_percent = 20;

/** Directions of a frame that this arm has: all ways where it has one (a frame may be turned), of turns those that it commands; in acs its axes. */
export function directions_of(layout: GroupLayout, frame: string): string[] {
    if (frame === 'acs') return layout.members;
    const can = layout.commands ?? [];
    const ways = can.slice(0, 3).some(Boolean) ? components.slice(0, 3) : [];
    return [...ways, ...components.slice(3).filter((_, i) => can[i + 3])];
}

/** Why nobody may jog it now; empty: one may. */
export function why_not_jog(group: GroupState, machine: MachineState): string {
    if (machine.emergency_stop) return why_emergency(machine);
    if (machine.mode === 'automatic') return say('why_automatic');
    const owners = machine.axes.filter((axis) => group.members.some((member) => member.axis === axis.name)).map((axis) => axis.owner);
    if (owners.includes('program')) return say('group_of_a_program');
    if (group.state === 'GroupErrorStop') return say('group_in_error');
    if (!group.powered) return say('group_needs_power');
    if (group.state === 'GroupDisabled') return say('group_not_enabled');
    return group.state === 'GroupStandby' ? '' : say('needs_standstill');
}

export function jog_pad(desk: Desk, layout: GroupLayout) {
    const frames = layout.arm ? frames_with_arm : (['acs'] as const);
    const frame = element('select', { 'aria-label': say('group_frame'), 'data-input': 'group_frame' }, ...frames.map((one) => element('option', { value: one }, say(`group_frame_${one}` as Key))));
    const by = element('select', { 'aria-label': say('group_increment'), 'data-input': 'group_increment' });
    const speed = element('input', { type: 'range', min: '1', max: '100', step: '1', value: String(first_percent), 'aria-label': say('velocity'), 'data-input': 'group_jog_velocity' });
    const shown = element('output', { class: 'number', 'data-value': 'group_jog_velocity' });
    const pad = element('div', { class: 'pad', role: 'group', 'aria-label': say('jog_hint'), title: say('jog_hint') });
    const limit = element('p', { class: 'hint', 'data-value': 'group_setup' }), ended = element('p', { class: 'hint', role: 'status', 'data-value': 'group_jog_end' });
    let buttons: HTMLButtonElement[] = [];
    const order = (direction: string): string => {
        const jog: GroupJog = { group: layout.name, frame: frame.value, direction };
        if (Number(by.value) > 0) jog.distance = Number(by.value);
        return JSON.stringify(jog);
    };
    const unit_of = (direction: string): string => frame.value === 'acs' ? (desk.axis_layout(direction)?.unit ?? '') : direction.startsWith('r') ? '°' : layout.unit;
    const lay_out = (): void => {
        desk.leading.end('blur');
        const directions = directions_of(layout, frame.value);
        const units = [...new Set(directions.map(unit_of))].join(', ');
        const kept = by.value;
        by.replaceChildren(...increments.map((one) => element('option', { value: String(one) }, one === 0 ? say('group_increment_none') : `${one} ${units}`)));
        if (kept) by.value = kept;
        buttons = [];
        const button = (direction: string, sign: '+' | '−'): HTMLButtonElement => {
            const way = `${direction}${sign === '+' ? '+' : '-'}`;
            const made = element('button', { type: 'button', class: 'jog', 'data-group-jog': way, 'aria-label': say(sign === '+' ? 'group_jog_positive' : 'group_jog_negative', { direction: direction.toUpperCase() }) },
                element('span', { class: 'jog-sign' }, sign));
            hold_to_jog(made, desk.leading, () => order(way), () => Number(speed.value) / 100);
            buttons.push(made);
            return made;
        };
        pad.replaceChildren(...directions.flatMap((direction) => [button(direction, '−'), element('span', { class: 'pad-name' }, frame.value === 'acs' ? direction : direction.toUpperCase()), button(direction, '+')]));
    };
    const show_speed = (): void => write(shown, layout.arm && frame.value !== 'acs' && layout.setup_velocity
        ? say('group_jog_speed', { percent: speed.value, velocity: String(Math.round(layout.setup_velocity * Number(speed.value)) / 100), unit: layout.unit }) : `${speed.value} %`);
    frame.addEventListener('change', () => { lay_out(); show_speed(); });
    by.addEventListener('change', () => desk.leading.end('blur'));
    speed.addEventListener('input', show_speed);
    lay_out();
    show_speed();
    const root = panel('group_jog', element('div', { class: 'hands' },
        element('div', { class: 'line' }, element('span', { class: 'label' }, say('group_frame')), frame, element('span', {}, say('group_increment')), by),
        element('div', { class: 'line' }, element('span', { class: 'label' }, say('velocity')), speed, shown), pad, ended, limit));
    return {
        root,
        update(group: GroupState, machine: MachineState): void {
            const why = why_not_jog(group, machine), mine = desk.leading.axis !== undefined;
            for (const button of buttons) {
                desk.permit(button, 'group_jog', mine || why === '', why);  // a button that is held stays as it is: greying it would take the pointer away
                mark(button, 'data-held', mine && document.activeElement === button);
            }
            write(ended, desk.stopped_by);
            ended.hidden = desk.stopped_by === '';
            const setup = machine.mode === 'setup' && layout.arm && !!layout.setup_velocity;
            write(limit, setup ? say('group_setup_limit', { velocity: String(layout.setup_velocity), unit: layout.unit }) : '');
            limit.hidden = !setup;
        },
        leave: () => desk.leading.end('blur'),
    };
}
