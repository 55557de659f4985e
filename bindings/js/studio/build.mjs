// Bundles the studio, the library and the characters into one HTML file that needs nothing else: node studio/build.mjs <index.html>
import { createHash } from 'node:crypto';
import { mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { build } from 'esbuild';

const here = dirname(fileURLToPath(import.meta.url));
const rigs = join(here, '..', '..', '..', 'tests', 'data', 'rigged');
const CHARACTERS = [
  { name: 'Cactus', file: join(here, 'characters', 'cactus.glb') },
  { name: 'Tube', file: join(rigs, 'tube.glb') },
  { name: 'Sheet', file: join(rigs, 'seamed_sheet.glb') },
];

async function bundle(entry) {
  const { outputFiles } = await build({
    entryPoints: [join(here, 'src', entry)], bundle: true, minify: true, write: false, format: 'esm', target: 'es2022', charset: 'utf8',
    legalComments: 'inline', logLevel: 'warning', alias: { 'sunder-tear': join(here, '..', 'dist', 'index.js') },
  });
  return outputFiles[0].text.trim();
}

/** What the page's policy allows, so that a browser runs no other script. */
const hashesOfScripts = (page) => [...page.matchAll(/<script(?: type="module")?>([^]*?)<\/script>/g)]
  .map(([, text]) => `'sha256-${createHash('sha256').update(text).digest('base64')}'`).join(' ');

const characters = CHARACTERS.map(({ name, file }) => ({ name, glb: readFileSync(file).toString('base64') }));
const [style, script] = [await bundle('style.css'), await bundle('main.js')];
// Functions as replacements, because "$&" in a bundle is no pattern.
const filled = readFileSync(join(here, 'src', 'index.html'), 'utf8')
  .replace('/* STYLE */', () => style)
  .replace('CHARACTERS', () => JSON.stringify(characters))
  .replace('/* SCRIPT */', () => script.replaceAll('</script', '<\\/script'));
const page = filled.replace('SCRIPT_HASHES', () => hashesOfScripts(filled));
const to = process.argv[2];
mkdirSync(dirname(to), { recursive: true });
writeFileSync(to, page);
console.log(`${to}: ${Buffer.byteLength(page)} bytes`);
