// The hand on a measurement: the same press, renewals and endings as a jog's (../jog.ts), with another request.
import { Desk } from '../desk';
import { JogHold, watch_page } from '../jog';
import { Request } from '../link';

export interface MeasureHold {
    readonly hold: JogHold;
    /** What the next press asks for. */
    order: Request;
}

const made = new WeakMap<Desk, MeasureHold>();

/** One for the page: the endings that no button sees are watched once. */
export function measure_hold(desk: Desk): MeasureHold {
    const known = made.get(desk);
    if (known) return known;
    const it: MeasureHold = {
        order: { cmd: 'measure' },
        hold: new JogHold({
            jog: async (axis, velocity, press) => {
                const answer = await desk.link.request(velocity === 0 ? { cmd: 'stop', axis } : press ? { ...it.order, cmd: 'measure', axis, press } : { cmd: 'measure', axis });
                if (!answer.ok && press) desk.refused(answer);
                return answer.ok;
            },
            blocked: () => !desk.link.opened || desk.link.stalled,
            stale: () => desk.link.stale,
        }, { now: () => performance.now(), every: (period, step) => { const timer = setInterval(step, period); return () => clearInterval(timer); } }),
    };
    watch_page(it.hold);
    desk.link.on_lost(() => it.hold.end('socket'));
    made.set(desk, it);
    return it;
}
