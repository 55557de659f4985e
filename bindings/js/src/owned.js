// An object of the library that is destroyed by dispose(), or when nothing refers to it any more.
import { invalidHandle } from './sunder_error.js';

const registry = new FinalizationRegistry((destroy) => destroy());

export class Owned {
  #handle;
  #destroy;

  constructor(handle, destroy) {
    this.#handle = handle;
    this.#destroy = () => destroy(handle);
    registry.register(this, this.#destroy, this);
  }

  get handle() {
    if (this.#handle === null) throw invalidHandle(`this ${this.constructor.name} was disposed of`);
    return this.#handle;
  }
  get isDisposed() { return this.#handle === null; }

  dispose() {
    if (this.#handle === null) return;
    registry.unregister(this);
    this.#handle = null;
    this.#destroy();
  }
  [Symbol.dispose ?? Symbol.for('Symbol.dispose')]() { this.dispose(); }
}
