// Merges equal vertices of a GLB the way a user's tool does.
// Usage: node weld.mjs gltf-transform|gltfpack|gltfpack-coarse|three|three-coarse <in.glb> <out.glb>
import { readFileSync, writeFileSync } from 'node:fs';

// Each tool is loaded alone: none is to fail by another's absence.
const tools = {
  async 'gltf-transform'(input, output) {
    const { NodeIO } = await import('@gltf-transform/core');
    const { weld } = await import('@gltf-transform/functions');
    const io = new NodeIO();
    const document = await io.read(input);
    await document.transform(weld());
    await io.write(output, document);
  },

  // -noq: positions as they are. -k*: nodes, materials, extras and vertex attributes that nothing uses stay.
  gltfpack: (input, output) => pack(input, output, ['-noq', '-kn', '-km', '-ke', '-kv']),

  // As it is run by default: positions in 14 bits.
  'gltfpack-coarse': (input, output) => pack(input, output, []),

  // Merges what is equal, but for rounding.
  three: (input, output) => mergeByThree(input, output, 1e-7),

  // As three.js does where it is not told how near is equal: within 0.0001, whatever the size of the model.
  'three-coarse': (input, output) => mergeByThree(input, output),
};

async function pack(input, output, options) {
  const gltfpack = await import('gltfpack');
  await gltfpack.pack(['-i', input, '-o', output, ...options], { read: readFileSync, write: writeFileSync });
}

// three.js' loader needs a browser; its mergeVertices() does not.
async function mergeByThree(input, output, tolerance) {
  const { NodeIO } = await import('@gltf-transform/core');
  const { BufferAttribute, BufferGeometry } = await import('three');
  const { mergeVertices } = await import('three/addons/utils/BufferGeometryUtils.js');
  const io = new NodeIO();
  const document = await io.read(input);
  const threeName = (name) => (name === 'POSITION' ? 'position' : name);
  const toThree = (accessor) => {
    const size = accessor.getElementSize();
    const values = new Float32Array(accessor.getCount() * size);
    const element = [];
    for (let i = 0; i < accessor.getCount(); ++i) values.set(accessor.getElement(i, element), i * size);
    return new BufferAttribute(values, size);
  };
  const toGltf = (attribute, name, accessor) => {
    const ArrayType = name.startsWith('JOINTS_') ? Uint16Array : Float32Array;
    return document.createAccessor().setType(accessor.getType()).setBuffer(accessor.getBuffer()).setArray(new ArrayType(attribute.array));
  };
  for (const mesh of document.getRoot().listMeshes())
    for (const primitive of mesh.listPrimitives()) {
      if (primitive.getMode() !== 4) continue;
      const geometry = new BufferGeometry();
      for (const name of primitive.listSemantics()) geometry.setAttribute(threeName(name), toThree(primitive.getAttribute(name)));
      if (primitive.getIndices()) geometry.setIndex([...primitive.getIndices().getArray()]);
      const targets = primitive.listTargets();
      targets.forEach((target) => {
        for (const name of target.listSemantics()) (geometry.morphAttributes[threeName(name)] ??= []).push(toThree(target.getAttribute(name)));
      });
      const merged = mergeVertices(geometry, tolerance);
      for (const name of primitive.listSemantics())
        primitive.setAttribute(name, toGltf(merged.getAttribute(threeName(name)), name, primitive.getAttribute(name)));
      const taken = {};
      targets.forEach((target) => {
        for (const name of target.listSemantics()) {
          const morph = merged.morphAttributes[threeName(name)][(taken[name] = (taken[name] ?? -1) + 1)];
          target.setAttribute(name, toGltf(morph, name, target.getAttribute(name)));
        }
      });
      const indices = document.createAccessor().setType('SCALAR').setBuffer(document.getRoot().listBuffers()[0]);
      primitive.setIndices(indices.setArray(new Uint32Array(merged.getIndex().array)));
    }
  await io.write(output, document);
}

const [tool, input, output] = process.argv.slice(2);
await tools[tool](input, output);
