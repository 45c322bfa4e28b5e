// The parameters of a drive by the manual's names: filtered, read, compared, written one at a time and only after it has been confirmed.
import { Desk, panel } from '../desk';
import { Inquiry } from '../inquiry';
import { plain } from '../numbers';
import { file_time, save_file } from '../save';
import { said } from '../sentences/said';
import { AxisLayout, AxisState } from '../state';
import { current_language, say, word } from '../texts';
import { element, mark, Rows, small_window, write } from '../view';

/** As the machine says it (hmi_bridge/README.md, `drive_parameters`). */
export interface DriveParameter {
    /** As drive_read takes it: `P05.13`, `6084h`. */
    id: string;
    object: string;
    english: string;
    chinese: string;
    unit: string;
    minimum: number | null;
    maximum: number | null;
    /** How drive_read would show it; empty: unknown. */
    factory_shown: string;
    factory_is: string;
    /** What the values mean, in the manual's words. */
    meaning: string;
    readable: boolean;
    writable: boolean;
    change: string;
    effective: string;
    manual: string;
}

/** More are not shown at once: a filter is there. */
const most_shown = 200;
/** Before why it could not be read, in place of its value. */
const unread = '⚠ ';

export const range_text = ({ minimum, maximum }: DriveParameter): string =>
    minimum === null ? (maximum === null ? '' : `≤ ${plain(maximum)}`) : maximum === null ? `≥ ${plain(minimum)}` : `${plain(minimum)} … ${plain(maximum)}`;
const factory_text = (parameter: DriveParameter): string => (parameter.factory_shown ? `${parameter.factory_shown}${parameter.factory_is === 'assumed' ? ` (${say('assumed')})` : ''}` : say('factory_unknown'));

/** Whether two texts of a value say the same: "250 ms" and "250.0 ms". */
export function same_value(a: string, b: string): boolean {
    const number = (text: string) => Number(text.trim().split(/\s+/)[0]);
    return a.trim() === b.trim() || (a.trim() !== '' && number(a) === number(b));
}

export class DriveParameters {
    private all_: DriveParameter[] = [];
    private readonly read_ = new Map<string, string>();
    private saved_: Map<string, string> | undefined;
    private reading_ = 0;
    private left_ = false;
    private moving_ = false;
    private readonly filter_ = element('input', { type: 'search', 'aria-label': say('filter'), placeholder: say('filter_parameters'), 'data-input': 'filter' });
    private readonly against_ = element('select', { 'aria-label': say('compare'), 'data-input': 'compare' }, ...(['compare_nothing', 'compare_factory', 'compare_saved'] as const).map((key) => element('option', { value: key }, say(key))));
    private readonly different_ = element('input', { type: 'checkbox', 'data-input': 'different' });
    private readonly read_all_ = element('button', { type: 'button', 'data-do': 'read_all', onclick: () => void this.read_shown() }, say('read_shown'));
    private readonly save_ = element('button', { type: 'button', 'data-do': 'save', onclick: () => this.save() }, say('save_set'));
    private readonly file_ = element('input', { type: 'file', accept: '.json,application/json', hidden: true, 'data-input': 'set' });
    private readonly load_ = element('button', { type: 'button', 'data-do': 'load', onclick: () => this.file_.click() }, say('load_set'));
    private readonly said_ = element('p', { class: 'hint', role: 'status' });
    private most_ = most_shown;
    private readonly more_ = element('button', { type: 'button', 'data-do': 'more_parameters', onclick: () => { this.most_ += most_shown; } }, say('show_more'));
    private readonly body_ = element('tbody');
    private readonly dialog_ = small_window({});
    private readonly inquiry_: Inquiry;
    private readonly rows_: { update(items: readonly DriveParameter[]): void };
    readonly root: HTMLElement;

