// A picture of the page of a group: the SCARA, while an axis of it is at its limit. Writes FOLDER/group.png, and group-zh.png beside it where `both`.
import { writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { Cell, pause, until } from './cell';
import { small_png } from './small_png';

export async function group_picture(folder: string, both = false): Promise<void> {
    const cell = new Cell();
    try {
        // A computer that is late at times is not what is looked at.
        await cell.start({ file: 'scara.yaml', machine: (yaml) => `${yaml}\nwatch: { overruns_allowed: 1000, lateness_warning: 900 ms }\n` });
        await cell.told({ cmd: 'set_parameter', parameter: 'speed', value: 500 });
        for (const [name, taste] of [['group', {}], ['group-zh', { theme: 'dark', language: 'zh' }]] as const) {
            if (name !== 'group' && !both) continue;
            await cell.look('#group/arm', taste);
            await pause(7000);
            await until('an axis holds it back', async () => (await cell.page.locator('tr[data-limiting]').count()) > 0);
            const picture = small_png(await cell.page.screenshot());
            writeFileSync(join(folder, `${name}.png`), picture);
            console.log(`${name}.png ${(picture.length / 1024).toFixed(0)} kB`);
        }
    } finally {
        await cell.end();
    }
}
