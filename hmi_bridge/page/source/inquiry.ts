// What a page asks for only while it is shown: again and again, or when told to, one question at a time.
import { Desk } from './desk';
import { Answer, Request } from './link';

/** ms: how soon a question that was not answered is asked again. */
const again_after = 2000;

export class Inquiry {
    /** The machine is older than this page: it does not know the command. Nothing is asked any more. */
    unknown = false;
    /** The last answer; undefined: none yet. */
    answer: Answer | undefined;

    private due_ = 0;
    private waiting_ = false;
    private left_ = false;

    /** `period` ms; Infinity: once, and again by ask(). */
    constructor(private readonly desk_: Desk, private readonly request_: () => Request, private readonly period_: number, private readonly take_: (answer: Answer) => void) {}

    /** Called with each state, thus some 20 times a second while the page is shown: asks when it is time. */
    step(): void {
        const now = performance.now();
        if (now < this.due_ || this.waiting_ || this.unknown || this.left_ || !this.desk_.link.opened || !this.desk_.link.allowed(this.request_().cmd)) return;
        this.waiting_ = true;
        void this.desk_.link.request(this.request_()).then((answer) => {
            this.waiting_ = false;
            if (this.left_) return;
            const code = answer.error?.code ?? '';
            this.unknown = code === 'request.unknown_command' || code === 'web.unknown_command';
            const passing = code === 'page.no_connection' || code === 'page.no_answer' || code === 'web.busy';
            this.due_ = now + (passing ? again_after : this.period_);
            if (passing) return;
            this.answer = answer;
            this.take_(answer);
        });
    }
    /** At the next step. */
    ask(): void {
        this.due_ = 0;
    }
    leave(): void {
        this.left_ = true;
    }
}
