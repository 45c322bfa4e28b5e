// Figures of a range: of each sample that is there, never of what was thinned for the screen.
import { bit_of } from './signals';

export interface Statistics {
    count: number;
    /** Cycles without a number. */
    missing: number;
    min: number;
    max: number;
    mean: number;
    /** Root of the mean square. */
    rms: number;
    peak_to_peak: number;
    /** Of the samples as they are (divided by their count). */
    deviation: number;
}

export class Figures {
    private count_ = 0;
    private given_ = 0;
    private min_ = Infinity;
    private max_ = -Infinity;
    private mean_ = 0;
    private squares_ = 0;

    add(samples: Float64Array, offset = 0, bit?: number): void {
        this.given_ += samples.length;
        for (let i = 0; i < samples.length; i++) {
            const sample = samples[i] as number, value = (bit === undefined ? sample : bit_of(sample, bit)) + offset;
            if (value !== value) continue;
            this.count_++;
            if (value < this.min_) this.min_ = value;
            if (value > this.max_) this.max_ = value;
            // Welford: a small ripple on a large value keeps its digits.
            const off = value - this.mean_;
            this.mean_ += off / this.count_;
            this.squares_ += off * (value - this.mean_);
        }
    }
    /** Of so many cycles, some of which may never have been given. */
    of(cycles = this.given_): Statistics {
        const count = this.count_, missing = cycles - count;
        if (count === 0) return { count, missing, min: NaN, max: NaN, mean: NaN, rms: NaN, peak_to_peak: NaN, deviation: NaN };
        const variance = this.squares_ / count;
        return { count, missing, min: this.min_, max: this.max_, mean: this.mean_, rms: Math.sqrt(this.mean_ ** 2 + variance), peak_to_peak: this.max_ - this.min_, deviation: Math.sqrt(variance) };
    }
}
