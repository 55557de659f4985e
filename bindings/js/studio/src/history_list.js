// The operations that are done, as a list: a click goes back to one.
import { html } from '../../../../tools/page_parts/src/elements.js';
import { plural } from '../../../../tools/page_parts/src/format.js';

const LABELS = {
  tear: ({ stroke, width }) => `Tear, ${plural(stroke.length, 'blade')}${width > 0 ? `, gap ${(100 * width).toPrecision(2)} cm` : ''}`,
  cut: () => 'Cut by a plane',
  drill: ({ radius }) => `Bore, radius ${(100 * radius).toPrecision(2)} cm`,
  detach: () => 'Part taken off',
};

export class HistoryList {
  #list;
  #onChoose;
  #known = '';

  /** @param onChoose  gets how many operations shall be left */
  constructor(list, onChoose) {
    this.#list = list;
    this.#onChoose = onChoose;
  }

  update(instance) {
    const { undo, redo } = instance.undoCounts, known = `${instance.id} ${undo} ${redo}`;
    if (known === this.#known) return;
    this.#known = known;
    const operations = undo > 0 ? JSON.parse(instance.log).operations : [];
    this.#list.replaceChildren(...operations.map((operation, i) => html('li', {},
      html('button', { title: 'Undo what came after it', onclick: () => this.#onChoose(i + 1) },
        `${i + 1}. ${LABELS[operation.op]?.(operation) ?? operation.op}`))));
  }
}
