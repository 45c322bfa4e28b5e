// Which cycles are there: half-open ranges in order, none touching another.

export interface Span {
    from: number;
    to: number;
}

export class Spans {
    readonly list: Span[] = [];

    add(from: number, to: number): void {
        if (to <= from) return;
        const last = this.list[this.list.length - 1];
        if (last && from >= last.from && from <= last.to) {  // a live view does this alone
            if (to > last.to) last.to = to;
            return;
        }
        let at = 0;
        while (at < this.list.length && (this.list[at] as Span).to < from) at++;
        let end = at;
        for (; end < this.list.length && (this.list[end] as Span).from <= to; end++) {
            from = Math.min(from, (this.list[end] as Span).from);
            to = Math.max(to, (this.list[end] as Span).to);
        }
        this.list.splice(at, end - at, { from, to });
    }
    /** What lies before this cycle is gone. */
    cut(before: number): void {
        let first = this.list[0];
        while (first && first.to <= before) {
            this.list.shift();
            first = this.list[0];
        }
        if (first && first.from < before) first.from = before;
    }
    has(from: number, to = from + 1): boolean {
        const span = this.list.find((s) => s.to > from);
        return span !== undefined && span.from <= from && span.to >= to;
    }
    /** What is not there of [from, to). */
    holes(from: number, to: number): Span[] {
        const out: Span[] = [];
        for (const span of this.list) {
            if (span.to <= from) continue;
            if (span.from >= to) break;
            if (span.from > from) out.push({ from, to: span.from });
            from = span.to;
        }
        if (from < to) out.push({ from, to });
        return out;
    }
}
