// The head of an axis: where it is, in large letters; what it shall; its state and lamps; the ruler.
import { Desk, write_lamp, write_state } from '../desk';
import { fixed } from '../numbers';
import { AxisLayout, AxisState, value } from '../state';
import { Key, say, word } from '../texts';
import { element, mark, write } from '../view';
import { is_old } from './is_old';
import { Ruler } from './ruler';

const lamps = ['powered', 'homed', 'in_position', 'has_job', 'moving_negative', 'moving_positive', 'constant_velocity', 'coupled', 'limit_negative', 'home_switch', 'limit_positive', 'warning'] as const;
type Lamp = (typeof lamps)[number];

/** Each lamp: whether it is lit, and whether that is bad. */
export function lit(axis: AxisState): Record<Lamp, boolean> {
    const velocity = value(axis.set_velocity);
    return {
        powered: axis.powered, homed: axis.homed, in_position: axis.in_position, has_job: axis.has_job, moving_negative: velocity < 0, moving_positive: velocity > 0,
        constant_velocity: velocity !== 0 && value(axis.set_acceleration) === 0, coupled: axis.state === 'SynchronizedMotion',
        limit_negative: axis.negative_limit_switch, home_switch: axis.home_switch, limit_positive: axis.positive_limit_switch, warning: axis.warning,
    };
}
const bad: readonly Lamp[] = ['limit_negative', 'limit_positive', 'warning'];
/** What only the drive can say: unknown while it does not answer. */
const of_drive: readonly Lamp[] = ['in_position', 'limit_negative', 'home_switch', 'limit_positive', 'warning'];
const text_of: Record<Lamp, Key> = {
    powered: 'powered', homed: 'lamp_homed', in_position: 'lamp_in_position', has_job: 'has_job', moving_negative: 'moving_negative', moving_positive: 'moving_positive',
    constant_velocity: 'constant_velocity', coupled: 'coupled', limit_negative: 'limit_negative', home_switch: 'home_switch', limit_positive: 'limit_positive', warning: 'lamp_warning',
};

export class AxisHead {
    private readonly position_ = element('output', { class: 'big', 'data-value': 'big_position' });
    private readonly state_ = element('div', { class: 'state', 'data-value': 'state' });
    private readonly facts_: Record<string, HTMLElement> = {};
    private readonly lamps_ = lamps.map((name) => element('span', { class: 'lamp', 'data-lamp': name }));
    private readonly old_ = element('div', { class: 'last-known', hidden: true, 'data-value': 'last_known' }, say('last_known'));
    private readonly ruler_ = new Ruler();
    readonly root: HTMLElement;

    constructor(_desk: Desk, private readonly layout_: AxisLayout) {
        const fact = (key: Key): HTMLElement[] => {
            this.facts_[key] = element('dd', { 'data-value': `head_${key}` });
            const hint: Record<string, string> = key === 'following_error' ? { title: say('following_hint') } : {};
            return [element('dt', hint, say(key)), this.facts_[key]];
        };
        this.root = element('section', { class: 'panel head' }, element('div', { class: 'head-line' },
            element('div', { class: 'head-position' }, element('div', {}, this.position_, element('span', { class: 'big-unit' }, layout_.unit)), this.old_),
            element('dl', { class: 'values facts' }, ...(['set_position', 'actual_velocity', 'following_error'] as const).flatMap(fact)),
            element('div', { class: 'head-side' }, this.state_, element('div', { class: 'lamps' }, ...this.lamps_))), this.ruler_.root);
    }
    update(axis: AxisState): void {
        const { unit } = this.layout_;
        const old = is_old(axis);
        mark(this.root, 'data-old', old);
        this.old_.hidden = !old;
        write(this.position_, fixed(axis.actual_position));
        write_state(this.state_, axis, word('axis', axis.state));
        for (const [key, text] of [['set_position', `${fixed(axis.set_position)} ${unit}`], ['actual_velocity', old ? '–' : `${fixed(axis.actual_velocity)} ${unit}/s`], ['following_error', old ? '–' : `${fixed(axis.following_error)} ${unit}`]] as const) {
            const cell = this.facts_[key];
            if (cell) write(cell, text);
        }
        const on = lit(axis);
        lamps.forEach((name, i) => {
            const lamp = this.lamps_[i];
            if (!lamp) return;
            const lights = on[name] && !(old && of_drive.includes(name));
            write_lamp(lamp, lights, say(text_of[name]), bad.includes(name) ? 'bad' : 'good');
            mark(lamp, 'data-on', lights);
        });
        this.ruler_.update(this.layout_, axis);
    }
}
