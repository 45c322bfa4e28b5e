// Measuring an axis: what, with which numbers, where it will go; held while it runs; what came of it.
import { AxisHead } from '../axis/head';
import { axis_of, axis_tabs } from '../axis/tabs';
import { why_not_by_hand } from '../axis/why';
import { Desk, Page, panel } from '../desk';
import { hold_to_jog } from '../jog';
import { Request } from '../link';
import { measure_hold } from '../measure/hold';
import { Kind, kinds, Plan } from '../measure/orders';
import { digits, Result, ResultView } from '../measure/result';
import { typed } from '../numbers';
import { said } from '../sentences/said';
import { MachineState } from '../state';
import { Key, say } from '../texts';
import { element, mark, write } from '../view';

/** ms: the path is asked for anew this often, for the axis may stand elsewhere; while it runs the progress is. */
const asked_every = 500;

/** `#measure/NAME`. */
export function measure(desk: Desk, [wanted = '']: readonly string[]): Page {
    const name = axis_of(desk, wanted), layout = desk.axis_layout(name);
    if (!layout) return { root: element('div', { class: 'page measure' }, element('p', { class: 'hint' }, say('no_axes'))), update: () => undefined };
    const unit = layout.unit, held = measure_hold(desk), head = new AxisHead(desk, layout), shown = new ResultView(desk);
    let kind = kinds[0] as Kind, plan: Plan | undefined, asked = 0, left = false, run = -1, was_running = false;

    const choice = element('select', { 'data-input': 'kind', 'aria-label': say('measure_kind') }, ...kinds.map((k) => element('option', { value: k.kind }, say(`measure_kind_${k.kind}` as Key))));
    const about = element('p', { class: 'hint' }), fields = element('div', { class: 'measure-fields' });
    const path = element('p', { class: 'measure-path', 'data-value': 'measure_path', 'aria-live': 'polite' });
    const bar = element('progress', { max: '1', value: '0', 'aria-label': say('measure_hold') }), progress = element('span', { 'data-value': 'measure_progress' });
    const hold = element('button', { type: 'button', class: 'primary measure-hold', 'data-cmd': 'measure', title: say('measure_hold_hint') }, say('measure_hold'));

    const order = (): Request => {
        const made: Request = { cmd: 'measure_plan', axis: name, kind: kind.kind };
        for (const input of fields.querySelectorAll('input')) {
            const number = typed(input.value);
            if (input.value.trim() !== '' && !Number.isNaN(number)) made[input.dataset['input'] as string] = number;
        }
        return made;
    };
    /** What is typed and no number: a path that leaves it out would not be what was asked for. */
    const wrong = (): string | undefined => {
        let first: string | undefined;
        for (const input of fields.querySelectorAll('input')) {
            const bad = input.value.trim() !== '' && Number.isNaN(typed(input.value));
            mark(input, 'aria-invalid', bad && 'true');
            if (bad) first ??= input.value;
        }
        return first;
    };
    const ask_path = (): void => {
        asked = performance.now();
        const text = wrong();
        if (text !== undefined) {
            plan = undefined;
            write(path, `⚠ ${say('not_a_number', { text })}`);
            return mark(path, 'data-tone', 'warn');
        }
        const request = order();
        void desk.link.request(request).then((answer) => {
            if (left || wrong() !== undefined) return;
            plan = answer.ok ? (answer['measure_plan'] as Plan) : undefined;
            const refusal = answer.error ? [answer.error.what, answer.error.remedy].flatMap((sentence) => (sentence ? [said(sentence).text] : [])).join(' – ') : '';
            write(path, plan ? say('measure_path', { low: digits(plan.lowest), high: digits(plan.highest), unit, velocity: digits(plan.velocity), seconds: digits(plan.duration_s), margin: digits(plan.margin) }) : refusal ? `⚠ ${refusal}` : say('measure_no_path'));
            mark(path, 'data-tone', plan ? false : 'warn');
            held.order = request;
        });
    };
    const ask_result = (): void => {
        asked = performance.now();
        void desk.link.request({ cmd: 'measure_result', axis: name }).then((answer) => {
            if (left) return;
            const result = answer.ok ? (answer['measure_result'] as Result) : undefined;
            if (!result) shown.clear(say('measure_none_yet'));
            else if (!result.running && result.run !== run) {
                run = result.run;
                shown.show(result);
            }
        });
    };
    const choose = (): void => {
        kind = kinds.find((k) => k.kind === choice.value) ?? kind;
        write(about, say(`measure_about_${kind.kind}` as Key));
        fields.replaceChildren(...kind.fields.map((field) => element('label', {}, element('span', {}, say(field.title)),
            element('input', { type: 'text', inputmode: 'decimal', 'data-input': field.key, placeholder: say('measure_by_itself'), oninput: ask_path }), element('span', { class: 'unit' }, field.unit.replace('u', unit)))));
        ask_path();
    };
    choice.addEventListener('change', choose);
    hold_to_jog(hold, held.hold, () => name, () => (plan ? 1 : 0));
    choose();
    ask_result();

    return {
        root: element('div', { class: 'page measure' }, axis_tabs(desk, name, 'measure'), head.root,
            element('div', { class: 'columns' }, element('div', { class: 'stack' }, panel('measure_kind', choice, about, fields, path, element('div', { class: 'line' }, hold), element('div', { class: 'line' }, bar, progress))), shown.root)),
        update(machine: MachineState) {
            const axis = machine.axes.find((a) => a.name === name);
            if (!axis) return;
            head.update(axis);
            const now = machine.measure, mine = now?.axis === name, running = mine && now.running;
            const holding = held.hold.axis === name, reason = why_not_by_hand(axis, machine);
            const ready = axis.powered && axis.state === 'Standstill';
            desk.permit(hold, 'measure', holding || (reason === '' && ready && plan !== undefined), reason || (ready ? path.textContent ?? '' : say(axis.powered ? 'needs_standstill' : 'needs_power')));
            mark(hold, 'data-held', holding);
            for (const input of fields.querySelectorAll('input')) input.disabled = running;
            choice.disabled = running;
            bar.value = mine ? Math.min(1, now.elapsed_s / Math.max(now.duration_s, 1e-3)) : 0;
            write(progress, mine ? say('measure_progress', { elapsed: now.elapsed_s.toFixed(1), duration: now.duration_s.toFixed(1) }) : '');
            if (was_running && !running) {
                if (holding) held.hold.end('stopped');  // it went to its end
                ask_result();
            } else if (!running && performance.now() - asked > asked_every) ask_path();
            was_running = running;
        },
        leave() {
            left = true;
            if (held.hold.axis !== undefined) held.hold.end('gone');
            shown.leave();
        },
    };
}
