// The hands of an axis: power, home, reset, control, stop; jog, step, move to; override. Each grey button knows why it is grey.
import { Desk, panel } from '../desk';
import { hold_to_jog } from '../jog';
import { fixed, typed } from '../numbers';
import { AxisState, MachineState, value } from '../state';
import { Key, say } from '../texts';
import { element, mark, write } from '../view';
import { why_not_by_hand } from './why';

const step_sizes = [0.001, 0.01, 0.1, 1, 10, 100];
/** ms: while somebody pulls the override's handle, it is told this often; the machine's word is shown again this long after. */
const override_told = 100, override_left = 700;

export interface Hands {
    readonly root: HTMLElement;
    update(axis: AxisState, machine: MachineState): void;
}

function buttons(desk: Desk, name: string, axis_now: () => AxisState | undefined): Hands {
    const power = desk.button('power_on', () => ({ cmd: axis_now()?.powered ? 'disable' : 'enable', axis: name }), 'primary');
    const home = desk.button('home', () => ({ cmd: 'home', axis: name }));
    const reset = desk.button('reset', () => ({ cmd: 'reset', axis: name }));
    const control = desk.button('take_control', () => ({ cmd: axis_now()?.owner === 'operator' ? 'release_control' : 'take_control', axis: name }));
    const stop = desk.button('stop_axis', () => ({ cmd: 'stop', axis: name }), 'stop');
    return {
        root: element('div', { class: 'buttons wide' }, power, home, reset, control, stop),
        update(axis, machine) {
            const reason = why_not_by_hand(axis, machine);
            const resting = axis.powered && axis.state === 'Standstill';
            write(power, say(axis.powered ? 'power_off' : 'power_on'));
            const stopped = axis.state === 'ErrorStop';
            mark(power, 'class', axis.powered || stopped ? '' : 'primary');
            mark(reset, 'class', stopped ? 'primary' : '');
            desk.permit(power, axis.powered ? 'disable' : 'enable', axis.powered || reason === '', reason);
            desk.permit(home, 'home', reason === '' && resting, reason || say(axis.powered ? 'needs_standstill' : 'needs_power'));
            desk.permit(reset, 'reset', !axis.disabled, reason);
            write(control, say(axis.owner === 'operator' ? 'release_control' : 'take_control'));
            desk.permit(control, axis.owner === 'operator' ? 'release_control' : 'take_control', !axis.disabled, reason);
        },
    };
}

function jogging(desk: Desk, name: string, unit: string, slow: () => number, fast: () => number): Hands {
    const button = (sign: string, key: Key, velocity: () => number): HTMLButtonElement => {
        const made = element('button', { type: 'button', class: 'jog', 'aria-label': say(key), title: say(key), 'data-jog': sign }, element('span', { class: 'jog-sign' }, sign),
            element('small', {}, `${fixed(Math.abs(velocity()), 0)} ${unit}/s`));
        hold_to_jog(made, desk.hold, () => name, velocity);
        return made;
    };
    const jogs = [button('−−', 'jog_fast_negative', () => -fast()), button('−', 'jog_slow_negative', () => -slow()), button('+', 'jog_slow_positive', slow), button('++', 'jog_fast_positive', fast)];
    return {
        root: element('div', { class: 'jogs', role: 'group', 'aria-label': say('jog_hint'), title: say('jog_hint') }, ...jogs),
        update(axis, machine) {
            const reason = why_not_by_hand(axis, machine);
            for (const jog of jogs) {
                const mine = desk.hold.axis === name;  // a button that is held stays as it is: greying it would take the pointer away
                const ready = axis.powered && ['Standstill', 'DiscreteMotion'].includes(axis.state);
                desk.permit(jog, 'jog', mine || (reason === '' && ready), reason || say(axis.powered ? 'needs_standstill' : 'needs_power'));
                mark(jog, 'data-held', mine && document.activeElement === jog);
            }
        },
    };
}

