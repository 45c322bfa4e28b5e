// A hand on the page: what is pressed happens, and every ending of a jog ends it.
import assert from 'node:assert/strict';
import { after, before, beforeEach, test } from 'node:test';
import { Cell, pause, until } from './cell';
import { newest, recorded } from './recorded';

const cell = new Cell();
before(() => cell.start(), { timeout: 120_000 });
after(() => cell.end());
beforeEach(() => cell.line.flow());

const jog = (sign: string) => cell.page.locator(`[data-jog="${sign}"]`);
// ms: what two busy cores are late before a test looks.
const patience = 1500;
// Cycles of 1 ms from the ending to standstill: the lease (250 ms), the ramp from 20 mm/s at 5000 mm/s2 and 100 m/s3 (under 50 ms), and how long the
// ending itself may take from this process to the browser, or the machine's word of its newest cycle to this process.
const lease = 250, ramp = 50, on_the_way = 150;

/** A page that stands still for 200 ms on a busy computer lets go: then it is pressed again, a few times. */
async function hold_x(): Promise<void> {
    for (let left = 4; ; left--) {
        await cell.look('#axis/x');
        await jog('+').waitFor();
        await until('the button may be pressed', () => jog('+').isEnabled());
        const box = await jog('+').boundingBox();
        assert.ok(box);
        await cell.page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
        await cell.page.mouse.down();
        try {
            await until('x moves', async () => (await cell.axis('x')).set_velocity > 19, 3000);
            return;
        } catch (why) {
            if (left === 0) throw why;
            await cell.page.mouse.up();
            await cell.stands('x', patience);
        }
    }
}
async function no_more_motion(): Promise<void> {
    await cell.stands('x', patience);
    const before = (await cell.axis('x')).set_position;
    await pause(400);
    assert.equal((await cell.axis('x')).set_position, before, 'it began again by itself');
}

test('by keyboard alone: power, home, jog, move, stop', { timeout: 90_000 }, async () => {
    await cell.look('#axis/x');
    const press = async (selector: string, key = 'Enter') => {
        const wanted = cell.page.locator(selector);
        await until(`${selector} may be pressed`, () => wanted.isEnabled());
        for (let i = 0; i < 60; i++) {
            if (await wanted.evaluate((element) => element === document.activeElement)) break;
            await cell.page.keyboard.press('Tab');
        }
        assert.ok(await wanted.evaluate((element) => element === document.activeElement), `${selector} is not reached by Tab`);
        if (key) await cell.page.keyboard.press(key);
    };
    await press('[data-cmd="enable"]');
    await until('power', async () => (await cell.axis('x')).powered);
    await press('[data-cmd="home"]');
    await until('homed', async () => (await cell.axis('x')).homed && (await cell.axis('x')).state === 'Standstill', 40_000);

    await press('[data-jog="+"]', '');
    await cell.page.keyboard.down(' ');
    await until('x moves', async () => (await cell.axis('x')).set_velocity > 19);
    await cell.page.keyboard.up(' ');
    await no_more_motion();

    await press('[data-input="to"]', '');
    await cell.page.keyboard.type('40');
    await cell.page.keyboard.press('Enter');
    await until('x is at 40 mm', async () => Math.abs((await cell.axis('x')).actual_position - 40) < 0.01);

    await press('[data-input="to"]', '');
    await cell.page.keyboard.press('Control+a');
    await cell.page.keyboard.type('300');
    await cell.page.keyboard.press('Enter');
    await until('x moves', async () => (await cell.axis('x')).set_velocity > 15);
    await press('[data-do="stop"]');
    await cell.stands('x', 3000);
    assert.ok((await cell.axis('x')).actual_position < 290);
});

test('held, and nothing happens: it goes on, in every cycle', { timeout: 90_000 }, async () => {
    await cell.powered_and_homed('x');
    for (let left = 6; left > 0; left--) {
        await hold_x();
        const from = await newest(cell.machine);
        await pause(1000);
        const velocity = await recorded(cell.machine, 'x.set_velocity', from, await newest(cell.machine));
        await cell.page.mouse.up();
        await no_more_motion();
        if (velocity.length > 500 && velocity.every((v) => v > 19)) return;
    }
    assert.fail('it stopped by itself each time: no ending below shows anything');
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
    ['a page that stands still', () => cell.page.evaluate(() => { setTimeout(() => { const end = Date.now() + 1200; while (Date.now() < end); }, 0); })],
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
    const pressed = presses(), before = await newest(cell.machine);
    try {
        await happens();
        const ended = await newest(cell.machine);
        await no_more_motion();
        const velocity = await recorded(cell.machine, 'x.set_velocity', before, await newest(cell.machine));
        if ((velocity[0] ?? 0) <= 19) return false;
        const stood = velocity.findIndex((v) => v === 0);
        assert.ok(stood > 0 && stood + before <= ended + lease + ramp + on_the_way, `it stood ${stood + before - ended} cycles after the ending`);
        assert.ok(velocity.slice(stood).every((v) => v === 0), 'it moved again');
    } finally {
        await afterwards?.();
    }
    const recovered = await newest(cell.machine);
    await no_more_motion();  // what comes late begins nothing
    assert.ok((await recorded(cell.machine, 'x.set_velocity', recovered, await newest(cell.machine))).every((v) => v === 0), 'it moved when all was well again');
    assert.equal(presses(), pressed, 'it pressed anew');
    return true;
}
for (const [name, happens, afterwards] of endings)
    test(`a jog ends by: ${name}`, { timeout: 90_000 }, async () => {
        await cell.powered_and_homed('x');
        for (let left = 3; left > 0; left--) if (await ends(happens, afterwards)) return;
        assert.fail('it never moved when the ending came');
    });
