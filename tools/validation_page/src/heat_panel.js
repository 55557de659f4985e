// The controls of the heat map: what it shows, its scale, the worst vertices.
import { byId, html, setText } from '../../page_parts/src/elements.js';
import { vertexInMesh } from '../../page_parts/src/decode.js';
import { niceTop, quantity } from '../../page_parts/src/format.js';
import { scaleOf, shownArray, shownBone, topsOf, weighingBones, worstVertices } from './heat.js';
import { drawLegend } from './legend.js';

const WORST = 8;

export class HeatPanel {
  /** @param onShown  (shown or null, scale), @param onWorst  (place, label) */
  constructor(data, radius, { onShown, onWorst }) {
    Object.assign(this, { data, radius, onShown, onWorst });
    this.select = byId('shown');
    this.top = byId('top');
    this.log = byId('log');
    this.fillSelect();
    this.select.addEventListener('change', () => this.choose());
    this.log.addEventListener('change', () => this.rescale());
    this.top.addEventListener('input', () => this.rescale());
    this.choose();
  }

  fillSelect() {
    const { data } = this;
    const option = (value, name) => html('option', { value }, name);
    if (data.arrays.length)
      this.select.append(html('optgroup', { label: 'Measured on the target' },
        ...data.arrays.map((array, i) => option(`array ${i}`, array.name))));
    this.select.append(html('optgroup', { label: 'Weights of a bone' },
      ...weighingBones(data.target).map((bone) => option(`bone ${bone}`, data.target.bones[bone]))),
    option('none', 'Nothing'));
  }

  choose() {
    const [kind, number] = this.select.value.split(' ');
    if (kind !== 'none') this.lastShown = this.select.value;
    if (kind === 'array') this.shown = shownArray(this.data.arrays[number]);
    else this.shown = kind === 'bone' ? shownBone(this.data, Number(number)) : null;
    this.worst = [];
    if (this.shown) {
      this.tops = topsOf(this.shown);
      // The slider is logarithmic: errors of skins span decades.
      this.top.value = 1 + Math.log10(this.tops.wanted / this.tops.most) / 3;
      this.worst = this.shown.isWeight ? []
        : worstVertices(this.data.target, this.shown, WORST, 0.06 * this.radius);
    }
    this.log.disabled = !this.shown || this.shown.signed;
    byId('top-row').hidden = !this.shown || Boolean(this.shown.isWeight);
    this.listWorst();
    this.rescale();
  }

  rescale() {
    byId('legend').hidden = !this.shown;
    if (!this.shown) return this.onShown(null);
    const top = niceTop(this.tops.most * 10 ** (3 * (Number(this.top.value) - 1)));
    const scale = scaleOf(this.shown, top, this.log.checked);
    setText(byId('top-value'), quantity(top, this.shown.unit));
    drawLegend(byId('legend'), this.shown, scale);
    return this.onShown(this.shown, scale);
  }

  listWorst() {
    setText(byId('worst-title'), this.worst.length ? 'Worst vertices' : '');
    this.buttons = this.worst.map((vertex, i) => {
      const { number } = vertexInMesh(this.data.target, vertex);
      return html('button', { class: 'place', onclick: () => this.goTo(i) },
        html('b', {}, `vertex ${number}`), html('span', {}, this.label(vertex)));
    });
    byId('worst').replaceChildren(...this.buttons.map((button) => html('li', {}, button)));
    this.current = -1;
  }

  label(vertex) {
    return quantity(this.shown.target[vertex], this.shown.unit);
  }

  goTo(i) {
    const vertex = this.worst[i];
    this.current = i;
    const { mesh, number } = vertexInMesh(this.data.target, vertex);
    this.onWorst({ mesh: this.data.target.meshes.indexOf(mesh), vertex: number },
      this.label(vertex));
  }

  /** The next or previous worst vertex. */
  step(direction) {
    const count = this.worst.length;
    if (!count) return;
    this.goTo(this.current < 0 ? (direction > 0 ? 0 : count - 1)
      : (this.current + direction + count) % count);
  }

  toggle() {
    this.select.value = this.shown ? 'none' : this.lastShown ?? this.select.options[0].value;
    this.choose();
  }

  toggleLog() {
    if (this.log.disabled) return;
    this.log.checked = !this.log.checked;
    this.rescale();
  }
}
