// The page of a group: who holds it back and why it stopped in words, its path in pixels, what is read of it and how often.
import assert from 'node:assert/strict';
import test from 'node:test';
import { why_not_own } from '@page/group/hand';
import { path_text, window_around } from '@page/group/path_view';
import { Trail } from '@page/group/trail';
import { Answer, Request } from '@page/link';
import { goes_with, held_back, left_to_go, why_error, why_refused } from '@page/pages/group';
import { GroupState, MachineState } from '@page/state';
import { choose_language, say } from '@page/texts';

const group: GroupState = {
    name: 'arm', unit: 'mm', state: 'GroupMoving', interrupted: false, held: false, resetting: false, powered: true, online: true, in_position: false, error: 0,
    members: [{ axis: 'shoulder', ident: 1, unit: 'deg', set_position: 1, actual_position: 1, set_velocity: 0, velocity_use: 0.5, acceleration_use: 1, jerk_use: 0 }],
    tool_known: true, tool_set: [1, 2, 3, 0, 0, 90], tool_actual: [1, 2, 3, 0, 0, 90], tool_speed: 10, tool_actual_speed: 10, path_velocity: 10, path_acceleration: 0, limiter: 'axis_limit', limiting_axis: 'shoulder',
    command: 'MC_MoveLinearAbsolute', block: '', command_id: 4, progress: 0.5, distance_to_go: 5, remaining_s: 0.5, queued: 0, override: 1, operators_override: 1,
};

test('who holds the path back is named', () => {
    assert.equal(held_back(group), say('group_limited_axis', { axis: 'shoulder' }));
    assert.equal(held_back({ ...group, limiter: 'override_factor', limiting_axis: '' }), say('limiter_override_factor'));
    assert.equal(held_back({ ...group, limiter: 'command', limiting_axis: '' }), say('limiter_command'));
});

test('the frame that it goes with is named, and how well it does', () => {
    assert.equal(goes_with(group), '', 'an older runtime says nothing');
    assert.equal(goes_with({ ...group, track: 'none', track_axis: '' }), '');
    const belt = { ...group, track: 'belt', track_axis: 'conveyor', track_in_sync: false, track_lag: 3.16 };
    assert.match(goes_with(belt), /conveyor.*3\.2 mm/);
    assert.doesNotMatch(goes_with({ ...belt, track_in_sync: true }), /3\.2/);
});

test('a way of several axes has a share and no length', () => {
    assert.match(left_to_go({ ...group, path_unit: 'deg' }), /^5\.0 deg/);
    assert.match(left_to_go({ ...group, path_unit: 'u' }), /^50 %/);
});

test('an error is said in the reader\'s language, with what to do', () => {
    assert.deepEqual(why_error(group), []);
    const stopped = { ...group, state: 'GroupErrorStop', error: 0x3001, error_name: 'following_error', error_text: '', error_cause: 'a cause', error_remedy: 'a remedy' };
    assert.deepEqual(why_error(stopped), [say('group_alarm_of_an_axis', { alarm: 'following_error' }), 'a cause', 'a remedy']);
    const of_axis = { ...stopped, error_text: 'following_error of axis elbow' };
    assert.equal(why_error(of_axis)[0], 'following_error of axis elbow');
    choose_language('zh');
    try {
        assert.equal(why_error(of_axis)[0], '轴 elbow 的 following_error');
        assert.equal(why_error({ ...of_axis, error_text: 'An axis was taken out of the group\'s motion, namely axis elbow' })[0], '某个轴脱离了轴组运动，即轴 elbow');
        assert.match(why_error(stopped)[0] ?? '', /[\u4e00-\u9fff]/);
    } finally {
        choose_language('en');
    }
});

