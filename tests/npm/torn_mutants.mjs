// Changes a torn file and looks whether tools/check_torn.mjs refuses it: its document in each way of DOCUMENTS, and single bytes of its
// accessors. What it accepts of the latter must be harmless: the model's numbers differ by less than rounding, or only the record does,
// which then tells less.
// Usage: node torn_mutants.mjs COUNT SEED SOURCE.glb TORN.glb [SOURCE.glb TORN.glb ...]. Prints counts as JSON; exit code 1 if a harmful one passed.
import { readFileSync } from 'node:fs';
import { checkTorn, Gltf, openGltf, Unchecked } from '../../tools/check_torn.mjs';

const EXTENSION = 'SUNDER_torn_mesh', RECORD = ['parts', 'parents', 'places', 'kinds', 'sums', 'reduced', 'remaining'];
const HARMLESS = 2 ** -20;  // of the largest magnitude in the accessor
const [count, seed, ...files] = process.argv.slice(2);
let state = Number(seed) >>> 0;
const random = (n) => {  // xorshift32
  for (const shift of [13, -17, 5]) state = (state ^ (shift > 0 ? state << shift : state >>> -shift)) >>> 0;
  return state % n;
};

/** The accessors of torn meshes, and where their bytes are in the file. */
function targetsOf(torn) {
  const found = new Map(), { json } = torn, add = (index, isRecord) => { if (index !== undefined && !found.has(index)) found.set(index, { index, isRecord }); };
  for (const primitive of json.meshes.flatMap((mesh) => mesh.primitives)) {
    const record = primitive.extensions?.[EXTENSION];
    if (!record) continue;
    for (const of of [primitive.attributes, ...(primitive.targets ?? [])]) Object.values(of).forEach((index) => add(index, false));
    add(primitive.indices, false);
    RECORD.forEach((name) => add(record[name], true));
  }
  const from = torn.bin.byteOffset - torn.bytes.byteOffset, spans = (index, offset, length) => [from + (json.bufferViews[index].byteOffset ?? 0) + (offset ?? 0), length];
  for (const target of found.values()) {
    const { bufferView, byteOffset, count: n, type, componentType, sparse } = json.accessors[target.index];
    const size = (componentType < 5122 ? 1 : componentType < 5124 ? 2 : 4) * { SCALAR: 1, VEC2: 2, VEC3: 3, VEC4: 4 }[type];
    target.spans = bufferView === undefined ? [] : [spans(bufferView, byteOffset, (n - 1) * (json.bufferViews[bufferView].byteStride ?? size) + size)];
    if (sparse) target.spans.push(...[sparse.indices, sparse.values].map((part, i) => spans(part.bufferView, part.byteOffset, sparse.count * (i ? size : part.componentType < 5124 ? 2 : 4))));
  }
  return [...found.values()].filter(({ spans: of }) => of.length > 0);
}

/** The largest change of a number, relative to the largest magnitude. */
function change(before, after) {
  let most = 0, difference = 0;
  before.forEach((x, i) => {
    most = Math.max(most, Math.abs(x));
    if (!(Math.abs(x - after[i]) <= difference)) difference = Math.abs(x - after[i]);
  });
  return difference / most;
}

/** Gives a record a chain of new vertices, each between the one before and another of the source. */
function chain(json, length) {
  const primitive = json.meshes.flatMap((mesh) => mesh.primitives).find(({ extensions }) => extensions?.[EXTENSION]), record = primitive.extensions[EXTENSION], first = record.firstVertex;
  const add = (values, componentType, type, count) => {
    json.buffers.push({ byteLength: values.byteLength, uri: `data:;base64,${Buffer.from(values.buffer).toString('base64')}` });
    json.bufferViews.push({ buffer: json.buffers.length - 1, byteLength: values.byteLength });
    return json.accessors.push({ bufferView: json.bufferViews.length - 1, componentType, type, count }) - 1;
  };
  const at = (make) => Array.from({ length }, (_, i) => make(i)).flat(), n = first + length;
  const indices = add(new Uint32Array([first + length - 1, first + length - 2, first + length - 3]), 5125, 'SCALAR', 3);
  delete primitive.targets;
  Object.assign(primitive, { attributes: { POSITION: add(new Float32Array(3 * n), 5126, 'VEC3', n) }, indices });
  Object.assign(record, { parents: add(new Uint32Array(at((i) => [i ? first + i - 1 : 0, i % first, 0])), 5125, 'SCALAR', 3 * length), places: add(new Uint32Array(at((i) => i)), 5125, 'SCALAR', length) });
  Object.assign(record, { parts: add(new Float32Array(at(() => [0.5, 0.5, 0])), 5126, 'VEC3', length), kinds: add(new Uint8Array(length), 5121, 'SCALAR', length), sums: undefined });
}

