// The scope of a machine that runs: nothing is missing, what is exported is what the machine has, and hands do what they should.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { after, before, test } from 'node:test';
import { patience, until } from './cell';
import { Json } from './machine';
import { ScopeCell, table } from './scope_cell';

const scope = new ScopeCell(), { cell } = scope;
before(() => scope.start(), { timeout: 120_000 });
after(() => cell.end());

test('32 signals at 1 kHz, live for six seconds: not one cycle is missing', { timeout: 240_000 }, async () => {
    await cell.look('#scope');
    const described = (await cell.told({ cmd: 'scope_signals' }))['scope'] as Json;
    assert.equal(described['cycle_ns'], 1_000_000);
    const names = (described['signals'] as Json[]).filter((s) => s['kind'] === 'real' && s['group'] === 'axis').map((s) => String(s['name'])).slice(0, 32);
    const more = (described['signals'] as Json[]).map((s) => String(s['name'])).filter((name) => !names.includes(name) && name !== 'time_s').slice(0, 32 - names.length);
    // A set-up of all of them, as one that was saved.
    await cell.page.evaluate((channels) => {
        localStorage.setItem('scope_last', JSON.stringify({ taktwerk_scope: 1, span_s: 5, channels: channels.map((name, colour) => ({ name, colour, offset: 0 })) }));
    }, [...names, ...more]);
    await cell.page.reload();
    await cell.page.locator('.scope-values tbody tr').nth(31).waitFor();
    await scope.cycles(6000);
    const file = table(await scope.exported());
    assert.equal(file.names.length, 33);
    assert.ok(file.rows > 4900, `${file.rows} cycles`);
    assert.ok((await scope.as_the_machine(file)) > 4000);
    assert.equal(await cell.page.locator('tr[data-missing]').count(), 0);
});

test('what is exported is what the machine has, to the last digit; so is what a cursor says', { timeout: 240_000 }, async () => {
    await cell.powered_and_homed('x');
    await cell.look('#scope');
    await scope.tick('x.set_position', 'x.actual_position', 'x.following_error', 'x.state');
    await cell.told({ cmd: 'move', axis: 'x', position: 100, velocity: 150 });
    await scope.cycles(1500);
    await scope.press('freeze');
    const file = table(await scope.exported());
    assert.ok((await scope.as_the_machine(file)) > 1000);
    assert.ok(new Set(file.columns[file.names.indexOf('x.set_position')]).size > 100, 'it moved');

    await scope.press('cursors');
    const line = cell.page.locator('[data-cursor="a"]');
    await line.focus();
    await cell.page.keyboard.press('ArrowRight');
    await until('the values are there', async () => (await cell.page.locator('tr[data-row="x.actual_position"] [data-value="a"]').textContent()) !== '–');
    const between = table(await scope.exported()), positions = between.columns[between.names.indexOf('x.actual_position')] ?? [];
    const text = (row: string, value: string) => cell.page.locator(`tr[data-row="${row}"] [data-value="${value}"]`).textContent();
    await until('the numbers follow', async () => Number((await text('x.actual_position', 'a'))?.replace('−', '-')) === positions[0] && Number((await text('x.actual_position', 'max'))?.replace('−', '-')) === Number(Math.max(...positions).toPrecision(7)));
    assert.equal(Number((await text('x.actual_position', 'a'))?.replace('−', '-')), positions[0]);
    assert.equal(Number((await text('x.actual_position', 'b'))?.replace('−', '-')), positions[positions.length - 1]);
    assert.equal(Number((await text('x.actual_position', 'max'))?.replace('−', '-')), Number(Math.max(...positions).toPrecision(7)));
    assert.match((await text('x.state', 'b')) ?? '', /^(Homing|Standstill|DiscreteMotion)$/);
});

test('zooming asks for no less: each cycle is a sample, frozen or scrolled back', { timeout: 240_000 }, async () => {
    await cell.look('#scope');
    await scope.tick('in.start_button');
    await until('pulses', async () => {  // of a machine that was late some are missing
        const all = (await cell.told({ cmd: 'scope_signals' }))['scope'] as Json, last = Number(all['last']);
        const { columns } = await scope.recorded(['in.start_button'], Math.max(Number(all['first']), last - 6000), last + 1);
        return (columns[0]?.length ?? 0) >= 6000 && (columns[0]?.filter((v) => v === 1).length ?? 0) >= 2;
    });
    await until('the page has them', async () => Number((await cell.page.locator('body').getAttribute('data-cycle'))) >= Number((await cell.machine.state())['cycle']) - 500);
    await scope.press('freeze');
    await cell.page.locator('.scope-surface').focus();
    for (let i = 0; i < 3; i++) await cell.page.keyboard.press('ArrowLeft');
    for (let i = 0; i < 4; i++) await cell.page.keyboard.press('-');
    assert.ok((await scope.as_the_machine(table(await scope.exported()))) > 4000);
    await cell.page.locator('.scope-surface').focus();
    await cell.page.keyboard.press('a');
    const all = table(await scope.exported()), button = all.columns[all.names.indexOf('in.start_button')] ?? [];
    assert.ok(all.rows > 6000);
    const ones = button.map((v, i) => (v === 1 ? i : -1)).filter((i) => i >= 0);
    assert.ok(ones.length >= 2, 'pulses');
    for (const at of ones) assert.equal(button[at + 1] ?? 0, 0, 'of one sample');
});

