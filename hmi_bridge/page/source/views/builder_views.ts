// The machine builder's own pages as the machine has them: asked for once a machine, and again when it was started anew.
import { Link } from '../link';
import { current_language } from '../texts';

export interface LocalText {
    en: string;
    zh: string;
}
/** A value of the machine, bound when the machine's file was checked. */
export interface ShownValue {
    name: string;
    source: 'axis' | 'input' | 'output' | 'variable' | 'parameter' | 'machine';
    of: string;
    member: string;
    form: 'number' | 'flag' | 'word';
    unit: string;
    whole: boolean;
    minimum?: number;
    maximum?: number;
    writable?: boolean;
}
export interface WidgetLayout {
    kind: string;
    label: LocalText;
    values?: ShownValue[];
    axis?: string;
    minimum?: number;
    maximum?: number;
    decimals?: number;
    width?: number;
    tone?: string;
    seconds?: number;
    image?: string;
    placed?: (WidgetLayout & { x: number; y: number })[];
}
export interface ViewLayout {
    name: string;
    title: LocalText;
    rows: WidgetLayout[][];
}

export const local = (text: LocalText): string => (current_language() === 'zh' ? text.zh : text.en);

/** ms: a question that was not answered is asked again so soon. */
const again_after = 2000;

export class BuilderViews {
    all: readonly ViewLayout[] = [];
    /** Rises with each answer: who has built something of `all` builds it anew. */
    revision = 0;
    on_change: () => void = () => undefined;

    private asked_of_: unknown;
    private due_ = 0;

    constructor(private readonly link_: Link) {}

    /** Each time that something may have changed. */
    step(): void {
        const layout = this.link_.layout;
        if (layout === this.asked_of_ && this.due_ === 0) return;
        if (layout === undefined || !this.link_.opened || !this.link_.allowed('views')) return;
        if (layout === this.asked_of_ && performance.now() < this.due_) return;
        this.asked_of_ = layout;
        this.due_ = performance.now() + again_after;
        void this.link_.request({ cmd: 'views' }).then((answer) => {
            if (this.link_.layout !== layout) return;
            const code = answer.error?.code ?? '';
            if (!answer.ok && code.startsWith('page.')) return;  // again, when it is due
            this.due_ = 0;
            const views = answer.ok && Array.isArray(answer['views']) ? (answer['views'] as ViewLayout[]) : [];
            if (JSON.stringify(views) === JSON.stringify(this.all)) return;
            this.all = views;
            this.revision++;
            this.on_change();
        });
    }
    find(name: string | undefined): ViewLayout | undefined {
        return this.all.find((view) => view.name === name) ?? this.all[0];
    }
}
