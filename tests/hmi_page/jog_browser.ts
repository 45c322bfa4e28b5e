// A hand on the page: what is pressed happens, and every ending of a jog ends it.
import assert from 'node:assert/strict';
import { after, before, beforeEach, test } from 'node:test';
import { Cell, until } from './cell';
import { newest, recorded } from './recorded';

const cell = new Cell();
before(() => cell.start(), { timeout: 120_000 });
after(() => cell.end());
beforeEach(() => cell.line.flow());

const jog = (sign: string) => cell.page.locator(`[data-jog="${sign}"]`);
// The newest cycles by which it stands, counted from one that began behind the ending: a renewal that was sent right before it is taken within 250 ms or not
// at all (`valid_ms` of a jog), its lease is 200 ms (`jog_lease`), the ramp from 20 mm/s at 5000 mm/s2 and 100 m/s3 takes under 50 ms.
const cycle_ms = 4, renewal_age = 250, lease = 200, ramp = 50;
const velocities = async (from: number): Promise<number[]> => recorded(cell.machine, 'x.set_velocity', from, await newest(cell.machine));

/** A page that stands still for 200 ms on a busy computer lets go and says so: then it is pressed again. */
async function hold_x(): Promise<void> {
    for (;;) {
        await cell.look('#axis/x');
        await until('the button may be pressed', () => jog('+').isEnabled());
        await cell.press_down(jog('+'));
        let moves = false;
        await until('x moves, or the page says why not', async () => (moves = (await cell.axis('x')).set_velocity > 19) || (await cell.notice()) !== '');
        if (moves) return;
        await cell.page.mouse.up();
        await cell.powered_and_homed('x');
    }
}
async function no_more_motion(): Promise<void> {
    await cell.stands('x');
    const from = await newest(cell.machine);
    await cell.passes(400);
    assert.ok((await velocities(from)).every((v) => v === 0), 'it began again by itself');
}

test('by keyboard alone: power, home, jog, move, stop', { timeout: 300_000 }, async () => {
    await cell.look('#axis/x');
    const to = async (selector: string): Promise<void> => {
        const wanted = cell.page.locator(selector);
        await until(`${selector} may be pressed`, () => wanted.isEnabled());
        await until(`${selector} is reached by Tab`, async () => {
            if (await wanted.evaluate((element) => element === document.activeElement)) return true;
            await cell.page.keyboard.press('Tab');
            return false;
        });
    };
    const press = (what: string, selector: string, holds: () => Promise<boolean>): Promise<void> => cell.insist(what, async () => {
        await to(selector);
        await cell.page.keyboard.press('Enter');
    }, holds);
    const x = () => cell.axis('x');
    await press('power', '[data-cmd="enable"]', async () => (await x()).powered);
    await press('homing', '[data-cmd="home"]', async () => (await x()).state === 'Homing' || (await x()).homed);
    await until('homed', async () => (await x()).homed && (await x()).state === 'Standstill');

    let from = 0;
    await cell.insist('x moves', async () => {
        await cell.page.keyboard.up(' ');
        await cell.stands('x');
        await to('[data-jog="+"]');
        from = await newest(cell.machine);
        await cell.page.keyboard.down(' ');
    }, async () => (await velocities(from)).some((v) => v > 19));
    await cell.page.keyboard.up(' ');
    await no_more_motion();

    const move_to = (position: string, holds: () => Promise<boolean>): Promise<void> => cell.insist(`to ${position}`, async () => {
        await to('[data-input="to"]');
        await cell.page.keyboard.press('Control+a');
        await cell.page.keyboard.type(position);
        await cell.page.keyboard.press('Enter');
    }, holds);
    await move_to('40', async () => Math.abs((await x()).actual_position - 40) < 0.01);

    // So slow that it is still under way when a busy computer has come to the STOP button.
    await cell.told({ cmd: 'override', axis: 'x', value: 0.1 });
    await move_to('300', async () => (await x()).set_velocity > 1);
    await to('[data-do="stop"]');
    await cell.page.keyboard.press('Enter');
    await cell.stands('x');
    assert.ok((await x()).actual_position < 290);
    await cell.told({ cmd: 'override', axis: 'x', value: 1 });
});

