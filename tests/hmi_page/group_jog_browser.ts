// A hand on the pad of a group: what is pressed moves, in its frame, and every ending stops it. What moved the machine says, never the page.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { Cell, until } from './cell';
import { Json } from './machine';
import { newest, recorded } from './recorded';

const cell = new Cell();
const joints = ['shoulder', 'elbow', 'lift', 'wrist'];
const by_hand = (yaml: string): string => yaml.replace('start_mode: automatic', 'start_mode: manual');
before(async () => {
    await cell.start({ file: 'scara.yaml', machine: by_hand });
    await ready();
}, { timeout: 180_000 });
after(() => cell.end());

const arm = async (): Promise<Json> => ((await cell.machine.state())['groups'] as Json[])[0] as Json;
const tool = async (): Promise<number[]> => (await arm())['tool_set'] as number[];
const button = (way: string) => cell.page.locator(`[data-group-jog="${way}"]`);
const choose = (what: string, value: string) => cell.page.locator(`[data-input="${what}"]`).selectOption(value);
/** Every cycle since then. */
const velocities = async (axis: string, from: number): Promise<number[]> => recorded(cell.machine, `${axis}.set_velocity`, from, await newest(cell.machine));

async function ready(): Promise<void> {
    for (const joint of joints) await cell.powered_and_homed(joint);
    if ((await arm())['state'] === 'GroupErrorStop') await cell.told({ cmd: 'group_reset', group: 'arm' });
    await until('it is no error any more', async () => (await arm())['state'] !== 'GroupErrorStop');
    if ((await arm())['state'] === 'GroupDisabled') await cell.told({ cmd: 'group_enable', group: 'arm' });
    await until('it stands by', async () => (await arm())['state'] === 'GroupStandby');
}
async function rests(): Promise<void> {
    await until('it rests', async () => (await arm())['state'] !== 'GroupMoving');
    for (const joint of joints) await cell.stands(joint);
}
async function pad(frame: string, increment = '0'): Promise<void> {
    await ready();
    await cell.look('#group/arm');
    await choose('group_frame', frame);
    await choose('group_increment', increment);
    await cell.page.locator('[data-input="group_jog_velocity"]').fill('100');
}
/** A page that stands still for 200 ms on a busy computer lets go and says so: then it is pressed again. */
async function hold(way: string, holds: () => Promise<boolean>): Promise<void> {
    for (;;) {
        await until(`${way} may be pressed`, () => button(way).isEnabled());
        await cell.hush();
        await button(way).scrollIntoViewIfNeeded();
        await cell.press_down(button(way));
        let done = false;
        await until(`${way} is held, or the page says why not`, async () => (done = await holds()) || (await cell.notice()) !== '');
        if (done) return;
        await cell.page.mouse.up();
        await rests();
        await ready();
    }
}

test('an axis of the group moves while its button is held, and the tool in the machine afterwards', { timeout: 240_000 }, async () => {
    await pad('acs');
    await hold('elbow+', async () => (await cell.axis('elbow')).set_position > 50);
    await cell.page.mouse.up();
    await rests();
    assert.ok((await cell.axis('elbow')).set_position < 140);
    assert.equal((await cell.axis('shoulder')).set_position, 0);

    await pad('mcs');
    const [x, y, z] = await tool() as [number, number, number];
    await hold('x-', async () => ((await tool())[0] ?? 0) < x - 20);
    await cell.page.mouse.up();
    await rests();
    const at = await tool();
    assert.ok(Math.abs((at[1] ?? 0) - y) < 1e-6 && Math.abs((at[2] ?? 0) - z) < 1e-6, 'on a straight line');
});

test('by keyboard: held as long as the key is', { timeout: 240_000 }, async () => {
    await pad('mcs');
    const [, y] = await tool() as [number, number, number];
    await cell.insist('it goes', async () => {
        await cell.page.keyboard.up(' ');
        await rests();
        await button('y-').focus();
        await cell.page.keyboard.down(' ');
    }, async () => ((await tool())[1] ?? 0) < y - 10);
    await cell.page.keyboard.up(' ');
    await rests();
    const stood = (await tool())[1];
    await cell.passes(400);
    assert.equal((await tool())[1], stood);
});

