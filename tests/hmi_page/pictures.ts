// node pictures.mjs FOLDER: a picture of each page as docs/hmi.md shows it (./dev pictures): in English and light, the axis once more in Chinese and dark.
import { mkdirSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { Cell, pause, Taste, unhurried, until } from './cell';
import { group_picture } from './group_picture';
import { recording_picture, scope_pictures } from './scope_pictures';
import { small_png } from './small_png';

const folder = process.argv[2] ?? '.';
mkdirSync(folder, { recursive: true });
const cell = new Cell();
const keep = async (name: string): Promise<void> => {
    const picture = small_png(await cell.page.screenshot());
    writeFileSync(join(folder, `${name}.png`), picture);
    console.log(`${name}.png ${(picture.length / 1024).toFixed(0)} kB`);
};
const take = async (name: string, hash: string, taste: Taste = {}, settled: () => Promise<void> = () => pause(900)): Promise<void> => {
    await cell.look(`#${hash}`, taste);
    await settled();
    await keep(name);
};
/** Held as the page holds it, to its end; a computer that is late lets go, and it begins anew. */
const measured = async (order: Record<string, unknown>): Promise<void> => {
    const running = async () => ((await cell.machine.state())['measure'] as { running: boolean; end: string } | null);
    for (let left = 5; left > 0; left--) {
        await cell.machine.ask({ cmd: 'measure', axis: 'x', press: true, ...order });
        while ((await running())?.running) await cell.machine.ask({ cmd: 'measure', axis: 'x' });
        if ((await running())?.end === 'done') return;
        await pause(500);
    }
};
const shuttle = async (to: number): Promise<void> => void (await cell.machine.ask({ cmd: 'move', axis: 'x', position: to, velocity: 90 }));

try {
    await cell.start({ machine: unhurried });
    for (const axis of ['x', 'y', 'z']) await cell.powered_and_homed(axis);
    await cell.machine.ask({ cmd: 'reset_peaks', axis: 'all' });
    for (const [axis, position] of [['y', 160], ['z', 55]] as const) await cell.machine.ask({ cmd: 'move', axis, position, velocity: 100 });
    await shuttle(610);
    await pause(1500);
    await take('axis', 'axis/x');
    await take('overview', 'overview');
    await until('x is there', async () => Math.abs((await cell.axis('x')).actual_position - 610) < 0.1);
    await measured({ kind: 'step', distance: 20, velocity: 100, count: 1 });
    await take('measure', 'measure/x', {}, () => pause(2500));
    await shuttle(90);
    await pause(1000);
    await take('axis-zh', 'axis/x', { theme: 'dark', language: 'zh' });
    await take('drive', 'axis/x/drive', {}, async () => {
        await cell.page.locator('[data-input="filter"]').fill('P05');
        await cell.page.locator('[data-input="compare"]').selectOption('compare_factory');
        await pause(600);
        if (await cell.page.locator('[data-do="read_all"]').isEnabled()) await cell.page.locator('[data-do="read_all"]').click();
        await pause(2500);
    });
    await take('bus', 'bus', {}, () => pause(2500));
    await take('programs', 'programs', {}, () => pause(2500));
    await take('system', 'system', {}, () => pause(2500));
    // The machine builder's own page (docs/views.md), while the cell works.
    await cell.machine.ask({ cmd: 'mode', mode: 'automatic' });
    await cell.machine.ask({ cmd: 'program_start', program: 'pick_and_place' });
    for (let i = 0; i < 12; i++) {
        await cell.machine.ask({ cmd: 'set_value', variable: 'pick_and_place.start', value: 1, press: i === 0 });
        await pause(50);
    }
    await cell.machine.ask({ cmd: 'set_value', variable: 'pick_and_place.start', value: 0 });
    await pause(9000);
    await take('view', 'view/cell', {}, () => pause(9000));
    await take('view-zh', 'view/cell', { theme: 'dark', language: 'zh' }, () => pause(9000));
    await cell.machine.ask({ cmd: 'mode', mode: 'manual' });
    await pause(1500);
    await take('io', 'io', {}, async () => {
        const force = cell.page.locator('[data-do="forcing"]');
        if (!(await force.isEnabled())) return;
        await force.check();
        await cell.page.locator('[data-input-point="part_present"] [data-set="0"]').click();
        await pause(800);
    });
    await scope_pictures(cell, keep);
    await cell.machine.ask({ cmd: 'simulate', line: 'drive-fault y 0x3130' });
    await pause(3000);  // the recording goes on for two seconds
    await take('alarms', 'alarms');
    await take('history', 'alarms/history');
    await recording_picture(cell, keep);
} finally {
    await cell.end();
}
await group_picture(folder);
