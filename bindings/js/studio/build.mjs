// Bundles the studio, the library and the characters into one HTML file that needs nothing else: node studio/build.mjs <index.html>
import { mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { build } from 'esbuild';
import { pageHtml } from '../../../tools/page_parts/page_html.mjs';

const here = dirname(fileURLToPath(import.meta.url));
const rigs = join(here, '..', '..', '..', 'tests', 'data', 'rigged');
const CHARACTERS = [
  { name: 'Cactus', file: join(here, 'characters', 'cactus.glb') },
  { name: 'Tube', file: join(rigs, 'tube.glb') },
  { name: 'Sheet', file: join(rigs, 'seamed_sheet.glb') },
];

const characters = CHARACTERS.map(({ name, file }) => ({ name, glb: readFileSync(file).toString('base64') }));
const page = await pageHtml({
  folder: join(here, 'src'), build,
  options: { alias: { 'sunder-tear': join(here, '..', 'dist', 'index.js') } },
  texts: () => ({ CHARACTERS: JSON.stringify(characters) }),
});
const to = process.argv[2];
mkdirSync(dirname(to), { recursive: true });
writeFileSync(to, page);
console.log(`${to}: ${Buffer.byteLength(page)} bytes`);
