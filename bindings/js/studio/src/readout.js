// The figures of a frame, averaged over some so that they can be read.
import { html } from '../../../../tools/page_parts/src/elements.js';

const SHOWN_EVERY = 12;
const milliseconds = (value) => `${value.toFixed(2)} ms`;
const ROWS = {
  own: ['Sunder in all', milliseconds],
  operations: ['Operations', (us) => milliseconds(us / 1000)],
  settling: ['Settling', (us) => milliseconds(us / 1000)],
  tissue: ['Tissue', (us) => milliseconds(us / 1000)],
  drawing: ['Posing', (us) => milliseconds(us / 1000)],
  upload: ['Copies to buffers', milliseconds],
  bytes: ['Uploaded', (bytes) => `${(bytes / 1024).toFixed(0)} kB`],
  vertices: ['Vertices posed', (number) => number.toFixed(0)],
  instances: ['Instances', (number) => number.toFixed(0)],
  idle: ['Skipped: nothing moved', (number) => number.toFixed(0)],
  waiting: ['Skipped: waits for its turn', (number) => number.toFixed(0)],
  memory: ['Memory', (bytes) => `${(bytes / 1048576).toFixed(0)} MB`],
};

export class Readout {
  #list;
  #others = [];
  #cells = {};
  #sums = {};
  #frames = 0;
  /** The means that are shown. */
  shown = {};

  constructor(list) {
    this.#list = list;
    for (const [name, [label]] of Object.entries(ROWS)) {
      const term = html('dt', {}, label), cell = html('dd');
      list.append(term, cell);
      this.#cells[name] = cell;
    }
  }

  /** Pairs of a name and its text. */
  get lines() { return [...this.#others, ...Object.entries(ROWS).map(([name, [label]]) => [label, this.#cells[name].textContent])]; }

  /** Lines above the figures: pairs of a name and its text. */
  set others(lines) {
    if (lines.join() === this.#others.join()) return;
    for (let i = 0; i < 2 * this.#others.length; ++i) this.#list.firstChild.remove();
    this.#others = lines;
    this.#list.prepend(...lines.flat().map((text, i) => html(i % 2 === 0 ? 'dt' : 'dd', {}, text)));
  }

  add(figures) {
    for (const name of Object.keys(ROWS)) this.#sums[name] = (this.#sums[name] ?? 0) + (figures[name] ?? 0);
    if (++this.#frames < SHOWN_EVERY) return;
    for (const [name, [, text]] of Object.entries(ROWS)) {
      this.shown[name] = this.#sums[name] / this.#frames;
      this.#cells[name].textContent = text(this.shown[name]);
    }
    this.#sums = {};
    this.#frames = 0;
  }
}
