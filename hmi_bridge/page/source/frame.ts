// What stands around every page: the head line with STOP, the banners that no page may hide, the tabs.
import { Account } from './account';
import { in_words, stops, where } from './alarm_words';
import { Desk } from './desk';
import { duration } from './numbers';
import { Entry, pages } from './pages/list';
import { said } from './sentences/said';
import { MachineState } from './state';
import { current_language, say, word } from './texts';
import { element, mark, write } from './view';
import { local } from './views/builder_views';

const modes = ['manual', 'setup', 'automatic'] as const;
/** More names than these do not fit into the banner of what is forced. */
const most_named = 4;

export interface FrameHands {
    set_language(): void;
    set_theme(): void;
    dark: boolean;
    route(): Entry;
    /** What stands in the address behind the page's name. */
    rest(): readonly string[];
}

export class Frame {
    readonly main = element('main', { tabindex: '-1' });
    private readonly parts_: { root: HTMLElement; update(): void }[];
    private readonly account_: Account;

    constructor(private readonly desk_: Desk, hands: FrameHands) {
        this.account_ = new Account(desk_);
        const head = this.head(hands), banners = this.banners(), tabs = this.tabs(hands);
        this.parts_ = [head, banners, tabs];
        document.body.replaceChildren(head.root, banners.root, tabs.root, this.main, desk_.notice, this.account_.dialog);
    }
    update(): void {
        mark(document.body, 'data-stale', this.desk_.link.stale);
        for (const part of this.parts_) part.update();
        this.account_.update();
    }

    private head(hands: FrameHands) {
        const desk = this.desk_, link = desk.link;
        const name = element('strong', { class: 'machine' });
        const machines = element('select', { 'aria-label': say('watched_machine'), onchange: () => link.watch(machines.value) });
        const phase = element('span', { class: 'phase' });
        const buttons = modes.map((mode) => element('button', { type: 'button', 'data-mode': mode, onclick: () => void desk.give({ cmd: 'mode', mode }) }, word('mode', mode)));
        const live = element('span', { class: 'live' });
        const language = element('button', { type: 'button', class: 'small', 'data-do': 'language', onclick: hands.set_language }, say('other_language'));
        const theme = element('button', { type: 'button', class: 'small', 'data-do': 'theme', onclick: hands.set_theme }, say(hands.dark ? 'to_light' : 'to_dark'));
        const stop_all = () => {
            desk.let_go('stopped');
            void desk.give({ cmd: 'stop' });
        };
        const stop = element('button', {
            type: 'button', class: 'stop main-stop', 'data-do': 'stop', title: say('stop_hint'),
            onpointerdown: stop_all,
            onclick: (event: MouseEvent) => { if (event.detail === 0) stop_all(); },  // by key
        }, `■ ${say('stop_software')}`);
        const root = element('header', { class: 'top' }, name, machines, phase, element('div', { class: 'segments', role: 'group', 'aria-label': say('mode') }, ...buttons),
            element('span', { class: 'space' }), live, this.account_.button, language, theme, stop);
        return {
            root,
            update: () => {
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
                write(live, link.stale ? `○ ${say('old')}` : `● ${say('live')}`);
                mark(live, 'data-tone', link.stale ? 'bad' : 'good');
                write(phase, state ? word('phase', state.phase) : '');
                modes.forEach((mode, i) => {
                    const button = buttons[i];
                    if (!button) return;
                    mark(button, 'aria-pressed', state?.mode === mode ? 'true' : 'false');
                    write(button, `${state?.mode === mode ? '✓ ' : ''}${word('mode', mode)}`);
                    desk.permit(button, 'mode', state !== undefined);
                });
            },
        };
    }

