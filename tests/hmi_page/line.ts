// The network between browser and server: hands bytes on as they come, or holds them back, late or not at all. Nothing is lost while it holds: TCP.
import { connect, createServer, Server, Socket } from 'node:net';

export class Line {
    private held_ = false;
    private readonly waiting_: (() => void)[] = [];
    private readonly ends_ = new Set<Socket>();
    private server_: Server | undefined;

    /** Where the browser comes in; the server stands at the same port of `to`. */
    constructor(private readonly port_: number, private readonly from_ = '127.0.0.1', private readonly to_ = '127.0.0.2') {}

    async open(): Promise<void> {
        const server = createServer((near) => {
            const far = connect(this.port_, this.to_);
            for (const [here, there] of [[near, far], [far, near]] as const) {
                this.ends_.add(here);
                here.on('data', (bytes) => this.pass(() => there.write(bytes)));
                here.on('end', () => this.pass(() => there.end()));
                here.on('error', () => there.destroy());
                here.on('close', () => {
                    this.ends_.delete(here);
                    if (!this.held_) there.destroySoon();
                });
            }
        });
        this.server_ = server;
        await new Promise<void>((resolve, reject) => server.once('error', reject).listen(this.port_, this.from_, resolve));
    }
    private pass(bytes: () => void): void {
        if (this.held_) this.waiting_.push(bytes);
        else bytes();
    }
    /** The network stalls: what is sent waits. */
    hold(): void {
        this.held_ = true;
    }
    /** It recovers: what waited comes at once, in its order. */
    flow(): void {
        this.held_ = false;
        for (const bytes of this.waiting_.splice(0)) bytes();
    }
    /** The plug is pulled: connections end, what waited is lost. */
    cut(): void {
        this.held_ = false;
        this.waiting_.length = 0;
        for (const end of this.ends_) end.destroy();
    }
    async close(): Promise<void> {
        this.cut();
        await new Promise((resolve) => (this.server_ ? this.server_.close(resolve) : resolve(undefined)));
    }
}
