// What a person may ask of a group: stop, interrupt and continue, reset, enable, and how fast along the path. Each grey button knows why it is grey.
import { Desk, panel } from '../desk';
import { GroupState, MachineState, value } from '../state';
import { say } from '../texts';
import { element, write } from '../view';

/** ms: while somebody pulls the override's handle, it is told this often; the machine's word is shown again this long after. */
const override_told = 100, override_left = 700;

/** Why a person cannot enable or disable it now; empty: he can. */
export function why_not_own(group: GroupState, machine: MachineState): string {
    const owners = machine.axes.filter((axis) => group.members.some((member) => member.axis === axis.name)).map((axis) => axis.owner);
    return owners.includes('program') ? say('group_of_a_program') : '';
}

export function group_hand(desk: Desk, name: string) {
    const give = (cmd: string) => () => ({ cmd, group: name });
    const halt = desk.button('group_halt', give('group_halt'), 'stop');
    const interrupt = desk.button('group_interrupt', give('group_interrupt')), go_on = desk.button('group_continue', give('group_continue'));
    const reset = desk.button('group_reset', give('group_reset')), enable = desk.button('group_enable', give('group_enable')), disable = desk.button('group_disable', give('group_disable'));
    let touched = -Infinity, told = 0;
    const slider = element('input', { type: 'range', min: '0', max: '100', step: '1', 'aria-label': say('override'), 'data-input': 'group_override' });
    const shown = element('output', { class: 'number', 'data-value': 'group_override' });
    const tell = (): void => {
        told = performance.now();
        void desk.give({ cmd: 'group_override', group: name, value: Number(slider.value) / 100 });
    };
    slider.addEventListener('input', () => {
        touched = performance.now();
        write(shown, `${slider.value} %`);
        if (touched - told > override_told) tell();
    });
    slider.addEventListener('change', tell);
    const root = panel('group_hand', element('div', { class: 'hands' }, element('div', { class: 'buttons wide' }, halt, interrupt, go_on), element('div', { class: 'buttons wide' }, reset, enable, disable),
        element('div', { class: 'line' }, element('span', { class: 'label' }, say('override')), slider, shown), element('p', { class: 'hint' }, say('group_hand_hint'))));
    return {
        root,
        update(group: GroupState, machine: MachineState): void {
            const disabled = group.state === 'GroupDisabled', others = why_not_own(group, machine);
            desk.permit(interrupt, 'group_interrupt', group.state === 'GroupMoving', say('group_not_moving'));
            desk.permit(go_on, 'group_continue', group.held && !machine.emergency_stop, machine.emergency_stop ? say('why_emergency') : group.interrupted ? say('group_interrupted_by_program') : say('group_not_interrupted'));
            go_on.classList.toggle('primary', group.held);
            desk.permit(reset, 'group_reset', group.state === 'GroupErrorStop', say('group_no_error'));
            reset.classList.toggle('primary', group.state === 'GroupErrorStop');
            desk.permit(enable, 'group_enable', disabled && others === '', disabled ? others : say('group_enabled_already'));
            desk.permit(disable, 'group_disable', !disabled && others === '', disabled ? say('group_not_enabled') : others);
            desk.permit(slider, 'group_override');
            if (performance.now() - touched < override_left) return;
            const percent = String(Math.round(value(group.operators_override) * 100));
            if (slider.value !== percent) slider.value = percent;
            write(shown, `${percent} %`);
        },
    };
}
