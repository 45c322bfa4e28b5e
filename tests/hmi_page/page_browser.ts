// A person looks at the page of a machine that runs: what is shown is so.
import assert from 'node:assert/strict';
import { after, before, beforeEach, test } from 'node:test';
import { Cell, pause, patience, until } from './cell';
import { recorded } from './recorded';

const cell = new Cell();
before(() => cell.start(), { timeout: 120_000 });
after(() => cell.end());
beforeEach(() => cell.line.flow());

test('values on the screen are those that the machine has recorded of the same cycle, to the last digit', { timeout: 180_000 }, async () => {
    await cell.powered_and_homed('x');
    await cell.look('#axis/x');
    const signals: [string, string, string, number][] = [['big_position', 'x.actual_position', '', 3], ['head_set_position', 'x.set_position', ' mm', 3], ['head_actual_velocity', 'x.actual_velocity', ' mm/s', 3],
        ['head_following_error', 'x.following_error', ' mm', 3], ['set_velocity', 'x.set_velocity', ' mm/s', 3], ['set_acceleration', 'x.set_acceleration', ' mm/s²', 1]];
    const seen = new Set<string>();
    let to = 300;
    for (const end = Date.now() + patience; seen.size < 12 && Date.now() < end; await pause(50)) {  // there and back, until so many different ones were seen while it moved
        if ((await cell.axis('x')).state === 'Standstill') await cell.told({ cmd: 'move', axis: 'x', position: (to = 400 - to), velocity: 60 });
        const [cycle, said] = await cell.page.evaluate((names) => [Number(document.body.dataset['cycle']), names.map((name) => document.querySelector(`[data-value="${name}"]`)?.textContent ?? '')] as const, signals.map(([name]) => name));
        for (const [i, [name, signal, unit, decimals]] of signals.entries()) {
            const [value] = await recorded(cell.machine, signal, cycle, cycle + 1);
            assert.equal(said[i]?.replace('−', '-'), `${value?.toFixed(decimals).replace(/^-(0\.?0*)$/, '$1')}${unit}`, `${name} of cycle ${cycle}`);
        }
        if (Math.abs((await recorded(cell.machine, 'x.set_velocity', cycle, cycle + 1))[0] ?? 0) > 50) seen.add(said[0] ?? '');
    }
    assert.ok(seen.size >= 12, `only ${seen.size} looks met it moving`);
});

