// Measuring in the browser: the path is told before, the axis moves while the button is held, the numbers are the machine's.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { Cell, until } from './cell';
import { Json } from './machine';
import { newest, recorded } from './recorded';

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
/** A page that stands still on a busy computer lets go by itself and says so: then it is held again. */
async function measured(): Promise<void> {
    for (;;) {
        const run = (await state())?.run ?? 0;
        await cell.hush();
        await cell.press_down(hold());
        await until('it has ended', async () => (((await state())?.run ?? 0) > run && (await state())?.running === false) || (await cell.notice()) !== '');
        await cell.page.mouse.up();
        await until('it ends', async () => (await state())?.running !== true);
        if (((await state())?.run ?? 0) > run && (await state())?.end === 'done') return;
        assert.notEqual(await cell.notice(), '', 'it ended without a word');
        await until('the button may be pressed', () => hold().isEnabled());
    }
}

test('a step response: held to its end, the page shows what the machine says', { timeout: 240_000 }, async () => {
    await choose('step', { distance: '10', velocity: '20', count: '1' });
    await measured();
    const result = (await cell.told({ cmd: 'measure_result', axis: 'x' }))['measure_result'] as Json;
    assert.equal(result['end'], 'done');
    const error = (result['largest_error'] as { value: number }).value;
    const shown = cell.page.locator('[data-value="measure_result"]');
    await until('the result is shown', async () => ((await shown.textContent()) ?? '').includes(String(Number(error.toPrecision(4)))));
    await until('its plots are drawn', async () => (await shown.locator('canvas').count()) === 3);
});

test('let go, the axis stops, and the page says so', { timeout: 180_000 }, async () => {
    await choose('ramp', { distance: '30', velocity: '10', count: '3' });
    // As a jog's (jog_browser.ts): the oldest renewal that is taken, its lease, and the ramp from 10 mm/s; in cycles of 4 ms.
    const most = (250 + 200 + 50) / 4;
    for (;;) {
        await until('the button may be pressed', () => hold().isEnabled());
        await cell.hush();
        await cell.press_down(hold());
        await until('the axis moves, or the page says why not', async () => Math.abs((await cell.axis('x')).set_velocity) > 5 || (await cell.notice()) !== '');
        const before = await newest(cell.machine);
        await cell.page.mouse.up();
        const ended = await cell.cycle_from_now();
        await until('the axis stands', async () => (await cell.axis('x')).set_velocity === 0 && (await state())?.running !== true);
        await cell.passes(500);
        const velocity = await recorded(cell.machine, 'x.set_velocity', before, await newest(cell.machine));
        if (Math.abs(velocity[0] ?? 0) <= 5) continue;  // it had let go by itself
        const stood = velocity.indexOf(0);
        assert.ok(stood > 0 && before + stood <= ended + most, `it stood ${before + stood - ended} cycles behind`);
        assert.ok(velocity.slice(stood).every((v) => v === 0), 'it went on');
        assert.equal((await state())?.end, 'stopped');
        return;
    }
});

test('what is no number is not measured as if nothing were typed', { timeout: 180_000 }, async () => {
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

test('a path beyond a software limit is refused in words and cannot be pressed', { timeout: 180_000 }, async () => {
    await cell.look('#measure/x');
    await cell.page.locator('[data-input="distance"]').fill('100000');
    await until('the refusal', async () => ((await cell.page.locator('[data-value="measure_path"]').textContent()) ?? '').includes('software limit'));
    await until('the button is grey', () => hold().isDisabled());
});
