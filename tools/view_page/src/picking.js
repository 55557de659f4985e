// Where a ray meets a posed surface, in double precision. No DOM.
import { raycast } from '../../page_parts/src/raycast.js';
import { poseNormal } from '../../page_parts/src/skin.js';
import { add, cross, dot, scaled, unit } from './vectors.js';

/** Cosine below which an interpolated normal does not speak for its triangle. */
const LEAST_AGREEMENT = 0.2;

/** A model in the pose that is shown. */
export class PosedSurface {
  /** @param positions  posed, three per vertex; @param pose  of skin.js: poseOf() */
  constructor(model, pose, positions) {
    Object.assign(this, { model, pose, positions });
  }

  /**
   * The first place on a ray, or null: {position, normal, distance}, and its triangle with the
   * corners and their shares. The normal points against the ray.
   */
  hit(origin, direction) {
    const found = raycast(this.positions, this.model.indices, origin, direction);
    if (!found) return null;
    const corners = found.corners.map((vertex) => this.corner(vertex));
    const position = [0, 1, 2].map((k) =>
      corners.reduce((sum, corner, i) => sum + found.shares[i] * corner[k], 0));
    return { ...found, position, normal: this.normalAt(found, corners, direction) };
  }

  corner(vertex) {
    return Array.from(this.positions.subarray(vertex * 3, vertex * 3 + 3));
  }

  normalAt({ corners: vertices, shares }, [a, b, c], direction) {
    let flat = unit(cross(add(b, a, -1), add(c, a, -1)));
    if (dot(flat, direction) > 0) flat = scaled(flat, -1);
    let smooth = vertices.reduce((sum, vertex, i) =>
      add(sum, poseNormal(this.model, this.pose, vertex), shares[i]), [0, 0, 0]);
    if (dot(smooth, flat) < 0) smooth = scaled(smooth, -1);
    smooth = unit(smooth);
    return dot(smooth, flat) < LEAST_AGREEMENT ? flat : smooth;
  }

  /** How far it is from a place to the next surface in a direction; at most `limit`. */
  freeDistance(position, direction, limit) {
    const start = add(position, direction, 1e-4 * limit);
    return Math.min(limit,
      raycast(this.positions, this.model.indices, start, direction)?.distance ?? limit);
  }

  /** The place nearest to a point on the line through it, within `reach` on both sides; or null. */
  nearestOnLine(point, direction, reach) {
    const start = add(point, direction, reach);
    const down = scaled(direction, -1);
    let best = null;
    for (let from = 0; from < 2 * reach;) {
      const found = this.hit(add(start, down, from), down);
      if (!found || from + found.distance > 2 * reach) break;
      from += found.distance + 1e-6 * reach;
      const offset = Math.abs(from - reach);
      if (!best || offset < best.offset) best = { position: found.position, offset };
      if (from > reach) break;
    }
    return best?.position ?? null;
  }
}
