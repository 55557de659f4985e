// What is under the pointer, in numbers.
import { html } from '../../page_parts/src/elements.js';
import { vertexInMesh } from '../../page_parts/src/decode.js';
import { quantity } from '../../page_parts/src/format.js';
import { influencesText } from './heat.js';
import { raycast } from '../../page_parts/src/raycast.js';

/** The corner nearest to a hit, and the value at the hit itself. */
function place(hit, values) {
  const nearest = hit.corners[hit.shares.indexOf(Math.max(...hit.shares))];
  const value = values &&
    hit.corners.reduce((sum, corner, i) => sum + hit.shares[i] * values[corner], 0);
  return { nearest, value };
}

export class Readout {
  /** @param viewports  () -> per viewport [{role, model, positions(), values}] */
  constructor(output, stage, viewports) {
    this.output = output;
    this.stage = stage;
    this.viewports = viewports;
    this.pointer = null;
    const { canvas } = stage;
    canvas.addEventListener('pointermove', (event) => {
      this.pointer = event.buttons ? null : [event.offsetX, event.offsetY];
      this.request();
    });
    canvas.addEventListener('pointerleave', () => {
      this.pointer = null;
      this.request();
    });
  }

  /** Writes again soon: a ray costs milliseconds on large models. */
  request() {
    this.timer ??= setTimeout(() => {
      this.timer = undefined;
      this.update();
    }, 40);
  }

  update() {
    const found = this.pointer && this.find(...this.pointer);
    this.output.hidden = !found;
    if (!found) return;
    this.output.replaceChildren(...this.lines(found));
    const { clientWidth: width, clientHeight: height } = this.stage.canvas.parentElement;
    const [x, y] = this.pointer;
    const { offsetWidth, offsetHeight } = this.output;
    const left = x + 18 + offsetWidth > width ? x - offsetWidth - 12 : x + 18;
    const top = y + 14 + offsetHeight > height ? y - offsetHeight - 10 : y + 14;
    this.output.style.transform = `translate(${Math.max(0, left)}px, ${Math.max(0, top)}px)`;
  }

  find(x, y) {
    const { view, origin, direction } = this.stage.rayAt(x, y);
    const hits = (this.viewports()[view] ?? []).map((shown) => ({
      shown, hit: raycast(shown.positions(), shown.model.indices, origin, direction),
    })).filter(({ hit }) => hit);
    return hits.sort((a, b) => a.hit.distance - b.hit.distance)[0];
  }

  lines({ shown, hit }) {
    const { nearest, value } = place(hit, shown.values);
    const { mesh, number } = vertexInMesh(shown.model, nearest);
    const lines = [html('span', {}, `${shown.role} · ${mesh.name} · vertex ${number}`)];
    if (shown.values) lines.unshift(html('b', {}, quantity(value, shown.unit)));
    lines.push(html('span', { class: 'bones' }, influencesText(shown.model, nearest)));
    return lines;
  }
}
