// Eight colours that people tell apart who see no red or no green (after Okabe and Ito, made darker or lighter until they stand out from the ground);
// from the ninth curve on they come again with dashes. A curve also has its number, so that colour is never the only sign.

const light = ['#0067ad', '#b84300', '#00735a', '#96307a', '#6f5a00', '#1c2833', '#4a3dbd', '#8a1f2d'];
const dark = ['#62b8f0', '#ff9d57', '#43d3a8', '#f0a5d5', '#f0e25a', '#f3f6f8', '#b0a5ff', '#ff8a92'];
const dashes: readonly number[][] = [[], [8, 4], [2, 3], [10, 3, 2, 3]];

export const most_colours = light.length;
export const is_dark = (): boolean => document.documentElement.dataset['theme'] === 'dark';
export const colour_of = (place: number, on_dark: boolean): string => (on_dark ? dark : light)[place % light.length] ?? '';
export const dash_of = (place: number): readonly number[] => dashes[Math.floor(place / light.length) % dashes.length] ?? [];
/** The first place that no curve has. */
export function free_place(taken: readonly number[]): number {
    let place = 0;
    while (taken.includes(place)) place++;
    return place;
}
