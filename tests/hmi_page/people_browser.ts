// Several people at one machine: two pages, who takes over from whom, what a role may not do.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { Page } from 'playwright-core';
import { Cell, until } from './cell';

const cell = new Cell();
before(() => cell.start(), { timeout: 120_000 });
after(() => cell.end());

const ready = async (page: Page, selector: string): Promise<void> => until(`${selector} may be pressed`, () => page.locator(selector).isEnabled());
const refusal = (page: Page) => page.locator('.notice[data-kind="refused"]');

test('while one jogs another may look, not jog nor move; stop is everybody\'s', { timeout: 180_000 }, async () => {
    await cell.powered_and_homed('x');
    await cell.look('#axis/x');
    const second = await cell.another('#axis/x');
    try {
        const box = await cell.page.locator('[data-jog="+"]').boundingBox();
        assert.ok(box);
        const jogs = async (): Promise<boolean> => (await cell.axis('x')).set_velocity > 19;
        for (let left = 6; ; left--) {  // a page that stands still for 200 ms on a busy computer lets go: then nobody jogs who could be disturbed
            await ready(cell.page, '[data-jog="+"]');
            await cell.page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
            await cell.page.mouse.down();
            await until('x moves', jogs, 3000).catch(() => undefined);
            if (await jogs()) {
                await second.locator('[data-input="to"]').fill('1');
                await second.locator('[data-cmd="move"]').click({ timeout: 2000 }).catch(() => undefined);
                await refusal(second).waitFor({ timeout: 1500 }).catch(() => undefined);
                if ((await refusal(second).count()) > 0 && (await jogs())) break;
            }
            await cell.page.mouse.up();
            await cell.machine.ask({ cmd: 'stop', axis: 'x' });
            await cell.stands('x', 3000);
            assert.ok(left > 0, 'it was let go each time');
        }
        assert.match((await second.locator('[data-value="state"]').textContent()) ?? '', /▶/, 'the other does not see that it moves');
        await second.locator('[data-do="stop"]').dispatchEvent('pointerdown', { pointerId: 3 });
        await cell.stands('x', 2000);
        await cell.page.mouse.up();
    } finally {
        await second.context().close();
    }
});

test('control is handed back and taken by the other, and both see who has it', { timeout: 60_000 }, async () => {
    await cell.look('#axis/x');
    const second = await cell.another('#axis/x');
    try {
        const owner = (page: Page) => page.locator('[data-value="owner"]').textContent();
        const control = (page: Page) => page.locator('.wide button').nth(3);
        if ((await cell.axis('x')).owner !== 'operator') {
            await control(cell.page).click();
            await until('the operator has it', async () => (await cell.axis('x')).owner === 'operator');
        }
        await until('both see it', async () => (await owner(cell.page)) === 'operator' && (await owner(second)) === 'operator');
        await second.locator('[data-input="to"]').fill('30');
        await ready(second, '[data-cmd="move"]');
        await second.locator('[data-cmd="move"]').click();
        await until('the second one moves it', async () => Math.abs((await cell.axis('x')).actual_position - 30) < 0.01);
    } finally {
        await second.context().close();
    }
});

test('what a role may not do is grey and says why; stop stays', { timeout: 90_000 }, async () => {
    await cell.serve_as('viewer');
    await cell.look('#axis/x');
    await until('the role is told', async () => ((await cell.page.locator('[data-do="account"]').textContent()) ?? '').includes('viewer'));
    for (const selector of ['[data-cmd="enable"], [data-cmd="disable"]', '[data-jog="+"]', '[data-jog="−−"]', '[data-cmd="move"]', '[data-cmd="reset"]', '[data-mode="automatic"]'])
        for (const button of await cell.page.locator(selector).all()) {
            assert.ok(await button.isDisabled(), selector);
            assert.match((await button.getAttribute('data-reason')) ?? '', /viewer/, selector);
        }
    assert.ok(await cell.page.locator('[data-do="stop"]').isEnabled());
    const box = await cell.page.locator('[data-cmd="reset"]').first().boundingBox();
    assert.ok(box);
    await cell.page.mouse.click(box.x + 5, box.y + 5);
    assert.match((await cell.page.locator('.notice').textContent()) ?? '', /Your role \(viewer\)/);

    await cell.serve_as('operator');
    await cell.look('#axis/x');
    await ready(cell.page, '[data-jog="+"]');
    await cell.page.locator('[data-page="io"]').click();
    await cell.page.locator('[data-output-point="gripper"] [data-set="1"]').waitFor();
    assert.ok(await cell.page.locator('[data-output-point="gripper"] [data-set="1"]').isDisabled());

    await cell.serve_as('engineer');
    await cell.look('#io');
    await cell.page.locator('[data-output-point="gripper"] [data-set="1"]').click();
    await until('the output is on', async () => ((await cell.machine.state())['outputs'] as Record<string, number>)['gripper'] === 1);
    await cell.page.close();
    await until('it is safe again when the page goes', async () => ((await cell.machine.state())['outputs'] as Record<string, number>)['gripper'] === 0);
});
