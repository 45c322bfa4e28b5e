// Elements and what is written into them: a page is built once and then only written to, so that a button that is held stays the same button.

type Attributes = Record<string, string | boolean | ((event: never) => void)>;

/** An element: attributes by name, listeners as `onclick`, `true` as an attribute without a value. Text is text, never markup. */
export function element<K extends keyof HTMLElementTagNameMap>(tag: K, attributes: Attributes = {}, ...children: (Node | string)[]): HTMLElementTagNameMap[K] {
    const made = document.createElement(tag);
    apply(made, attributes);
    made.append(...children);
    return made;
}

export function drawing(tag: string, attributes: Attributes = {}, ...children: (Node | string)[]): SVGElement {
    const made = document.createElementNS('http://www.w3.org/2000/svg', tag);
    apply(made, attributes);
    made.append(...children);
    return made;
}

function apply(to: Element, attributes: Attributes): void {
    for (const [name, given] of Object.entries(attributes)) {
        if (typeof given === 'function') to.addEventListener(name.slice(2), given as EventListener);
        else if (given !== false) to.setAttribute(name, given === true ? '' : given);
    }
}

/** Writes only what is different: a screen reader and the layout see changes, not each message. */
export function write(to: Element, text: string): void {
    if (to.textContent !== text) to.textContent = text;
}
export function mark(to: Element, name: string, text: string | boolean): void {
    if (text === false) to.removeAttribute(name);
    else if (to.getAttribute(name) !== (text === true ? '' : text)) to.setAttribute(name, text === true ? '' : text);
}

/** Rows that follow a list by key: what stays keeps its elements. */
export class Rows<T, R extends { root: Element }> {
    private readonly made_ = new Map<string, R>();
    constructor(private readonly parent_: Element, private readonly key_: (item: T) => string, private readonly make_: (item: T) => R,
                private readonly update_: (row: R, item: T) => void) {}
    row(key: string): R | undefined {
        return this.made_.get(key);
    }
    update(items: readonly T[]): void {
        const present = new Set<string>();
        let before: Element | null = this.parent_.firstElementChild;
        for (const item of items) {
            const key = this.key_(item);
            if (present.has(key)) continue;
            present.add(key);
            let row = this.made_.get(key);
            if (!row) this.made_.set(key, (row = this.make_(item)));
            if (row.root === before) before = before.nextElementSibling;
            else this.parent_.insertBefore(row.root, before);
            this.update_(row, item);
        }
        for (const [key, row] of this.made_)
            if (!present.has(key)) {
                row.root.remove();
                this.made_.delete(key);
            }
    }
}

/** A small window over the page that leaves everything else as it is: STOP stays in reach. Escape closes it. */
export function small_window(attributes: Attributes, ...children: (Node | string)[]): HTMLDialogElement {
    const made = element('dialog', { class: 'dialog', ...attributes }, ...children);
    made.addEventListener('keydown', (event) => {
        if (event.key === 'Escape') made.close();
    });
    return made;
}
