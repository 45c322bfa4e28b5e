// What can be measured, and what each kind asks for. A field that is left empty is decided by the machine (axes/excitation/excitation_plan.hpp).
import { Key } from '../texts';

export interface Field {
    readonly key: string;
    readonly title: Key;
    /** Behind the number: `u` is the axis' unit. */
    readonly unit: string;
}
export interface Kind {
    readonly kind: string;
    readonly fields: readonly Field[];
}

const distance: Field = { key: 'distance', title: 'measure_distance', unit: 'u' };
const velocity: Field = { key: 'velocity', title: 'measure_velocity', unit: 'u/s' };
const acceleration: Field = { key: 'acceleration', title: 'measure_acceleration', unit: 'u/s²' };
const count = (title: Key): Field => ({ key: 'count', title, unit: '' });

export const kinds: readonly Kind[] = [
    { kind: 'step', fields: [distance, velocity, acceleration, count('measure_count')] },
    { kind: 'ramp', fields: [distance, velocity, acceleration, count('measure_count')] },
    { kind: 'friction', fields: [distance, velocity, acceleration, count('measure_velocities')] },
    { kind: 'sweep', fields: [{ key: 'distance', title: 'measure_amplitude', unit: 'u' }, velocity, acceleration, { key: 'from_hz', title: 'measure_from_hz', unit: 'Hz' },
        { key: 'to_hz', title: 'measure_to_hz', unit: 'Hz' }, count('measure_frequencies')] },
    { kind: 'following', fields: [distance, velocity, acceleration, count('measure_velocities')] },
    { kind: 'cogging', fields: [distance, velocity, { key: 'period', title: 'measure_period', unit: 'u' }, count('measure_count')] },
];

/** As the socket says it (hmi_bridge/README.md). */
export interface Plan {
    kind: string;
    unit: string;
    velocity: number;
    acceleration: number;
    lowest: number;
    highest: number;
    margin: number;
    duration_s: number;
}
