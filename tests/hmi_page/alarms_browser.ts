// An alarm that stops something: it stands on top, in both languages, with what was recorded around it; afterwards it is in the history.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { Cell, unhurried, until } from './cell';

const cell = new Cell();
before(() => cell.start({ machine: unhurried }), { timeout: 120_000 });
after(() => cell.end());

test('it stands on every page and in both languages, with cause and remedy', { timeout: 180_000 }, async () => {
    await cell.powered_and_homed('y');
    await cell.told({ cmd: 'move', axis: 'y', position: 200, velocity: 40 });
    await cell.look('#overview');
    assert.ok(await cell.page.locator('.strip').isHidden());
    await cell.told({ cmd: 'simulate', line: 'drive-fault y 0x3130' });
    await cell.page.locator('.strip').waitFor();
    assert.match((await cell.page.locator('.strip').textContent()) ?? '', /axis y: .*3130h/);
    await cell.page.locator('.strip').click();
    const card = cell.page.locator('[data-alarm="drive_fault"]');
    await card.waitFor();
    const state = (await cell.machine.state())['alarms'] as { name: string; english: string; chinese: string; cause: string; remedy: string }[];
    const alarm = state.find((a) => a.name === 'drive_fault');
    assert.ok(alarm);
    const text = (await card.textContent()) ?? '';
    for (const part of [alarm.english, alarm.cause, alarm.remedy]) assert.ok(part !== '' && text.includes(part), part);
    await cell.page.locator('[data-do="language"]').click();
    await until('Chinese', async () => ((await card.textContent()) ?? '').includes(alarm.chinese));
    assert.notEqual(alarm.chinese, alarm.english);
    // Cause, remedy and reset, too; and the move that the fault ended.
    const left = await cell.page.locator('.page.alarms dd:not(:last-of-type), .page.alarms .event > span:last-of-type, .page.alarms .event small').evaluateAll((cells) => cells.map((one) => one.textContent ?? '').filter((text) => !/[\u4e00-\u9fff]/.test(text)));
    assert.deepEqual(left, []);
    assert.ok(((await cell.page.locator('.page.alarms').textContent()) ?? '').includes('电网缺一相'));
});

test('one click opens what was recorded around it', { timeout: 180_000 }, async () => {
    await cell.look('#alarms');
    const link = cell.page.locator('[data-alarm="drive_fault"] [data-recording]');
    await link.waitFor();
    const name = (await link.getAttribute('data-recording')) ?? '';
    await until('it is whole', async () => ((await cell.told({ cmd: 'recordings' }))['recordings'] as { name: string; complete: boolean }[]).some((r) => r.name === name && r.complete));
    await link.click();
    assert.ok((await cell.page.evaluate(() => location.hash)).startsWith('#scope/recording/'));
    await cell.page.locator('.page.scope canvas').first().waitFor();
});

test('its file is saved as it lies on the machine\'s disk', { timeout: 180_000 }, async () => {
    await cell.look('#system');
    const save = cell.page.locator('[data-do="copy_recording"]').first();
    await until('it may be saved', () => save.isEnabled());
    const kept = cell.page.waitForEvent('download');
    await save.click();
    const download = await kept, name = download.suggestedFilename();
    assert.match(name, /^demo-.*\.twscope$/);
    const on_disk = readFileSync(join(cell.folder, 'recordings', name));
    assert.ok(on_disk.length > 0);
    assert.ok(readFileSync(await download.path()).equals(on_disk));
});

test('afterwards it is in the history: found by its text and place, handed out as CSV', { timeout: 180_000 }, async () => {
    await cell.look('#alarms/history');
    const rows = cell.page.locator('[data-past-alarm]');
    await cell.page.locator('[data-past-alarm="drive_fault"]').waitFor();
    await cell.page.locator('[data-input="text"]').fill('no alarm says this');
    await until('nothing fits', async () => (await rows.count()) === 0);
    await cell.page.locator('[data-input="text"]').fill('3130h');
    await until('it is found by its text', async () => (await rows.count()) >= 1);
    await cell.page.locator('[data-input="source"]').selectOption('axis x');
    await until('it is not of x', async () => (await rows.count()) === 0);
    await cell.page.locator('[data-input="source"]').selectOption('axis y');
    await until('it is of y', async () => (await rows.count()) >= 1);
    const kept = cell.page.waitForEvent('download');
    await cell.page.locator('[data-do="export"]').click();
    const download = await kept;
    assert.match(download.suggestedFilename(), /^demo-alarms-.*\.csv$/);
    const csv = readFileSync(await download.path(), 'utf8');
    assert.equal(csv.charCodeAt(0), 0xfeff);
    assert.ok(csv.includes('drive_fault') && csv.includes('3130h'));
    assert.equal(csv.trimEnd().split('\r\n').length, 1 + (await rows.count()));
});

test('reset by the page: it stands no more and lasted as long as it stood', { timeout: 180_000 }, async () => {
    await cell.look('#alarms');
    await until('reset may be pressed', () => cell.page.locator('[data-cmd="reset"]').isEnabled());
    await cell.insist('it is gone', () => cell.page.locator('[data-cmd="reset"]').click(), async () => !((await cell.machine.state())['alarms'] as { name: string; standing: boolean }[]).some((a) => a.name === 'drive_fault' && a.standing));
    await cell.look('#alarms/history');
    const row = cell.page.locator('[data-past-alarm="drive_fault"]').first();
    await row.waitFor();
    await until('it says how long', async () => !/standing/.test((await row.textContent()) ?? ''));
});
