// The page over LCM: what it shows is what the machine has recorded; without multicast it says why, and takes the socket.
import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { after, before, test } from 'node:test';
import { Cell, pause, until } from './cell';
import { recorded } from './recorded';

const cell = new Cell();
/** The network is the tests' own. */
const ip = (...words: string[]): void => {
    const done = spawnSync('ip', words, { encoding: 'utf8' });
    assert.equal(done.status, 0, `ip ${words.join(' ')}: ${done.stderr}`);
};
const route = (deed: 'add' | 'del'): void => ip('route', deed, '224.0.0.0/4', 'dev', 'lo');
const shown = async (name: string): Promise<string> => (await cell.page.locator(`[data-value="${name}"]`).textContent()) ?? '';

before(async () => {
    ip('link', 'set', 'lo', 'multicast', 'on');
    route('add');
    await cell.start();
}, { timeout: 120_000 });
after(async () => {
    await cell.end();
    spawnSync('ip', ['route', 'del', '224.0.0.0/4', 'dev', 'lo']);
});

test('values that came over LCM are those that the machine has recorded of the same cycle, to the last digit', { timeout: 90_000 }, async () => {
    await cell.look('#system');
    await until('the page says LCM', async () => (await shown('values_from')) === 'LCM');
    assert.equal(await shown('why_not_lcm'), '–');
    await cell.powered_and_homed('x');
    await cell.machine.told({ cmd: 'move', axis: 'x', position: 300, velocity: 60 });
    await until('x moves', async () => (await cell.axis('x')).set_velocity > 50);
    await cell.look('#axis/x');
    const signals: [string, string, string, number][] = [['big_position', 'x.actual_position', '', 3], ['head_set_position', 'x.set_position', ' mm', 3], ['head_actual_velocity', 'x.actual_velocity', ' mm/s', 3]];
    const seen = new Set<string>();
    for (let look = 0; look < 12; look++) {
        await pause(150);
        const [cycle, said] = await cell.page.evaluate((names) => [Number(document.body.dataset['cycle']), names.map((name) => document.querySelector(`[data-value="${name}"]`)?.textContent ?? '')] as const, signals.map(([name]) => name));
        for (const [i, [name, signal, unit, decimals]] of signals.entries()) {
            const [value] = await recorded(cell.machine, signal, cycle, cycle + 1);
            assert.equal(said[i]?.replace('−', '-'), `${value?.toFixed(decimals).replace(/^-(0\.?0*)$/, '$1')}${unit}`, `${name} of cycle ${cycle}`);
        }
        seen.add(said[0] ?? '');
    }
    assert.ok(seen.size >= 8, 'the values stood still');
});

test('a route that goes away is told with its remedy, and the values go on over the socket; it comes back, and so does LCM', { timeout: 90_000 }, async () => {
    await cell.look('#system');
    await until('the page says LCM', async () => (await shown('values_from')) === 'LCM');
    route('del');
    await until('the page says socket', async () => (await shown('values_from')) === 'the local socket');
    assert.match(await shown('why_not_lcm'), /ip route add 224\.0\.0\.0\/4 dev lo/);
    const before = Number(await cell.page.evaluate(() => document.body.dataset['cycle']));
    await until('the values advance', async () => Number(await cell.page.evaluate(() => document.body.dataset['cycle'])) > before);
    assert.ok(await cell.page.locator('body:not([data-stale])').count());
    route('add');
    await until('the page says LCM again', async () => (await shown('values_from')) === 'LCM');
    assert.equal(await shown('why_not_lcm'), '–');
});
