// The machine builder's own page before a machine that runs its program: each widget shows what the machine has, and what is written stands in the program.
import assert from 'node:assert/strict';
import { after, before, beforeEach, test } from 'node:test';
import { Cell, unhurried, until } from './cell';
import { newest, recorded } from './recorded';

const cell = new Cell();

/** The demo with its program and without its happenings, and a page with each kind of widget. */
const views = `views:
  work:
    title: { en: Work, zh: 工作 }
    rows:
      - - { button: pick_and_place.start, label: { en: Start, zh: 启动 } }
        - { switch: pick_and_place.stop_at_end, label: { en: Stop at end, zh: 完成后停止 } }
        - { set: pick_and_place.pace, label: { en: Pace, zh: 倍率 } }
        - { set: pick_and_place.speed, label: Speed }
      - - { value: pick_and_place.pieces, label: { en: Pieces, zh: 件数 } }
        - { lamp: pick_and_place.running, label: { en: Running, zh: 运行中 } }
        - { lamp: in.part_present }
        - { bar: x.actual_position }
        - { value: machine.mode }
        - { value: x.state }
      - - { text: { en: What stands here is text <b>alone</b>, zh: 只是文字 } }
        - { alarms: true }
        - { axis: x }
      - - { image: demo-cell.svg, placed: [ { value: x.actual_position, x: 10, y: 20, label: px }, { lamp: out.gripper, x: 50, y: 50 } ] }
        - { trend: [x.actual_position, y.actual_position], seconds: 5 }
  second:
    title: { en: Second, zh: 第二页 }
    rows: [[ { value: y.actual_position } ]]

`;
const with_views = (yaml: string): string => unhurried(yaml).replace('start_mode: manual', 'start_mode: automatic').replace(/^views:[\s\S]*?(?=^# ---)/m, views);
before(() => cell.start({ machine: with_views, role: 'operator' }), { timeout: 120_000 });
after(() => cell.end());
beforeEach(() => cell.line.flow());

const variable = async (name: string): Promise<number> =>
    Number(((await cell.machine.state())['variables'] as { program: string; name: string; value: number }[]).find((v) => v.name === name)?.value);
const widget = (of: string, kind?: string) => cell.page.locator(`${kind ? `[data-widget="${kind}"]` : '.widget'}[data-of="${of}"]`);
const start = () => cell.page.locator('[data-button="pick_and_place.start"]');
const plainly = (text: string | null) => (text ?? '').replace('−', '-');

/** ms of machine time: the oldest renewal that is taken, how long a button stays pressed without one, and the task's next scan. */
const renewal_age = 250, lease = 200, scan = 2 * 4;
const cycle_ms = 4;
const start_recorded = async (from: number): Promise<number[]> => recorded(cell.machine, 'pick_and_place.start', from, await cell.cycle_from_now());  // what `state` said before is in it

/** Held, and it stays TRUE for longer than any lease. A page that stands still on a busy computer lets go by itself and says so: then it is pressed anew, as a person would. */
async function down(): Promise<void> {
    for (;;) {
        await until('the button may be pressed', () => start().isEnabled());
        await cell.hush();
        await cell.press_down(start());
        await until('the program sees it, or the page says why not', async () => (await variable('start')) === 1 || (await cell.notice()) !== '');
        const from = await cell.cycle_from_now();
        await until('it is held for a while', async () => (await newest(cell.machine)) > from + 300 / cycle_ms);
        const seen = await start_recorded(from);
        if (seen.every((v) => v === 1) && (await variable('start')) === 1) return;
        assert.notEqual(await cell.notice(), '', 'it was let go without a word');
        await cell.page.mouse.up();
    }
}

test('an operator begins with the first page of the machine\'s builder, and each is in the navigation by its title', async () => {
    await cell.look('');
    await cell.page.locator('.page.view').waitFor();
    assert.deepEqual(await cell.page.locator('.own-tabs a').allTextContents(), ['Work', 'Second']);
    assert.equal(await cell.page.locator('.own-tabs a[aria-current="page"]').textContent(), 'Work');
    await cell.page.locator('.own-tabs a', { hasText: 'Second' }).click();
    await widget('y.actual_position').waitFor();
    await cell.page.locator('[data-do="language"]').click();
    assert.deepEqual(await cell.page.locator('.own-tabs a').allTextContents(), ['工作', '第二页']);
    await cell.page.locator('.own-tabs a', { hasText: '工作' }).click();
    assert.equal(await widget('pick_and_place.pieces').locator('h2').textContent(), '件数');
});

test('a number: what is typed stands in the program, what is out of its range does not, and the page shows the machine\'s', async () => {
    await cell.look('#view/work');
    const pace = widget('pick_and_place.pace'), input = pace.locator('input');
    await until('it may be written', () => input.isEnabled());
    const from = await newest(cell.machine);
    const type = async (text: string): Promise<void> => {
        await input.fill(text);
        await input.press('Enter');
    };
    await cell.insist('the program has it', () => type('72,5'), async () => (await variable('pace')) === 72.5);
    await until('the page shows it', async () => plainly(await pace.locator('[data-value="value"]').textContent()).startsWith('72.5'));
    await until('nothing is on its way', async () => (await pace.locator('.hint').textContent()) === '');
    for (const wrong of ['500', '-1', 'fast']) {
        await cell.hush();
        await type(wrong);
        await until(`${wrong} is refused`, async () => (await cell.notice()).includes(wrong.replace('-', '')));
    }
    await cell.insist('the program has the next one', () => type('72.25'), async () => (await variable('pace')) === 72.25);
    let had = new Set<number>();
    await until('it is recorded, too', async () => (had = new Set(await recorded(cell.machine, 'pick_and_place.pace', from, await newest(cell.machine)))).has(72.25));
    assert.deepEqual([...had], [100, 72.5, 72.25]);
    assert.ok(await widget('pick_and_place.speed').locator('button').isDisabled(), 'a parameter is for the engineer');
});

test('a switch shows what the machine has; what the program takes back goes back', async () => {
    await cell.look('#view/work');
    const button = widget('pick_and_place.stop_at_end').locator('button');
    await until('it may be switched', () => button.isEnabled());
    const is = () => button.getAttribute('aria-checked');
    assert.equal(await is(), 'false');
    await cell.insist('the program has it', () => button.click(), async () => (await variable('stop_at_end')) === 1);
    await until('the page shows it', async () => (await is()) === 'true');
    await cell.told({ cmd: 'set_value', variable: 'pick_and_place.stop_at_end', value: 0 });  // by another hand
    await until('the page shows it', async () => (await is()) === 'false');
});

test('what is refused is told, and nothing is shown as if it were done', async () => {
    await cell.look('#view/work');
    const button = widget('pick_and_place.stop_at_end').locator('button');
    await until('it may be switched', () => button.isEnabled());
    await cell.told({ cmd: 'simulate', line: 'input estop_ok 0' });
    await until('the emergency stop holds', async () => (await cell.machine.state())['emergency_stop'] === true);
    const from = await newest(cell.machine);
    await cell.insist('it is refused', () => button.click(), async () => (await cell.notice()).includes('emergency stop'));
    await until('nothing is on its way', async () => (await widget('pick_and_place.stop_at_end').locator('.hint').textContent()) === '');
    assert.equal(await button.getAttribute('aria-checked'), 'false');
    assert.ok((await recorded(cell.machine, 'pick_and_place.stop_at_end', from, await newest(cell.machine))).every((v) => v === 0));
    await until('no button is pressed then', () => start().isDisabled());
    await cell.told({ cmd: 'simulate', line: 'input estop_ok 1' });
    await until('it is released', async () => (await cell.machine.state())['emergency_stop'] === false);
    await cell.told({ cmd: 'reset' });
    await until('it may be pressed', () => start().isEnabled());
});

const endings: [string, () => Promise<unknown> | void, (() => Promise<unknown> | void)?][] = [
    ['let go', () => cell.page.mouse.up()],
    ['the capture lost', () => cell.lose_capture(start())],
    ['the window\'s blur', () => cell.page.evaluate(() => window.dispatchEvent(new Event('blur')))],
    ['a second finger', () => cell.page.touchscreen.tap(700, 300)],
    ['another page of it', () => cell.page.evaluate(() => { location.hash = '#overview'; })],
    ['STOP by somebody', () => cell.machine.ask({ cmd: 'stop' })],
    ['a network that stalls', () => cell.line.hold(), () => cell.line.flow()],
    ['a page that freezes', () => void cell.signal_renderers('SIGSTOP'), () => void cell.signal_renderers('SIGCONT')],
    ['a page that is closed', () => cell.page.close()],
];
for (const [what, happens, recovers] of endings)
    test(`a button falls back: ${what}`, { timeout: 180_000 }, async () => {
        for (;;) {
            await cell.look('#view/work');
            await down();
            const before = await newest(cell.machine);
            await happens();
            const ended = await cell.cycle_from_now();
            await until('it falls back', async () => (await variable('start')) === 0);
            const seen = await start_recorded(before), fell = seen.indexOf(0);
            if (fell === 0) {  // it had let go by itself, which says nothing of this ending
                await recovers?.();
                continue;
            }
            assert.ok(fell > 0 && before + fell <= ended + (renewal_age + lease + scan) / cycle_ms, `it fell ${before + fell - ended} cycles after the ending`);
            await recovers?.();
            await cell.passes(500);
            assert.ok((await start_recorded(before + fell)).every((v) => v === 0), 'it came back by itself');
            return;
        }
    });

test('a button by the keyboard alone', { timeout: 180_000 }, async () => {
    await cell.look('#view/work');
    await until('it may be pressed', () => start().isEnabled());
    await start().focus();
    let from = 0;
    await cell.insist('the program sees it', async () => {
        await cell.page.keyboard.up(' ');
        await until('it is let go', async () => (await variable('start')) === 0 && (await start().isEnabled()));
        from = await newest(cell.machine);
        await cell.page.keyboard.down(' ');
    }, async () => (await start_recorded(from)).includes(1));
    await cell.page.keyboard.up(' ');
    await until('it falls back', async () => (await variable('start')) === 0);
});

// Pressed and let go at once, as a finger taps: either the program has seen it, or the page says why not. Nothing is lost without a word.
test('a tap is seen by the program', { timeout: 180_000 }, async () => {
    await cell.look('#view/work');
    for (let taps = 0; taps < 5; taps++) {
        await until('it may be pressed', async () => (await variable('start')) === 0 && (await start().isEnabled()));
        const from = await newest(cell.machine);
        await cell.insist('the program sees it', () => start().click({ delay: 0 }), async () => (await start_recorded(from)).includes(1));
    }
});

test('what only shows shows the machine\'s values; a picture is a picture, a text is text', async () => {
    await cell.look('#view/work');
    const axis = await cell.axis('x');
    await until('the bar has the position', async () => Math.abs(Number(await widget('x.actual_position', 'bar').locator('[role="meter"]').getAttribute('aria-valuenow')) - (await cell.axis('x')).actual_position) < 5);
    assert.equal(await widget('machine.mode').locator('[data-value="value"]').textContent(), 'Automatic');
    assert.match((await widget('in.part_present').locator('[data-value="lamp"]').textContent()) ?? '', /^● on/);
    assert.equal(await cell.page.locator('[data-widget="text"]').textContent(), 'What stands here is text <b>alone</b>');
    const image = cell.page.locator('.picture img');
    await until('the picture is there', () => image.evaluate((img) => (img as HTMLImageElement).naturalWidth > 0));
    assert.match((await image.getAttribute('src')) ?? '', /^blob:/);
    await until('a value stands on it', async () => (await cell.page.locator('.placed-value').textContent())?.startsWith('px') ?? false);
    await until('the trend is drawn', () => cell.page.locator('.trend-host canvas').evaluateAll((all) => all.some((c) => {
        const ctx = (c as HTMLCanvasElement).getContext('2d');
        return ctx !== null && ctx.getImageData(0, 0, (c as HTMLCanvasElement).width, (c as HTMLCanvasElement).height).data.some((v) => v !== 0);
    })));
    assert.ok(axis);
    assert.deepEqual(cell.complaints.filter((text) => !text.includes('401')), []);
});

test('old values are grey, and nothing of the page can be pressed', async () => {
    await cell.look('#view/work');
    await until('it may be pressed', () => start().isEnabled());
    await start().focus();
    cell.line.hold();
    await cell.page.locator('.stale').waitFor();
    await until('all are grey', async () => (await cell.page.locator('.view button:not([disabled])').count()) === 0);
    cell.line.flow();
    await until('it may be pressed again', () => start().isEnabled());
    await until('the keyboard is where it was', () => start().evaluate((button) => button === document.activeElement));
});