test('a file of this disk opens in the same view, and wrong ones are told', { timeout: 240_000 }, async () => {
    await cell.look('#scope');
    await scope.press('files');
    const give = (name: string, text: string) => cell.page.locator('[data-file="csv"]').setInputFiles({ name, mimeType: 'text/csv', buffer: Buffer.from(text) });
    await give('bad.csv', 'time_s,a\n0,1\n0.001,zwei\n');
    await until('it is told', async () => /line 3.*zwei/.test((await cell.page.locator('.scope-complaint:visible').textContent()) ?? ''));
    const rows = Array.from({ length: 2000 }, (_, i) => `${i / 1000},${10 * Math.sin((2 * Math.PI * 50 * i) / 1000)},${i}`).join('\n');
    await give('sine.csv', `time_s,w.position[mm],w.count\n${rows}\n`);
    await until('it is shown', async () => ((await scope.shown('scene')) ?? '').includes('sine.csv'));
    await scope.press('signals');
    await scope.tick('w.position', 'w.count');
    await cell.page.locator('[data-view="spectrum"]').click();
    const cells = (value: string) => cell.page.locator(`.spectrum [data-value="${value}"]`).first().textContent();
    await until('its spectrum is the sine', async () => (await cells('largest_hz')) === '50 Hz');
    assert.equal(Math.round(Number(await cells('largest')) * 1e6) / 1e6, 10);
    await cell.page.locator('[data-view="xy"]').click();
    await cell.page.locator('.scope-other.xy canvas').waitFor();
});

test('a set-up is saved by name, exported and comes back', { timeout: 240_000 }, async () => {
    await cell.look('#scope');
    await scope.tick('x.actual_torque');
    await scope.press('files');
    await cell.page.locator('[data-field="setup"]').fill('torque of x');
    await scope.press('save_setup');
    const [download] = await Promise.all([cell.page.waitForEvent('download'), scope.press('export_setups')]);
    const text = readFileSync(await download.path(), 'utf8');
    assert.match(text, /torque of x/);
    await cell.look('#scope');  // somebody else's browser
    assert.equal(await cell.page.locator('tr[data-row="x.actual_torque"]').count(), 0);
    await scope.press('files');
    await cell.page.locator('[data-file="setup"]').setInputFiles({ name: 'set.json', mimeType: 'application/json', buffer: Buffer.from('{"a":1}') });
    await until('what is none is told', async () => /no set-up/.test((await cell.page.locator('.scope-complaint:visible').textContent()) ?? ''));
    await cell.page.locator('[data-file="setup"]').setInputFiles({ name: 'set.json', mimeType: 'application/json', buffer: Buffer.from(text) });
    await cell.page.locator('[data-setup="torque of x"] button').first().click();
    await cell.page.locator('tr[data-row="x.actual_torque"]').waitFor();
});

