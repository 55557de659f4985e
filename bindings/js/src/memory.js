// The memory of the library. It may grow in any call, which detaches every typed array on it: so they are made anew.
import { SunderError } from './sunder_error.js';

const encoder = new TextEncoder(), decoder = new TextDecoder();
const NUMBERS = { u8: ['Uint8', 1], u32: ['Uint32', 4], i32: ['Int32', 4], u64: ['BigUint64', 8], f32: ['Float32', 4], f64: ['Float64', 8] };

export class Memory {
  #exports;
  #view = new DataView(new ArrayBuffer(0));
  #rooms = [];

  constructor(exports) {
    this.#exports = exports;
  }

  get buffer() { return this.#exports.memory.buffer; }
  get view() {
    if (this.#view.buffer !== this.buffer) this.#view = new DataView(this.buffer);
    return this.#view;
  }

  /** A typed array on the memory: valid until the next call of the library. */
  viewOf(Type, at, length) { return new Type(this.buffer, length ? at : 0, at ? length : 0); }

  /** Detaches every view that was handed out, so that none shows memory that has another meaning now. */
  detachViews() { this.#exports.memory.grow(0); }

  // ---- arguments of a call, which live until release() ----

  mark() { return this.#rooms.length; }
  release(mark) {
    while (this.#rooms.length > mark) this.#exports.free(this.#rooms.pop());
  }
  room(size) {
    const at = this.#exports.malloc(Math.max(8, size)) >>> 0;
    if (at === 0) throw new SunderError('limit_exceeded', 15, null, `no memory for ${size} bytes`);
    this.#rooms.push(at);
    return at;
  }

  /** The address of a copy. Numbers are addresses already. */
  array(Type, values) {
    if (values === null || values === undefined) return 0;
    if (typeof values === 'number') return values;
    const from = typeof values === 'string' ? encoder.encode(values) : values;
    const at = this.room(from.length * Type.BYTES_PER_ELEMENT);
    this.viewOf(Type, at, from.length).set(from);
    return at;
  }
  strings(values) { return this.array(Uint32Array, values?.map?.((one) => this.string(one)) ?? values); }
  arrays(Type, values) { return this.array(Uint32Array, values?.map?.((one) => this.array(Type, one)) ?? values); }

  /** Text or its bytes, ended by a zero. */
  string(text) {
    if (text === null || text === undefined) return 0;
    if (typeof text === 'number') return text;
    const bytes = typeof text === 'string' ? encoder.encode(text) : text;
    const at = this.room(bytes.length + 1);
    const to = this.viewOf(Uint8Array, at, bytes.length + 1);
    to.set(bytes);
    to[bytes.length] = 0;
    return at;
  }

  structs(struct, values) {
    if (values === null || values === undefined) return 0;
    if (typeof values === 'number') return values;
    const at = this.room(struct.size * values.length);
    this.viewOf(Uint8Array, at, struct.size * values.length).fill(0);
    values.forEach((value, i) => {
      struct.write(this, at + i * struct.size, struct.sized ? { ...value, struct_size: struct.size } : value);
    });
    return at;
  }

  // ---- reading ----

  text(at) {
    if (at === 0) return '';
    const bytes = new Uint8Array(this.buffer);
    const first = at >>> 0;
    return decoder.decode(bytes.subarray(first, bytes.indexOf(0, first)));
  }
  readStructs(struct, at, count) { return Array.from({ length: count }, (_, i) => struct.read(this, at + i * struct.size)); }
}

// u32(at), u32s(at, count), set_u32(at, value), set_u32s(at, count, values); likewise for the other numbers.
for (const [name, [kind, size]] of Object.entries(NUMBERS)) {
  const isWide = kind === 'BigUint64';
  Memory.prototype[name] = function (at) { return this.view[`get${kind}`](at, true); };
  Memory.prototype[`${name}s`] = function (at, count) {
    return Array.from({ length: count }, (_, i) => this.view[`get${kind}`](at + i * size, true));
  };
  Memory.prototype[`set_${name}`] = function (at, value) {
    this.view[`set${kind}`](at, isWide ? BigInt(value) : value, true);
  };
  Memory.prototype[`set_${name}s`] = function (at, count, values) {
    for (let i = 0; i < count; ++i) this[`set_${name}`](at + i * size, values[i]);
  };
}
