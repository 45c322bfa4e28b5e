// Whether an axis' values are those of now.
import { AxisState } from '../state';

/** Its drive does not answer: what it said last is not what is. */
export const is_old = (axis: AxisState): boolean => !axis.online && !axis.disabled;
