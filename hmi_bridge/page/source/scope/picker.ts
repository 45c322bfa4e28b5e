// The tree of signals: searched by words, opened by groups, chosen by a tick; a word opens into its bits.
import { current_language, say, word } from '../texts';
import { element, mark } from '../view';
import { Session } from './session';
import { key_of, meaning, Signal, tree } from './signals';

/** Lines that are drawn of a search; a machine has thousands of signals. */
const most_lines = 400;

export class Picker {
    readonly root: HTMLElement;
    private readonly search_ = element('input', { type: 'search', placeholder: say('scope_search'), 'aria-label': say('scope_search'), oninput: () => this.fill() });
    private readonly list_ = element('div', { class: 'scope-tree' });
    private readonly open_ = new Set<string>();
    private filled_: unknown;

    constructor(private readonly session_: Session, private readonly changed_: () => void) {
        this.root = element('div', { class: 'scope-picker' }, this.search_, this.list_);
    }
    update(): void {
        const signals = this.session_.scene?.signals;
        if (signals !== this.filled_) {
            this.filled_ = signals;
            const first = [...(signals?.values() ?? [])].find((s) => s.group === 'axis');
            if (first && this.open_.size === 0) this.open_.add(`axis/${first.of}`);
            this.fill();
            return;
        }
        const chosen = new Set(this.session_.setup.channels.map(key_of));
        for (const tick of this.list_.querySelectorAll<HTMLInputElement>('input[data-signal]')) {
            const on = chosen.has(tick.dataset['signal'] ?? '');
            if (tick.checked !== on) tick.checked = on;
        }
    }
    focus(): void {
        this.search_.focus();
    }

    private fill(): void {
        const signals = [...(this.session_.scene?.signals.values() ?? [])], search = this.search_.value.trim();
        let lines = 0;
        const parts = tree(signals, search).map(({ group, of, signals: members }) => {
            const key = `${group}/${of}`, open = search !== '' || this.open_.has(key);
            const body = element('div', { class: 'scope-branch' });
            if (open) for (const signal of members) if (lines++ < most_lines) body.append(...this.line(signal));
            const head = element('button', { type: 'button', class: 'scope-group', 'aria-expanded': open ? 'true' : 'false', 'data-group': key, onclick: () => {
                if (!this.open_.delete(key)) this.open_.add(key);
                this.fill();
                this.list_.querySelector<HTMLElement>(`[data-group="${CSS.escape(key)}"]`)?.focus();
            } }, `${open ? '▾' : '▸'} ${word('scope_group', group)}${of ? ` ${of}` : ''} (${members.length})`);
            return element('div', {}, head, body);
        });
        const hint = signals.length === 0 ? say('scope_no_signals') : parts.length === 0 ? say('scope_nothing_found') : lines > most_lines ? say('scope_more_found', { count: String(lines - most_lines) }) : '';
        this.list_.replaceChildren(...parts, ...(hint ? [element('p', { class: 'hint' }, hint)] : []));
        this.update();
    }
    private line(signal: Signal): HTMLElement[] {
        const one = (key: string, text: string, bit?: number): HTMLElement => {
            const tick = element('input', { type: 'checkbox', 'data-signal': key, onchange: () => {
                if (tick.checked) this.session_.add(signal.name, bit);
                else this.session_.remove(key);
                this.changed_();
            } });
            return element('label', { class: bit === undefined ? 'scope-line' : 'scope-line bit' }, tick, element('span', {}, text),
                element('small', {}, bit === undefined ? `${signal.unit ? `[${signal.unit}] ` : ''}${meaning(signal, current_language())}` : ''));
        };
        const short = signal.group !== 'task' && signal.name.includes('.') ? signal.name.slice(signal.name.indexOf('.') + 1) : signal.name;
        const lines = [one(signal.name, short)];
        if (signal.kind === 'word') {
            const open = this.open_.has(signal.name);
            const bits = element('button', { type: 'button', class: 'scope-bits', 'aria-label': say('scope_bits_of', { name: signal.name }), onclick: () => {
                if (!this.open_.delete(signal.name)) this.open_.add(signal.name);
                this.fill();
            } }, say('scope_bits'));
            mark(bits, 'aria-expanded', open ? 'true' : 'false');
            (lines[0] as HTMLElement).append(bits);
            if (open) for (let bit = 0; bit < 32; bit++) lines.push(one(`${signal.name}.${bit}`, `${short}.${bit}`, bit));
        }
        return lines;
    }
}
