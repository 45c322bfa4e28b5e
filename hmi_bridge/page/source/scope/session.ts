// What the scope shows, kept while other pages are looked at: the machine as it runs, a recording of an alarm, or a file. No elements here.
import { Answer, Link } from '../link';
import { Cursors, place_cursors } from './cursors';
import { CsvFile } from './csv';
import { seconds_of, time_signal } from './cycle_time';
import { Live, load, Reader } from './pull';
import { Setup, empty_setup, most_channels, SavedSetups } from './setup';
import { Channel, first_choice, key_of, Signal } from './signals';
import { free_place } from './colours';
import { capacity_for, Store } from './store';
import { arm_request, next_event, Trigger, TriggerState } from './trigger';
import { View } from './view';

export interface Marker {
    cycle: number;
    /** 'automatic': shown because none came. */
    kind: 'trigger' | 'automatic' | 'alarm';
    text: string;
}

/** Something that can be looked at. */
export interface Scene {
    kind: 'live' | 'recording' | 'file';
    title: string;
    /** What it is, beside its title. */
    about?: string;
    cycle_ns: number;
    signals: Map<string, Signal>;
    store: Store;
    view: View;
    marker?: Marker;
    /** Machine time of a cycle: s. */
    seconds(cycle: number): number;
    /** Brings samples of what is shown; true: there are more to be had at once. */
    fetch(names: readonly string[]): Promise<boolean>;
}

export interface Recording {
    name: string;
    alarm: string;
    source: string;
    utime: number;
    from: number;
    to: number;
    alarm_cycle: number;
    bytes: number;
    complete: boolean;
}
export type Trouble = 'scope_no_machine' | 'scope_no_recorder' | '';

/** ms between two questions. */
const pull_every = 66;
const look_for_trigger_every = 200;
const again_after = 1000;

const described = (scope: Record<string, unknown>): Map<string, Signal> => new Map((scope['signals'] as Signal[]).map((signal) => [signal.name, signal]));

/** A cycle that was late has its own time: it comes with the samples. */
const with_time = (names: readonly string[], signals: Map<string, Signal>): string[] => (names.length > 0 && signals.has(time_signal) && !names.includes(time_signal) ? [...names, time_signal] : [...names]);
export class Session {
    setup: Setup;
    cursors: Cursors = { shown: false, a: 0, b: 0 };
    scene: Scene | undefined;
    live: Scene | undefined;
    trouble: Trouble = 'scope_no_machine';
    trigger: TriggerState | undefined;
    private trigger_text_ = '';
    private shown_event_ = -1;
    private wanted_axis_ = '';
    private machine_ = '';
    private busy_ = false;
    private pulled_at_ = -1e9;
    private asked_at_ = -1e9;
    private trigger_at_ = -1e9;

    constructor(private readonly link_: Pick<Link, 'request' | 'opened' | 'machine' | 'layout'>, readonly saved: SavedSetups) {
        this.setup = saved.last ?? empty_setup();
    }

    signal(name: string): Signal | undefined {
        return this.scene?.signals.get(name);
    }
    /** Names of the signals that curves are made of, each once. */
    get names(): string[] {
        return [...new Set(this.setup.channels.map((channel) => channel.name))];
    }

    /** Called often, by the clock `now` (ms); does what is due. */
    async step(now: number): Promise<void> {
        if (this.busy_) return;
        this.busy_ = true;
        try {
            if (this.link_.machine !== this.machine_) this.leave_machine();
            if (!this.live && now - this.asked_at_ > again_after) {
                this.asked_at_ = now;
                await this.begin();
            }
            if (this.wanted_axis_ && this.live) {
                const axis = this.wanted_axis_;
                this.wanted_axis_ = '';
                this.show_live();
                if (first_choice([...this.live.signals.values()], axis).every((n) => this.live?.signals.get(n)?.of === axis)) {
                    this.setup.channels = [];
                    this.choose_first(this.live, axis);
                }
            }
            if (now - this.pulled_at_ >= pull_every) {
                this.pulled_at_ = now;
                // The machine goes on being read while a file is looked at: coming back, nothing is missing.
                for (const scene of new Set([this.live, this.scene])) if (scene && (await scene.fetch(this.names.filter((name) => scene.signals.has(name))))) this.pulled_at_ = -1e9;
                this.live?.view.tie(this.live.store.newest);
            }
            if (this.trigger && now - this.trigger_at_ >= look_for_trigger_every) {
                this.trigger_at_ = now;
                await this.look_at_trigger();
            }
        } finally {
            this.busy_ = false;
        }
    }

