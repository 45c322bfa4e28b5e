// The hands on the picture: wheel, drag, box, fingers and keys move the view and the cursors.
import { say } from '../texts';
import { element } from '../view';
import { Session } from './session';

export class Hands {
    /** Lies over the curves, from the left edge of the time to its right one. */
    readonly surface = element('div', { class: 'scope-surface', tabindex: '0', role: 'application', 'aria-label': say('scope_picture') });
    readonly lines = { a: this.cursor_line('a'), b: this.cursor_line('b') };
    /** A drag draws a box to zoom into, instead of moving the time. */
    box_zoom = false;
    private pointed_x_: number | undefined;
    private readonly select_ = element('div', { class: 'scope-select', hidden: true });
    /** Views to come back to. */
    private readonly past_: { from: number; to: number; follow: boolean }[] = [];

    /** `width`: of the time, in pixels; `changed`: the view or a cursor is another. */
    constructor(private readonly session_: Session, private readonly width_: () => number, private readonly changed_: () => void) {
        this.surface.append(this.select_, this.lines.a, this.lines.b);
        this.listen();
    }
    /** The cycle under the mouse. */
    get pointed(): number | undefined {
        return this.pointed_x_ === undefined ? undefined : this.cycle_at(this.pointed_x_);
    }
    /** Another scene: what was seen of the other one is no place to come back to. */
    forget(): void {
        this.past_.length = 0;
    }
    private get view() {
        return this.session_.scene?.view;
    }
    remember(): void {
        const view = this.view;
        if (!view) return;
        this.past_.push({ from: view.from, to: view.to, follow: view.follow });
        if (this.past_.length > 50) this.past_.shift();
    }
    back(): void {
        const was = this.past_.pop(), view = this.view;
        if (!was || !view) return;
        view.follow = was.follow;
        view.show(was.from, was.to);
        view.tie(this.session_.scene?.store.newest ?? 0);
        this.moved();
    }
    zoom(factor: number, part = 0.5): void {
        this.view?.zoom(factor, part);
        this.moved();
    }
    move(part: number): void {
        this.view?.move(part);
        this.moved();
    }
    /** All that is there. */
    all(): void {
        const scene = this.session_.scene;
        if (!scene) return;
        this.remember();
        const firsts = [...scene.store.tracks.values()].map((t) => t.have.list[0]?.from ?? Infinity);
        const first = Math.min(...firsts);
        if (!Number.isFinite(first)) return;
        scene.view.show(first, scene.store.newest);
        this.moved();
    }
    private moved(): void {
        this.session_.changed();
        this.changed_();
    }
    private part(client_x: number): number {
        const box = this.surface.getBoundingClientRect();
        return Math.min(1, Math.max(0, (client_x - box.left) / Math.max(1, this.width_())));
    }
    private cycle_at(client_x: number): number {
        const view = this.view;
        return view ? Math.round(view.from + view.span * this.part(client_x)) : 0;
    }
    private cursor_line(which: 'a' | 'b'): HTMLElement {
        const line = element('div', { class: `scope-cursor ${which}`, role: 'slider', tabindex: '0', hidden: true, 'data-cursor': which, 'aria-label': say('scope_cursor', { which: which.toUpperCase() }),
            onkeydown: (event: KeyboardEvent) => {
                const step = event.key === 'ArrowLeft' ? -1 : event.key === 'ArrowRight' ? 1 : 0;
                if (step === 0) return;
                event.preventDefault();
                event.stopPropagation();
                this.session_.cursors[which] += step * (event.shiftKey ? 10 : 1) * (event.ctrlKey ? 100 : 1);
                this.moved();
            },
            onpointerdown: (event: PointerEvent) => {
                event.preventDefault();
                event.stopPropagation();
                line.focus();
                line.setPointerCapture(event.pointerId);
            },
            onpointermove: (event: PointerEvent) => {
                if (!line.hasPointerCapture(event.pointerId)) return;
                event.stopPropagation();
                this.session_.cursors[which] = this.cycle_at(event.clientX);
                this.changed_();
            },
        }, element('span', {}, which.toUpperCase()));
        return line;
    }

    private listen(): void {
        const surface = this.surface;
        surface.addEventListener('wheel', (event) => {
            event.preventDefault();
            if (event.shiftKey || Math.abs(event.deltaX) > Math.abs(event.deltaY)) this.move(((event.deltaX || event.deltaY) / 100) * 0.1);
            else this.zoom(1.25 ** (event.deltaY / 100), this.part(event.clientX));
        }, { passive: false });
        surface.addEventListener('pointerleave', () => (this.pointed_x_ = undefined));
        const fingers = new Map<number, number>();
        let start: { x: number; from: number; to: number; box: boolean } | undefined;
        surface.addEventListener('pointerdown', (event) => {
            if (event.button !== 0) return;
            event.preventDefault();
            surface.focus({ preventScroll: true });
            surface.setPointerCapture(event.pointerId);
            fingers.set(event.pointerId, event.clientX);
            const view = this.view;
            if (!view) return;
            if (fingers.size === 1) {
                this.remember();
                start = { x: event.clientX, from: view.from, to: view.to, box: this.box_zoom || event.shiftKey };
            } else start = undefined;
        });
        surface.addEventListener('pointermove', (event) => {
            const view = this.view, before = fingers.get(event.pointerId);
            this.pointed_x_ = event.pointerType === 'mouse' && before === undefined ? event.clientX : undefined;
            if (before === undefined || !view) return;
            if (fingers.size === 2) {  // pinch
                const other = [...fingers].find(([id]) => id !== event.pointerId)?.[1] ?? 0;
                const now = Math.abs(event.clientX - other), was = Math.abs(before - other);
                if (now > 10 && was > 10) this.zoom(was / now, this.part((event.clientX + other) / 2));
            } else if (start?.box) {
                const box = surface.getBoundingClientRect();
                this.select_.hidden = false;
                this.select_.style.left = `${Math.max(0, Math.min(start.x, event.clientX) - box.left)}px`;
                this.select_.style.width = `${Math.abs(event.clientX - start.x)}px`;
            } else if (start && Math.abs(event.clientX - start.x) > 3) {
                const by = ((start.x - event.clientX) / this.width_()) * (start.to - start.from);
                view.follow = false;
                view.show(start.from + by, start.to + by);
                this.moved();
            }
            fingers.set(event.pointerId, event.clientX);
        });
        const end = (event: PointerEvent): void => {
            if (!fingers.delete(event.pointerId)) return;
            const view = this.view;
            if (start?.box && view && Math.abs(event.clientX - start.x) > 6) {
                const a = this.part(Math.min(start.x, event.clientX)), b = this.part(Math.max(start.x, event.clientX));
                const { from, span } = view;
                view.follow = false;
                view.show(from + span * a, from + span * b);
                this.moved();
            } else if (start && Math.abs(event.clientX - start.x) <= 3) this.past_.pop();
            this.select_.hidden = true;
            start = undefined;
        };
        surface.addEventListener('pointerup', end);
        surface.addEventListener('pointercancel', end);
        surface.addEventListener('dblclick', () => this.back());
    }
}
