// What the machine has recorded of itself, asked over a connection of its own: every cycle of a signal, whatever the page says.
import assert from 'node:assert/strict';
import { Machine } from './machine';

/** Numbers as `scope_read` sends them: f64, little-endian, base64. */
export function numbers(text: string): number[] {
    const bytes = Buffer.from(text, 'base64');
    return Array.from({ length: bytes.length / 8 }, (_, i) => bytes.readDoubleLE(i * 8));
}

/** One signal, a value per cycle, from `from` up to and without `to`. None is missing, or the test fails. */
export async function recorded(machine: Machine, signal: string, from: number, to: number): Promise<number[]> {
    const answer = await machine.told({ cmd: 'scope_read', signals: [signal], from, to, points: to - from });
    assert.equal(answer['missing'], 0, `${signal}: cycles are missing`);
    assert.equal(answer['per'], 1);
    assert.equal(answer['from'], from);
    const values = numbers((answer['data'] as string[])[0] ?? '');
    assert.equal(values.length, to - from);
    return values;
}
/** The newest cycle that is recorded. */
export async function newest(machine: Machine): Promise<number> {
    return Number((await machine.state())['cycle']);
}
