// Where the tool was in the last seconds: every cycle of it, read from the machine's memory, for the states that the page is sent are too far apart for a curve.
import { Answer, Request } from '../link';
import { Doubles } from '../scope/base64';

export const trail_seconds = 6;

export interface TrailPoint {
    cycle: number;
    at: [number, number, number];
}

export class Trail {
    points: TrailPoint[] = [];
    /** The machine gave none when it was asked last. */
    unread = false;
    private next_ = 0;
    private asking_ = false;
    private readonly doubles_ = new Doubles();

    constructor(private readonly ask_: (request: Request) => Promise<Answer>, private readonly group_: string, private readonly cycle_ns_: number) {}

    /** Up to this cycle of the machine's; the points are there when the promise is. A machine that began anew begins a new trail. */
    async follow(newest: number): Promise<void> {
        const most = Math.ceil((trail_seconds * 1e9) / Math.max(1, this.cycle_ns_));
        if (newest + 1 < this.next_) this.restart();
        if (this.asking_ || newest < this.next_) return;
        this.asking_ = true;
        const from = Math.max(this.next_, newest + 1 - most, 0), to = newest + 1;
        const answer = await this.ask_({ cmd: 'scope_read', signals: ['x', 'y', 'z'].map((name) => `group.${this.group_}.tool_${name}`), from, to, points: to - from });
        this.asking_ = false;
        const data = answer['data'];
        this.unread = !answer.ok || !Array.isArray(data) || (answer['per'] ?? 1) !== 1;
        if (this.unread || !Array.isArray(data)) return;
        const begin = Number(answer['from']), [x = [], y = [], z = []] = data.map((text) => [...this.doubles_.decode(String(text))]);
        x.forEach((value, i) => {
            const at: [number, number, number] = [value, y[i] ?? NaN, z[i] ?? NaN];
            if (at.every(Number.isFinite)) this.points.push({ cycle: begin + i, at });
        });
        this.next_ = to;
        const oldest = this.points.findIndex((point) => point.cycle > newest - most);
        this.points.splice(0, oldest < 0 ? this.points.length : oldest);
    }
    private restart(): void {
        this.points = [];
        this.next_ = 0;
    }
}
