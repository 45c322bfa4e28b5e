// A picture of the machine with values and lamps on it. The picture is shown as a picture alone: nothing in it can run or ask for anything.
import { Desk } from '../desk';
import { say } from '../texts';
import { element, mark, write } from '../view';
import { local, WidgetLayout } from './builder_views';
import { doubtful, is_on, text_of } from './reading';
import { boxed, first_value, label_of, MakeWidget, Widget } from './widget';

/** ms: where the machine did not answer. */
const again_after = 2000;

function placed(layout: WidgetLayout & { x: number; y: number }): Widget {
    const shown = first_value(layout), label = local(layout.label);
    const text = element('b', { 'data-value': layout.kind });
    const root = element('span', { class: `placed placed-${layout.kind}`, 'data-of': shown.name, title: shown.name }, ...(label ? [element('span', { class: 'placed-label' }, label)] : []), text);
    root.style.left = `${layout.x}%`;
    root.style.top = `${layout.y}%`;
    return {
        root,
        update(state) {
            if (layout.kind === 'lamp') {
                const on = is_on(state, shown);
                write(text, on ? '●' : '○');
                mark(text, 'data-tone', on ? layout.tone ?? 'good' : 'idle');
                mark(root, 'aria-label', `${label || shown.name}: ${say(on ? 'view_on' : 'view_off')}`);
            } else write(text, `${doubtful(state, shown) ? '? ' : ''}${text_of(state, shown, layout.decimals)} ${shown.form === 'number' ? shown.unit : ''}`.trim());
        },
    };
}

class Picture implements Widget {
    readonly root: HTMLElement;
    private readonly img_ = element('img', { alt: '' });
    private readonly why_ = element('p', { class: 'hint' });
    private readonly placed_: Widget[];
    private address_ = '';
    private due_ = 0;
    private asking_ = false;
    private left_ = false;

    constructor(private readonly desk_: Desk, private readonly layout_: WidgetLayout) {
        this.placed_ = (layout_.placed ?? []).map(placed);
        this.img_.alt = label_of(layout_) || say('view_picture');
        this.root = boxed(layout_, 'image', element('div', { class: 'picture' }, this.img_, ...this.placed_.map((one) => one.root)), this.why_);
    }
    update(state: Parameters<Widget['update']>[0]): void {
        if (!this.address_) void this.fetch();
        for (const one of this.placed_) one.update(state);
    }
    leave(): void {
        this.left_ = true;
        if (this.address_) URL.revokeObjectURL(this.address_);
    }
    private async fetch(): Promise<void> {
        if (this.asking_ || performance.now() < this.due_) return;
        this.asking_ = true;
        const answer = await this.desk_.link.request({ cmd: 'view_image', image: this.layout_.image });
        this.asking_ = false;
        this.due_ = performance.now() + again_after;
        if (this.left_) return;
        if (!answer.ok) {
            if (!answer.error?.code.startsWith('page.')) write(this.why_, `${answer.error?.what ?? ''} ${answer.error?.remedy ?? ''}`);
            return;
        }
        const bytes = Uint8Array.from(atob(String(answer['data'])), (letter) => letter.charCodeAt(0));
        this.address_ = URL.createObjectURL(new Blob([bytes], { type: String(answer['media_type']) }));
        this.img_.src = this.address_;
        write(this.why_, '');
    }
}

export const image_widget: MakeWidget = (desk, layout) => new Picture(desk, layout);