test('hands: wheel, drag, a box, double click, keys, a scale by hand', { timeout: 240_000 }, async () => {
    await cell.look('#scope');
    await until('curves are there', async () => /\d/.test((await scope.shown('newest')) ?? ''));
    await scope.cycles(3000);
    await scope.press('freeze');
    const { from: first, seconds } = await scope.times();
    /** The cycle of a time: a machine on a busy computer skips milliseconds, and what is seen is as wide as its cycles. */
    const cycle_of = (s: number): number => {
        const at = seconds.findIndex((t) => t >= s - 1e-6);
        assert.ok(at >= 0 && s >= (seconds[0] ?? NaN), `${s} s is not among the machine's`);
        return first + at;
    };
    /** What is seen, in cycles. */
    const seen = async (): Promise<{ from: number; to: number; span: number }> => {
        const text = (await cell.page.locator('.scope-between').textContent()) ?? '';
        const [from = NaN, to = NaN] = text.split('shown,')[1]?.split(' to ').map((t) => cycle_of(parseFloat(t.trim().replace('−', '-')))) ?? [];
        return { from, to, span: to - from };
    };
    type Seen = Awaited<ReturnType<typeof seen>>;
    const becomes = async (what: string, wanted: Partial<Seen>, within: number): Promise<Seen> => {
        let is = await seen();
        const holds = () => Object.entries(wanted).every(([key, cycles]) => Math.abs(is[key as keyof Seen] - cycles) <= within);
        await until(`${what}: ${JSON.stringify(wanted)}`, async () => ((is = await seen()), holds()), patience).catch((why: unknown) => assert.fail(`${JSON.stringify(is)}: ${String(why)}`));
        return is;
    };
    await cell.page.locator('[data-field="span"]').selectOption('2');
    const box = await cell.page.locator('.scope-surface').boundingBox();
    assert.ok(box);
    const at = (part: number) => box.x + box.width * part, middle = box.y + 60;
    const { mouse, keyboard } = cell.page, start = await becomes('2 s', { span: 2000 }, 3);

    await mouse.move(at(0.25), middle);
    await mouse.wheel(0, -400);
    const span = 2000 / 1.25 ** 4;
    const zoomed = await becomes('zoomed; what is under the pointer stays there', { span, from: start.from + 500 - span / 4 }, 10);

    const drag = async (from: number, to: number): Promise<void> => {
        await mouse.move(at(from), middle);
        await mouse.down();
        await mouse.move(at((from + to) / 2), middle);
        await mouse.move(at(to), middle);
        await mouse.up();
    };
    await drag(0.5, 0.75);
    const moved = await becomes('dragged', { from: zoomed.from - zoomed.span / 4, span }, 10);

    await keyboard.down('Shift');
    await drag(0.25, 0.75);
    await keyboard.up('Shift');
    await becomes('a box', { span: span / 2, from: moved.from + moved.span / 4 }, 10);

    await mouse.dblclick(at(0.5), middle);
    await becomes('back', { from: moved.from, span }, 10);
    await cell.page.locator('.scope-surface').focus();
    await keyboard.press('ArrowLeft');
    await becomes('to the left', { from: moved.from - moved.span / 10, span }, 10);
    await keyboard.press('+');
    await becomes('nearer', { span: span / 2 }, 10);
    await keyboard.press('End');
    await until('it follows again', async () => /Freeze/.test((await cell.page.locator('[data-do="freeze"]').textContent()) ?? ''));

    await cell.page.locator('.scope-name').first().click();
    for (const [field, text] of [['min', '-20'], ['max', '30']] as const) await cell.page.locator(`[data-field="${field}"]`).fill(text);
    await scope.press('scale');
    await cell.settled();
    await cell.page.locator('.scope-name').first().click();
    assert.equal(await cell.page.locator('[data-field="max"]').inputValue(), '30');
    await scope.press('autoscale');
});

for (const taste of [{ language: 'en', theme: 'light' }, { language: 'zh', theme: 'dark' }] as const)
    test(`as it stands on a panel PC, ${taste.language}, ${taste.theme}: nothing beside the screen, no word of the other language`, { timeout: 240_000 }, async () => {
        await cell.look('#scope', taste);
        for (const open of ['signals', 'trigger', 'files']) {
            await scope.press(open);
            await cell.settled();
            const seen = await cell.page.evaluate(() => {
                const visible = [...document.querySelectorAll<HTMLElement>('.page.scope *')].filter((e) => e.getClientRects().length > 0);
                const main = document.querySelector('main') as HTMLElement;
                return {
                    outside: visible.filter((e) => e.matches('button, select, input, a') && !e.closest('.scope-scroll, .scope-side') && (e.getBoundingClientRect().right > innerWidth + 1 || e.getBoundingClientRect().bottom > innerHeight + 1)).map((e) => e.outerHTML.slice(0, 80)),
                    small: visible.filter((e) => e.matches('.scope-bar button, .scope-bar select, .scope-form button, .scope-form input[type="text"], .scope-form select') && e.getBoundingClientRect().height < 43.5).map((e) => e.outerHTML.slice(0, 80)),
                    // Names of signals are the machine's.
                    texts: visible.filter((e) => !e.closest('.scope-name, .scope-link, .scope-line span, [data-field], datalist')).flatMap((e) => [...e.childNodes].filter((n) => n.nodeType === 3).map((n) => n.textContent ?? '')),
                    over: Math.max(main.scrollHeight - main.clientHeight, main.scrollWidth - main.clientWidth),
                };
            });
            assert.deepEqual(seen.outside, []);
            assert.deepEqual(seen.small, []);
            assert.ok(seen.over <= 0);
            assert.ok(seen.texts.length > 10);
            if (taste.language === 'en') assert.deepEqual(seen.texts.filter((t) => /[\u4e00-\u9fff]/.test(t)), []);
            else assert.deepEqual(seen.texts.filter((t) => /[A-Za-z]{3}/.test(t.replace(/CSV|PNG|FFT|pick_and_place|\[.*?\]|[.0-9]+h\b/g, ''))), []);
        }
    });

test('the picture is a PNG of its size', { timeout: 240_000 }, async () => {
    await cell.look('#scope');
    await until('curves are there', async () => /\d/.test((await scope.shown('newest')) ?? ''));
    await scope.press('files');
    const [download] = await Promise.all([cell.page.waitForEvent('download'), scope.press('save_png')]);
    const bytes = readFileSync(await download.path());
    assert.equal(bytes.subarray(1, 4).toString(), 'PNG');
    const [width, height] = [bytes.readUInt32BE(16), bytes.readUInt32BE(20)];
    assert.ok(width > 700 && height > 200, `${width} x ${height}`);
});

test('the browser had nothing to complain about', () => assert.deepEqual(cell.complaints, []));
