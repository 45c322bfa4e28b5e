// The frame around the pages: head line with STOP, banners, navigation; and the loop that writes the newest state into the page shown.
import { Desk, Page } from './desk';
import { JogHold, watch_page } from './jog';
import { Link } from './link';
import { duration } from './numbers';
import { in_words } from './pages/alarms';
import { Entry, pages } from './pages/list';
import { choose_language, current_language, Key, Language, say, texts, word } from './texts';
import { element, mark, write } from './view';

const modes = ['manual', 'setup', 'automatic'] as const;

const link = new Link(`${location.protocol === 'https:' ? 'wss' : 'ws'}://${location.host}/ws`);
const hold = new JogHold({
    jog: async (axis, velocity, press) => {
        const answer = await link.request(press ? { cmd: 'jog', axis, velocity, press } : { cmd: 'jog', axis, velocity });
        if (!answer.ok && velocity !== 0) desk.refused(answer);
        else if (press && answer.note) desk.tell('note', answer.note);
        return answer.ok;
    },
    blocked: () => !link.opened || link.stalled,
    stale: () => link.stale,
}, { now: () => performance.now(), every: (period, step) => { const timer = setInterval(step, period); return () => clearInterval(timer); } });
const desk = new Desk(link, hold);
hold.on_end = (ending) => {
    const key = `jog_ended_${ending}`;
    if (Object.hasOwn(texts, key)) desk.tell('note', say(key as Key));
};

interface Frame {
    main: HTMLElement;
    update(): void;
}
let frame: Frame;
let shown: Page | undefined;
let shown_as = '';

/** `#axis/x` is the page `axis` with the rest `x`; what nobody knows is the first page. */
function route(): { entry: Entry; rest: string[] } {
    const [name, ...parts] = location.hash.slice(1).split('/');
    const entry = pages.find((known) => known.name === name) ?? (pages[0] as Entry);
    try {
        return { entry, rest: parts.map(decodeURIComponent) };
    } catch {
        return { entry, rest: [] };  // an address typed by hand
    }
}

function make_frame(): Frame {
    const name = element('strong', { class: 'machine' });
    const machines = element('select', { 'aria-label': say('watched_machine'), onchange: () => link.watch(machines.value) });
    const phase = element('span', { class: 'phase' });
    const mode_buttons = modes.map((mode) => element('button', { type: 'button', 'data-mode': mode, onclick: () => void desk.give({ cmd: 'mode', mode }) }, word('mode', mode)));
    const live = element('span', { class: 'live' });
    const language = element('button', { type: 'button', class: 'small', 'data-do': 'language', onclick: () => set_language(current_language() === 'en' ? 'zh' : 'en') }, say('other_language'));
    const theme = element('button', { type: 'button', class: 'small', 'data-do': 'theme', onclick: () => set_theme(dark() ? 'light' : 'dark') }, say(dark() ? 'to_light' : 'to_dark'));
    const stop = element('button', {
        type: 'button', class: 'stop main-stop', 'data-do': 'stop', title: say('stop_hint'),
        onpointerdown: () => { hold.end('stopped'); void desk.give({ cmd: 'stop' }); },
        onclick: (event: MouseEvent) => { if (event.detail === 0) { hold.end('stopped'); void desk.give({ cmd: 'stop' }); } },  // by key
    }, `■ ${say('stop_software')}`);
    const simulated = element('div', { class: 'banner simulated', hidden: true }, say('simulated_banner'));
    const stale = element('div', { class: 'banner stale', role: 'alert', hidden: true });
    const emergency = element('div', { class: 'banner emergency', role: 'alert', hidden: true }, `⚠ ${say('emergency_stop')}`);
    const strip_text = element('span'), strip_more = element('span', { class: 'strip-more' });
    const strip = element('a', { class: 'banner strip', href: '#alarms', hidden: true }, strip_text, strip_more);
    const offered = pages.filter((entry) => entry.under === undefined);
    const tabs = offered.map((entry) => element('a', { href: `#${entry.name}`, 'data-page': entry.name }, say(entry.title)));
    const main = element('main', { tabindex: '-1' });
    document.body.replaceChildren(
        element('header', { class: 'top' }, name, machines, phase, element('div', { class: 'segments', role: 'group', 'aria-label': say('mode') }, ...mode_buttons), element('span', { class: 'space' }), live, language, theme, stop),
        element('div', { class: 'banners' }, simulated, stale, emergency, strip), element('nav', { class: 'side', 'aria-label': 'Taktwerk' }, ...tabs), main, desk.notice);

    return {
        main,
        update() {
            const state = link.state;
            write(name, link.machine || 'Taktwerk');
            name.hidden = link.machines.length > 1;
            machines.hidden = link.machines.length <= 1;
            const listed = link.machines.map((m) => `${m.machine}${m.online ? '' : ` (${say('offline')})`}`);
            if (machines.dataset['listed'] !== listed.join('\n')) {
                machines.dataset['listed'] = listed.join('\n');
                machines.replaceChildren(...link.machines.map((m, i) => element('option', { value: m.machine }, listed[i] ?? '')));
            }
            if (machines.value !== link.machine && document.activeElement !== machines) machines.value = link.machine;
            const old = link.stale;
            mark(document.body, 'data-stale', old);
            write(live, old ? `○ ${say('old')}` : `● ${say('live')}`);
            mark(live, 'data-tone', old ? 'bad' : 'good');
            stale.hidden = !old;
            if (old) {
                const age = duration((performance.now() - link.fresh_at) / 1000);
                const why = link.opened ? link.why_stale : say('no_connection');
                write(stale, '⚠ ' + (link.fresh_at === 0 ? say('never_banner') : say('stale_banner', { time: link.fresh_since.toLocaleTimeString('en-GB'), age })) + (why ? ` (${why})` : ''));
            }
            write(phase, state ? word('phase', state.phase) : '');
            modes.forEach((mode, i) => {
                const button = mode_buttons[i];
                if (!button) return;
                mark(button, 'aria-pressed', state?.mode === mode ? 'true' : 'false');
                write(button, `${state?.mode === mode ? '✓ ' : ''}${word('mode', mode)}`);
                desk.permit(button, 'mode', state !== undefined);
            });
            simulated.hidden = !state?.simulated;
            emergency.hidden = !state?.emergency_stop;
            const standing = state?.alarms.filter((alarm) => alarm.standing) ?? [];
            const first = standing[0];
            strip.hidden = !first;
            if (first) {
                write(strip_text, `⚠ ${first.source}: ${in_words(first)}`);
                write(strip_more, standing.length > 1 ? say('more_alarms', { count: String(standing.length) }) : '');
            }
            const { entry } = route();
            offered.forEach((offer, i) => {
                const tab = tabs[i];
                if (!tab) return;
                tab.hidden = offer.offered?.(desk) === false;
                mark(tab, 'aria-current', offer.name === (entry.under ?? entry.name) ? 'page' : false);
                if (offer.name === 'alarms') write(tab, say('alarms') + (standing.length > 0 ? ` (${standing.length})` : ''));
            });
        },
    };
}

