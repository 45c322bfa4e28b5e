// node figures.mjs [SECONDS PAIRS MINUTES]: what the page costs, on a machine of 64 axes that all move, in real time (tests/bench/hmi/run.sh starts it).
// SECONDS: of a window with and of one without the page's server; PAIRS of such windows, in turn; MINUTES: of values at ten times the usual rate.
import { ChildProcess, spawn } from 'node:child_process';
import { mkdtempSync, readdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { cpus, tmpdir } from 'node:os';
import { join } from 'node:path';
import { gzipSync } from 'node:zlib';
import { chromium } from 'playwright-core';
import { Json, Machine } from './machine';
import { PageClient } from './page_client';

const build = process.env['TAKTWERK_BUILD'] ?? '', source = process.env['TAKTWERK_SOURCE'] ?? '';
const [seconds = 10, pairs = 6, minutes = 6] = process.argv.slice(2).map(Number);
// As a machine is set up (realtime.cpus): the cycle has a CPU of its own, and everything else the others. TAKTWERK_PIN=0: wherever the system puts it.
const pinned = process.env['TAKTWERK_PIN'] !== '0' && cpus().length > 1;
const others = `0-${cpus().length - 2}`;
const axes = 64, clients = 4, usual_rate = 20, raised_rate = 200;
const folder = mkdtempSync(join(tmpdir(), 'hmi-figures-')), socket = join(folder, 'figures.sock');
const children: ChildProcess[] = [];
const pause = (ms: number): Promise<void> => new Promise((resolve) => setTimeout(resolve, ms));
const say = (line: string): void => console.log(line);
const sorted = (values: number[]): number[] => [...values].sort((a, b) => a - b);
const percentile = (values: number[], part: number): number => sorted(values)[Math.min(values.length - 1, Math.floor(part * values.length))] ?? NaN;
const median = (values: number[]): number => percentile(values, 0.5);

function machine_file(): string {
    const list = Array.from({ length: axes }, (_, i) => i + 1);
    return ['version: 1', 'name: figures', 'cycle: 1 ms', 'start_mode: automatic', 'bus:', '  interface: simulated', '  sync0_shift: 900 us', '  slaves:',
        ...list.map((i) => `    - { name: d${i}, profile: sv33-e }`), 'axes:',
        ...list.map((i) => `  a${i}: { slave: d${i}, unit: mm, gearing: { counts_per_revolution: 131072, feed: 10 mm }, limits: { velocity: 300 mm/s, acceleration: 2000 mm/s2, jerk: 50000 mm/s3 }, following_error: { window: 50 mm, time: 1 s }, homing: { kind: set_here }, require_homed: false }`),
        'programs:', `  shuttles: { library: ${join(build, 'tests/bench/shuttles.so')}, autostart: true, tasks: { main: { every: 1 cycles } } }`,
        `realtime: { priority: 80, lock_memory: true, required: false${pinned ? `, cpus: [${cpus().length - 1}]` : ''} }`, 'watch: { overruns_allowed: 1000 }', 'simulation: { supervision: relaxed }',
        'hmi:', `  socket: ${socket}`, '  lcm: { enabled: true, required: false, commands: disabled }', ''].join('\n');
}
function start(args: string[]): { process: ChildProcess; said: () => string } {
    const command = [...(pinned && args[0] !== 'run' ? ['taskset', '-c', others] : []), join(build, 'taktwerk'), ...args];
    const child = spawn(command[0] ?? '', command.slice(1), { stdio: ['ignore', 'pipe', 'pipe'], cwd: source });
    children.push(child);
    let said = '';
    for (const stream of [child.stdout, child.stderr]) stream?.on('data', (text) => (said = (said + String(text)).slice(-20_000)));
    return { process: child, said: () => said };
}
async function until(what: string, holds: () => Promise<boolean> | boolean, ms = 60_000): Promise<void> {
    for (const end = Date.now() + ms; Date.now() < end; await pause(20)) if (await holds()) return;
    throw new Error(`not within ${ms} ms: ${what}`);
}
/** Its CPU time so far, seconds, and its memory, MB. */
function spent(pid: number): { cpu: number; resident: number } {
    const fields = readFileSync(`/proc/${pid}/stat`, 'utf8').split(') ')[1]?.split(' ') ?? [];
    return { cpu: (Number(fields[11]) + Number(fields[12])) / 100, resident: Number(/VmRSS:\s*(\d+)/.exec(readFileSync(`/proc/${pid}/status`, 'utf8'))?.[1]) / 1024 };
}
async function serve(rate = usual_rate): Promise<{ process: ChildProcess; port: number; source: () => Promise<string> }> {
    const server = start(['hmi', '--listen', '127.0.0.1:0', '--socket', socket, '--page', join(build, 'hmi_page/page'), '--audit', join(folder, 'audit'), '--rate', String(rate)]);
    let port = 0;
    await until('the server listens', () => {
        if (server.process.exitCode !== null) throw new Error(`taktwerk hmi ended:\n${server.said()}`);
        return (port = Number(/http:\/\/[^\s/]*:(\d+)\//.exec(server.said())?.[1] ?? 0)) !== 0;
    });
    const hello = async () => {
        const client = await PageClient.open('127.0.0.1', port);
        const said = () => String((JSON.parse(client.newest.get('hello') ?? '{}') as Json)['source'] ?? '');
        await until('values by a known way', () => said() !== '' && client.newest.has('state'));
        client.close();
        return said();
    };
    return { process: server.process, port, source: hello };
}
async function ended(child: ChildProcess): Promise<void> {
    if (child.exitCode !== null) return;
    child.kill('SIGTERM');
    await new Promise((resolve) => child.once('exit', resolve));
}

/** Every cycle's computing time since `from`, us, from the recorder: the whole window in pieces that fit an answer. */
async function computing(machine: Machine, signal: string, from: number, to: number): Promise<number[]> {
    const all: number[] = [];
    for (let at = from; at < to;) {
        const answer = await machine.told({ cmd: 'scope_read', signals: [signal], from: at, to: Math.min(to, at + 4000), points: 4000 });
        if (Number(answer['missing']) > 0) throw new Error('the recorder has lost part of the window');
        const bytes = Buffer.from(String((answer['data'] as string[])[0]), 'base64');
        for (let i = 0; i + 8 <= bytes.length; i += 8) all.push(bytes.readDoubleLE(i));
        at = Number(answer['to']);
    }
    return all;
}

async function cycles(machine: Machine): Promise<void> {
    if (pairs === 0) return;
    const listed = ((await machine.told({ cmd: 'scope_signals' }))['scope'] as Json)['signals'] as { name: string; unit: string }[];
    const signal = listed.find((s) => /comput/.test(s.name));
    if (!signal) throw new Error('the recorder has no computing time');
    const to_us = signal.unit === 'ns' ? 1e-3 : signal.unit === 's' ? 1e6 : 1;
    const now = async () => Number((await machine.state())['cycle']);
    const off: number[][] = [], on: number[][] = [], server_cpu: number[] = [], ratios: number[] = [];
    let source = '', values = 0;
    for (let pair = 0; pair < pairs; ++pair) {
        const window = async (to: number[][]) => {
            await pause(1000);
            const from = await now();
            await pause(seconds * 1000);
            to.push((await computing(machine, signal.name, from, await now())).map((value) => value * to_us));
        };
        await window(off);
        const server = await serve();
        source = await server.source();
        const pages = await Promise.all(Array.from({ length: clients }, () => PageClient.open('127.0.0.1', server.port)));
        const before = spent(server.process.pid ?? 0), began = performance.now(), messages = pages.reduce((sum, page) => sum + page.messages, 0);
        await window(on);
        const took = (performance.now() - began) / 1000;
        server_cpu.push((spent(server.process.pid ?? 0).cpu - before.cpu) / took);
        values = (pages.reduce((sum, page) => sum + page.messages, 0) - messages) / took / clients;
        for (const page of pages) page.close();
        await ended(server.process);
        ratios.push(percentile(on[pair] ?? [], 0.99) / percentile(off[pair] ?? [], 0.99));
    }
    const row = (name: string, windows: number[][]) => {
        const p = (part: number) => median(windows.map((w) => percentile(w, part))).toFixed(1);
        say(`  ${name.padEnd(28)} p50 ${p(0.5)} us, p99 ${p(0.99)} us, p99.9 ${p(0.999)} us  (medians of ${windows.length} windows of ${seconds} s)`);
    };
    say(`computing time of a cycle, ${axes} axes that move, 1 ms, every cycle counted; the cycle ${pinned ? 'on a CPU of its own' : 'wherever the system puts it'}`);
    row('without the page', off);
    row(`with ${clients} pages`, on);
    const together = (windows: number[][]) => percentile(windows.flat(), 0.99);
    say(`  p99 with / without          ${(together(on) / together(off)).toFixed(3)} over all cycles together; of the pairs: ${sorted(ratios).map((r) => r.toFixed(3)).join(', ')}; median ${median(ratios).toFixed(3)}`);
    say(`the page's server: ${(median(server_cpu) * 100).toFixed(1)} % of a core (${sorted(server_cpu).map((c) => (c * 100).toFixed(1)).join(', ')}), ${clients} pages, each ${values.toFixed(1)} messages a second, values over ${source}`);
}

const browser_arguments = ['--no-sandbox', '--disable-gpu', '--disable-quic', '--no-first-run', '--disable-background-networking', '--disable-component-update', '--disable-sync', '--js-flags=--expose-gc'];

async function first_values(): Promise<void> {
    const server = await serve();
    const browser = await chromium.launch({ executablePath: '/usr/bin/chromium', headless: true, args: browser_arguments });
    const times: number[] = [];
    for (let i = 0; i < 10; ++i) {
        const context = await browser.newContext({ viewport: { width: 1280, height: 800 } });
        const page = await context.newPage();
        await page.goto(`http://127.0.0.1:${server.port}/#overview`, { waitUntil: 'commit' });
        // From the navigation's own beginning to the frame in which a position stands on the screen.
        times.push(await page.evaluate(() => new Promise<number>((resolve) => {
            const look = () => (/\d/.test(document.querySelector('main [data-value="position"]')?.textContent ?? '') ? requestAnimationFrame(() => resolve(performance.now())) : requestAnimationFrame(look));
            look();
        })));
        await context.close();
    }
    say(`first values on the screen of a new browser page: median ${median(times).toFixed(0)} ms, worst of ${times.length} ${Math.max(...times).toFixed(0)} ms`);
    await browser.close();
    await ended(server.process);
}

function bundle(): void {
    const files = readdirSync(join(build, 'hmi_page/page')).map((name) => ({ name, bytes: gzipSync(readFileSync(join(build, 'hmi_page/page', name)), { level: 9 }).length }));
    say(`the page's files, gzip: ${(files.reduce((sum, file) => sum + file.bytes, 0) / 1000).toFixed(1)} kB (${files.map((file) => `${file.name} ${(file.bytes / 1000).toFixed(1)}`).join(', ')})`);
}

/** A minute of 32 signals of which each cycle counts, in a browser: what the page itself marks as missing, looked at each second, and what it exports at the end. */
async function scope(machine: Machine): Promise<void> {
    const listed = ((await machine.told({ cmd: 'scope_signals' }))['scope'] as Json)['signals'] as { name: string; kind: string; group: string }[];
    const names = listed.filter((s) => s.kind === 'real' && s.group === 'axis').map((s) => s.name).slice(0, 32);
    const server = await serve();
    const browser = await chromium.launch({ executablePath: '/usr/bin/chromium', headless: true, args: browser_arguments });
    const page = await browser.newPage({ viewport: { width: 1280, height: 800 } });
    await page.addInitScript((channels) => {
        localStorage.setItem('scope_last', JSON.stringify({ taktwerk_scope: 1, span_s: 15, channels: channels.map((name, colour) => ({ name, colour, offset: 0 })) }));
    }, names);
    await page.goto(`http://127.0.0.1:${server.port}/#scope`);
    await page.locator('.scope-values tbody tr').nth(31).waitFor();
    let looks = 0, missing = 0;
    for (const end = Date.now() + 60_000; Date.now() < end; await pause(1000)) {
        ++looks;
        missing += await page.locator('tr[data-missing]').count();
    }
    await page.locator('[data-do="files"]').click();
    const [download] = await Promise.all([page.waitForEvent('download'), page.locator('[data-do="save_csv"]').click()]);
    const [head = '', ...rows] = readFileSync(await download.path(), 'utf8').trimEnd().split('\n');
    const lacking = rows.filter((row) => /(^|,)(nan)?(,|$)/.test(row)).length;
    say(`scope of ${names.length} signals at 1 kHz, 60 s: ${missing} signals with a gap in ${looks} looks; exported ${rows.length} cycles of ${head.split(',').length - 1} signals, ${lacking} with a hole`);
    await browser.close();
    await ended(server.process);
}

async function memory(): Promise<void> {
    const server = await serve(raised_rate);
    const browser = await chromium.launch({ executablePath: '/usr/bin/chromium', headless: true, args: browser_arguments });
    const page = await browser.newPage({ viewport: { width: 1280, height: 800 } });
    await page.goto(`http://127.0.0.1:${server.port}/#overview`);
    const counter = await PageClient.open('127.0.0.1', server.port);
    const devtools = await page.context().newCDPSession(page);
    const look = async () => {
        await devtools.send('HeapProfiler.collectGarbage');
        const heap = (await devtools.send('Runtime.getHeapUsage')) as { usedSize: number };
        const nodes = await page.evaluate(() => document.getElementsByTagName('*').length);
        return { server: spent(server.process.pid ?? 0).resident, heap: heap.usedSize / 1e6, nodes, values: counter.messages };
    };
    await pause(15_000);
    const samples = [await look()];
    for (let i = 0; i < 6; ++i) {
        await pause((minutes * 60_000) / 6);
        samples.push(await look());
    }
    const values = (samples.at(-1)?.values ?? 0) - (samples[0]?.values ?? 0);
    say(`memory over ${values} values (${(values / usual_rate / 3600).toFixed(2)} h at ${usual_rate} Hz): server ${samples.map((s) => s.server.toFixed(1)).join(', ')} MB; page's heap ${samples.map((s) => s.heap.toFixed(1)).join(', ')} MB; elements ${samples.map((s) => s.nodes).join(', ')}`);
    counter.close();
    await browser.close();
    await ended(server.process);
}

try {
    say(`${cpus().length} x ${cpus()[0]?.model ?? 'CPU'}, load ${readFileSync('/proc/loadavg', 'utf8').split(' ').slice(0, 3).join(' ')}`);
    writeFileSync(join(folder, 'figures.yaml'), machine_file());
    const run = start(['run', join(folder, 'figures.yaml'), '--quiet']);
    let machine: Machine | undefined;
    await until('axes move', async () => {
        if (run.process.exitCode !== null) throw new Error(`taktwerk run ended:\n${run.said()}`);
        try {
            machine ??= await Machine.open(socket);
            return ((await machine.state())['axes'] as Json[]).filter((axis) => axis['state'] === 'DiscreteMotion').length > axes / 2;
        } catch {
            return false;
        }
    });
    if (!machine) throw new Error('no machine');
    bundle();
    await cycles(machine);
    await first_values();
    await scope(machine);
    await memory();
    machine.close();
} catch (failure) {
    console.error(String(failure));
    process.exitCode = 1;
} finally {
    for (const child of children) child.kill('SIGTERM');
    await pause(1500);
    for (const child of children) child.kill('SIGKILL');
    rmSync(folder, { recursive: true, force: true });
}
