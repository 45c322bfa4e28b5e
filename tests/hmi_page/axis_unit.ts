// Why an axis does not move, its ruler, its lamps, its following error: pure, so each case is one line.
import assert from 'node:assert/strict';
import test from 'node:test';
import { is_old } from '@page/axis/is_old';
import { place_in_window } from '@page/axis/values';
import { range_of, tick_distance } from '@page/axis/ruler';
import { why, why_not_by_hand } from '@page/axis/why';
import { columns_of, BusSlave } from '@page/bus/tree';
import { columns, percentile } from '@page/histograms';
import { same_value } from '@page/axis/drive_parameters';
import { csv } from '@page/save';
import { AxisLayout, AxisState, MachineState } from '@page/state';
import { say } from '@page/texts';

const axis: AxisState = {
    name: 'x', unit: 'mm', state: 'Standstill', owner: 'operator', disabled: false, simulated: false, online: true, powered: true, homed: true, in_position: true, has_job: false, command: '', block: '', held_by_stop: false, queued: 0,
    resetting: false, warning: false, error: 0, drive_error: 0, actual_position: 1, actual_velocity: 0, actual_torque: 0, set_position: 1, set_velocity: 0, set_acceleration: 0, set_jerk: 0, target_position: 1, following_error: 0,
    following_window: 5, velocity_limiter: 'none', override: 1, turns: 0, drive_state: 'operation enabled', drive_mode: 'cyclic position', status_word: 0, negative_limit_switch: false, positive_limit_switch: false, home_switch: false,
};
const machine: MachineState = {
    machine: 'm', cycle: 1, time_ns: 0, phase: 'running', mode: 'manual', emergency_stop: false, simulated: false, statistics: {}, bus: {}, slaves: [], axes: [axis], programs: [], tasks: [], input_units: {}, output_units: {}, inputs: {}, outputs: {},
    doubtful_inputs: [], variables: [], parameters: [], alarms: [], events: [],
};
const alarm = { id: 1, name: 'drive_fault', source: 'axis x', since_ns: 0, count: 1, standing: true, acknowledged: false, reaction: 'stop_axis', english: 'a phase is lost', chinese: '缺相', cause: '', remedy: '', reset: '' };

// The nearest reason comes first: what is further down would not help while it holds.
const reasons: [string, Partial<AxisState>, Partial<MachineState>, string][] = [
    ['nothing is wrong', {}, {}, say('why_idle')],
    ['switched off in the file', { disabled: true, powered: false }, { emergency_stop: true }, say('why_disabled')],
    ['emergency stop', { powered: false, online: false }, { emergency_stop: true }, say('why_emergency')],
    ['an emergency stop that nobody pressed', { powered: false, online: false }, { emergency_stop: true, emergency_stop_unread: true }, say('why_emergency_unread')],
    ['no answer on the bus', { powered: false, online: false, state: 'ErrorStop' }, {}, say('why_offline')],
    ['an error', { state: 'ErrorStop' }, {}, say('why_error')],
    ['held by MC_Stop', { held_by_stop: true, block: 'p.stop' }, {}, say('why_held', { block: ' (p.stop)' })],
    ['no power', { powered: false, drive_state: 'switch-on disabled' }, {}, say('why_no_power')],
    ['the drive is on its way', { powered: false, drive_state: 'switched on' }, {}, say('why_drive_not_up', { state: 'switched on' })],
    ['a command that gives no velocity', { has_job: true, command: 'MC_MoveAbsolute', block: 'p.a' }, {}, say('why_waiting', { command: 'MC_MoveAbsolute', block: ' (p.a)' })],
    ['a program has it', { owner: 'program' }, { mode: 'automatic' }, say('why_program')],
    ['automatic mode', {}, { mode: 'automatic' }, say('why_automatic')],
];
for (const [name, of_axis, of_machine, first] of reasons)
    test(`why it does not move: ${name}`, () => assert.equal(why({ ...axis, ...of_axis }, { ...machine, ...of_machine }).sentences[0], first));

test('an error names its alarms, and only those of this axis', () => {
    const sentences = why({ ...axis, state: 'ErrorStop' }, { ...machine, alarms: [alarm, { ...alarm, source: 'axis y', english: 'another' }, { ...alarm, standing: false, english: 'gone' }] }).sentences;
    assert.deepEqual(sentences, [say('why_error'), 'a phase is lost']);
});

test('an error says what to do, also when its alarm is gone', () => {
    const stopped = { ...axis, state: 'ErrorStop', error: 0x300f, error_name: 'emergency_stop', error_cause: 'The emergency stop was pressed or its circuit is open', error_remedy: 'Remove the danger, release the emergency stop, then reset' };
    assert.deepEqual(why(stopped, machine).sentences, [say('why_error'), stopped.error_cause, stopped.error_remedy]);
    assert.deepEqual(why(stopped, { ...machine, alarms: [{ ...alarm, remedy: 'check the mains' }] }).sentences, [say('why_error'), 'a phase is lost', 'check the mains']);
});

