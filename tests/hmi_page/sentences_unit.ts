// What the machine says in English alone has its Chinese on the page: each cause and remedy of the alarm tables and drive files, what refuses a command, and what is
// made of several of them.
import assert from 'node:assert/strict';
import { readFileSync, readdirSync } from 'node:fs';
import { join } from 'node:path';
import test from 'node:test';
import { in_words } from '@page/alarm_words';
import { in_chinese, said, sentences } from '@page/sentences/said';
import { choose_language } from '@page/texts';

const source = process.env['TAKTWERK_SOURCE'] ?? '';
const read = (path: string): string => readFileSync(join(source, path), 'utf8');
const chinese = /[\u4e00-\u9fff]/;
/** The literals of C++, those that stand one behind the other joined. */
const literals = (text: string): string[] => [...text.replace(/"\s*\n\s*"/g, '').matchAll(/"((?:[^"\\\n]|\\.)*)"/g)].map((found) => (found[1] ?? '').replace(/\\"/g, '"'));
const whole = (english: string): void => assert.match(in_chinese(english) ?? '', chinese, `no Chinese for: ${english}`);

// The file, and how many alarms it has at the least: a table that is not found has none.
for (const [file, least] of [['runtime/alarms.hpp', 20], ['axes/axis/alarms.hpp', 30], ['ecat/alarms.hpp', 25], ['modbus/tcp/alarms.hpp', 6]] as const)
    test(`each cause and remedy of ${file}`, () => {
        const rows = read(file).split(/\{id\(\w+::/).slice(1).map(literals);
        assert.ok(rows.length >= least, `${rows.length} alarms`);
        for (const [name, , , cause = '', remedy = ''] of rows) {
            assert.ok(cause !== '' && remedy !== '', `${name}: the table is read wrongly`);
            whole(cause);
            whole(remedy);
        }
    });

test('each cause and remedy of the drive files', () => {
    const folder = join(source, 'config/drives'), files = readdirSync(folder).filter((file) => file.endsWith('.alarms.yaml'));
    assert.ok(files.length >= 6);
    for (const file of files) {
        const found = [...read(`config/drives/${file}`).matchAll(/\b(?:cause|remedy): (?:'((?:[^']|'')*)'|"([^"]*)"|([^,}\n]+))/g)].map((one) => (one[1] ?? one[2] ?? one[3] ?? '').replace(/''/g, "'").trim());
        assert.ok(found.length >= 10, `${file}: ${found.length}`);
        found.forEach(whole);
    }
});

test('what an axis refuses has the Chinese of its table', () => {
    const text = read('axes/axis/error_texts.hpp');
    const rows = text.slice(text.indexOf('error_texts{{')).split(/\{ErrorId::/).slice(1).map(literals);
    assert.ok(rows.length >= 50);
    for (const [, ...words] of rows) for (const i of [0, 1, 2]) assert.equal(in_chinese(words[i] ?? ''), words[i + 3]);
});

// Whole literals that are handed to a person as cause, remedy or what: those made by fmt with the places as `{}`.
for (const [file, least] of [['runtime/machine/alarm_words.cpp', 8], ['hmi_bridge/words/answer_text.cpp', 40], ['hmi_bridge/words/event_text.cpp', 5]] as const)
    test(`each sentence of ${file}`, () => {
        const text = read(file).replace(/"\s*\n\s*"/g, '');
        const found = [...text.matchAll(/\.(?:cause|remedy|what) \+?=\s*(?:[^;"]*?\?\s*|fmt::format\(\s*)?((?:"(?:[^"\\\n]|\\.)*"[^;"]*)+)/g)].flatMap((one) => literals(one[1] ?? '')).filter((one) => /[a-z]{3} [a-z]/i.test(one));
        assert.ok(found.length >= least, `${found.length} sentences`);
        // What only goes behind another sentence is tried with one in front of it.
        for (const sentence of found) whole(/^[ ;,]/.test(sentence) ? `nobody has control${sentence}` : sentence.replace('{}{}', '; else: x').replace(/: $/, ': x').replace(/\{[^}]*\}/g, 'x'));
    });

test('where a path cannot be gone, alone and behind what was refused', () => {
    const found = literals(read('hmi_bridge/words/place_text.cpp')).filter((one) => /[a-z]{3} |at X/.test(one) && !one.includes('/')).map((one) => one.replace(/\{[^}]*\}/g, '12.5'));
    assert.ok(found.length >= 10, `${found.length} sentences`);
    for (const where of found) {
        whole(where);
        const all = in_chinese(`'cell.in' (MC_MovePath) was refused: The path leaves the workspace of the tool (outside_workspace). Where: ${where}`) ?? '';
        assert.match(all, /位置：/);
        assert.doesNotMatch(all, /Where|room|axis |its way|its text/, all);
    }
    const long = in_chinese('MC_MovePath of program cell was refused: The path leaves the workspace of the tool (outside_workspace). Where: it leaves the room \'cell\'; at X 1.000 Y 2.000 Z 3.000 mm (MCS); after 1.000 of 2.000 mm of its way; line 7 of its text') ?? '';
    assert.doesNotMatch(long, /Where|room|its way|its text|leaves/, long);
    assert.match(long, /离开空间“cell”；位于 X 1\.000 Y 2\.000 Z 3\.000 mm（MCS）；已走 1\.000，全程 2\.000 mm；其程序第 7 行/);
});

test('why nothing new comes', () => {
    const found = [...read('hmi_bridge/web/server/feed.hpp').matchAll(/why_ = "([^"]+)"/g)].map((one) => one[1] ?? '');
    assert.ok(found.length >= 3);
    found.forEach(whole);
});

test('sentences that are made of others are Chinese in all their parts', () => {
    assert.equal(in_chinese('MC_MoveAbsolute of the operator was ended: the axis went into ErrorStop (drive_fault)'), '操作员的 MC_MoveAbsolute 被终止：轴进入故障停止（drive_fault）');
    assert.equal(in_chinese('once its cause is gone: press reset or `taktwerk reset y`, in a program MC_Reset'), '原因消失后：对 y 按“复位”，在程序中用 MC_Reset');
    assert.equal(in_chinese('Home the axis. Then MC_Reset, or `taktwerk reset`.'), '回零。然后复位。');
    assert.equal(in_chinese('It still coasts, or a load, a master or a hand turns it, faster than a tenth of the axis\' velocity (12.5 mm/s): power would hold it with a jolt'),
        '电机仍在滑行，或被负载、主轴或人手带动，速度超过轴速度的十分之一（12.5 mm/s）：此时接通动力会产生冲击');
});

test('where on the bus stands behind the text of an alarm', () => {
    choose_language('zh');
    const text = in_words({ english: '3 slaves ...', chinese: "同一电缆后的 3 个从站失去应答:between slave 0 'x' (sv33-e) port 1 and slave 1 'y' (sv33-e)" });
    choose_language('en');
    assert.equal(text, "同一电缆后的 3 个从站失去应答:在 从站 0 'x' (sv33-e) 端口 1 与 从站 1 'y' (sv33-e) 之间");
});

test('what nobody knows stays as it came, and says that it is English', () => {
    choose_language('zh');
    assert.deepEqual(said('The moon is full (again)'), { text: 'The moon is full (again)', known: false });
    assert.equal(said('Home the axis').known, true);
    choose_language('en');
    assert.deepEqual(said('Home the axis'), { text: 'Home the axis', known: true });
});

test('each sentence is Chinese, and has the places of the English one', () => {
    const places = (text: string): number => [...text.matchAll(/\{\w?\}/g)].length;
    for (const [english, text] of Object.entries(sentences)) {
        if (/[a-z]{2}/i.test(english.replace(/\{\w?\}/g, ''))) assert.match(text, chinese, english);
        assert.equal(places(text), places(english), english);
    }
});
