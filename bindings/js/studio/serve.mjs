// Serves the studio to this machine alone, with a model of the user's if one is named, and opens it in the browser.
// Usage: node studio/serve.mjs <index.html> [--no-browser] [MODEL.glb]
import { spawn } from 'node:child_process';
import { readFileSync } from 'node:fs';
import { createServer } from 'node:http';
import { basename } from 'node:path';

const args = process.argv.slice(2).filter((arg) => arg !== '--no-browser');
const [file, model] = args;

/** The page, whose first character is the model. */
function pageWith(page, path) {
  if (!path) return page;
  const shown = { name: basename(path).replace(/\.[^.]*$/, ''), glb: readFileSync(path).toString('base64') };
  const start = '<script id="characters" type="application/json">[';
  return page.replace(start, () => `${start}${JSON.stringify(shown).replaceAll('<', '\\u003c')},`);
}

const OPENERS = { darwin: ['open'], win32: ['cmd', '/c', 'start', ''] };
const page = pageWith(readFileSync(file, 'utf8'), model);
const server = createServer(({ method, url, headers }, answer) => {
  // Another host's name that points here is not ours: its pages must not read the model.
  const isOurs = new RegExp(`^(localhost|127\\.0\\.0\\.1):${server.address().port}$`).test(headers.host ?? '');
  if (!isOurs || method !== 'GET' || url !== '/') return answer.writeHead(isOurs ? 404 : 403).end();
  answer.writeHead(200, { 'content-type': 'text/html; charset=utf-8', 'cache-control': 'no-store' }).end(page);
});
server.listen(0, '127.0.0.1', () => {
  const address = `http://localhost:${server.address().port}/`;
  console.log(address);
  if (process.argv.includes('--no-browser')) return;
  const [program, ...before] = OPENERS[process.platform] ?? ['xdg-open'];
  spawn(program, [...before, address], { stdio: 'ignore' }).on('error', () => console.error(`${program} is absent: open the address yourself`));
});
