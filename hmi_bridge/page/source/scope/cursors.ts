// Two cursors and what lies between them.
export interface Cursors {
    shown: boolean;
    /** Cycles. */
    a: number;
    b: number;
}

/** Within what is seen, at a third and at two thirds. */
export function place_cursors(cursors: Cursors, from: number, to: number): void {
    cursors.a = Math.round(from + (to - from) / 3);
    cursors.b = Math.round(from + ((to - from) * 2) / 3);
    cursors.shown = true;
}
/** Hz, of two times in s; infinite where they are one. */
export const rate_between = (a: number, b: number): number => 1 / Math.abs(b - a);

/** The range that figures are about: between the cursors, both included, or what is seen. */
export function measured(cursors: Cursors, from: number, to: number): { from: number; to: number } {
    if (!cursors.shown) return { from: Math.max(0, Math.ceil(from)), to: Math.max(0, Math.floor(to)) };
    return { from: Math.max(0, Math.min(cursors.a, cursors.b)), to: Math.max(cursors.a, cursors.b) + 1 };
}

/** A time with as much of it as a cycle needs: 12.345 s, 1.25 ms. */
export function time_text(seconds: number, cycle_ns: number): string {
    const size = Math.abs(seconds);
    const decimals = Math.max(0, Math.ceil(-Math.log10(cycle_ns / 1e9) - 1e-9));
    const text = size >= 1 || size === 0 ? `${seconds.toFixed(decimals)} s` : `${(seconds * 1e3).toFixed(Math.max(0, decimals - 3))} ms`;
    return text.replace('-', '−');
}
/** All the digits that the number has. */
export const value_text = (value: number): string => (Number.isNaN(value) ? '–' : !Number.isFinite(value) ? (value > 0 ? '∞' : '−∞') : String(value).replace('-', '−'));
/** Of a figure that was computed: seven digits. */
export function figure_text(value: number): string {
    if (!Number.isFinite(value)) return value_text(value);
    return value_text(Number(value.toPrecision(7)));
}
