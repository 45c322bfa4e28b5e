// A connection that takes no bytes is told from a browser that hands them on a moment later.
import assert from 'node:assert/strict';
import test from 'node:test';
import { Link, stalled_after } from '@page/link';

/** What the browser would give; bytes stay in it until the test says so. */
class Wire {
    static readonly OPEN = 1;
    static newest: Wire;
    readonly readyState = Wire.OPEN;
    bufferedAmount = 0;
    readonly sent: string[] = [];
    onopen: () => void = () => undefined;
    constructor(readonly address: string) {
        Wire.newest = this;
    }
    send(text: string): void {
        this.sent.push(text);
        this.bufferedAmount += text.length;
    }
}
let now = 1000;
Object.assign(globalThis, { WebSocket: Wire, window: { setTimeout: () => 0 }, setTimeout: () => 0 });
performance.now = () => now;

function opened(): [Link, Wire] {
    const link = new Link('ws://here/ws');
    link.open();
    Wire.newest.onopen();
    Wire.newest.bufferedAmount = 0;  // what it says at once has left
    return [link, Wire.newest];
}

test('bytes that wait for a moment are no stalled network; those that stay are', () => {
    const [link, wire] = opened();
    now += 60_000;  // nothing was sent for long
    void link.request({ cmd: 'stop' });
    assert.equal(link.stalled, false);
    now += stalled_after;
    assert.equal(link.stalled, false);
    void link.request({ cmd: 'stop' });  // more behind them makes them no younger
    now += 1;
    assert.equal(link.stalled, true);
    wire.bufferedAmount = 0;
    assert.equal(link.stalled, false);
});

test('they are counted from when they were sent, not from those before them', () => {
    const [link, wire] = opened();
    void link.request({ cmd: 'stop' });
    wire.bufferedAmount = 0;
    now += 10 * stalled_after;
    link.watch('demo');
    assert.equal(link.stalled, false);
    now += stalled_after + 1;
    assert.equal(link.stalled, true);
});
