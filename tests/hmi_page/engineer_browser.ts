// What an engineer changes: forced points that nobody can overlook, parameters of a drive, the override.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { Cell, unhurried, until } from './cell';
import { Json } from './machine';

const cell = new Cell();
before(() => cell.start({ machine: unhurried }), { timeout: 120_000 });
after(() => cell.end());

const forced = async (): Promise<Json[]> => ((await cell.machine.state())['forced'] ?? []) as Json[];
const input = async (name: string): Promise<number> => ((await cell.machine.state())['inputs'] as Record<string, number>)[name] ?? NaN;
const places = ['overview', 'axis/x', 'axis/x/drive', 'scope', 'alarms', 'alarms/history', 'io', 'programs', 'bus', 'system'];

test('a forced point is marked on every page, for everybody; it ends by hand and with the page', { timeout: 240_000 }, async () => {
    await cell.look('#io');
    const row = cell.page.locator('[data-input-point="part_present"]');
    await row.waitFor();
    assert.equal(await input('part_present'), 1);
    assert.equal(await row.locator('[data-set="0"]').isVisible(), false, 'an input has buttons although nothing is forced');
    await cell.page.locator('[data-do="forcing"]').check();
    await cell.insist('it is forced', () => row.locator('[data-set="0"]').click(), async () => (await input('part_present')) === 0 && (await forced()).length === 1);
    await cell.insist('both are', () => cell.page.locator('[data-output-point="buzzer"] [data-set="1"]').click(), async () => (await forced()).length === 2);

    const other = await cell.another('#overview');
    for (const page of [cell.page, other])
        for (const place of places) {
            await page.evaluate((hash) => { location.hash = hash; }, place);
            const banner = page.locator('.banner.forced');
            await banner.waitFor();
            const text = (await banner.textContent()) ?? '';
            assert.ok(text.includes('2') && text.includes('part_present') && text.includes('buzzer'), `${place}: ${text}`);
        }
    await cell.page.evaluate(() => { location.hash = 'io'; });
    await row.locator('.badge').waitFor();
    assert.match((await row.locator('.badge').textContent()) ?? '', /FORCED/);

    await cell.insist('both are released by whoever comes by', () => other.locator('.banner.forced button').click({ timeout: 2000 }).catch(() => undefined), async () => (await forced()).length === 0 && (await input('part_present')) === 1, other);
    await cell.page.locator('.banner.forced').waitFor({ state: 'hidden' });

    await cell.page.locator('[data-do="forcing"]').check();
    await cell.insist('it is forced again', () => row.locator('[data-set="0"]').click(), async () => (await forced()).length === 1);
    await cell.page.close();
    await until('it ends with the page', async () => (await forced()).length === 0 && (await input('part_present')) === 1);
    await other.context().close();
});

test('what the emergency stop reads nobody may force, and the button says so', { timeout: 180_000 }, async () => {
    await cell.look('#io');
    await cell.page.locator('[data-do="forcing"]').check();
    const button = cell.page.locator('[data-input-point="estop_ok"] [data-set="0"]');
    await button.waitFor();
    assert.ok(await button.isDisabled());
    assert.match((await button.getAttribute('data-reason')) ?? '', /^Nobody may force it: ./);
    assert.ok(await cell.page.locator('[data-input-point="part_present"] [data-set="0"]').isEnabled());
});

test('the override is set by its handle and by keys, and another page shows it', { timeout: 180_000 }, async () => {
    await cell.look('#axis/x');
    const other = await cell.another('#axis/x');
    const slider = cell.page.locator('[data-input="override"]');
    const override = async (): Promise<number> => Number(((await cell.machine.state())['axes'] as Json[])[0]?.['operators_override']);
    await until('it may be set', () => slider.isEnabled());
    assert.equal(await override(), 1);
    await slider.focus();
    for (let i = 0; i < 4; i++) await cell.page.keyboard.press('ArrowLeft');
    await cell.insist('95 %', async () => {
        await cell.page.keyboard.press('ArrowLeft');
        for (let back = Number(await slider.inputValue()); back < 95; back++) await cell.page.keyboard.press('ArrowRight');
    }, async () => Math.abs((await override()) - 0.95) < 1e-9);
    await cell.insist('0 %', async () => {
        await cell.page.keyboard.press('ArrowRight');
        await cell.page.keyboard.press('Home');
    }, async () => (await override()) === 0);
    await until('the other shows it', async () => (await other.locator('[data-value="operators_override"]').textContent()) === '0 %');
    await cell.insist('100 %', async () => {
        await cell.page.keyboard.press('ArrowLeft');
        await cell.page.keyboard.press('End');
    }, async () => (await override()) === 1);
    await other.context().close();
});

