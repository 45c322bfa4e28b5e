// What the tests of the scope have in common: a machine with pulses of one cycle, what the page exports, what the machine itself has.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { Doubles } from '@page/scope/base64';
import { Cell, quiet, until } from './cell';
import { Json } from './machine';

// Each two seconds: at 1 kHz a sample.
const pulses = Array.from({ length: 600 }, (_, i) => `    - { at: ${4000 + 2000 * i} ms, input: start_button, value: 1 }\n    - { at: ${4001 + 2000 * i} ms, input: start_button, value: 0 }`).join('\n');
export const with_pulses = (yaml: string): string => `${quiet(yaml).trimEnd()}\n  events:\n${pulses}\n`;

export interface Table {
    names: string[];
    columns: number[][];
    rows: number;
}

/** Of a CSV: times first. */
export function table(text: string): Table {
    const [head = '', ...lines] = text.trimEnd().split('\n');
    const cells = lines.map((line) => line.split(',').map((cell) => (cell === 'nan' ? NaN : Number(cell))));
    const names = head.split(',').map((name) => name.replace(/\[.*/, ''));
    return { names, columns: names.map((_, i) => cells.map((row) => row[i] ?? NaN)), rows: lines.length };
}

export class ScopeCell {
    readonly cell = new Cell();

    start(): Promise<void> {
        return this.cell.start({ machine: with_pulses, cycle: '1 ms' });
    }
    press(what: string): Promise<void> {
        return this.cell.page.locator(`[data-do="${what}"]`).click();
    }
    shown(value: string): Promise<string | null> {
        return this.cell.page.locator(`[data-value="${value}"]`).first().textContent();
    }
    /** Curves of these signals, chosen as a person does it. */
    async tick(...names: string[]): Promise<void> {
        if ((await this.cell.page.locator('[data-do="signals"]').getAttribute('aria-expanded')) !== 'true') await this.press('signals');
        const search = this.cell.page.locator('.scope-picker input[type="search"]');
        for (const name of names) {
            await search.fill(name.replace('.', ' '));
            await this.cell.page.locator(`input[data-signal="${name}"]`).check();
        }
        await search.fill('');
    }
    /** So many more are there. */
    async cycles(more: number): Promise<void> {
        const now = async () => Number((await this.cell.machine.state())['cycle']), from = await now();
        await until(`${more} cycles`, async () => (await now()) >= from + more);
    }
    /** When each cycle was that the machine has: s. A busy computer skips time. */
    async times(): Promise<{ from: number; seconds: number[] }> {
        const all = (await this.cell.told({ cmd: 'scope_signals' }))['scope'] as Json, { from, columns } = await this.recorded(['time_s'], Number(all['first']), Number(all['last']) + 1);
        return { from, seconds: columns[0] ?? [] };
    }
    /** What "save as CSV" gives. */
    async exported(): Promise<string> {
        if ((await this.cell.page.locator('[data-do="files"]').getAttribute('aria-expanded')) !== 'true') await this.press('files');
        const [download] = await Promise.all([this.cell.page.waitForEvent('download'), this.press('save_csv')]);
        return readFileSync(await download.path(), 'utf8');
    }
    /** Every sample of some signals, asked of the machine itself; from undefined: the newest that it has. */
    async recorded(names: string[], from: number, to: number, recording = ''): Promise<{ from: number; columns: number[][] }> {
        const columns: number[][] = names.map(() => []);
        let begin = from;
        for (let at = from; at < to; at += 3000) {
            const answer = await this.cell.told({ ...(recording ? { cmd: 'recording_read', recording } : { cmd: 'scope_read' }), signals: names, from: at, to: Math.min(to, at + 3000), points: 3000 });
            assert.equal(answer['per'], 1);
            if (at === from) begin = Number(answer['from']);
            (answer['data'] as string[]).forEach((text, i) => columns[i]?.push(...new Doubles().decode(text)));
        }
        return { from: begin, columns };
    }
    /** Each row is the machine's next cycle, each number the machine's; answers how many cycles were looked at. */
    async as_the_machine(file: Table, recording = ''): Promise<number> {
        const names = ['time_s', ...file.names.slice(1)];
        const all = (await this.cell.told(recording ? { cmd: 'recording_signals', recording } : { cmd: 'scope_signals' }))['scope'] as Json;
        const first = Number(all['first']), times = (await this.recorded(['time_s'], first, Number(all['last']) + 1, recording));
        const start = times.columns[0]?.[0] ?? NaN, skipped = (file.columns[0] ?? []).findIndex((t) => t >= start);  // the machine forgets the oldest meanwhile
        assert.ok(skipped >= 0, `rows from ${file.columns[0]?.[0]} to ${file.columns[0]?.[file.rows - 1]} s, the machine has from ${start} s`);
        const at = times.columns[0]?.indexOf(file.columns[0]?.[skipped] ?? NaN) ?? -1;
        assert.ok(at >= 0, 'such a cycle there never was');
        const count = file.rows - skipped, real = await this.recorded(names, times.from + at, times.from + at + count, recording);
        const gone = real.from - times.from - at;
        names.forEach((name, i) => assert.deepEqual(file.columns[i]?.slice(skipped + gone), real.columns[i], name));
        return count - gone;
    }
}
