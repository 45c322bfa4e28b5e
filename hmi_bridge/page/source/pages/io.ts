// Inputs and outputs by the names that programs use. Outputs are set where the machine allows it: while no program runs. Forcing holds a point against
// program and terminal; what is forced says so on every page (frame.ts).
import { Desk, Page, panel, write_lamp } from '../desk';
import { plain, typed } from '../numbers';
import { ForcedPoint, MachineState, Real } from '../state';
import { say } from '../texts';
import { element, mark, Rows, write } from '../view';

type Direction = 'input' | 'output';
interface Point {
    name: string;
    value: Real;
    unit: string;
    doubtful: boolean;
    forced: ForcedPoint | undefined;
}

function points(direction: Direction, state: MachineState, wanted: string): Point[] {
    const [values, units] = direction === 'input' ? [state.inputs, state.input_units] : [state.outputs, state.output_units];
    return Object.entries(values).filter(([name]) => name.toLowerCase().includes(wanted)).map(([name, value]) => ({
        name, value, unit: units[name] ?? '', doubtful: direction === 'input' && state.doubtful_inputs.includes(name),
        forced: state.forced?.find((point) => point.point === name && point.direction === direction),
    }));
}
function write_point(to: HTMLElement, { value, unit, doubtful }: Point): void {
    if (unit === '' && (value === 0 || value === 1)) write_lamp(to, value === 1, say(value === 1 ? 'on' : 'off'));
    else {
        write(to, `${plain(value)}${unit ? ' ' + unit : ''}`);
        mark(to, 'data-tone', false);
    }
    if (doubtful) {
        write(to, `⚠ ${to.textContent} (${say('doubtful')})`);
        mark(to, 'data-tone', 'warn');
    }
}

/** The table of one direction. `forcing()`: the buttons force instead of setting. */
function point_rows(desk: Desk, direction: Direction, forcing: () => boolean, locked: () => string) {
    const body = element('tbody');
    const rows = new Rows(body, (point: Point) => `${point.name}/${point.unit}`, (point) => {
        const { name, unit } = point;
        const shown = element('td', { 'data-value': 'value', class: unit ? 'number' : '' }), badge = element('span', { class: 'badge', hidden: true }, say('forced')), by = element('small', { lang: 'en' });
        const given = element('input', { type: 'text', inputmode: 'decimal', 'aria-label': `${name} ${say('value')}`, placeholder: unit, 'data-input': 'point' });
        const send = (value: number): void => {
            if (forcing()) void desk.give({ cmd: 'force', [direction]: name, value });
            else void desk.give({ cmd: 'set_output', output: name, value });
        };
        const send_given = (): void => {
            const value = typed(given.value);
            if (Number.isNaN(value)) desk.tell('refused', say('not_a_number', { text: given.value }));
            else send(value);
        };
        const buttons = unit ? [element('button', { type: 'button', 'data-set': 'value', onclick: send_given }, say('set'))]
            : ([1, 0] as const).map((to) => element('button', { type: 'button', 'data-set': String(to), 'aria-label': `${name} ${say(to ? 'on' : 'off')}`, onclick: () => send(to) }, say(to ? 'on' : 'off')));
        const release = element('button', { type: 'button', 'data-do': 'release', 'aria-label': `${name} ${say('release')}`, onclick: () => void desk.give({ cmd: 'unforce', [direction]: name }) }, say('release'));
        const hand = element('td', { class: 'buttons' }, ...(unit ? [given] : []), ...buttons, release);
        const root = element('tr', { [`data-${direction}-point`]: name }, element('th', { scope: 'row' }, name, badge, by), shown, hand);
        return { root, shown, badge, by, given, buttons, release };
    }, (row, point) => {
        const force = forcing();
        write_point(row.shown, point);
        row.badge.hidden = !point.forced;
        write(row.by, point.forced?.by ?? '');
        mark(row.root, 'data-forced', point.forced !== undefined);
        const kept = (direction === 'input' ? desk.link.layout?.kept_inputs : desk.link.layout?.kept_outputs)?.[point.name] ?? '';
        const settable = force || direction === 'output';
        row.given.hidden = !settable;
        for (const button of row.buttons) {
            button.hidden = !settable;
            desk.permit(button, force ? 'force' : 'set_output', force ? kept === '' : locked() === '', force ? say('kept_point', { why: kept }) : locked());
            mark(button, 'data-forces', force);
        }
        row.release.hidden = !force && !point.forced;
        desk.permit(row.release, 'unforce', point.forced !== undefined, say('not_forced'));
    });
    return { root: element('table', { class: 'points' }, body), update: (list: Point[]) => rows.update(list) };
}

export function io(desk: Desk): Page {
    let why_locked = '';
    const force = element('input', { type: 'checkbox', role: 'switch', 'data-do': 'forcing' });
    const filter = element('input', { type: 'search', 'aria-label': say('filter'), placeholder: say('filter'), 'data-input': 'filter' });
    const inputs = point_rows(desk, 'input', () => force.checked, () => ''), outputs = point_rows(desk, 'output', () => force.checked, () => why_locked);
    const hint = element('p', { class: 'hint' }), none = element('p', { class: 'hint' }, say('no_points'));
    const bar = element('div', { class: 'bar' }, filter, element('label', { class: 'switch' }, force, element('span', {}, say('forcing'))), element('span', { class: 'hint' }, say('forcing_hint')));
    return {
        root: element('div', { class: 'page io' }, bar, none, element('div', { class: 'columns' }, panel('inputs', inputs.root), panel('outputs', hint, outputs.root))),
        update(state: MachineState) {
            const running = state.programs.some((program) => program.state === 'running');
            why_locked = running ? say('outputs_locked') : state.emergency_stop ? say('outputs_locked_estop') : '';
            desk.permit(force, 'force', state.forced !== undefined, say('not_known'));
            if (force.disabled) force.checked = false;
            mark(bar, 'data-forcing', force.checked);
            write(hint, force.checked ? '' : why_locked || say('outputs_hint'));
            const wanted = filter.value.trim().toLowerCase();
            inputs.update(points('input', state, wanted));
            outputs.update(points('output', state, wanted));
            none.hidden = Object.keys(state.inputs).length + Object.keys(state.outputs).length > 0;
        },
    };
}
