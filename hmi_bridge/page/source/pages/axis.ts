// One axis: where it is, why it does not move, and the hands to move it.
import { Desk, Page, panel, Values, write_lamp, write_state } from '../desk';
import { hold_to_jog } from '../jog';
import { fixed, hex, typed } from '../numbers';
import { Ruler } from '../ruler';
import { AxisState, MachineState, value } from '../state';
import { Key, say, word } from '../texts';
import { element, mark, write } from '../view';
import { why } from '../why';

const step_sizes = [0.01, 0.1, 1, 10, 100];

/** `#axis/NAME`; the first one where there is none of that name. */
export function axis_page(desk: Desk, [wanted = '']: readonly string[]): Page {
    const known = desk.link.layout?.axes ?? [];
    const name = (known.find((axis) => axis.name === wanted) ?? known[0])?.name ?? '';
    const layout = desk.axis_layout(name);
    const unit = layout?.unit ?? 'u';
    const axis_of = (): AxisState | undefined => desk.link.state?.axes.find((axis) => axis.name === name);

    const tabs = element('nav', { class: 'tabs', 'aria-label': say('axis') }, ...known.map((axis) => {
        const tab = element('a', { href: `#axis/${encodeURIComponent(axis.name)}` }, axis.name);
        if (axis.name === name) mark(tab, 'aria-current', 'page');
        return tab;
    }));
    const position = element('output', { class: 'big', 'data-value': 'big_position' });
    const state_line = element('div', { class: 'state', 'data-value': 'state' });
    const lamps = { powered: element('span', { class: 'lamp' }), homed: element('span', { class: 'lamp' }), in_position: element('span', { class: 'lamp' }),
        negative: element('span', { class: 'lamp' }), home: element('span', { class: 'lamp' }), positive: element('span', { class: 'lamp' }) };
    const ruler = new Ruler();
    const why_title = element('h2'), why_text = element('ul', { class: 'why', 'data-value': 'why' });
    const left = new Values(), right = new Values();

    const power = desk.button('power_on', () => ({ cmd: axis_of()?.powered ? 'disable' : 'enable', axis: name }), 'primary');
    const home = desk.button('home', () => ({ cmd: 'home', axis: name }));
    const reset = desk.button('reset', () => ({ cmd: 'reset', axis: name }));
    const control = desk.button('take_control', () => ({ cmd: axis_of()?.owner === 'operator' ? 'release_control' : 'take_control', axis: name }));
    const stop = desk.button('stop_axis', () => ({ cmd: 'stop', axis: name }), 'stop');

    const jog_button = (sign: string, key: Key, velocity: () => number): HTMLButtonElement => {
        const button = element('button', { type: 'button', class: 'jog', 'aria-label': say(key), title: say(key), 'data-jog': sign }, sign);
        hold_to_jog(button, desk.hold, () => name, velocity);
        return button;
    };
    const slow = () => value(layout?.jog_slow), fast = () => value(layout?.jog_fast);
    const jogs = [jog_button('−−', 'jog_fast_negative', () => -fast()), jog_button('−', 'jog_slow_negative', () => -slow()),
        jog_button('+', 'jog_slow_positive', slow), jog_button('++', 'jog_fast_positive', fast)];

    const size = element('select', { 'aria-label': say('step_size'), 'data-input': 'step' }, ...step_sizes.map((s) => element('option', { value: String(s) }, `${s} ${unit}`)));
    size.value = '1';
    const move = (to: number, velocity: number) => {
        const low = value(layout?.position_min), high = value(layout?.position_max);
        if (axis_of()?.homed && (to < low || to > high))
            desk.tell('refused', say('outside_limits', { text: fixed(to), low: fixed(low), high: fixed(high) }));
        else void desk.give({ cmd: 'move', axis: name, position: to, velocity });
    };
    const step = (sense: number) => () => move(value(axis_of()?.set_position) + sense * Number(size.value), slow());
    const steps = [element('button', { type: 'button', 'data-step': '-', onclick: step(-1), 'aria-label': say('step_negative') }, `− ${say('step')}`),
        element('button', { type: 'button', 'data-step': '+', onclick: step(1), 'aria-label': say('step_positive') }, `+ ${say('step')}`)] as const;

    const to = element('input', { type: 'text', inputmode: 'decimal', 'aria-label': say('move_to'), 'data-input': 'to' });
    const at = element('input', { type: 'text', inputmode: 'decimal', 'aria-label': say('velocity'), value: Number.isFinite(slow()) ? String(slow()) : '', 'data-input': 'at' });
    const go = element('button', { type: 'submit', 'data-cmd': 'move' }, say('go'));
    const move_form = element('form', {
        class: 'line',
        onsubmit: (event: Event) => {
            event.preventDefault();
            const target = typed(to.value), velocity = typed(at.value);
            if (Number.isNaN(target)) desk.tell('refused', say('not_a_number', { text: to.value }));
            else if (Number.isNaN(velocity)) desk.tell('refused', say('not_a_number', { text: at.value }));
            else if (velocity <= 0) desk.tell('refused', say('must_be_positive'));
            else move(target, velocity);
        },
    }, element('span', {}, say('move_to')), to, element('span', {}, unit), element('span', {}, say('at_velocity')), at, element('span', {}, `${unit}/s`), go);

    const hand = (speed: () => number) => `${fixed(speed(), 0)} ${unit}/s`;
    const root = element('div', { class: 'page axis' }, tabs,
        element('section', { class: 'panel head' }, element('div', { class: 'head-line' }, element('div', {}, position, element('span', { class: 'big-unit' }, unit)),
            element('div', { class: 'head-side' }, state_line, element('div', { class: 'lamps' }, ...Object.values(lamps)))), ruler.root),
        element('div', { class: 'columns' },
            element('div', { class: 'stack' },
                element('section', { class: 'panel' }, element('div', { class: 'buttons wide' }, power, home, reset, control, stop)),
                panel('jog', element('div', { class: 'jogs' }, ...jogs), element('p', { class: 'hint' }, `${say('jog_hint')}  − + ${hand(slow)} · −− ++ ${hand(fast)}`),
                    element('div', { class: 'line' }, steps[0], size, steps[1]), move_form)),
            element('div', { class: 'stack' },
                element('section', { class: 'panel' }, why_title, why_text),
                panel('values', element('div', { class: 'two' }, left.root, right.root)))));

    return {
        root,
        update(machine: MachineState) {
            const axis = machine.axes.find((a) => a.name === name);
            if (!axis || !layout) return;
            write(position, fixed(axis.actual_position));
            write_state(state_line, axis, word('axis', axis.state));
            write_lamp(lamps.powered, axis.powered, `${say('power')} ${say(axis.powered ? 'power_on_state' : 'power_off_state')}`);
            write_lamp(lamps.homed, axis.homed, say(axis.homed ? 'homed' : 'not_homed'));
            write_lamp(lamps.in_position, axis.in_position, say('in_position'));
            write_lamp(lamps.negative, axis.negative_limit_switch, say('limit_negative'), 'bad');
            write_lamp(lamps.home, axis.home_switch, say('home_switch'));
            write_lamp(lamps.positive, axis.positive_limit_switch, say('limit_positive'), 'bad');
            ruler.update(layout, axis);

            const reason = why(axis, machine);
            write(why_title, reason.title);
            const last = machine.events.filter((event) => event.axis === name).at(-1);
            const sentences = last ? [...reason.sentences, say('why_last_refusal', { what: last.english })] : reason.sentences;
            if (why_text.dataset['shown'] !== sentences.join('\n')) {
                why_text.dataset['shown'] = sentences.join('\n');
                why_text.replaceChildren(...sentences.map((sentence) => element('li', {}, sentence)));
            }
            write_values(left, right, axis, unit);

            const by_hand = machine.mode !== 'automatic' && axis.owner !== 'program' && !axis.disabled && !machine.emergency_stop;
            const resting = axis.powered && axis.state === 'Standstill';
            write(power, say(axis.powered ? 'power_off' : 'power_on'));
            desk.permit(power, axis.powered ? 'disable' : 'enable', axis.powered || by_hand);
            desk.permit(home, 'home', by_hand && resting);
            desk.permit(reset, 'reset', !axis.disabled);
            write(control, say(axis.owner === 'operator' ? 'release_control' : 'take_control'));
            desk.permit(control, axis.owner === 'operator' ? 'release_control' : 'take_control', !axis.disabled);
            for (const button of jogs) {
                const mine = desk.hold.axis === name;  // a button that is held stays as it is: greying it would take the pointer away
                desk.permit(button, 'jog', mine || (by_hand && axis.powered && ['Standstill', 'DiscreteMotion'].includes(axis.state)));
                mark(button, 'data-held', mine && document.activeElement === button);
            }
            for (const button of steps) desk.permit(button, 'move', by_hand && resting);
            desk.permit(go, 'move', by_hand && axis.powered && axis.state !== 'ErrorStop');
        },
    };
}

