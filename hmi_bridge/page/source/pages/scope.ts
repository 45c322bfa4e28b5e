// The scope: a bar, the lanes, the list of values, and at the side what is chosen, waited for or kept.
import { Desk, Page } from '../desk';
import { rate_between, time_text } from '../scope/cursors';
import { curve_panel } from '../scope/curve_panel';
import { FilesPanel } from '../scope/files_panel';
import { Picker } from '../scope/picker';
import { Session } from '../scope/session';
import { SavedSetups, setup_views } from '../scope/setup';
import { key_of } from '../scope/signals';
import { SpectrumView } from '../scope/spectrum_view';
import { Stack } from '../scope/stack';
import { TriggerPanel } from '../scope/trigger_panel';
import { ValueTable } from '../scope/value_table';
import { XyView } from '../scope/xy_view';
import { Key, say } from '../texts';
import { element, mark, write } from '../view';

const spans_s = [0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 60, 120, 300];
type Side = '' | 'signals' | 'trigger' | 'files' | 'curve';

/** What was chosen and kept outlives the page: one for each link. */
const sessions = new WeakMap<object, Session>();
let side: Side = 'signals';

export function scope(desk: Desk, rest: readonly string[]): Page {
    let session = sessions.get(desk.link) as Session;
    if (!session) sessions.set(desk.link, (session = new Session(desk.link, new SavedSetups(localStorage))));
    let left = false, curve = '';

    const button = (key: Key, tag: string, what: () => void, sign = ''): HTMLButtonElement => element('button', { type: 'button', 'data-do': tag, title: say(key), onclick: what }, sign || say(key));
    const changed = (): void => {
        draw();
        update();
    };
    const open = (which: Side): void => {
        side = side === which && which !== 'curve' ? '' : which;
        fill_side();
        changed();
        if (side === 'signals') picker.focus();
    };
    const choose = (key: string): void => {
        curve = key;
        open('curve');
    };
    const stack = new Stack(session, () => update(), choose);
    const others = { xy: new XyView(session, () => session.changed()), spectrum: new SpectrumView(session, () => session.changed()) };
    const table = new ValueTable(session, changed, choose);
    const picker = new Picker(session, changed), trigger = new TriggerPanel(desk, session, changed), files = new FilesPanel(session, stack, () => (session.setup.view === 'time' ? undefined : others[session.setup.view].canvas()), changed);

    const run = button('scope_freeze', 'freeze', () => toggle_run());
    const span = element('select', { 'aria-label': say('scope_shown_time'), 'data-field': 'span', onchange: () => {
        const view = session.scene?.view;
        if (!view || span.value === '') return;
        view.zoom(view.cycles(Number(span.value)) / view.span, 1);
        session.changed();
        changed();
    } }, ...spans_s.map((s) => element('option', { value: String(s) }, s < 1 ? `${s * 1000} ms` : `${s} s`)), element('option', { value: '', hidden: true }, ''));
    const own_span = span.lastElementChild as HTMLOptionElement;
    const box = button('scope_box', 'box', () => {
        stack.hands.box_zoom = !stack.hands.box_zoom;
        update();
    }, '⬚');
    const cursors = button('scope_cursors', 'cursors', () => {
        session.toggle_cursors();
        changed();
    });
    const sides = { signals: button('scope_signals', 'signals', () => open('signals')), trigger: button('scope_trigger', 'trigger', () => open('trigger')), files: button('scope_files', 'files', () => open('files')) };
    const views = setup_views.map((view) => element('button', { type: 'button', 'data-view': view, onclick: () => {
        session.setup.view = view;
        session.changed();
        changed();
    } }, say(`scope_view_${view}`)));
    const what = element('strong', { class: 'scope-what', 'data-value': 'scene' });
    const back = element('a', { class: 'scope-back', href: '#scope', onclick: () => {
        session.show_live();
        changed();
    } }, say('scope_back_to_live'));
    const hint = element('p', { class: 'hint scope-hint', role: 'status' });
    const panel = element('aside', { class: 'scope-side' });
    const bar = element('div', { class: 'scope-bar', role: 'toolbar', 'aria-label': say('scope') }, run, span, button('scope_zoom_in', 'zoom_in', () => { stack.hands.remember(); stack.hands.zoom(0.5); }, '+'),
        button('scope_zoom_out', 'zoom_out', () => { stack.hands.remember(); stack.hands.zoom(2); }, '−'), box, button('scope_back', 'back', () => stack.hands.back(), '↶'), button('scope_all', 'all', () => stack.hands.all(), '↔'), cursors,
        element('div', { class: 'segments', role: 'group', 'aria-label': say('scope_view') }, ...views), element('span', { class: 'space' }), trigger.status, sides.signals, sides.trigger, sides.files);
    const strip = element('div', { class: 'scope-strip' }, what, back);
    const middle = element('div', { class: 'scope-middle' }, element('div', { class: 'scope-main' }, hint, stack.root, table.root, others.xy.root, others.spectrum.root), panel);
    const root = element('div', { class: 'page scope' }, bar, strip, middle);

    function toggle_run(): void {
        const scene = session.scene;
        if (!scene || scene.kind !== 'live') return;
        if (scene.view.follow) scene.view.follow = false;
        else session.show_live();
        changed();
    }
    root.addEventListener('keydown', (event) => {
        const target = event.target as HTMLElement;
        if (target.closest('input, select, button, a, .scope-side') || event.altKey || event.metaKey) return;
        const keys: Record<string, () => void> = {
            ' ': toggle_run, ArrowLeft: () => stack.hands.move(-0.1), ArrowRight: () => stack.hands.move(0.1), PageUp: () => stack.hands.move(-0.9), PageDown: () => stack.hands.move(0.9), '+': () => stack.hands.zoom(0.5), '=': () => stack.hands.zoom(0.5), '-': () => stack.hands.zoom(2),
            End: () => { session.show_live(); changed(); }, c: () => { session.toggle_cursors(); changed(); }, a: () => stack.hands.all(), Backspace: () => stack.hands.back(),
        };
        const act = keys[event.key];
        if (!act) return;
        event.preventDefault();
        act();
    });

    function fill_side(): void {
        panel.hidden = side === '';
        const chosen = session.setup.channels.find((c) => key_of(c) === curve);
        if (side === 'curve' && !chosen) side = '';
        panel.replaceChildren(...(side === 'signals' ? [picker.root] : side === 'trigger' ? [trigger.root] : side === 'files' ? [files.root] : chosen && side === 'curve'
            ? [curve_panel(session, stack, chosen, changed, () => { side = ''; fill_side(); })] : []));
        panel.hidden = side === '';
        for (const [name, b] of Object.entries(sides)) mark(b, 'aria-expanded', side === name ? 'true' : 'false');
    }
    function draw(): void {
        const { view } = session.setup;
        stack.root.hidden = table.root.hidden = view !== 'time' || !session.scene;
        others.xy.root.hidden = view !== 'xy' || !session.scene;
        others.spectrum.root.hidden = view !== 'spectrum' || !session.scene;
        setup_views.forEach((one, i) => mark(views[i] as Element, 'aria-pressed', one === view ? 'true' : 'false'));
        if (view === 'time') stack.draw();
        else others[view].draw();
    }
    function update(): void {
        const { scene, trouble } = session, now = performance.now();
        const live = scene?.kind === 'live', follow = live && scene.view.follow;
        write(run, follow ? `❚❚ ${say('scope_freeze')}` : `▶ ${say('scope_run')}`);
        run.hidden = scene !== undefined && !live;
        mark(run, 'data-frozen', live && !follow);
        mark(cursors, 'aria-pressed', session.cursors.shown ? 'true' : 'false');
        mark(box, 'aria-pressed', stack.hands.box_zoom ? 'true' : 'false');
        if (scene && document.activeElement !== span) {
            const shown = scene.view.seconds(scene.view.span), known = spans_s.find((s) => Math.abs(s / shown - 1) < 1e-6);
            write(own_span, time_text(shown, scene.cycle_ns));
            span.value = known === undefined ? '' : String(known);
        }
        strip.hidden = !scene || live;
        back.hidden = !session.live;
        mark(root, 'data-kept', scene !== undefined && !live);
        if (scene && !live) write(what, `${scene.kind === 'file' ? '▤' : '⚠'} ${say(scene.kind === 'file' ? 'scope_shows_file' : 'scope_shows_recording')} ${scene.about ? `${scene.about} · ` : ''}${scene.title}`);
        const text = !scene && trouble ? say(trouble) : scene && session.setup.channels.length === 0 ? say('scope_no_curve') : '';
        write(hint, text);
        trigger.update();
        trigger.status.hidden = session.trigger === undefined;
        if (side === 'signals') picker.update();
        if (side === 'files') files.update(now);
        if (session.setup.view === 'time') table.update(now, stack.hands.pointed, (cycle) => stack.time_of(cycle), (a, b) => hertz(rate_between(a, b)));
    }
    let wanted = rest[0] === 'recording' && session.scene?.title !== rest[1] ? rest[1] : undefined;
    /** The recording of the address, as soon as there is a machine to ask. */
    function open_wanted(name: string): void {
        wanted = undefined;
        void session.show_recording(name).then((refused) => {
            if (refused?.error?.code === 'page.no_recording') desk.tell('refused', say('scope_recording_gone', { name }));
            else if (refused) desk.refused(refused);
            else if (!left) changed();
        });
    }
    async function beat(): Promise<void> {
        if (left) return;
        if (wanted !== undefined && desk.link.opened && desk.link.layout) open_wanted(wanted);
        await session.step(performance.now());
        if (left || !root.isConnected) return;
        draw();
        update();
    }
    fill_side();
    const timer = setInterval(() => void beat(), 33);
    if (rest[0] === 'axis' && rest[1] !== undefined) session.show_axis(rest[1]);
    return {
        root,
        update,
        leave() {
            left = true;
            clearInterval(timer);
            session.changed();
        },
    };
}

const hertz = (rate: number): string => (Number.isFinite(rate) ? `${Number(rate.toPrecision(6))} Hz` : '–');