test('held, and nothing happens: it goes on, in every cycle', { timeout: 180_000 }, async () => {
    await cell.powered_and_homed('x');
    for (;;) {
        await hold_x();
        const from = await newest(cell.machine);
        await cell.passes(1000);
        const velocity = await velocities(from), said = await cell.notice();
        await cell.page.mouse.up();
        await no_more_motion();
        if (velocity.length > 800 / cycle_ms && velocity.every((v) => v > 19)) return;
        assert.notEqual(said, '', 'it stopped by itself without a word');
    }
});

const endings: [string, () => Promise<unknown> | void, (() => Promise<void> | void)?][] = [
    ['the button let go', () => cell.page.mouse.up()],
    ['the finger beside the button', () => cell.page.mouse.move(700, 700)],
    ['pointercancel', () => jog('+').evaluate((button) => button.dispatchEvent(new PointerEvent('pointercancel', { pointerId: 1, bubbles: true })))],
    ['the capture lost', () => cell.lose_capture(jog('+'))],
    ['the window\'s blur', () => cell.page.evaluate(() => window.dispatchEvent(new Event('blur')))],
    ['a hidden page', () => cell.page.evaluate(() => {
        Object.defineProperty(document, 'visibilityState', { value: 'hidden', configurable: true });
        document.dispatchEvent(new Event('visibilitychange'));
    })],
    ['a second finger', () => cell.page.touchscreen.tap(700, 300)],
    ['another page of it', () => cell.page.evaluate(() => { location.hash = '#overview'; })],
    ['the STOP button', () => cell.page.locator('[data-do="stop"]').dispatchEvent('pointerdown', { pointerId: 7 })],
    ['a page that stands still', async () => {
        const stands = cell.page.waitForEvent('console', (message) => message.text() === 'it stands');
        await cell.page.evaluate(() => void setTimeout(() => { console.log('it stands'); const end = Date.now() + 1200; while (Date.now() < end); }, 0));
        await stands;
    }],
    ['a frozen renderer', () => assert.ok(cell.signal_renderers('SIGSTOP') > 0), () => void cell.signal_renderers('SIGCONT')],
    ['a page that is closed', () => cell.page.close()],
    ['a network that stalls', () => cell.line.hold(), () => cell.line.flow()],
    ['a connection that ends', () => cell.line.cut()],
    ['a frozen server', () => cell.signal_server('SIGSTOP'), () => cell.signal_server('SIGCONT')],
    ['a killed server', () => cell.signal_server('SIGKILL'), () => cell.serve()],
];
/** False: it let go before the ending came, which says nothing of the ending. */
async function ends(happens: () => Promise<unknown> | void, afterwards?: () => Promise<void> | void): Promise<boolean> {
    await hold_x();
    const presses = () => cell.sent.filter((message) => message['press'] === true).length;
    const before = await newest(cell.machine);
    try {
        await happens();
        const ended = await cell.cycle_from_now();
        await no_more_motion();
        const velocity = await velocities(before);
        if ((velocity[0] ?? 0) <= 19) return false;
        const stood = velocity.findIndex((v) => v === 0);
        assert.ok(stood > 0 && stood + before <= ended + (renewal_age + lease + ramp) / cycle_ms, `it stood ${stood + before - ended} cycles after the ending`);
        assert.ok(velocity.slice(stood).every((v) => v === 0), 'it moved again');
    } finally {
        await afterwards?.();
    }
    await no_more_motion();  // what comes late begins nothing
    assert.ok(presses() <= 1, 'it pressed anew');
    return true;
}
for (const [name, happens, afterwards] of endings)
    test(`a jog ends by: ${name}`, { timeout: 180_000 }, async () => {
        await cell.powered_and_homed('x');
        while (!(await ends(happens, afterwards))) await cell.powered_and_homed('x');
    });
