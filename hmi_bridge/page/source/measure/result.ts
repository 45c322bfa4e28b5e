// What was measured: numbers with their uncertainty, plots, proposals, a file.
import { Desk, panel, Values } from '../desk';
import { csv, file_time, save_file } from '../save';
import { Real, value } from '../state';
import { Key, say, texts } from '../texts';
import { element } from '../view';
import { Drawn, Marked, Plot, PlotOf } from './plot';

interface Estimate {
    value: Real;
    deviation: Real;
}
interface Margin {
    value: Real;
    frequency_hz: Real;
}
type Curve = Record<string, (Real | boolean | null)[] | number | string>;
interface Proposal {
    key: string;
    value: Real;
    deviation: Real;
    unit: string;
}
/** The answer to `measure_result`, as the socket says it (hmi_bridge/README.md). */
export interface Result {
    run: number;
    axis: string;
    unit: string;
    kind: string;
    running: boolean;
    end: string;
    elapsed_s: number;
    samples: number;
    dead_time_s?: number;
    doubt?: string;
    window?: number;
    curves?: Curve[];
    proposals?: Proposal[];
    plan: { duration_s: number };
    [more: string]: unknown;
}

/** Four digits that count. */
export function digits(number: number): string {
    if (!Number.isFinite(number)) return '–';
    return Number(number.toPrecision(4)).toString().replace('-', '−');
}
const numbers = (curve: Curve, key: string): (number | null)[] => (Array.isArray(curve[key]) ? (curve[key] as (Real | null)[]).map((v) => (v === null ? null : value(v))) : []);

type Line = [title: string, text: string];

function estimated(result: Record<string, unknown>, key: string, title: string, factor: number, unit: string): Line {
    const found = result[key] as Estimate | null | undefined;
    if (!found) return [title, say('measure_unknown')];
    const deviation = value(found.deviation) * factor;
    return [title, `${digits(value(found.value) * factor)} ${unit}${deviation > 0 ? ` ± ${Number(deviation.toPrecision(2))}` : ''}`];
}
function margin(result: Result, key: string, title: Key, unit: string, where: boolean): Line {
    const found = result[key] as Margin | null | undefined;
    return [say(title), found ? `${digits(value(found.value))} ${unit}${where ? ` @ ${digits(value(found.frequency_hz))} Hz` : ''}` : say('measure_not_inside')];
}

function move_lines(r: Result): Line[] {
    const u = r.unit;
    return [
        estimated(r, 'overshoot', say('measure_overshoot'), 1, u),
        estimated(r, 'settling_time_s', say('measure_settling', { window: digits(r.window ?? NaN), unit: u }), 1000, 'ms'),
        estimated(r, 'rise_time_s', say('measure_rise'), 1000, 'ms'),
        estimated(r, 'largest_error', say('measure_largest_error'), 1, u),
        estimated(r, 'error_at_velocity', say('measure_at_velocity'), 1, u),
        [say('measure_lag'), r['lag_s'] === null ? say('measure_unknown') : `${digits(value(r['lag_s'] as Real) * 1000)} ms`],
        estimated(r, 'velocity_ripple', say('measure_ripple'), 1, `${u}/s`),
    ];
}
const percent = (r: Record<string, unknown>, key: string, title: Key, per = ''): Line => estimated(r, key, say(title), 100, `%${per}`);
function friction_lines(r: Result): Line[] {
    return [percent(r, 'gravity', 'measure_gravity'), percent(r, 'coulomb', 'measure_coulomb'), percent(r, 'viscous', 'measure_viscous', ` / (${r.unit}/s)`), percent(r, 'coulomb_positive', 'measure_coulomb_positive'),
        percent(r, 'coulomb_negative', 'measure_coulomb_negative'), percent(r, 'breakaway_positive', 'measure_breakaway_positive'), percent(r, 'breakaway_negative', 'measure_breakaway_negative')];
}
function following_lines(r: Result): Line[] {
    const u = r.unit, torque = (r['torque'] ?? {}) as Record<string, unknown>;
    return [
        [say('measure_rms'), `${digits(value(r['rms_error'] as Real))} ${u}`],
        estimated(r, 'lag_s', say('measure_lag'), 1000, 'ms'),
        estimated(r, 'per_acceleration_s2', say('measure_per_acceleration'), 1000, `${u} / (1000 ${u}/s²)`),
        estimated(r, 'per_direction', say('measure_per_direction'), 1, u),
        [say('measure_rms_left'), `${digits(value(r['rms_left'] as Real))} ${u}`],
        percent(torque, 'gravity', 'measure_gravity'), percent(torque, 'coulomb', 'measure_coulomb'), percent(torque, 'viscous', 'measure_viscous', ` / (${u}/s)`),
        percent(torque, 'inertia', 'measure_inertia', ` / (${u}/s²)`),
    ];
}
function sweep_lines(r: Result): Line[] {
    return [margin(r, 'bandwidth_hz', 'measure_bandwidth', 'Hz', false), margin(r, 'phase_bandwidth_hz', 'measure_phase_bandwidth', 'Hz', false), margin(r, 'resonance_db', 'measure_resonance', 'dB', true),
        margin(r, 'notch_db', 'measure_notch', 'dB', true), margin(r, 'phase_margin_deg', 'measure_phase_margin', '°', true), margin(r, 'gain_margin_db', 'measure_gain_margin', 'dB', true)];
}
function cogging_lines(r: Result): Line[] {
    return [[say('measure_peak_to_peak'), `${digits(value(r['peak_to_peak'] as Real) * 100)} %`], [say('measure_period'), `${digits(value(r['period'] as Real))} ${r.unit}`], [say('measure_seen'), String(r['periods'] ?? '–')]];
}

