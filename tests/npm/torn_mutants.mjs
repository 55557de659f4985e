// Changes single bytes of a torn file's accessors and looks whether tools/check_torn.mjs refuses it. What it accepts must be harmless:
// the model's numbers differ by less than rounding, or only the record does, which then tells less.
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

const counts = { mutants: 0, refused: 0, unreadable: 0, rounding: 0, recordOnly: 0, harmful: [] };
const pairs = [];
for (let i = 0; i + 1 < files.length; i += 2) {
  const source = openGltf(files[i]), bytes = new Uint8Array(readFileSync(files[i + 1])), torn = new Gltf(bytes);
  if (checkTorn(source, torn).faults.length > 0) throw new Error(`${files[i + 1]} is refused as it is`);
  pairs.push({ file: files[i + 1], source, bytes, torn, targets: targetsOf(torn) });
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
