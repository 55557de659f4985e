// Prints the nodes of an FBX file but its lights and cameras, posed by three's FBXLoader at four keys of a take, in the file's own space.
// Usage: node fbx_nodes.mjs <in.fbx> <take>
// Output: a line per node and key, "seconds-from-the-first-key<TAB>name<TAB>16 numbers", a matrix by columns.
import { readFileSync } from 'node:fs';

// The loader asks for images, which are not needed here.
globalThis.self = globalThis;
globalThis.window = globalThis;
globalThis.document = {
  createElementNS: () => ({ addEventListener() {}, removeEventListener() {}, style: {} }),
};
console.warn = console.log = () => {};

const { AnimationMixer, LoopOnce } = await import('three');
const { FBXLoader } = await import('three/addons/loaders/FBXLoader.js');

const [input, take] = process.argv.slice(2);
const bytes = readFileSync(input);
const root = new FBXLoader().parse(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength), '');
const clip = root.animations.find((one) => one.name === take);
if (!clip) throw new Error(`no take ${take} among ${root.animations.map((one) => one.name)}`);
const action = new AnimationMixer(root).clipAction(clip).setLoop(LoopOnce).play();
action.clampWhenFinished = true;

// Between keys three interpolates rotations, not the curves of the file.
const start = Math.min(...clip.tracks.map((track) => track.times[0]));
const keys = clip.tracks.reduce((most, track) => (track.times.length > most.length ? track.times : most), []);
const lines = [];
for (const part of [0, 0.3, 0.6, 1]) {
  const time = keys[Math.round(part * (keys.length - 1))];
  action.getMixer().setTime(time);
  root.updateMatrixWorld(true);
  root.traverse((node) => {
    const name = node.userData.originalName;
    if (name && !node.isLight && !node.isCamera) lines.push([time - start, name, node.matrixWorld.elements.join(' ')].join('\t'));
  });
}
process.stdout.write(lines.join('\n') + '\n');
