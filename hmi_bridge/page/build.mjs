// node build.mjs OUT [TESTS]: the page into OUT/page, the tests of the folder TESTS into OUT/tests. Run from where node_modules is.
import { cp, mkdir, readdir } from 'node:fs/promises';
import { createRequire } from 'node:module';
import { dirname, join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';

const [out, tests] = process.argv.slice(2);
if (!out) throw new Error('usage: node build.mjs OUT [TESTS]');
const here = dirname(fileURLToPath(import.meta.url));
const esbuild = createRequire(resolve(out, 'package.json'))('esbuild');

await mkdir(join(out, 'page'), { recursive: true });
await esbuild.build({
    entryPoints: [join(here, 'source/page.ts'), join(here, 'source/page.css')],
    outdir: join(out, 'page'),
    bundle: true,
    minify: true,
    nodePaths: [resolve(out, 'node_modules')],
    format: 'esm',
    target: ['chrome100', 'firefox100', 'safari15'],
    charset: 'utf8',
    logLevel: 'warning',
});
for (const file of ['index.html', 'icon.svg']) await cp(join(here, 'source', file), join(out, 'page', file));

if (tests) {
    await mkdir(join(out, 'tests'), { recursive: true });
    const files = (await readdir(tests)).filter((name) => name.endsWith('.ts'));
    await esbuild.build({
        entryPoints: files.map((name) => join(tests, name)),
        outdir: join(out, 'tests'),
        outExtension: { '.js': '.mjs' },
        bundle: true,
        platform: 'node',
        format: 'esm',
        target: 'node18',
        packages: 'external',
        alias: { '@page': join(here, 'source') },
        logLevel: 'warning',
    });
}