    private leave_machine(): void {
        this.machine_ = this.link_.machine;
        if (this.scene === this.live) this.scene = undefined;
        this.live = undefined;
        this.trigger = undefined;
    }

    private async begin(): Promise<void> {
        if (!this.link_.opened || !this.link_.layout) {
            this.trouble = 'scope_no_machine';
            return;
        }
        const answer = await this.link_.request({ cmd: 'scope_signals' });
        if (!answer.ok) {
            this.trouble = answer.error?.code.startsWith('request.') || answer.error?.code.startsWith('web.') ? 'scope_no_recorder' : 'scope_no_machine';
            return;
        }
        this.trouble = '';
        const scope = answer['scope'] as Record<string, unknown>;
        const cycle_ns = Number(scope['cycle_ns']);
        const store = new Store(capacity_for(this.names.length, cycle_ns));
        const reader = new Reader((request) => this.link_.request(request), undefined, store, cycle_ns);
        reader.extent = { first: Number(scope['first']), last: Number(scope['last']) };
        const live = new Live(reader);
        const scene: Scene = {
            kind: 'live', title: this.machine_, cycle_ns, signals: described(scope), store, view: new View(cycle_ns, this.setup.span_s),
            seconds: (cycle) => seconds_of(store, cycle, cycle_ns, reader.zero_ns),
            fetch: async (names) => {
                const all = with_time(names, scene.signals), capacity = capacity_for(all.length, cycle_ns);
                store.keep(all, capacity);
                live.names = all;
                return live.step();
            },
        };
        reader.on_restart = () => {  // another run of the machine: other cycles, perhaps other signals
            if (this.live !== scene) return;
            this.live = undefined;
            if (this.scene === scene) this.scene = undefined;
            this.trigger = undefined;
            this.asked_at_ = -1e9;
        };
        this.live = scene;
        this.scene ??= scene;
        if (this.setup.channels.length === 0) this.choose_first(scene);
    }

    // --- what is shown ---------------------------------------------------------------------------------------------------------
    show_live(): void {
        this.scene = this.live;
        if (!this.scene) return;
        delete this.scene.marker;
        this.scene.view.follow = true;
        this.scene.view.tie(this.scene.store.newest);
        this.cursors.shown = false;
    }
    show_file(name: string, file: CsvFile): void {
        const view = new View(file.cycle_ns);
        view.follow = false;
        view.show(0, file.to);
        this.enter({ kind: 'file', title: name, cycle_ns: file.cycle_ns, signals: new Map(file.signals.map((s) => [s.name, s])), store: file.store, view,
            seconds: (cycle) => file.start_s + (cycle * file.cycle_ns) / 1e9, fetch: () => Promise.resolve(false) });
    }
    async recordings(): Promise<Answer> {
        return this.link_.request({ cmd: 'recordings' });
    }
    /** Undefined: it is shown; else what was refused. */
    async show_recording(name: string): Promise<Answer | undefined> {
        let about: Recording | undefined;
        for (let again = 0; again < 20; again++) {  // an alarm that has just come is still being recorded for some seconds
            const list = await this.recordings();
            if (!list.ok) return list;
            about = (list['recordings'] as Recording[]).find((recording) => recording.name === name);
            if (!about || about.complete) break;
            await new Promise((resolve) => setTimeout(resolve, 500));
        }
        if (!about) return { ok: false, error: { code: 'page.no_recording', what: name } };
        const kept = about;
        const answer = await this.link_.request({ cmd: 'recording_signals', recording: name });
        if (!answer.ok) return answer;
        const scope = answer['scope'] as Record<string, unknown>;
        const cycle_ns = Number(scope['cycle_ns']), store = new Store(Math.max(1, kept.to - kept.from));
        const reader = new Reader((request) => this.link_.request(request), name, store, cycle_ns);
        const view = new View(cycle_ns);
        view.follow = false;
        view.show(kept.from, kept.to);
        let failed_at = -1e9;
        this.enter({ kind: 'recording', title: name, about: `${kept.source}: ${kept.alarm}`, cycle_ns, signals: described(scope), store, view, marker: { cycle: kept.alarm_cycle, kind: 'alarm', text: kept.alarm },
            seconds: (cycle) => seconds_of(store, cycle, cycle_ns, reader.zero_ns),
            fetch: async (names) => {
                if (performance.now() - failed_at < again_after) return false;
                if (!(await load(reader, with_time(names, this.scene?.signals ?? new Map()), kept.from, kept.to))) failed_at = performance.now();
                return false;
            } }, kept.source);
        return undefined;
    }
    private enter(scene: Scene, source = ''): void {
        this.scene = scene;
        this.cursors.shown = false;
        const axis = [...scene.signals.values()].find((s) => s.group === 'axis' && source.split(' ').includes(s.of))?.of ?? '';
        const fits = this.setup.channels.some((channel) => scene.signals.has(channel.name) && (axis === '' || scene.signals.get(channel.name)?.of === axis));
        if (!fits) {
            this.setup.channels = [];
            this.choose_first(scene, axis);
        }
    }

