// The watch table: the variables that this person chose, remembered by this browser for this machine.
import { Desk } from './desk';
import { plain } from './numbers';
import { remember, remembered_list } from './remembered';
import { MachineState, Real } from './state';
import { say } from './texts';
import { element, mark, Rows, write } from './view';

interface Variable {
    program: string;
    name: string;
    unit: string;
    value: Real;
}
/** Without a choice the first ones are shown. */
const first_shown = 12;

export const full = (of: { program: string; name: string }): string => `${of.program}.${of.name}`;

export class Watch {
    private readonly choosing_ = element('button', { type: 'button', 'data-do': 'choose', 'aria-expanded': 'false', onclick: () => this.choose(this.choosing_.getAttribute('aria-expanded') !== 'true') }, say('choose_variables'));
    private readonly filter_ = element('input', { type: 'search', 'aria-label': say('filter'), placeholder: say('filter'), 'data-input': 'filter' });
    private readonly body_ = element('tbody');
    private readonly none_ = element('p', { class: 'hint' }, say('no_variables'));
    private readonly key_: string;
    private chosen_: Set<string> | undefined;
    private readonly rows_: { update(items: readonly Variable[]): void };
    readonly root = element('div', {}, element('div', { class: 'bar' }, this.filter_, this.choosing_), this.none_, element('div', { class: 'scroll' }, element('table', { class: 'watch' }, this.body_)));

    constructor(desk: Desk) {
        this.key_ = `watch/${desk.link.machine}`;
        const chosen = remembered_list(this.key_);
        if (chosen.length > 0) this.chosen_ = new Set(chosen);
        this.rows_ = new Rows(this.body_, full, (variable: Variable) => {
            const name = full(variable), doc = desk.link.layout?.variables.find((v) => full(v) === name)?.doc ?? '';
            const box = element('input', { type: 'checkbox', 'aria-label': name, onchange: () => this.keep(name, box.checked) });
            const boxed = element('td', { class: 'box' }, box), shown = element('td', { class: 'number', 'data-value': 'value' });
            const root = element('tr', { 'data-variable': name }, boxed, element('th', { scope: 'row', title: doc }, name), shown, element('td', { class: 'unit' }, variable.unit), element('td', { class: 'doc', lang: 'en' }, doc));
            return { root, shown, box, boxed };
        }, (row, variable) => {
            write(row.shown, plain(variable.value));
            row.boxed.hidden = !this.choosing;
            const kept = this.chosen_?.has(full(variable)) ?? false;
            if (row.box.checked !== kept) row.box.checked = kept;
        });
    }
    update(state: MachineState): void {
        const wanted = this.filter_.value.trim().toLowerCase();
        const shown = wanted || this.choosing ? state.variables.filter((v) => full(v).toLowerCase().includes(wanted))
            : state.variables.filter((v, i) => this.chosen_ ? this.chosen_.has(full(v)) : i < first_shown);
        this.rows_.update(shown);
        this.none_.hidden = state.variables.length > 0;
        this.choosing_.hidden = this.filter_.hidden = state.variables.length === 0;
    }
    private get choosing(): boolean {
        return this.choosing_.getAttribute('aria-expanded') === 'true';
    }
    private choose(on: boolean): void {
        mark(this.choosing_, 'aria-expanded', on ? 'true' : 'false');
        write(this.choosing_, say(on ? 'choosing_done' : 'choose_variables'));
    }
    private keep(name: string, kept: boolean): void {
        this.chosen_ ??= new Set();
        if (kept) this.chosen_.add(name);
        else this.chosen_.delete(name);
        if (this.chosen_.size === 0) this.chosen_ = undefined;
        remember(this.key_, JSON.stringify([...(this.chosen_ ?? [])]));
    }
}
