// The operations that are done, as a list: a click goes back to one.

const count = (number, one, many = `${one}s`) => `${number} ${number === 1 ? one : many}`;
const LABELS = {
  tear: ({ stroke, width }) => `Tear, ${count(stroke.length, 'blade')}${width > 0 ? `, gap ${(100 * width).toPrecision(2)} cm` : ''}`,
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
    this.#list.replaceChildren(...operations.map((operation, i) => {
      const button = document.createElement('button');
      button.textContent = `${i + 1}. ${LABELS[operation.op]?.(operation) ?? operation.op}`;
      button.title = 'Undo what came after it';
      button.addEventListener('click', () => this.#onChoose(i + 1));
      const item = document.createElement('li');
      item.append(button);
      return item;
    }));
  }
}
