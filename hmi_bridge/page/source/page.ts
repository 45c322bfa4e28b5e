// The page: joins the connection, the hand, the frame and the pages (pages/list.ts); and the loop that writes the newest state into the page shown.
import { Desk, Page } from './desk';
import { Frame, html_language } from './frame';
import { GroupJog } from './group/jog_pad';
import { Clock, Ending, JogHold, watch_page } from './jog';
import { Link } from './link';
import { Entry, pages } from './pages/list';
import { remember, remembered } from './remembered';
import { said } from './sentences/said';
import { choose_language, current_language, Key, say, texts } from './texts';
import { element, mark } from './view';

const link = new Link(`${location.protocol === 'https:' ? 'wss' : 'ws'}://${location.host}/ws`);
const clock: Clock = { now: () => performance.now(), every: (period, step) => { const timer = setInterval(step, period); return () => clearInterval(timer); } };
const hold = new JogHold({
    jog: async (axis, velocity, press) => {
        const answer = await link.request(press ? { cmd: 'jog', axis, velocity, press } : { cmd: 'jog', axis, velocity });
        if (!answer.ok && velocity !== 0) desk.refused(answer);
        else if (press && answer.note) desk.tell('note', said(answer.note).text);
        return answer.ok;
    },
    blocked: () => !link.opened || link.stalled,
    stale: () => link.stale,
}, clock);
// A button of the machine builder's own page is held as a jog is; the machine lets go by the same lease.
const pressing = new JogHold({
    jog: async (variable, value, press) => {
        const answer = await link.request(value === 0 ? { cmd: 'set_value', variable, value } : { cmd: 'set_value', variable, value, press });
        if (!answer.ok && value !== 0) desk.refused(answer);
        return answer.ok;
    },
    blocked: () => !link.opened || link.stalled,
    stale: () => link.stale,
}, clock);
// A group is held in a frame and a direction: as text, what the hold holds (group/jog_pad.ts).
const leading = new JogHold({
    jog: async (order, velocity, press) => {
        const jog = JSON.parse(order) as GroupJog;
        if (press) desk.stopped_by = '';
        const answer = await link.request(velocity === 0 ? { cmd: 'group_jog', group: jog.group, velocity } : { cmd: 'group_jog', ...jog, velocity, ...(press ? { press } : {}) });
        if (!answer.ok && velocity !== 0) {
            desk.refused(answer);
            desk.stopped_by = said(answer.error?.what ?? '').text;
        }
        return answer.ok;
    },
    blocked: () => !link.opened || link.stalled,
    stale: () => link.stale,
}, clock);
const desk = new Desk(link, hold, pressing, leading);
const tell_end = (group: string) => (ending: Ending) => {
    const key = `${group}_${ending}`;
    if (Object.hasOwn(texts, key)) desk.tell('note', say(key as Key));
};
hold.on_end = tell_end('jog_ended');
pressing.on_end = tell_end('press_ended');
leading.on_end = tell_end('jog_ended');

let frame: Frame;
let shown: Page | undefined;
let shown_as = '';

/** `#axis/x` is the page `axis` with the rest `x`; what nobody knows is the first page. */
function route(): { entry: Entry; rest: string[] } {
    const [name, ...parts] = location.hash.slice(1).split('/');
    const own = pages.find((known) => known.name === 'view');
    // Who works at the machine begins with its builder's first page, where there is one.
    if (!name && own && desk.views.all.length > 0 && (link.role === 'viewer' || link.role === 'operator')) return { entry: own, rest: [] };
    const entry = pages.find((known) => known.name === name) ?? (pages[0] as Entry);
    try {
        return { entry, rest: parts.map(decodeURIComponent) };
    } catch {
        return { entry, rest: [] };  // an address typed by hand
    }
}

function show(): void {
    const { entry, rest } = route();
    const as = [current_language(), link.machine, entry.name, ...rest, ...(entry.name === 'view' ? [desk.views.revision] : [])].join('\n');
    if (!link.layout && !entry.alone) {
        leave();
        frame.main.replaceChildren(element('p', { class: 'hint' }, say(link.login && link.role === '' ? 'login_first' : 'never_banner')));
    } else if (!shown || as !== shown_as) {
        desk.let_go('blur');
        leave();
        shown = entry.make(desk, rest);
        frame.main.replaceChildren(shown.root);
        frame.main.scrollTop = 0;
    }
    shown_as = as;
}
function leave(): void {
    shown?.leave?.();
    shown = undefined;
}
function refresh(): void {
    desk.views.step();
    frame.update();
    show();
    if (!link.state) return;
    mark(document.body, 'data-cycle', String(link.state.cycle));  // whose numbers these are
    shown?.update(link.state);
}

const dark = (): boolean => document.documentElement.dataset['theme'] === 'dark';
function rebuild(): void {
    desk.let_go('blur');
    document.documentElement.lang = html_language();
    desk.hush();
    leave();
    frame = new Frame(desk, {
        set_language: () => {
            choose_language(current_language() === 'en' ? 'zh' : 'en');
            remember('language', current_language());
            rebuild();
        },
        set_theme: () => {
            document.documentElement.dataset['theme'] = dark() ? 'light' : 'dark';
            remember('theme', document.documentElement.dataset['theme']);
            rebuild();
        },
        dark: dark(),
        route: () => route().entry,
        rest: () => route().rest,
    });
    refresh();
}

document.documentElement.dataset['theme'] = remembered('theme') ?? (matchMedia('(prefers-color-scheme: dark)').matches ? 'dark' : 'light');
choose_language((remembered('language') ?? (navigator.language.startsWith('zh') ? 'zh' : 'en')) === 'zh' ? 'zh' : 'en');
rebuild();
watch_page(hold);
watch_page(pressing);
watch_page(leading);
desk.tell_reasons();
let asked = false;
link.on_change = () => {
    if (asked) return;
    asked = true;
    requestAnimationFrame(() => {
        asked = false;
        refresh();
    });
};
link.on_closed = () => desk.let_go('socket');
window.addEventListener('hashchange', refresh);
setInterval(refresh, 100);  // the age goes on without messages
link.open();