function move_plots(r: Result, curve: Curve): PlotOf[] {
    const x = numbers(curve, 'time_s') as number[], below = say('measure_plot_time');
    return [
        { title: `${say('measure_plot_position')}, ${r.unit}`, below, x, curves: [{ name: say('measure_plot_set'), values: numbers(curve, 'set_position') }, { name: say('measure_plot_actual'), values: numbers(curve, 'actual_position') }] },
        { title: `${say('measure_plot_error')}, ${r.unit}`, below, x, curves: [{ name: say('measure_plot_error'), values: numbers(curve, 'following_error') }] },
        { title: say('measure_plot_torque'), below, x, curves: [{ name: say('measure_plot_torque'), values: numbers(curve, 'torque').map((t) => (t === null ? null : 100 * t)) }] },
    ];
}
function plots(r: Result): PlotOf[] {
    const [curve, second] = r.curves ?? [];
    if (!curve) return [];
    if (r.kind === 'friction')
        return [{ title: say('measure_plot_torque'), below: `${say('measure_plot_velocity')}, ${r.unit}/s`, x: numbers(curve, 'velocity') as number[], curves: [{ name: say('measure_plot_torque'), values: numbers(curve, 'torque').map((t) => (t === null ? null : 100 * t)) }] }];
    if (r.kind === 'sweep') {
        const x = numbers(curve, 'frequency_hz') as number[], marks: Marked[] = [];
        for (const [key, unit] of [['bandwidth_hz', 'Hz'], ['resonance_db', 'dB'], ['phase_margin_deg', '°'], ['gain_margin_db', 'dB']] as const) {
            const found = r[key] as Margin | null;
            const titles = { bandwidth_hz: 'measure_bandwidth', resonance_db: 'measure_resonance', phase_margin_deg: 'measure_phase_margin', gain_margin_db: 'measure_gain_margin' } as const;
            if (found) marks.push({ x: value(found.frequency_hz), text: `${say(titles[key])}: ${digits(value(found.value))} ${unit}` });
        }
        const pair = (closed: string, open: string): Drawn[] => [{ name: say('measure_plot_closed'), values: numbers(curve, closed) }, { name: say('measure_plot_open'), values: numbers(curve, open) }];
        return [{ title: say('measure_plot_gain'), below: 'Hz', x, logarithmic: true, marks, curves: pair('gain_db', 'open_gain_db') }, { title: say('measure_plot_phase'), below: 'Hz', x, logarithmic: true, marks, curves: pair('phase_deg', 'open_phase_deg') }];
    }
    if (r.kind === 'cogging' && second)
        return [{ title: say('measure_plot_torque'), below: `${say('measure_plot_position')}, ${r.unit}`, x: numbers(second, 'position') as number[], curves: [{ name: say('measure_plot_torque'), values: numbers(second, 'torque').map((t) => (t === null ? null : 100 * t)) }] },
            { title: say('measure_plot_torque'), below: say('measure_harmonic'), x: numbers(curve, 'order') as number[], curves: [{ name: say('measure_wave_torque'), points: true, values: numbers(curve, 'torque').map((t) => (t === null ? null : 100 * t)) }] }];
    return move_plots(r, curve);
}

