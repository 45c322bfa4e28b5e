// A machine that runs, the relay in front of it, a browser that looks at it.
import { ChildProcess, spawn } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { Browser, chromium, Page } from 'playwright-core';
import { Machine, Relay } from './relay';

export interface Axis {
    name: string;
    state: string;
    powered: boolean;
    homed: boolean;
    unit: string;
    actual_position: number;
    actual_velocity: number;
    set_position: number;
    set_velocity: number;
}

const build = process.env['TAKTWERK_BUILD'] ?? '';
const source = process.env['TAKTWERK_SOURCE'] ?? '';
const patience = 20_000;

export async function until(what: string, holds: () => Promise<boolean> | boolean, ms = patience): Promise<void> {
    for (const end = Date.now() + ms; Date.now() < end; await pause(20)) if (await holds()) return;
    throw new Error(`not within ${ms} ms: ${what}`);
}
export const pause = (ms: number): Promise<void> => new Promise((resolve) => setTimeout(resolve, ms));

export class Cell {
    relay!: Relay;
    machine!: Machine;
    browser!: Browser;
    page!: Page;
    address = '';
    readonly complaints: string[] = [];
    private runtime_: ChildProcess | undefined;
    private readonly folder_ = mkdtempSync(join(tmpdir(), 'hmi-page-'));

    /** The demo without its programs and happenings: an operator alone with three axes. */
    async start(): Promise<void> {
        const demo = readFileSync(join(source, 'config/machines/demo.yaml'), 'utf8');
        const path = join(this.folder_, 'demo.sock');
        const quiet = demo.replace(/^programs:[\s\S]*?(?=^# --- Safety)/m, '').replace('start_mode: automatic', 'start_mode: manual')
            .replace(/^  events:[\s\S]*$/m, '').replace('enabled: true, required: false', 'enabled: false').replace(/^hmi:$/m, `hmi:\n  socket: ${path}`)
            .replace('\nhmi:', '\nhmi:');
        const file = join(this.folder_, 'demo.yaml');
        writeFileSync(file, quiet.includes('socket:') ? quiet : quiet + `\nsocket: ${path}\n`);
        let said = '';
        this.runtime_ = spawn(join(build, 'taktwerk'), ['run', file], { stdio: ['ignore', 'pipe', 'pipe'], cwd: source });
        for (const stream of [this.runtime_.stdout, this.runtime_.stderr]) stream?.on('data', (text) => (said += String(text)));
        await until('the machine runs', async () => {
            if (this.runtime_?.exitCode != null) throw new Error(`taktwerk run ended:\n${said}`);
            try {
                this.machine ??= await Machine.open(path);
                return (await this.machine.state())['phase'] === 'running';
            } catch {
                return false;
            }
        });
        this.relay = new Relay(join(build, 'hmi_page/page'), path);
        this.address = await this.relay.listen();
        this.browser = await chromium.launch({
            executablePath: '/usr/bin/chromium', headless: true,
            args: ['--no-sandbox', '--disable-gpu', '--disable-quic', '--no-first-run', '--disable-background-networking', '--disable-component-update', '--disable-sync'],
        });
        await this.look();
    }
    /** A fresh page, as of somebody who comes for the first time. */
    async look(hash = ''): Promise<void> {
        await this.page?.context().close();
        const context = await this.browser.newContext({ viewport: { width: 1280, height: 800 }, locale: 'en-GB', hasTouch: true });
        this.page = await context.newPage();
        this.page.on('console', (message) => message.type() === 'error' && !message.text().includes('WebSocket') && this.complaints.push(message.text()));
        this.page.on('pageerror', (error) => this.complaints.push(String(error)));
        await this.page.goto(this.address + hash);
        await this.page.locator('body:not([data-stale])').waitFor({ timeout: patience });
    }
    async axis(name: string): Promise<Axis> {
        return ((await this.machine.state())['axes'] as Axis[]).find((axis) => axis.name === name) as Axis;
    }
    async powered_and_homed(name: string): Promise<void> {
        await this.machine.ask({ cmd: 'enable', axis: name });
        await until(`${name} has power`, async () => (await this.axis(name)).powered && (await this.axis(name)).state === 'Standstill');
        if ((await this.axis(name)).homed) return;
        await this.machine.ask({ cmd: 'home', axis: name });
        await until(`${name} is homed`, async () => (await this.axis(name)).homed && (await this.axis(name)).state === 'Standstill', 40_000);
    }
    async stands(name: string, ms: number): Promise<void> {
        await until(`${name} stands`, async () => (await this.axis(name)).set_velocity === 0 && (await this.axis(name)).state === 'Standstill', ms);
    }
    async end(): Promise<void> {
        await this.browser?.close();
        await this.relay?.close();
        this.machine?.close();
        if (this.runtime_ && this.runtime_.exitCode === null) {
            const gone = new Promise((resolve) => this.runtime_?.once('exit', resolve));
            this.runtime_.kill('SIGTERM');
            await gone;
        }
        rmSync(this.folder_, { recursive: true, force: true });
    }
}
