// What every widget is, and the frame around it: label above, so that rows of widgets stand in line.
import { Desk } from '../desk';
import { MachineState } from '../state';
import { element } from '../view';
import { local, ShownValue, WidgetLayout } from './builder_views';

export interface Widget {
    readonly root: HTMLElement;
    update(state: MachineState): void;
    leave?(): void;
}
export type MakeWidget = (desk: Desk, layout: WidgetLayout) => Widget;

const nothing: ShownValue = { name: '', source: 'machine', of: '', member: '', form: 'number', unit: '', whole: false };
export const first_value = (layout: WidgetLayout): ShownValue => layout.values?.[0] ?? nothing;
export const label_of = (layout: WidgetLayout): string => local(layout.label) || first_value(layout).name || (layout.axis ?? '');

export function boxed(layout: WidgetLayout, kind: string, ...children: (Node | string)[]): HTMLElement {
    const label = label_of(layout);
    return element('section', { class: `panel widget widget-${kind}`, 'data-widget': kind, 'data-of': first_value(layout).name || (layout.axis ?? layout.image ?? '') },
        ...(label ? [element('h2', {}, label)] : []), ...children);
}
