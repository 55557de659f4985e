// One HTML file from the folder of a page: index.html, in whose marks its style, its script and other texts are put.
import { createHash } from 'node:crypto';
import { readFileSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';

const parts = join(dirname(fileURLToPath(import.meta.url)), 'src');

/** What a policy allows, so that a browser runs no other script: the hash of each script; data is none. */
function hashesOfScripts(page) {
  const scripts = [...page.matchAll(/<script(?: type="module")?>([^]*?)<\/script>/g)];
  if (scripts.length + 1 !== page.split('<script').length - 1) throw new Error('Unknown scripts.');
  return scripts.map(([, text]) => `'sha256-${createHash('sha256').update(text).digest('base64')}'`).join(' ');
}

/**
 * @param build  of esbuild @param options  for it @param texts  those of other marks, { mark: text }, by what the script
 * is made from: paths of files
 */
export async function pageHtml({ folder, build, options = {}, texts = () => ({}) }) {
  const bundle = async (entry) => {
    const { outputFiles, metafile } = await build({
      entryPoints: [join(folder, entry)], bundle: true, minify: true, write: false, metafile: true, format: 'esm', target: 'es2022',
      charset: 'utf8', legalComments: 'inline', logLevel: 'warning', ...options,
    });
    return { text: outputFiles[0].text.trim(), inputs: Object.keys(metafile.inputs) };
  };
  const style = await bundle('style.css'), script = await bundle('main.js');
  const marks = {
    '/* STYLE */': style.text,
    '/* SHOW_ERROR */': readFileSync(join(parts, 'show_error.js'), 'utf8').trim(),
    ...texts(script.inputs),
    '/* SCRIPT */': script.text,
  };
  let page = readFileSync(join(folder, 'index.html'), 'utf8');
  // A function as replacement, because "$&" in a bundle is no pattern.
  for (const [mark, text] of Object.entries(marks)) page = page.replace(mark, () => text);
  page = page.replace(/\r\n?/g, '\n');  // as browsers read it before they compute hashes
  return page.replace('SCRIPT_HASHES', () => hashesOfScripts(page));
}
