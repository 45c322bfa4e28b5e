// The spectrum of any number of samples: radix 2, and Bluestein's chirp for the lengths that are none. Amplitudes in the signal's unit.

function radix2(re: Float64Array, im: Float64Array): void {
    const n = re.length;
    for (let i = 1, j = 0; i < n; i++) {
        let bit = n >> 1;
        for (; j & bit; bit >>= 1) j ^= bit;
        j ^= bit;
        if (i < j) {
            const a = re[i] as number, b = im[i] as number;
            re[i] = re[j] as number;
            im[i] = im[j] as number;
            re[j] = a;
            im[j] = b;
        }
    }
    const cos = new Float64Array(n >> 1), sin = new Float64Array(n >> 1);
    for (let i = 0; i < n >> 1; i++) {
        cos[i] = Math.cos((2 * Math.PI * i) / n);
        sin[i] = -Math.sin((2 * Math.PI * i) / n);
    }
    for (let half = 1; half < n; half *= 2) {
        const step = n / (2 * half);
        for (let block = 0; block < n; block += 2 * half)
            for (let i = 0; i < half; i++) {
                const c = cos[i * step] as number, s = sin[i * step] as number, p = block + i, q = p + half;
                const a = (re[q] as number) * c - (im[q] as number) * s, b = (re[q] as number) * s + (im[q] as number) * c;
                re[q] = (re[p] as number) - a;
                im[q] = (im[p] as number) - b;
                re[p] = (re[p] as number) + a;
                im[p] = (im[p] as number) + b;
            }
    }
}

function inverse2(re: Float64Array, im: Float64Array): void {
    radix2(im, re);  // swapped: the inverse, but for the division
    for (let i = 0; i < re.length; i++) {
        re[i] = (re[i] as number) / re.length;
        im[i] = (im[i] as number) / re.length;
    }
}

/** In place, forward, not scaled; any length. */
export function fft(re: Float64Array, im: Float64Array): void {
    const n = re.length;
    if (n < 2) return;
    if ((n & (n - 1)) === 0) return radix2(re, im);
    // Bluestein: kl = (k2 + l2 - (k-l)2) / 2 makes the sum a convolution with a chirp.
    let m = 1;
    while (m < 2 * n - 1) m *= 2;
    const chirp_re = new Float64Array(n), chirp_im = new Float64Array(n);
    for (let i = 0; i < n; i++) {
        const angle = (Math.PI * ((i * i) % (2 * n))) / n;  // the square modulo 2n: the angle keeps its digits
        chirp_re[i] = Math.cos(angle);
        chirp_im[i] = -Math.sin(angle);
    }
    const a_re = new Float64Array(m), a_im = new Float64Array(m), b_re = new Float64Array(m), b_im = new Float64Array(m);
    for (let i = 0; i < n; i++) {
        const c = chirp_re[i] as number, s = chirp_im[i] as number, x = re[i] as number, y = im[i] as number;
        a_re[i] = x * c - y * s;
        a_im[i] = x * s + y * c;
        b_re[i] = c;
        b_im[i] = -s;
        if (i > 0) {
            b_re[m - i] = c;
            b_im[m - i] = -s;
        }
    }
    radix2(a_re, a_im);
    radix2(b_re, b_im);
    for (let i = 0; i < m; i++) {
        const x = a_re[i] as number, y = a_im[i] as number, c = b_re[i] as number, s = b_im[i] as number;
        a_re[i] = x * c - y * s;
        a_im[i] = x * s + y * c;
    }
    inverse2(a_re, a_im);
    for (let i = 0; i < n; i++) {
        const c = chirp_re[i] as number, s = chirp_im[i] as number, x = a_re[i] as number, y = a_im[i] as number;
        re[i] = x * c - y * s;
        im[i] = x * s + y * c;
    }
}

export const windows = ['hann', 'flat_top', 'blackman_harris', 'rectangle'] as const;
export type Window = (typeof windows)[number];

/** Cosine terms; periodic, so that a whole number of waves stays on its lines. Flat top after ISO 18431-2, Blackman-Harris with 92 dB (Harris 1978). */
const terms: Record<Window, readonly number[]> = {
    rectangle: [1],
    hann: [0.5, -0.5],
    blackman_harris: [0.35875, -0.48829, 0.14128, -0.01168],
    flat_top: [1, -1.933, 1.286, -0.388, 0.0322],
};

export interface Spectrum {
    /** Hz between two lines. */
    line_hz: number;
    /** In the signal's unit: the peak of the sine on that line; line 0 is the mean. */
    amplitude: Float64Array;
}

/** Undefined where a sample is missing or there are fewer than four: a spectrum of what is not there would be made up. */
export function spectrum(samples: Float64Array, sample_hz: number, window: Window): Spectrum | undefined {
    const n = samples.length;
    if (n < 4 || samples.some((v) => !Number.isFinite(v))) return undefined;
    let mean = 0;
    for (const v of samples) mean += v / n;
    const re = new Float64Array(n), im = new Float64Array(n);
    let gain = 0;
    for (let i = 0; i < n; i++) {
        let weight = 0;
        terms[window].forEach((term, order) => (weight += term * Math.cos((2 * Math.PI * order * i) / n)));
        re[i] = ((samples[i] as number) - mean) * weight;  // the mean alone on line 0, not leaking into those beside it
        gain += weight;
    }
    fft(re, im);
    const lines = Math.floor(n / 2) + 1;
    const amplitude = new Float64Array(lines);
    for (let k = 1; k < lines; k++) amplitude[k] = (Math.hypot(re[k] as number, im[k] as number) / gain) * (2 * k === n ? 1 : 2);
    amplitude[0] = Math.abs(mean);
    return { line_hz: sample_hz / n, amplitude };
}

/** dB of the unit itself: 0 dB is 1 mm. */
export const decibel = (amplitude: number): number => 20 * Math.log10(amplitude);
