// The scope without a browser: samples that come, are kept, thinned, measured, written and read again; gaps stay gaps.
import assert from 'node:assert/strict';
import test from 'node:test';
import { Doubles } from '@page/scope/base64';
import { csv_pieces, CsvError, digits, read_csv } from '@page/scope/csv';
import { measured, rate_between, time_text, value_text } from '@page/scope/cursors';
import { draw_curve } from '@page/scope/curve';
import { lanes_of, next_range } from '@page/scope/lanes';
import { Live, load, Reader } from '@page/scope/pull';
import { empty_setup, from_text, SavedSetups, to_text } from '@page/scope/setup';
import { bit_of, Channel, Kind, matches, Signal, tree } from '@page/scope/signals';
import { Spans } from '@page/scope/spans';
import { Figures } from '@page/scope/statistics';
import { capacity_for, Store } from '@page/scope/store';
import { Columns, runs, thin } from '@page/scope/thin';
import { arm_request, first_trigger, next_event, status_of, trouble } from '@page/scope/trigger';
import { View } from '@page/scope/view';
import { base64, FakeScope } from './scope_fake';

const signal = (name: string, unit = '', kind: Kind = 'real', group = 'axis'): Signal => ({ name, unit, kind, group, of: name.split('.')[0] ?? '', en: name.replace('.', ' '), zh: '' });
const channel = (name: string, more: Partial<Channel> = {}): Channel => ({ name, offset: 0, hidden: false, colour: 0, apart: false, ...more });
const filled = (name: string, from: number, values: number[], capacity = 1000): Store => {
    const store = new Store(capacity);
    store.put(name, from, Float64Array.from(values));
    return store;
};

test('base64 gives the same doubles, whatever they are', () => {
    const values = [0, -0, 1, -1.5, 0.1 + 0.2, NaN, Infinity, -Infinity, Number.MIN_VALUE, Number.MAX_VALUE, 1 / 3];
    const doubles = new Doubles();
    for (let n = 0; n <= values.length; n++) {
        const got = doubles.decode(base64(values.slice(0, n)));
        assert.deepEqual([...got], values.slice(0, n));
    }
    assert.equal(Object.is(doubles.decode(base64([-0]))[0], -0), true);
    const many = Array.from({ length: 100_000 }, (_, i) => Math.sin(i));
    assert.deepEqual([...doubles.decode(base64(many))], many);
});

test('spans: what touches becomes one, holes are what is between', () => {
    const spans = new Spans();
    for (const [from, to] of [[10, 20], [30, 40], [20, 25], [50, 60], [39, 51], [5, 5]] as const) spans.add(from, to);
    assert.deepEqual(spans.list, [{ from: 10, to: 25 }, { from: 30, to: 60 }]);
    assert.deepEqual(spans.holes(0, 70), [{ from: 0, to: 10 }, { from: 25, to: 30 }, { from: 60, to: 70 }]);
    assert.deepEqual(spans.holes(12, 20), []);
    assert.ok(spans.has(24) && !spans.has(25) && spans.has(30, 60) && !spans.has(20, 31));
    spans.cut(35);
    assert.deepEqual(spans.list, [{ from: 35, to: 60 }]);
    spans.add(0, 100);
    assert.deepEqual(spans.list, [{ from: 0, to: 100 }]);
});

test('the store keeps the newest and forgets the oldest; a hole stays a hole', () => {
    const store = filled('a', 0, [0, 1, 2, 3, 4, 5], 8);
    store.put('a', 8, Float64Array.from([8, 9, 10]));
    assert.equal(store.oldest, 3);
    assert.deepEqual([...store.copy('a', 0, 11)], [NaN, NaN, NaN, 3, 4, 5, NaN, NaN, 8, 9, 10]);
    assert.ok(Number.isNaN(store.at('a', 2)) && store.at('a', 3) === 3 && Number.isNaN(store.at('a', 6)));
    store.put('a', 6, Float64Array.from([6, 7]));  // filled behind
    assert.deepEqual([...store.copy('a', 3, 11)], [3, 4, 5, 6, 7, 8, 9, 10]);
    store.put('b', 0, Float64Array.from([0, 1, 2, 3, 4]));  // most of it too old
    assert.deepEqual([...store.copy('b', 0, 6)], [NaN, NaN, NaN, 3, 4, NaN]);
    store.keep(['a'], 4);
    assert.deepEqual([...store.copy('a', 3, 11)], [NaN, NaN, NaN, NaN, 7, 8, 9, 10]);
    assert.ok(!store.tracks.has('b'));
});

