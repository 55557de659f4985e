// What all generated calls share: errors, and structs with their defaults.
import { Memory } from './memory.js';
import { SunderError } from './sunder_error.js';

export class CallsBase {
  constructor(exports) {
    this.exports = exports;
    this.memory = new Memory(exports);
  }

  check(status) {
    if (status === 0) return;
    const { exports, memory } = this;
    const index = exports.sunder_last_error_index() >>> 0;
    throw new SunderError(memory.text(exports.sunder_status_name(status)), status, index === 0xFFFFFFFF ? null : index,
      memory.text(exports.sunder_last_error()));
  }

  /** The struct that sunder_default_...() gives. */
  defaults(struct) {
    const mark = this.memory.mark();
    try {
      return struct.read(this.memory, this.made(struct, {}));
    } finally {
      this.memory.release(mark);
    }
  }

  /** The address of a struct with the defaults of the library and the given values; 0 for null. */
  made(struct, values) {
    if (values === null || values === undefined) return 0;
    const m = this.memory, at = m.room(struct.size);
    if (struct.maker) this.exports[struct.maker](at);
    struct.write(m, at, struct.sized ? { ...values, struct_size: struct.size } : values);
    return at;
  }
}
