// A group of axes: where its tool is in the machine and where its axes are, the path that it went, who holds it back, what it does, and the hand on it.
import { Desk, Page, panel, Values } from '../desk';
import { group_hand } from '../group/hand';
import { jog_pad } from '../group/jog_pad';
import { member_rows } from '../group/members';
import { PathView } from '../group/path_view';
import { Trail, trail_seconds } from '../group/trail';
import { duration, fixed } from '../numbers';
import { said } from '../sentences/said';
import { GroupFrame, GroupState, MachineState, ToolPose, value } from '../state';
import { Key, say, word } from '../texts';
import { element, mark, Rows, write } from '../view';

const trail_each = 150;  // ms
const components = ['X', 'Y', 'Z', 'RX', 'RY', 'RZ'] as const;
const signs: Record<string, string> = { GroupDisabled: '○', GroupStandby: '●', GroupHoming: '⌂', GroupStopping: '◼', GroupErrorStop: '⚠' };
const tones: Record<string, string> = { GroupDisabled: 'idle', GroupStopping: 'warn', GroupErrorStop: 'bad' };

/** Who or what holds the velocity along the path down, in words. */
export function held_back(group: GroupState): string {
    return group.limiter === 'axis_limit' && group.limiting_axis ? say('group_limited_axis', { axis: group.limiting_axis }) : word('limiter', group.limiter);
}

/** Which frame that moves it goes with, and how well; empty: none. */
export function goes_with(group: GroupState): string {
    if (!group.track || group.track === 'none') return '';
    const what = say(group.track === 'table' ? 'group_track_table' : 'group_track_belt', { axis: group.track_axis ?? '' });
    return group.track_in_sync ? say('group_track_in_step', { what }) : say('group_track_behind', { what, lag: `${fixed(group.track_lag ?? 0, 1)} ${group.unit}` });
}

/** Why it stands in an error and what to do, the nearest first; empty: it does not. */
export function why_error(group: GroupState): string[] {
    if (group.state !== 'GroupErrorStop' && group.error === 0) return [];
    const name = group.error_text ? said(group.error_text).text : group.error_name ? say('group_alarm_of_an_axis', { alarm: group.error_name }) : String(group.error);
    return [name, said(group.error_cause ?? '').text, said(group.error_remedy ?? '').text].filter((text) => text !== '');
}

/** What it has refused of its program, where and what to do; empty: nothing since it moved. */
export function why_refused(group: GroupState): string[] {
    const refusal = group.refusal;
    if (!refusal) return [];
    const what = refusal.block ? `${refusal.command} (${refusal.block})` : refusal.command;
    return [say('group_refused', { what, why: said(refusal.text).text }), said(refusal.where).text, said(refusal.remedy).text].filter((text) => text !== '');
}

/** A list that is built anew when it says something else; hidden with its panel while it says nothing. */
function reasons(title: Key, value: string) {
    const list = element('ul', { class: 'why', 'data-value': value }), root = panel(title, list);
    let shown = '';
    root.hidden = true;
    return {
        root,
        update(lines: string[]): void {
            root.hidden = lines.length === 0;
            if (shown === lines.join('\n')) return;
            shown = lines.join('\n');
            list.replaceChildren(...lines.map((line) => element('li', {}, line)));
        },
    };
}

function tool_table(unit: string) {
    const cells = { tool_actual: components.map(() => element('td', { class: 'number' })), tool_set: components.map(() => element('td', { class: 'number' })) };
    components.forEach((name, i) => {
        mark(cells.tool_actual[i] as Element, 'data-value', `tool_actual_${name}`);
        mark(cells.tool_set[i] as Element, 'data-value', `tool_set_${name}`);
    });
    const body = element('tbody'), of_frames = new Rows(body, (frame: GroupFrame) => frame.frame, (frame) => {
        const numbers = components.map((name) => element('td', { class: 'number', 'data-value': `${frame.frame}_${name}` })), head = element('th', { scope: 'row' });
        return { root: element('tr', { 'data-frame': frame.frame }, head, ...numbers), head, numbers };
    }, (row, frame) => {
        const name = say(`group_frame_${frame.frame}` as Key);
        write(row.head, frame.axis ? say('group_frame_moves', { name, axis: frame.axis }) : name);
        row.numbers.forEach((cell, i) => write(cell, known ? fixed(frame.tool_actual[i]) : '–'));
    });
    let known = false;
    const row = (of: keyof typeof cells) => element('tr', { class: of === 'tool_actual' ? 'tool-large' : '' }, element('th', { scope: 'row' }, say(`group_${of}`)), ...cells[of]);
    return {
        root: element('table', { class: 'tool' }, element('thead', {}, element('tr', {}, element('th', {}), ...components.map((name, i) => element('th', { scope: 'col', class: 'number' }, `${name} [${i < 3 ? unit : '°'}]`)))),
            element('tbody', {}, row('tool_actual'), row('tool_set')), body),
        update(group: GroupState): void {
            known = group.tool_known;
            of_frames.update(group.frames ?? []);
            for (const of of ['tool_actual', 'tool_set'] as const) cells[of].forEach((cell, i) => write(cell, group.tool_known ? fixed(group[of][i]) : '–'));
        },
    };
}

