// The list of operations, and the log that they make.
import { byId, html } from '../../page_parts/src/elements.js';
import { saveFile } from '../../page_parts/src/save_file.js';
import { describe, formatLog } from './log.js';

export class OperationList {
  /** @param name  of the saved file; @param onChoose  (operation or null) */
  constructor(history, name, { onChoose, onMessage }) {
    Object.assign(this, { history, name, onChoose, onMessage });
    this.chosen = null;
    byId('undo').addEventListener('click', () => history.step(-1));
    byId('redo').addEventListener('click', () => history.step(1));
    byId('copy').addEventListener('click', () => this.copy());
    byId('save').addEventListener('click', () => this.save());
    this.update();
  }

  get text() {
    return formatLog(this.history.operations);
  }

  update() {
    const { operations, canUndo, canRedo } = this.history;
    if (!operations.includes(this.chosen)) this.chosen = null;
    byId('operations').replaceChildren(...operations.map((operation, i) => this.row(operation, i)));
    byId('no-operations').hidden = operations.length > 0;
    byId('undo').disabled = !canUndo;
    byId('redo').disabled = !canRedo;
    byId('copy').disabled = byId('save').disabled = operations.length === 0;
  }

  row(operation, i) {
    const { name, facts } = describe(operation);
    return html('li', {},
      html('button', { class: 'choose', title: `${facts}: go to its pose`,
        'aria-pressed': String(operation === this.chosen),
        onclick: () => this.choose(operation === this.chosen ? null : operation) },
      html('b', {}, `${i + 1} ${name}`), html('span', {}, facts)),
      html('button', { 'aria-label': `Delete operation ${i + 1}: ${name}`, title: 'Delete',
        onclick: () => this.history.remove(i) }, '×'));
  }

  choose(operation) {
    this.chosen = operation;
    this.update();
    this.onChoose(operation);
  }

  async copy() {
    try {
      await navigator.clipboard.writeText(this.text);
      this.onMessage('The log is in the clipboard.');
    } catch {
      this.onMessage('The browser does not let this page write to the clipboard: save the log.', true);
    }
  }

  save() {
    saveFile(this.text, this.name, 'application/json');
    this.onMessage(`Saved as ${this.name}.`);
  }
}
