// The one instance of the library in this page, worker or process.
import { Calls, SUNDER_C_VERSION } from '../generated/calls.js';
import { SunderError } from './sunder_error.js';
import { wasiImports } from './wasi.js';

let defaultSource = null, loading = null, loaded = null;

/** What initialise() loads if nothing else is given: a function that gives bytes, a module, a response, or their promise. */
export const setDefaultSource = (source) => { defaultSource = source; };

async function start(given) {
  const source = await given;
  let instance = null;
  const imports = wasiImports(() => instance.exports.memory);
  if (source instanceof WebAssembly.Module) instance = await WebAssembly.instantiate(source, imports);
  else if (typeof Response !== 'undefined' && source instanceof Response)
    ({ instance } = await WebAssembly.instantiate(await source.arrayBuffer(), imports));
  else ({ instance } = await WebAssembly.instantiate(source, imports));
  instance.exports._initialize();
  const calls = new Calls(instance.exports);
  calls.sunder_check_abi(SUNDER_C_VERSION, 0);
  return calls;
}

/** Loads the library once. A second call gives the same; a failed one may be repeated. */
export function initialise(source = null) {
  loading ??= start(source ?? defaultSource()).then((calls) => (loaded = calls), (error) => {
    loading = null;
    throw error;
  });
  return loading;
}

/** The calls of the library, which is loaded. */
export function library() {
  if (loaded === null) throw new SunderError('not_found', 8, null, 'the library is not loaded: await Sunder.init() or Sunder.load() first');
  return loaded;
}
