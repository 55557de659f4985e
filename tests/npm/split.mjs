// Splits closed bodies by planes, with Manifold, and prints what lies between the planes:
//   <body> <sides> <volume> <number of parts>
// a line for each combination of sides that has any volume; "+" where the plane's normal points.
// Usage: node split.mjs <file.json>: [{"positions": [x, y, z, …], "triangles": [a, b, c, …], "planes": [[x, y, z, offset], …]}, …]
import { readFileSync } from 'node:fs';
import Module from 'manifold-3d';

const module = await Module();
module.setup();
const { Manifold, Mesh } = module;
const bodies = JSON.parse(readFileSync(process.argv[2], 'utf8'));
bodies.forEach(({ positions, triangles, planes }, number) => {
  const mesh = new Mesh({ numProp: 3, vertProperties: new Float32Array(positions), triVerts: new Uint32Array(triangles) });
  let cells = [['', new Manifold(mesh)]];
  for (const [x, y, z, offset] of planes)
    cells = cells.flatMap(([sides, solid]) => {
      if (solid.isEmpty()) return [];
      const [above, below] = solid.splitByPlane([x, y, z], offset);
      solid.delete();
      return [[`${sides}+`, above], [`${sides}-`, below]];
    });
  for (const [sides, solid] of cells) {
    if (solid.status() !== 'NoError') throw new Error(`body ${number}: ${solid.status()}`);
    if (!solid.isEmpty()) {
      const parts = solid.decompose();
      console.log(number, sides || '=', solid.volume(), parts.length);
      for (const part of parts) part.delete();
    }
    solid.delete();
  }
});
