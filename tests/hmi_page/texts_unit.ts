// The table of texts is whole: both languages, the same places to fill in, and a line for each word that the runtime can say.
import assert from 'node:assert/strict';
import { readFileSync, readdirSync, statSync } from 'node:fs';
import { join } from 'node:path';
import test from 'node:test';
import { gzipSync } from 'node:zlib';
import { fixed, span_of, typed } from '@page/numbers';
import { rooms, texts } from '@page/texts';

const source = process.env['TAKTWERK_SOURCE'] ?? '';
const places = (text: string): string[] => [...text.matchAll(/\{(\w+)\}/g)].map((m) => m[1] ?? '').sort();

test('each text has both languages and the same places', () => {
    for (const [key, [english, chinese]] of Object.entries(texts)) {
        assert.ok(english.trim() !== '' && chinese.trim() !== '', key);
        assert.deepEqual(places(english), places(chinese), key);
        if (key !== 'other_language' && key !== 'io') assert.match(chinese, /[\u4e00-\u9fff]/, `${key}: no Chinese`);
        if (key !== 'other_language') assert.doesNotMatch(english, /[\u4e00-\u9fff]/, `${key}: Chinese among the English`);
    }
});

test('no key stands in two rooms, and each file is a room', () => {
    const keys = Object.values(rooms).flatMap((room) => Object.keys(room));
    assert.deepEqual(keys.filter((key, i) => keys.indexOf(key) !== i), []);
    assert.deepEqual(readdirSync(join(source, 'hmi_bridge/page/source/texts')).sort(), Object.keys(rooms).map((room) => `${room}.ts`).sort());
});

// Group of the page's words, the file and the function that says them.
const groups: [string, string, RegExp][] = [
    ['phase', 'hmi_bridge/words/words.cpp', /word\(runtime::MachinePhase value\)[^}]*\}/],
    ['mode', 'hmi_bridge/words/words.cpp', /word\(runtime::Mode value\)[^}]*\}/],
    ['program', 'hmi_bridge/words/words.cpp', /word\(runtime::ProgramState value\)[^}]*\}/],
    ['bus', 'hmi_bridge/words/words.cpp', /word\(ecat::Master::Phase value\)[^}]*\}/],
    ['limiter', 'hmi_bridge/words/words.cpp', /word\(axes::VelocityLimiter value\)[^}]*\}/],
    ['reaction', 'hmi_bridge/words/words.cpp', /word\(Reaction value\)[^}]*\}/],
    ['axis', 'axes/words/types.cpp', /name\(AxisState state\)[^}]*\}/],
    ['owner', 'axes/words/types.cpp', /name\(Owner owner\)[^}]*\}/],
    ['drive', 'axes/port/names.cpp', /name\(PowerState state\)[^}]*\}/],
    ['drivemode', 'axes/port/names.cpp', /name\(DriveMode mode\)[^}]*\}/],
    ['brake', 'hmi_bridge/words/words.cpp', /word\(axes::BrakeState value\)[^}]*\}/],
    ['effective', 'hmi_bridge/socket/machine_questions.cpp', /word\(axes::ParameterEffect effect\)[^}]*\}/],
    ['change', 'hmi_bridge/socket/machine_questions.cpp', /word\(axes::ParameterChange change\)[^}]*\}/],
    ['dc', 'ecat/dc/cycle_servo.cpp', /name\(DcLock lock\)[^}]*\}/],
    ['ring', 'ecat/ring/ring_state.hpp', /name\(RingShape shape\)[^}]*\}/],
    ['measure_doubt', 'axes/measuring/quality.hpp', /word\(Doubt doubt\)[^}]*\}/],
];
for (const [group, file, where] of groups)
    test(`each word of ${file} is in the table as ${group}`, () => {
        const body = where.exec(readFileSync(join(source, file), 'utf8'))?.[0] ?? '';
        const words = [...body.matchAll(/case [^:]+(?:::[^:]+)*: return "([^"]+)"/g)].map((m) => m[1]);
        assert.ok(words.length >= 3, `${file}: the function was not found`);
        for (const word of words) assert.ok(Object.hasOwn(texts, `${group}_${word}`), `${group}_${word}`);
    });

// A table each, in the order of the enumerators.
for (const [group, file, where] of [['group', 'axes/group/axis_group.cpp', /name\(GroupState state\)[^}]*\}/], ['limiter', 'axes/group/group_words.cpp', /name\(PathLimiter limiter\)[^}]*\}/]] as const)
    test(`each word of ${file} is in the table as ${group}`, () => {
        const words = [...(where.exec(readFileSync(join(source, file), 'utf8'))?.[0] ?? '').matchAll(/"([^"]+)"/g)].map((m) => m[1]);
        assert.ok(words.length >= 4, `${file}: the function was not found`);
        for (const word of words) assert.ok(Object.hasOwn(texts, `${group}_${word}`), `${group}_${word}`);
    });

test('no text stands in the pages themselves', () => {
    const folder = join(source, 'hmi_bridge/page/source');
    const files = (readdirSync(folder, { recursive: true }) as string[]).filter((file) => file.endsWith('.ts') && !file.startsWith('texts'));
    for (const file of files) {
        const text = readFileSync(join(folder, file), 'utf8');
        // A child of an element that is a literal with a word in it.
        for (const found of text.matchAll(/element\('\w+', \{[^{}]*\}, '([^']*[A-Za-z]{2}[^']*)'/g)) assert.fail(`${file}: ${found[1]}`);
    }
});

test('the page is smaller than 200 kB compressed', () => {
    const folder = join(process.env['TAKTWERK_BUILD'] ?? '', 'hmi_page/page');
    const files = readdirSync(folder).filter((f) => statSync(join(folder, f)).isFile());
    assert.ok(files.includes('page.js') && files.includes('page.css') && files.includes('index.html'));
    const bytes = files.reduce((sum, f) => sum + gzipSync(readFileSync(join(folder, f))).length, 0);
    assert.ok(bytes < 200_000, `${bytes} bytes`);
});

test('the lock file names no registry', () => {
    const lock = readFileSync(join(source, 'hmi_bridge/page/package-lock.json'), 'utf8');
    assert.doesNotMatch(lock, /"resolved"|https?:\/\//);
});

test('numbers as a person reads and types them', () => {
    assert.equal(fixed(-0.0001), '0.000');
    assert.equal(fixed(-12.5), '−12.500');
    assert.equal(fixed('-Infinity'), '−∞');
    assert.equal(fixed('NaN'), '–');
    assert.equal(span_of(88_200), '88.2 µs');
    assert.equal(span_of(9_999_000), '9999 µs');
    assert.equal(span_of(508_844_000), '508.8 ms');
    assert.equal(typed('12,5'), 12.5);
    assert.equal(typed('−3'), -3);
    for (const wrong of ['', '1 2', '0x10', '1,2,3', 'Infinity', 'e5', '.']) assert.ok(Number.isNaN(typed(wrong)), wrong);
});
