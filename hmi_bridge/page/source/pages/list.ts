// The pages, a line each: the name in the address (`#name/rest`), its title among the tabs, and who makes it.
import { Desk, Page } from '../desk';
import { Key } from '../texts';
import { alarms } from './alarms';
import { axis_page } from './axis';
import { bus } from './bus';
import { group_page } from './group';
import { io } from './io';
import { measure } from './measure';
import { overview } from './overview';
import { programs } from './programs';
import { scope } from './scope';
import { system } from './system';
import { builder_view } from './view';

export interface Entry {
    readonly name: string;
    readonly title: Key;
    /** Made anew whenever the address, the language or the machine changes. `rest`: what stands behind the name in the address, decoded, cut at each `/`. */
    make(desk: Desk, rest: readonly string[]): Page;
    /** No tab of its own: it is reached from another page, whose tab is marked instead. */
    readonly under?: string;
    /** Shown without a machine as well. */
    readonly alone?: boolean;
    /** Whether it has a tab just now; always where it is left out. */
    offered?(desk: Desk): boolean;
}

/** In the order of the tabs. The first one is shown where the address names none. */
export const pages: readonly Entry[] = [
    { name: 'overview', title: 'overview', make: overview },
    { name: 'view', title: 'view_page', make: builder_view, under: 'view' },  // a tab each: frame.ts
    { name: 'axis', title: 'axis', make: axis_page },
    { name: 'measure', title: 'axis_measure', make: measure, under: 'axis' },
    { name: 'group', title: 'group_page', make: group_page, offered: (desk) => (desk.link.layout?.groups ?? []).length > 0 },
    { name: 'scope', title: 'scope', make: scope, alone: true },
    { name: 'alarms', title: 'alarms', make: alarms },
    { name: 'io', title: 'io', make: io },
    { name: 'programs', title: 'programs', make: programs },
    { name: 'bus', title: 'bus', make: bus },
    { name: 'system', title: 'system', make: system },
];
