// The scope of a machine that runs: nothing is missing, a trigger meets the one sample, an alarm's recording opens, what is exported is what the machine has.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { after, before, test } from 'node:test';
import { Doubles } from '@page/scope/base64';
import { read_csv } from '@page/scope/csv';
import { Cell, pause, quiet, until } from './cell';
import { Json } from './machine';

// One cycle long, each two seconds: at 1 kHz a sample.
const pulses = Array.from({ length: 60 }, (_, i) => `    - { at: ${4000 + 2000 * i} ms, input: start_button, value: 1 }\n    - { at: ${4001 + 2000 * i} ms, input: start_button, value: 0 }`).join('\n');
const cell = new Cell();
before(() => cell.start({ machine: (yaml) => `${quiet(yaml).trimEnd()}\n  events:\n${pulses}\n` }), { timeout: 120_000 });
after(() => cell.end());

const press = (what: string) => cell.page.locator(`[data-do="${what}"]`).click();
const tick = async (...names: string[]) => {
    if ((await cell.page.locator('[data-do="signals"]').getAttribute('aria-expanded')) !== 'true') await press('signals');
    const search = cell.page.locator('.scope-picker input[type="search"]');
    for (const name of names) {
        await search.fill(name.replace('.', ' '));
        await cell.page.locator(`input[data-signal="${name}"]`).check();
    }
    await search.fill('');
};
async function exported(): Promise<string> {
    if ((await cell.page.locator('[data-do="files"]').getAttribute('aria-expanded')) !== 'true') await press('files');
    const [download] = await Promise.all([cell.page.waitForEvent('download'), press('save_csv')]);
    return readFileSync(await download.path(), 'utf8');
}
/** Every sample of a signal, asked of the machine itself. */
async function recorded(names: string[], from: number, to: number, recording = ''): Promise<{ from: number; columns: number[][] }> {
    const answer = await cell.machine.ask({ ...(recording ? { cmd: 'recording_read', recording } : { cmd: 'scope_read' }), signals: names, from, to, points: to - from });
    assert.equal(answer['ok'], true, JSON.stringify(answer['error']));
    assert.equal(answer['per'], 1);
    return { from: Number(answer['from']), columns: (answer['data'] as string[]).map((text) => [...new Doubles().decode(text)]) };
}
const shown = (value: string) => cell.page.locator(`[data-value="${value}"]`).first().textContent();

test('32 signals at 1 kHz, live for six seconds: not one cycle is missing', { timeout: 60_000 }, async () => {
    await cell.look('#scope');
    const described = (await cell.machine.ask({ cmd: 'scope_signals' }))['scope'] as Json;
    assert.equal(described['cycle_ns'], 1_000_000);
    const names = (described['signals'] as Json[]).filter((s) => s['kind'] === 'real' && s['group'] === 'axis').map((s) => String(s['name'])).slice(0, 32);
    const more = (described['signals'] as Json[]).map((s) => String(s['name'])).filter((name) => !names.includes(name) && name !== 'time_s').slice(0, 32 - names.length);
    // A set-up of all of them, as one that was saved.
    await cell.page.evaluate((channels) => {
        localStorage.setItem('scope_last', JSON.stringify({ taktwerk_scope: 1, span_s: 5, channels: channels.map((name, colour) => ({ name, colour, offset: 0 })) }));
    }, [...names, ...more]);
    await cell.page.reload();
    await cell.page.locator('.scope-values tbody tr').nth(31).waitFor();
    await pause(6000);
    const file = read_csv(await exported(), () => undefined);
    assert.equal(file.signals.length, 32);
    assert.ok(file.to > 4900, `${file.to} cycles`);
    for (const { name } of file.signals) assert.deepEqual(file.store.tracks.get(name)?.have.list, [{ from: 0, to: file.to }], name);
    assert.equal(await cell.page.locator('tr[data-missing]').count(), 0);
});

test('a trigger meets the one sample of a pulse of 1 ms', { timeout: 60_000 }, async () => {
    await cell.look('#scope');
    await tick('in.start_button');
    await press('trigger');
    await cell.page.locator('[data-trigger="kind"]').selectOption('rising');
    await cell.page.locator('[data-trigger="signal"]').fill('in.start_button');
    await cell.page.locator('[data-trigger="level"]').fill('0.5');
    await cell.page.locator('[data-trigger="length_s"]').fill('0.05');
    await cell.page.locator('[data-trigger="before_percent"]').fill('40');
    await press('arm');
    await cell.page.locator('.scope-marker:visible').waitFor({ timeout: 10_000 });
    await until('it says so', async () => /triggered/.test((await shown('trigger_status')) ?? ''));
    const file = read_csv(await exported(), () => undefined);
    assert.equal(file.to, 50, 'cycles');
    const samples = [...file.store.copy('in.start_button', 0, file.to)];
    assert.deepEqual(samples.map((v, i) => (v === 1 ? i : -1)).filter((i) => i >= 0), [20], 'one sample, behind 40 % of what is shown');
});