function show(): void {
    const { entry, rest } = route();
    const as = [current_language(), link.machine, entry.name, ...rest].join('\n');
    if (!link.layout && !entry.alone) {
        leave();
        frame.main.replaceChildren(element('p', { class: 'hint' }, say('never_banner')));
    } else if (!shown || as !== shown_as) {
        hold.end('blur');
        leave();
        shown = entry.make(desk, rest);
        frame.main.replaceChildren(shown.root);
    }
    shown_as = as;
}
function leave(): void {
    shown?.leave?.();
    shown = undefined;
}
function refresh(): void {
    frame.update();
    show();
    if (link.state) shown?.update(link.state);
}

function remembered(key: string): string | null {
    try {
        return localStorage.getItem(key);
    } catch {
        return null;
    }
}
function remember(key: string, text: string): void {
    try {
        localStorage.setItem(key, text);
    } catch { /* a browser that keeps nothing */ }
}
const dark = (): boolean => document.documentElement.dataset['theme'] === 'dark';
function set_theme(theme: string): void {
    document.documentElement.dataset['theme'] = theme;
    remember('theme', theme);
    rebuild();
}
function set_language(language: Language): void {
    choose_language(language);
    remember('language', language);
    rebuild();
}
function rebuild(): void {
    hold.end('blur');
    document.documentElement.lang = current_language() === 'zh' ? 'zh-CN' : 'en';
    desk.hush();
    leave();
    frame = make_frame();
    refresh();
}

document.documentElement.dataset['theme'] = remembered('theme') ?? (matchMedia('(prefers-color-scheme: dark)').matches ? 'dark' : 'light');
choose_language((remembered('language') ?? (navigator.language.startsWith('zh') ? 'zh' : 'en')) === 'zh' ? 'zh' : 'en');
rebuild();
watch_page(hold);
let asked = false;
link.on_change = () => {
    if (asked) return;
    asked = true;
    requestAnimationFrame(() => {
        asked = false;
        refresh();
    });
};
link.on_closed = () => hold.end('socket');
window.addEventListener('hashchange', refresh);
setInterval(refresh, 100);  // the age goes on without messages
link.open();