const shown = (json) => json.nodes.filter(({ mesh }) => mesh !== undefined), primitivesOf = (json) => json.meshes.flatMap(({ primitives }) => primitives);
const isFilling = ({ extensions }) => extensions?.[EXTENSION] && extensions[EXTENSION].sourcePrimitive === undefined;
/** Changes of the document that must be refused; false: there is nothing to change. */
const DOCUMENTS = {
  'no node has a mesh': (json) => shown(json).forEach((node) => delete node.mesh),
  'the first node has no mesh': (json) => delete shown(json)[0].mesh,
  'the last node has no mesh': (json) => delete shown(json).at(-1).mesh,
  'the first node with a mesh has no skin': (json) => shown(json)[0].skin !== undefined && delete shown(json)[0].skin,
  'the first primitive is gone': (json) => json.meshes[0].primitives.shift(),
  'the last primitive is gone': (json) => json.meshes.at(-1).primitives.pop(),
  'a wall or cap is gone': (json) => primitivesOf(json).some(isFilling) && json.meshes.forEach((mesh) => { mesh.primitives = mesh.primitives.filter((one) => !isFilling(one)); }),
  'the first primitive is there twice': (json) => json.meshes[0].primitives.push(json.meshes[0].primitives[0]),
  'the first primitive has another material': (json) => { json.meshes[0].primitives[0].material = (json.meshes[0].primitives[0].material ?? 0) + 1; },
  'the last primitive of the source has another material': (json) => { const one = primitivesOf(json).filter((of) => !isFilling(of)).at(-1); one.material = (one.material ?? 0) + 1; },
  'the first material is another': (json) => json.materials?.length > 1 && json.materials.reverse(),
  'scenes are empty': (json) => json.scenes.forEach((scene) => { scene.nodes = []; }),
  'there are no scenes': (json) => delete json.scenes,
  'another node shows a mesh': (json) => json.scenes[0].nodes.push(json.nodes.push({ mesh: shown(json)[0].mesh, translation: [5, 0, 0] }) - 1),
  'another node of the source shows a mesh': (json) => { const node = json.nodes.find(({ mesh }) => mesh === undefined); return node !== undefined && Object.assign(node, { mesh: shown(json)[0].mesh }); },
  'the first node is moved': (json) => { json.nodes[0].translation = [5, 0, 0]; },
  'a clip moves another node': (json) => json.animations !== undefined && json.animations[0].channels.forEach(({ target }) => { target.node = target.node === 0 ? 1 : 0; }),
  'a clip lasts another time': (json) => json.animations !== undefined && json.animations[0].samplers.forEach((sampler) => { sampler.input = sampler.output; }),
  'a channel is gone': (json) => json.animations !== undefined && json.animations[0].channels.pop(),
  'a clip is gone': (json) => json.animations !== undefined && json.animations.pop(),
  'a chain of new vertices between all of the source': (json) => chain(json, 20000)
};

const counts = { documents: {}, mutants: 0, refused: 0, unreadable: 0, rounding: 0, recordOnly: 0, harmful: [] };
const pairs = [];
for (let i = 0; i + 1 < files.length; i += 2) {
  const source = openGltf(files[i]), bytes = new Uint8Array(readFileSync(files[i + 1])), torn = new Gltf(bytes);
  if (checkTorn(source, torn).faults.length > 0) throw new Error(`${files[i + 1]} is refused as it is`);
  pairs.push({ file: files[i + 1], source, bytes, torn, targets: targetsOf(torn) });
  for (const [name, apply] of Object.entries(DOCUMENTS)) {
    const mutant = new Gltf(bytes);
    if (apply(mutant.json) === false) continue;
    const isRefused = checkTorn(source, mutant).faults.length > 0;
    counts.documents[name] = (counts.documents[name] ?? 0) + isRefused;
    if (!isRefused) counts.harmful.push({ file: files[i + 1], name });
  }
}
for (let i = 0; i < Number(count); ++i) {
  const { file, source, bytes, torn, targets } = pairs[i % pairs.length], target = targets[random(targets.length)];
  const [begin, length] = target.spans[random(target.spans.length)], at = begin + random(length), flip = 1 + random(255);
  bytes[at] ^= flip;
  counts.mutants += 1;
  try {
    const mutant = new Gltf(bytes);
    if (checkTorn(source, mutant).faults.length > 0) counts.refused += 1;
    else if (target.isRecord) counts.recordOnly += 1;
    else if (change(torn.accessor(target.index).values, mutant.accessor(target.index).values) <= HARMLESS) counts.rounding += 1;
    else counts.harmful.push({ file, accessor: target.index, at, flip });
  } catch (error) {
    if (!(error instanceof Unchecked)) throw error;
    counts.unreadable += 1;
  }
  bytes[at] ^= flip;
}
console.log(JSON.stringify(counts));
process.exitCode = counts.harmful.length > 0 ? 1 : 0;
