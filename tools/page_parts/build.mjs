// Bundles a page into one HTML file, and that into the pieces of a C++ source.
// Usage: node build.mjs <folder of the page> <page.html> <template.cpp> <C++ function>
import { readFileSync, writeFileSync } from 'node:fs';
import { dirname, join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';
import { build } from 'esbuild';
import { pageHtml } from './page_html.mjs';

const packages = join(dirname(fileURLToPath(import.meta.url)), 'node_modules');
const [folder, htmlFile, cppFile, functionName] = process.argv.slice(2);

/** The licences of the packages in a bundle, which travel with it in one comment at its top. */
function licences(inputs) {
  const names = inputs.map((input) => /.*node_modules\/((?:@[^/]+\/)?[^/]+)/.exec(input)?.[1]);
  return [...new Set(names.filter(Boolean))].sort().map((name) => {
    const { version } = JSON.parse(readFileSync(join(packages, name, 'package.json'), 'utf8'));
    return `${name} ${version}\n${readFileSync(join(packages, name, 'LICENSE'), 'utf8').trim()}`;
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

const html = await pageHtml({ folder: resolve(folder), build, options: { nodePaths: [packages] },
  texts: (inputs) => ({ '/* LICENCES */': `/*\n${licences(inputs)}\n*/` }) });
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
