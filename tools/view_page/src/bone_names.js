// The name of the bone under the pointer.
import { NONE } from '../../page_parts/src/decode.js';
import { setText } from '../../page_parts/src/elements.js';

const REACH = 9;  // pixels

/** Distance of a place from a line, all in pixels. */
function distanceFromLine([x, y], [ax, ay], [bx, by]) {
  const squared = (bx - ax) ** 2 + (by - ay) ** 2;
  const share = squared ? ((x - ax) * (bx - ax) + (y - ay) * (by - ay)) / squared : 0;
  const t = Math.min(Math.max(share, 0), 1);
  return Math.hypot(x - ax - t * (bx - ax), y - ay - t * (by - ay));
}

/** The bone whose head or line to its parent is nearest to a place; NONE beyond reach. */
export function boneAt(place, { bones, parents, placeOf }) {
  const heads = Array.from(parents, (_, bone) =>
    placeOf(Array.from(bones.subarray(bone * 12 + 9, bone * 12 + 12))));
  let best = NONE, nearest = REACH;
  parents.forEach((parent, bone) => {
    if (!heads[bone]) return;
    // A head wins over the lines that end there: children begin at it too.
    const toHead = 0.5 * Math.hypot(place[0] - heads[bone][0], place[1] - heads[bone][1]);
    const from = parent !== NONE && heads[parent];
    const toLine = from ? distanceFromLine(place, from, heads[bone]) : Infinity;
    const distance = Math.min(toHead, toLine);
    if (distance >= nearest) return;
    nearest = distance;
    // The line from a parent to a child is the parent.
    best = toHead <= toLine ? bone : parent;
  });
  return best;
}

/** @param output  shows the name; @param state  () -> of boneAt(), or null while bones are hidden */
export function followBones(output, canvas, names, state, onBone) {
  canvas.addEventListener('pointermove', (event) => {
    const shown = event.buttons ? null : state();
    const place = [event.offsetX, event.offsetY];
    const bone = shown ? boneAt(place, shown) : NONE;
    output.hidden = bone === NONE;
    onBone(bone);
    if (bone === NONE) return;
    setText(output, names[bone]);
    const right = place[0] + 16 + output.offsetWidth > canvas.clientWidth;
    const left = right ? Math.max(0, place[0] - output.offsetWidth - 12) : place[0] + 16;
    output.style.transform = `translate(${left}px, ${Math.max(0, place[1] - 36)}px)`;
  });
  canvas.addEventListener('pointerleave', () => {
    output.hidden = true;
    onBone(NONE);
  });
}
