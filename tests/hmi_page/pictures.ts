// node pictures.mjs FOLDER: a picture of each page, as docs/hmi.md shows them.
import { mkdirSync } from 'node:fs';
import { join } from 'node:path';
import { Cell, pause, Taste } from './cell';

const folder = process.argv[2] ?? '.';
mkdirSync(folder, { recursive: true });
const cell = new Cell();
try {
    await cell.start({ machine: (yaml) => yaml.replace('start_mode: automatic', 'start_mode: manual').replace(/^  events:[\s\S]*$/m, '').replace('overruns_allowed: 10', 'overruns_allowed: 1000, lateness_warning: 900 ms') });
    for (const axis of ['x', 'y', 'z']) await cell.powered_and_homed(axis);
    await cell.machine.ask({ cmd: 'move', axis: 'x', position: 600, velocity: 100 });
    const take = async (name: string, hash: string, taste: Taste = {}) => {
        await cell.look(`#${hash}`, taste);
        await pause(700);
        await cell.page.screenshot({ path: join(folder, `${name}.png`) });
    };
    await take('axis', 'axis/x');
    await cell.machine.ask({ cmd: 'move', axis: 'x', position: 60, velocity: 100 });
    await take('axis-dark-zh', 'axis/x', { theme: 'dark', language: 'zh' });
    await take('drive', 'axis/x/drive');
    await take('overview', 'overview');
    await take('io', 'io');
    await take('programs', 'programs');
    await take('bus', 'bus');
    await take('system', 'system');
    await cell.machine.ask({ cmd: 'simulate', line: 'drive-fault y 0x3130' });
    await pause(500);
    await take('alarms', 'alarms');
    await take('alarms-history', 'alarms/history');
} finally {
    await cell.end();
}
