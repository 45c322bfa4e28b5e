// Widgets that write: a button that is held, a switch that stays, a number. Each shows what the machine has; what is on its way stands beside it.
import { Desk } from '../desk';
import { hold_to_jog } from '../jog';
import { typed } from '../numbers';
import { MachineState } from '../state';
import { say } from '../texts';
import { element, mark, write } from '../view';
import { ShownValue } from './builder_views';
import { is_on, number_of, short, text_of } from './reading';
import { boxed, first_value, label_of, MakeWidget } from './widget';

/** ms: the machine has had time to take it over; what it shows then is its own will. */
const taken_within = 1500;

/** What was asked for and is not there yet. */
class Wish {
    private wanted_: number | undefined;
    private since_ = 0;
    /** It was accepted, and the machine shows something else. */
    private missed_ = false;

    ask(value: number): void {
        this.wanted_ = value;
        this.since_ = performance.now();
        this.missed_ = false;
    }
    drop(): void {
        this.wanted_ = undefined;
        this.missed_ = false;
    }
    /** For the line beside the value: on its way, not taken over, or nothing. */
    text(now: number, shown: (value: number) => string): string {
        if (this.wanted_ === undefined) return '';
        if (now === this.wanted_) {
            this.drop();
            return '';
        }
        this.missed_ = this.missed_ || performance.now() - this.since_ > taken_within;
        return say(this.missed_ ? 'view_not_taken' : 'view_on_its_way', { value: shown(this.wanted_) });
    }
    get open(): boolean {
        return this.wanted_ !== undefined && !this.missed_;
    }
}

const may_write = (shown: ShownValue): string => (shown.source === 'parameter' ? 'set_parameter' : 'set_value');
const request = (shown: ShownValue, value: number) =>
    shown.source === 'parameter' ? { cmd: 'set_parameter', parameter: shown.name, value } : { cmd: 'set_value', variable: shown.name, value };

export const switch_widget: MakeWidget = (desk, layout) => {
    const shown = first_value(layout), wish = new Wish();
    const sign = element('span', { class: 'switch-sign', 'aria-hidden': 'true' }), said = element('span', { 'data-value': 'switch' });
    const note = element('p', { class: 'hint', 'aria-live': 'polite' });
    const button = element('button', { type: 'button', class: 'switch', role: 'switch', 'aria-label': label_of(layout), 'data-cmd': 'set_value' }, sign, said);
    let on = false;
    button.addEventListener('click', () => {
        const wanted = on ? 0 : 1;
        wish.ask(wanted);
        void desk.give(request(shown, wanted)).then((answer) => { if (!answer.ok) wish.drop(); });
    });
    return {
        root: boxed(layout, 'switch', button, note),
        update(state) {
            on = is_on(state, shown);
            write(said, say(on ? 'view_on' : 'view_off'));
            mark(button, 'aria-checked', on ? 'true' : 'false');
            write(note, wish.text(on ? 1 : 0, (value) => say(value ? 'view_on' : 'view_off')));
            mark(button, 'data-waits', wish.open);
            desk.permit(button, 'set_value');
        },
    };
};

export const button_widget: MakeWidget = (desk, layout) => {
    const shown = first_value(layout);
    const lamp = element('span', { class: 'button-lamp', 'data-value': 'button' });
    const button = element('button', { type: 'button', class: 'held', 'data-cmd': 'set_value', 'data-button': shown.name }, element('span', {}, label_of(layout)), lamp);
    hold_to_jog(button, desk.pressing, () => shown.name, () => 1);
    const root = element('section', { class: 'panel widget widget-button', 'data-widget': 'button', 'data-of': shown.name }, button);
    return {
        root,
        update(state: MachineState) {
            const on = is_on(state, shown), mine = desk.pressing.axis === shown.name;
            const runs = state.programs.find((program) => program.name === shown.of)?.state === 'running';
            write(lamp, `${on ? '●' : '○'} ${say(on ? 'view_pressed' : mine ? 'view_pressing' : runs ? 'view_hold' : 'view_no_program')}`);
            mark(button, 'data-held', mine);
            mark(button, 'data-on', on);
            const stopped = state.emergency_stop;
            // A button that is held stays as it is: greying it would take the pointer away.
            desk.permit(button, 'set_value', mine || (runs && !stopped), say(stopped ? 'emergency_stop' : 'view_no_program'));
        },
        leave: () => desk.pressing.end('blur'),
    };
};

export const set_widget: MakeWidget = (desk: Desk, layout) => {
    const shown = first_value(layout), wish = new Wish();
    const number = element('span', { class: 'widget-number', 'data-value': 'value' });
    const note = element('p', { class: 'hint', 'aria-live': 'polite' });
    const input = element('input', { type: 'text', inputmode: 'decimal', 'aria-label': label_of(layout), 'data-input': shown.name });
    const set = element('button', { type: 'submit', class: 'primary', 'data-cmd': may_write(shown) }, say('set'));
    const limit = (at: number | undefined) => (at === undefined ? '' : short(at));
    const form = element('form', {
        class: 'line',
        onsubmit: (event: Event) => {
            event.preventDefault();
            const value = typed(input.value);
            if (Number.isNaN(value)) return desk.tell('refused', say('not_a_number', { text: input.value }));
            if (shown.minimum !== undefined && shown.maximum !== undefined && (value < shown.minimum || value > shown.maximum))
                return desk.tell('refused', say('view_outside', { value: short(value), low: limit(shown.minimum), high: limit(shown.maximum), unit: shown.unit }));
            if (shown.whole && !Number.isInteger(value)) return desk.tell('refused', say('view_whole', { value: short(value) }));
            wish.ask(value);
            void desk.give(request(shown, value)).then((answer) => {
                if (answer.ok) input.value = '';
                else wish.drop();
            });
        },
    }, input, element('span', { class: 'unit' }, shown.unit), set);
    const range = shown.minimum !== undefined && shown.maximum !== undefined ? `${limit(shown.minimum)} … ${limit(shown.maximum)} ${shown.unit}` : '';
    return {
        root: boxed(layout, 'set', element('div', { class: 'widget-line' }, number, element('span', { class: 'widget-unit' }, shown.unit), element('span', { class: 'widget-range' }, range)), form, note),
        update(state) {
            write(number, text_of(state, shown, layout.decimals));
            write(note, wish.text(number_of(state, shown), (value) => `${short(value)} ${shown.unit}`.trim()));
            desk.permit(set, may_write(shown));
            desk.permit(input, may_write(shown));
        },
    };
};