test('values of a server that is silent are grey, with the time since; only STOP stays', { timeout: 180_000 }, async () => {
    await cell.look('#axis/x');
    // By the page's own clock, whatever this computer does besides: when a new cycle came, when the page called it old, and whether it was slow to say so.
    await cell.page.addInitScript(() => {
        const seen = { fresh: 0, stale: 0, silent: 0, longest_silent: 0 }, Plain = WebSocket;
        let cycle = 0;
        Object.assign(window, { seen, WebSocket: class extends Plain {
            constructor(address: string) {
                super(address);
                this.addEventListener('message', ({ data }) => {
                    const message = JSON.parse(String(data)) as { type: string; age_ms: number; state: { cycle: number } };
                    if (message.type !== 'state' || message.state.cycle === cycle) return;
                    cycle = message.state.cycle;
                    seen.fresh = performance.now() - message.age_ms;
                });
            }
        } });
        setInterval(() => {  // as often as the page itself looks
            const stale = document.body.hasAttribute('data-stale');
            seen.silent = !stale && performance.now() - seen.fresh > 500 ? seen.silent + 1 : 0;
            seen.longest_silent = Math.max(seen.longest_silent, seen.silent);
        }, 100);
        document.addEventListener('DOMContentLoaded', () => new MutationObserver(() => {
            if (document.body.hasAttribute('data-stale')) seen.stale = performance.now();
        }).observe(document.body, { attributes: true, attributeFilter: ['data-stale'] }));
    });
    await cell.page.reload();
    await cell.page.locator('body:not([data-stale]) .page').waitFor({ timeout: patience });
    await until('it may be pressed', () => cell.page.locator('main [data-cmd="reset"]').isEnabled());
    await cell.page.evaluate(() => Object.assign((window as unknown as { seen: object }).seen, { stale: 0, longest_silent: 0 }));
    const banner = cell.page.locator('.stale');
    cell.line.hold();
    await banner.waitFor({ timeout: patience });
    const seen = await cell.page.evaluate(() => (window as unknown as { seen: Record<'fresh' | 'stale' | 'longest_silent', number> }).seen);
    assert.ok(seen.stale - seen.fresh > 499, `too early: after ${seen.stale - seen.fresh} ms`);
    assert.ok(seen.longest_silent <= 2, `looked ${seen.longest_silent} times at old values and did not say so`);
    assert.match((await banner.textContent()) ?? '', /since \d\d:\d\d:\d\d \(\d/);
    assert.notEqual(await cell.page.locator('main').evaluate((main) => getComputedStyle(main).filter), 'none');
    for (const button of await cell.page.locator('main button:not([data-cmd="stop"])').all()) assert.ok(await button.isDisabled(), (await button.textContent()) ?? '');
    assert.ok(await cell.page.locator('[data-do="stop"]').isEnabled());
    cell.line.flow();
    await cell.page.locator('body:not([data-stale])').waitFor({ timeout: patience });
    await until('the banner goes', () => banner.isHidden());
});

test('a page that nobody touches says its time, so that the server can tell an old press from a new one', { timeout: 240_000 }, async () => {
    const times = () => cell.sent.filter((message) => message['type'] === 'clock').map((message) => Number(message['sent_ms']));
    const before = times().length;
    await until('it has said it twice more', () => times().length >= before + 2);
    assert.ok(times().every((time, i, all) => i === 0 || time - (all[i - 1] ?? 0) < 60_000), 'more often than the two minutes that the server bears');
});

test('one click makes it Chinese, on every page', { timeout: 180_000 }, async () => {
    await cell.look('#overview');
    await cell.page.locator('[data-do="language"]').click();
    const { texts } = await import('@page/texts');
    const english: Set<string> = new Set(Object.values(texts).filter(([en, zh]) => en !== zh && en.length > 3).map(([en]) => en));
    for (const page of ['overview', 'axis', 'alarms', 'io', 'programs', 'bus', 'system']) {
        await cell.page.locator(`[data-page="${page}"]`).click();
        await cell.page.locator(`.page.${page}`).waitFor();
        await cell.settled();
        const said = await cell.page.evaluate(() => {
            const out: string[] = [];
            const walk = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
            while (walk.nextNode()) out.push((walk.currentNode.textContent ?? '').trim());
            return out;
        });
        for (const text of said) assert.ok(!english.has(text), `${page}: "${text}"`);
    }
    assert.equal(await cell.page.locator('html').getAttribute('lang'), 'zh-CN');
});

// WCAG 2.1, 1.4.3: 4.5 to 1, for large letters (24 px, or 18.66 px bold) 3 to 1. Disabled controls are exempt.
test('letters stand out from their ground in both themes, and STOP and SIMULATED are on the screen', { timeout: 180_000 }, async () => {
    for (const theme of ['light', 'dark'] as const) {
        await cell.look('', { theme });
        for (const page of ['overview', 'axis/x', 'alarms', 'io', 'programs', 'bus', 'system']) {
            await cell.go(page);
            assert.equal(await cell.page.locator('html').getAttribute('data-theme'), theme);
            assert.ok(await cell.page.locator('.simulated').isVisible());
            const stop = await cell.page.locator('[data-do="stop"]').boundingBox();
            assert.ok(stop && stop.x >= 0 && stop.x + stop.width <= 1280 && stop.y + stop.height <= 800, 'STOP is off the screen');
            const faint = await cell.page.evaluate(() => {
                const numbers = (colour: string) => (colour.match(/[\d.]+/g) ?? []).map(Number);
                const light = (c: number[]) => [0.2126, 0.7152, 0.0722].reduce((sum, weight, i) => {
                    const v = (c[i] ?? 0) / 255;
                    return sum + weight * (v <= 0.03928 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4);
                }, 0);
                const out: string[] = [];
                let looked = 0;
                for (const element of document.querySelectorAll<HTMLElement>('body *')) {
                    const text = [...element.childNodes].filter((n) => n.nodeType === 3).map((n) => n.textContent?.trim()).join('');
                    if (!text || element.closest(':disabled') || element.offsetParent === null && !element.closest('svg')) continue;
                    let ground: Element | null = element;
                    while (ground && (numbers(getComputedStyle(ground).backgroundColor)[3] ?? 1) === 0) ground = ground.parentElement;
                    const style = getComputedStyle(element);
                    const [a, b] = [light(numbers(element.closest('svg') ? style.fill : style.color)), light(numbers(getComputedStyle(ground ?? document.body).backgroundColor))];
                    const ratio = (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05);
                    const size = parseFloat(style.fontSize), large = size >= 24 || (size >= 18.66 && Number(style.fontWeight) >= 700);
                    looked++;
                    if (ratio < (large ? 3 : 4.5)) out.push(`${text}: ${ratio.toFixed(2)}`);
                }
                return { out, looked };
            });
            assert.ok(faint.looked > 20);
            assert.deepEqual(faint.out, [], `${theme} ${page}`);
        }
    }
});

test('the browser had nothing to complain about', () => assert.deepEqual(cell.complaints, []));