test('a trigger that nothing meets waits, and is taken back', { timeout: 60_000 }, async () => {
    await cell.look('#scope');
    await press('trigger');
    await cell.page.locator('[data-trigger="kind"]').selectOption('above');
    await cell.page.locator('[data-trigger="signal"]').fill('x.set_velocity');
    await cell.page.locator('[data-trigger="level"]').fill('1e6');
    await press('arm');
    await until('it waits', async () => /waiting/.test((await shown('trigger_status')) ?? ''));
    assert.ok(await cell.page.locator('.scope-marker').isHidden());
    await press('disarm');
    await until('it does not wait', async () => cell.page.locator('[data-value="trigger_status"]').isHidden());
    // What is wrong is said, and not sent.
    await cell.page.locator('[data-trigger="signal"]').fill('no.such');
    const before = cell.sent.filter((m) => m['cmd'] === 'scope_arm').length;
    await press('arm');
    assert.match((await cell.page.locator('.scope-complaint').first().textContent()) ?? '', /no such signal/);
    assert.equal(cell.sent.filter((m) => m['cmd'] === 'scope_arm').length, before);
});

test('what is exported is what the machine has, to the last digit; so is what a cursor says', { timeout: 90_000 }, async () => {
    await cell.powered_and_homed('x');
    await cell.look('#scope');
    await tick('x.set_position', 'x.actual_position', 'x.following_error', 'x.state');
    await cell.machine.ask({ cmd: 'move', axis: 'x', position: 100, velocity: 150 });
    await pause(1500);
    await press('freeze');
    const names = ['x.set_position', 'x.actual_position', 'x.following_error', 'x.state'];
    const file = read_csv(await exported(), () => undefined);
    // Cycle 0 of the file, found by its time.
    const probe = await cell.machine.ask({ cmd: 'scope_read', signals: ['time_s'] });
    const zero = Number(probe['from']) + Math.round(file.start_s * 1000 - Number(probe['time_ns']) / 1e6);
    const real = await recorded(names, zero, zero + file.to);
    const begin = real.from - zero;  // the machine may have forgotten the oldest meanwhile
    assert.ok(file.to - begin > 1000);
    names.forEach((name, i) => assert.deepEqual([...file.store.copy(name, begin, file.to)], real.columns[i], name));
    assert.ok(new Set(real.columns[0]).size > 100, 'it moved');

    await press('cursors');
    const line = cell.page.locator('[data-cursor="a"]');
    await line.focus();
    await cell.page.keyboard.press('ArrowRight');
    await until('the values are there', async () => (await cell.page.locator('tr[data-row="x.actual_position"] [data-value="a"]').textContent()) !== '–');
    await pause(400);
    const between = read_csv(await exported(), () => undefined);
    const text = (row: string, value: string) => cell.page.locator(`tr[data-row="${row}"] [data-value="${value}"]`).textContent();
    assert.equal(Number((await text('x.actual_position', 'a'))?.replace('−', '-')), between.store.at('x.actual_position', 0));
    assert.equal(Number((await text('x.actual_position', 'b'))?.replace('−', '-')), between.store.at('x.actual_position', between.to - 1));
    assert.ok(['Standstill', 'DiscreteMotion'].includes((await text('x.state', 'b')) ?? ''));
});

test('zooming asks for no less: each cycle is a sample, frozen or scrolled back', { timeout: 60_000 }, async () => {
    await cell.look('#scope');
    await tick('in.start_button');
    await pause(4500);
    await press('freeze');
    await cell.page.locator('.scope-surface').focus();
    for (let i = 0; i < 3; i++) await cell.page.keyboard.press('ArrowLeft');
    for (let i = 0; i < 4; i++) await cell.page.keyboard.press('-');
    const wide = read_csv(await exported(), () => undefined);
    await cell.page.locator('.scope-surface').focus();
    await cell.page.keyboard.press('a');
    const all = read_csv(await exported(), () => undefined);
    assert.ok(all.to > 6000);
    const ones = [...all.store.copy('in.start_button', 0, all.to)].map((v, i) => (v === 1 ? i : -1)).filter((i) => i >= 0);
    assert.ok(ones.length >= 3, 'pulses of one sample');
    ones.slice(1).forEach((at, i) => assert.equal(at - (ones[i] ?? 0), 2000));
    assert.deepEqual(wide.store.tracks.get('in.start_button')?.have.list.length, 1);
});

