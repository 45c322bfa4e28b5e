// The axes of a group, a row each: where they are, and how much of their limits their set-points use, so that who holds the path back is seen.
import { table } from '../desk';
import { fixed } from '../numbers';
import { GroupMember, GroupState, value } from '../state';
import { element, mark, Rows, write } from '../view';

const uses = ['velocity_use', 'acceleration_use', 'jerk_use'] as const;
/** A part from which on a limit counts as used: as the machine counts. */
const in_use = 0.98;

export function member_rows() {
    const body = element('tbody');
    let limiting = '';
    const rows = new Rows(body, (member: GroupMember) => member.axis, (member) => {
        const actual = element('td', { class: 'number', 'data-value': 'actual' }), set = element('td', { class: 'number', 'data-value': 'set' });
        const bars = uses.map((use) => {
            const fill = element('i'), text = element('span');
            return { fill, text, cell: element('td', { 'data-value': use }, element('div', { class: 'use' }, fill, text)) };
        });
        const root = element('tr', { 'data-member': member.axis }, element('th', { scope: 'row' }, element('a', { href: `#axis/${encodeURIComponent(member.axis)}`, class: 'row-link' }, member.axis)), actual, set, ...bars.map((bar) => bar.cell));
        return { root, actual, set, bars };
    }, (row, member) => {
        write(row.actual, `${fixed(member.actual_position)} ${member.unit}`);
        write(row.set, `${fixed(member.set_position)} ${member.unit}`);
        uses.forEach((use, i) => {
            const bar = row.bars[i], part = value(member[use]);
            if (!bar) return;
            bar.fill.style.width = `${Math.min(100, part * 100).toFixed(1)}%`;
            mark(bar.fill, 'data-full', part >= in_use);
            write(bar.text, `${(part * 100).toFixed(0)} %`);
        });
        mark(row.root, 'data-limiting', member.axis === limiting);
    });
    return {
        root: table(['axis', 'actual_position', 'set_position', 'group_velocity_use', 'group_acceleration_use', 'group_jerk_use'], body, ['actual_position', 'set_position']),
        update(group: GroupState): void {
            limiting = group.limiting_axis;
            rows.update(group.members);
        },
    };
}
