// What is kept: recordings of alarms, files, pictures, set-ups.
import { where } from '../alarm_words';
import { Answer } from '../link';
import { Key, say } from '../texts';
import { element, Rows, write } from '../view';
import { CsvError, csv_pieces, read_csv } from './csv';
import { measured } from './cursors';
import { on_ground, picture } from './picture';
import { Recording, Session } from './session';
import { from_text, to_text } from './setup';
import { Stack } from './stack';

const largest_file = 300e6;

/** Hands the browser a file to keep. */
export function download(name: string, content: Blob): void {
    const link = element('a', { href: URL.createObjectURL(content), download: name });
    document.body.append(link);
    link.click();
    link.remove();
    setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}
const stamp = (): string => new Date().toISOString().slice(0, 19).replace(/[:T]/g, '-');

/** Every cycle between the cursors, or of what is shown. */
function csv_of(session: Session): string[] {
    const { scene, cursors, setup } = session;
    if (!scene) return [];
    const range = measured(cursors, scene.view.from, scene.view.to);
    const names = [...new Set(setup.channels.map((c) => c.name))].filter((name) => scene.signals.has(name) && name !== 'time_s');  // that column is there anyway
    const from = Math.max(range.from, Math.min(...names.map((name) => scene.store.tracks.get(name)?.have.list[0]?.from ?? Infinity)));
    return [...csv_pieces(scene.store, names.map((name) => ({ name, unit: scene.signals.get(name)?.unit ?? '' })), from, Math.min(range.to, scene.store.newest), (cycle) => scene.seconds(cycle))];
}

export class FilesPanel {
    readonly root: HTMLElement;
    private readonly complaint_ = element('p', { class: 'scope-complaint', role: 'alert' });
    private readonly recordings_ = element('div', { class: 'scope-list' });
    private readonly setups_ = element('div', { class: 'scope-list' });
    private readonly rows_: Rows<Recording, { root: HTMLElement; text: HTMLElement }>;
    private readonly none_ = element('p', { class: 'hint', hidden: true }, say('scope_no_recordings'));
    private readonly file_ = element('input', { type: 'file', accept: '.csv,text/csv', hidden: true, 'data-file': 'csv', onchange: () => void this.open() });
    private readonly setup_file_ = element('input', { type: 'file', accept: '.json,application/json', hidden: true, 'data-file': 'setup', onchange: () => void this.import_setups() });
    private asked_at_ = -1e9;

    constructor(private readonly session_: Session, private readonly stack_: Stack, private readonly other_: () => HTMLCanvasElement | undefined, private readonly changed_: () => void) {
        this.rows_ = new Rows<Recording, { root: HTMLElement; text: HTMLElement }>(this.recordings_, (r) => r.name, (recording) => {
            const text = element('small');
            return { root: element('a', { class: 'scope-recording', href: `#scope/recording/${encodeURIComponent(recording.name)}`, 'data-recording': recording.name }, element('b', {}, `${where(recording.source)}: ${recording.alarm}`), text), text };
        }, (row, r) => write(row.text, `${new Date(r.utime / 1000).toLocaleString('sv')} · ${(r.bytes / 1024).toFixed(0)} kB${r.complete ? '' : ' · ' + say('scope_not_complete')}`));
        const name = element('input', { type: 'text', 'aria-label': say('scope_setup_name'), placeholder: say('scope_setup_name'), maxlength: '60', 'data-field': 'setup' });
        const button = (key: Key, what: () => void, tag: string): HTMLElement => element('button', { type: 'button', 'data-do': tag, onclick: what }, say(key));
        this.root = element('div', { class: 'scope-form' }, this.complaint_, this.file_, this.setup_file_,
            element('div', { class: 'buttons wide' }, button('scope_save_csv', () => this.save_csv(), 'save_csv'), button('scope_save_png', () => this.save_png(), 'save_png')), element('p', { class: 'hint' }, say('scope_csv_hint')),
            button('scope_open_csv', () => this.file_.click(), 'open_csv'), element('h3', {}, say('scope_recordings')), this.none_, this.recordings_, element('h3', {}, say('scope_setups')),
            element('form', { class: 'line', onsubmit: (event: Event) => {
                event.preventDefault();
                const given = name.value.trim();
                if (given === '') return name.focus();
                if (!this.session_.saved.save(given, this.session_.setup)) this.complain(say('scope_setup_not_kept'));
                name.value = '';
                this.list_setups();
            } }, name, element('button', { type: 'submit', 'data-do': 'save_setup' }, say('scope_setup_save'))), this.setups_,
            element('div', { class: 'buttons wide' }, button('scope_setup_export', () => this.export_setups(), 'export_setups'), button('scope_setup_import', () => this.setup_file_.click(), 'import_setups')));
        this.list_setups();
    }
    private complain(text: string): void {
        write(this.complaint_, text ? `⚠ ${text}` : '');
    }

