// A part that came off: a character of its own, with mass and inertia.
import { sunder_hull } from '../generated/calls.js';
import { Model } from './model.js';
import { namesOf } from './options.js';
import { Owned } from './owned.js';

const SOLIDS = ['closed', 'fans', 'shell'];

export class Piece extends Owned {
  #calls;
  constructor(calls, handle) {
    super(handle, () => {
      calls.sunder_destroy_piece(handle);
      calls.memory.detachViews();
    });
    this.#calls = calls;
  }

  /** { mass, volume, area, centre, inertia, inertiaPiece, modelFromPiece, solid, holes, meshCount }. */
  get info() {
    const info = this.#calls.sunder_get_piece(this.handle);
    return { ...namesOf(info), solid: SOLIDS[info.solid] };
  }
  /** A model of the piece, to be spawned. */
  toModel(options = {}) { return new Model(this.#calls, this.#calls.sunder_get_piece_character(this.handle), options); }
  /** Which vertices of the torn model those of a mesh were: { mesh, vertices }, a copy. */
  source(mesh = 0) {
    const { torn_mesh, torn_vertices, count } = this.#calls.sunder_get_piece_vertices(this.handle, mesh);
    return { mesh: torn_mesh, vertices: this.#calls.memory.viewOf(Uint32Array, torn_vertices, count).slice() };
  }
  /** Convex hulls for a physics engine, as copies. Fails where the library was built without Qhull, as the one in this package. */
  hulls({ most = 8, points = 64 } = {}) {
    const { memory } = this.#calls;
    const { hulls, count } = this.#calls.sunder_get_piece_hulls(this.handle, most, points);
    return memory.readStructs(sunder_hull, hulls, count).map((hull) => ({
      points: memory.viewOf(Float64Array, hull.points, 3 * hull.point_count).slice(),
      triangles: memory.viewOf(Uint32Array, hull.triangles, 3 * hull.triangle_count).slice(),
      bone: hull.bone === 0xFFFFFFFF ? null : hull.bone, volume: hull.volume }));
  }
}
