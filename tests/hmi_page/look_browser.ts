// Each page as it stands on a panel PC of 1280 x 800, in both languages and themes: nothing cut off, nothing beside the screen, big enough for a finger, no word of the other language.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { Cell, Taste, unhurried, until } from './cell';

const cell = new Cell();
before(() => cell.start({ machine: unhurried }), { timeout: 120_000 });
after(() => cell.end());

const places = ['overview', 'axis/x', 'axis/x/drive', 'alarms', 'alarms/history', 'programs', 'bus', 'system', 'io'];
const tastes: Required<Taste>[] = [{ language: 'en', theme: 'light' }, { language: 'zh', theme: 'dark' }];
/** What has to be seen as a whole: hands, and what is watched while they work. */
const without_scrolling = ['overview', 'axis/x', 'io'];

// Names that a machine file gives, those of alarms, words of standards and units: the same in every language; so are commands, which stand in `these`.
const allowed = /^(demo|x|y|z|io|[xyz]_drive|sv33-e|se-808x|estop_ok|start_button|gripper_closed|part_present|lamp_run|gripper|buzzer|pick_and_place(\.\w+)*|speed|grip_time|main|step|pieces|mm|s|µs|ns|ms|kB|u|OP|PREOP|SAFEOP|INIT|DC|AL|SYNC0|RX|CSV|EEPROM|MC_\w+|(MIT|Apache|BSD|MPL|L?GPL|BSL|ISC|Zlib|public-domain)(-[\w.-]+)?|uPlot|esbuild|TypeScript|English|v?\d.*|[0-9A-F]+h|P\d\d\.\d\d|socket|lcm|LCM|Taktwerk|[a-z]+(_[a-z]+)+)$/;

for (const taste of tastes)
    for (const place of places)
        test(`${place}, ${taste.language}, ${taste.theme}`, { timeout: 180_000 }, async () => {
            if (place === places[0]) await cell.look('', taste);
            await cell.go(place);
            if (place === 'io') {
                const forcing = cell.page.locator('[data-do="forcing"]');
                await until('forcing is allowed', () => forcing.isEnabled());
                await forcing.check();
                await cell.insist('it is forced', () => cell.page.locator('[data-input-point="part_present"] [data-set="0"]').click(), () => cell.page.locator('.banner.forced').isVisible());
                await cell.hush();
                await cell.settled();
            }
            const seen = await cell.page.evaluate(() => {
                const main = document.querySelector('main') as HTMLElement;
                const visible = (element: HTMLElement): boolean => element.getClientRects().length > 0;
                const name = (element: Element): string => `${element.tagName.toLowerCase()}.${element.className} "${(element.textContent ?? '').slice(0, 30)}"`;
                const cut: string[] = [], small: string[] = [], outside: string[] = [];
                for (const element of document.querySelectorAll<HTMLElement>('body *')) {
                    if (!visible(element) || element.closest('svg')) continue;
                    const style = getComputedStyle(element), box = element.getBoundingClientRect();
                    const own = [...element.childNodes].some((node) => node.nodeType === 3 && node.textContent?.trim());
                    if (own && style.overflowX !== 'auto' && element.scrollWidth > element.clientWidth + 1 && style.display !== 'inline') cut.push(name(element));
                    if (box.right > innerWidth + 1) outside.push(name(element));
                    const pressed = element.matches('button, .tabs a, .side a, select, input:not([type="checkbox"])');
                    if (pressed && box.height < 44 - 0.5 && !element.closest('.uplot')) small.push(`${name(element)} ${box.height.toFixed(0)} px`);
                }
                const texts: string[] = [];
                const walk = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
                while (walk.nextNode()) {
                    const holder = walk.currentNode.parentElement;
                    if (holder && (visible(holder) || holder.tagName === 'OPTION') && !holder.closest('body [lang], .log')) texts.push((walk.currentNode.textContent ?? '').trim());
                }
                return { cut, small, outside, texts, high: main.scrollHeight - main.clientHeight, wide: main.scrollWidth - main.clientWidth };
            });
            assert.ok(seen.texts.length > 20);
            assert.deepEqual(seen.cut, [], 'cut off');
            assert.deepEqual(seen.outside, [], 'beside the screen');
            assert.deepEqual(seen.small, [], 'too small for a finger');
            assert.ok(seen.wide <= 0, `main is ${seen.wide} px too wide`);
            if (without_scrolling.includes(place)) assert.ok(seen.high <= 0, `main is ${seen.high} px too high`);
            if (taste.language === 'en') for (const text of seen.texts) assert.ok(!/[\u4e00-\u9fff]/.test(text) || text === '中文', text);
            else
                for (const text of seen.texts)
                    for (const word of text.replace(/`[^`]*`/g, '').split(/[^A-Za-z0-9_.\-µ]+/).filter((part) => /[A-Za-z]{2}/.test(part)))
                        assert.ok(allowed.test(word.replace(/^[.\-]+|[.\-]+$/g, '')), `not Chinese: "${word}" in "${text}"`);
        });
