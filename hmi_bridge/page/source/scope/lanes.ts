// Which curve goes where: analog lanes by unit, one lane of bands for bits and states; and the scale of a lane.
import { Channel, is_digital, key_of, Signal } from './signals';

export interface Lane {
    /** The unit, or the one curve that stands apart; "bands" for bits and states. */
    key: string;
    unit: string;
    digital: boolean;
    channels: Channel[];
}

export function lanes_of(channels: readonly Channel[], signal: (name: string) => Signal | undefined): Lane[] {
    const lanes = new Map<string, Lane>();
    for (const channel of channels) {
        const about = signal(channel.name);
        const digital = is_digital(channel, about);
        // A word beside other words; what has no unit beside what has none.
        const unit = about?.unit ?? '';
        const key = digital ? 'bands' : (channel.apart ? `${key_of(channel)}` : `[${unit || about?.kind || ''}]`);
        let lane = lanes.get(key);
        if (!lane) lanes.set(key, (lane = { key, unit, digital, channels: [] }));
        lane.channels.push(channel);
    }
    const list = [...lanes.values()];
    return [...list.filter((lane) => !lane.digital), ...list.filter((lane) => lane.digital)];
}

export interface Range {
    min: number;
    max: number;
}

/** Of the value itself: what lies nearer together is the last digit trembling, and no scale has labels for it. */
const least_part = 1e-5;

/** Room around what is shown; a flat curve gets a little of its own size. */
export function range_around(low: number, high: number): Range {
    if (!(low <= high) || !Number.isFinite(low) || !Number.isFinite(high)) return { min: -1, max: 1 };
    const size = Math.max(Math.abs(high), Math.abs(low));
    const room = high > low ? Math.max((high - low) * 0.06, (size * least_part - (high - low)) / 2) : Math.max(size * 0.05, 1.2e-3);
    return { min: low - room, max: high + room };
}

/** Grows at once, shrinks only when a third would stay empty: a scale that moves with every sample cannot be read. */
export function next_range(now: Range | undefined, low: number, high: number): Range {
    const wanted = range_around(low, high);
    if (!now || !(low <= high)) return wanted;
    const inside = low >= now.min && high <= now.max;
    return inside && wanted.max - wanted.min > (now.max - now.min) * 0.67 ? now : wanted;
}
