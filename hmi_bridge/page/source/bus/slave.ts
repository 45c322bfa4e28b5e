// One slave of the bus: what it is, its ports with their counters, its clock, what it says of itself.
import { hex, microseconds } from '../numbers';
import { said } from '../sentences/said';
import { say } from '../texts';
import { element, mark, Rows, write } from '../view';
import { Values } from '../desk';
import { BusSlave, Port } from './tree';

export class SlaveDetails {
    private readonly title_ = element('h2');
    private readonly values_ = new Values();
    private readonly body_ = element('tbody');
    private readonly said_ = element('p', { class: 'hint', lang: 'en' });
    private readonly ports_ = new Rows(this.body_, (port: Port & { number: number }) => String(port.number), (port) => {
        const cells = [0, 1, 2, 3, 4].map((i) => element('td', i === 0 ? {} : { class: 'number' }));
        return { root: element('tr', {}, element('th', { scope: 'row' }, String(port.number)), ...cells), cells };
    }, (row, port) => {
        [port.link ? `● ${said(port.at_other_end).text || say('link')}` : `○ ${say('no_link')}`, port.lost_links, port.rx_errors, port.invalid_frames, port.forwarded_errors].forEach((text, i) => {
            const cell = row.cells[i];
            if (!cell) return;
            write(cell, String(text));
            if (i > 0) mark(cell, 'data-tone', i < 4 && text !== 0 ? 'bad' : 'idle');
        });
    });
    readonly root = element('section', { class: 'panel', 'data-part': 'slave' }, this.title_, this.said_, this.values_.root,
        element('table', { class: 'dense' }, element('thead', {}, element('tr', {}, ...(['port', 'at_other_end', 'lost_links', 'rx_errors', 'invalid_frames', 'forwarded_errors'] as const).map((key, i) =>
            element('th', { scope: 'col', class: i > 1 ? 'number' : '', title: say(key) }, say(key))))), this.body_));

    update(slave: BusSlave | undefined): void {
        this.root.hidden = !slave;
        if (!slave) return;
        write(this.title_, `${slave.position ?? '–'}  ${slave.name}`);
        write(this.said_, [slave.al_status_code ? `${hex(slave.al_status_code)} ${slave.al_status_text}. ${slave.al_status_remedy}` : '', slave.trouble ?? '', slave.unread ?? ''].filter((text) => text !== '').join(' '));
        this.values_.set('device', slave.device || '–');
        this.values_.set('identity', `${hex(slave.vendor, 8)} · ${hex(slave.product, 8)} · ${hex(slave.revision, 8)}`);
        this.values_.set('serial', String(slave.serial));
        if (slave.dc !== undefined) {
            this.values_.set('dc_delay', slave.dc ? `${microseconds(slave.dc_delay_ns ?? 0)} µs` : '–');
            this.values_.set('dc_of_slave', !slave.dc ? say('no_clock') : slave.reference_clock ? say('reference_clock') : `${slave.dc_difference_ns ?? 0} ns`);
        }
        this.ports_.update((slave.ports ?? []).map((port, number) => ({ ...port, number })));
    }
}
