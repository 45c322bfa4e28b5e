// Inputs and outputs by the names that programs use. Outputs are set where the machine allows it: while no program runs.
import { Desk, Page, panel, write_lamp } from '../desk';
import { plain, typed } from '../numbers';
import { MachineState, Real } from '../state';
import { say } from '../texts';
import { element, Rows, write } from '../view';

interface Point {
    name: string;
    value: Real;
    unit: string;
    doubtful: boolean;
}

function points(values: Record<string, Real>, units: Record<string, string>, doubtful: string[] = []): Point[] {
    return Object.entries(values).map(([name, value]) => ({ name, value, unit: units[name] ?? '', doubtful: doubtful.includes(name) }));
}
function write_point(to: HTMLElement, point: Point): void {
    if (point.unit === '' && (point.value === 0 || point.value === 1)) write_lamp(to, point.value === 1, say(point.value === 1 ? 'on' : 'off'));
    else {
        write(to, `${plain(point.value)}${point.unit ? ' ' + point.unit : ''}`);
        delete to.dataset['tone'];
    }
    if (point.doubtful) {
        write(to, `⚠ ${to.textContent} (${say('doubtful')})`);
        to.dataset['tone'] = 'warn';
    }
}

export function io(desk: Desk): Page {
    let settable = false;
    const input_body = element('tbody'), output_body = element('tbody');
    const inputs = new Rows(input_body, (point: Point) => point.name, (point) => {
        const shown = element('td', { 'data-value': 'value' });
        return { root: element('tr', { 'data-input-point': point.name }, element('th', { scope: 'row' }, point.name), shown), shown };
    }, (row, point) => write_point(row.shown, point));
    const outputs = new Rows(output_body, (point: Point) => point.name, (point) => {
        const shown = element('td', { 'data-value': 'value' });
        const given = element('input', { type: 'text', inputmode: 'decimal', 'aria-label': `${point.name} ${say('value')}` });
        const send = (value: number) => void desk.give({ cmd: 'set_output', output: point.name, value });
        const buttons = point.unit
            ? [element('button', { type: 'button', onclick: () => (Number.isNaN(typed(given.value)) ? desk.tell('refused', say('not_a_number', { text: given.value })) : send(typed(given.value))) }, say('set'))]
            : [element('button', { type: 'button', 'data-set': '1', 'aria-label': `${point.name} ${say('on')}`, onclick: () => send(1) }, say('on')),
               element('button', { type: 'button', 'data-set': '0', 'aria-label': `${point.name} ${say('off')}`, onclick: () => send(0) }, say('off'))];
        const hand = element('td', { class: 'buttons' }, ...(point.unit ? [given] : []), ...buttons);
        return { root: element('tr', { 'data-output-point': point.name }, element('th', { scope: 'row' }, point.name), shown, hand), shown, buttons };
    }, (row, point) => {
        write_point(row.shown, point);
        for (const button of row.buttons) desk.permit(button, 'set_output', settable);
    });
    const hint = element('p', { class: 'hint' }), none = element('p', { class: 'hint' }, say('no_points'));
    return {
        root: element('div', { class: 'page io' }, none, element('div', { class: 'columns' }, panel('inputs', element('table', {}, input_body)),
            panel('outputs', hint, element('table', {}, output_body)))),
        update(state: MachineState) {
            const running = state.programs.some((program) => program.state === 'running');
            settable = !running && !state.emergency_stop;
            write(hint, say(running ? 'outputs_locked' : state.emergency_stop ? 'outputs_locked_estop' : 'outputs_hint'));
            inputs.update(points(state.inputs, state.input_units, state.doubtful_inputs));
            outputs.update(points(state.outputs, state.output_units));
            none.hidden = Object.keys(state.inputs).length + Object.keys(state.outputs).length > 0;
        },
    };
}
