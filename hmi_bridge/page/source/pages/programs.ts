// Programs: start and stop, their parameters with range and meaning, their variables as a watch table, their tasks with how long they run.
import { Desk, Page, panel, table } from '../desk';
import { Histograms } from '../histograms';
import { microseconds, plain, typed } from '../numbers';
import { MachineState } from '../state';
import { say } from '../texts';
import { element, Rows, write } from '../view';
import { full, Watch } from '../watch';
import { program_rows } from './overview';

function parameter_rows(desk: Desk) {
    const body = element('tbody');
    const rows = new Rows(body, full, (parameter: MachineState['parameters'][number]) => {
        const info = desk.link.layout?.parameters.find((p) => full(p) === full(parameter));
        const shown = element('td', { class: 'number', 'data-value': 'value' });
        const given = element('input', { type: 'text', inputmode: 'decimal', 'aria-label': full(parameter), 'data-input': 'parameter' });
        const set = element('button', { type: 'submit' }, say('set'));
        const form = element('form', {
            class: 'line',
            onsubmit: (event: Event) => {
                event.preventDefault();
                const value = typed(given.value);
                if (Number.isNaN(value)) desk.tell('refused', say('not_a_number', { text: given.value }));
                else void desk.give({ cmd: 'set_parameter', parameter: full(parameter), value }).then((answer) => { if (answer.ok) given.value = ''; });
            },
        }, given, set);
        const range = info ? `${plain(info.minimum)} … ${plain(info.maximum)} ${parameter.unit}` : '';
        const root = element('tr', { 'data-parameter': full(parameter) }, element('th', { scope: 'row' }, parameter.name, element('small', { class: 'doc', lang: 'en' }, info?.doc ?? ''), element('small', { class: 'doc' }, range)), shown,
            element('td', { class: 'unit' }, parameter.unit), element('td', {}, form));
        return { root, shown, set, given };
    }, (row, parameter) => {
        write(row.shown, plain(parameter.value));
        desk.permit(row.set, 'set_parameter');
    });
    const none = element('p', { class: 'hint' }, say('no_parameters'));
    return {
        root: element('div', {}, none, element('div', { class: 'scroll' }, element('table', {}, body))),
        update(state: MachineState) {
            rows.update(state.parameters);
            none.hidden = state.parameters.length > 0;
        },
    };
}

export function programs(desk: Desk): Page {
    const control = program_rows(desk), parameters = parameter_rows(desk), watch = new Watch(desk), histograms = new Histograms(desk);
    const task_body = element('tbody');
    const tasks = new Rows(task_body, (task: MachineState['tasks'][number]) => task.name, (task) => {
        const cells = [0, 1, 2, 3].map(() => element('td', { class: 'number' }));
        return { root: element('tr', { 'data-task': task.name }, element('th', { scope: 'row' }, task.name), ...cells), cells };
    }, (row, task) => {
        const texts = [String(task.releases), String(task.overruns), microseconds(task.run_ns), microseconds(task.run_max_ns)];
        row.cells.forEach((cell, i) => write(cell, texts[i] ?? ''));
    });
    const task_panel = panel('tasks', table(['task', 'releases', 'overruns', 'run_time', 'run_time_max'], task_body, ['releases', 'overruns', 'run_time', 'run_time_max']));
    return {
        root: element('div', { class: 'page programs' }, element('div', { class: 'columns' }, element('div', { class: 'stack' }, panel('programs', control.root), panel('parameters', parameters.root), task_panel),
            element('div', { class: 'stack' }, panel('variables', watch.root), histograms.root))),
        update(state: MachineState) {
            control.update(state);
            watch.update(state);
            parameters.update(state);
            tasks.update(state.tasks);
            histograms.step();
        },
        leave: () => histograms.leave(),
    };
}
