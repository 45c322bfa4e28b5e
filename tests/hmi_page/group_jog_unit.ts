// The jog pad of a group: which directions it has, and why it may not be pressed.
import assert from 'node:assert/strict';
import test from 'node:test';
import { directions_of, why_not_jog } from '@page/group/jog_pad';
import { GroupLayout, GroupState, MachineState } from '@page/state';
import { choose_language, say } from '@page/texts';

const scara: GroupLayout = { name: 'arm', unit: 'mm', members: ['shoulder', 'elbow', 'lift', 'wrist'], arm: true, commands: [true, true, true, false, false, true], setup_velocity: 250 };
const group = { name: 'arm', state: 'GroupStandby', powered: true, members: [{ axis: 'shoulder' }] } as unknown as GroupState;
const machine = (mode: string, owner: string, emergency_stop = false): MachineState => ({ mode, emergency_stop, axes: [{ name: 'shoulder', owner }, { name: 'other', owner: 'program' }] }) as unknown as MachineState;

test('ways of a frame, the turns that the arm has, its axes', () => {
    assert.deepEqual(directions_of(scara, 'mcs'), ['x', 'y', 'z', 'rz']);
    assert.deepEqual(directions_of(scara, 'tcs'), ['x', 'y', 'z', 'rz']);
    assert.deepEqual(directions_of(scara, 'acs'), ['shoulder', 'elbow', 'lift', 'wrist']);
    const plane = { ...scara, commands: [true, true, false, false, false, false] };
    assert.deepEqual(directions_of(plane, 'pcs'), ['x', 'y', 'z'], 'a product may be tilted: its Z can be a way of this arm');
});

test('why nobody may jog it, the nearest reason alone, in both languages', () => {
    assert.equal(why_not_jog(group, machine('manual', 'operator')), '');
    assert.equal(why_not_jog(group, machine('setup', 'operator')), '');
    assert.equal(why_not_jog(group, machine('automatic', 'program')), say('why_automatic'));
    assert.equal(why_not_jog(group, machine('manual', 'program')), say('group_of_a_program'));
    assert.equal(why_not_jog(group, machine('manual', 'operator', true)), say('why_emergency'));
    assert.equal(why_not_jog({ ...group, state: 'GroupErrorStop' }, machine('manual', 'operator')), say('group_in_error'));
    assert.equal(why_not_jog({ ...group, powered: false }, machine('manual', 'operator')), say('group_needs_power'));
    assert.equal(why_not_jog({ ...group, state: 'GroupDisabled' }, machine('manual', 'operator')), say('group_not_enabled'));
    assert.notEqual(why_not_jog({ ...group, state: 'GroupMoving' }, machine('manual', 'operator')), '');
    choose_language('zh');
    try {
        assert.match(why_not_jog({ ...group, powered: false }, machine('manual', 'operator')), /[\u4e00-\u9fff]/);
    } finally {
        choose_language('en');
    }
});
