// Every value of an axis with its unit, in two columns: motion, and who moves it by what.
import { Desk, panel, Values } from '../desk';
import { fixed, hex } from '../numbers';
import { AxisState, value } from '../state';
import { say, word } from '../texts';
import { element } from '../view';

export class AxisValues {
    private readonly left_ = new Values();
    private readonly right_ = new Values();
    private readonly peaks_: HTMLButtonElement;
    readonly root: HTMLElement;

    constructor(private readonly desk_: Desk, name: string, private readonly unit_: string) {
        this.peaks_ = desk_.button('reset_peaks', () => ({ cmd: 'reset_peaks', axis: name }), 'small');
        this.root = panel('values', element('div', { class: 'two' }, this.left_.root, this.right_.root), element('div', { class: 'peaks' }, this.peaks_));
    }
    update(axis: AxisState): void {
        const unit = this.unit_, left = this.left_, right = this.right_;
        left.set('target_position', axis.has_job ? `${fixed(axis.target_position)} ${unit}` : '–');
        left.set('distance_to_go', axis.has_job ? `${fixed(value(axis.target_position) - value(axis.set_position))} ${unit}` : '–');
        left.set('set_velocity', `${fixed(axis.set_velocity)} ${unit}/s`);
        left.set('set_acceleration', `${fixed(axis.set_acceleration, 1)} ${unit}/s²`);
        left.set('set_jerk', `${fixed(axis.set_jerk, 0)} ${unit}/s³`);
        left.set('actual_torque', `${fixed(value(axis.actual_torque) * 100, 1)} %`);
        left.set('following_window', `± ${fixed(axis.following_window)} ${unit}`);
        left.set('following_peaks', axis.following_error_min === undefined ? '–' : `${fixed(axis.following_error_min)} … ${fixed(axis.following_error_max)} ${unit}`);
        right.set('owner', word('owner', axis.owner));
        right.set('command', axis.command || '–');
        right.set('block', axis.block || '–');
        right.set('queued', String(axis.queued));
        right.set('limiter', word('limiter', axis.velocity_limiter));
        right.set('override', `${fixed(value(axis.override) * 100, 0)} %`);
        right.set('drive_state', word('drive', axis.drive_state));
        right.set('drive_error', axis.drive_error === 0 ? say('none_of_these') : hex(axis.drive_error));
        right.set('error', axis.error === 0 ? say('none_of_these') : String(axis.error));
        this.desk_.permit(this.peaks_, 'reset_peaks', axis.following_error_min !== undefined, say('not_known'));
    }
}