test('what it has refused is said with where and what to do, in the reader\'s language', () => {
    assert.deepEqual(why_refused(group), []);
    const refused = {
        ...group, refusal: {
            number: 1, error: 'outside_workspace', text: 'The path leaves the workspace of the tool', command: 'MC_MoveLinearAbsolute', block: 'cell.in',
            remedy: 'Lead the path inside, or around the room; the group\'s `workspace` in the machine file says where the tool\'s point may be',
            where: 'it enters the kept-free room \'post\'; at X 45.000 Y 0.000 Z 12.500 mm (MCS); after 45.000 of 100.000 mm of its way; line 12 of its text',
        },
    };
    assert.match(why_refused(refused)[0] ?? '', /MC_MoveLinearAbsolute \(cell\.in\) was refused: The path leaves/);
    assert.equal(why_refused(refused)[1], refused.refusal.where);
    choose_language('zh');
    try {
        const [what = '', where = '', remedy = ''] = why_refused(refused);
        for (const text of [what, where, remedy]) assert.match(text, /[\u4e00-\u9fff]/);
        assert.equal(where, '进入须保持空闲的空间“post”；位于 X 45.000 Y 0.000 Z 12.500 mm（MCS）；已走 45.000，全程 100.000 mm；其程序第 12 行');
    } finally {
        choose_language('en');
    }
});

test('whose its axes are decides who enables it', () => {
    const machine = { axes: [{ name: 'shoulder', owner: 'program' }, { name: 'other', owner: 'operator' }] } as unknown as MachineState;
    assert.equal(why_not_own(group, machine), say('group_of_a_program'));
    assert.equal(why_not_own(group, { axes: [{ name: 'shoulder', owner: 'operator' }, { name: 'other', owner: 'program' }] } as unknown as MachineState), '');
});

// 100 wide and 50 high in a picture of 200 x 200: the width decides, both directions have its scale, the middle is in the middle.
test('the picture has one scale in both directions', () => {
    const window = window_around([[0, 0], [100, 50]], 200, 200);
    assert.ok(Math.abs(window.scale - 200 / 116) < 1e-12);
    assert.ok(Math.abs(window.from[0] - (50 - 58)) < 1e-9 && Math.abs(window.from[1] - (25 - 58)) < 1e-9);
    const one = window_around([[7, 7]], 200, 100);
    assert.ok(Number.isFinite(one.scale) && one.scale > 0, 'a tool that stands is a place, too');
    assert.ok(Number.isFinite(window_around([], 200, 100).scale));
});

test('points within half a pixel are one, and the last one is drawn', () => {
    assert.equal(path_text([[0, 0], [0.2, 0], [10, 0], [10.1, 0]]), 'M0.0 0.0L10.0 0.0L10.1 0.0');
    assert.equal(path_text([]), '');
});

const base64 = (values: number[]): string => Buffer.from(new Float64Array(values).buffer).toString('base64');

test('of the path each cycle is read once, and what is older than the seconds shown is dropped', async () => {
    const asked: Request[] = [];
    let ok = true;
    const ask = (request: Request): Promise<Answer> => {
        asked.push(request);
        const from = Number(request['from']), cycles = Array.from({ length: Number(request['to']) - from }, (_, i) => from + i);
        return Promise.resolve(ok ? { ok: true, from, to: request['to'], per: 1, data: [cycles, cycles.map(() => 2), cycles.map((cycle) => (cycle === 6003 ? NaN : 3))].map(base64) } : { ok: false });
    };
    const trail = new Trail(ask, 'arm', 1e6);
    await trail.follow(100);
    await trail.follow(100);
    await trail.follow(6050);
    assert.deepEqual(asked.map((request) => [request['from'], request['to']]), [[0, 101], [101, 6051]]);
    assert.deepEqual(asked[0]?.['signals'], ['group.arm.tool_x', 'group.arm.tool_y', 'group.arm.tool_z']);
    assert.equal(trail.points[0]?.cycle, 51, '6 s of 1 ms');
    assert.equal(trail.points.at(-1)?.cycle, 6050);
    assert.deepEqual(trail.points.at(-1)?.at, [6050, 2, 3]);
    assert.ok(!trail.points.some((point) => point.cycle === 6003), 'what is no number is no place');
    await trail.follow(20);
    assert.deepEqual([trail.points[0]?.cycle, trail.points.at(-1)?.cycle], [0, 20], 'a machine that began anew');
    ok = false;
    await trail.follow(30);
    assert.equal(trail.unread, true);
});
