// What is done with the scope's samples: lanes, figures, cursors, files, triggers, set-ups; numbers against calculations by hand.
import assert from 'node:assert/strict';
import test from 'node:test';
import { csv_pieces, CsvError, digits, read_csv } from '@page/scope/csv';
import { measured, rate_between, time_text, value_text } from '@page/scope/cursors';
import { lanes_of, next_range } from '@page/scope/lanes';
import { empty_setup, from_text, SavedSetups, to_text } from '@page/scope/setup';
import { Channel, Kind, matches, Signal, tree } from '@page/scope/signals';
import { Figures } from '@page/scope/statistics';
import { Store } from '@page/scope/store';
import { arm_request, first_trigger, next_event, status_of, trouble } from '@page/scope/trigger';
import { time_ticks } from '@page/scope/time_ticks';
import { View } from '@page/scope/view';

const signal = (name: string, unit = '', kind: Kind = 'real', group = 'axis'): Signal => ({ name, unit, kind, group, of: name.split('.')[0] ?? '', en: name.replace('.', ' '), zh: '' });
const channel = (name: string, more: Partial<Channel> = {}): Channel => ({ name, offset: 0, hidden: false, colour: 0, apart: false, ...more });

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

test('round times stand where their cycles are, on a machine that is late as well', () => {
    const even = time_ticks(1000.5, 3000.5, 4, (cycle) => cycle / 1000, 0.001);
    assert.equal(even.step, 0.5);
    assert.deepEqual(even.ticks.map((t) => [Math.round(t.cycle * 1e6) / 1e6, t.seconds]), [[1500, 1.5], [2000, 2], [2500, 2.5], [3000, 3]]);
    // From cycle 2000 on half a second late: 2.2 s fell into the gap, 2.5 s is cycle 2000 again.
    const late = time_ticks(1000, 3000, 12, (cycle) => (cycle < 2000 ? cycle : cycle + 500) / 1000, 0.001);
    assert.equal(late.step, 0.5);
    assert.deepEqual(late.ticks.map((t) => [Math.round(t.cycle * 1e6) / 1e6, t.seconds]), [[1000, 1], [1500, 1.5], [2000, 2], [2000, 2.5], [2500, 3], [3000, 3.5]]);
    // Counted from a trigger; zoomed in between two cycles.
    assert.deepEqual(time_ticks(0, 10, 10, (cycle) => 5 + cycle / 1000, 0.001, 5.004).ticks.map((t) => Math.round(t.seconds * 1e6)), [-4000, -3000, -2000, -1000, 0, 1000, 2000, 3000, 4000, 5000, 6000]);
    assert.deepEqual(time_ticks(5, 5, 10, (cycle) => cycle, 1).ticks, []);
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
