// Which axis, and what of it: the lines above every page about one axis.
import { Desk } from '../desk';
import { Key, say } from '../texts';
import { element, mark } from '../view';

/** The parts of an axis, a line each: where they stand and what they are called. */
const parts: readonly { name: string; title: Key; where(axis: string): string }[] = [
    { name: 'hand', title: 'axis_hand', where: (axis) => `axis/${axis}` },
    { name: 'measure', title: 'axis_measure', where: (axis) => `measure/${axis}` },
    { name: 'drive', title: 'axis_drive', where: (axis) => `axis/${axis}/drive` },
];

/** The axis of the address; the first one where there is none of that name. */
export function axis_of(desk: Desk, wanted = ''): string {
    const known = desk.link.layout?.axes ?? [];
    return (known.find((axis) => axis.name === wanted) ?? known[0])?.name ?? '';
}

/** `part`: the one shown; another axis is shown in the same part. */
export function axis_tabs(desk: Desk, name: string, part: string): HTMLElement {
    const where = parts.find((known) => known.name === part)?.where ?? ((axis: string) => `${part}/${axis}`);
    const tab = (address: string, text: string, shown: boolean): HTMLElement => {
        const made = element('a', { href: `#${address}` }, text);
        mark(made, 'aria-current', shown ? 'page' : false);
        return made;
    };
    return element('div', { class: 'bar' },
        element('nav', { class: 'tabs', 'aria-label': say('axis') }, ...(desk.link.layout?.axes ?? []).map((axis) => tab(where(encodeURIComponent(axis.name)), axis.name, axis.name === name))),
        element('span', { class: 'space' }),
        element('nav', { class: 'tabs parts', 'aria-label': say('axis_parts') }, ...parts.map((known) => tab(known.where(encodeURIComponent(name)), say(known.title), known.name === part))));
}
