// Splits closed bodies by a plane each, with Manifold, and writes both surfaces, below the plane and above it:
//   <number of positions> <number of triangles>
//   <x y z …>
//   <a b c …>
// Usage: node sides.mjs <file.json> <output>: [{"positions": [x, y, z, …], "triangles": [a, b, c, …], "plane": [x, y, z, offset]}, …]
import { readFileSync, writeFileSync } from 'node:fs';
import Module from 'manifold-3d';

const module = await Module();
module.setup();
const { Manifold, Mesh } = module;
const lines = [];
for (const { positions, triangles, plane } of JSON.parse(readFileSync(process.argv[2], 'utf8'))) {
  const mesh = new Mesh({ numProp: 3, vertProperties: new Float32Array(positions), triVerts: new Uint32Array(triangles) });
  const solid = new Manifold(mesh);
  const [above, below] = solid.splitByPlane(plane.slice(0, 3), plane[3]);
  for (const side of [below, above]) {
    const { vertProperties, triVerts } = side.getMesh();
    lines.push(`${vertProperties.length / 3} ${triVerts.length / 3}`, Array.from(vertProperties).join(' '), Array.from(triVerts).join(' '));
    side.delete();
  }
  solid.delete();
}
writeFileSync(process.argv[3], lines.join('\n') + '\n');
