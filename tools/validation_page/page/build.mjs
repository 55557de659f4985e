// Bundles the page into one HTML file, and that into the pieces of a C++ source.
// Usage: node build.mjs <page.html> <page_template.cpp>
import { readFileSync, writeFileSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { build } from 'esbuild';

const here = dirname(fileURLToPath(import.meta.url));
const [htmlFile, cppFile] = process.argv.slice(2);

async function bundle(entry) {
  const result = await build({
    entryPoints: [join(here, 'src', entry)],
    bundle: true,
    minify: true,
    write: false,
    format: 'esm',
    target: 'es2022',
    charset: 'utf8',
    legalComments: 'inline',
    logLevel: 'warning',
  });
  return result.outputFiles[0].text.trim();
}

/** Where a licence is required to travel with the code: one comment at the top of the bundle. */
function licences() {
  return ['three', 'd3-scale-chromatic', 'd3-interpolate', 'd3-color'].map((name) => {
    const folder = join(here, 'node_modules', name);
    const { version } = JSON.parse(readFileSync(join(folder, 'package.json'), 'utf8'));
    return `${name} ${version}\n${readFileSync(join(folder, 'LICENSE'), 'utf8').trim()}`;
  }).join('\n\n');
}

/** A string literal of C++; short ones, because compilers limit their length. */
function literals(text) {
  const pieces = text.match(/[^]{1,8000}/gu);
  return pieces.map((piece) => {
    const escaped = piece.replace(/[\\"?]/g, '\\$&').replace(/\r/g, '\\r').replace(/\t/g, '\\t');
    return escaped.split('\n').map((line) => `"${line}`).join('\\n"\n') + '"';
  }).join(',\n');
}

const style = await bundle('style.css');
const script = await bundle('main.js');
// A function as replacement, because "$&" in a bundle is no pattern.
const html = readFileSync(join(here, 'src', 'index.html'), 'utf8')
  .replace('/* LICENCES */', () => `/*\n${licences()}\n*/`)
  .replace('/* STYLE */', () => style)
  .replace('/* SCRIPT */', () => script);
if (html.split('SUNDER_PAGE_DATA').length !== 2) throw new Error('The data needs exactly one place.');
writeFileSync(htmlFile, html);
writeFileSync(cppFile, `#include "tools/validation_page/page_template.h"

namespace sunder::tools {
namespace {
constexpr std::string_view kPieces[] = {
${literals(html)}};
}  // namespace

std::span<const std::string_view> page_template() { return kPieces; }

}  // namespace sunder::tools
`);
