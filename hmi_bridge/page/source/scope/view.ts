// Which stretch of time is seen: it follows the newest cycle or stands, is zoomed about a point and moved. In cycles; may begin between two.

export class View {
    from = 0;
    to = 10_000;
    /** The newest cycle stays at the right edge. */
    follow = true;

    constructor(readonly cycle_ns: number, span_s = 10) {
        this.to = this.cycles(span_s);
    }
    cycles(seconds: number): number {
        return (seconds * 1e9) / this.cycle_ns;
    }
    seconds(cycles: number): number {
        return (cycles * this.cycle_ns) / 1e9;
    }
    get span(): number {
        return this.to - this.from;
    }
    show(from: number, to: number): void {
        const least = 8;  // cycles: nearer there is nothing to see
        const most = this.cycles(3600);
        const span = Math.min(most, Math.max(least, to - from)), middle = (from + to) / 2;
        this.from = span === to - from ? from : middle - span / 2;
        this.to = this.from + span;
    }
    /** By a factor, about the point at `part` of the width; a view that follows keeps its right edge. */
    zoom(factor: number, part = 0.5): void {
        const about = this.follow ? this.to : this.from + this.span * part;
        const left = this.follow ? 1 : part;
        const span = this.span * factor;
        this.show(about - span * left, about + span * (1 - left));
        if (this.follow) this.tie(about);
    }
    /** By a part of the width; into the past it stops following. */
    move(part: number): void {
        const by = this.span * part;
        this.follow = false;
        this.show(this.from + by, this.to + by);
    }
    tie(newest: number): void {
        if (!this.follow) return;
        const span = this.span;
        this.to = newest;
        this.from = newest - span;
    }
}
