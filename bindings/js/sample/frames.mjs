// Frames of 12 numbers, a rotation column after column and a translation, as physics engines take them: a place and a quaternion.

/** { place: [x, y, z], turn: [x, y, z, w] } of the frame that begins at a number. */
export function split(frames, first = 0) {
  const m = frames.slice(first, first + 12);
  const at = (row, column) => m[3 * column + row];
  const trace = at(0, 0) + at(1, 1) + at(2, 2);
  // Of the four numbers the largest is found first, so that none is lost.
  const squares = [at(0, 0) - at(1, 1) - at(2, 2), at(1, 1) - at(0, 0) - at(2, 2), at(2, 2) - at(0, 0) - at(1, 1), trace];
  const most = squares.indexOf(Math.max(...squares));
  const largest = Math.sqrt(1 + squares[most]) / 2, rest = 1 / (4 * largest);
  const turn = [0, 0, 0, 0];
  turn[most] = largest;
  for (let i = 0; i < 3; ++i) {
    const j = (i + 1) % 3, k = (i + 2) % 3;
    if (most === 3) turn[i] = (at(k, j) - at(j, k)) * rest;
    else if (i === most) turn[3] = (at(k, j) - at(j, k)) * rest;
    else turn[i] = (at(most, i) + at(i, most)) * rest;
  }
  return { place: [m[9], m[10], m[11]], turn };
}

/** The 12 numbers of a place and a quaternion of any length. */
export function join([px, py, pz], [x, y, z, w]) {
  const s = 2 / (x * x + y * y + z * z + w * w);
  return [1 - s * (y * y + z * z), s * (x * y + z * w), s * (x * z - y * w),
    s * (x * y - z * w), 1 - s * (x * x + z * z), s * (y * z + x * w),
    s * (x * z + y * w), s * (y * z - x * w), 1 - s * (x * x + y * y), px, py, pz];
}

/** Quaternions x y z w: the second turn, then the first; and a turn back. */
export const multiply = ([ax, ay, az, aw], [bx, by, bz, bw]) => [
  aw * bx + ax * bw + ay * bz - az * by, aw * by - ax * bz + ay * bw + az * bx,
  aw * bz + ax * by - ay * bx + az * bw, aw * bw - ax * bx - ay * by - az * bz];
export const conjugate = ([x, y, z, w]) => [-x, -y, -z, w];
/** A vector turned by a quaternion. */
export const turned = (turn, [x, y, z]) => multiply(multiply(turn, [x, y, z, 0]), conjugate(turn)).slice(0, 3);

/** An axis of a frame, 0 to 2. */
export const axisOf = (frame, axis) => frame.slice(3 * axis, 3 * axis + 3);
/** Where a frame puts a point of its own. */
export const transform = (frame, [x, y, z]) => [0, 1, 2].map((k) => frame[k] * x + frame[3 + k] * y + frame[6 + k] * z + frame[9 + k]);