test('memory is bounded: 32 signals at 1 kHz take at most 96 MiB, and 20 s are always kept', () => {
    for (const signals of [1, 8, 32, 33, 256]) {
        assert.ok(capacity_for(signals, 1e6) * signals * 8 <= 96 * 1024 * 1024);
        assert.ok(capacity_for(signals, 1e6) >= 20_000);
    }
});

test('thinned curves keep each spike, and a column that lacks a cycle is a gap', () => {
    const values = Array.from({ length: 1000 }, () => 1);
    values[345] = 99;
    values[346] = -99;
    const store = filled('a', 0, values.slice(0, 700)), columns = new Columns();
    store.put('a', 703, Float64Array.from(values.slice(703)));
    thin(columns, store.tracks.get('a'), store.capacity, 0, 1000, 100, store.newest);
    assert.equal(columns.per, 10);
    assert.equal(Math.max(...[...columns.high.subarray(0, columns.count)].filter((v) => !Number.isNaN(v))), 99);
    assert.equal(columns.low[34], -99);
    assert.deepEqual([...columns.low.subarray(69, 72)], [1, NaN, 1]);  // [700, 703) is missing
    // Every sample where there is a pixel for it, at its own cycle.
    thin(columns, store.tracks.get('a'), store.capacity, 340.5, 349.5, 100, store.newest);
    assert.deepEqual([columns.per, columns.start, columns.count], [1, 340, 10]);
    assert.deepEqual([...columns.low.subarray(0, 10)], [1, 1, 1, 1, 1, 99, -99, 1, 1, 1]);
    // Rolling on by one cycle moves no column: they begin at multiples of their length.
    thin(columns, store.tracks.get('a'), store.capacity, 7, 507, 50, store.newest);
    const start = columns.start;
    thin(columns, store.tracks.get('a'), store.capacity, 8, 508, 50, store.newest);
    assert.equal(columns.start, start);
    // Behind the newest cycle there is no gap, only nothing yet.
    thin(columns, store.tracks.get('a'), store.capacity, 990, 1010, 2, store.newest);
    assert.deepEqual([...columns.low.subarray(0, 2)], [1, NaN]);
});

test('a stroke is broken at a gap: never a line across', () => {
    const store = filled('a', 0, [1, 2, 3]), columns = new Columns();
    store.put('a', 5, Float64Array.from([4, NaN, 5]));
    thin(columns, store.tracks.get('a'), store.capacity, 0, 8, 100, store.newest);
    const strokes: string[] = [];
    draw_curve({ moveTo: (x, y) => strokes.push(`M${x},${y}`), lineTo: (x, y) => strokes.push(`L${x.toFixed(0)},${y}`) }, columns, { left: 0, top: 0, width: 8, height: 10, from: 0, to: 8, min: 0, max: 10 }, 0, false);
    assert.deepEqual(strokes, ['M0,9', 'L0,9', 'L1,8', 'L2,7', 'M5,6', 'L5,6', 'M7,5', 'L7,5']);
});

test('bands: one run a value, several short ones are put together, a gap is in none', () => {
    const store = filled('s', 0, [1, 1, 1, 1, 2, 2, 2, 2, 1, 2, 1, 2, 3, 3, 3, 3]);
    store.put('s', 20, Float64Array.from([3, 3]));
    const track = store.tracks.get('s');
    assert.deepEqual(runs(track, store.capacity, 0, 22, 1).map((r) => [r.from, r.to, r.value]), [[0, 4, 1], [4, 8, 2], [8, 9, 1], [9, 10, 2], [10, 11, 1], [11, 12, 2], [12, 16, 3], [20, 22, 3]]);
    const coarse = runs(track, store.capacity, 0, 22, 3);
    assert.deepEqual(coarse.map((r) => [r.from, r.to, r.many]), [[0, 4, false], [4, 8, false], [8, 12, true], [12, 16, false], [20, 22, false]]);
    assert.deepEqual(runs(filled('w', 0, [4, 5, 2]).tracks.get('w'), 1000, 0, 3, 1, 2).map((r) => [r.from, r.to, r.value]), [[0, 2, 1], [2, 3, 0]]);
});