    private banners() {
        const desk = this.desk_, link = desk.link;
        const simulated = element('div', { class: 'banner simulated', hidden: true }, say('simulated_banner'));
        const stale = element('div', { class: 'banner stale', role: 'alert', hidden: true });
        const emergency = element('div', { class: 'banner emergency', role: 'alert', hidden: true });
        const forced_text = element('a', { href: '#io' });
        const release = desk.button('release_forces', () => ({ cmd: 'release_forces' }), 'small');
        const forced = element('div', { class: 'banner forced', role: 'alert', hidden: true }, forced_text, release);
        const strip_text = element('span'), strip_more = element('span', { class: 'strip-more' });
        const strip = element('a', { class: 'banner strip', href: '#alarms', hidden: true }, strip_text, strip_more);
        const write_state = (state: MachineState | undefined): void => {
            simulated.hidden = !state?.simulated;
            emergency.hidden = !state?.emergency_stop;
            write(emergency, `⚠ ${say(state?.emergency_stop_unread ? 'emergency_unread' : 'emergency_stop')}`);
            const points = state?.forced ?? [];
            forced.hidden = points.length === 0;
            if (points.length > 0) {
                const names = points.slice(0, most_named).map((point) => point.point).join(', ') + (points.length > most_named ? ' …' : '');
                write(forced_text, `⚠ ${say('forced_banner', { count: String(points.length), names })}`);
                desk.permit(release, 'release_forces');
            }
            const listed = listed_alarms(state), first = listed.find((alarm) => alarm.standing && stops(alarm)) ?? listed.find((alarm) => alarm.standing) ?? listed[0];
            strip.hidden = !first;
            if (first) {
                mark(strip, 'data-tone', !first.standing ? 'idle' : stops(first) ? 'bad' : 'warn');
                write(strip_text, `${first.standing ? '⚠' : '○'} ${where(first.source)}: ${in_words(first)}${first.standing ? '' : ` – ${say('gone')}`}`);
                write(strip_more, listed.length > 1 ? say('more_alarms', { count: String(listed.length) }) : '');
            }
        };
        return {
            root: element('div', { class: 'banners' }, simulated, stale, emergency, forced, strip),
            update: () => {
                stale.hidden = !link.stale;
                if (link.stale) {
                    const age = duration((performance.now() - link.fresh_at) / 1000);
                    const why = link.opened ? said(link.why_stale).text : say('no_connection');
                    if (link.login && link.role === '') write(stale, say('login_first'));
                    else write(stale, '⚠ ' + (link.fresh_at === 0 ? say('never_banner') : say('stale_banner', { time: link.fresh_since.toLocaleTimeString('en-GB'), age })) + (why ? ` (${why})` : ''));
                }
                write_state(link.state);
            },
        };
    }

    private tabs(hands: FrameHands) {
        const offered = pages.filter((entry) => entry.under === undefined);
        const tabs = offered.map((entry) => element('a', { href: `#${entry.name}`, 'data-page': entry.name }, say(entry.title)));
        const own = element('div', { class: 'own-tabs' }), views = this.desk_.views;
        let revision = -1;
        const own_tabs = (shown: boolean): void => {
            if (revision !== views.revision) own.replaceChildren(...views.all.map((view) => element('a', { href: `#view/${encodeURIComponent(view.name)}`, 'data-view': view.name }, local(view.title))));
            revision = views.revision;
            own.hidden = views.all.length === 0;
            const name = shown ? views.find(hands.rest()[0])?.name : undefined;
            for (const tab of own.querySelectorAll('a')) mark(tab, 'aria-current', tab.dataset['view'] === name ? 'page' : false);
        };
        return {
            root: element('nav', { class: 'side', 'aria-label': say('pages') }, own, ...tabs),
            update: () => {
                own_tabs(hands.route().name === 'view');
                const entry = hands.route(), listed = listed_alarms(this.desk_.link.state).length;
                offered.forEach((offer, i) => {
                    const tab = tabs[i];
                    if (!tab) return;
                    tab.hidden = offer.offered?.(this.desk_) === false;
                    mark(tab, 'aria-current', offer.name === (entry.under ?? entry.name) ? 'page' : false);
                    if (offer.name === 'alarms') write(tab, say('alarms') + (listed > 0 ? ` (${listed})` : ''));
                });
            },
        };
    }
}

/** Those that stand, and those that are gone and wait for a person. */
const listed_alarms = (state: MachineState | undefined) => state?.alarms.filter((alarm) => alarm.standing || !alarm.acknowledged) ?? [];

export const html_language = (): string => (current_language() === 'zh' ? 'zh-CN' : 'en');