    constructor(private readonly desk_: Desk, private readonly layout_: AxisLayout) {
        this.inquiry_ = new Inquiry(desk_, () => ({ cmd: 'drive_parameters', axis: layout_.name }), Infinity, (answer) => {
            if (answer.ok) this.all_ = (answer['drive_parameters'] as { parameters: DriveParameter[] }).parameters;
            else this.desk_.refused(answer);
        });
        this.rows_ = new Rows(this.body_, (parameter: DriveParameter) => parameter.id, (parameter) => {
            const shown = element('td', { class: 'number', 'data-value': 'value' }), other = element('td', { class: 'number' });
            const read = element('button', { type: 'button', class: 'small', 'data-cmd': 'drive_read', 'aria-label': `${say('read')} ${parameter.id}`, onclick: () => void this.read(parameter.id) }, say('read'));
            const change = element('button', { type: 'button', class: 'small', 'data-cmd': 'drive_write', 'aria-label': `${say('change')} ${parameter.id}`, onclick: () => this.ask(parameter) }, say('change'));
            const root = element('tr', { 'data-parameter': parameter.id }, element('th', { scope: 'row' }, parameter.id, element('small', { class: 'doc', lang: current_language() }, this.title(parameter))), shown, other,
                element('td', { class: 'range' }, range_text(parameter), ...(parameter.writable ? [element('small', { class: 'doc' }, word('effective', parameter.effective))] : [])), element('td', { class: 'buttons' }, ...(parameter.readable ? [read] : []), ...(parameter.writable ? [change] : [])));
            return { root, shown, other, change, read };
        }, (row, parameter) => {
            const value = this.read_.get(parameter.id), other = this.other(parameter);
            const differs = value !== undefined && other !== undefined && !same_value(value, other);
            write(row.shown, value ?? '–');
            write(row.other, other === undefined ? '' : differs ? `≠ ${other}` : other);
            mark(row.root, 'data-differs', differs);
            this.desk_.permit(row.read, 'drive_read');
            this.desk_.permit(row.change, 'drive_write', !this.moving_, say('needs_standstill'));
        });
        this.file_.addEventListener('change', () => void this.load());
        this.root = panel('drive_parameters', element('div', { class: 'bar' }, this.filter_, this.read_all_, this.against_, element('label', { class: 'switch' }, this.different_, element('span', {}, say('only_different'))),
            element('span', { class: 'space' }), this.save_, this.load_, this.file_), this.said_, element('div', { class: 'scroll tall' }, element('table', { class: 'dense parameters' }, element('thead', {}, element('tr', {}, ...(['name', 'value', 'compared', 'parameter_range'] as const).map((key, i) => element('th', { scope: 'col', class: i === 1 || i === 2 ? 'number' : '' }, say(key))), element('th', {}))), this.body_), element('div', { class: 'buttons' }, this.more_)), this.dialog_);
    }
    update(axis: AxisState): void {
        this.inquiry_.step();
        this.moving_ = axis.state !== 'Disabled' && axis.state !== 'Standstill' && axis.state !== 'ErrorStop';
        const shown = this.shown();
        this.rows_.update(shown.slice(0, this.most_));
        this.more_.hidden = shown.length <= this.most_;
        write(this.said_, this.inquiry_.unknown ? say('not_known') : this.reading_ > 0 ? say('reading', { count: String(this.reading_) })
            : this.inquiry_.answer && this.all_.length === 0 ? say('no_drive_parameters') : shown.length > this.most_ ? say('more_parameters', { count: String(shown.length), most: String(this.most_) }) : '');
        this.desk_.permit(this.read_all_, 'drive_read', shown.length > 0 && this.reading_ === 0);
        this.save_.disabled = this.read_.size === 0;
    }
    leave(): void {
        this.left_ = true;
        this.inquiry_.leave();
    }

