// A machine that runs, the server of its page, the network in front of it, a browser that looks at it.
import { ChildProcess, spawn } from 'node:child_process';
import { copyFileSync, mkdtempSync, readdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { Browser, BrowserContext, chromium, Locator, Page } from 'playwright-core';
import { Line } from './line';
import { Json, Machine } from './machine';

export interface Axis {
    name: string;
    state: string;
    owner: string;
    powered: boolean;
    homed: boolean;
    unit: string;
    actual_position: number;
    actual_velocity: number;
    set_position: number;
    set_velocity: number;
    override: number;
}

const build = process.env['TAKTWERK_BUILD'] ?? '';
const source = process.env['TAKTWERK_SOURCE'] ?? '';
const command = process.env['TAKTWERK_COMMAND'] ?? join(build, 'taktwerk');
/** ms: what no test is about. A computer that does much else may take so long; what is about time is judged by the machine's cycles. */
export const patience = 60_000;
/** Who is asked what there is to see where something was waited for in vain. */
let witness: Cell | undefined;

export async function until(what: string, holds: () => Promise<boolean> | boolean, ms = patience): Promise<void> {
    for (const end = Date.now() + ms; Date.now() < end; await pause(20)) if (await holds()) return;
    throw new Error(`not within ${ms} ms: ${what}\n${(await witness?.testimony()) ?? ''}`);
}
/** What the server, the machine or the page itself says to somebody who comes late: it was not done, and may be given again. */
const late = /ms to arrive|ms old and was valid|No answer from the machine|No connection|stood still|stalls|does not answer|values are old|无应答|连接|卡顿|过时/;
export const pause = (ms: number): Promise<void> => new Promise((resolve) => setTimeout(resolve, ms));

export interface CellOptions {
    /** The machine's cycle: four times as long as the demo's, so that a busy computer has more time for each. */
    cycle?: string;
    /** Of config/machines/; the demo where it is left out. */
    file?: string;
    /** What is changed in that machine file. */
    machine?: (yaml: string) => string;
    /** Of `taktwerk hmi`. */
    role?: string;
    /** The file of users: people log in. */
    users?: string;
}

export interface Taste {
    theme?: 'light' | 'dark';
    language?: 'en' | 'zh';
}

/** The demo with its program, its axes by hand, on a computer that is late at times, drives and all: that is not what is looked at. */
export const unhurried = (yaml: string): string => yaml.replace('start_mode: automatic', 'start_mode: manual').replace(/^  events:[\s\S]*$/m, '').replace('overruns_allowed: 10', 'overruns_allowed: 1000, lateness_warning: 900 ms')
    .replace(/^( {6})(profile|terminal): .*$/gm, '$&\n$1sm_watchdog: 6 s');
/** Without programs as well: an operator alone with three axes. */
export const quiet = (yaml: string): string => unhurried(yaml).replace(/^programs:[\s\S]*?(?=^# --- Safety)/m, '').replace(/^views:[\s\S]*?(?=^# ---)/m, '');

export class Cell {
    line!: Line;
    machine!: Machine;
    browser!: Browser;
    page!: Page;
    address = '';
    port = 0;
    /** What the browser's console said. */
    readonly complaints: string[] = [];
    /** Messages of the page to the server, as they left the page. */
    sent: Json[] = [];
    /** What a page has asked and is not answered yet. */
    private readonly asked_ = new WeakMap<Page, Set<number>>();
    readonly folder = mkdtempSync(join(tmpdir(), 'hmi-page-'));
    readonly command = command;
    readonly socket = join(this.folder, 'demo.sock');
    private readonly children_: ChildProcess[] = [];
    private server_: ChildProcess | undefined;
    private role_ = 'engineer';
    private users_ = '';

    async start(options: CellOptions = {}): Promise<void> {
        witness = this;
        const written = readFileSync(join(source, 'config/machines', options.file ?? 'demo.yaml'), 'utf8'), demo = /^hmi:$/m.test(written) ? written : `${written}\nhmi:\n`;
        const file = join(this.folder, 'demo.yaml');
        copyFileSync(join(source, 'config/machines/demo-cell.svg'), join(this.folder, 'demo-cell.svg'));
        writeFileSync(file, (options.machine ?? quiet)(demo).replace('cycle: 1 ms', `cycle: ${options.cycle ?? '4 ms'}`).replace(/^hmi:$/m, `hmi:\n  socket: ${this.socket}`));
        this.role_ = options.role ?? this.role_;
        this.users_ = options.users ?? '';
        const runtime = this.child([command, 'run', file, '--recordings', join(this.folder, 'recordings'), '--history', join(this.folder, 'history')], source);
        await until('the machine runs', async () => {
            if (runtime.process.exitCode !== null) throw new Error(`taktwerk run ended:\n${runtime.said()}`);
            try {
                this.machine ??= await Machine.open(this.socket);
                return (await this.machine.state())['phase'] === 'running';
            } catch {
                return false;
            }
        });
        await this.serve();
        this.line = new Line(this.port);
        await this.line.open();
        this.address = `http://127.0.0.1:${this.port}/`;
        this.browser = await chromium.launch({
            executablePath: '/usr/bin/chromium', headless: true,
            args: ['--no-sandbox', '--disable-gpu', '--disable-quic', '--no-first-run', '--disable-background-networking', '--disable-component-update', '--disable-sync'],
        });
        await this.look();
    }
    /** The server, or a new one at the same place. It listens beside the browser's address: the line goes between. */
    async serve(): Promise<void> {
        const server = this.child([command, 'hmi', '--listen', `127.0.0.2:${this.port}`, '--socket', this.socket, ...(this.users_ ? ['--users', this.users_] : ['--role', this.role_]),
            '--page', join(build, 'hmi_page/page'), '--audit', join(this.folder, 'audit')], this.folder);
        this.server_ = server.process;
        await until('the server listens', () => {
            if (server.process.exitCode !== null) throw new Error(`taktwerk hmi ended:\n${server.said()}`);
            this.port = Number(/http:\/\/[^\s/]*:(\d+)\//.exec(server.said())?.[1] ?? 0);
            return this.port !== 0;
        });
    }
    /** Another server in its place, for another role. */
    async serve_as(role: string): Promise<void> {
        const old = this.server_;
        const gone = new Promise((resolve) => old?.once('exit', resolve));
        old?.kill('SIGTERM');
        await gone;
        this.role_ = role;
        await this.serve();
    }
    signal_server(signal: NodeJS.Signals): void {
        this.server_?.kill(signal);
    }
    /** To the processes that draw pages, of this browser alone. */
    signal_renderers(signal: NodeJS.Signals): number {
        const parents = new Map<number, number>(), renderers: number[] = [];
        for (const name of readdirSync('/proc')) {
            const pid = Number(name);
            if (!Number.isInteger(pid)) continue;
            try {
                parents.set(pid, Number(/\) \S (\d+)/.exec(readFileSync(`/proc/${pid}/stat`, 'utf8'))?.[1]));
                if (readFileSync(`/proc/${pid}/cmdline`, 'utf8').includes('--type=renderer')) renderers.push(pid);
            } catch { /* it has just ended */ }
        }
        const mine = renderers.filter((pid) => {
            for (let up: number | undefined = pid; up; up = parents.get(up)) if (up === process.pid) return true;
            return false;
        });
        for (const pid of mine) process.kill(pid, signal);
        return mine.length;
    }
    /** The browser takes the pointer away from a button that is held. It gives and takes a capture with the pointer's next message only: what is not given yet cannot be lost. */
    async lose_capture(button: Locator): Promise<void> {
        const box = await button.boundingBox();
        let by = 2;
        const moved_until = (what: string, told: string) => until(what, async () => {
            if (box) await this.page.mouse.move(box.x + box.width / 2 + (by = -by), box.y + box.height / 2);
            return (await button.getAttribute(told)) !== null;
        });
        await button.evaluate((held) => {
            held.addEventListener('pointermove', () => held.setAttribute('data-moved', ''), { once: true });
            held.addEventListener('lostpointercapture', () => held.setAttribute('data-lost', ''), { once: true });
        });
        await moved_until('the capture is given', 'data-moved');
        await button.evaluate((held) => held.releasePointerCapture(1));
        await moved_until('the capture is lost', 'data-lost');
    }
    /** A fresh page, as of somebody who comes for the first time. */
    async look(hash = '', taste: Taste = {}): Promise<void> {
        await this.page?.context().close();
        this.sent = [];
        this.page = await this.another(hash, taste, this.sent);
    }
    /** One more browser window, of another person. */
    async another(hash = '', taste: Taste = {}, sent: Json[] = []): Promise<Page> {
        const context: BrowserContext = await this.browser.newContext({ viewport: { width: 1280, height: 800 }, locale: 'en-GB', hasTouch: true });
        await context.addInitScript((kept) => {
            for (const [key, text] of Object.entries(kept)) if (localStorage.getItem(key) === null) localStorage.setItem(key, text);
        }, { theme: taste.theme ?? 'light', language: taste.language ?? 'en' });
        const page = await context.newPage();
        page.on('console', (message) => message.type() === 'error' && !/WebSocket|status of 401/.test(message.text()) && this.complaints.push(message.text()));
        page.on('pageerror', (error) => this.complaints.push(String(error)));
        page.on('websocket', (socket) => {
            const asked = new Set<number>();
            this.asked_.set(page, asked);
            socket.on('framesent', ({ payload }) => {
                const message = JSON.parse(String(payload)) as Json;
                sent.push(message);
                if (message['type'] === 'command') asked.add(Number(message['id']));
            });
            socket.on('framereceived', ({ payload }) => {
                const answer = /^\{"type":"(?:answer|error)","id":(\d+)/.exec(String(payload).slice(0, 60));
                if (answer) asked.delete(Number(answer[1]));
            });
        });
        await page.goto(this.address + hash);
        await page.locator(this.users_ ? 'body main' : 'body:not([data-stale]) .page').waitFor({ timeout: patience });
        return page;
    }
    /** Another page of the same window, with all that it asked for. */
    async go(place: string): Promise<void> {
        await this.page.evaluate((hash) => { location.hash = hash; }, place);
        await this.page.locator(`.page.${/^\w+/.exec(place)?.[0] ?? ''}`).waitFor();
        await this.settled();
    }
    /** Answers and values have come, and are drawn. */
    async settled(page = this.page): Promise<void> {
        const shown = () => page.evaluate(() => document.body.dataset['cycle']);
        for (let left = 3, before = await shown(); left > 0;) {
            let now = before;
            await until('values come', async () => (now = await shown()) !== before);
            left = (this.asked_.get(page)?.size ?? 0) > 0 ? 3 : left - 1;
            before = now;
        }
    }
    async axis(name: string): Promise<Axis> {
        return ((await this.machine.state())['axes'] as Axis[]).find((axis) => axis.name === name) as Axis;
    }
    /** A command of the test's own: what was too late is given again. */
    async told(request: Json): Promise<Json> {
        for (const end = Date.now() + patience; ;) {
            const answer = await this.machine.ask(request), what = String((answer['error'] as Json | undefined)?.['what']);
            if (answer['ok'] === true) return answer;
            if (!late.test(what) || Date.now() > end) throw new Error(`${JSON.stringify(request)}: ${what}\n${await this.testimony()}`);
        }
    }
    /** What the page tells: a refusal, or why it let go by itself. */
    async notice(page = this.page): Promise<string> {
        return (await page.locator('.notice').textContent()) ?? '';
    }
    async hush(page = this.page): Promise<void> {
        await page.evaluate(() => document.querySelector<HTMLButtonElement>('.notice button')?.click());
    }
    /** Presses, and it holds; or the page says that it came too late: only then it is pressed again, as a person would. */
    async insist(what: string, press: () => Promise<unknown>, holds: () => Promise<boolean>, page = this.page): Promise<void> {
        for (const end = Date.now() + patience; ;) {
            await this.hush(page);
            await press();
            let said = '', done = false;
            await until(what, async () => {
                done = await holds();
                said = await this.notice(page);
                return done || late.test(said);
            });
            if (done || (await holds())) return;
            if (Date.now() > end) throw new Error(`${what}: ${said}`);
        }
    }
    /** Presses the middle of it with the mouse and leaves it pressed. */
    async press_down(button: Locator, page = this.page): Promise<void> {
        const box = await button.boundingBox();
        if (!box) throw new Error('the button is not on the screen');
        await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
        await page.mouse.down();
    }
    /** A cycle that began after this was asked. */
    async cycle_from_now(): Promise<number> {
        const cycle = async () => Number((await this.machine.state())['cycle']), known = await cycle();
        let newer = known;
        await until('the machine goes on', async () => (newer = await cycle()) > known);
        return newer;
    }
    /** Machine time, ms. */
    async machine_ms(): Promise<number> {
        return Number((await this.machine.state())['time_ns']) / 1e6;
    }
    /** So much of it passes. */
    async passes(ms: number): Promise<void> {
        const from = await this.machine_ms();
        await until(`${ms} ms pass`, async () => (await this.machine_ms()) >= from + ms);
    }
    async powered_and_homed(name: string): Promise<void> {
        const state = async () => (await this.axis(name)).state;
        const rests = async (): Promise<boolean> => (await this.axis(name)).powered && (await state()) === 'Standstill';
        for (const end = Date.now() + patience; !(await rests());) {
            if ((await state()) === 'ErrorStop') await this.told({ cmd: 'reset' });  // a computer that stood still for long; all of it, not this axis alone
            await until(`${name} is reset`, async () => (await state()) !== 'ErrorStop');
            await this.told({ cmd: 'enable', axis: name });
            await until(`${name} has power`, async () => (await rests()) || ((await state()) === 'ErrorStop' && Date.now() < end));
        }
        if ((await this.axis(name)).homed) return;
        await this.told({ cmd: 'home', axis: name });
        await until(`${name} is homed`, async () => (await this.axis(name)).homed && (await rests()));
    }
    async stands(name: string, ms = patience): Promise<void> {
        await until(`${name} stands`, async () => (await this.axis(name)).set_velocity === 0 && (await this.axis(name)).state === 'Standstill', ms);
    }
    /** For whoever reads why a test failed. */
    async testimony(): Promise<string> {
        const within = <T>(what: Promise<T>): Promise<T | string> => Promise.race([what.catch((why: unknown) => String(why)), pause(3000).then(() => 'no answer')]);
        const state = await within(this.machine?.state() ?? Promise.resolve('no machine'));
        const short = typeof state === 'string' ? state : JSON.stringify({
            cycle: state['cycle'], mode: state['mode'], alarms: (state['alarms'] as Json[] | undefined)?.map((a) => `${String(a['source'])} ${String(a['english'])}: ${String(a['cause'])}`),
            axes: (state['axes'] as Axis[] | undefined)?.map((a) => `${a.name} ${a.state} ${a.owner} ${a.set_position}`), events: (state['events'] as Json[] | undefined)?.slice(-4).map((e) => e['english']),
        });
        const page = this.page && !this.page.isClosed() ? await within(this.page.evaluate(() => `${location.hash} ${document.querySelector('.live')?.textContent ?? ''}; ${document.querySelector('.notice')?.textContent ?? ''}; `
            + `focus on ${document.activeElement?.outerHTML.slice(0, 120) ?? ''}; ${document.querySelector('main')?.innerText.slice(0, 600) ?? ''}`)) : 'no page';
        return `the machine: ${short}\nthe page: ${page}\nthe browser: ${this.complaints.slice(-4).join('; ')}`;
    }
    async end(): Promise<void> {
        await this.browser?.close();
        await this.line?.close();
        this.machine?.close();
        for (const child of this.children_.reverse()) {
            if (child.exitCode !== null || child.signalCode !== null) continue;
            const gone = new Promise((resolve) => child.once('exit', resolve));
            child.kill('SIGCONT');
            child.kill('SIGTERM');
            await gone;
        }
        rmSync(this.folder, { recursive: true, force: true });
    }
    private child([program = '', ...words]: string[], cwd: string): { process: ChildProcess; said: () => string } {
        let said = '';
        const child = spawn(program, words, { stdio: ['ignore', 'pipe', 'pipe'], cwd });
        for (const stream of [child.stdout, child.stderr]) stream?.on('data', (text) => (said += String(text)));
        this.children_.push(child);
        return { process: child, said: () => said };
    }
}
