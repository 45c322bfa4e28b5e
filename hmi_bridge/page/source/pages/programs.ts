// Programs: their variables as a watch table, their parameters with range and meaning, their tasks.
import { Desk, Page, panel, table } from '../desk';
import { microseconds, plain, typed } from '../numbers';
import { MachineState } from '../state';
import { say } from '../texts';
import { element, Rows, write } from '../view';
import { program_rows } from './overview';

const full = (of: { program: string; name: string }): string => `${of.program}.${of.name}`;

export function programs(desk: Desk): Page {
    const control = program_rows(desk);
    const filter = element('input', { type: 'search', 'aria-label': say('filter'), placeholder: say('filter') });
    const variable_body = element('tbody'), parameter_body = element('tbody'), task_body = element('tbody');
    const variables = new Rows(variable_body, full, (variable: MachineState['variables'][number]) => {
        const doc = desk.link.layout?.variables.find((v) => full(v) === full(variable))?.doc ?? '';
        const shown = element('td', { class: 'number', 'data-value': 'value' });
        return { root: element('tr', { 'data-variable': full(variable) }, element('th', { scope: 'row', title: doc }, full(variable)), shown, element('td', {}, variable.unit), element('td', { class: 'doc' }, doc)), shown };
    }, (row, variable) => write(row.shown, plain(variable.value)));
    const parameters = new Rows(parameter_body, full, (parameter: MachineState['parameters'][number]) => {
        const info = desk.link.layout?.parameters.find((p) => full(p) === full(parameter));
        const shown = element('td', { class: 'number', 'data-value': 'value' });
        const given = element('input', { type: 'text', inputmode: 'decimal', 'aria-label': full(parameter) });
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
        const range = info ? `${plain(info.minimum)} … ${plain(info.maximum)}` : '';
        return { root: element('tr', { 'data-parameter': full(parameter) }, element('th', { scope: 'row', title: info?.doc ?? '' }, full(parameter)), shown, element('td', {}, parameter.unit),
            element('td', {}, range), element('td', {}, form), element('td', { class: 'doc' }, info?.doc ?? '')), shown, set };
    }, (row, parameter) => {
        write(row.shown, plain(parameter.value));
        desk.permit(row.set, 'set_parameter');
    });
    const tasks = new Rows(task_body, (task: MachineState['tasks'][number]) => task.name, (task) => {
        const cells = [0, 1, 2, 3].map(() => element('td', { class: 'number' }));
        return { root: element('tr', {}, element('th', { scope: 'row' }, task.name), ...cells), cells };
    }, (row, task) => {
        const texts = [String(task.releases), String(task.overruns), microseconds(task.run_ns), microseconds(task.run_max_ns)];
        row.cells.forEach((cell, i) => write(cell, texts[i] ?? ''));
    });
    return {
        root: element('div', { class: 'page programs' }, panel('programs', control.root), panel('parameters', table(['name', 'value', 'unit', 'parameter_range', 'set', 'meaning'], parameter_body)),
            panel('variables', filter, table(['name', 'value', 'unit', 'meaning'], variable_body)), panel('tasks', table(['task', 'releases', 'overruns', 'run_time', 'run_time_max'], task_body))),
        update(state: MachineState) {
            control.update(state);
            const wanted = filter.value.trim().toLowerCase();
            variables.update(state.variables.filter((variable) => full(variable).toLowerCase().includes(wanted)));
            parameters.update(state.parameters);
            tasks.update(state.tasks);
        },
    };
}
