// Reads a GLB and writes it without Draco and meshopt compression, by the decoders that three.js ships.
// Usage: node decompress.mjs <in.glb> <out.glb>
import { readFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { NodeIO } from '@gltf-transform/core';
import { ALL_EXTENSIONS } from '@gltf-transform/extensions';
import { MeshoptDecoder } from 'three/addons/libs/meshopt_decoder.module.js';

// Draco's decoder is a script for CommonJS that defines a variable.
async function dracoDecoder() {
  const source = readFileSync(new URL(import.meta.resolve('three/addons/libs/draco/gltf/draco_decoder.js')), 'utf8');
  return new Function('require', '__dirname', `${source}; return DracoDecoderModule;`)(createRequire(import.meta.url), '.')();
}

const [input, output] = process.argv.slice(2);
await MeshoptDecoder.ready;
const io = new NodeIO()
  .registerExtensions(ALL_EXTENSIONS)
  .registerDependencies({ 'meshopt.decoder': MeshoptDecoder, 'draco3d.decoder': await dracoDecoder() });
const document = await io.read(input);
for (const extension of document.getRoot().listExtensionsUsed())
  if (/meshopt|draco/.test(extension.extensionName)) extension.dispose();
const buffer = document.getRoot().listBuffers()[0];
for (const accessor of document.getRoot().listAccessors()) accessor.setBuffer(buffer);
for (const other of document.getRoot().listBuffers().slice(1)) other.dispose();
await io.write(output, document);