test('an alarm that stops leaves a recording, and it opens in the same view', { timeout: 90_000 }, async () => {
    await cell.powered_and_homed('y');
    await cell.machine.ask({ cmd: 'simulate', line: 'drive-fault y 0x3130' });
    let name = '', about: Json = {};
    await until('the recording is whole', async () => {
        about = ((await cell.machine.ask({ cmd: 'recordings' }))['recordings'] as Json[] | undefined)?.find((r) => String(r['source']).includes('y') && r['complete'] === true) ?? {};
        name = String(about['name'] ?? '');
        return name !== '';
    }, 20_000);
    await cell.look(`#scope/recording/${encodeURIComponent(name)}`);
    await until('it says which', async () => ((await shown('scene')) ?? '').includes(name));
    await cell.page.locator('.scope-marker[data-kind="alarm"]:visible').waitFor();
    await until('its values are there', async () => (await cell.page.locator('tr[data-row="y.state"] [data-value="newest"]').textContent()) === 'ErrorStop');
    await pause(500);
    const file = read_csv(await exported(), () => undefined), from = Number(about['from']), to = Number(about['to']);
    assert.ok(to - from >= 2000);
    const real = await recorded(['y.state', 'y.set_position'], from, to, name);
    assert.deepEqual([...file.store.copy('y.state', real.from - from, to - from)], real.columns[0]);
    assert.deepEqual([...file.store.copy('y.set_position', real.from - from, to - from)], real.columns[1]);
    // One click back to what runs.
    await cell.page.locator('.scope-back').click();
    await until('it is live again', async () => cell.page.locator('[data-do="freeze"]').isVisible());
    await cell.machine.ask({ cmd: 'reset' });
});

test('a file of this disk opens in the same view, and wrong ones are told', { timeout: 60_000 }, async () => {
    await cell.look('#scope');
    await press('files');
    const give = (name: string, text: string) => cell.page.locator('[data-file="csv"]').setInputFiles({ name, mimeType: 'text/csv', buffer: Buffer.from(text) });
    await give('bad.csv', 'time_s,a\n0,1\n0.001,zwei\n');
    await until('it is told', async () => /line 3.*zwei/.test((await cell.page.locator('.scope-complaint:visible').textContent()) ?? ''));
    const rows = Array.from({ length: 2000 }, (_, i) => `${i / 1000},${10 * Math.sin((2 * Math.PI * 50 * i) / 1000)}`).join('\n');
    await give('sine.csv', `time_s,w.position[mm]\n${rows}\n`);
    await until('it is shown', async () => ((await shown('scene')) ?? '').includes('sine.csv'));
    await press('signals');
    await tick('w.position');
    await cell.page.locator('[data-view="spectrum"]').click();
    const cells = (value: string) => cell.page.locator(`.spectrum [data-value="${value}"]`).first().textContent();
    await until('its spectrum is the sine', async () => (await cells('largest_hz')) === '50 Hz');
    assert.equal(Math.round(Number(await cells('largest')) * 1e6) / 1e6, 10);
    await cell.page.locator('[data-view="xy"]').click();
    await cell.page.locator('.scope-other.xy canvas').waitFor();
});

test('a set-up is saved by name, exported and comes back', { timeout: 60_000 }, async () => {
    await cell.look('#scope');
    await tick('x.actual_torque');
    await press('files');
    await cell.page.locator('[data-field="setup"]').fill('torque of x');
    await press('save_setup');
    const [download] = await Promise.all([cell.page.waitForEvent('download'), press('export_setups')]);
    const text = readFileSync(await download.path(), 'utf8');
    assert.match(text, /torque of x/);
    await cell.look('#scope');  // somebody else's browser
    assert.equal(await cell.page.locator('tr[data-row="x.actual_torque"]').count(), 0);
    await press('files');
    await cell.page.locator('[data-file="setup"]').setInputFiles({ name: 'set.json', mimeType: 'application/json', buffer: Buffer.from('{"a":1}') });
    await until('what is none is told', async () => /no set-up/.test((await cell.page.locator('.scope-complaint:visible').textContent()) ?? ''));
    await cell.page.locator('[data-file="setup"]').setInputFiles({ name: 'set.json', mimeType: 'application/json', buffer: Buffer.from(text) });
    await cell.page.locator('[data-setup="torque of x"] button').first().click();
    await cell.page.locator('tr[data-row="x.actual_torque"]').waitFor();
});

test('the picture is a PNG of its size', { timeout: 60_000 }, async () => {
    await cell.look('#scope');
    await pause(500);
    await press('files');
    const [download] = await Promise.all([cell.page.waitForEvent('download'), press('save_png')]);
    const bytes = readFileSync(await download.path());
    assert.equal(bytes.subarray(1, 4).toString(), 'PNG');
    assert.ok(bytes.readUInt32BE(16) > 700 && bytes.readUInt32BE(20) > 200);
});

test('the browser had nothing to complain about', () => assert.deepEqual(cell.complaints, []));
