// The meshes that all cut, as { name, positions, triangles }: made here, and those of developers where they are.
import { existsSync, readFileSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';

const shared = join(dirname(fileURLToPath(import.meta.url)), '..', '..', '..', 'shared', 'models');

/** A closed body with dents: an octahedron's faces divided n times, 4 n^2 + 2 vertices. */
function blob(n) {
  const index = new Map(), positions = [], triangles = [];
  const vertex = (direction) => {
    const key = direction.join();
    if (!index.has(key)) {
      const length = Math.hypot(...direction), [x, y, z] = direction.map((value) => value / length);
      const radius = 0.5 + 0.06 * Math.sin(5 * x + 1) * Math.cos(4 * y) + 0.04 * Math.sin(6 * z);
      index.set(key, positions.length / 3);
      positions.push(radius * x, radius * y, radius * z);
    }
    return index.get(key);
  };
  for (const [sx, sy, sz] of [[1, 1, 1], [-1, 1, -1], [-1, -1, 1], [1, -1, -1], [-1, 1, 1], [1, -1, 1], [1, 1, -1], [-1, -1, -1]]) {
    const flip = sx * sy * sz < 0;
    const at = (i, j) => vertex([sx * i || 0, sy * j || 0, sz * (n - i - j) || 0]);
    const add = (a, b, c) => triangles.push(a, flip ? c : b, flip ? b : c);
    for (let i = 0; i < n; ++i) {
      for (let j = 0; j < n - i; ++j) {
        add(at(i, j), at(i + 1, j), at(i, j + 1));
        if (i + j < n - 1) add(at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
      }
    }
  }
  return { positions, triangles };
}

/** A sheet of n x n squares in which every eighth block of 3 x 3 is missing. */
function sheet(n) {
  const positions = [], triangles = [];
  for (let y = 0; y <= n; ++y) for (let x = 0; x <= n; ++x) positions.push(x / n - 0.5, y / n - 0.5, 0);
  for (let y = 0; y < n; ++y) {
    for (let x = 0; x < n; ++x) {
      if (x % 8 > 1 && x % 8 < 5 && y % 8 > 1 && y % 8 < 5) continue;
      const a = y * (n + 1) + x;
      triangles.push(a, a + 1, a + n + 2, a, a + n + 2, a + n + 1);
    }
  }
  return { positions, triangles };
}

function off(file) {
  const [vertices, faces, , ...numbers] = readFileSync(file, 'utf8').replace(/^OFF/, '').trim().split(/\s+/).map(Number);
  const triangles = [];
  for (let i = 0; i < faces; ++i) triangles.push(...numbers.slice(3 * vertices + 4 * i + 1, 3 * vertices + 4 * i + 4));
  return { positions: numbers.slice(0, 3 * vertices), triangles };
}
function ply(file) {
  const text = readFileSync(file, 'utf8'), end = text.indexOf('end_header');
  const count = (what) => Number(new RegExp(`element ${what} (\\d+)`).exec(text)[1]);
  const lines = text.slice(text.indexOf('\n', end) + 1).split('\n'), vertices = count('vertex');
  return {
    positions: lines.slice(0, vertices).flatMap((line) => line.trim().split(/\s+/).slice(0, 3).map(Number)),
    triangles: lines.slice(vertices, vertices + count('face')).flatMap((line) => line.trim().split(/\s+/).slice(1, 4).map(Number)),
  };
}

/** One mesh of a GLB without compression: its first, in its own space, its vertices merged by place. */
function glb(file, all) {
  const bytes = readFileSync(file), json = JSON.parse(bytes.subarray(20, 20 + bytes.readUInt32LE(12)).toString());
  const data = bytes.subarray(28 + bytes.readUInt32LE(12));
  const read = (index) => {
    const accessor = json.accessors[index], view = json.bufferViews[accessor.bufferView];
    const width = { SCALAR: 1, VEC3: 3 }[accessor.type], size = { 5121: 1, 5123: 2, 5125: 4, 5126: 4 }[accessor.componentType];
    const from = (view.byteOffset ?? 0) + (accessor.byteOffset ?? 0), stride = view.byteStride ?? width * size;
    const get = { 5121: 'readUInt8', 5123: 'readUInt16LE', 5125: 'readUInt32LE', 5126: 'readFloatLE' }[accessor.componentType];
    return Array.from({ length: accessor.count * width }, (_, i) => data[get](from + Math.floor(i / width) * stride + (i % width) * size));
  };
  const positions = [], triangles = [], index = new Map();
  for (const primitive of (all ? json.meshes : json.meshes.slice(0, 1)).flatMap((mesh) => mesh.primitives)) {
    const places = read(primitive.attributes.POSITION), corners = primitive.indices === undefined ? places.map((_, i) => i).slice(0, places.length / 3) : read(primitive.indices);
    const of = Array.from({ length: places.length / 3 }, (_, v) => {
      const key = places.slice(3 * v, 3 * v + 3).join();
      if (!index.has(key)) {
        index.set(key, positions.length / 3);
        positions.push(...places.slice(3 * v, 3 * v + 3));
      }
      return index.get(key);
    });
    for (let i = 0; i < corners.length; i += 3) {
      const [a, b, c] = corners.slice(i, i + 3).map((corner) => of[corner]);
      if (a !== b && b !== c && c !== a) triangles.push(a, b, c);
    }
  }
  return { positions, triangles };
}

/** Only vertices that triangles use, in a box whose diagonal is 1. */
function prepared(name, { positions, triangles }) {
  const used = new Map(), kept = [];
  const renamed = triangles.map((v) => {
    if (!used.has(v)) {
      used.set(v, kept.length / 3);
      kept.push(...positions.slice(3 * v, 3 * v + 3));
    }
    return used.get(v);
  });
  const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
  kept.forEach((value, i) => {
    low[i % 3] = Math.min(low[i % 3], value);
    high[i % 3] = Math.max(high[i % 3], value);
  });
  const diagonal = Math.hypot(...low.map((value, k) => high[k] - value));
  return { name, positions: Float32Array.from(kept, (value, i) => (value - (low[i % 3] + high[i % 3]) / 2) / diagonal), triangles: Uint32Array.from(renamed) };
}

export function meshes() {
  const list = [['blob', () => blob(29)], ['large blob', () => blob(95)], ['sheet with holes', () => sheet(80)]];
  const add = (name, file, read) => { if (existsSync(join(shared, file))) list.push([name, () => read(join(shared, file))]); };
  add('bunny', 'static/bunny_3485.off', off);
  add('large bunny', 'static/bunny_35947.ply', ply);
  add('liver', 'static/liver_female.glb', (file) => glb(file, true));
  add('body', 'rigged/mannequiny.glb', (file) => glb(file, true));
  return list.map(([name, make]) => prepared(name, make()));
}
