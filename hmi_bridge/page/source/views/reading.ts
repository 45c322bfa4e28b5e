// What a value is in the newest state, and how it is written for a person.
import { is_old } from '../axis/is_old';
import { fixed } from '../numbers';
import { MachineState, Real, value } from '../state';
import { Key, say, texts, word } from '../texts';
import { ShownValue } from './builder_views';

type Found = Real | boolean | undefined;

function found(state: MachineState, shown: ShownValue): Found {
    switch (shown.source) {
        case 'axis': return (state.axes.find((axis) => axis.name === shown.of) as unknown as Record<string, Found> | undefined)?.[shown.member];
        case 'input': return state.inputs[shown.of];
        case 'output': return state.outputs[shown.of];
        case 'variable': return state.variables.find((v) => v.program === shown.of && v.name === shown.member)?.value;
        case 'parameter': return state.parameters.find((p) => p.program === shown.of && p.name === shown.member)?.value;
        case 'machine': return shown.member === 'alarms' ? state.alarms.filter((alarm) => alarm.standing).length : (state as unknown as Record<string, Found>)[shown.member];
    }
}

/** NaN where there is none, or a word. */
export function number_of(state: MachineState, shown: ShownValue): number {
    const is = found(state, shown);
    return typeof is === 'boolean' ? Number(is) : value(is);
}
export const is_on = (state: MachineState, shown: ShownValue): boolean => {
    const is = number_of(state, shown);
    return !Number.isNaN(is) && is !== 0;
};
/** What only the drive can say. */
const of_drive = /^(actual_|following_|drive_|in_position$|.*_switch$)/;
/** An input whose slave, wire or range is not to be believed; what a drive said last that does not answer. */
export function doubtful(state: MachineState, shown: ShownValue): boolean {
    if (shown.source === 'input') return state.doubtful_inputs.includes(shown.of);
    const axis = shown.source === 'axis' && of_drive.test(shown.member) ? state.axes.find((one) => one.name === shown.of) : undefined;
    return axis !== undefined && is_old(axis);
}

/** Decimals that suit a range: four digits that matter. */
export function decimals_for(shown: ShownValue, given?: number): number | undefined {
    if (given !== undefined) return given;
    if (shown.whole) return 0;
    if (shown.source === 'axis') return shown.member.endsWith('velocity') ? 1 : shown.member.endsWith('position') ? 2 : 3;
    return undefined;
}

/** Four decimals at most, and no zeros behind the last that matters. */
export const short = (is: Real): string => {
    const text = fixed(is, 4);
    return text.includes('.') ? text.replace(/\.?0+$/, '') : text;
};

export function text_of(state: MachineState, shown: ShownValue, decimals?: number): string {
    const is = found(state, shown);
    if (is === undefined) return '–';
    if (shown.form === 'flag') return say(is_on(state, shown) ? 'view_on' : 'view_off');
    if (shown.form === 'word') {
        const group = shown.source === 'axis' ? 'axis' : shown.member;
        return Object.hasOwn(texts, `${group}_${String(is)}`) ? say(`${group}_${String(is)}` as Key) : word(group, String(is));
    }
    const places = decimals_for(shown, decimals);
    return places === undefined ? short(is as Real) : fixed(is as Real, places);
}
