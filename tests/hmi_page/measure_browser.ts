// Measuring in the browser: the path is told before, the axis moves while the button is held, the numbers are the machine's.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { Cell, pause, until } from './cell';
import { Json } from './machine';

const cell = new Cell();
before(async () => {
    await cell.start();
    await cell.powered_and_homed('x');
}, { timeout: 120_000 });
after(() => cell.end());

const hold = () => cell.page.locator('[data-cmd="measure"]');
const state = async () => (await cell.machine.state())['measure'] as { run: number; running: boolean; end: string } | null;

async function choose(kind: string, numbers: Record<string, string>): Promise<void> {
    await cell.look('#measure/x');
    await cell.page.locator('[data-input="kind"]').selectOption(kind);
    for (const [key, text] of Object.entries(numbers)) await cell.page.locator(`[data-input="${key}"]`).fill(text);
    await until('the path is told', async () => /\d/.test((await cell.page.locator('[data-value="measure_path"]').textContent()) ?? ''));
    await until('the button may be pressed', () => hold().isEnabled());
}
async function press(): Promise<void> {
    const box = await hold().boundingBox();
    assert.ok(box);
    await cell.page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
    await cell.page.mouse.down();
}
/** A page that stands still on a busy computer lets go by itself: then it is held again, a few times. */
async function measured(): Promise<void> {
    for (let left = 4; ; left--) {
        const run = (await state())?.run ?? 0;
        await press();
        await until('it has ended', async () => ((await state())?.run ?? 0) > run && (await state())?.running === false, 30_000);
        await cell.page.mouse.up();
        if ((await state())?.end === 'done' || left === 0) return;
        await until('the button may be pressed', () => hold().isEnabled());
    }
}

test('a step response: held to its end, the page shows what the machine says', { timeout: 120_000 }, async () => {
    await choose('step', { distance: '10', velocity: '20', count: '1' });
    await measured();
    const result = (await cell.machine.ask({ cmd: 'measure_result', axis: 'x' }))['measure_result'] as Json;
    assert.equal(result['end'], 'done');
    const error = (result['largest_error'] as { value: number }).value;
    const shown = cell.page.locator('[data-value="measure_result"]');
    await until('the result is shown', async () => ((await shown.textContent()) ?? '').includes(String(Number(error.toPrecision(4)))));
    await until('its plots are drawn', async () => (await shown.locator('canvas').count()) === 3);
});

test('let go, the axis stops, and the page says so', { timeout: 60_000 }, async () => {
    await choose('ramp', { distance: '30', velocity: '10', count: '3' });
    const run = (await state())?.run ?? 0;
    await press();
    await until('the axis moves', async () => Math.abs((await cell.axis('x')).set_velocity) > 5 || ((await state())?.run ?? 0) > run && (await state())?.running === false);
    await cell.page.mouse.up();
    await until('the axis stands', async () => (await cell.axis('x')).set_velocity === 0 && (await state())?.running === false, 3000);
    assert.equal((await state())?.end === 'done', false);
    const at = (await cell.axis('x')).set_position;
    await pause(500);
    assert.equal((await cell.axis('x')).set_position, at, 'it does not go on');
});

test('what is no number is not measured as if nothing were typed', { timeout: 60_000 }, async () => {
    await cell.look('#measure/x');
    const distance = cell.page.locator('[data-input="distance"]'), path = cell.page.locator('[data-value="measure_path"]');
    await until('there is a path', async () => /mm/.test((await path.textContent()) ?? ''));
    await distance.fill('1o');
    await until('it is told', async () => /"1o"/.test((await path.textContent()) ?? ''));
    assert.equal(await distance.getAttribute('aria-invalid'), 'true');
    await until('and cannot be pressed', () => cell.page.locator('[data-cmd="measure"]').isDisabled());
    await distance.fill('10');
    await until('again a path', async () => (await distance.getAttribute('aria-invalid')) === null && /10/.test((await path.textContent()) ?? ''));
});

test('a path beyond a software limit is refused in words and cannot be pressed', { timeout: 60_000 }, async () => {
    await cell.look('#measure/x');
    await cell.page.locator('[data-input="distance"]').fill('100000');
    await until('the refusal', async () => ((await cell.page.locator('[data-value="measure_path"]').textContent()) ?? '').includes('software limit'));
    await until('the button is grey', () => hold().isDisabled());
});