const place_of = (pose: ToolPose): [number, number, number] => [value(pose[0]), value(pose[1]), value(pose[2])];

/** `#group/NAME`; the first one where there is none of that name. */
export function group_page(desk: Desk, [wanted = '']: readonly string[]): Page {
    const known = desk.link.layout?.groups ?? [];
    const layout = known.find((group) => group.name === wanted) ?? known[0];
    if (!layout) return { root: element('div', { class: 'page group' }, element('p', { class: 'hint' }, say('group_none'))), update: () => undefined };
    const { name, unit } = layout;
    const tabs = element('nav', { class: 'tabs', 'aria-label': say('group_page') }, ...known.map((group) => {
        const tab = element('a', { href: `#group/${encodeURIComponent(group.name)}` }, group.name);
        mark(tab, 'aria-current', group.name === name ? 'page' : false);
        return tab;
    }));
    const state = element('div', { class: 'state', 'data-value': 'group_state' }), note = element('p', { class: 'hint', 'data-value': 'group_note' });
    const tool = tool_table(unit), facts = new Values(), members = member_rows(), hand = group_hand(desk, name), pad = jog_pad(desk, layout);
    const done = element('i'), progress = element('div', { class: 'progress', role: 'progressbar', 'data-value': 'progress' }, done);
    const error = reasons('group_why_error', 'group_why'), refused = reasons('group_why_refused', 'group_refused');
    const path = new PathView(unit), trail = new Trail((request) => desk.link.request(request), name, desk.link.layout?.cycle_ns ?? 1e6);
    const unread = element('p', { class: 'hint' }, say('group_path_unread'));
    const drawn = element('section', { class: 'panel' }, element('h2', {}, say('group_path', { seconds: String(trail_seconds) })), path.root, unread);
    const root = element('div', { class: 'page group' }, element('div', { class: 'bar' }, tabs, element('span', { class: 'space' }), state), error.root, refused.root,
        element('div', { class: 'columns' },
            element('div', { class: 'stack' }, panel('group_tool', tool.root, note), panel('group_doing', facts.root, progress), pad.root, hand.root),
            element('div', { class: 'stack' }, ...(layout.arm ? [drawn] : []), panel('group_axes', members.root))));
    let asked = 0;
    return {
        root,
        leave: pad.leave,
        update(machine: MachineState) {
            const group = machine.groups?.find((one) => one.name === name);
            if (!group) return;
            write(state, `${signs[group.state] ?? '▶'} ${word('group', group.state)}`);
            mark(state, 'data-tone', tones[group.state] ?? (group.interrupted ? 'warn' : 'good'));
            write(note, group.interrupted ? say(group.held ? 'group_interrupted_by_hand' : 'group_interrupted_by_program') : group.tool_known ? '' : say('group_tool_unknown'));
            tool.update(group);
            members.update(group);
            hand.update(group, machine);
            pad.update(group, machine);
            write_facts(facts, group);
            done.style.width = `${(value(group.progress) * 100).toFixed(1)}%`;
            mark(progress, 'aria-valuenow', String(Math.round(value(group.progress) * 100)));
            error.update(why_error(group));
            refused.update(why_refused(group));
            if (layout.arm) {
                const nowhere: [number, number, number] = [NaN, NaN, NaN];
                path.update(trail.points, group.tool_known ? place_of(group.tool_set) : nowhere, group.tool_known ? place_of(group.tool_actual) : nowhere);
                unread.hidden = !trail.unread;
                const now = performance.now();
                if (now - asked >= trail_each && !desk.link.stale) {
                    asked = now;
                    void trail.follow(machine.cycle);
                }
            }
        },
    };
}

/** Several axes go together: the measure of their way is the norm of their numbers, which is no length. */
function is_of_axes(group: GroupState): boolean {
    return group.path_unit === 'u' && group.unit !== 'u';
}

/** Of a way of several axes its share. */
export function left_to_go(group: GroupState): string {
    const left = value(group.remaining_s);
    const way = is_of_axes(group) ? `${fixed((1 - value(group.progress)) * 100, 0)} %` : `${fixed(group.distance_to_go, 1)} ${group.path_unit ?? group.unit}`;
    return left > 0 ? `${way}, ${duration(left)}` : way;
}

function write_facts(facts: Values, group: GroupState): void {
    const speed = `${group.unit}/s`, path_unit = group.path_unit ?? group.unit;
    facts.set('command', group.command ? `${group.command}${group.block ? ` (${group.block})` : ''}` : '–');
    facts.set('group_to_go', group.command ? left_to_go(group) : '–');
    facts.set('group_waiting', String(group.queued));
    facts.set('group_tool_speed', group.tool_known ? `${fixed(group.tool_actual_speed, 1)} ${speed}` : '–');
    const along = `${fixed(group.path_velocity, 1)} ${path_unit}/s`;
    facts.set('group_path_velocity', is_of_axes(group) ? say('group_of_its_axes', { velocity: along }) : along);
    facts.set('group_limited', held_back(group));
    facts.set('group_track', goes_with(group) || '–');
    facts.set('group_deviation', group.tool_known ? `${fixed(group.path_deviation ?? 0)} ${group.unit}` : '–');
    facts.set('group_programs_override', `${fixed(value(group.override) * 100, 0)} %`);
}
