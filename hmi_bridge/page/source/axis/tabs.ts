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

/** More axes than these are chosen from a list: their tabs would push the hands off the screen. */
const most_tabs = 10;

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
    const axes = (desk.link.layout?.axes ?? []).map((axis) => axis.name);
    const go = (to: string): void => { location.hash = `#${where(encodeURIComponent(to))}`; };
    const beside = (sign: string, key: Key, step: number): HTMLElement => element('button', { type: 'button', 'aria-label': say(key), title: say(key), 'data-do': key, onclick: () => go(axes.at((axes.indexOf(name) + step) % axes.length) ?? name) }, sign);
    const choice = (): HTMLElement[] => {
        const list = element('select', { 'aria-label': say('axis'), 'data-input': 'axis', onchange: () => go(list.value) }, ...axes.map((axis) => element('option', { value: axis }, axis)));
        list.value = name;
        return [beside('‹', 'axis_before', -1), list, beside('›', 'axis_behind', 1)];
    };
    return element('div', { class: 'bar' },
        element('nav', { class: 'tabs', 'aria-label': say('axis') }, ...(axes.length > most_tabs ? choice() : axes.map((axis) => tab(where(encodeURIComponent(axis)), axis, axis === name)))),
        element('span', { class: 'space' }),
        element('nav', { class: 'tabs parts', 'aria-label': say('axis_parts') }, ...parts.map((known) => tab(known.where(encodeURIComponent(name)), say(known.title), known.name === part))));
}
