// What a browser keeps for this person: language, theme, chosen variables. One that keeps nothing loses nothing but that.
export function remembered(key: string): string | null {
    try {
        return localStorage.getItem(key);
    } catch {
        return null;
    }
}
export function remember(key: string, text: string): void {
    try {
        localStorage.setItem(key, text);
    } catch { /* none */ }
}
/** A list of texts; empty where it is none. */
export function remembered_list(key: string): string[] {
    try {
        const list: unknown = JSON.parse(remembered(key) ?? '[]');
        return Array.isArray(list) ? list.filter((item) => typeof item === 'string') : [];
    } catch {
        return [];
    }
}
