// Files that leave the page: made here, handed to the browser's downloads. Nothing is sent anywhere.
import { element } from './view';

export function save_file(name: string, kind: string, content: BlobPart): void {
    const address = URL.createObjectURL(new Blob([content], { type: kind }));
    element('a', { href: address, download: name }).click();
    setTimeout(() => URL.revokeObjectURL(address), 10_000);
}

/** RFC 4180, with a byte order mark so that spreadsheets read Chinese. What would begin a formula there is kept from it by an apostrophe. */
export function csv(rows: readonly (readonly string[])[]): string {
    const field = (text: string): string => {
        const safe = /^[=+\-@\t\r]/.test(text) && Number.isNaN(Number(text)) ? `'${text}` : text;
        return /[",\r\n]/.test(safe) ? `"${safe.replaceAll('"', '""')}"` : safe;
    };
    return '\ufeff' + rows.map((row) => row.map(field).join(',') + '\r\n').join('');
}

/** 2026-11-25 22:04:05, by this computer's clock; of microseconds since 1970. */
export function local_time(utime: number): string {
    const at = new Date(utime / 1000), two = (n: number) => String(n).padStart(2, '0');
    return `${at.getFullYear()}-${two(at.getMonth() + 1)}-${two(at.getDate())} ${two(at.getHours())}:${two(at.getMinutes())}:${two(at.getSeconds())}`;
}
/** The same for a file's name. */
export const file_time = (): string => local_time(Date.now() * 1000).replace(' ', '_').replaceAll(':', '-');
