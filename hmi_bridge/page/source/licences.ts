// What the page is made with, beside what the machine lists of itself; read by people who must know.
import { Key } from './texts';

export interface Licence {
    name: string;
    version: string;
    licence: string;
    used: Key;
}

export const page_licences: readonly Licence[] = [
    { name: 'uPlot', version: '1.6.32', licence: 'MIT', used: 'licence_page' },
    { name: 'esbuild', version: '', licence: 'MIT', used: 'licence_build' },
    { name: 'TypeScript', version: '', licence: 'Apache-2.0', used: 'licence_build' },
];
