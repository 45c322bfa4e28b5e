// Numbers as an operator reads them.
import { Real, value } from './state';

/** Three decimals, a real minus sign, no "-0.000". What is no number is a dash. */
export function fixed(real: Real | null | undefined, decimals = 3): string {
    const number = value(real);
    if (Number.isNaN(number)) return '–';
    if (!Number.isFinite(number)) return number > 0 ? '∞' : '−∞';
    const text = number.toFixed(decimals);
    return Number(text) === 0 ? text.replace('-', '') : text.replace('-', '−');
}

/** A program's value: whole numbers without decimals. */
export function plain(real: Real): string {
    const number = value(real);
    return Number.isInteger(number) ? String(number).replace('-', '−') : fixed(number, 4);
}

export const microseconds = (ns: number): string => (ns / 1000).toFixed(ns < 100_000 ? 1 : 0);
/** With its unit: milliseconds where microseconds would be five digits. */
export const span_of = (ns: number): string => (ns < 10_000_000 ? `${microseconds(ns)} µs` : `${(ns / 1e6).toFixed(1)} ms`);
export const hex = (word: number, digits = 4): string => word.toString(16).toUpperCase().padStart(digits, '0') + 'h';

/** What a person typed; comma or point, NaN where it is no number. */
export function typed(text: string): number {
    const cleaned = text.trim().replace('−', '-').replace(',', '.');
    return /^[+-]?(\d+\.?\d*|\.\d+)(e[+-]?\d+)?$/i.test(cleaned) ? Number(cleaned) : NaN;
}

export function duration(seconds: number): string {
    if (seconds < 60) return seconds.toFixed(1) + ' s';
    const whole = Math.floor(seconds);
    const two = (n: number) => String(n).padStart(2, '0');
    return `${Math.floor(whole / 3600)}:${two(Math.floor(whole / 60) % 60)}:${two(whole % 60)}`;
}
