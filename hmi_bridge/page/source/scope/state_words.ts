// Names of states in the page's language: English ones as PLCopen and the drives' standard have them, Chinese ones by the table of texts.
import { current_language, word } from '../texts';
import { Signal, state_name } from './signals';

/** The last part of a signal's name: the group of its words. */
const groups: Record<string, string> = { state: 'axis', drive_state: 'drive', owner: 'owner', velocity_limiter: 'limiter', drive_mode: 'drivemode', mode: 'mode', phase: 'phase' };

export function state_text(signal: Signal | undefined, value: number): string {
    const name = state_name(signal, value), group = groups[signal?.name.split('.').pop() ?? ''];
    return current_language() === 'en' || group === undefined ? name : word(group, name);
}
