// The list of operations with undo and redo. No DOM.

export class History {
  /** @param onChange  () after every change */
  constructor(operations, onChange) {
    this.states = [operations];
    this.at = 0;
    this.onChange = onChange;
  }

  get operations() {
    return this.states[this.at];
  }

  get canUndo() {
    return this.at > 0;
  }

  get canRedo() {
    return this.at + 1 < this.states.length;
  }

  change(operations) {
    this.states = [...this.states.slice(0, this.at + 1), operations];
    ++this.at;
    this.onChange();
  }

  append(operation) {
    this.change([...this.operations, operation]);
  }

  remove(index) {
    this.change(this.operations.filter((_, i) => i !== index));
  }

  step(direction) {
    const at = this.at + direction;
    if (at < 0 || at >= this.states.length) return;
    this.at = at;
    this.onChange();
  }
}
