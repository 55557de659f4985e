// Each peer cuts one mesh: { tear } along a stroke, { halve } by a plane. Only the call that cuts is timed. Results are
// { milliseconds, mesh, fresh } with the vertices that the cut made, or an error's text.
import RAPIER from '@dimforge/rapier3d-compat';
import ManifoldModule from 'manifold-3d';
import { BoxGeometry, BufferAttribute, BufferGeometry, MeshBasicMaterial, Vector3 } from 'three';
import { Brush, Evaluator, INTERSECTION, SUBTRACTION } from 'three-bvh-csg';
import { halfSpace, newVertices } from './geometry.mjs';

/** Milliseconds of processor time: other programs on the machine would stretch long calls more than short ones. */
const now = () => {
  const { user, system } = process.cpuUsage();
  return (user + system) / 1000;
};
const joined = (parts) => {
  const positions = [], triangles = [];
  for (const part of parts) {
    const first = positions.length / 3;
    for (const value of part.positions) positions.push(value);
    for (const v of part.triangles) triangles.push(first + v);
  }
  return { positions, triangles };
};

export async function rapier() {
  await RAPIER.init();
  return {
    name: 'Rapier',
    tear(mesh, { triangle }) {
      const world = new RAPIER.World({ x: 0, y: 0, z: 0 });
      try {
        const desc = RAPIER.SoftBodyDesc.trimesh(mesh.positions, mesh.triangles);
        if (!desc) return { refused: 'no body' };
        const body = world.createSoftBody(desc);
        world.step();
        const blade = triangle.map(([x, y, z]) => ({ x, y, z })), before = now();
        const event = world.cutSoftBody(body, blade);
        const milliseconds = now() - before;
        if (!event) return { milliseconds, refused: 'nothing cut' };
        const fresh = [...new Set([...event.splitParticles(), ...event.insertedParticles()])], pieces = event.numPieces();
        const positions = body.particlePositions(), result = { positions, triangles: body.boundary() };
        event.free();
        return { milliseconds, mesh: result, fresh, pieces };
      } finally {
        world.free();
      }
    },
  };
}

export async function manifold() {
  const wasm = await ManifoldModule();
  wasm.setup();
  return {
    name: 'Manifold',
    halve(mesh) {
      let body;
      try {
        body = new wasm.Manifold(new wasm.Mesh({ numProp: 3, vertProperties: mesh.positions, triVerts: mesh.triangles }));
      } catch (error) {
        return { refused: String(error.message ?? error).split('\n')[0] };
      }
      if (body.status() !== 'NoError') return { refused: body.status() };
      const { normal, point } = halfSpace, offset = normal.reduce((sum, value, k) => sum + value * point[k], 0);
      const before = now();
      const halves = body.splitByPlane(normal, offset);
      const parts = halves.map((half) => half.getMesh());  // it is lazy: this computes
      const milliseconds = now() - before;
      const result = joined(parts.map(({ vertProperties, triVerts, numProp }) => ({
        positions: Float32Array.from({ length: vertProperties.length / numProp * 3 }, (_, i) => vertProperties[Math.floor(i / 3) * numProp + (i % 3)]), triangles: triVerts })));
      for (const one of [body, ...halves]) one.delete();
      return { milliseconds, mesh: result, fresh: newVertices(mesh, result) };
    },
  };
}

export async function csg() {
  const material = new MeshBasicMaterial(), evaluator = new Evaluator();
  evaluator.attributes = ['position'];
  evaluator.useGroups = false;
  return {
    name: 'three-bvh-csg',
    halve(mesh) {
      const geometry = new BufferGeometry();
      geometry.setAttribute('position', new BufferAttribute(mesh.positions.slice(), 3));
      geometry.setIndex(new BufferAttribute(mesh.triangles.slice(), 1));
      const body = new Brush(geometry, material), box = new Brush(new BoxGeometry(4, 4, 4), material);
      box.geometry.deleteAttribute('normal');
      box.geometry.deleteAttribute('uv');
      const normal = new Vector3(...halfSpace.normal);
      box.quaternion.setFromUnitVectors(new Vector3(0, 1, 0), normal);
      box.position.set(...halfSpace.point).addScaledVector(normal, 2);
      for (const brush of [body, box]) {
        brush.updateMatrixWorld(true);
        brush.prepareGeometry();
      }
      const before = now();
      const halves = [INTERSECTION, SUBTRACTION].map((operation) => evaluator.evaluate(body, box, operation, new Brush(new BufferGeometry(), material)));
      const milliseconds = now() - before;
      const result = joined(halves.map((half) => {
        const { position } = half.geometry.attributes, index = half.geometry.index, { start, count } = half.geometry.drawRange;
        const all = index ? Array.from(index.array) : Array.from({ length: position.count }, (_, i) => i);
        return { positions: position.array.subarray(0, 3 * position.count), triangles: all.slice(start, start + Math.min(count, all.length)) };
      }));
      const used = new Set(result.triangles);
      return { milliseconds, mesh: result, fresh: newVertices(mesh, result).filter((v) => used.has(v)) };
    },
  };
}

export async function sunder(entry) {
  const { Sunder } = await import(entry);
  const models = new Map();
  async function prepared(mesh, soft) {
    const key = `${mesh.name} ${soft}`;
    if (!models.has(key)) models.set(key, await Sunder.fromArrays({ meshes: [mesh] }, { soft }));
    const scene = await Sunder.createScene(), instance = scene.spawn(models.get(key));
    instance.prepareToTear();
    scene.update(1 / 60);
    return { scene, instance };
  }
  /** An update that applies a command: the tear, particles that follow and come to rest, and posing. */
  function timed({ scene, instance }, mesh, submit) {
    submit(instance);
    const before = now();
    const [result] = scene.update(1 / 60);
    const milliseconds = now() - before;
    if (result.error) return { milliseconds, refused: result.error.message };
    const { positions, triangles, vertexCount } = instance.source(0), first = mesh.positions.length / 3;
    const kept = triangles.slice();
    const used = new Set(kept);
    const answer = { milliseconds, mesh: { positions: positions.slice(), triangles: kept.filter((_, i) => kept[i - (i % 3)] !== kept[i - (i % 3) + 1]) },
      fresh: Array.from({ length: vertexCount - first }, (_, i) => first + i).filter((v) => used.has(v)) };
    answer.changed = mesh.positions.reduce((count, value, i) => count + (value !== answer.mesh.positions[i] ? 1 : 0), 0);
    scene.dispose();
    return answer;
  }
  return {
    name: 'Sunder',
    tear: async (mesh, { stroke }) => timed(await prepared(mesh, true), mesh, (instance) => instance.tear(stroke)),
    halve: async (mesh) => timed(await prepared(mesh, false), mesh, (instance) => instance.cut({ ...halfSpace, caps: true })),
  };
}
