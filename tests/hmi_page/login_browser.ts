// People with names: who logs in sees the machine and is known by name and role, who logs out sees it no more, also in another window of that browser.
import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { Cell, patience, pause, quiet, until } from './cell';

const cell = new Cell();
const users = join(cell.folder, 'users.json');
const add = (name: string, role: string, password: string): void => {
    const made = spawnSync(cell.command, ['hmi', 'user', 'add', name, role, '--users', users], { input: password + '\n', encoding: 'utf8' });
    assert.equal(made.status, 0, made.stderr);
};
before(async () => {
    add('anna', 'operator', 'a long horse battery');
    add('otto', 'viewer', 'another staple here');
    await cell.start({ machine: quiet, users });
}, { timeout: 120_000 });
after(() => cell.end());

const account = () => cell.page.locator('[data-do="account"]');
const said = async (): Promise<string> => (await cell.page.locator('dialog [role="alert"]').textContent()) ?? '';
/** Until the server has judged it: when too many tries came at once the page says so, and it is tried again. Empty: who logs in is in. */
async function log_in(user: string, password: string): Promise<string> {
    for (;;) {
        await cell.page.locator('dialog[open] [data-input="user"]').fill(user);
        await cell.page.locator('dialog[open] [data-input="password"]').fill(password);
        await cell.page.locator('dialog[open] [data-do="log_in"]').click();
        await until('it is answered', async () => (await said()) !== '' || (await cell.page.locator('dialog[open]').count()) === 0);
        if (!/too|connection/i.test(await said())) return said();
        await pause(500);
    }
}

test('nothing of the machine is seen before somebody has logged in; a wrong password says no more than that', { timeout: 180_000 }, async () => {
    await cell.page.locator('dialog[open] [data-input="user"]').waitFor({ timeout: patience });
    assert.match((await cell.page.locator('.stale').textContent()) ?? '', /Log in/);
    assert.equal(await cell.page.locator('main .page').count(), 0);
    for (const user of ['anna', 'nobody']) {
        assert.match(await log_in(user, 'wrong'), /wrong/);
        assert.equal(await cell.page.locator('main .page').count(), 0);
    }
});

test('an operator is known by name, runs the machine, and changes nothing of it', { timeout: 180_000 }, async () => {
    assert.equal(await log_in('anna', 'a long horse battery'), '');
    await cell.page.locator('body:not([data-stale]) .page').waitFor({ timeout: patience });
    await until('name and role', async () => (await account().textContent()) === 'anna · operator');
    assert.equal(await cell.page.locator('dialog[open]').count(), 0);
    await cell.page.evaluate(() => { location.hash = 'axis/x'; });
    await until('power may be given', () => cell.page.locator('[data-cmd="enable"]').isEnabled());
    await cell.insist('x has power', () => cell.page.locator('[data-cmd="enable"]').click(), async () => (await cell.axis('x')).powered);
    await cell.page.evaluate(() => { location.hash = 'io'; });
    const set = cell.page.locator('[data-output-point="gripper"] [data-set="1"]');
    await set.waitFor();
    assert.ok(await set.isDisabled());
    assert.match((await set.getAttribute('data-reason')) ?? '', /operator/);
});

test('logged out, nothing is seen any more, in no window', { timeout: 180_000 }, async () => {
    const second = await cell.page.context().newPage();
    await second.goto(cell.address);
    await second.locator('body:not([data-stale]) .page').waitFor({ timeout: patience });
    await cell.page.bringToFront();
    await account().click();
    await cell.page.locator('dialog[open] [data-do="log_out"]').click();
    for (const page of [cell.page, second]) {
        await until('it is asked who comes', async () => /Log in/.test((await page.locator('.stale').textContent()) ?? ''));
        await until('the page is empty', async () => (await page.locator('main .page').count()) === 0);
    }
});

test('a viewer looks', { timeout: 180_000 }, async () => {
    if ((await cell.page.locator('dialog[open]').count()) === 0) await account().click();
    assert.equal(await log_in('otto', 'another staple here'), '');
    await until('name and role', async () => (await account().textContent()) === 'otto · viewer');
    await cell.page.evaluate(() => { location.hash = 'axis/x'; });
    const power = cell.page.locator('[data-cmd="enable"], [data-cmd="disable"]').first();
    await power.waitFor();
    await until('it is grey', () => power.isDisabled());
    await until('it says why', async () => /viewer/.test((await power.getAttribute('data-reason')) ?? ''));
    await until('a stop is his', () => cell.page.locator('[data-do="stop"]').isEnabled());
});
