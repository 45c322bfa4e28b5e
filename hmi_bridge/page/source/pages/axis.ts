// One axis: where it is, why it does not move, and the hands to move it; and its drive (../axis/drive.ts).
import { drive_page } from '../axis/drive';
import { hands } from '../axis/hands';
import { AxisHead } from '../axis/head';
import { axis_of, axis_tabs } from '../axis/tabs';
import { AxisValues } from '../axis/values';
import { why } from '../axis/why';
import { Desk, Page } from '../desk';
import { write_said } from '../sentences/said';
import { MachineState, value } from '../state';
import { say } from '../texts';
import { element, write } from '../view';

/** `#axis/NAME`, `#axis/NAME/drive`; the first one where there is none of that name. */
export function axis_page(desk: Desk, [wanted = '', part = '']: readonly string[]): Page {
    const name = axis_of(desk, wanted);
    const layout = desk.axis_layout(name);
    if (!layout) return { root: element('div', { class: 'page axis' }, element('p', { class: 'hint' }, say('no_axes'))), update: () => undefined };
    if (part === 'drive') return drive_page(desk, layout);

    const head = new AxisHead(desk, layout), values = new AxisValues(desk, name, layout.unit, value(layout.modulo) > 0), hand = hands(desk, name);
    const why_title = element('h2'), why_text = element('ul', { class: 'why', 'data-value': 'why' });
    const refusal = element('span'), refused = element('span', { 'data-value': 'last_refusal' });
    const root = element('div', { class: 'page axis' }, axis_tabs(desk, name, 'hand'), head.root,
        element('div', { class: 'columns' }, hand.root, element('div', { class: 'stack' }, element('section', { class: 'panel' }, why_title, why_text, element('p', { class: 'refusal' }, refusal, refused)), values.root)));
    return {
        root,
        update(machine: MachineState) {
            const axis = machine.axes.find((a) => a.name === name);
            if (!axis) return;
            head.update(axis);
            hand.update(axis, machine);
            values.update(axis);
            const reason = why(axis, machine);
            write(why_title, reason.title);
            const last = machine.events.filter((event) => event.axis === name).at(-1);
            write(refusal, last ? say('why_last_refusal') : '');
            write_said(refused, last?.english ?? '');
            const sentences = reason.sentences;
            if (why_text.dataset['shown'] !== sentences.join('\n')) {
                why_text.dataset['shown'] = sentences.join('\n');
                why_text.replaceChildren(...sentences.map((sentence) => element('li', {}, sentence)));
            }
        },
    };
}
