// What the machine shall wait for, and whether it came.
import { Desk } from '../desk';
import { typed } from '../numbers';
import { Key, say } from '../texts';
import { element, mark, write } from '../view';
import { Session } from './session';
import { has_level, has_window, status_of, Trigger, trigger_kinds, trigger_modes, trouble } from './trigger';

export class TriggerPanel {
    readonly root: HTMLElement;
    readonly status = element('span', { class: 'scope-status', role: 'status', 'data-value': 'trigger_status' });
    private readonly fields_ = new Map<keyof Trigger, { row: HTMLElement; field: HTMLInputElement | HTMLSelectElement }>();
    private readonly arm_: HTMLButtonElement;
    private readonly disarm_: HTMLButtonElement;
    private readonly complaint_ = element('p', { class: 'scope-complaint', role: 'alert' });
    private readonly names_ = element('datalist', { id: 'scope-trigger-signals' });
    private known_: unknown;
    private setup_: unknown;

    constructor(private readonly desk_: Desk, private readonly session_: Session, private readonly changed_: () => void) {
        const choice = (key: keyof Trigger, label: Key, values: readonly string[], group: string): HTMLElement => {
            const field = element('select', { 'data-trigger': key, onchange: () => this.take() }, ...values.map((v) => element('option', { value: v }, say(`scope_${group}_${v}` as Key))));
            return this.row(key, label, field);
        };
        const text = (key: keyof Trigger, label: Key, unit = '', attributes: Record<string, string> = {}): HTMLElement =>
            this.row(key, label, element('input', { type: 'text', 'data-trigger': key, onchange: () => this.take(), ...attributes }), unit);
        this.arm_ = element('button', { type: 'button', class: 'primary', 'data-do': 'arm', onclick: () => void this.arm() }, say('scope_arm'));
        this.disarm_ = element('button', { type: 'button', 'data-do': 'disarm', onclick: () => void session_.disarm().then(changed_) }, say('scope_disarm'));
        const decimal = { inputmode: 'decimal' };
        this.root = element('form', { class: 'scope-form', onsubmit: (event: Event) => {
            event.preventDefault();
            void this.arm();
        } }, element('p', { class: 'hint' }, say('scope_trigger_hint')), choice('kind', 'scope_trigger_when', trigger_kinds, 'kind'), this.names_,
            text('signal', 'scope_trigger_signal', '', { list: 'scope-trigger-signals', spellcheck: 'false' }), text('level', 'scope_trigger_level', '', decimal), text('level2', 'scope_trigger_level2', '', decimal),
            text('bit', 'scope_trigger_bit', '', { inputmode: 'numeric' }), text('alarm', 'scope_trigger_alarm', '', { placeholder: say('scope_trigger_any_alarm'), spellcheck: 'false' }),
            choice('mode', 'scope_trigger_mode', trigger_modes, 'mode'), text('length_s', 'scope_trigger_shown', 's', decimal), text('before_percent', 'scope_trigger_before', '%', decimal), text('holdoff_s', 'scope_trigger_holdoff', 's', decimal),
            element('div', { class: 'buttons wide' }, this.arm_, this.disarm_), this.complaint_);
    }
    private row(key: keyof Trigger, label: Key, field: HTMLInputElement | HTMLSelectElement, unit = ''): HTMLElement {
        const row = element('label', { class: 'scope-field' }, element('span', {}, say(label)), field, element('small', {}, unit));
        this.fields_.set(key, { row, field });
        return row;
    }
    private take(): void {
        const trigger = this.session_.setup.trigger;
        for (const [key, { field }] of this.fields_) {
            const now = field.value.trim();
            if (key === 'kind' || key === 'mode' || key === 'signal' || key === 'alarm') (trigger as unknown as Record<string, string>)[key] = now;
            else trigger[key] = typed(now);
        }
        write(this.complaint_, '');
        this.session_.changed();
    }
    private async arm(): Promise<void> {
        this.take();
        const trigger = this.session_.setup.trigger, wrong = trouble(trigger, (name) => this.session_.live?.signals.has(name) ?? false);
        write(this.complaint_, wrong ? `⚠ ${say(wrong)}` : '');
        if (wrong) return;
        const answer = await this.session_.arm({ ...trigger }, this.words(trigger));
        if (!answer.ok) this.desk_.refused(answer);
        this.changed_();
    }
    /** "x.following_error > 0.5", as the marker says. */
    private words(t: Trigger): string {
        switch (t.kind) {
            case 'rising': return `${t.signal} ↗ ${t.level}`;
            case 'falling': return `${t.signal} ↘ ${t.level}`;
            case 'either': return `${t.signal} ↕ ${t.level}`;
            case 'above': return `${t.signal} > ${t.level}`;
            case 'below': return `${t.signal} < ${t.level}`;
            case 'inside': return `${t.level} < ${t.signal} < ${t.level2}`;
            case 'outside': return `${t.signal} ∉ ${t.level} … ${t.level2}`;
            case 'bit': return `${t.signal}.${t.bit}`;
            case 'alarm': return t.alarm || say('scope_trigger_any_alarm');
        }
    }

    update(): void {
        const { session_: session } = this, trigger = session.setup.trigger;
        if (session.live?.signals !== this.known_) {
            this.known_ = session.live?.signals;
            this.names_.replaceChildren(...[...(session.live?.signals.keys() ?? [])].map((name) => element('option', { value: name })));
        }
        if (session.setup !== this.setup_) {
            this.setup_ = session.setup;
            if (trigger.signal === '') trigger.signal = session.setup.channels[0]?.name ?? '';
            for (const [key, { field }] of this.fields_) field.value = String(trigger[key]);
        }
        const kind = (this.fields_.get('kind')?.field.value ?? trigger.kind) as Trigger['kind'];
        const show = (key: keyof Trigger, on: boolean): void => {
            const row = this.fields_.get(key)?.row;
            if (row) row.hidden = !on;
        };
        show('signal', kind !== 'alarm');
        show('level', has_level(kind));
        show('level2', has_window(kind));
        show('bit', kind === 'bit');
        show('alarm', kind === 'alarm');
        const status = status_of(session.trigger);
        write(this.status, `${{ off: '○', waiting: '◔', filling: '◕', triggered: '●' }[status]} ${say(`scope_status_${status}`)}`);
        mark(this.status, 'data-tone', { off: 'idle', waiting: 'warn', filling: 'warn', triggered: 'good' }[status]);
        this.desk_.permit(this.arm_, 'scope_arm', session.live !== undefined);
        this.desk_.permit(this.disarm_, 'scope_disarm', session.trigger !== undefined);
    }
}
