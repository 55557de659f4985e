// The sphere around posed models. No DOM.
import { posePositions } from './skin.js';

/** @param models  [[model, matrices], ...] */
export function boundingSphere(models) {
  const least = [Infinity, Infinity, Infinity], most = [-Infinity, -Infinity, -Infinity];
  for (const [model, matrices] of models) {
    const positions = posePositions(model, matrices);
    for (const index of model.indices)
      for (let k = 0; k < 3; ++k) {
        least[k] = Math.min(least[k], positions[index * 3 + k]);
        most[k] = Math.max(most[k], positions[index * 3 + k]);
      }
  }
  if (!(least[0] <= most[0])) return { centre: [0, 0, 0], radius: 1 };
  const centre = least.map((low, k) => (low + most[k]) / 2);
  return { centre, radius: Math.hypot(...centre.map((x, k) => most[k] - x)) || 1 };
}
