// What the builder's pages reckon without a browser: how a row shares its columns, how a value is found and written.
import assert from 'node:assert/strict';
import test from 'node:test';
import { MachineState } from '@page/state';
import { ShownValue } from '@page/views/builder_views';
import { doubtful, is_on, number_of, text_of } from '@page/views/reading';
import { spans_of } from '@page/views/spans';

test('widgets take the columns they ask for; the others share what is left, the first ones what does not divide', () => {
    assert.deepEqual(spans_of([undefined, undefined, undefined]), [4, 4, 4]);
    assert.deepEqual(spans_of([undefined, undefined, undefined, undefined, undefined]), [3, 3, 2, 2, 2]);
    assert.deepEqual(spans_of([2, 3, undefined, undefined]), [2, 3, 4, 3]);
    assert.deepEqual(spans_of([7, undefined]), [7, 5]);
    assert.deepEqual(spans_of([12, 12, undefined]), [12, 12, 1], 'more than a row: the grid wraps, and nothing vanishes');
});

const state = {
    mode: 'automatic', emergency_stop: false,
    axes: [{ name: 'x', state: 'Standstill', actual_position: -0.001, homed: true, override: 'NaN' }],
    inputs: { door: 1, tank: 7.25 }, outputs: { lamp: 0 }, doubtful_inputs: ['tank'],
    variables: [{ program: 'cell', name: 'pieces', unit: '', value: 12 }, { program: 'other', name: 'pieces', unit: '', value: 99 }, { program: 'cell', name: 'on', unit: '', value: 1 }],
    parameters: [{ program: 'cell', name: 'pause', unit: 's', value: 0.5 }],
    alarms: [{ standing: true }, { standing: false }],
} as unknown as MachineState;
const shown = (source: ShownValue['source'], of: string, member: string, form: ShownValue['form'] = 'number', whole = false): ShownValue => ({ name: '', source, of, member, form, unit: '', whole });

test('a value is found where it stands, and written as a person reads it', () => {
    assert.equal(number_of(state, shown('variable', 'cell', 'pieces')), 12);
    assert.equal(text_of(state, shown('variable', 'cell', 'pieces', 'number', true)), '12');
    assert.equal(text_of(state, shown('axis', 'x', 'actual_position')), '0.00', 'no minus before zero');
    assert.equal(text_of(state, shown('axis', 'x', 'actual_position'), 3), '−0.001');
    assert.equal(text_of(state, shown('axis', 'x', 'state', 'word')), 'Standstill');
    assert.equal(text_of(state, shown('axis', 'x', 'homed', 'flag')), 'on');
    assert.equal(text_of(state, shown('machine', '', 'mode', 'word')), 'Automatic');
    assert.equal(text_of(state, shown('parameter', 'cell', 'pause')), '0.5');
    assert.equal(number_of(state, shown('machine', '', 'alarms')), 1);
    assert.ok(is_on(state, shown('variable', 'cell', 'on', 'flag')) && !is_on(state, shown('output', 'lamp', '')));
});

test('what is not there, or is no number, is never shown as one', () => {
    assert.equal(text_of(state, shown('variable', 'cell', 'gone')), '–');
    assert.equal(text_of(state, shown('axis', 'q', 'actual_position')), '–');
    assert.equal(text_of(state, shown('axis', 'x', 'override'), 1), '–');
    assert.ok(!is_on(state, shown('input', 'gone', '')), 'a lamp of nothing is dark');
    assert.ok(doubtful(state, shown('input', 'tank', '')) && !doubtful(state, shown('input', 'door', '')));
});
