// The nearest triangle on a ray. No DOM.

/** {distance, triangle, corners, shares} of the first hit, or null. @param positions  posed, 3 per vertex. */
export function raycast(positions, indices, origin, direction) {
  let best = null;
  let nearest = Infinity;
  const [dx, dy, dz] = direction;
  for (let i = 0; i < indices.length; i += 3) {
    const a = indices[i] * 3, b = indices[i + 1] * 3, c = indices[i + 2] * 3;
    const ux = positions[b] - positions[a], uy = positions[b + 1] - positions[a + 1];
    const uz = positions[b + 2] - positions[a + 2];
    const vx = positions[c] - positions[a], vy = positions[c + 1] - positions[a + 1];
    const vz = positions[c + 2] - positions[a + 2];
    const px = dy * vz - dz * vy, py = dz * vx - dx * vz, pz = dx * vy - dy * vx;
    const determinant = ux * px + uy * py + uz * pz;
    if (determinant === 0) continue;
    const sx = origin[0] - positions[a], sy = origin[1] - positions[a + 1];
    const sz = origin[2] - positions[a + 2];
    const s = (sx * px + sy * py + sz * pz) / determinant;
    if (s < 0 || s > 1) continue;
    const qx = sy * uz - sz * uy, qy = sz * ux - sx * uz, qz = sx * uy - sy * ux;
    const t = (dx * qx + dy * qy + dz * qz) / determinant;
    if (t < 0 || s + t > 1) continue;
    const distance = (vx * qx + vy * qy + vz * qz) / determinant;
    if (distance <= 0 || distance >= nearest) continue;
    nearest = distance;
    best = { distance, triangle: i / 3, corners: [a / 3, b / 3, c / 3], shares: [1 - s - t, s, t] };
  }
  return best;
}