test('bits of a word, negative ones too', () => {
    assert.deepEqual([0, 1, 2, 15].map((bit) => bit_of(0x8005, bit)), [1, 0, 1, 1]);
    assert.equal(bit_of(-1, 31), 1);
    assert.equal(bit_of(-2, 0), 0);
    assert.ok(Number.isNaN(bit_of(NaN, 3)));
});

test('lanes: mm with mm, mm/s with mm/s, bits and states below, one apart', () => {
    const known = new Map([signal('x.p', 'mm'), signal('y.p', 'mm'), signal('x.v', 'mm/s'), signal('x.state', '', 'state'), signal('in', '', 'bit'), signal('x.word', '', 'word')].map((s) => [s.name, s]));
    const lanes = lanes_of([channel('in'), channel('x.p'), channel('x.v'), channel('y.p'), channel('x.state'), channel('x.word'), channel('x.word', { bit: 3 }), channel('x.p', { apart: true })], (n) => known.get(n));
    assert.deepEqual(lanes.map((l) => [l.key, l.channels.map((c) => c.name).join()]), [['[mm]', 'x.p,y.p'], ['[mm/s]', 'x.v'], ['[word]', 'x.word'], ['x.p', 'x.p'], ['bands', 'in,x.state,x.word']]);
});

test('an automatic scale grows at once and does not tremble', () => {
    const first = next_range(undefined, 0, 100);
    assert.ok(first.min < 0 && first.max > 100);
    assert.equal(next_range(first, 5, 95), first);
    assert.ok(next_range(first, 0, 200).max > 200);
    assert.ok(next_range(first, 40, 60).max < 70);
    assert.ok(next_range(undefined, 5, 5).max > 5);
    const trembling = next_range(undefined, 1000, 1000 + 1e-9);
    assert.ok(trembling.max - trembling.min > 0.009 && trembling.max - trembling.min < 0.011);
});

test('figures, against a calculation by hand', () => {
    const figures = new Figures();
    figures.add(Float64Array.from([2, 4, 4, 4]));
    figures.add(Float64Array.from([5, 5, 7, 9, NaN]));
    // mean 40/8; squares of the differences 9+1+1+1+0+0+4+16 = 32, /8 = 4; squares 4+16*3+25*2+49+81 = 232, /8 = 29
    assert.deepEqual(figures.of(10), { count: 8, missing: 2, min: 2, max: 9, mean: 5, rms: Math.sqrt(29), peak_to_peak: 7, deviation: 2 });
    const ripple = new Figures();
    ripple.add(Float64Array.from([1e9 + 1, 1e9 - 1, 1e9 + 1, 1e9 - 1]));
    assert.equal(ripple.of().deviation, 1);
    const shifted = new Figures();
    shifted.add(Float64Array.from([1, 3]), 10);
    assert.deepEqual([shifted.of().mean, shifted.of().min], [12, 11]);
    assert.ok(Number.isNaN(new Figures().of().mean));
});

test('cursors: difference, rate, what the figures are about, times with as many digits as a cycle has', () => {
    assert.equal(rate_between(1, 1.25), 4);
    assert.equal(rate_between(5, 5), Infinity);
    assert.deepEqual(measured({ shown: true, a: 20, b: 10 }, 0, 100), { from: 10, to: 21 });
    assert.deepEqual(measured({ shown: false, a: 20, b: 10 }, 0.5, 100.5), { from: 1, to: 100 });
    assert.equal(time_text(12.3456, 1e6), '12.346 s');
    assert.equal(time_text(-0.0125, 250_000), '−12.5 ms');
    assert.equal(value_text(-0.30000000000000004), '−0.30000000000000004');
});

