// Widgets that only show: a value, a lamp, a bar, a text.
import { write_lamp } from '../desk';
import { fixed } from '../numbers';
import { say } from '../texts';
import { element, mark, write } from '../view';
import { local } from './builder_views';
import { decimals_for, doubtful, is_on, number_of, text_of } from './reading';
import { boxed, first_value, label_of, MakeWidget } from './widget';

export const value_widget: MakeWidget = (_desk, layout) => {
    const shown = first_value(layout), number = element('span', { class: 'widget-number', 'data-value': 'value' });
    const root = boxed(layout, 'value', element('div', { class: 'widget-line' }, number, ...(shown.unit ? [element('span', { class: 'widget-unit' }, shown.unit)] : [])));
    return {
        root,
        update(state) {
            const doubt = doubtful(state, shown);
            write(number, (doubt ? '? ' : '') + text_of(state, shown, layout.decimals));
            mark(number, 'data-form', shown.form);
            mark(root, 'data-doubtful', doubt);
        },
    };
};

export const lamp_widget: MakeWidget = (_desk, layout) => {
    const shown = first_value(layout), lamp = element('span', { class: 'widget-lamp', 'data-value': 'lamp' });
    const root = boxed(layout, 'lamp', element('div', { class: 'widget-line' }, lamp));
    return {
        root,
        update(state) {
            const on = is_on(state, shown);
            write_lamp(lamp, on, say(on ? 'view_on' : 'view_off') + (doubtful(state, shown) ? ' ?' : ''), layout.tone);
            mark(root, 'data-on', on);
        },
    };
};

/** Between two ends; what lies beyond stays at the end, and is marked. */
export const bar_widget: MakeWidget = (_desk, layout) => {
    const shown = first_value(layout);
    const low = layout.minimum ?? shown.minimum ?? 0, high = layout.maximum ?? shown.maximum ?? 1;
    const number = element('span', { class: 'widget-number', 'data-value': 'value' });
    const fill = element('div', { class: 'bar-fill' }), track = element('div', { class: 'bar-track', role: 'meter', 'aria-label': label_of(layout), 'aria-valuemin': String(low), 'aria-valuemax': String(high) }, fill);
    const places = Math.min(2, decimals_for(shown, layout.decimals) ?? 2);
    const end = (at: number) => fixed(at, Number.isInteger(at) ? 0 : places);
    const root = boxed(layout, 'bar', element('div', { class: 'widget-line' }, number, element('span', { class: 'widget-unit' }, shown.unit)), track,
        element('div', { class: 'bar-ends' }, element('span', {}, end(low)), element('span', {}, end(high))));
    return {
        root,
        update(state) {
            const is = number_of(state, shown), part = (at: number) => Math.min(1, Math.max(0, (at - low) / (high - low)));
            const doubt = doubtful(state, shown);
            write(number, (doubt ? '? ' : '') + text_of(state, shown, layout.decimals));
            mark(root, 'data-doubtful', doubt);
            const zero = low < 0 && high > 0 ? part(0) : 0, at = Number.isNaN(is) ? zero : part(is);
            fill.style.left = `${(Math.min(zero, at) * 100).toFixed(2)}%`;
            fill.style.width = `${(Math.abs(at - zero) * 100).toFixed(2)}%`;
            mark(track, 'aria-valuenow', Number.isNaN(is) ? false : String(is));
            mark(root, 'data-beyond', is < low || is > high);
        },
    };
};

export const text_widget: MakeWidget = (_desk, layout) => ({ root: element('section', { class: 'widget widget-text', 'data-widget': 'text' }, element('p', {}, local(layout.label))), update: () => undefined });