    /** How one axis follows; as soon as its machine is there. */
    show_axis(name: string): void {
        this.wanted_axis_ = name;
    }
    private choose_first(scene: Scene, axis = ''): void {
        for (const name of first_choice([...scene.signals.values()], axis)) {
            const channel = this.add(name);
            if (channel && name.endsWith('.following_error')) channel.apart = true;  // beside positions it would be a flat line
        }
    }
    add(name: string, bit?: number): Channel | undefined {
        const key = key_of({ name, bit });
        const found = this.setup.channels.find((channel) => key_of(channel) === key);
        if (found || this.setup.channels.length >= most_channels) return found;
        const channel: Channel = { name, ...(bit === undefined ? {} : { bit }), offset: 0, hidden: false, colour: free_place(this.setup.channels.map((c) => c.colour)), apart: false };
        this.setup.channels.push(channel);
        this.changed();
        return channel;
    }
    remove(key: string): void {
        this.setup.channels = this.setup.channels.filter((channel) => key_of(channel) !== key);
        this.changed();
    }
    use(setup: Setup): void {
        this.setup = setup;
        if (this.scene?.view.follow) {
            this.scene.view.show(this.scene.view.to - this.scene.view.cycles(setup.span_s), this.scene.view.to);
            this.scene.view.tie(this.scene.store.newest);
        }
        this.changed();
    }
    /** Keeps the set-up for the next visit. */
    changed(): void {
        if (this.scene) this.setup.span_s = this.scene.view.seconds(this.scene.view.span);
        this.saved.last = this.setup;
    }
    toggle_cursors(): void {
        const { scene, cursors } = this;
        if (cursors.shown || !scene) cursors.shown = false;
        else {
            scene.view.follow = false;  // what moves cannot be measured
            place_cursors(cursors, scene.view.from, scene.view.to);
        }
    }

    // --- trigger -----------------------------------------------------------------------------------------------------------------
    async arm(trigger: Trigger, text: string): Promise<Answer> {
        if (this.scene !== this.live) this.show_live();
        const answer = await this.link_.request(arm_request(trigger, this.live?.cycle_ns ?? 1e6));
        if (answer.ok) {
            this.trigger = { armed: true, looked_to: 0, events: [] };
            this.trigger_text_ = text;
            this.shown_event_ = this.live ? this.live.store.newest - 1 : -1;
            if (this.live) {
                delete this.live.marker;
                this.live.view.follow = true;
                this.cursors.shown = false;
            }
        }
        return answer;
    }
    async disarm(): Promise<void> {
        this.trigger = undefined;
        await this.link_.request({ cmd: 'scope_disarm' });
    }
    private async look_at_trigger(): Promise<void> {
        const answer = await this.link_.request({ cmd: 'scope_state' });
        if (!answer.ok || !this.trigger) return;
        this.trigger = answer['scope'] as TriggerState;
        if (!this.trigger.armed && this.trigger.events.length === 0) {  // it ended with a connection that is no more
            this.trigger = undefined;
            return;
        }
        const event = next_event(this.trigger, this.shown_event_), scene = this.live;
        if (!event || !scene || this.scene !== scene || scene.store.newest < event.to) return;  // its samples are on their way
        this.shown_event_ = event.cycle;
        // Cursors stay where they were about the trigger.
        if (scene.marker) for (const which of ['a', 'b'] as const) this.cursors[which] += event.cycle - scene.marker.cycle;
        else this.cursors.shown = false;
        scene.marker = { cycle: event.cycle, kind: event.automatic ? 'automatic' : 'trigger', text: this.trigger_text_ };
        scene.view.follow = false;
        scene.view.show(event.from, event.to);
    }
}
