// Strokes of the brush that can be undone, among the operations on the character.
export class PaintHistory {
  #done = [];
  #undone = [];

  get canUndo() { return this.#done.length > 0; }
  get canRedo() { return this.#undone.length > 0; }
  /** Those after the last stroke; null: none was drawn. */
  get fields() { return this.#done.at(-1)?.after ?? null; }

  /** @param stroke  { before, after: fields; operations: how many were done when it was drawn } */
  add(stroke) {
    this.#done.push(stroke);
    this.#undone = [];
  }
  /** @param operations  that are done @returns the fields before the last stroke; null: an operation came later, or there is no stroke */
  undo(operations) {
    if (!this.canUndo || this.#done.at(-1).operations < operations) return null;
    this.#undone.push(this.#done.pop());
    return this.#undone.at(-1).before;
  }
  /** @returns the fields after the next stroke; null: an operation comes before it, or there is no stroke */
  redo(operations) {
    if (!this.canRedo || this.#undone.at(-1).operations > operations) return null;
    this.#done.push(this.#undone.pop());
    return this.#done.at(-1).after;
  }
  clear() {
    this.#done = [];
    this.#undone = [];
  }
}
