// Several people at one machine: two pages, who takes over from whom, what a role may not do.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { Page } from 'playwright-core';
import { Cell, until } from './cell';
import { newest, recorded } from './recorded';

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
        const jogs = async (): Promise<boolean> => (await cell.axis('x')).set_velocity > 19;
        await second.locator('[data-input="to"]').fill('1');
        for (;;) {  // a page that stands still for 200 ms on a busy computer lets go and says so: then nobody jogs who could be disturbed
            await ready(cell.page, '[data-jog="+"]');
            await cell.hush();
            await cell.hush(second);
            await cell.press_down(cell.page.locator('[data-jog="+"]'));
            await until('x moves, or the page says why not', async () => (await jogs()) || (await cell.notice()) !== '');
            const from = await newest(cell.machine);
            const over = async (): Promise<boolean> => !(await jogs());
            await until('the other sees that it moves', async () => /▶/.test((await second.locator('[data-value="state"]').textContent()) ?? '') || (await over()));
            await second.locator('[data-cmd="move"]').dispatchEvent('click');
            await until('the other is refused', async () => (await refusal(second).count()) > 0 || (await over()));
            const velocity = await recorded(cell.machine, 'x.set_velocity', from, await newest(cell.machine));
            if ((await cell.notice(second)).includes('jogging') && velocity.every((v) => v > 19)) break;
            assert.notEqual(await cell.notice(), '', 'it was let go without a word');
            await cell.page.mouse.up();
            await cell.told({ cmd: 'stop', axis: 'x' });
            await cell.powered_and_homed('x');
        }
        await second.locator('[data-do="stop"]').dispatchEvent('pointerdown', { pointerId: 3 });
        await cell.stands('x');
        await cell.page.mouse.up();
    } finally {
        await second.context().close();
    }
});

test('control is handed back and taken by the other, and both see who has it', { timeout: 180_000 }, async () => {
    await cell.look('#axis/x');
    const second = await cell.another('#axis/x');
    try {
        const owner = (page: Page) => page.locator('[data-value="owner"]').textContent();
        const control = (page: Page) => page.locator('.wide button').nth(3);
        if ((await cell.axis('x')).owner !== 'operator') {
            await cell.insist('the operator has it', () => control(cell.page).click(), async () => (await cell.axis('x')).owner === 'operator');
        }
        await until('both see it', async () => (await owner(cell.page)) === 'operator' && (await owner(second)) === 'operator');
        await second.locator('[data-input="to"]').fill('30');
        await ready(second, '[data-cmd="move"]');
        await cell.insist('the second one moves it', () => second.locator('[data-cmd="move"]').click(), async () => Math.abs((await cell.axis('x')).actual_position - 30) < 0.01, second);
    } finally {
        await second.context().close();
    }
});

test('what a role may not do is grey and says why; stop stays', { timeout: 180_000 }, async () => {
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
    await cell.insist('the output is on', () => cell.page.locator('[data-output-point="gripper"] [data-set="1"]').click(), async () => ((await cell.machine.state())['outputs'] as Record<string, number>)['gripper'] === 1);
    await cell.page.close();
    await until('it is safe again when the page goes', async () => ((await cell.machine.state())['outputs'] as Record<string, number>)['gripper'] === 0);
});
