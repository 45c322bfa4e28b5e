// A person looks at a SCARA that draws, and holds it back: what is shown is so, and what is pressed happens.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { Cell, patience, pause, until } from './cell';
import { Json } from './machine';
import { recorded } from './recorded';

const cell = new Cell();
before(() => cell.start({ file: 'scara.yaml', machine: (yaml) => yaml }), { timeout: 120_000 });
after(() => cell.end());

const arm = async (): Promise<Json> => ((await cell.machine.state())['groups'] as Json[])[0] as Json;
const moves = async (): Promise<boolean> => (await arm())['state'] === 'GroupMoving' && Number((await arm())['tool_speed']) > 20;
const shown = (name: string): Promise<string> => cell.page.locator(`[data-value="${name}"]`).innerText();

test('the tool on the screen is where the machine has recorded it in the same cycle', { timeout: 180_000 }, async () => {
    await until('it draws', moves);
    await cell.look('#group/arm');
    const signals: [string, string][] = [['tool_set_X', 'tool_x'], ['tool_set_Y', 'tool_y'], ['tool_actual_X', 'tool_actual_x'], ['tool_actual_Y', 'tool_actual_y']];
    const seen = new Set<string>();
    for (const end = Date.now() + patience; seen.size < 8 && Date.now() < end; await pause(50)) {
        const [cycle, said] = await cell.page.evaluate((names) => [Number(document.body.dataset['cycle']), names.map((name) => document.querySelector(`[data-value="${name}"]`)?.textContent ?? '')] as const, signals.map(([name]) => name));
        for (const [i, [name, signal]] of signals.entries()) {
            const [value] = await recorded(cell.machine, `group.arm.${signal}`, cycle, cycle + 1);
            assert.equal(said[i]?.replace('−', '-'), value?.toFixed(3).replace(/^-(0\.?0*)$/, '$1'), `${name} of cycle ${cycle}`);
        }
        seen.add(said[0] ?? '');
    }
    assert.ok(seen.size >= 8, `only ${seen.size} looks met it moving`);
    assert.match(await shown('group_state'), /Moving/);
    assert.match(await shown('command'), /MC_Move(Linear|Circular)Absolute/);
});

test('its path is drawn: lines and half circles, from above and from the front', { timeout: 180_000 }, async () => {
    const way = cell.page.locator('[data-plane="XY"] .way');
    await until('some seconds are drawn', async () => ((await way.getAttribute('d')) ?? '').length > 1500);
    // 40 mm wide and 160 high: the slot of the program, to one scale, once the way to it has run out of the picture.
    await until('the slot is what is drawn', async () => {
        const box = await way.boundingBox();
        return box !== null && Math.abs(box.height / box.width - 4) < 0.2;
    });
    const front = await cell.page.locator('[data-plane="XZ"] .way').boundingBox();
    assert.ok(front && front.height < 3, 'it stays on one height');
});

test('a viewer may stop it and nothing else', { timeout: 240_000 }, async () => {
    await cell.serve_as('viewer');
    await cell.look('#group/arm');
    for (const cmd of ['group_interrupt', 'group_continue', 'group_reset', 'group_enable', 'group_disable']) assert.ok(await cell.page.locator(`main [data-cmd="${cmd}"]`).isDisabled(), cmd);
    assert.ok(await cell.page.locator('[data-input="group_override"]').isDisabled());
    assert.ok(await cell.page.locator('main [data-cmd="group_halt"]').isEnabled());
    await cell.serve_as('operator');
    await cell.look('#group/arm');
});

test('an operator interrupts it on its path and lets it go on', { timeout: 240_000 }, async () => {
    await until('it draws', moves);
    const interrupt = cell.page.locator('main [data-cmd="group_interrupt"]'), go_on = cell.page.locator('main [data-cmd="group_continue"]');
    assert.ok(await go_on.isDisabled(), 'nobody has interrupted it');
    await cell.insist('it stands', () => interrupt.click(), async () => (await arm())['held'] === true && Number((await arm())['tool_speed']) === 0);
    await until('the page says so', async () => /Interrupted by hand/.test(await shown('group_note')));
    const at = (await arm())['tool_set'];
    await cell.passes(500);
    assert.deepEqual((await arm())['tool_set'], at);
    await until('it may go on', () => go_on.isEnabled());
    await cell.insist('it goes on', () => go_on.click(), async () => (await arm())['interrupted'] === false);
    await until('it draws', moves);
});

test('the override slows the tool down', { timeout: 240_000 }, async () => {
    const slider = cell.page.locator('[data-input="group_override"]');
    await cell.insist('30 %', () => slider.fill('30'), async () => (await arm())['operators_override'] === 0.3);
    await until('the page says what holds it back', async () => /override/.test(await shown('group_limited')));
    await cell.passes(1000);
    for (let i = 0; i < 20; i++) {
        assert.ok(Number((await arm())['tool_speed']) < 60.1, 'mm/s: 30 % of 200');
        await pause(30);
    }
    await cell.insist('100 %', () => slider.fill('100'), async () => (await arm())['operators_override'] === 1);
});

test('who is at its limit is marked, and why it stopped is said in Chinese, too', { timeout: 240_000 }, async () => {
    await cell.told({ cmd: 'set_parameter', parameter: 'speed', value: 500 });
    await until('an axis holds it back', async () => (await cell.page.locator('tr[data-limiting]').count()) > 0);
    await cell.told({ cmd: 'simulate', line: 'drive-fault elbow 0x2310' });
    await until('it stops', async () => (await arm())['state'] === 'GroupErrorStop');
    await cell.look('#group/arm', { language: 'zh' });
    await until('the reasons stand there', async () => (await cell.page.locator('[data-value="group_why"] li').count()) > 1);
    for (const reason of await cell.page.locator('[data-value="group_why"] li').allInnerTexts()) assert.match(reason, /[\u4e00-\u9fff]/, reason);
    assert.match(await shown('group_state'), /故障/);
    assert.deepEqual(cell.complaints, []);
});