test('live: every cycle comes once, what was missed is fetched while the machine has it, what is gone stays a gap', async () => {
    const machine = new FakeScope([signal('a'), signal('b')], { a: (c) => c, b: (c) => -c });
    machine.depth = 5000;
    machine.pass(10_000);
    const store = new Store(50_000), reader = new Reader(machine.ask, undefined, store, 1e6), live = new Live(reader);
    reader.extent = { first: machine.first, last: machine.last };
    live.names = ['a', 'b'];
    for (let i = 0; i < 20; i++) {
        await live.step();
        machine.pass(70);
    }
    await live.step();
    assert.equal(store.newest, machine.last + 1);
    assert.equal(store.tracks.get('a')?.have.list.length, 1);
    assert.ok(store.has('a', 5001, machine.last + 1), 'the past that the machine had');
    assert.deepEqual([...store.copy('b', 9990, 10_010)], Array.from({ length: 20 }, (_, i) => -9990 - i));
    // Away for less than what the machine keeps: nothing is lost.
    machine.pass(4000);
    for (let i = 0; i < 3; i++) await live.step();
    assert.equal(store.tracks.get('a')?.have.list.length, 1);
    // Away for longer: a gap, as long as what is gone, and it is not asked for again and again.
    const before = machine.last;
    machine.pass(9000);
    for (let i = 0; i < 5; i++) await live.step();
    assert.deepEqual(store.tracks.get('a')?.have.holes(before, machine.last + 1), [{ from: before + 1, to: machine.first }]);
    const asked = machine.asked.length;
    await live.step();
    assert.equal(machine.asked.length, asked + 1);
    // A signal chosen later gets the past that is still there.
    live.names = ['a', 'b', 'c'];
    machine.values['c'] = (c) => 2 * c;
    for (let i = 0; i < 3; i++) await live.step();
    assert.ok(store.has('c', machine.first, machine.last + 1));
    assert.equal(store.at('c', machine.first), 2 * machine.first);
});

test('a machine that began anew is told, and nothing of it is mixed with the old', async () => {
    const machine = new FakeScope([signal('a')], { a: (c) => c });
    machine.pass(1000);
    const store = new Store(50_000), reader = new Reader(machine.ask, undefined, store, 1e6), live = new Live(reader);
    reader.extent = { first: machine.first, last: machine.last };
    live.names = ['a'];
    await live.step();
    let told = 0;
    reader.on_restart = () => told++;
    machine.last = 10;
    machine.first = 0;
    await live.step();
    assert.equal(told, 1);
    assert.equal(store.newest, 1001);
    // One that has run as long meanwhile is told by its time.
    machine.last = 2000;
    machine.zero_ns = 60e9;
    reader.extent = { first: 0, last: 1000 };
    await live.step();
    assert.equal(told, 2);
    assert.equal(store.newest, 1001);
});

test('what was overwritten while it was read came as NaN, and is a gap; a NaN that the machine has is none', async () => {
    const store = new Store(100);
    let missing = 0;
    const reader = new Reader(() => Promise.resolve({ ok: true, from: 10, to: 15, per: 1, first: 10, last: 14, time_ns: 10e6, missing, data: [base64([1, 2, NaN, NaN, 5])] }), undefined, store, 1e6);
    await reader.read(['a'], 10, 15);
    assert.ok(store.has('a', 10, 15) && Number.isNaN(store.at('a', 12)));
    missing = 2;
    await reader.read(['b'], 10, 15);
    assert.deepEqual(store.tracks.get('b')?.have.list, [{ from: 10, to: 12 }, { from: 14, to: 15 }]);
});

test('more than 64 signals are asked for in several questions, all up to the same cycle', async () => {
    const names = Array.from({ length: 100 }, (_, i) => `s${i}`);
    const machine = new FakeScope(names.map((n) => signal(n)), Object.fromEntries(names.map((n, i) => [n, (c: number) => c * 1000 + i])));
    machine.pass(20_000);
    const store = new Store(20_001), reader = new Reader(machine.ask, undefined, store, 1e6);
    assert.ok(await load(reader, names, 1, 20_001));
    for (const [i, name] of names.entries()) {
        assert.ok(store.has(name, 1, 20_001), name);
        assert.equal(store.at(name, 20_000), 20_000_000 + i);
    }
    for (const request of machine.asked) {
        const cycles = Number(request['to']) - Number(request['from']), signals = (request['signals'] as string[]).length;
        assert.ok(signals <= 64 && cycles * signals <= 24_000);
    }
});

test('digits as the trace writes them', () => {
    // What std::format's {} gives for these doubles.
    const known: [number, string][] = [[0.1 + 0.2, '0.30000000000000004'], [1e-5, '1e-05'], [1.5e-7, '1.5e-07'], [0.0001, '0.0001'], [-2.5, '-2.5'], [1e100, '1e+100'], [1e16, '1e+16'], [42, '42'], [-0, '0'], [NaN, 'nan'], [-Infinity, '-inf']];
    for (const [value, text] of known) assert.equal(digits(value), text);
});

