// How a curve becomes strokes: one column after the other from its least to its greatest, broken where samples are missing.
import { Columns } from './thin';

export interface Frame {
    left: number;
    top: number;
    width: number;
    height: number;
    /** Cycles at the left and right edge, values at the lower and upper one. */
    from: number;
    to: number;
    min: number;
    max: number;
}

/** What a path is drawn with: Path2D, or a test's notebook. */
export interface Pen {
    moveTo(x: number, y: number): void;
    lineTo(x: number, y: number): void;
}

export function draw_curve(pen: Pen, columns: Columns, frame: Frame, offset: number, steps: boolean): void {
    const x_scale = frame.width / (frame.to - frame.from), y_scale = frame.height / (frame.max - frame.min);
    // Far outside is outside: what is clipped anyway must not overflow a canvas.
    const y_of = (value: number): number => Math.max(-1e5, Math.min(1e5, frame.top + (frame.max - value - offset) * y_scale));
    let before = NaN;
    for (let i = 0; i < columns.count; i++) {
        const low = columns.low[i] as number, high = columns.high[i] as number;
        if (low !== low) {
            before = NaN;
            continue;
        }
        const x = frame.left + (columns.start + i * columns.per - frame.from) * x_scale;
        // Enter the column at the end that is nearer.
        const up = before !== before || Math.abs(before - low) <= Math.abs(before - high);
        const first = up ? low : high, second = up ? high : low;
        if (before !== before) {
            pen.moveTo(x, y_of(first));
            if (first === second) pen.lineTo(x + 0.01, y_of(first));  // a lone sample is seen, too
        } else {
            if (steps) pen.lineTo(x, y_of(before));
            pen.lineTo(x, y_of(first));
        }
        if (second !== first) pen.lineTo(x, y_of(second));
        before = second;
    }
}

/** Least and greatest of what is seen; low > high where nothing is. */
export function extremes(columns: Columns, offset: number): { low: number; high: number } {
    let low = Infinity, high = -Infinity;
    for (let i = 0; i < columns.count; i++) {
        const a = columns.low[i] as number, b = columns.high[i] as number;
        if (a !== a || !Number.isFinite(a) || !Number.isFinite(b)) continue;
        if (a < low) low = a;
        if (b > high) high = b;
    }
    return { low: low + offset, high: high + offset };
}
