// The bus as it is cabled: a line per slave, its cable drawn to the slave before it, its ports, what is wrong with it in the same line.
import { drawing, element, mark, Rows, write } from '../view';
import { say } from '../texts';

/** As the machine says it (hmi_bridge/README.md, `bus`). What only configured slaves have is absent from others. */
export interface Port {
    link: boolean;
    open: boolean;
    at_other_end: string;
    child: number | null;
    lost_links: number;
    rx_errors: number;
    invalid_frames: number;
    forwarded_errors: number;
}
export interface BusSlave {
    /** null: it is not on the cable. */
    position: number | null;
    name: string;
    configured: boolean;
    device: string;
    vendor: number;
    product: number;
    revision: number;
    serial: number;
    parent?: number | null;
    parent_port?: number | null;
    entry_port?: number | null;
    depth?: number | null;
    state: string;
    al_error: boolean;
    al_status_code: number;
    al_status_text: string;
    al_status_remedy: string;
    ports?: Port[];
    unread?: string;
    group?: string;
    away?: boolean;
    fresh?: boolean;
    age?: number;
    dc?: boolean;
    reference_clock?: boolean;
    dc_delay_ns?: number;
    dc_difference_ns?: number;
    trouble?: string;
    not_exchanged?: boolean;
}

const row_height = 46, indent = 26;

export const errors_of = (port: Port): number => port.lost_links + port.rx_errors + port.invalid_frames;

/** How far a slave stands to the right: a branch is one step further than the line that it leaves; the line itself goes straight down. */
export function columns_of(slaves: readonly BusSlave[]): number[] {
    const out: number[] = [];
    slaves.forEach((slave, i) => {
        const parent = slave.parent ?? null;
        if (parent === null || out[parent] === undefined) out[i] = 0;
        else {
            const children = slaves.filter((other) => other.parent === parent);
            // Of several children the last one, in the order of the cable, goes on with the line.
            out[i] = (out[parent] ?? 0) + (children.at(-1) === slave ? 0 : 1);
        }
    });
    return out;
}

export class BusTree {
    readonly root = element('div', { class: 'tree' });
    private shown_: readonly BusSlave[] = [];
    private columns_: number[] = [];
    private readonly rows_: { update(items: readonly BusSlave[]): void };

    constructor(private readonly chosen_: (slave: BusSlave) => void, private readonly is_chosen_: (slave: BusSlave) => boolean) {
        this.rows_ = new Rows(this.root, (slave: BusSlave) => `${slave.position ?? 'away'}/${slave.name}`, (slave) => {
            const cable = drawing('svg', { class: 'cable', 'aria-hidden': 'true' });
            const where = element('span', { class: 'number place' }), name = element('strong', {}), device = element('span', { class: 'doc', lang: 'en' });
            const state = element('span', { class: 'slave-state' }), ports = element('span', { class: 'ports' }), trouble = element('span', { class: 'slave-trouble', lang: 'en' });
            const box = element('button', { type: 'button', class: 'slave', 'data-slave': slave.name, onclick: () => {
                const now = this.shown_.find((other) => other.position === slave.position && other.name === slave.name);
                if (now) this.chosen_(now);
            } }, where, element('span', { class: 'slave-name' }, name, device), state, ports, trouble);
            return { root: element('div', { class: 'tree-row' }, cable, box), cable, box, where, name, device, state, ports, trouble };
        }, (row, slave) => {
            write(row.where, slave.position === null ? '–' : String(slave.position));
            write(row.name, slave.name || say('unnamed'));
            write(row.device, slave.device || (slave.configured ? '' : say('not_configured')));
            const ok = slave.state === 'OP' && !slave.al_error;
            write(row.state, `${slave.position === null ? '✕' : ok ? '●' : '⚠'} ${slave.position === null ? say(slave.away ? 'slave_away' : 'slave_missing') : slave.state === 'unknown' ? say('state_unknown') : slave.state}`);
            mark(row.state, 'data-tone', slave.position === null ? (slave.away ? 'idle' : 'bad') : ok ? 'good' : 'warn');
            const said = [slave.al_status_code ? slave.al_status_text : '', slave.trouble ?? '', slave.fresh === false && slave.position !== null ? say('aged', { count: String(slave.age ?? 0) }) : '',
                ...(slave.ports ?? []).map((port, i) => (errors_of(port) > 0 ? say('port_errors', { port: String(i), count: String(errors_of(port)) }) : ''))].filter((text) => text !== '');
            write(row.trouble, said.length > 0 ? `⚠ ${said.join(' · ')}` : '');
            mark(row.box, 'aria-pressed', this.is_chosen_(slave) ? 'true' : 'false');
            const drawn = (slave.ports ?? []).map((port) => (port.link ? (errors_of(port) > 0 ? 'e' : 'l') : '-')).join('');
            if (row.ports.dataset['drawn'] !== drawn) {
                row.ports.dataset['drawn'] = drawn;
                row.ports.replaceChildren(...[...drawn].map((kind, i) => element('span', { class: 'port', 'data-kind': kind, title: `${say('port')} ${i}: ${say(kind === '-' ? 'no_link' : 'link')}` }, String(i))));
            }
            this.draw_cable(row.cable, slave);
        });
    }
    update(slaves: readonly BusSlave[]): void {
        this.shown_ = slaves;
        this.columns_ = columns_of(slaves);
        this.rows_.update(slaves);
    }

    /** Within each row: lines that pass by on their way down, and the bend from the parent's column to this slave. */
    private draw_cable(to: SVGElement, slave: BusSlave): void {
        const i = this.shown_.indexOf(slave), column = this.columns_[i] ?? 0, parent = slave.parent ?? null;
        const x = (at: number): number => 12 + at * indent;
        const lines: string[] = [];
        if (slave.position !== null) {
            const from = parent === null ? 0 : this.columns_[parent] ?? 0;
            if (i === 0) lines.push(`M${x(0)} 0 V${row_height / 2}`);
            else lines.push(from === column ? `M${x(column)} 0 V${row_height / 2}` : `M${x(from)} 0 V${row_height / 2} H${x(column)}`);
            if (this.shown_.some((other) => other.parent === i)) lines.push(`M${x(column)} ${row_height / 2} V${row_height}`);
            // A child of one above that stands further below: its line passes here.
            this.shown_.forEach((other, j) => {
                if (j > i && other.parent !== null && other.parent !== undefined && other.parent < i) lines.push(`M${x(this.columns_[other.parent] ?? 0)} 0 V${row_height}`);
            });
        }
        const drawn = lines.join(' ') + column;
        if (to.getAttribute('data-drawn') === drawn) return;
        mark(to, 'data-drawn', drawn);
        const wide = x(column) + 14;
        mark(to, 'width', String(wide));
        mark(to, 'height', String(row_height));
        to.replaceChildren(drawing('path', { d: lines.join(' ') }), drawing('path', { d: slave.position === null ? '' : `M${x(column)} ${row_height / 2} H${wide}` }));
    }
}
