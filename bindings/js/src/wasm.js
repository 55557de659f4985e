// The library beside this module, as sunder.wasm.
import { setDefaultSource } from './library.js';

setDefaultSource(() => {
  const file = new URL('./sunder.wasm', import.meta.url);
  // node does not fetch files.
  const files = file.protocol === 'file:' && globalThis.process?.getBuiltinModule?.('node:fs/promises');
  return files ? files.readFile(file) : fetch(file).then((response) => {
    if (!response.ok) throw new Error(`${file}: ${response.status}`);
    return response;
  });
});

export * from './exports.js';
