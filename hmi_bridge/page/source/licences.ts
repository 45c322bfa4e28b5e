// What the page and the `taktwerk` command are made with, beside their own source; read by people who must know.
import { Key } from './texts';

export interface Licence {
    name: string;
    licence: string;
    used: Key;
}

export const licences: readonly Licence[] = [
    { name: 'Taktwerk', licence: 'Apache-2.0', used: 'licence_itself' },
    { name: 'CLI11', licence: 'BSD-3-Clause', used: 'licence_command' },
    { name: 'Eigen', licence: 'MPL-2.0', used: 'licence_command' },
    { name: 'fmt', licence: 'MIT', used: 'licence_command' },
    { name: 'JSON for Modern C++', licence: 'MIT', used: 'licence_command' },
    { name: 'LCM, GLib', licence: 'LGPL-2.1-or-later', used: 'licence_command' },
    { name: 'libmodbus', licence: 'LGPL-2.1-or-later', used: 'licence_command' },
    { name: 'pugixml', licence: 'MIT', used: 'licence_command' },
    { name: 'yaml-cpp', licence: 'MIT', used: 'licence_command' },
    { name: 'Boost (Asio, Beast)', licence: 'BSL-1.0', used: 'licence_server' },
    { name: 'esbuild, TypeScript', licence: 'MIT, Apache-2.0', used: 'licence_build' },
];
