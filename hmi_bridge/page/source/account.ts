// Who is at the page: the button in the head line, the form to log in. The server keeps the session in a cookie that no script reads.
import { Desk } from './desk';
import { say, word } from './texts';
import { element, mark, small_window, write } from './view';

export class Account {
    readonly button = element('button', { type: 'button', class: 'small account', 'data-do': 'account', 'aria-haspopup': 'dialog', onclick: () => this.open() });
    private readonly user_ = element('input', { type: 'text', name: 'user', autocomplete: 'username', required: true, 'data-input': 'user' });
    private readonly password_ = element('input', { type: 'password', name: 'password', autocomplete: 'current-password', required: true, 'data-input': 'password' });
    private readonly said_ = element('p', { class: 'hint bad', role: 'alert' });
    private readonly submit_ = element('button', { type: 'submit', class: 'primary', 'data-do': 'log_in' }, say('log_in'));
    private readonly leave_ = element('button', { type: 'button', 'data-do': 'log_out', onclick: () => void this.log_out() }, say('log_out'));
    private readonly who_ = element('p', {});
    private readonly form_ = element('form', { class: 'login', onsubmit: (event: Event) => { event.preventDefault(); void this.log_in(); } },
        element('label', {}, element('span', {}, say('user')), this.user_), element('label', {}, element('span', {}, say('password')), this.password_), this.said_, this.submit_);
    readonly dialog = small_window({ 'aria-label': say('log_in') }, element('h2', {}, say('who_are_you')), this.who_, this.form_,
        element('div', { class: 'buttons' }, this.leave_, element('button', { type: 'button', class: 'small', onclick: () => this.dialog.close() }, say('close'))));
    private offered_ = false;

    constructor(private readonly desk_: Desk) {}

    update(): void {
        const { login, user, role } = this.desk_.link;
        this.button.hidden = role === '' && !login;
        write(this.button, user ? `${user} · ${word('role', role)}` : login ? `${say('log_in')} · ${word('role', role || 'nobody')}` : word('role', role));
        mark(this.button, 'title', say(login ? 'account_hint' : 'account_no_users'));
        this.button.disabled = !login;
        if (role !== '') this.offered_ = false;
        if (login && role === '' && !this.offered_) this.open();  // without a name there is nothing to see
    }
    private open(): void {
        this.offered_ = true;
        const { user, role } = this.desk_.link;
        write(this.who_, user ? say('logged_in_as', { user, role: word('role', role) }) : '');
        this.form_.hidden = user !== '';
        this.leave_.hidden = user === '';
        write(this.said_, '');
        this.dialog.show();
        if (!user) this.user_.focus();
    }
    private async log_in(): Promise<void> {
        const password = this.password_.value;
        this.submit_.disabled = true;
        this.password_.value = '';
        write(this.said_, '');  // of an earlier try, which is not this one's answer
        const status = await post('api/login', { user: this.user_.value, password });
        this.submit_.disabled = false;
        if (status !== 200) {
            write(this.said_, '⚠ ' + say(status === 429 || status === 503 ? 'login_too_often' : status === 0 ? 'no_connection' : 'login_wrong'));
            this.password_.focus();
            return;
        }
        this.dialog.close();
        this.desk_.link.reopen();
    }
    private async log_out(): Promise<void> {
        await post('api/logout', {});
        this.dialog.close();
        this.desk_.link.reopen();
    }
}

/** The status; 0: no server. */
async function post(where: string, what: object): Promise<number> {
    try {
        const answer = await fetch(where, { method: 'POST', headers: { 'Content-Type': 'application/json' }, body: JSON.stringify(what), credentials: 'same-origin' });
        return answer.ok ? 200 : answer.status;
    } catch {
        return 0;
    }
}