    /** Asks for the recordings while it is open. */
    update(now: number): void {
        if (now - this.asked_at_ < 3000) return;
        this.asked_at_ = now;
        void this.session_.recordings().then((answer: Answer) => {
            const list = answer.ok ? (answer['recordings'] as Recording[]) : [];
            this.rows_.update(list);
            this.none_.hidden = list.length > 0;
        });
    }

    private save_csv(): void {
        download(`taktwerk-${stamp()}.csv`, new Blob(csv_of(this.session_), { type: 'text/csv' }));
    }
    private save_png(): void {
        const other = this.other_();
        (other ? on_ground(other) : picture(this.session_, this.stack_)).toBlob((blob) => blob && download(`taktwerk-${stamp()}.png`, blob), 'image/png');
    }
    private async open(): Promise<void> {
        const file = this.file_.files?.[0];
        this.file_.value = '';
        if (!file) return;
        if (file.size > largest_file) return this.complain(say('scope_file_large', { name: file.name }));
        this.complain(say('scope_reading'));
        try {
            const known = this.session_.live?.signals;
            this.session_.show_file(file.name, read_csv(await file.text(), (name) => known?.get(name)));
            this.complain('');
            this.changed_();
        } catch (wrong) {
            if (!(wrong instanceof CsvError)) throw wrong;
            this.complain(say(`scope_csv_${wrong.trouble}`, { name: file.name, line: String(wrong.line), what: wrong.what.slice(0, 40) }));
        }
    }

    private list_setups(): void {
        this.setups_.replaceChildren(...[...this.session_.saved.list()].map(([name, setup]) => element('div', { class: 'scope-setup', 'data-setup': name }, element('span', {}, name),
            element('button', { type: 'button', class: 'small', 'aria-label': `${say('scope_setup_load')} ${name}`, onclick: () => {
                this.session_.use(setup);
                this.changed_();
            } }, say('scope_setup_load')),
            element('button', { type: 'button', class: 'small', 'aria-label': `${say('scope_setup_delete')} ${name}`, onclick: () => {
                this.session_.saved.remove(name);
                this.list_setups();
            } }, '✕'))));
    }
    private export_setups(): void {
        const all = Object.fromEntries([...this.session_.saved.list(), ['—', this.session_.setup] as const].map(([name, setup]) => [name, JSON.parse(to_text(setup)) as unknown]));
        if (this.session_.saved.list().size > 0) delete all['—'];
        download('taktwerk-scope.json', new Blob([JSON.stringify({ taktwerk_scopes: all }, null, 1)], { type: 'application/json' }));
    }
    private async import_setups(): Promise<void> {
        const file = this.setup_file_.files?.[0];
        this.setup_file_.value = '';
        if (!file) return;
        let count = 0;
        try {
            const given = JSON.parse(await file.slice(0, 4e6).text()) as Record<string, unknown>;
            for (const [name, one] of Object.entries((given['taktwerk_scopes'] ?? {}) as Record<string, unknown>)) {
                const setup = from_text(JSON.stringify(one));
                if (setup && this.session_.saved.save(name.slice(0, 60), setup)) count++;
            }
        } catch { /* said below */ }
        this.complain(count > 0 ? '' : say('scope_setup_bad', { name: file.name }));
        this.list_setups();
    }
}