function write_values(left: Values, right: Values, axis: AxisState, unit: string): void {
    left.set('actual_position', `${fixed(axis.actual_position)} ${unit}`);
    left.set('set_position', `${fixed(axis.set_position)} ${unit}`);
    left.set('target_position', axis.has_job ? `${fixed(axis.target_position)} ${unit}` : '–');
    left.set('distance_to_go', axis.has_job ? `${fixed(value(axis.target_position) - value(axis.set_position))} ${unit}` : '–');
    left.set('following_error', `${fixed(axis.following_error)} ${unit}`);
    left.set('following_window', `${fixed(axis.following_window)} ${unit}`);
    left.set('actual_velocity', `${fixed(axis.actual_velocity)} ${unit}/s`);
    left.set('set_velocity', `${fixed(axis.set_velocity)} ${unit}/s`);
    left.set('set_acceleration', `${fixed(axis.set_acceleration, 1)} ${unit}/s²`);
    left.set('set_jerk', `${fixed(axis.set_jerk, 0)} ${unit}/s³`);
    left.set('actual_torque', `${fixed(value(axis.actual_torque) * 100, 1)} %`);
    right.set('owner', word('owner', axis.owner));
    right.set('command', axis.command || '–');
    right.set('block', axis.block || '–');
    right.set('queued', String(axis.queued));
    right.set('limiter', word('limiter', axis.velocity_limiter));
    right.set('override', `${fixed(value(axis.override) * 100, 0)} %`);
    right.set('drive_state', word('drive', axis.drive_state));
    right.set('drive_mode', word('drivemode', axis.drive_mode));
    right.set('status_word', hex(axis.status_word));
    right.set('error', axis.error === 0 ? say('none_of_these') : String(axis.error));
    right.set('drive_error', axis.drive_error === 0 ? say('none_of_these') : hex(axis.drive_error));
}
