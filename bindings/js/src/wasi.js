// What the library imports of WASI: a clock, and calls that write its last words if it ends the program.
import { SunderError } from './sunder_error.js';

const NOT_SUPPORTED = 52, BAD_FILE = 8;

export function wasiImports(memory) {
  const decoder = new TextDecoder();
  const view = () => new DataView(memory().buffer);
  const calls = {
    clock_time_get(clock, precision, time) {
      view().setBigUint64(time, BigInt(Math.round((clock === 0 ? Date.now() : performance.now()) * 1e6)), true);
      return 0;
    },
    fd_write(file, parts, count, written) {
      if (file !== 1 && file !== 2) return BAD_FILE;
      let text = '', size = 0;
      for (let i = 0; i < count; ++i) {
        const at = view().getUint32(parts + 8 * i, true), length = view().getUint32(parts + 8 * i + 4, true);
        text += decoder.decode(new Uint8Array(memory().buffer, at, length));
        size += length;
      }
      if (text.trim()) console.error(text.trimEnd());
      view().setUint32(written, size, true);
      return 0;
    },
    proc_exit(code) { throw new SunderError('internal_error', 17, null, `the library ended with ${code}`); },
  };
  // Files do not exist here.
  return { wasi_snapshot_preview1: new Proxy(calls, { get: (target, name) => target[name] ?? (() => NOT_SUPPORTED) }) };
}
