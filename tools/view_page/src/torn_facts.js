// What the torn model has that the source does not.
import { html } from '../../page_parts/src/elements.js';
import { plural } from '../../page_parts/src/format.js';
import { PIECES } from './shown_model.js';

const swatch = (colour) => html('span', { class: 'swatch', style: `background: ${colour}` });

export function listTornFacts(holder, torn) {
  const triangles = new Map();
  for (let i = 0; i < torn.indices.length; i += 3) {
    const piece = torn.piece_of_vertex[torn.indices[i]];
    if (piece) triangles.set(piece, (triangles.get(piece) ?? 0) + 1);
  }
  const lips = torn.lips.length / 2;
  holder.append(html('li', {}, swatch('#d6143c'),
    lips ? `lips: ${plural(lips, 'open edge')}` : 'no open edge that the source does not have'));
  for (const [piece, count] of [...triangles].sort(([a], [b]) => a - b))
    holder.append(html('li', {}, swatch(PIECES[(piece - 1) % PIECES.length]),
      `piece ${piece}: ${plural(count, 'triangle')}`));
  if (!triangles.size) holder.append(html('li', { class: 'quiet' }, 'No piece is separated.'));
}
