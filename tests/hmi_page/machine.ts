// The machine's local socket: what a test does besides the page, and what it believes instead of the page.
import { connect, Socket } from 'node:net';
import { createInterface } from 'node:readline';

export type Json = Record<string, unknown>;

/** One connection; answers by id. */
export class Machine {
    private next_ = 1;
    private readonly waiting_ = new Map<number, (answer: Json) => void>();
    private constructor(private readonly socket_: Socket) {
        createInterface({ input: socket_ }).on('line', (line) => {
            const answer = JSON.parse(line) as Json;
            const id = Number(answer['id']);
            this.waiting_.get(id)?.(answer);
            this.waiting_.delete(id);
        });
        socket_.on('error', () => undefined);
    }
    static open(path: string): Promise<Machine> {
        return new Promise((resolve, reject) => {
            const socket = connect(path);
            socket.once('connect', () => resolve(new Machine(socket)));
            socket.once('error', reject);
        });
    }
    ask(request: Json): Promise<Json> {
        const id = this.next_++;
        return new Promise((resolve) => {
            this.waiting_.set(id, resolve);
            this.socket_.write(JSON.stringify({ ...request, id }) + '\n');
        });
    }
    /** As ask(); a refusal fails the test. */
    async told(request: Json): Promise<Json> {
        const answer = await this.ask(request);
        if (answer['ok'] !== true) throw new Error(`${JSON.stringify(request)}: ${JSON.stringify(answer['error'])}`);
        return answer;
    }
    async state(): Promise<Json> {
        const answer = await this.ask({ cmd: 'state' });
        return (answer['state'] ?? answer) as Json;
    }
    close(): void {
        this.socket_.destroy();
    }
}
