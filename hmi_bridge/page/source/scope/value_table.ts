// The list below the picture: each curve with its value, both cursors, what lies between, and its figures.
import { current_language, say } from '../texts';
import { element, mark, Rows, write } from '../view';
import { figure_text, measured, value_text } from './cursors';
import { Session } from './session';
import { bit_of, Channel, key_of, meaning, Signal } from './signals';
import { sample_of } from './stack';
import { state_text } from './state_words';
import { Figures } from './statistics';

const figure_keys = ['scope_min', 'scope_max', 'scope_mean', 'scope_rms', 'scope_pp', 'scope_deviation'] as const;
/** Samples that are looked at four times a second; beyond that once a second. */
const many_samples = 4e6;

interface Line {
    root: HTMLElement;
    show: HTMLInputElement;
    number: HTMLElement;
    cells: HTMLElement[];
}

export class ValueTable {
    readonly root: HTMLElement;
    private readonly head_: HTMLElement[];
    private readonly rows_: Rows<Channel, Line>;
    private readonly between_ = element('p', { class: 'scope-between', 'aria-live': 'off' });
    private computed_at_ = 0;
    private last_ = '';

    constructor(private readonly session_: Session, changed: () => void, private readonly chosen_: (key: string) => void) {
        const titles = ['', 'scope_curve', 'unit', 'scope_newest', 'scope_at_a', 'scope_at_b', 'scope_difference', ...figure_keys] as const;
        this.head_ = titles.map((key) => element('th', { scope: 'col' }, key ? say(key) : ''));
        const body = element('tbody');
        this.rows_ = new Rows<Channel, Line>(body, (channel) => `${key_of(channel)} ${channel.colour} ${session_.scene?.title ?? ''}`, (channel) => {
            const key = key_of(channel), signal = session_.signal(channel.name);
            const show = element('input', { type: 'checkbox', 'data-show': key, onchange: () => {
                channel.hidden = !show.checked;
                changed();
            } });
            const number = element('b');
            const cells = titles.slice(3).map((_, i) => element('td', { class: 'number', 'data-value': ['newest', 'a', 'b', 'difference', 'min', 'max', 'mean', 'rms', 'pp', 'deviation'][i] ?? '' }));
            const name = element('button', { type: 'button', class: 'scope-link', title: signal ? meaning(signal, current_language()) : say('scope_unknown'), onclick: () => this.chosen_(key) }, key);
            return { root: element('tr', { 'data-row': key }, element('td', {}, element('label', { class: 'scope-show' }, show, sample_of(channel))), element('th', { scope: 'row' }, number, ' ', name), element('td', {}, signal?.unit ?? ''), ...cells), show, number, cells };
        }, (row, channel) => {
            const offset = channel.offset === 0 ? '' : ` (${channel.offset > 0 ? '+' : '−'}${Math.abs(channel.offset)})`;
            write(row.number, String(session_.setup.channels.indexOf(channel) + 1) + offset);
            if (row.show.checked === channel.hidden) row.show.checked = !channel.hidden;
            mark(row.show, 'aria-label', say('scope_show', { name: key_of(channel) }));
            mark(row.root, 'data-off', channel.hidden);
        });
        const scroll = element('div', { class: 'scope-scroll', tabindex: '0', 'aria-label': say('scope_values') }, element('table', {}, element('thead', {}, element('tr', {}, ...this.head_)), body));
        const fold = element('button', { type: 'button', class: 'scope-fold', 'aria-expanded': 'true', 'aria-label': say('scope_values'), title: say('scope_values'), onclick: () => {
            scroll.hidden = !scroll.hidden;
            write(fold, scroll.hidden ? '▴' : '▾');
            mark(fold, 'aria-expanded', scroll.hidden ? 'false' : 'true');
        } }, '▾');
        this.root = element('section', { class: 'scope-values' }, fold, this.between_, scroll);
    }

    update(now: number, pointed: number | undefined, time_of: (cycle: number) => string, rate: (a: number, b: number) => string): void {
        const { scene, cursors, setup } = this.session_;
        this.rows_.update(setup.channels);
        this.head_.forEach((head, i) => (head.hidden = i >= 3 && i <= 6 && cursors.shown === (i === 3)));
        if (!scene) return;
        const view = scene.view, range = measured(cursors, view.from, view.to);
        // Under the mouse, else at the right edge.
        const newest = pointed ?? Math.min(scene.store.newest - 1, view.follow ? Infinity : Math.floor(view.to));
        const samples = (range.to - range.from) * setup.channels.length;
        const state = JSON.stringify([cursors, range, newest, setup.channels]);
        if (state === this.last_ || now - this.computed_at_ < (samples > many_samples ? 1000 : pointed === undefined ? 250 : 80)) return;
        write(this.head_[3] as Element, say(pointed === undefined ? 'scope_newest' : 'scope_pointed'));
        this.last_ = state;
        this.computed_at_ = now;
        write(this.between_, cursors.shown
            ? `A ${time_of(cursors.a)}   B ${time_of(cursors.b)}   Δt ${value_text(Number(((scene.seconds(cursors.b) - scene.seconds(cursors.a)) * 1e3).toFixed(6)))} ms   1/Δt ${rate(scene.seconds(cursors.a), scene.seconds(cursors.b))}   ${say('scope_between')}`
            : say('scope_over_view', { from: time_of(range.from), to: time_of(range.to) }));
        for (const [i, channel] of setup.channels.entries()) {
            const line = this.rows_.row(`${key_of(channel)} ${channel.colour} ${scene.title}`);
            if (!line || i > 255) continue;
            const signal = scene.signals.get(channel.name);
            const at = (cycle: number): number => {
                const value = scene.store.at(channel.name, cycle);
                return (channel.bit === undefined ? value : bit_of(value, channel.bit)) + channel.offset;
            };
            const figures = new Figures();
            scene.store.each(channel.name, range.from, range.to, (piece) => figures.add(piece, channel.offset, channel.bit));
            const { min, max, mean, rms, peak_to_peak, deviation, missing } = figures.of(Math.max(0, Math.min(range.to, scene.store.newest) - Math.max(range.from, scene.store.tracks.get(channel.name)?.have.list[0]?.from ?? 0)));
            const a = at(cursors.a), b = at(cursors.b);
            const texts = [shown(signal, channel, at(newest)), shown(signal, channel, a), shown(signal, channel, b), figure_text(b - a), ...[min, max, mean, rms, peak_to_peak, deviation].map(figure_text)];
            line.cells.forEach((cell, k) => {
                write(cell, texts[k] ?? '');
                if (k === 4 || k === 5) mark(cell, 'title', value_text(k === 4 ? min : max));
                if (k <= 3) cell.hidden = cursors.shown === (k === 0);
            });
            mark(line.root, 'data-missing', missing > 0);
            mark(line.root, 'title', missing > 0 ? say('scope_missing', { count: String(missing) }) : false);
        }
    }
}

function shown(signal: Signal | undefined, channel: Channel, value: number): string {
    if (signal?.kind === 'state' && channel.bit === undefined) return Number.isNaN(value) ? '–' : state_text(signal, value);
    if (signal?.kind === 'word' && channel.bit === undefined && Number.isInteger(value)) return `${value < 0 ? '−' : ''}${Math.abs(value).toString(16).toUpperCase().padStart(4, '0')}h`;
    return value_text(value);
}
