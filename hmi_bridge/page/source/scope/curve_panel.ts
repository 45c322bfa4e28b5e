// What can be set for one curve and its lane.
import { typed } from '../numbers';
import { say } from '../texts';
import { element } from '../view';
import { Session } from './session';
import { Channel, key_of } from './signals';
import { sample_of, Stack } from './stack';

export function curve_panel(session: Session, stack: Stack, channel: Channel, changed: () => void, closed: () => void): HTMLElement {
    const key = key_of(channel), lane = stack.lane_of(key), unit = session.signal(channel.name)?.unit ?? '';
    const again = (): void => {
        session.changed();
        changed();
    };
    const complaint = element('p', { class: 'scope-complaint', role: 'alert' });
    const offset = element('input', { type: 'text', inputmode: 'decimal', value: String(channel.offset), 'data-field': 'offset', onchange: () => {
        const value = typed(offset.value);
        if (Number.isNaN(value)) offset.value = String(channel.offset);
        else channel.offset = value;
        again();
    } });
    const sample = element('span', {}, sample_of(channel));
    const colour = element('button', { type: 'button', 'data-do': 'colour', onclick: () => {
        channel.colour = (channel.colour + 1) % 32;
        sample.replaceChildren(sample_of(channel));
        again();
    } }, say('scope_next_colour'));
    const apart = element('input', { type: 'checkbox', ...(channel.apart ? { checked: true } : {}), onchange: () => {
        channel.apart = apart.checked;
        again();
    } });
    const move = (by: number): void => {
        const list = session.setup.channels, at = list.indexOf(channel), to = at + by;
        if (to < 0 || to >= list.length) return;
        list.splice(at, 1);
        list.splice(to, 0, channel);
        again();
    };
    const parts: HTMLElement[] = [];
    if (lane && !lane.digital) {
        const range = stack.range_of(lane.key);
        const field = (value: number | undefined, name: string): HTMLInputElement => element('input', { type: 'text', inputmode: 'decimal', 'data-field': name, value: value === undefined ? '' : String(Number(value.toPrecision(6))) });
        const from = field(range?.min, 'min'), to = field(range?.max, 'max');
        const set = (): void => {
            const min = typed(from.value), max = typed(to.value);
            complaint.textContent = min < max ? '' : say('scope_scale_order');
            if (min < max) stack.set_scale(stack.lane_of(key)?.key ?? lane.key, { min, max });
        };
        parts.push(element('h3', {}, `${say('scope_scale')} ${lane.unit ? `[${lane.unit}]` : ''}`),
            element('label', { class: 'scope-field' }, element('span', {}, say('scope_scale_from')), from), element('label', { class: 'scope-field' }, element('span', {}, say('scope_scale_to')), to),
            element('div', { class: 'buttons wide' }, element('button', { type: 'button', 'data-do': 'scale', onclick: set }, say('scope_manual_scale')),
                element('button', { type: 'button', 'data-do': 'autoscale', onclick: () => stack.set_scale(stack.lane_of(key)?.key ?? lane.key, undefined) }, say('scope_automatic_scale'))), complaint);
    }
    return element('div', { class: 'scope-form' }, element('h3', {}, sample, ' ', key), element('label', { class: 'scope-field' }, element('span', {}, say('scope_offset')), offset, element('small', {}, unit)),
        element('div', { class: 'scope-field' }, element('span', {}, say('scope_colour')), colour), ...(lane?.digital ? [] : [element('label', { class: 'scope-field' }, element('span', {}, say('scope_apart')), apart)]),
        element('div', { class: 'buttons wide' }, element('button', { type: 'button', onclick: () => move(-1) }, `▲ ${say('scope_up')}`), element('button', { type: 'button', onclick: () => move(1) }, `▼ ${say('scope_down')}`)),
        ...parts, element('button', { type: 'button', 'data-do': 'remove', onclick: () => {
            session.remove(key);
            closed();
            changed();
        } }, say('scope_remove')));
}
