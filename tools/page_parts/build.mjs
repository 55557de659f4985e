// Bundles a page into one HTML file, and that into the pieces of a C++ source.
// Usage: node build.mjs <folder of the page> <page.html> <template.cpp> <C++ function>
import { createHash } from 'node:crypto';
import { readFileSync, writeFileSync } from 'node:fs';
import { dirname, join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';
import { build } from 'esbuild';

const packages = join(dirname(fileURLToPath(import.meta.url)), 'node_modules');
const [folder, htmlFile, cppFile, functionName] = process.argv.slice(2);

async function bundle(entry) {
  const result = await build({
    entryPoints: [resolve(folder, entry)],
    nodePaths: [packages],
    bundle: true,
    minify: true,
    write: false,
    metafile: true,
    format: 'esm',
    target: 'es2022',
    charset: 'utf8',
    legalComments: 'inline',
    logLevel: 'warning',
  });
  return { text: result.outputFiles[0].text.trim(), inputs: Object.keys(result.metafile.inputs) };
}

/** The licences of the packages in a bundle, which travel with it in one comment at its top. */
function licences(inputs) {
  const names = inputs.map((input) => /.*node_modules\/((?:@[^/]+\/)?[^/]+)/.exec(input)?.[1]);
  return [...new Set(names.filter(Boolean))].sort().map((name) => {
    const { version } = JSON.parse(readFileSync(join(packages, name, 'package.json'), 'utf8'));
    return `${name} ${version}\n${readFileSync(join(packages, name, 'LICENSE'), 'utf8').trim()}`;
  }).join('\n\n');
}

/** What a policy allows, so that a browser runs no other script: the hash of each script; data is none. */
function hashesOfScripts(page) {
  const scripts = [...page.matchAll(/<script(?: type="module")?>([^]*?)<\/script>/g)];
  if (scripts.length + 1 !== page.split('<script').length - 1) throw new Error('Unknown scripts.');
  return scripts.map(([, text]) => `'sha256-${createHash('sha256').update(text).digest('base64')}'`).join(' ');
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
const bundled = readFileSync(join(folder, 'index.html'), 'utf8')
  .replace('/* LICENCES */', () => `/*\n${licences(script.inputs)}\n*/`)
  .replace('/* STYLE */', () => style.text)
  .replace('/* SCRIPT */', () => script.text)
  .replace(/\r\n?/g, '\n');  // as browsers read it before they compute hashes
const html = bundled.replace('SCRIPT_HASHES', hashesOfScripts(bundled));
if (html.split('SUNDER_PAGE_DATA').length !== 2) throw new Error('The data needs exactly one place.');
writeFileSync(htmlFile, html);
writeFileSync(cppFile, `#include "tools/page_parts/page_template.h"

namespace sunder::tools {
namespace {
constexpr std::string_view ${functionName}_pieces[] = {
${literals(html)}};
}  // namespace

PageTemplate ${functionName}() { return ${functionName}_pieces; }

}  // namespace sunder::tools
`);
