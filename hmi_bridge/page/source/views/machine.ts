// Widgets of a whole thing of the machine: an axis, what alarms stand.
import { write_state } from '../desk';
import { in_words, where } from '../alarm_words';
import { fixed } from '../numbers';
import { is_old } from '../axis/is_old';
import { Ruler } from '../axis/ruler';
import { say, word } from '../texts';
import { element, mark, Rows, write } from '../view';
import { Alarm, value } from '../state';
import { boxed, MakeWidget } from './widget';

/** Leads to the axis' own page. */
export const axis_widget: MakeWidget = (desk, layout) => {
    const name = layout.axis ?? '', ruler = new Ruler();
    const state_line = element('span', { class: 'widget-state', 'data-value': 'state' });
    const position = element('span', { class: 'widget-number', 'data-value': 'position' }), unit = element('span', { class: 'widget-unit' });
    const velocity = element('span', { class: 'widget-range', 'data-value': 'velocity' });
    const more = element('a', { href: `#axis/${encodeURIComponent(name)}`, class: 'row-link' }, say('view_axis_page'));
    const root = boxed(layout, 'axis', element('div', { class: 'widget-line' }, position, unit, state_line, velocity), ruler.root, more);
    return {
        root,
        update(state) {
            const axis = state.axes.find((one) => one.name === name), about = desk.axis_layout(name);
            if (!axis) return;
            const old = is_old(axis);
            mark(root, 'data-doubtful', old);
            write(position, `${old ? '? ' : ''}${fixed(axis.actual_position, 2)}`);
            write(unit, axis.unit);
            write(velocity, old ? say('last_known') : `${fixed(axis.actual_velocity, 1)} ${axis.unit}/s`);
            write_state(state_line, axis, word('axis', axis.state));
            if (about) ruler.update(about, axis);
            mark(ruler.root, 'data-homed', axis.homed && !Number.isNaN(value(axis.actual_position)));
        },
    };
};

/** The standing ones, with the reset that an operator needs first. */
export const alarms_widget: MakeWidget = (desk, layout) => {
    const list = element('ul', { class: 'view-alarms' }), calm = element('p', { class: 'calm' }, `✓ ${say('view_no_alarm')}`);
    const reset = desk.button('reset_all', () => ({ cmd: 'reset' }), 'primary');
    const rows = new Rows(list, (alarm: Alarm) => `${alarm.source}/${alarm.name}`, (alarm) => {
        const text = element('span');
        return { root: element('li', {}, element('a', { href: '#alarms', title: in_words(alarm) }, element('b', {}, `⚠ ${where(alarm.source)}: `), text)), text };
    }, (row, alarm) => write(row.text, in_words(alarm)));
    const root = boxed(layout, 'alarms', calm, element('div', { class: 'alarm-line' }, list, reset));
    return {
        root,
        update(state) {
            const standing = state.alarms.filter((alarm) => alarm.standing || !alarm.acknowledged);
            rows.update(standing);
            calm.hidden = standing.length > 0;
            reset.hidden = standing.length === 0;
            desk.permit(reset, 'reset');
        },
    };
};