function moving(desk: Desk, name: string, unit: string, slow: () => number, axis_now: () => AxisState | undefined): Hands {
    const layout = desk.axis_layout(name);
    const size = element('select', { 'aria-label': say('step_size'), 'data-input': 'step' }, ...step_sizes.map((s) => element('option', { value: String(s) }, `${s} ${unit}`)));
    size.value = '1';
    const move = (to: number, velocity: number): void => {
        const axis = axis_now(), now = axis?.position_min !== undefined;
        const low = value(now ? axis?.position_min : layout?.position_min), high = value(now ? axis?.position_max : layout?.position_max);
        if (axis?.homed && (to < low || to > high)) desk.tell('refused', say('outside_limits', { text: fixed(to), low: fixed(low), high: fixed(high) }));
        else void desk.give({ cmd: 'move', axis: name, position: to, velocity });
    };
    const step = (sense: number) => () => move(value(axis_now()?.set_position) + sense * Number(size.value), slow());
    const steps = [element('button', { type: 'button', 'data-step': '-', onclick: step(-1), 'aria-label': say('step_negative') }, '−'),
        element('button', { type: 'button', 'data-step': '+', onclick: step(1), 'aria-label': say('step_positive') }, '+')] as const;
    const to = element('input', { type: 'text', inputmode: 'decimal', 'aria-label': say('move_to'), 'data-input': 'to' });
    const at = element('input', { type: 'text', inputmode: 'decimal', 'aria-label': say('velocity'), value: Number.isFinite(slow()) ? String(slow()) : '', 'data-input': 'at' });
    const go = element('button', { type: 'submit', class: 'go', 'data-cmd': 'move' }, say('go'));
    const form = element('form', {
        class: 'line',
        onsubmit: (event: Event) => {
            event.preventDefault();
            const target = typed(to.value), velocity = typed(at.value);
            if (Number.isNaN(target)) desk.tell('refused', say('not_a_number', { text: to.value }));
            else if (Number.isNaN(velocity)) desk.tell('refused', say('not_a_number', { text: at.value }));
            else if (velocity <= 0) desk.tell('refused', say('must_be_positive'));
            else move(target, velocity);
        },
    }, element('span', { class: 'label' }, say('move_to')), to, element('span', { class: 'unit' }, unit), element('span', {}, say('at_velocity')), at, element('span', { class: 'unit' }, `${unit}/s`), go);
    return {
        root: element('div', { class: 'hands' }, element('div', { class: 'line' }, element('span', { class: 'label' }, say('step')), steps[0], size, steps[1]), form),
        update(axis, machine) {
            const reason = why_not_by_hand(axis, machine), resting = axis.powered && axis.state === 'Standstill';
            for (const button of steps) desk.permit(button, 'move', reason === '' && resting, reason || say(axis.powered ? 'needs_standstill' : 'needs_power'));
            desk.permit(go, 'move', reason === '' && axis.powered && axis.state !== 'ErrorStop', reason || say(axis.powered ? 'why_error' : 'needs_power'));
        },
    };
}

function overriding(desk: Desk, name: string): Hands {
    let touched = 0, told = 0;
    const slider = element('input', { type: 'range', min: '0', max: '100', step: '1', 'aria-label': say('override'), 'data-input': 'override' });
    const shown = element('output', { class: 'number', 'data-value': 'operators_override' });
    const tell = (): void => {
        told = performance.now();
        void desk.give({ cmd: 'override', axis: name, value: Number(slider.value) / 100 });
    };
    slider.addEventListener('input', () => {
        touched = performance.now();
        write(shown, `${slider.value} %`);
        if (touched - told > override_told) tell();
    });
    slider.addEventListener('change', tell);
    return {
        root: element('div', { class: 'line' }, element('span', { class: 'label' }, say('override')), slider, shown),
        update(axis) {
            const known = axis.operators_override !== undefined;
            desk.permit(slider, 'override', known && !axis.disabled, say(known ? 'why_disabled' : 'not_known'));
            if (performance.now() - touched < override_left) return;
            const percent = String(Math.round((known ? value(axis.operators_override) : value(axis.override)) * 100));
            if (slider.value !== percent) slider.value = percent;
            write(shown, `${percent} %`);
        },
    };
}

export function hands(desk: Desk, name: string): Hands {
    const layout = desk.axis_layout(name), unit = layout?.unit ?? 'u';
    const slow = () => value(layout?.jog_slow), fast = () => value(layout?.jog_fast);
    const axis_now = () => desk.link.state?.axes.find((axis) => axis.name === name);
    const parts = [buttons(desk, name, axis_now), jogging(desk, name, unit, slow, fast), moving(desk, name, unit, slow, axis_now), overriding(desk, name)];
    return {
        root: panel('axis_hand', element('div', { class: 'hands' }, ...parts.map((part) => part.root))),
        update: (axis, machine) => parts.forEach((part) => part.update(axis, machine)),
    };
}
