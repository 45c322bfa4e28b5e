// What the scope of a machine that runs waits for and keeps: a trigger meets the one sample of a pulse, an alarm's recording opens in the same view.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { patience, until } from './cell';
import { Json } from './machine';
import { ScopeCell, table } from './scope_cell';

const scope = new ScopeCell(), { cell } = scope;
before(() => scope.start(), { timeout: 120_000 });
after(() => cell.end());

test('a trigger meets the one sample of a pulse of 1 ms', { timeout: 240_000 }, async () => {
    await cell.look('#scope');
    await scope.tick('in.start_button');
    await scope.press('trigger');
    await cell.page.locator('[data-trigger="kind"]').selectOption('rising');
    await cell.page.locator('[data-trigger="signal"]').fill('in.start_button');
    await cell.page.locator('[data-trigger="level"]').fill('0.5');
    await cell.page.locator('[data-trigger="length_s"]').fill('0.05');
    await cell.page.locator('[data-trigger="before_percent"]').fill('40');
    await scope.press('arm');
    await cell.page.locator('.scope-marker:visible').waitFor({ timeout: patience });
    await until('it says so', async () => /triggered/.test((await scope.shown('trigger_status')) ?? ''));
    const file = table(await scope.exported());
    assert.equal(file.rows, 50, 'cycles');
    const samples = file.columns[file.names.indexOf('in.start_button')] ?? [];
    assert.deepEqual(samples.map((v, i) => (v === 1 ? i : -1)).filter((i) => i >= 0), [20], 'one sample, behind 40 % of what is shown');
});

test('a trigger that nothing meets waits, and is taken back', { timeout: 240_000 }, async () => {
    await cell.look('#scope');
    await scope.press('trigger');
    await cell.page.locator('[data-trigger="kind"]').selectOption('above');
    await cell.page.locator('[data-trigger="signal"]').fill('x.set_velocity');
    await cell.page.locator('[data-trigger="level"]').fill('1e6');
    await scope.press('arm');
    await until('it waits', async () => /waiting/.test((await scope.shown('trigger_status')) ?? ''));
    assert.ok(await cell.page.locator('.scope-marker').isHidden());
    await scope.press('disarm');
    await until('it does not wait', async () => cell.page.locator('[data-value="trigger_status"]').isHidden());
    // What is wrong is said, and not sent.
    await cell.page.locator('[data-trigger="signal"]').fill('no.such');
    const before = cell.sent.filter((m) => m['cmd'] === 'scope_arm').length;
    await scope.press('arm');
    assert.match((await cell.page.locator('.scope-complaint').first().textContent()) ?? '', /no such signal/);
    assert.equal(cell.sent.filter((m) => m['cmd'] === 'scope_arm').length, before);
});

test('an alarm that stops leaves a recording, and it opens in the same view', { timeout: 240_000 }, async () => {
    await cell.powered_and_homed('y');
    const before = Date.now() * 1000;
    await cell.told({ cmd: 'simulate', line: 'drive-fault y 0x3130' });
    let name = '', about: Json = {};
    await until('the recording is whole', async () => {
        about = ((await cell.machine.ask({ cmd: 'recordings' }))['recordings'] as Json[] | undefined)?.find((r) => Number(r['utime']) >= before && String(r['source']).includes('y') && r['complete'] === true) ?? {};
        name = String(about['name'] ?? '');
        return name !== '';
    });
    await cell.look(`#scope/recording/${encodeURIComponent(name)}`);
    await until('it says which', async () => ((await scope.shown('scene')) ?? '').includes(name));
    await cell.page.locator('.scope-marker[data-kind="alarm"]:visible').waitFor();
    await until('its values are there', async () => (await cell.page.locator('tr[data-row="y.state"] [data-value="newest"]').textContent()) === 'ErrorStop');
    await cell.settled();
    const file = table(await scope.exported());
    assert.equal(file.rows, Number(about['to']) - Number(about['from']));
    assert.equal(await scope.as_the_machine(file, name), file.rows);
    // One click back to what runs.
    await cell.page.locator('.scope-back').click();
    await until('it is live again', async () => cell.page.locator('[data-do="freeze"]').isVisible());
    await cell.machine.ask({ cmd: 'reset' });
});

test('the browser had nothing to complain about', () => assert.deepEqual(cell.complaints, []));
