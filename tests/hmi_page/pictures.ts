// node pictures.mjs FOLDER: a picture of each page, as docs/hmi.md shows them.
import { mkdirSync } from 'node:fs';
import { join } from 'node:path';
import { Cell } from './cell';

const folder = process.argv[2] ?? '.';
mkdirSync(folder, { recursive: true });
const cell = new Cell();
try {
    await cell.start();
    for (const axis of ['x', 'y', 'z']) await cell.powered_and_homed(axis);
    await cell.machine.ask({ cmd: 'move', axis: 'x', position: 600, velocity: 100 });
    const take = async (name: string, hash: string, theme = 'light', language = 'en') => {
        await cell.page.evaluate(([t, l]) => {
            localStorage.setItem('theme', t ?? '');
            localStorage.setItem('language', l ?? '');
        }, [theme, language]);
        await cell.page.goto(`${cell.address}?${name}#${hash}`);
        await cell.page.locator('body:not([data-stale]) .page').waitFor();
        await cell.page.waitForTimeout(400);
        await cell.page.screenshot({ path: join(folder, `hmi-${name}.png`) });
    };
    await take('axis', 'axis/x');
    await take('axis-dark-zh', 'axis/x', 'dark', 'zh');
    await take('overview', 'overview');
    await take('io', 'io');
    await take('programs', 'programs');
    await take('bus', 'bus');
    await take('system', 'system');
    await cell.machine.ask({ cmd: 'simulate', line: 'drive-fault y 0x3130' });
    await cell.page.waitForTimeout(500);
    await take('alarms', 'alarms');
} finally {
    await cell.end();
}
