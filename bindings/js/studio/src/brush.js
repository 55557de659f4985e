// Which vertices are under a brush: those of the surface around it that hang together there, so that it does not paint the back of an arm.

/** Points of a mesh, which vertices at one place in bind space share, and their neighbours. Lips of a tear are one. */
class Points {
  constructor({ positions, triangles, vertexCount }) {
    const numbers = new Map();
    this.of = new Uint32Array(vertexCount);
    this.vertices = [];
    for (let v = 0; v < vertexCount; ++v) {
      const key = positions.subarray(3 * v, 3 * v + 3).join();
      let point = numbers.get(key);
      if (point === undefined) {
        numbers.set(key, point = this.vertices.length);
        this.vertices.push([]);
      }
      this.of[v] = point;
      this.vertices[point].push(v);
    }
    this.triangles = triangles.slice();
    this.neighbours = this.vertices.map(() => new Set());
    for (let t = 0; t < triangles.length; t += 3) {
      const corners = [0, 1, 2].map((k) => this.of[triangles[t + k]]);
      for (const a of corners) for (const b of corners) if (a !== b) this.neighbours[a].add(b);
    }
  }
}

/** How much of its edge is soft: from half of the radius on. */
const shareAt = (distance) => {
  const left = Math.min(1, Math.max(0, 2 * (1 - distance)));
  return left * left * (3 - 2 * left);
};

export class Brush {
  #points = new Map();
  #known = '';

  /**
   * @param path  two hits on the mesh, { at, triangle, barycentric }, between which it was drawn
   * @returns pairs of a vertex of the torn mesh and how much of the paint it gets, above 0 up to 1
   */
  under(instance, mesh, path, radius) {
    const points = this.#pointsOf(instance, mesh), { positions } = instance.mesh(mesh), [{ at: from }, { at: to }] = path;
    const along = to.clone().sub(from), length = along.lengthSq(), offset = along.clone();
    const distance = (point) => {
      offset.fromArray(positions, 3 * points.vertices[point][0]).sub(from);
      const share = length > 0 ? Math.min(1, Math.max(0, offset.dot(along) / length)) : 0;
      return offset.addScaledVector(along, -share).length() / radius;
    };
    const reached = new Set(path.flatMap(({ triangle }) => [0, 1, 2].map((k) => points.of[points.triangles[3 * triangle + k]]))), found = [];
    for (const point of reached) {  // also those that are added meanwhile
      const share = shareAt(distance(point));
      if (share > 0) for (const vertex of points.vertices[point]) found.push([vertex, share]);
      for (const other of points.neighbours[point]) if (distance(other) < 1) reached.add(other);
    }
    return found.length ? found : this.#nearest(points, path[1]);
  }

  /** Where the faces are larger than the brush. */
  #nearest({ of, triangles, vertices }, { triangle, barycentric }) {
    const corner = barycentric ? barycentric.indexOf(Math.max(...barycentric)) : 0;
    return vertices[of[triangles[3 * triangle + corner]]].map((vertex) => [vertex, 1]);
  }

  #pointsOf(instance, mesh) {
    const known = `${instance.id} ${instance.digest}`;
    if (known !== this.#known) this.#points.clear();
    this.#known = known;
    if (!this.#points.has(mesh)) this.#points.set(mesh, new Points(instance.source(mesh)));
    return this.#points.get(mesh);
  }
}
