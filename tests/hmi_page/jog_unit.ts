// A jog begins with one press and each ending lets it go, once.
import assert from 'node:assert/strict';
import test from 'node:test';
import { Ending, JogHold, latest_renewal, most_unanswered, renewal } from '@page/jog';

interface Sent {
    axis: string;
    velocity: number;
    press: boolean;
}

class Bench {
    readonly sent: Sent[] = [];
    readonly endings: Ending[] = [];
    now = 1000;
    blocked = false;
    stale = false;
    answers: boolean | undefined = true;  // undefined: none comes
    private step_: (() => void) | undefined;
    readonly hold = new JogHold({
        jog: (axis, velocity, press) => {
            this.sent.push({ axis, velocity, press });
            return this.answers === undefined ? new Promise(() => undefined) : Promise.resolve(this.answers);
        },
        blocked: () => this.blocked,
        stale: () => this.stale,
    }, {
        now: () => this.now,
        every: (period, step) => {
            assert.equal(period, renewal);
            this.step_ = step;
            return () => { this.step_ = undefined; };
        },
    });
    constructor() {
        this.hold.on_end = (ending) => this.endings.push(ending);
    }
    async pass(ms = renewal): Promise<void> {
        this.now += ms;
        this.step_?.();
        await Promise.resolve();
        await Promise.resolve();
    }
    let_go(): number {
        return this.sent.filter((s) => s.velocity === 0).length;
    }
}

test('pressed once, renewed without press, let go with velocity 0', async () => {
    const bench = new Bench();
    assert.ok(bench.hold.press('x', 20));
    await bench.pass();
    await bench.pass();
    bench.hold.end('released');
    await bench.pass();
    assert.deepEqual(bench.sent, [{ axis: 'x', velocity: 20, press: true }, { axis: 'x', velocity: 20, press: false }, { axis: 'x', velocity: 20, press: false }, { axis: 'x', velocity: 0, press: false }]);
    assert.deepEqual(bench.endings, ['released']);
});

test('a second press ends the first and begins nothing', async () => {
    const bench = new Bench();
    bench.hold.press('x', 20);
    assert.ok(!bench.hold.press('y', -20));
    await bench.pass();
    assert.deepEqual(bench.sent, [{ axis: 'x', velocity: 20, press: true }, { axis: 'x', velocity: 0, press: false }]);
    assert.deepEqual(bench.endings, ['second_pointer']);
});

for (const [name, ending, trouble] of [
    ['a connection that takes no bytes', 'socket', (bench: Bench) => { bench.blocked = true; }],
    ['values that are old', 'stale', (bench: Bench) => { bench.stale = true; }],
    ['a refused renewal', 'refused', (bench: Bench) => { bench.answers = false; }],
] as [string, Ending, (bench: Bench) => void][])
    test(`${name} ends it, and nothing presses again`, async () => {
        const bench = new Bench();
        bench.hold.press('x', 20);
        await bench.pass();
        trouble(bench);
        await bench.pass();
        await bench.pass();
        assert.deepEqual(bench.endings, [ending]);
        assert.equal(bench.let_go(), 1);
        const sent = bench.sent.length;
        await bench.pass();
        assert.equal(bench.sent.length, sent);
    });

test('a page that stood still does not go on', async () => {
    const bench = new Bench();
    bench.hold.press('x', 20);
    await bench.pass(latest_renewal);
    assert.deepEqual(bench.endings, []);
    await bench.pass(latest_renewal + 1);
    assert.deepEqual(bench.endings, ['late']);
});

test('a server that does not answer ends it', async () => {
    const bench = new Bench();
    bench.answers = undefined;
    bench.hold.press('x', 20);
    for (let i = 0; i < most_unanswered - 1; i++) await bench.pass();
    assert.deepEqual(bench.endings, []);
    await bench.pass();
    assert.deepEqual(bench.endings, ['unanswered']);
});

test('no press without a connection, on old values, at no velocity; whoever pressed is told', () => {
    for (const [ending, trouble] of [['socket', (bench: Bench) => { bench.blocked = true; }], ['stale', (bench: Bench) => { bench.stale = true; }]] as const) {
        const bench = new Bench();
        trouble(bench);
        assert.ok(!bench.hold.press('x', 20));
        assert.deepEqual(bench.sent, []);
        assert.deepEqual(bench.endings, [ending]);
    }
    const bench = new Bench();
    assert.ok(!bench.hold.press('x', 0));
    assert.ok(!bench.hold.press('x', NaN));
    assert.deepEqual(bench.sent, []);
});
