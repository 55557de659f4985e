// Somebody who has node alone, and the file that npm pack makes.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { copyFileSync, readFileSync, readdirSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import test from 'node:test';
import { installed } from './packed.mjs';
import { packageFolder, rigFile } from './support.mjs';

test('the packed package tears a character in an empty folder', () => {
  const { folder, remove } = installed();
  try {
    assert.deepEqual(readdirSync(join(folder, 'node_modules')).filter((name) => !name.startsWith('.')), ['sunder-tear']);
    const own = join(folder, 'node_modules', 'sunder-tear');
    assert.ok(!readdirSync(own).includes('src') && !readdirSync(own).includes('tests'));
    copyFileSync(join(own, 'sample', 'torn.mjs'), join(folder, 'torn.mjs'));
    copyFileSync(rigFile('tube'), join(folder, 'character.glb'));
    const said = execFileSync('node', ['torn.mjs', 'character.glb', 'torn.glb'], { cwd: folder, encoding: 'utf8' });
    assert.match(said, /^[1-9]\d* faces crossed, 1\.\d+ m torn\n$/);
    const torn = readFileSync(join(folder, 'torn.glb'));
    assert.equal(torn.subarray(0, 4).toString(), 'glTF');
    assert.ok(torn.length > readFileSync(rigFile('tube')).length);
  } finally {
    remove();
  }
});

test('the types of the package fit a program that uses it', () => {
  const { folder, remove } = installed();
  try {
    writeFileSync(join(folder, 'use.ts'), `
import { Sunder, SunderError, type Command } from 'sunder-tear';
const model = await Sunder.load(new Uint8Array(4), { soft: 'skin', tension: 3 });
const scene = await Sunder.createScene();
const instance = scene.spawn(model);
const command: Command = instance.tear([[[0, 1, 1], { x: 0, y: 1, z: 0 }], [[0, 0, 1], [0, 0, 0]]], { width: 0.01, layers: 'all' });
// @ts-expect-error
instance.tear([], { walldepth: 1 });
const positions: Float32Array = instance.mesh(0).positions;
command.done.catch((error: SunderError) => error.index);
Sunder.calls.sunder_update(scene as unknown as number, positions[0]);
`);
    writeFileSync(join(folder, 'tsconfig.json'), JSON.stringify({ compilerOptions: { strict: true, noEmit: true, target: 'es2022',
      module: 'nodenext', lib: ['es2022', 'dom', 'esnext.disposable'], types: [] }, files: ['use.ts'] }));
    execFileSync('node', [join(packageFolder, 'node_modules', 'typescript', 'bin', 'tsc'), '-p', folder], { encoding: 'utf8', stdio: 'pipe' });
  } catch (error) {
    assert.fail(error.stdout || String(error));
  } finally {
    remove();
  }
});
