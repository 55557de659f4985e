// Vectors of three numbers. No DOM.

export const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const cross = (a, b) =>
  [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
export const scaled = (a, factor) => a.map((x) => x * factor);
/** a + factor * b */
export const add = (a, b, factor = 1) => a.map((x, k) => x + factor * b[k]);
export const distance = (a, b) => Math.hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
export const lerp = (a, b, t) => a.map((x, k) => (1 - t) * x + t * b[k]);
/** Zero stays zero. */
export const unit = (a) => scaled(a, 1 / (Math.hypot(...a) || 1));

/** Two unit vectors at right angles to a direction and to each other. */
export function frameAround(direction) {
  const other = Math.abs(direction[1]) < 0.9 ? [0, 1, 0] : [1, 0, 0];
  const right = unit(cross(other, direction));
  return [right, cross(direction, right)];
}
