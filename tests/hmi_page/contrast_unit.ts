// The palette: whatever is written stands out from its ground, in both themes. WCAG 2.1, 1.4.3: 4.5 to 1; 1.4.11: 3 to 1 for what only draws.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import test from 'node:test';
import { colour_of, dash_of, most_colours } from '@page/scope/colours';

const css = readFileSync(join(process.env['TAKTWERK_SOURCE'] ?? '', 'hmi_bridge/page/source/page.css'), 'utf8');
function palette(selector: string): Record<string, string> {
    const at = css.indexOf(`\n${selector} {`);
    assert.ok(at >= 0, selector);
    return Object.fromEntries([...css.slice(at, css.indexOf('}', at)).matchAll(/--([\w-]+): (#[0-9a-f]{6})/g)].map((m) => [m[1] ?? '', m[2] ?? '']));
}
const light = palette(':root'), dark = { ...light, ...palette(':root[data-theme="dark"]') };

function luminance(colour: string): number {
    const part = (at: number): number => {
        const v = parseInt(colour.slice(at, at + 2), 16) / 255;
        return v <= 0.03928 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4;
    };
    return 0.2126 * part(1) + 0.7152 * part(3) + 0.0722 * part(5);
}
function contrast(a: string, b: string): number {
    const [x, y] = [luminance(a), luminance(b)];
    return (Math.max(x, y) + 0.05) / (Math.min(x, y) + 0.05);
}

test('black on white is 21 to 1, and a grey that is known to be too light fails', () => {
    assert.ok(Math.abs(contrast('#000000', '#ffffff') - 21) < 0.01);
    assert.ok(contrast('#777777', '#ffffff') < 4.5);  // 4.48, the textbook's example
    assert.ok(contrast('#767676', '#ffffff') > 4.5);
});

const grounds = ['ground', 'panel', 'field'];
for (const [theme, colours] of [['light', light], ['dark', dark]] as const) {
    const at = (name: string): string => {
        const found = colours[name];
        assert.ok(found, `--${name} is missing`);
        return found;
    };
    test(`letters on every ground, ${theme}`, () => {
        for (const letter of ['text', 'quiet', 'good', 'warn', 'bad', 'idle', 'accent'])
            for (const ground of grounds) assert.ok(contrast(at(letter), at(ground)) >= 4.5, `${letter} on ${ground}: ${contrast(at(letter), at(ground)).toFixed(2)}`);
        for (const [letter, ground] of [['on-accent', 'accent'], ['on-mark', 'mark'], ['on-mark', 'force'], ['on-stop', 'stop'], ['good', 'good-ground'], ['warn', 'warn-ground'], ['bad', 'bad-ground'], ['text', 'warn-ground'], ['text', 'bad-ground'], ['quiet', 'warn-ground']] as const)
            assert.ok(contrast(at(letter), at(ground)) >= 4.5, `${letter} on ${ground}: ${contrast(at(letter), at(ground)).toFixed(2)}`);
    });
    test(`what only draws, ${theme}`, () => {
        for (const drawn of ['accent', 'bad', 'quiet', 'good']) assert.ok(contrast(at(drawn), at('panel')) >= 3, `${drawn}: ${contrast(at(drawn), at('panel')).toFixed(2)}`);
    });
}

test('curves of the scope stand out from their ground, and the ninth has another dash', () => {
    for (const on_dark of [false, true])
        for (let place = 0; place < most_colours; place++) assert.ok(contrast(colour_of(place, on_dark), (on_dark ? dark : light)['panel'] ?? '') >= 4.5, `${colour_of(place, on_dark)}`);
    assert.equal(new Set(Array.from({ length: 4 * most_colours }, (_, i) => `${colour_of(i, false)} ${dash_of(i).join()}`)).size, 4 * most_colours);
});
