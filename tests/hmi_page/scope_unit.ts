// The scope's samples without a browser: how they come, are kept, thinned and drawn; gaps stay gaps.
import assert from 'node:assert/strict';
import test from 'node:test';
import { Doubles } from '@page/scope/base64';
import { draw_curve } from '@page/scope/curve';
import { seconds_of } from '@page/scope/cycle_time';
import { another_run, Live, load, Reader } from '@page/scope/pull';
import { bit_of, Kind, Signal } from '@page/scope/signals';
import { Spans } from '@page/scope/spans';
import { capacity_for, Store } from '@page/scope/store';
import { Columns, runs, thin } from '@page/scope/thin';
import { base64, FakeScope } from './scope_fake';

const signal = (name: string, unit = '', kind: Kind = 'real', group = 'axis'): Signal => ({ name, unit, kind, group, of: name.split('.')[0] ?? '', en: name.replace('.', ' '), zh: '' });
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

test('a cycle that is not there counts on from the nearest that is: the machine skipped time', () => {
    const store = new Store(100), at = (cycle: number) => Math.round(seconds_of(store, cycle, 1_000_000, 5e9) * 1e6) / 1e6;
    assert.equal(at(10), 5.01, 'nothing is known');
    store.put('time_s', 10, Float64Array.from([7, 7.001, 9, 9.001]));
    assert.deepEqual([10, 11, 12, 13].map(at), [7, 7.001, 9, 9.001]);
    assert.deepEqual([8, 14, 20].map(at), [6.998, 9.002, 9.008]);
    store.put('time_s', 20, Float64Array.from([12]));
    assert.deepEqual([16, 18, 25].map(at), [9.004, 11.998, 12.005]);
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
    machine.zero_ns = 2e9;
    await live.step();
    assert.equal(told, 1);
    assert.equal(store.newest, 1001);
    // One that has run as long meanwhile is told by its start.
    machine.last = 2000;
    await live.step();
    assert.equal(told, 2);
    assert.equal(store.newest, 1001);
});

test('a machine that is late is no other one', () => {
    const ms = 1e6;
    // 20 s, each tenth cycle skipped a millisecond; the past is fetched behind the present.
    assert.ok(!another_run({ cycle: 18_000, zero_ns: 2000 * ms }, { cycle: 100, zero_ns: 10 * ms }, ms));
    assert.ok(!another_run({ cycle: 100, zero_ns: 10 * ms }, { cycle: 18_000, zero_ns: 99 * ms }, ms));
    assert.ok(!another_run({ cycle: 0, zero_ns: 0 }, { cycle: 500, zero_ns: 1e15 }, ms));
    // Ran for 18 s from 0 to 20 s, started again at 21 s.
    assert.ok(another_run({ cycle: 18_000, zero_ns: 2000 * ms }, { cycle: 5, zero_ns: 21_000 * ms }, ms));
    assert.ok(another_run({ cycle: 18_000, zero_ns: 2000 * ms }, { cycle: 18_100, zero_ns: 21_000 * ms }, ms));
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

test('an answer that is none of this protocol changes nothing', async () => {
    for (const strange of [{}, { data: 'x' }, { data: [7], from: -1, to: 5 }, { data: ['AAAA'], from: 5, to: 1 }, { data: [], from: 1.5, to: 3 }, { data: ['AAAAAAAAAAA='], from: 1, to: 2, per: 4 }]) {
        const store = new Store(100), reader = new Reader(() => Promise.resolve({ ok: true, first: 0, last: 50, ...strange }), undefined, store, 1e6);
        assert.equal(await reader.read(['a'], 1, 10), undefined);
        assert.equal(store.newest, 0);
    }
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
