// The last seconds of some values as curves: every cycle, from the machine's recorder; from a machine without one, what the page itself has seen.
import { Desk } from '../desk';
import { colour_of, is_dark } from '../scope/colours';
import { LaneChart } from '../scope/lane_chart';
import { Live, Reader } from '../scope/pull';
import { Channel, Signal } from '../scope/signals';
import { look } from '../scope/stack';
import { Store } from '../scope/store';
import { MachineState } from '../state';
import { element, write } from '../view';
import { WidgetLayout } from './builder_views';
import { number_of, text_of } from './reading';
import { boxed, MakeWidget, Widget } from './widget';

/** ms between two questions, and until a machine that did not answer is asked again. */
const pull_every = 100, again_after = 2000;
/** s between two values that the page keeps by itself. */
const own_step_s = 0.05;
const height = 190;
const tick_steps = [1, 2, 5, 10, 20, 30, 60, 120];

/** Where the samples come from. `cycle_s`: s between two of them. */
interface Source {
    readonly store: Store;
    readonly cycle_s: number;
    step(state: MachineState): void;
}

class Trend implements Widget {
    readonly root: HTMLElement;
    private readonly host_ = element('div', { class: 'trend-host' });
    private readonly numbers_: HTMLElement[];
    private readonly names_: string[];
    private source_: Source | undefined;
    private chart_: LaneChart | undefined;
    private asked_at_ = -1e9;
    private asking_ = false;
    private left_ = false;
    private drawn_ = -1;
    private readonly watch_: ResizeObserver;

    constructor(private readonly desk_: Desk, private readonly layout_: WidgetLayout) {
        const values = layout_.values ?? [];
        this.names_ = values.map((value) => value.name);
        this.numbers_ = values.map(() => element('b', { class: 'number' }));
        const legend = element('div', { class: 'trend-legend' }, ...values.map((value, i) => {
            const line = element('span', { class: 'trend-line', 'aria-hidden': 'true' });
            line.style.borderTopColor = colour_of(i, is_dark());
            return element('span', { class: 'trend-name' }, line, `${i + 1} ${value.name} `, this.numbers_[i] as HTMLElement, ` ${value.unit}`);
        }));
        this.root = boxed(layout_, 'trend', legend, this.host_);
        this.watch_ = new ResizeObserver(() => (this.drawn_ = -1));
        this.watch_.observe(this.host_);
    }

    update(state: MachineState): void {
        (this.layout_.values ?? []).forEach((value, i) => write(this.numbers_[i] as HTMLElement, text_of(state, value, this.layout_.decimals)));
        if (!this.source_) void this.begin();
        this.source_?.step(state);
        this.draw();
    }
    leave(): void {
        this.left_ = true;
        this.watch_.disconnect();
        this.chart_?.destroy();
    }

    private async begin(): Promise<void> {
        const link = this.desk_.link;
        if (this.asking_ || performance.now() - this.asked_at_ < again_after || !link.opened) return;
        this.asking_ = true;
        this.asked_at_ = performance.now();
        const answer = link.allowed('scope_signals') ? await link.request({ cmd: 'scope_signals' }) : { ok: false, error: { code: 'request.unknown_command', what: '' } };
        this.asking_ = false;
        if (this.left_) return;
        const code = answer.error?.code ?? '';
        if (!answer.ok && (code.startsWith('page.') || code === 'web.busy')) return;  // again in a moment
        this.source_ = answer.ok ? this.recorder(answer['scope'] as Record<string, unknown>) : this.own_eyes();
    }

    private recorder(scope: Record<string, unknown>): Source {
        const cycle_ns = Number(scope['cycle_ns']), cycles = Math.ceil((this.layout_.seconds ?? 20) * 1e9 / cycle_ns);
        const known = new Set((scope['signals'] as Signal[]).map((signal) => signal.name));
        const store = new Store(cycles + Math.ceil(2e9 / cycle_ns));
        const reader = new Reader((request) => this.desk_.link.request(request), undefined, store, cycle_ns);
        reader.extent = { first: Number(scope['first']), last: Number(scope['last']) };
        const live = new Live(reader);
        live.names = this.names_.filter((name) => known.has(name));
        reader.on_restart = () => {
            this.source_ = undefined;
            this.drawn_ = -1;
        };
        let due = 0, busy = false;
        return {
            store, cycle_s: cycle_ns / 1e9,
            step: () => {
                if (busy || performance.now() < due || this.left_) return;
                busy = true;
                due = performance.now() + pull_every;
                void live.step().finally(() => (busy = false));
            },
        };
    }

    private own_eyes(): Source {
        const store = new Store(Math.ceil((this.layout_.seconds ?? 20) / own_step_s) + 40);
        const values = this.layout_.values ?? [], one = new Float64Array(1);
        let last = -1;
        return {
            store, cycle_s: own_step_s,
            step: (state) => {
                const at = Math.floor(state.time_ns / 1e9 / own_step_s);
                if (at < last) store.clear();
                // A step that no state fell into repeats the one before; a longer silence is a gap.
                for (let i = last >= 0 && at - last <= 4 ? last + 1 : at; i <= at; i++)
                    for (const value of values) {
                        one[0] = number_of(state, value);
                        store.put(value.name, i, one);
                    }
                last = at;
            },
        };
    }

    private draw(): void {
        const source = this.source_;
        if (!source || source.store.newest === this.drawn_ || this.host_.clientWidth < 80) return;
        this.chart_ ??= this.make_chart();
        this.drawn_ = source.store.newest;
        const span = (this.layout_.seconds ?? 20) / source.cycle_s, to = source.store.newest;
        this.chart_.set_size(this.host_.clientWidth, height);
        this.chart_.draw({ store: source.store, from: to - span, to, ticks: this.ticks(to, source.cycle_s), signal: () => undefined, number: (key) => this.names_.indexOf(key) + 1, newest: to });
    }
    /** Seconds before the newest. */
    private ticks(to: number, cycle_s: number): { cycle: number; text: string }[] {
        const seconds = this.layout_.seconds ?? 20, step = tick_steps.find((wanted) => seconds / wanted <= 6) ?? seconds;
        const out: { cycle: number; text: string }[] = [];
        for (let back = Math.floor(seconds / step) * step; back >= 0; back -= step) out.push({ cycle: to - back / cycle_s, text: back === 0 ? '0 s' : `−${back} s` });
        return out;
    }
    private make_chart(): LaneChart {
        const channels: Channel[] = this.names_.map((name, i) => ({ name, offset: 0, hidden: false, colour: i, apart: false }));
        const unit = this.layout_.values?.[0]?.unit ?? '';
        const chart = new LaneChart({ key: 'trend', unit, digital: false, channels }, look(), true, this.host_);
        const { minimum, maximum } = this.layout_;
        if (minimum !== undefined && maximum !== undefined) chart.manual = { min: minimum, max: maximum };
        return chart;
    }
}

export const trend_widget: MakeWidget = (desk, layout) => new Trend(desk, layout);
