// How a row shares its twelve columns.
export const columns = 12;
/** How many of the columns each widget takes: what it asks for; those that ask for nothing share what is left, the first ones what does not divide. */
export function spans_of(widths: readonly (number | undefined)[]): number[] {
    const open = widths.filter((width) => width === undefined).length;
    const left = Math.max(open, columns - widths.reduce<number>((sum, width) => sum + (width ?? 0), 0));
    let place = 0;
    return widths.map((width) => width ?? Math.floor(left / open) + (place++ < left % open ? 1 : 0));
}