test('CSV: written and read again it is the same, gaps included', () => {
    const store = new Store(100);
    store.put('x.p', 10, Float64Array.from([0.1, 1 / 3, NaN]));
    store.put('x.p', 15, Float64Array.from([4, 5e-9]));
    store.put('bit', 10, Float64Array.from([0, 1, 1]));
    const text = [...csv_pieces(store, [{ name: 'x.p', unit: 'mm' }, { name: 'bit', unit: '' }], 10, 17, (cycle) => cycle / 1000)].join('');
    assert.equal(text, 'time_s,x.p[mm],bit\n0.01,0.1,0\n0.011,0.3333333333333333,1\n0.012,nan,1\n0.015,4,nan\n0.016,5e-09,nan\n');
    const file = read_csv(text, () => undefined);
    assert.deepEqual([file.cycle_ns, file.to, file.start_s], [1e6, 7, 0.01]);
    assert.deepEqual([...file.store.copy('x.p', 0, 7)], [0.1, 1 / 3, NaN, NaN, NaN, 4, 5e-9]);
    assert.ok(file.store.has('x.p', 2) && !file.store.has('x.p', 3));
    assert.deepEqual(file.signals.map((s) => [s.name, s.unit, s.of]), [['x.p', 'mm', 'x'], ['bit', '', '']]);
});

test('CSV that is none is told with its line', () => {
    const wrong = (text: string): [string, number] => {
        try {
            read_csv(text, () => undefined);
        } catch (e) {
            return [(e as CsvError).trouble, (e as CsvError).line];
        }
        return ['', 0];
    };
    assert.deepEqual(wrong(''), ['empty', 0]);
    assert.deepEqual(wrong('time_s,a\n0,1\n'), ['empty', 2]);
    assert.deepEqual(wrong('t,a\n0,1\n1,2\n'), ['no_time', 1]);
    assert.deepEqual(wrong('time_s,a\n0,1\n0.001\n'), ['columns', 3]);
    assert.deepEqual(wrong('time_s,a\n0,1\n0.001,x\n'), ['number', 3]);
    assert.deepEqual(wrong('time_s,a\n0,1\n0,2\n'), ['backwards', 3]);
    assert.deepEqual(wrong('time_s,a,a\n0,1,1\n1,2,2\n'), ['doubled', 1]);
    const bits = read_csv('time_s,in\n0,0\n0.00025,1\n', () => undefined);
    assert.deepEqual([bits.cycle_ns, bits.signals[0]?.kind], [250_000, 'bit']);
});

test('a trigger becomes what the machine is asked for', () => {
    const trigger = { ...first_trigger(), signal: 'in' };
    assert.deepEqual(arm_request(trigger, 1e6), { cmd: 'scope_arm', when: { kind: 'rising', signal: 'in', level: 0.5 }, pre: 200, post: 800, mode: 'single', holdoff: 0 });
    assert.deepEqual(arm_request({ ...trigger, kind: 'inside', level: -1, level2: 1, mode: 'normal', holdoff_s: 0.5, length_s: 2, before_percent: 50 }, 250_000),
        { cmd: 'scope_arm', when: { kind: 'inside', signal: 'in', level: -1, level2: 1 }, pre: 4000, post: 4000, mode: 'normal', holdoff: 2000 });
    assert.deepEqual(arm_request({ ...trigger, kind: 'bit', bit: 10 }, 1e6)['when'], { kind: 'bit', signal: 'in', bit: 10 });
    assert.deepEqual(arm_request({ ...trigger, kind: 'alarm' }, 1e6)['when'], { kind: 'alarm', alarm: '' });
    assert.equal(arm_request({ ...trigger, before_percent: 100 }, 1e6)['post'], 1);
    const known = (name: string): boolean => name === 'in';
    assert.equal(trouble(trigger, known), undefined);
    assert.equal(trouble({ ...trigger, signal: 'out' }, known), 'scope_trigger_no_signal');
    assert.equal(trouble({ ...trigger, kind: 'alarm', signal: '' }, known), undefined);
    assert.equal(trouble({ ...trigger, level: NaN }, known), 'scope_trigger_no_number');
    assert.equal(trouble({ ...trigger, kind: 'outside', level: 2, level2: 1 }, known), 'scope_trigger_order');
    assert.equal(trouble({ ...trigger, kind: 'bit', bit: 1.5 }, known), 'scope_trigger_bit_range');
    assert.equal(trouble({ ...trigger, length_s: 0 }, known), 'scope_trigger_length');
});

