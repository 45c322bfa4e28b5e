// The drive of an axis: its state by the manual's words, its status word bit by bit, its parameters.
import { alarms_of_axis, in_words } from '../alarm_words';
import { Desk, Page, panel, Values, write_lamp } from '../desk';
import { hex } from '../numbers';
import { said } from '../sentences/said';
import { AxisLayout, AxisState, MachineState } from '../state';
import { Key, say, word } from '../texts';
import { element, write } from '../view';
import { DriveParameters } from './drive_parameters';
import { is_old } from './is_old';
import { axis_tabs } from './tabs';

/** CiA 402-2, table of the status word, from bit 0; what is left out belongs to a mode or the vendor. */
const status_bits: readonly (readonly [number, Key])[] = [
    [0, 'bit_ready'], [1, 'bit_switched_on'], [2, 'bit_operation_enabled'], [3, 'bit_fault'], [4, 'bit_voltage'], [5, 'bit_no_quick_stop'], [6, 'bit_switch_on_disabled'], [7, 'bit_warning'],
    [9, 'bit_remote'], [10, 'bit_target_reached'], [11, 'bit_internal_limit'],
];
const bad_bits = [3, 7, 11];

export function drive_page(desk: Desk, layout: AxisLayout): Page {
    const status = new Values();
    const bits = status_bits.map(([bit]) => element('li', { 'data-bit': String(bit) }));
    const fault_text = element('strong', { 'data-tone': 'bad' }), fault_remedy = element('small');
    const fault = element('div', { class: 'event-line', hidden: true, 'data-part': 'fault' }, fault_text, fault_remedy);
    const parameters = new DriveParameters(desk, layout);
    const root = element('div', { class: 'page axis drive' }, axis_tabs(desk, layout.name, 'drive'),
        element('div', { class: 'columns' }, element('div', { class: 'stack' }, panel('drive', status.root, fault), panel('status_word', element('ul', { class: 'bits' }, ...bits))), parameters.root));
    const write_status = (axis: AxisState): void => {
        status.set('drive', layout.drive || '–');
        status.set('profile', layout.profile || '–');
        status.set('drive_place', String(layout.drive_axis));
        const old = is_old(axis);
        status.set('drive_state', old ? say('last_known') : word('drive', axis.drive_state));
        status.set('drive_mode', old ? '–' : word('drivemode', axis.drive_mode));
        status.set('status_word', old ? '–' : hex(axis.status_word));
        status.set('drive_error', old ? '–' : axis.drive_error === 0 ? say('none_of_these') : hex(axis.drive_error));
        if (axis.brake && axis.brake !== 'not_controlled') status.set('brake', word('brake', axis.brake));
        status_bits.forEach(([bit, key], i) => {
            const item = bits[i];
            if (!item) return;
            const on = !old && (axis.status_word & (1 << bit)) !== 0;
            write_lamp(item, on, `${bit} ${say(key)}`, bad_bits.includes(bit) ? 'bad' : 'good');
        });
    };
    return {
        root,
        update(machine: MachineState) {
            const axis = machine.axes.find((a) => a.name === layout.name);
            if (!axis) return;
            write_status(axis);
            const [alarm] = alarms_of_axis(machine, layout.name);
            fault.hidden = !alarm;
            if (alarm) {
                write(fault_text, `⚠ ${in_words(alarm)}`);
                write(fault_remedy, [said(alarm.cause).text, said(alarm.remedy).text, alarm.manual ?? ''].filter((text) => text !== '').join(' · '));
            }
            parameters.update(axis);
        },
        leave: () => parameters.leave(),
    };
}
