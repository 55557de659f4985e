// The size of a model. No DOM.

/** The box around all vertices that triangles use: {least, most}. */
export function boxOf(positions, indices) {
  const least = [Infinity, Infinity, Infinity], most = [-Infinity, -Infinity, -Infinity];
  for (const index of indices)
    for (let k = 0; k < 3; ++k) {
      least[k] = Math.min(least[k], positions[index * 3 + k]);
      most[k] = Math.max(most[k], positions[index * 3 + k]);
    }
  return { least, most };
}

/** The radius of the sphere around that box. */
export function radiusOf(positions, indices) {
  const { least, most } = boxOf(positions, indices);
  return Math.hypot(...least.map((low, k) => (most[k] - low) / 2)) || 1;
}
