// What the pages share: the connection, giving a command and telling its answer, buttons that know when they may be pressed.
import { Answer, Link, Request } from './link';
import { Ending, JogHold } from './jog';
import { said, write_said } from './sentences/said';
import { AxisLayout, AxisState, MachineState } from './state';
import { Key, say, word } from './texts';
import { element, mark, write } from './view';
import { BuilderViews } from './views/builder_views';

export interface Page {
    root: HTMLElement;
    update(state: MachineState): void;
    /** It is shown no more, and will not be again: ends what it asks for. */
    leave?(): void;
}

export interface Given {
    at: Date;
    request: Request;
    answer: Answer;
}
const most_given = 50;

export class Desk {
    readonly notice = element('div', { class: 'notice', role: 'status', 'aria-live': 'polite' });

    /** The pages of the machine's builder. */
    readonly views: BuilderViews;

    /** What ended the last jog of a group, or kept it from beginning; empty: nothing but its hand. */
    stopped_by = '';

    /** `hold`: a jog; `pressing`: a button of such a page; `leading`: a jog of a group. One hand holds one of them. */
    constructor(readonly link: Link, readonly hold: JogHold, readonly pressing: JogHold, readonly leading: JogHold) {
        this.views = new BuilderViews(link);
    }
    /** Whatever is held. */
    let_go(ending: Ending): void {
        this.hold.end(ending);
        this.pressing.end(ending);
        this.leading.end(ending);
    }

    /** What this page has commanded, newest first. */
    readonly given: Given[] = [];

    /** Gives the command and tells what came of it. */
    async give(request: Request): Promise<Answer> {
        const at = new Date();
        const answer = await this.link.request(request);
        this.given.unshift({ at, request, answer });
        this.given.length = Math.min(this.given.length, most_given);
        if (!answer.ok) this.refused(answer);
        else if (answer.note) this.tell('note', said(answer.note).text);
        else if (this.notice.dataset['kind'] === 'refused') this.hush();
        return answer;
    }
    refused(answer: Answer): void {
        const { code = '', subject = '', what = '', remedy = '' } = answer.error ?? {};
        if (code === 'page.no_connection') this.tell('refused', say('no_connection'));
        else if (code === 'page.no_answer') this.tell('refused', say('no_answer'));
        else this.tell('refused', `${say('refused')}: ${subject ? subject + ': ' : ''}${said(what).text}${remedy ? ' – ' + said(remedy).text : ''}`);
    }
    tell(kind: 'refused' | 'note', text: string): void {
        this.notice.dataset['kind'] = kind;
        this.notice.replaceChildren(element('span', {}, (kind === 'refused' ? '⚠ ' : 'ⓘ ') + text),
            element('button', { type: 'button', class: 'small', onclick: () => this.hush() }, say('close')));
    }
    hush(): void {
        delete this.notice.dataset['kind'];
        this.notice.replaceChildren();
    }

    /** A button that gives one command; grey while the values are old or the role may not. */
    button(key: Key, request: () => Request, kind = ''): HTMLButtonElement {
        const cmd = request().cmd;
        return element('button', { type: 'button', class: kind, 'data-cmd': cmd, onclick: () => void this.give(request()) }, say(key));
    }
    /** Whether a button may be pressed now, by its own reason and by everybody's. `why`: its own reason, told when a grey button is touched. */
    permit(button: HTMLButtonElement | HTMLInputElement | HTMLSelectElement, cmd: string, possible = true, why = ''): void {
        const may = this.link.allowed(cmd);
        const allowed = possible && !this.link.stale && may;
        if (button.disabled === allowed) this.enable(button, allowed);
        const reason = allowed ? '' : this.link.stale ? say('grey_stale') : !may ? (this.link.role === 'admin' ? say('not_known') : say('grey_role', { role: word('role', this.link.role) })) : why;
        mark(button, 'data-denied', !may);
        mark(button, 'data-reason', reason || false);
    }
    /** What turns grey loses the keyboard's focus, if only for a moment in which the values were old: it has it again, unless somebody went on meanwhile. */
    private enable(button: HTMLButtonElement | HTMLInputElement | HTMLSelectElement, may: boolean): void {
        if (!may && document.activeElement === button) this.unfocused_ = button;
        button.disabled = !may;
        if (!may || this.unfocused_ !== button) return;
        this.unfocused_ = undefined;
        if (document.activeElement === document.body) button.focus({ preventScroll: true });
    }
    private unfocused_: HTMLElement | undefined;

    /** A grey button takes no click; so the page looks what lies under the finger, and says why. */
    tell_reasons(): void {
        document.addEventListener('pointerdown', ({ clientX: x, clientY: y }) => {
            for (const button of document.querySelectorAll<HTMLElement>(':disabled[data-reason]')) {
                const box = button.getBoundingClientRect();
                if (x >= box.left && x < box.right && y >= box.top && y < box.bottom) this.tell('note', button.dataset['reason'] ?? '');
            }
        });
    }
    axis_layout(name: string): AxisLayout | undefined {
        return this.link.layout?.axes.find((axis) => axis.name === name);
    }
}

const signs: Record<string, string> = { Disabled: '○', Standstill: '●', Homing: '⌂', Stopping: '◼', ErrorStop: '⚠' };

/** A state as sign and word, coloured: never by colour alone. */
export function write_state(to: HTMLElement, axis: AxisState, text: string): void {
    write(to, `${signs[axis.state] ?? '▶'} ${text}`);
    const tone = axis.state === 'ErrorStop' ? 'bad' : axis.state === 'Disabled' ? 'idle' : axis.state === 'Stopping' ? 'warn' : 'good';
    mark(to, 'data-tone', tone);
}
export function write_lamp(to: HTMLElement, on: boolean, text: string, tone = 'good'): void {
    write(to, `${on ? '●' : '○'} ${text}`);
    mark(to, 'data-tone', on ? tone : 'idle');
}

/** Rows of a name and a value. */
export class Values {
    readonly root = element('dl', { class: 'values' });
    private readonly cells_ = new Map<string, HTMLElement>();
    add(key: Key): HTMLElement {
        const cell = element('dd', { 'data-value': key });
        this.root.append(element('dt', {}, say(key)), cell);
        this.cells_.set(key, cell);
        return cell;
    }
    set(key: Key, text: string): void {
        write(this.cells_.get(key) ?? this.add(key), text);
    }
    /** A sentence of the server, which may be in English alone and is marked as such then. */
    set_said(key: Key, english: string): void {
        write_said(this.cells_.get(key) ?? this.add(key), english);
    }
}

export const panel = (title: Key, ...children: (Node | string)[]): HTMLElement =>
    element('section', { class: 'panel' }, element('h2', {}, say(title)), ...children);
/** `numbers`: columns whose heads stand to the right, over numbers. */
export function table(keys: Key[], body: HTMLElement, numbers: Key[] = []): HTMLElement {
    return element('table', {}, element('thead', {}, element('tr', {}, ...keys.map((key) => element('th', { scope: 'col', class: numbers.includes(key) ? 'number' : '' }, say(key))))), body);
}
/** Links between the parts of a page; each with where it leads and its text. */
export const sub_tabs = (name: Key, parts: readonly (readonly [string, Key])[], shown: string): HTMLElement =>
    element('nav', { class: 'tabs', 'aria-label': say(name) }, ...parts.map(([where, key]) => element('a', { href: `#${where}`, 'aria-current': where === shown ? 'page' : 'false' }, say(key))));