/** Every curve, one below the other. */
function table_of(r: Result): string[][] {
    const rows: string[][] = [];
    for (const curve of r.curves ?? []) {
        const keys = Object.keys(curve).filter((key) => Array.isArray(curve[key])), length = Math.max(...keys.map((key) => (curve[key] as unknown[]).length));
        rows.push(keys);
        for (let i = 0; i < length; i++) rows.push(keys.map((key) => String((curve[key] as unknown[])[i] ?? '')));
        rows.push([]);
    }
    return rows;
}

function proposals(desk: Desk, r: Result): HTMLElement | undefined {
    if (!r.proposals?.length) return undefined;
    const lines = r.proposals.map((p) => `${p.key}: ${Number(value(p.value).toPrecision(5))}${p.unit ? ' ' + p.unit : ''}`);
    const copy = element('button', { type: 'button', 'data-do': 'copy', onclick: () => void navigator.clipboard?.writeText(lines.join('\n')).then(() => desk.tell('note', say('measure_copied'))) }, say('measure_copy'));
    return panel('measure_proposals', element('pre', { class: 'measure-proposals', 'data-value': 'proposals' }, lines.join('\n')), copy);
}

const of_group = (group: string, word: string): string => {
    const key = `measure_${group}_${word}`;
    return Object.hasOwn(texts, key) ? say(key as Key) : word;
};

export class ResultView {
    readonly root = element('div', { class: 'stack', 'data-value': 'measure_result' });
    private plots_: Plot[] = [];

    constructor(private readonly desk_: Desk) {}

    clear(text: string): void {
        this.leave();
        this.root.replaceChildren(element('p', { class: 'hint' }, text));
    }
    show(r: Result): void {
        this.leave();
        const lines = r.kind === 'friction' ? friction_lines(r) : r.kind === 'sweep' ? sweep_lines(r) : r.kind === 'following' ? following_lines(r) : r.kind === 'cogging' ? cogging_lines(r) : move_lines(r);
        lines.push([say('measure_dead_time'), `${digits((r.dead_time_s ?? NaN) * 1000)} ms`], [say('measure_samples'), String(r.samples)]);
        const values = new Values();
        for (const [title, text] of lines) values.root.append(element('dt', {}, title), element('dd', {}, text));
        const said: HTMLElement[] = [];
        if (r.end !== 'done') said.push(element('p', { class: 'hint', 'data-tone': 'warn' }, '⚠ ' + of_group('ended', r.end)));
        if (r.doubt) said.push(element('p', { class: 'hint', 'data-tone': 'bad' }, '⚠ ' + of_group('doubt', r.doubt)));
        if (r['all_settled'] === false) said.push(element('p', { class: 'hint', 'data-tone': 'warn' }, '⚠ ' + say('measure_not_settled')));
        if (r.kind === 'sweep') said.push(element('p', { class: 'hint' }, say('measure_open_hint')));
        const save = element('button', { type: 'button', 'data-do': 'csv', onclick: () => save_file(`${r.axis}-${r.kind}-${file_time()}.csv`, 'text/csv', csv(table_of(r))) }, say('measure_csv'));
        this.plots_ = plots(r).map((of) => new Plot(of));
        const proposed = proposals(this.desk_, r);
        this.root.replaceChildren(element('section', { class: 'panel' }, element('h2', {}, `${say('measure_result')}: ${of_group('kind', r.kind)}`), ...said, values.root, save), ...(proposed ? [proposed] : []),
            ...this.plots_.map((plot) => element('section', { class: 'panel' }, plot.root)));
    }
    leave(): void {
        for (const plot of this.plots_) plot.destroy();
        this.plots_ = [];
    }
}
