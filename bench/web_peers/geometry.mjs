// What the results of all peers are measured by.

const corner = (positions, v) => [positions[3 * v], positions[3 * v + 1], positions[3 * v + 2]];
const minus = (a, b) => a.map((value, k) => value - b[k]);
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const areaOf = (a, b, c) => Math.hypot(...cross(minus(b, a), minus(c, a))) / 2;
export const unit = (a) => a.map((value) => value / Math.hypot(...a));
export const signed = (plane, place) => dot(plane.normal, minus(place, plane.point));

export function meanEdge({ positions, triangles }) {
  let sum = 0;
  for (let i = 0; i < triangles.length; ++i) {
    const next = i % 3 === 2 ? i - 2 : i + 1;
    sum += Math.hypot(...minus(corner(positions, triangles[i]), corner(positions, triangles[next])));
  }
  return sum / triangles.length;
}

/** Where a ray meets a mesh first; or null. */
export function firstHit({ positions, triangles }, origin, direction) {
  let best = null;
  for (let i = 0; i < triangles.length; i += 3) {
    const [a, b, c] = [0, 1, 2].map((k) => corner(positions, triangles[i + k]));
    const u = minus(b, a), v = minus(c, a), h = cross(direction, v), det = dot(u, h);
    if (Math.abs(det) < 1e-14) continue;
    const s = minus(origin, a), x = dot(s, h) / det, q = cross(s, u), y = dot(direction, q) / det, t = dot(v, q) / det;
    if (x >= 0 && y >= 0 && x + y <= 1 && t > 0 && (best === null || t < best)) best = t;
  }
  return best === null ? null : origin.map((value, k) => value + best * direction[k]);
}

/** The areas of a surface before and behind a plane: each triangle is clipped. */
export function clippedAreas({ positions, triangles }, plane) {
  const areas = [0, 0];
  for (let i = 0; i < triangles.length; i += 3) {
    const corners = [0, 1, 2].map((k) => corner(positions, triangles[i + k])), heights = corners.map((place) => signed(plane, place));
    for (const side of [0, 1]) {
      const kept = [];
      corners.forEach((place, k) => {
        const other = (k + 1) % 3, h = side ? -heights[k] : heights[k], g = side ? -heights[other] : heights[other];
        if (h >= 0) kept.push(place);
        if (h * g < 0) kept.push(place.map((value, m) => value + (h / (h - g)) * (corners[other][m] - value)));
      });
      for (let k = 2; k < kept.length; ++k) areas[side] += areaOf(kept[0], kept[k - 1], kept[k]);
    }
  }
  return areas;
}

/** The same of a mesh that was cut: by the middles of its triangles, without caps. */
export function cutAreas({ positions, triangles }, plane) {
  const areas = [0, 0];
  for (let i = 0; i < triangles.length; i += 3) {
    const corners = [0, 1, 2].map((k) => corner(positions, triangles[i + k]));
    const heights = corners.map((place) => signed(plane, place));
    if (heights.every((height) => Math.abs(height) < 1e-6)) continue;
    areas[heights[0] + heights[1] + heights[2] > 0 ? 0 : 1] += areaOf(...corners);
  }
  return areas;
}

/** Mean and largest distance of vertices to a plane. */
export function distances(positions, vertices, plane) {
  let sum = 0, most = 0;
  for (const v of vertices) {
    const distance = Math.abs(signed(plane, corner(positions, v)));
    sum += distance;
    most = Math.max(most, distance);
  }
  return vertices.length ? { mean: sum / vertices.length, most } : null;
}

/** Vertices at places where the source had none. */
export function newVertices(source, { positions }) {
  const key = (array, v) => [0, 1, 2].map((k) => Math.round(array[3 * v + k] * 1e6)).join();
  const old = new Set(Array.from({ length: source.positions.length / 3 }, (_, v) => key(source.positions, v)));
  return Array.from({ length: positions.length / 3 }, (_, v) => v).filter((v) => !old.has(key(positions, v)));
}

/** A vertical cut of a fifth of the diagonal in the front, slightly turned so that it follows no edges. */
export function localCut(mesh) {
  const turned = unit([0.31, 1, 0]), inward = [0, 0, -1], half = 0.1, depth = 0.03;
  for (const [x, y] of [[0.013, 0.017], [0.1, 0.05], [-0.1, 0.05], [0.05, -0.1], [-0.05, -0.12], [0.2, 0.1]]) {
    const place = firstHit(mesh, [x, y, 2], inward);
    if (!place) continue;
    const at = (along, out) => place.map((value, k) => value + along * turned[k] - out * inward[k]);
    return {
      plane: { point: place, normal: unit(cross(turned, inward)) },
      // Both are `2 half` wide at the height of the surface.
      triangle: [at(-2 * half, 2 * depth), at(2 * half, 2 * depth), at(0, -2 * depth)],
      stroke: Array.from({ length: 9 }, (_, i) => [at((i / 4 - 1) * half, 2 * depth), at((i / 4 - 1) * half, -depth)]),
    };
  }
  return null;
}

export const halfSpace = { point: [0.011, 0.007, -0.013], normal: unit([0.9, 0.31, 0.17]) };