test('parameters of a drive: filtered, read, compared with the factory, written only when confirmed', { timeout: 240_000 }, async () => {
    await cell.look('#axis/x/drive');
    const rows = cell.page.locator('.parameters tbody tr');
    await until('the list is there', async () => (await rows.count()) > 20);
    const all = await rows.count();
    await cell.page.locator('[data-input="filter"]').fill('6065h');
    await until('the filter leaves few', async () => (await rows.count()) >= 1 && (await rows.count()) < Math.min(all, 5));
    const row = rows.first(), name = (await row.getAttribute('data-parameter')) ?? '';
    const there = async (): Promise<string> => String((await cell.told({ cmd: 'drive_read', axis: 'x', parameter: name }))['shown']);
    const before = await there();
    await cell.insist('it is read', () => row.locator('[data-cmd="drive_read"]').click(), async () => (await row.locator('[data-value="value"]').textContent()) === before);

    // The machine file's start-up list sets 6065h to 393216; the factory's value is another.
    await cell.page.locator('[data-input="compare"]').selectOption('compare_factory');
    await until('it differs from the factory', async () => (await row.getAttribute('data-differs')) !== null && ((await row.textContent()) ?? '').includes('≠'));

    const ask = row.locator('[data-cmd="drive_write"]');
    await until('it may be written', () => ask.isEnabled());
    const unit = before.replace(/^[-\d.]+/, '');
    const write = async (value: string, confirm: boolean): Promise<void> => {
        await ask.click();
        await cell.page.locator('dialog[open] [data-input="value"]').fill(value);
        if (confirm) await cell.page.locator('dialog[open] [data-do="confirm"]').click();
        else await cell.page.keyboard.press('Escape');
        await cell.page.locator('dialog[open]').waitFor({ state: 'detached' }).catch(() => undefined);
    };
    await write(`200000${unit}`, false);
    assert.equal(await there(), before, 'it was written without being confirmed');
    assert.ok(cell.sent.some((message) => message['cmd'] === 'drive_read') && !cell.sent.some((message) => message['cmd'] === 'drive_write'), 'it was sent without being confirmed');
    await cell.insist('it is written', () => write(`200000${unit}`, true), async () => (await there()).startsWith('200000'));
    await until('it is shown', async () => ((await row.locator('[data-value="value"]').textContent()) ?? '').startsWith('200000'));
});

test('a parameter of a program is set within its range and refused beyond it', { timeout: 180_000 }, async () => {
    await cell.look('#programs');
    const row = cell.page.locator('[data-parameter="pick_and_place.speed"]');
    await cell.insist('it is set', async () => {
        await row.locator('input').fill('250');
        await row.locator('button').click();
    }, async () => (await row.locator('[data-value="value"]').textContent()) === '250');
    await cell.insist('its range ends at 600', async () => {
        await row.locator('input').fill('601');
        await row.locator('button').click();
    }, async () => (await cell.notice()).includes('601'));
    assert.equal(await row.locator('[data-value="value"]').textContent(), '250');
});

test('the watch table keeps what was chosen', { timeout: 180_000 }, async () => {
    await cell.look('#programs');
    const rows = cell.page.locator('.watch tbody tr');
    await until('variables are there', async () => (await rows.count()) >= 2);
    await cell.page.locator('[data-do="choose"]').click();
    await cell.page.locator('[data-variable="pick_and_place.pieces"] input').check();
    await cell.page.locator('[data-do="choose"]').click();
    await until('it stands alone', async () => (await rows.count()) === 1);
    await cell.page.reload();
    await cell.page.locator('body:not([data-stale]) .page').waitFor();
    await until('and still does', async () => (await rows.count()) === 1 && (await rows.first().getAttribute('data-variable')) === 'pick_and_place.pieces');
});

