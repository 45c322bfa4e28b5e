// The spectrum against calculations by hand: a sum of sines has the amplitudes that it was made of.
import assert from 'node:assert/strict';
import test from 'node:test';
import { decibel, fft, spectrum, Window, windows } from '@page/scope/fft';

const near = (a: number | undefined, b: number, within = 1e-9): void => assert.ok(Math.abs((a ?? NaN) - b) <= within, `${a} instead of ${b}`);
const made = (n: number, of: (i: number) => number): Float64Array => Float64Array.from({ length: n }, (_, i) => of(i));

/** The definition itself. */
function dft(x: readonly number[]): [number, number][] {
    return x.map((_, k) => x.reduce<[number, number]>(([re, im], v, i) => [re + v * Math.cos((2 * Math.PI * k * i) / x.length), im - v * Math.sin((2 * Math.PI * k * i) / x.length)], [0, 0]));
}

for (const n of [1, 2, 3, 4, 5, 7, 8, 12, 30, 64, 97, 100])
    test(`${n} numbers: as the definition says`, () => {
        const x = Array.from({ length: n }, (_, i) => Math.sin(i * i + 1) + (i % 3));
        const re = Float64Array.from(x), im = new Float64Array(n);
        fft(re, im);
        dft(x).forEach(([a, b], k) => {
            near(re[k], a, 1e-10 * n);
            near(im[k], b, 1e-10 * n);
        });
    });

test('one impulse is flat, one constant is line 0', () => {
    const re = Float64Array.from([1, 0, 0, 0, 0, 0]), im = new Float64Array(6);
    fft(re, im);
    re.forEach((v) => near(v, 1, 1e-12));
    const flat = spectrum(made(10, () => -3), 1000, 'hann');
    near(flat?.amplitude[0], 3);
    for (let k = 1; k <= 5; k++) near(flat?.amplitude[k], 0, 1e-12);
});

for (const window of windows)
    for (const n of [1000, 1024])
        test(`a sine on a line has its amplitude, exactly: ${window}, ${n} samples`, () => {
            // 5 mm at line 50, 0.25 mm at line 200, a mean of 7 mm, in n samples at 1 kHz.
            const got = spectrum(made(n, (i) => 7 + 5 * Math.sin((2 * Math.PI * 50 * i) / n + 0.3) + 0.25 * Math.cos((2 * Math.PI * 200 * i) / n)), 1000, window as Window);
            near(got?.line_hz, 1000 / n, 1e-12);
            near(got?.amplitude[0], 7);
            near(got?.amplitude[50], 5);
            near(got?.amplitude[200], 0.25);
            near(got?.amplitude[120], 0);
            assert.equal(got?.amplitude.length, n / 2 + 1);
        });

test('the last line of an even number of samples is not doubled', () => {
    const got = spectrum(made(8, (i) => (i % 2 === 0 ? 2 : -2)), 1000, 'rectangle');
    near(got?.amplitude[4], 2);
});

test('between two lines the flat top keeps the amplitude within 0.1 %, Hann loses up to 15.1 %', () => {
    const half = made(1000, (i) => Math.sin((2 * Math.PI * 50.5 * i) / 1000));
    // The scalloping losses that are published for these windows: 0.01 dB and 1.42 dB.
    near(Math.max(...(spectrum(half, 1000, 'flat_top')?.amplitude ?? [])), 1, 2e-3);
    near(Math.max(...(spectrum(half, 1000, 'hann')?.amplitude ?? [])), 10 ** (-1.42 / 20), 2e-3);
});

test('nothing is made up: a missing sample, or too few of them, gives no spectrum', () => {
    assert.equal(spectrum(Float64Array.from([1, 2, NaN, 4, 5]), 1000, 'hann'), undefined);
    assert.equal(spectrum(Float64Array.from([1, 2, 3]), 1000, 'hann'), undefined);
});

test('decibels of the unit', () => {
    assert.equal(decibel(1), 0);
    near(decibel(0.1), -20);
});
