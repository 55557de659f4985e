// Runs a program of WASI in node: node run.mjs PROGRAM.wasm ARGUMENTS...
// It may read the whole file system, by absolute paths, and print. node:wasi would do as much, but node 20 crashes in its own collection of garbage
// when the memory of such a program grows.
import { readFileSync, writeSync } from 'node:fs';

const BAD_FILE = 8, NO_ENTRY = 44, NOT_SUPPORTED = 52;
const CHARACTERS = 2, FOLDER = 3, FILE = 4;
const ROOT = 3;  // the file number of the folder "/"
const encoder = new TextEncoder(), decoder = new TextDecoder();
const words = process.argv.slice(2).map((word) => encoder.encode(`${word}\0`));
const epoch = BigInt(Date.now()) * 1000000n - process.hrtime.bigint();
const files = new Map();  // number -> { bytes, at }
let memory = null, next = ROOT + 1;

class Exit extends Error {
  constructor(code) {
    super();
    this.code = code;
  }
}

const view = () => new DataView(memory.buffer);
const bytesAt = (at, length) => new Uint8Array(memory.buffer, at, length);
/** Calls use(bytes) for each part of a list of buffers, until it gives less than the part. @return the sum. */
function eachPart(parts, count, use) {
  let sum = 0;
  for (let i = 0; i < count; ++i) {
    const part = bytesAt(view().getUint32(parts + 8 * i, true), view().getUint32(parts + 8 * i + 4, true));
    const done = use(part);
    sum += done;
    if (done < part.length) break;
  }
  return sum;
}

const calls = {
  args_sizes_get(count, size) {
    view().setUint32(count, words.length, true);
    view().setUint32(size, words.reduce((sum, word) => sum + word.length, 0), true);
    return 0;
  },
  args_get(addresses, text) {
    words.forEach((word, i) => {
      view().setUint32(addresses + 4 * i, text, true);
      bytesAt(text, word.length).set(word);
      text += word.length;
    });
    return 0;
  },
  environ_sizes_get(count, size) {
    view().setUint32(count, 0, true);
    view().setUint32(size, 0, true);
    return 0;
  },
  environ_get: () => 0,
  clock_time_get(clock, precision, time) {
    view().setBigUint64(time, process.hrtime.bigint() + (clock === 0 ? epoch : 0n), true);
    return 0;
  },
  fd_prestat_get(file, at) {
    if (file !== ROOT) return BAD_FILE;
    view().setUint32(at, 0, true);
    view().setUint32(at + 4, 1, true);
    return 0;
  },
  fd_prestat_dir_name(file, at) {
    bytesAt(at, 1).set(encoder.encode('/'));
    return 0;
  },
  fd_fdstat_get(file, at) {
    if (file > ROOT && !files.has(file)) return BAD_FILE;
    bytesAt(at, 24).fill(0);
    view().setUint8(at, file < ROOT ? CHARACTERS : file === ROOT ? FOLDER : FILE);
    view().setBigUint64(at + 8, ~0n & 0xFFFFFFFFFFFFFFFFn, true);
    view().setBigUint64(at + 16, ~0n & 0xFFFFFFFFFFFFFFFFn, true);
    return 0;
  },
  path_open(folder, follows, path, length, creates, rights, inherited, flags, file) {
    if (creates !== 0) return NOT_SUPPORTED;
    try {
      files.set(next, { bytes: readFileSync(`/${decoder.decode(bytesAt(path, length))}`), at: 0 });
    } catch {
      return NO_ENTRY;
    }
    view().setUint32(file, next++, true);
    return 0;
  },
  fd_read(file, parts, count, done) {
    const from = files.get(file);
    if (!from) return BAD_FILE;
    view().setUint32(done, eachPart(parts, count, (part) => {
      const read = from.bytes.subarray(from.at, from.at + part.length);
      part.set(read);
      from.at += read.length;
      return read.length;
    }), true);
    return 0;
  },
  fd_seek(file, offset, from, at) {
    const of = files.get(file);
    if (!of) return BAD_FILE;
    of.at = Number(offset) + [0, of.at, of.bytes.length][from];
    view().setBigUint64(at, BigInt(of.at), true);
    return 0;
  },
  fd_write(file, parts, count, done) {
    if (file !== 1 && file !== 2) return BAD_FILE;
    view().setUint32(done, eachPart(parts, count, (part) => writeSync(file, part)), true);
    return 0;
  },
  fd_close(file) { return files.delete(file) ? 0 : BAD_FILE; },
  proc_exit(code) { throw new Exit(code); },
};

const imports = { wasi_snapshot_preview1: new Proxy(calls, { get: (of, name) => of[name] ?? (() => NOT_SUPPORTED) }) };
const { instance } = await WebAssembly.instantiate(readFileSync(process.argv[2]), imports);
memory = instance.exports.memory;
try {
  instance.exports._start();
} catch (error) {
  if (!(error instanceof Exit)) throw error;
  process.exitCode = error.code;
}