test('an increment ends exactly there, with the button still down', { timeout: 240_000 }, async () => {
    await pad('mcs', '1');
    const [, y] = await tool() as [number, number, number];
    let at = y;
    await hold('y+', async () => (at = (await tool())[1] ?? 0) >= y + 1 - 1e-6);
    await cell.passes(300);
    const stood = (await tool())[1] ?? 0;
    await cell.page.mouse.up();
    assert.ok(Math.abs(Math.round(stood - y) - (stood - y)) < 1e-6, `it stands ${stood - y} mm further`);
    assert.ok(at > y);
});

const endings: [string, () => Promise<unknown> | void, (() => Promise<void> | void)?][] = [
    ['the button let go', () => cell.page.mouse.up()],
    ['the finger beside the button', () => cell.page.mouse.move(5, 5)],
    ['the window\'s blur', () => cell.page.evaluate(() => window.dispatchEvent(new Event('blur')))],
    ['a second finger', () => cell.page.touchscreen.tap(700, 300)],
    ['another page of it', () => cell.page.evaluate(() => { location.hash = '#overview'; })],
    ['a page that is closed', () => cell.page.close()],
    ['a network that stalls', () => cell.line.hold(), () => cell.line.flow()],
    ['a connection that ends', () => cell.line.cut(), () => cell.line.flow()],
];
for (const [name, happens, afterwards] of endings)
    test(`a jog of the group ends by: ${name}`, { timeout: 240_000 }, async () => {
        await pad('acs');
        const way = (await cell.axis('wrist')).set_position > 0 ? 'wrist-' : 'wrist+';
        await hold(way, async () => Math.abs((await cell.axis('wrist')).set_velocity) > 60);
        try {
            await happens();
            await rests();
            const from = await newest(cell.machine);
            await cell.passes(400);
            assert.ok((await velocities('wrist', from)).every((v) => v === 0), 'it began again by itself');
        } finally {
            await afterwards?.();
        }
        assert.notEqual((await arm())['state'], 'GroupErrorStop');
    });

test('what stops it is said below the buttons, in Chinese, too', { timeout: 240_000 }, async () => {
    await pad('acs');
    await hold('lift+', async () => (await cell.axis('lift')).set_position === 100);
    const said = () => cell.page.locator('[data-value="group_jog_end"]').innerText();
    await until('a limit is said', async () => /as far as its axes may/.test(await said()));
    await cell.page.mouse.up();
    await rests();
    await ready();
    await cell.look('#group/arm', { language: 'zh' });
    await choose('group_frame', 'acs');
    await hold('lift+', async () => (await said()) !== '');
    await cell.page.mouse.up();
    assert.match(await said(), /[\u4e00-\u9fff]/);
});

test('in set-up mode the page says how fast the tool may be, and the machine keeps it', { timeout: 240_000 }, async () => {
    await cell.told({ cmd: 'mode', mode: 'setup' });
    await pad('acs');
    await until('it is said', async () => /at most 250 mm\/s.*no safety function/s.test(await cell.page.locator('[data-value="group_setup"]').innerText()));
    const from = await newest(cell.machine);
    await hold('shoulder+', async () => (await cell.axis('shoulder')).set_velocity > 10);
    await cell.passes(500);
    await cell.page.mouse.up();
    await rests();
    assert.ok((await recorded(cell.machine, 'group.arm.tool_speed', from, await newest(cell.machine))).every((v) => v <= 250));
    await cell.told({ cmd: 'mode', mode: 'manual' });
});

test('a viewer sees the pad and moves nothing', { timeout: 240_000 }, async () => {
    await cell.serve_as('viewer');
    await cell.look('#group/arm');
    assert.ok(await button('x+').isDisabled());
    assert.deepEqual(cell.complaints, []);
});
