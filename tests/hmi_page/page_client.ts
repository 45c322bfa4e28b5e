// A page without a browser: one WebSocket to the server, which counts what comes. Enough of RFC 6455 for a client that reads text frames and answers pings.
import { randomBytes } from 'node:crypto';
import { connect, Socket } from 'node:net';

export class PageClient {
    messages = 0;
    bytes = 0;
    /** The newest message of each type, as it came. */
    readonly newest = new Map<string, string>();
    private rest_ = Buffer.alloc(0);
    private parts_: Buffer[] = [];
    private constructor(private readonly socket_: Socket) {
        socket_.on('data', (data) => this.take(data));
        socket_.on('error', () => undefined);
    }

    static open(host: string, port: number): Promise<PageClient> {
        return new Promise((resolve, reject) => {
            const socket = connect(port, host);
            socket.once('error', reject);
            socket.once('connect', () => socket.write([`GET /ws HTTP/1.1`, `Host: ${host}:${port}`, `Origin: http://${host}:${port}`, 'Upgrade: websocket', 'Connection: Upgrade',
                'Sec-WebSocket-Version: 13', `Sec-WebSocket-Key: ${randomBytes(16).toString('base64')}`, '', ''].join('\r\n')));
            let head = Buffer.alloc(0);
            const begin = (data: Buffer) => {
                head = Buffer.concat([head, data]);
                const end = head.indexOf('\r\n\r\n');
                if (end < 0) return;
                socket.off('data', begin);
                const first = head.subarray(0, head.indexOf('\r\n')).toString();
                if (!first.includes(' 101 ')) return reject(new Error(first));
                const client = new PageClient(socket);
                client.take(head.subarray(end + 4));
                resolve(client);
            };
            socket.on('data', begin);
        });
    }
    send(message: unknown): void {
        this.frame(1, Buffer.from(JSON.stringify(message)));
    }
    close(): void {
        this.socket_.destroy();
    }

    private frame(opcode: number, payload: Buffer): void {
        const mask = randomBytes(4);
        const head = payload.length < 126 ? Buffer.from([0x80 | opcode, 0x80 | payload.length]) : Buffer.from([0x80 | opcode, 0x80 | 126, payload.length >> 8, payload.length & 255]);
        const masked = Buffer.from(payload.map((byte, i) => byte ^ (mask[i & 3] ?? 0)));
        this.socket_.write(Buffer.concat([head, mask, masked]));
    }
    private take(data: Buffer): void {
        this.rest_ = this.rest_.length > 0 ? Buffer.concat([this.rest_, data]) : data;
        for (;;) {
            if (this.rest_.length < 2) return;
            const opcode = this.rest_.readUInt8(0) & 15, last = (this.rest_.readUInt8(0) & 128) !== 0, short = this.rest_.readUInt8(1) & 127;
            const head = short < 126 ? 2 : short === 126 ? 4 : 10;
            if (this.rest_.length < head) return;
            const size = short < 126 ? short : short === 126 ? this.rest_.readUInt16BE(2) : Number(this.rest_.readBigUInt64BE(2));
            if (this.rest_.length < head + size) return;
            const payload = this.rest_.subarray(head, head + size);
            this.rest_ = this.rest_.subarray(head + size);
            if (opcode === 9) this.frame(10, Buffer.from(payload));
            if (opcode > 2) continue;
            this.parts_.push(payload);
            if (!last) continue;
            this.message(Buffer.concat(this.parts_));
            this.parts_ = [];
        }
    }
    private message(text: Buffer): void {
        ++this.messages;
        this.bytes += text.length;
        const type = /^\{"type":"(\w+)"/.exec(text.subarray(0, 40).toString())?.[1] ?? '';
        this.newest.set(type, text.toString());
    }
}