test('the bus is drawn in the order of its cable', { timeout: 180_000 }, async () => {
    await cell.look('#bus');
    await until('four slaves', async () => (await cell.page.locator('.tree .slave').count()) === 4);
    const names = await cell.page.locator('.tree .slave').evaluateAll((list) => list.map((slave) => slave.getAttribute('data-slave')));
    assert.deepEqual(names, ['x_drive', 'y_drive', 'z_drive', 'io']);
    await until('ports are known', async () => (await cell.page.locator('[data-slave="x_drive"] .port').count()) === 4);
    const linked = (name: string) => cell.page.locator(`[data-slave="${name}"] .port[data-kind="l"]`).count();
    assert.equal(await linked('x_drive'), 2);  // in and on
    assert.equal(await linked('io'), 1);       // the end of the line
    await cell.page.locator('[data-slave="y_drive"]').click();
    await until('its ports are told', async () => (await cell.page.locator('[data-part="slave"] tbody tr').count()) === 4);
    assert.match((await cell.page.locator('[data-part="slave"]').textContent()) ?? '', /x_drive/);
});

test('an emergency stop that was released leaves its words until somebody resets', { timeout: 180_000 }, async () => {
    await cell.insist('x has power', async () => {
        await cell.machine.ask({ cmd: 'reset' });
        await cell.machine.ask({ cmd: 'enable', axis: 'x' });
    }, async () => (await cell.axis('x')).powered);
    await cell.machine.ask({ cmd: 'simulate', line: 'input estop_ok 0' });
    await until('x is stopped', async () => (await cell.axis('x')).state === 'ErrorStop');
    await cell.machine.ask({ cmd: 'simulate', line: 'input estop_ok 1' });
    await until('it is released', async () => !(await cell.machine.state())['emergency_stop']);
    await cell.look('#axis/x');
    await until('why, and what to do', async () => /emergency stop was pressed[^]*release the emergency stop/.test((await cell.page.locator('[data-value="why"]').textContent()) ?? ''));
    assert.match((await cell.page.locator('.strip').textContent()) ?? '', /Emergency stop.*not acknowledged/);
    assert.equal(await cell.page.locator('[data-value="error"]').textContent(), 'emergency_stop');
    await cell.machine.ask({ cmd: 'reset' });
});

test('of a drive that is cut off nothing old is shown as if it were of now', { timeout: 180_000 }, async () => {
    await cell.look('#axis/y');
    const old = cell.page.locator('[data-value="last_known"]');
    assert.ok(await old.isHidden());
    assert.notEqual(await cell.page.locator('[data-value="drive_state"]').textContent(), '–');
    await cell.machine.ask({ cmd: 'simulate', line: 'unplug y_drive' });
    await old.waitFor();
    for (const value of ['head_actual_velocity', 'head_following_error', 'actual_torque', 'drive_state']) assert.equal(await cell.page.locator(`[data-value="${value}"]`).textContent(), '–', value);
    // The input of the emergency stop is behind the same cable: nobody pressed it.
    await until('nobody pressed the emergency stop', async () => /cannot be read/.test((await cell.page.locator('.banner.emergency').textContent()) ?? ''));
    await until('why', async () => /cannot be read[^]*does not answer/.test((await cell.page.locator('[data-value="why"]').textContent()) ?? ''));
    await cell.look('#axis/y/drive');
    await until('no bit of its status word is lit', async () => (await cell.page.locator('.bits [data-tone="good"], .bits [data-tone="bad"]').count()) === 0);
    assert.equal(await cell.page.locator('[data-value="status_word"]').textContent(), '–');
    await cell.look('#overview');
    await until('the overview marks it', async () => /⚠/.test((await cell.page.locator('tr[data-axis="y"] [data-value="position"]').textContent()) ?? ''));
    assert.doesNotMatch((await cell.page.locator('tr[data-axis="x"] [data-value="position"]').textContent()) ?? '', /⚠/);
    await cell.machine.ask({ cmd: 'simulate', line: 'plug y_drive' });
});
