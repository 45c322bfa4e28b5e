// Samples as they come: base64 of little-endian f64. Decoded into one array that is used again, for twenty answers a second would else be twenty heaps of garbage.

const sextets = new Uint8Array(128);
for (let i = 0; i < 64; i++) sextets['ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/'.charCodeAt(i)] = i;

export class Doubles {
    private bytes_ = new Uint8Array(8 * 4096);

    /** The numbers of a text; valid until the next call. What does not fill a number is left out. */
    decode(text: string): Float64Array {
        let length = text.length;
        while (length > 0 && text.charCodeAt(length - 1) === 61) length--;  // =
        const bytes = Math.floor((length * 3) / 4);
        if (bytes > this.bytes_.length) this.bytes_ = new Uint8Array(Math.ceil((bytes * 2) / 8) * 8);
        const to = this.bytes_;
        const six = (at: number): number => (at < length ? sextets[text.charCodeAt(at) & 127] ?? 0 : 0);
        for (let at = 0, out = 0; at < length; at += 4, out += 3) {
            const word = (six(at) << 18) | (six(at + 1) << 12) | (six(at + 2) << 6) | six(at + 3);
            to[out] = word >> 16;
            to[out + 1] = word >> 8;
            to[out + 2] = word;
        }
        return new Float64Array(to.buffer, 0, bytes >> 3);  // every browser's numbers are little-endian
    }
}
