// A screenshot with at most 256 colours: a page has few, the rest are the edges of letters. Half the bytes, and nobody sees it.
import { crc32 as zlib_crc32, deflateSync, inflateSync } from 'node:zlib';

const signature = Buffer.from([0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a]);

const table = Array.from({ length: 256 }, (_, n) => {
    let c = n;
    for (let k = 0; k < 8; k++) c = c & 1 ? 0xedb88320 ^ (c >>> 1) : c >>> 1;
    return c >>> 0;
});
/** zlib's own is there from node 20.15 on. */
function crc32(bytes: Buffer): number {
    if (typeof zlib_crc32 === 'function') return zlib_crc32(bytes);
    let c = 0xffffffff;
    for (const byte of bytes) c = (table[(c ^ byte) & 0xff] ?? 0) ^ (c >>> 8);
    return (c ^ 0xffffffff) >>> 0;
}
function chunk(kind: string, data: Buffer): Buffer {
    const out = Buffer.alloc(12 + data.length);
    out.writeUInt32BE(data.length, 0);
    out.write(kind, 4, 'latin1');
    data.copy(out, 8);
    out.writeUInt32BE(crc32(out.subarray(4, 8 + data.length)), 8 + data.length);
    return out;
}

/** 8 bits a channel, RGB or RGBA, not interlaced: what a browser's screenshot is. Opaque. */
function pixels(png: Buffer): { width: number; height: number; colours: Uint32Array } {
    let width = 0, height = 0, channels = 0;
    const data: Buffer[] = [];
    for (let at = 8; at < png.length;) {
        const length = png.readUInt32BE(at), kind = png.toString('latin1', at + 4, at + 8), body = png.subarray(at + 8, at + 8 + length);
        if (kind === 'IHDR') {
            [width, height] = [body.readUInt32BE(0), body.readUInt32BE(4)];
            channels = body[9] === 6 ? 4 : body[9] === 2 ? 3 : 0;
            if (body[8] !== 8 || channels === 0 || body[12] !== 0) throw new Error('no screenshot');
        } else if (kind === 'IDAT') data.push(body);
        at += 12 + length;
    }
    const raw = inflateSync(Buffer.concat(data)), stride = width * channels;
    const colours = new Uint32Array(width * height);
    let above = new Uint8Array(stride);
    for (let y = 0; y < height; y++) {
        const filter = raw[y * (stride + 1)], line = new Uint8Array(stride);
        for (let i = 0; i < stride; i++) {
            const a = i >= channels ? line[i - channels] ?? 0 : 0, b = above[i] ?? 0, c = i >= channels ? above[i - channels] ?? 0 : 0;
            const p = a + b - c, [pa, pb, pc] = [Math.abs(p - a), Math.abs(p - b), Math.abs(p - c)];
            const guess = filter === 0 ? 0 : filter === 1 ? a : filter === 2 ? b : filter === 3 ? (a + b) >> 1 : pa <= pb && pa <= pc ? a : pb <= pc ? b : c;
            line[i] = (raw[y * (stride + 1) + 1 + i] ?? 0) + guess;
        }
        for (let x = 0; x < width; x++) colours[y * width + x] = ((line[x * channels] ?? 0) << 16) | ((line[x * channels + 1] ?? 0) << 8) | (line[x * channels + 2] ?? 0);
        above = line;
    }
    return { width, height, colours };
}

export function small_png(png: Buffer): Buffer {
    const { width, height, colours } = pixels(png);
    const often = new Map<number, number>();
    for (const colour of colours) often.set(colour, (often.get(colour) ?? 0) + 1);
    const palette = [...often].sort((a, b) => b[1] - a[1]).slice(0, 256).map(([colour]) => colour);
    const index = new Map(palette.map((colour, i) => [colour, i]));
    const nearest = (colour: number): number => {
        let best = 0, least = Infinity;
        palette.forEach((other, i) => {
            const distance = [16, 8, 0].reduce((sum, shift) => sum + (((colour >> shift) & 255) - ((other >> shift) & 255)) ** 2, 0);
            if (distance < least) [best, least] = [i, distance];
        });
        index.set(colour, best);
        return best;
    };
    const raw = Buffer.alloc(height * (width + 1));
    for (let y = 0; y < height; y++)
        for (let x = 0; x < width; x++) {
            const colour = colours[y * width + x] ?? 0;
            raw[y * (width + 1) + 1 + x] = index.get(colour) ?? nearest(colour);
        }
    const head = Buffer.alloc(13);
    head.writeUInt32BE(width, 0);
    head.writeUInt32BE(height, 4);
    head[8] = 8;
    head[9] = 3;
    const plte = Buffer.from(palette.flatMap((colour) => [(colour >> 16) & 255, (colour >> 8) & 255, colour & 255]));
    return Buffer.concat([signature, chunk('IHDR', head), chunk('PLTE', plte), chunk('IDAT', deflateSync(raw, { level: 9 })), chunk('IEND', Buffer.alloc(0))]);
}
