// Makes the package in dist/: node build.mjs <sunder.wasm>
import { execFileSync } from 'node:child_process';
import { copyFileSync, mkdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { brotliCompressSync, constants, deflateRawSync } from 'node:zlib';
import { build } from 'esbuild';

const here = dirname(fileURLToPath(import.meta.url));
const inHere = (...names) => join(here, ...names);
const wasm = readFileSync(process.argv[2]);

for (const folder of ['dist', 'generated']) {
  rmSync(inHere(folder), { recursive: true, force: true });
  mkdirSync(inHere(folder));
}
execFileSync(process.execPath, [inHere('make_calls.mjs'), inHere('..', 'c', 'sunder_api.json'), inHere('generated', 'calls.js'), inHere('dist', 'calls.d.ts')]);
writeFileSync(inHere('generated', 'inlined.js'), `export const inlined = '${deflateRawSync(wasm, { level: 9 }).toString('base64')}';\n`);

await build({
  entryPoints: { index: inHere('src', 'index.js'), wasm: inHere('src', 'wasm.js'), three: inHere('src', 'three', 'index.js') },
  outdir: inHere('dist'), bundle: true, minifySyntax: true, minifyWhitespace: true, format: 'esm', target: 'es2022', charset: 'utf8',
  external: ['three'], logLevel: 'warning',
});
writeFileSync(inHere('dist', 'sunder.wasm'), wasm);
for (const entry of ['index', 'wasm', 'three']) copyFileSync(inHere('types', `${entry}.d.ts`), inHere('dist', `${entry}.d.ts`));
copyFileSync(inHere('..', '..', 'LICENSE'), inHere('LICENSE'));

const brotli = (bytes) => brotliCompressSync(bytes, { params: { [constants.BROTLI_PARAM_QUALITY]: 11, [constants.BROTLI_PARAM_LGWIN]: 24 } }).length;
for (const name of ['sunder.wasm', 'wasm.js', 'index.js', 'three.js']) {
  const bytes = readFileSync(inHere('dist', name));
  console.log(`${name}: ${bytes.length} bytes, brotli ${brotli(bytes)}`);
}
