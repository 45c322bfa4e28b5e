// Why an axis does not move, or why at this velocity: whole sentences, the nearest reason first. Pure: a test goes through the reasons.
import { alarms_of_axis, in_words } from '../alarm_words';
import { said } from '../sentences/said';
import { AxisState, MachineState, value } from '../state';
import { say, word } from '../texts';

export interface Why {
    title: string;
    /** The first is the reason; what follows is good to know. */
    sentences: string[];
}

const moving = (axis: AxisState): boolean => value(axis.set_velocity) !== 0;

export function why(axis: AxisState, machine: MachineState): Why {
    const sentences = moving(axis) ? why_velocity(axis) : why_still(axis, machine);
    if (axis.negative_limit_switch) sentences.push(say('why_switch', { side: say('limit_negative') }));
    if (axis.positive_limit_switch) sentences.push(say('why_switch', { side: say('limit_positive') }));
    if (axis.powered && axis.enable_positive === false) sentences.push(say('why_not_positive'));
    if (axis.powered && axis.enable_negative === false) sentences.push(say('why_not_negative'));
    if (axis.warning) sentences.push(say('why_warned'));
    if (!axis.homed && !axis.disabled) sentences.push(say('why_not_homed'));
    return { title: say(moving(axis) ? 'why_velocity' : 'why_still'), sentences };
}

/** Why a hand may not command it now, in general; empty: it may. */
export function why_not_by_hand(axis: AxisState, machine: MachineState): string {
    if (axis.disabled) return say('why_disabled');
    if (machine.emergency_stop) return why_emergency(machine);
    if (machine.mode === 'automatic') return say('why_automatic');
    return axis.owner === 'program' ? say('why_program') : '';
}

const behind = (block: string): string => (block ? ` (${block})` : '');

export const why_emergency = (machine: MachineState): string => say(machine.emergency_stop_unread ? 'why_emergency_unread' : 'why_emergency');

/** Its alarms with what to do; where they are gone meanwhile, what its error means. */
function why_error(axis: AxisState, machine: MachineState): string[] {
    const standing = alarms_of_axis(machine, axis.name);
    const told = standing.length > 0 ? standing.flatMap((alarm) => [in_words(alarm), said(alarm.remedy).text]) : [said(axis.error_cause ?? '').text, said(axis.error_remedy ?? '').text];
    return told.filter((text) => text !== '');
}

function why_velocity(axis: AxisState): string[] {
    const by = { command: axis.command || word('axis', axis.state), block: behind(axis.block), owner: word('owner', axis.owner) };
    const sentences = [say('why_moving', by)];
    if (axis.master) sentences.push(say('why_follows', { master: axis.master }));
    if (axis.velocity_limiter !== 'none') sentences.push(say('why_limited', { limiter: word('limiter', axis.velocity_limiter) }));
    return sentences;
}

function why_still(axis: AxisState, machine: MachineState): string[] {
    if (axis.disabled) return [say('why_disabled')];
    if (machine.emergency_stop) return [why_emergency(machine), ...(axis.online ? [] : [say('why_offline')])];
    if (!axis.online) return [say('why_offline')];
    if (axis.state === 'ErrorStop') return [say('why_error'), ...why_error(axis, machine)];
    if (axis.held_by_stop) return [say('why_held', { block: behind(axis.block) })];
    const sentences: string[] = [];
    if (!axis.powered) {
        const settled = ['switch-on disabled', 'ready to switch on'].includes(axis.drive_state);
        sentences.push(settled || axis.drive_state === 'unknown' ? say('why_no_power') : say('why_drive_not_up', { state: word('drive', axis.drive_state) }));
    } else if (axis.has_job) sentences.push(say('why_waiting', { command: axis.command, block: behind(axis.block) }));
    if (axis.owner === 'program') sentences.push(say('why_program'));
    else if (machine.mode === 'automatic') sentences.push(say('why_automatic'));
    return sentences.length > 0 ? sentences : [say('why_idle')];
}
