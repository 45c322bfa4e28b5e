// The kinds of widgets, a line each.
import { say } from '../texts';
import { element } from '../view';
import { image_widget } from './image';
import { alarms_widget, axis_widget } from './machine';
import { bar_widget, lamp_widget, text_widget, value_widget } from './shown';
import { trend_widget } from './trend';
import { boxed, MakeWidget } from './widget';
import { button_widget, set_widget, switch_widget } from './written';

const kinds: Record<string, MakeWidget> = {
    value: value_widget,
    lamp: lamp_widget,
    bar: bar_widget,
    text: text_widget,
    button: button_widget,
    switch: switch_widget,
    set: set_widget,
    trend: trend_widget,
    axis: axis_widget,
    alarms: alarms_widget,
    image: image_widget,
};

/** A machine that is newer than this page has kinds that it does not know. */
const unknown_widget: MakeWidget = (_desk, layout) => ({ root: boxed(layout, 'unknown', element('p', { class: 'hint' }, say('view_unknown_widget', { kind: layout.kind }))), update: () => undefined });

export const widget_of = (kind: string): MakeWidget => (Object.hasOwn(kinds, kind) ? kinds[kind] : undefined) ?? unknown_widget;
