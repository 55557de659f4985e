// What npm pack makes, installed in an empty folder, without network.
import { execFileSync } from 'node:child_process';
import { mkdtempSync, readFileSync, readdirSync, rmSync, symlinkSync, writeFileSync } from 'node:fs';
import { createServer } from 'node:http';
import { tmpdir } from 'node:os';
import { extname, join, normalize } from 'node:path';
import { packageFolder } from './support.mjs';

/** @returns { folder, remove } */
export function installed() {
  const folder = mkdtempSync(join(tmpdir(), 'sunder-tear-'));
  const npm = (args, cwd) => execFileSync('npm', [...args, '--offline', '--ignore-scripts', '--no-audit', '--no-fund', '--loglevel=error'], { cwd, encoding: 'utf8' });
  npm(['pack', '--pack-destination', folder], packageFolder);
  const [tarball] = readdirSync(folder).filter((name) => name.endsWith('.tgz'));
  writeFileSync(join(folder, 'package.json'), '{ "private": true, "type": "module" }');
  npm(['install', `./${tarball}`], folder);
  return { folder, remove: () => rmSync(folder, { recursive: true, force: true }) };
}

/** three as its users have it beside the package. */
export const addThree = (folder) => symlinkSync(join(packageFolder, 'node_modules', 'three'), join(folder, 'node_modules', 'three'));

const TYPES = { '.html': 'text/html', '.js': 'text/javascript', '.mjs': 'text/javascript', '.wasm': 'application/wasm', '.glb': 'model/gltf-binary' };

/** Serves a folder on the loopback. @returns { address, close } */
export async function serve(folder) {
  const server = createServer((request, response) => {
    const path = normalize(decodeURIComponent(new URL(request.url, 'http://a').pathname));
    try {
      const bytes = readFileSync(join(folder, path));
      response.writeHead(200, { 'content-type': TYPES[extname(path)] ?? 'application/octet-stream' }).end(bytes);
    } catch {
      response.writeHead(404).end();
    }
  });
  await new Promise((resolve) => server.listen(0, '127.0.0.1', resolve));
  return { address: `http://127.0.0.1:${server.address().port}`, close: () => server.close() };
}
