// Prints the vertices of an FBX file, posed by three's FBXLoader, in the file's own space.
// Usage: node fbx_corners.mjs <in.fbx> <take> <seconds> ...
// Output: a line per vertex, "seconds x y z", of at most 400 vertices spread over the file.
import { readFileSync } from 'node:fs';

// The loader asks for images, which are not needed here.
globalThis.self = globalThis;
globalThis.window = globalThis;
globalThis.document = {
  createElementNS: () => ({ addEventListener() {}, removeEventListener() {}, style: {} }),
};

const three = await import('three');
const { FBXLoader } = await import('three/addons/loaders/FBXLoader.js');

const [input, take, ...times] = process.argv.slice(2);
const bytes = readFileSync(input);
const warn = console.warn;
console.warn = console.log = () => {};
const root = new FBXLoader().parse(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength), '');
console.warn = warn;

const clip = root.animations.find((one) => one.name === take);
if (!clip) throw new Error(`no take ${take} among ${root.animations.map((one) => one.name)}`);
const mixer = new three.AnimationMixer(root);
mixer.clipAction(clip).setLoop(three.LoopOnce).play();
mixer.clipAction(clip).clampWhenFinished = true;

const meshes = [];
root.traverse((node) => node.isMesh && meshes.push(node));
const count = meshes.reduce((sum, mesh) => sum + mesh.geometry.attributes.position.count, 0);
const step = Math.max(1, Math.ceil(count / 400));
const lines = [];
const place = new three.Vector3();
for (const time of times) {
  mixer.setTime(Number(time));
  root.updateMatrixWorld(true);
  let index = 0;
  for (const mesh of meshes) {
    for (let i = 0; i < mesh.geometry.attributes.position.count; ++i) {
      if (index++ % step) continue;
      mesh.getVertexPosition(i, place).applyMatrix4(mesh.matrixWorld);
      lines.push([time, place.x, place.y, place.z].join(' '));
    }
  }
}
process.stdout.write(lines.join('\n') + '\n');
