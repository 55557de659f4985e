// What several tests need: models of the repository, a tear across the tube, and where the models of developers are.
import { existsSync, readFileSync, readdirSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';

const root = join(dirname(fileURLToPath(import.meta.url)), '..', '..', '..');
export const packageFolder = join(root, 'bindings', 'js');
export const rigFile = (name) => join(root, 'tests', 'data', 'rigged', `${name}.glb`);
export const rig = (name) => new Uint8Array(readFileSync(rigFile(name)));
export const rigNames = readdirSync(join(root, 'tests', 'data', 'rigged')).filter((name) => name.endsWith('.glb')).map((name) => name.slice(0, -4));

/** The command, which may not be built. */
export const commandFile = process.env.SUNDER_COMMAND ?? join(root, 'build', 'release', 'tools', 'sunder');

/** Models that are not in the repository: an empty list where they are absent. */
const shared = join(root, '..', 'shared', 'models', 'rigged');
export const sharedRigs = existsSync(shared) ? readdirSync(shared).filter((name) => name.endsWith('.glb')).map((name) => join(shared, name)) : [];

/** A blade that goes down the front of the tube, and reaches a little below its surface. */
export const FRONT_STROKE = [[[0, 1.6, 1], [0, 1.6, 0.3]], [[0.05, 1, 1], [0.05, 1, 0.3]], [[0, 0.5, 1], [0, 0.5, 0.3]]];

/** Buffers that are kept as a renderer keeps them, and the area of what it draws. */
export class Buffers {
  triangles = new Uint32Array(0);
  seen = 0n;
  update(instance, mesh = 0) {
    const posed = instance.mesh(mesh, this.seen);
    if (posed.initialTriangles.length) this.triangles = posed.initialTriangles.slice();
    const grown = new Uint32Array(3 * posed.triangleCapacity);
    grown.set(this.triangles);
    this.triangles = grown;
    const writes = posed.triangleWrites;
    for (let i = 0; i < writes.length; i += 4) this.triangles.set(writes.subarray(i + 1, i + 4), 3 * writes[i]);
    this.seen = posed.epoch;
    this.positions = posed.positions.slice();
    this.ranges = posed.drawRanges;
    return this;
  }
  get area() {
    let area = 0;
    const p = (v, k) => this.positions[3 * v + k];
    const drawn = this.ranges.flatMap(({ firstTriangle, triangleCount }) => Array.from({ length: triangleCount }, (_, i) => firstTriangle + i));
    for (const triangle of drawn) {
      const [a, b, c] = this.triangles.subarray(3 * triangle, 3 * triangle + 3);
      const u = [0, 1, 2].map((k) => p(b, k) - p(a, k)), v = [0, 1, 2].map((k) => p(c, k) - p(a, k));
      area += Math.hypot(u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]) / 2;
    }
    return area;
  }
}
