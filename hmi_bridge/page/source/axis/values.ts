// Every value of an axis with its unit: motion in one column, who moves it by what in the other; below them the following error within its window.
import { Desk, panel, Values } from '../desk';
import { fixed, hex } from '../numbers';
import { AxisState, value } from '../state';
import { say, word } from '../texts';
import { element, mark, write } from '../view';
import { is_old } from './is_old';

/** Where a following error stands between the ends of its window: 0 to 1. */
export const place_in_window = (error: number, window: number): number => (window > 0 && Number.isFinite(window) ? Math.min(1, Math.max(0, (error / window + 1) / 2)) : 0.5);

/** The following error of now and its peaks of all cycles, drawn within the window that stops the axis. */
class FollowingError {
    private readonly span_ = element('i', { class: 'lag-span' });
    private readonly now_ = element('i', { class: 'lag-now' });
    private readonly said_ = element('output', { class: 'number', 'data-value': 'following_peaks' });
    private readonly bar_ = element('div', { class: 'lag', role: 'img' }, this.span_, this.now_, element('i', { class: 'lag-zero' }));
    private readonly anew_: HTMLButtonElement;
    readonly root: HTMLElement;

    constructor(private readonly desk_: Desk, name: string, private readonly unit_: string) {
        this.anew_ = desk_.button('reset_peaks', () => ({ cmd: 'reset_peaks', axis: name }), 'small');
        this.root = element('div', { class: 'lag-line' }, element('span', { class: 'label' }, say('following_peaks')), this.said_, this.bar_, this.anew_);
    }
    update(axis: AxisState): void {
        const window = value(axis.following_window), known = axis.following_error_min !== undefined;
        const low = value(axis.following_error_min), high = value(axis.following_error_max);
        write(this.said_, known ? `${fixed(low)} … ${fixed(high)} ${this.unit_}` : '–');
        mark(this.bar_, 'aria-label', `${fixed(axis.following_error)} (± ${fixed(window)}) ${this.unit_}`);
        mark(this.bar_, 'title', `± ${fixed(window)} ${this.unit_}`);
        this.now_.style.left = `${(place_in_window(value(axis.following_error), window) * 100).toFixed(1)}%`;
        this.span_.hidden = !known;
        if (known) {
            this.span_.style.left = `${(place_in_window(low, window) * 100).toFixed(1)}%`;
            this.span_.style.right = `${((1 - place_in_window(high, window)) * 100).toFixed(1)}%`;
        }
        this.desk_.permit(this.anew_, 'reset_peaks', known, say('not_known'));
    }
}

export class AxisValues {
    private readonly left_ = new Values();
    private readonly right_ = new Values();
    private readonly following_: FollowingError;
    readonly root: HTMLElement;

    constructor(desk: Desk, name: string, private readonly unit_: string, private readonly modulo_: boolean) {
        this.following_ = new FollowingError(desk, name, unit_);
        this.right_.root.classList.add('words');
        this.root = panel('values', element('div', { class: 'two' }, this.left_.root, this.right_.root), this.following_.root);
    }
    update(axis: AxisState): void {
        const old = is_old(axis), sign = (on: boolean | undefined): string => (on === undefined ? '–' : on ? '●' : '○');
        const unit = this.unit_, left = this.left_, right = this.right_;
        left.set('target_position', axis.has_job ? `${fixed(axis.target_position)} ${unit}` : '–');
        left.set('distance_to_go', axis.has_job ? `${fixed(value(axis.target_position) - value(axis.set_position))} ${unit}` : '–');
        left.set('set_velocity', `${fixed(axis.set_velocity)} ${unit}/s`);
        left.set('set_acceleration', `${fixed(axis.set_acceleration, 1)} ${unit}/s²`);
        left.set('set_jerk', `${fixed(axis.set_jerk, 0)} ${unit}/s³`);
        left.set('actual_torque', old ? '–' : `${fixed(value(axis.actual_torque) * 100, 1)} %`);
        left.set('following_window', `± ${fixed(axis.following_window)} ${unit}`);
        left.set('override', `${fixed(value(axis.override) * 100, 0)} %`);
        right.set('owner', word('owner', axis.owner));
        right.set('command', axis.command || '–');
        right.set('block', axis.block || '–');
        right.set('queued', String(axis.queued));
        right.set('limiter', word('limiter', axis.velocity_limiter));
        right.set('enables', [axis.enable, axis.enable_positive, axis.enable_negative].map(sign).join(' '));
        right.set('drive_state', old ? '–' : word('drive', axis.drive_state));
        right.set('drive_error', old ? '–' : axis.drive_error === 0 ? say('none_of_these') : hex(axis.drive_error));
        right.set('error', axis.error === 0 ? say('none_of_these') : axis.error_name ?? hex(axis.error));
        if (axis.master) right.set('follows', axis.master);
        if (this.modulo_) left.set('turns', String(axis.turns));
        this.following_.update(axis);
    }
}
