// Files of numbers: the same columns and digits as `taktwerk run --trace` writes, and such a file read again.
import { Signal } from './signals';
import { Spans } from './spans';
import { Store } from './store';

/** As the trace writes it: the shortest digits that give the same double again. */
export function digits(value: number): string {
    if (Number.isNaN(value)) return 'nan';
    if (!Number.isFinite(value)) return value > 0 ? 'inf' : '-inf';
    const size = Math.abs(value);
    if (value === 0 || (size >= 1e-4 && size < 1e16)) return String(value);
    const [mantissa = '', exponent = ''] = value.toExponential().split('e');
    return `${mantissa}e${exponent.slice(0, 1)}${exponent.slice(1).padStart(2, '0')}`;
}

export interface CsvColumn {
    name: string;
    unit: string;
}

const block = 4096;  // cycles: ten minutes of many signals are never one text

/** Every cycle of [from, to) that one of the columns has, in pieces; a cell without a number is "nan", a cycle that no column has is no line. */
export function* csv_pieces(store: Store, columns: readonly CsvColumn[], from: number, to: number, seconds: (cycle: number) => number): Generator<string> {
    yield ['time_s', ...columns.map((c) => (c.unit ? `${c.name}[${c.unit}]` : c.name))].join() + '\n';
    for (let begin = from; begin < to; begin += block) {
        const end = Math.min(to, begin + block), samples = columns.map((c) => store.copy(c.name, begin, end)), there = new Spans();
        for (const { name } of columns) for (const span of store.tracks.get(name)?.have.list ?? []) there.add(Math.max(begin, span.from), Math.min(end, span.to));
        let text = '';
        for (const span of there.list)
            for (let cycle = span.from; cycle < span.to; cycle++) {
                text += digits(seconds(cycle));
                for (const column of samples) text += ',' + digits(column[cycle - begin] as number);
                text += '\n';
            }
        if (text !== '') yield text;
    }
}

export interface CsvFile {
    cycle_ns: number;
    signals: Signal[];
    store: Store;
    /** Cycles: [0, to). */
    to: number;
    /** Time of cycle 0. */
    start_s: number;
}

export type CsvTrouble = 'empty' | 'no_time' | 'columns' | 'number' | 'backwards' | 'doubled';
export class CsvError extends Error {
    constructor(readonly trouble: CsvTrouble, readonly line: number, readonly what = '') {
        super(`${trouble} in line ${line}: ${what}`);
    }
}

const number = (text: string): number => {
    const known: Record<string, number> = { nan: NaN, '-nan': NaN, inf: Infinity, '-inf': -Infinity };
    const value = known[text] ?? (text.trim() === '' ? undefined : Number(text));
    if (value === undefined || (Number.isNaN(value) && known[text] === undefined)) throw new Error(text);
    return value;
};

/** What kind it is nobody wrote down: only 0 and 1 is a bit, a known signal is what the machine says. */
export function read_csv(text: string, known: (name: string) => Signal | undefined): CsvFile {
    const lines = text.split(/\r?\n/);
    while (lines.length > 0 && lines[lines.length - 1] === '') lines.pop();
    if (lines.length < 3) throw new CsvError('empty', lines.length);
    const heads = (lines[0] ?? '').split(',').map((head) => /^(.*?)(?:\[(.*)\])?$/.exec(head.trim()) ?? ['', '', '']);
    if (heads[0]?.[1] !== 'time_s') throw new CsvError('no_time', 1, heads[0]?.[1] ?? '');
    const names = heads.map((head) => head[1] ?? '');
    const twice = names.find((name, i) => names.indexOf(name) !== i);
    if (twice !== undefined) throw new CsvError('doubled', 1, twice);
    const rows = lines.length - 1;
    const columns = heads.map(() => new Float64Array(rows));
    for (let row = 0; row < rows; row++) {
        const cells = (lines[row + 1] as string).split(',');
        if (cells.length !== heads.length) throw new CsvError('columns', row + 2, `${cells.length} ≠ ${heads.length}`);
        try {
            cells.forEach((cell, i) => ((columns[i] as Float64Array)[row] = number(cell)));
        } catch (wrong) {
            throw new CsvError('number', row + 2, (wrong as Error).message);
        }
    }
    const time = columns[0] as Float64Array;
    let step = Infinity;
    for (let row = 1; row < rows; row++) {
        const passed = (time[row] as number) - (time[row - 1] as number);
        if (!(passed > 0)) throw new CsvError('backwards', row + 2);
        step = Math.min(step, passed);
    }
    const cycle_ns = Math.max(1, Math.round(step * 1e6) * 1000 || Math.round(step * 1e9));
    const start_s = time[0] as number;
    const cycle = (row: number): number => Math.round(((time[row] as number) - start_s) / (cycle_ns / 1e9));
    const to = cycle(rows - 1) + 1;
    const store = new Store(to);
    const signals: Signal[] = [];
    for (let i = 1; i < names.length; i++) {
        const name = names[i] as string, values = columns[i] as Float64Array;
        for (let row = 0; row < rows;) {  // a piece without a gap at a time
            let end = row + 1;
            while (end < rows && cycle(end) === cycle(row) + (end - row)) end++;
            store.put(name, cycle(row), values.subarray(row, end));
            row = end;
        }
        const [of = '', ...rest] = name.split('.');
        const bit = values.every((v) => v === 0 || v === 1);
        signals.push({ ...(known(name) ?? { kind: bit ? 'bit' : 'real', group: rest.length > 0 ? 'axis' : 'machine', of: rest.length > 0 ? of : '', en: '', zh: '' }), name, unit: heads[i]?.[2] ?? known(name)?.unit ?? '' });
    }
    return { cycle_ns, signals, store, to, start_s };
}