    private title(parameter: DriveParameter): string {
        const text = current_language() === 'zh' ? parameter.chinese || parameter.english : parameter.english || parameter.chinese;
        return parameter.manual ? `${text} (${parameter.manual})` : text;
    }
    private other(parameter: DriveParameter): string | undefined {
        return this.against_.value === 'compare_factory' ? parameter.factory_shown || undefined : this.against_.value === 'compare_saved' ? this.saved_?.get(parameter.id) : undefined;
    }
    private shown(): DriveParameter[] {
        const wanted = this.filter_.value.trim().toLowerCase();
        return this.all_.filter((parameter) => [parameter.id, parameter.object, parameter.english, parameter.chinese].some((text) => text.toLowerCase().includes(wanted))).filter((parameter) => {
            if (!this.different_.checked) return true;
            const value = this.read_.get(parameter.id), other = this.other(parameter);
            return value !== undefined && other !== undefined && !same_value(value, other);
        });
    }
    private async read(name: string): Promise<void> {
        const answer = await this.desk_.link.request({ cmd: 'drive_read', axis: this.layout_.name, parameter: name });
        if (answer.ok) this.read_.set(name, String(answer['shown'] ?? ''));
        else if (answer.error?.code !== 'page.no_connection') this.read_.set(name, `${unread}${said(answer.error?.what ?? '').text}`);
    }
    /** One after the other: a drive answers one mailbox at a time. Ends when the page is left. */
    private async read_shown(): Promise<void> {
        const names = this.shown().filter((parameter) => parameter.readable).map((parameter) => parameter.id);
        for (this.reading_ = names.length; this.reading_ > 0 && !this.left_ && this.desk_.link.opened; this.reading_--) await this.read(names[names.length - this.reading_] ?? '');
        this.reading_ = 0;
    }
    private ask(parameter: DriveParameter): void {
        const given = element('input', { type: 'text', 'data-input': 'value', value: this.read_.get(parameter.id) ?? '', 'aria-label': say('value') });
        const store = element('input', { type: 'checkbox', 'data-input': 'store' });
        const form = element('form', {
            method: 'dialog',
            onsubmit: (event: Event) => {
                event.preventDefault();
                this.dialog_.close();
                void this.desk_.give({ cmd: 'drive_write', axis: this.layout_.name, parameter: parameter.id, value: given.value.trim(), ...(store.checked ? { store: true } : {}) }).then((answer) => {
                    if (answer.ok) void this.read(parameter.id);
                });
            },
        }, element('p', {}, this.title(parameter)), element('dl', { class: 'values' }, element('dt', {}, say('now')), element('dd', {}, this.read_.get(parameter.id) ?? say('not_read')), element('dt', {}, say('parameter_range')), element('dd', {}, range_text(parameter) || '–'),
            element('dt', {}, say('factory')), element('dd', {}, factory_text(parameter)), ...(parameter.meaning ? [element('dt', {}, say('meaning')), element('dd', { class: 'long' }, parameter.meaning)] : []), element('dt', {}, say('effective')), element('dd', {}, `${word('change', parameter.change)}; ${word('effective', parameter.effective)}`)),
            element('label', { class: 'line' }, element('span', {}, say('new_value')), given), element('label', { class: 'switch' }, store, element('span', {}, say('into_eeprom'))),
            element('p', { class: 'hint' }, say('write_warning')), element('div', { class: 'buttons' }, element('button', { type: 'submit', class: 'primary', 'data-do': 'confirm' }, say('write_now')),
                element('button', { type: 'button', onclick: () => this.dialog_.close() }, say('cancel'))));
        this.dialog_.replaceChildren(element('h2', {}, `${this.layout_.name}: ${parameter.id}`), form);
        this.dialog_.show();
        given.select();
    }
    private save(): void {
        const set = { drive: this.layout_.drive, profile: this.layout_.profile, axis: this.layout_.name, values: Object.fromEntries([...this.read_].filter(([, value]) => !value.startsWith(unread))) };
        save_file(`${this.desk_.link.machine}-${this.layout_.name}-${file_time()}.json`, 'application/json', JSON.stringify(set, undefined, 1) + '\n');
    }
    private async load(): Promise<void> {
        const file = this.file_.files?.[0];
        if (!file) return;
        try {
            const set = JSON.parse(await file.text()) as { values?: Record<string, unknown> };
            this.saved_ = new Map(Object.entries(set.values ?? {}).map(([name, value]) => [name, String(value)]));
            this.against_.value = 'compare_saved';
        } catch {
            this.desk_.tell('refused', say('not_a_set', { name: file.name }));
        }
        this.file_.value = '';
    }
}