test('what came of a trigger: the newest whole event, shown once', () => {
    const event = (cycle: number, complete: boolean) => ({ cycle, from: cycle - 10, to: cycle + 10, complete, automatic: false });
    const state = { armed: true, looked_to: 500, events: [event(100, true), event(200, true), event(490, false)] };
    assert.equal(next_event(state, -1)?.cycle, 200);
    assert.equal(next_event(state, 200), undefined);
    assert.equal(status_of(undefined), 'off');
    assert.equal(status_of(state), 'filling');
    assert.equal(status_of({ armed: true, looked_to: 1, events: [] }), 'waiting');
    assert.equal(status_of({ armed: false, looked_to: 1, events: [event(1, true)] }), 'triggered');
});

test('signals are found by words of their name, unit or meaning, in either language', () => {
    const x = { ...signal('x.set_position', 'mm'), en: 'set position', zh: '设定位置' };
    assert.ok(matches(x, 'pos X') && matches(x, '设定') && matches(x, 'mm') && matches(x, '') && !matches(x, 'pos y'));
    const branches = tree([signal('in', '', 'bit', 'input'), x, signal('y.p', 'mm'), signal('new', '', 'real', 'unheard')], '');
    assert.deepEqual(branches.map((b) => [b.group, b.of]), [['axis', 'x'], ['axis', 'y'], ['input', ''], ['unheard', 'new']]);
});

test('a set-up comes back as it was; a stranger\'s is looked at, key by key', () => {
    const setup = { ...empty_setup(), channels: [channel('x.p', { offset: 2.5, colour: 3, apart: true }), channel('w', { bit: 4, hidden: true })], scales: { '[mm]': { min: -1, max: 5 } }, span_s: 2 };
    assert.deepEqual(from_text(to_text(setup)), setup);
    for (const bad of ['', '[]', '{}', 'null', '{"taktwerk_scope":2,"channels":[]}', '{"taktwerk_scope":1}']) assert.equal(from_text(bad), undefined);
    const strange = from_text('{"taktwerk_scope":1,"channels":[{"name":7},{"name":"a","bit":-1,"offset":"x","colour":1e9}],"scales":{"m":{"min":5,"max":1}},"span_s":1e99,"trigger":{"kind":"bang","level":null}}');
    assert.deepEqual(strange?.channels, [channel('a')]);
    assert.deepEqual(strange?.scales, {});
    assert.equal(strange?.span_s, 3600);
    assert.deepEqual(strange?.trigger, first_trigger());
    const kept = new Map<string, string>();
    const saved = new SavedSetups({ getItem: (k) => kept.get(k) ?? null, setItem: (k, v) => void kept.set(k, v) });
    assert.ok(saved.save('mine', setup));
    assert.deepEqual(saved.list().get('mine'), setup);
    saved.remove('mine');
    assert.equal(saved.list().size, 0);
    const full = new SavedSetups({ getItem: () => { throw new Error('no'); }, setItem: () => { throw new Error('full'); } });
    assert.equal(full.save('mine', setup), false);
    assert.equal(full.last, undefined);
});

test('a view that follows keeps its right edge, one that stands is zoomed about the pointer', () => {
    const view = new View(1e6, 10);
    view.tie(50_000);
    assert.deepEqual([view.from, view.to], [40_000, 50_000]);
    view.zoom(0.5, 0.2);
    assert.deepEqual([view.from, view.to], [45_000, 50_000]);
    view.move(-1);
    assert.deepEqual([view.follow, view.from, view.to], [false, 40_000, 45_000]);
    view.zoom(0.1, 0.2);
    assert.deepEqual([view.from, view.to], [40_900, 41_400]);
    view.tie(60_000);
    assert.equal(view.to, 41_400);
    for (let i = 0; i < 20; i++) view.zoom(0.1, 0.5);
    assert.equal(Math.round(view.span), 8);
});
