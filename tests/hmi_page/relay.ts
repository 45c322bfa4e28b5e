// Stands where the server stands: static files and the WebSocket of hmi_bridge/web/README.md for one page at a time, the local socket of a machine
// behind it. For tests only: no roles, no origins, no ages.
import { createServer, Server } from 'node:http';
import { readFile } from 'node:fs/promises';
import { AddressInfo, connect, Socket } from 'node:net';
import { basename, extname, join } from 'node:path';
import { createInterface } from 'node:readline';
import { WebSocket, WebSocketServer } from 'ws';

type Json = Record<string, unknown>;
const kinds: Record<string, string> = { '.html': 'text/html', '.js': 'text/javascript', '.css': 'text/css', '.svg': 'image/svg+xml' };

/** The machine's local socket: answers by id, one connection. */
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
    async state(): Promise<Json> {
        const answer = await this.ask({ cmd: 'state' });
        return (answer['state'] ?? answer) as Json;
    }
    close(): void {
        this.socket_.destroy();
    }
}

export class Relay {
    /** The newest state that went to the page. */
    last: Json = {};
    /** Commands as the page sent them. */
    readonly commands: Json[] = [];
    /** A frozen server: nothing is read, nothing is sent. */
    frozen = false;
    private server_: Server | undefined;
    private readonly pages_ = new Set<WebSocket>();

    constructor(private readonly folder_: string, private readonly machine_path_: string) {}

    async listen(): Promise<string> {
        const server = createServer((request, response) => {
            const name = request.url === '/' ? 'index.html' : basename(request.url ?? '');
            readFile(join(this.folder_, name)).then((body) => response.writeHead(200, {
                'content-type': kinds[extname(name)] ?? 'text/plain', 'content-security-policy': "default-src 'self'; frame-ancestors 'none'",
            }).end(body), () => response.writeHead(404).end());
        });
        this.server_ = server;
        new WebSocketServer({ server, path: '/ws' }).on('connection', (page) => void this.serve(page));
        await new Promise<void>((resolve) => server.listen(0, '127.0.0.1', resolve));
        return `http://127.0.0.1:${(server.address() as AddressInfo).port}/`;
    }
    /** A killed server: connections end at once. */
    drop(): void {
        for (const page of this.pages_) page.terminate();
    }
    async close(): Promise<void> {
        this.drop();
        await new Promise((resolve) => this.server_?.close(resolve));
    }

    private async serve(page: WebSocket): Promise<void> {
        this.pages_.add(page);
        const early: string[] = [];
        let take = (text: string): void => void early.push(text);
        page.on('message', (data) => take(String(data)));
        const machine = await Machine.open(this.machine_path_);
        const layout = await machine.ask({ cmd: 'layout' });
        const described = (layout['layout'] ?? layout) as Json;
        const send = (message: Json) => page.readyState === WebSocket.OPEN && page.send(JSON.stringify(message));
        send({ type: 'hello', protocol: 1, version: 'test', role: 'operator', machine: described['machine'], machines: [], layout: described });
        take = (text) => {
            if (this.frozen) return;
            const { type, machine: _watched, sent_ms: _sent, id, ...request } = JSON.parse(text) as Json;
            if (type !== 'command') return;
            this.commands.push(request);
            void machine.ask(request).then((answer) => this.frozen || send({ ...answer, type: 'answer', id }));
        };
        early.forEach((text) => take(text));
        const timer = setInterval(() => {
            if (!this.frozen) void machine.state().then((state) => {
                this.last = state;
                if (!this.frozen) send({ type: 'state', machine: described['machine'], age_ms: 0, state });
            });
        }, 50);
        page.on('close', () => {
            clearInterval(timer);
            machine.close();
            this.pages_.delete(page);
        });
    }
}