test('a direction that its program forbids is said, while it has power', () => {
    assert.ok(why({ ...axis, enable_positive: false, enable_negative: true }, machine).sentences.includes(say('why_not_positive')));
    assert.ok(why({ ...axis, enable_positive: true, enable_negative: false }, machine).sentences.includes(say('why_not_negative')));
    assert.ok(!why({ ...axis, powered: false, enable_positive: false, enable_negative: false }, machine).sentences.includes(say('why_not_positive')));
});

test('what a drive said last that does not answer is not of now', () => {
    assert.equal(is_old({ ...axis, online: false }), true);
    assert.equal(is_old(axis), false);
    assert.equal(is_old({ ...axis, online: false, disabled: true }), false);
});

test('a moving axis says by what, for whom, and what limits it', () => {
    const said = why({ ...axis, set_velocity: -5, command: 'MC_Jog', velocity_limiter: 'software_limit' }, machine);
    assert.equal(said.title, say('why_velocity'));
    assert.match(said.sentences[0] ?? '', /MC_Jog/);
    assert.match(said.sentences[1] ?? '', /software limit/);
});

test('a hand may command it, or is told why not', () => {
    assert.equal(why_not_by_hand(axis, machine), '');
    assert.equal(why_not_by_hand(axis, { ...machine, mode: 'automatic' }), say('why_automatic'));
    assert.equal(why_not_by_hand({ ...axis, owner: 'program' }, machine), say('why_program'));
    assert.equal(why_not_by_hand(axis, { ...machine, emergency_stop: true, mode: 'automatic' }), say('why_emergency'));
});

const layout: AxisLayout = { name: 'x', unit: 'mm', disabled: false, simulated: false, jog_slow: 1, jog_fast: 2, drive: '', profile: '', drive_axis: 1 };
test('the ruler shows the limits and a little beyond, a turn, or what lies around', () => {
    const limited = range_of({ ...layout, position_min: 0, position_max: 100 }, 50);
    assert.deepEqual([limited.low, limited.high], [0, 100]);
    assert.ok(limited.from < 0 && limited.to > 100);
    assert.deepEqual(range_of({ ...layout, modulo: 360 }, 50), { from: 0, to: 360, low: -Infinity, high: Infinity });
    const free = range_of({ ...layout, position_min: null, position_max: null }, 1234);
    assert.ok(free.from < 1234 && free.to > 1234);
    assert.ok(Number.isFinite(range_of(layout, NaN).from));
});
test('ticks are 1, 2, 5 times a power of ten', () => {
    assert.equal(tick_distance(1000, 10), 100);
    assert.equal(tick_distance(100, 9), 20);
    assert.equal(tick_distance(0.45, 10), 0.05);
});
test('a following error stands within its window', () => {
    assert.equal(place_in_window(0, 5), 0.5);
    assert.equal(place_in_window(-5, 5), 0);
    assert.equal(place_in_window(7, 5), 1);
    assert.equal(place_in_window(1, Infinity), 0.5);  // without supervision there is no window
});

test('a branch of the bus stands a step to the right, the line goes on straight', () => {
    const slave = (position: number, parent: number | null): BusSlave => ({ position, parent, name: `s${position}`, configured: true, device: '', vendor: 0, product: 0, revision: 0, serial: 0, state: 'OP', al_error: false, al_status_code: 0, al_status_text: '', al_status_remedy: '' });
    assert.deepEqual(columns_of([slave(0, null), slave(1, 0), slave(2, 1)]), [0, 0, 0]);
    // 0 is a junction: 1 and 2 hang from one of its ports, 3 goes on.
    assert.deepEqual(columns_of([slave(0, null), slave(1, 0), slave(2, 1), slave(3, 0)]), [0, 1, 1, 0]);
});

test('percentiles and columns of a histogram', () => {
    const times = { count: 100, longest_ns: 1900, longest_cycle: 7, bins: [[100, 199, 98], [1000, 1999, 2]] as [number, number, number][] };
    assert.equal(percentile(times, 0.5), 199);
    assert.equal(percentile(times, 0.98), 199);
    assert.equal(percentile(times, 0.99), 1900);  // never above the longest
    const [low, high] = columns(times, 100, 10_000);
    assert.ok(low && high && low.x === 0 && high.x > low.x && low.height > high.height && high.height > 1);
});

test('values of a drive are compared as numbers where they are', () => {
    assert.ok(same_value('250 ms', '250.0 ms'));
    assert.ok(!same_value('250 ms', '300 ms'));
    assert.ok(same_value('off', 'off'));
    assert.ok(!same_value('off', 'on'));
    assert.ok(!same_value('', '0'));
});

test('CSV: quotes, commas, and nothing that a spreadsheet would carry out', () => {
    assert.equal(csv([['a', 'b,c', 'd"e']]), '\ufeffa,"b,c","d""e"\r\n');
    assert.equal(csv([['=1+1', '-5', '@x']]), "\ufeff'=1+1,-5,'@x\r\n");
});
