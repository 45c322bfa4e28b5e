// Pictures of the scope, for docs/scope.md: part of pictures.ts.
import { Cell, pause, Taste, until } from './cell';

export async function scope_pictures(cell: Cell, keep: (name: string) => Promise<void>): Promise<void> {
    const look = async (channels: string[], more: object = {}, taste: Taste = {}): Promise<void> => {
        await cell.look('#scope', taste);
        await cell.page.evaluate(([names, rest]) => localStorage.setItem('scope_last', JSON.stringify({
            taktwerk_scope: 1, span_s: 8, channels: (names as string[]).map((name, colour) => ({ name, colour, offset: 0, apart: name.endsWith('following_error') })), ...(rest as object),
        })), [channels, more] as const);
        await cell.page.reload();
        await cell.page.locator('.page.scope .uplot canvas:visible').first().waitFor({ timeout: 60_000 });
        await pause(1000);
        await cell.page.locator('[data-do="signals"][aria-expanded="true"]').click();
    };
    const move = (axis: string, position: number, velocity: number) => cell.machine.ask({ cmd: 'move', axis, position, velocity });
    const press = (what: string) => cell.page.locator(`[data-do="${what}"]`).click();
    const of_x = ['x.set_position', 'x.actual_position', 'x.set_velocity', 'x.actual_velocity', 'x.following_error', 'x.state', 'x.velocity_limiter', 'in.part_present'];

    await look(of_x);
    await move('x', 320, 150);
    await pause(3500);
    await move('x', 120, 150);
    await pause(3500);
    await press('cursors');
    await pause(1200);
    await keep('scope');
    await move('x', 250, 100);
    await look(of_x, {}, { theme: 'dark', language: 'zh' });
    await pause(2500);
    await keep('scope-zh');

    await look([...of_x, 'in.start_button'], { trigger: { kind: 'rising', signal: 'x.set_velocity', level: 20, mode: 'single', length_s: 1, before_percent: 20 } });
    await cell.stands('x', 15_000);
    await press('trigger');
    await press('arm');
    await pause(800);
    await move('x', 320, 150);
    await cell.page.locator('.scope-marker:visible').waitFor({ timeout: 10_000 });
    await pause(600);
    await keep('scope-trigger');

    await look(['x.set_velocity', 'x.actual_velocity', 'x.actual_torque'], { view: 'spectrum', spectrum: { lane: '[mm/s]', window: 'hann', decibel: true } });
    await move('x', 120, 100);
    await pause(2500);
    await press('freeze');
    await pause(800);
    await keep('scope-fft');
}

/** Of the alarm that came last. */
export async function recording_picture(cell: Cell, keep: (name: string) => Promise<void>): Promise<void> {
    await pause(500);
    let name = '';
    await until('the recording is there', async () => {
        const newest = ((await cell.machine.ask({ cmd: 'recordings' }))['recordings'] as { name: string; complete: boolean }[] | undefined)?.[0];
        name = newest?.complete ? newest.name : '';
        return name !== '';
    });
    await cell.look(`#scope/recording/${encodeURIComponent(name)}`);
    await cell.page.locator('.scope-marker:visible').waitFor({ timeout: 60_000 });
    await cell.page.locator('[data-do="files"]').click();
    await pause(2500);
    await keep('scope-recording');
}
