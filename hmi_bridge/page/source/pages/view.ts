// A page of the machine builder's own: rows of widgets, as the machine file has them.
import { Desk, Page } from '../desk';
import { say } from '../texts';
import { element } from '../view';
import { columns, spans_of } from '../views/spans';
import { Widget } from '../views/widget';
import { widget_of } from '../views/widgets';

export function builder_view(desk: Desk, rest: readonly string[]): Page {
    const view = desk.views.find(rest[0]);
    const root = element('div', { class: 'page view' });
    const widgets: Widget[] = [];
    for (const row of view?.rows ?? []) {
        const line = element('div', { class: 'view-row' }), spans = spans_of(row.map((layout) => layout.width));
        row.forEach((layout, i) => {
            const widget = widget_of(layout.kind)(desk, layout);
            widget.root.style.gridColumn = `span ${spans[i] ?? columns}`;
            widgets.push(widget);
            line.append(widget.root);
        });
        root.append(line);
    }
    if (!view) root.append(element('p', { class: 'hint' }, say('view_none')));
    return {
        root,
        update: (state) => widgets.forEach((widget) => widget.update(state)),
        leave: () => widgets.forEach((widget) => widget.leave?.()),
    };
}
