// A recording's file, from the machine's disk into the browser's downloads, piece by piece as the machine gives it.
import { Desk } from './desk';
import { save_file } from './save';
import { say } from './texts';
import { element, write } from './view';

/** Bytes; a recording has some megabytes. */
const largest = 512 * 1024 * 1024;

/** False: it did not come whole, and why has been told. */
export async function copy_recording(desk: Desk, name: string, told: (part: number) => void): Promise<boolean> {
    const pieces: BlobPart[] = [];
    for (let from = 0, size = 1; from < size;) {
        const answer = await desk.link.request({ cmd: 'recording_part', recording: name, from });
        if (!answer.ok) {
            desk.refused(answer);
            return false;
        }
        const piece = Uint8Array.from(atob(String(answer['data'] ?? '')), (letter) => letter.charCodeAt(0));
        size = Number(answer['size']);
        if (piece.length === 0 || !(size <= largest)) {
            desk.tell('refused', say('recording_not_whole'));
            return false;
        }
        pieces.push(piece);
        from += piece.length;
        told(from / size);
    }
    save_file(`${name}.twscope`, 'application/octet-stream', new Blob(pieces));
    return true;
}

/** Saves the recording; says how far it is meanwhile. */
export function copy_button(desk: Desk, name: string): { root: HTMLButtonElement; permit(complete: boolean): void } {
    let busy = false;
    const root = element('button', {
        type: 'button', class: 'small', 'data-do': 'copy_recording', 'aria-label': `${say('save_recording')} ${name}`, title: `${name}.twscope`,
        onclick: () => {
            busy = true;
            void copy_recording(desk, name, (part) => write(root, `${Math.round(part * 100)} %`)).finally(() => {
                busy = false;
                write(root, say('save_recording'));
            });
        },
    }, say('save_recording'));
    return { root, permit: (complete) => desk.permit(root, 'recording_part', complete && !busy, say('being_recorded')) };
}
