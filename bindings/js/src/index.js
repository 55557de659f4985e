// The library inside this module.
import { setDefaultSource } from './library.js';
import { inlined } from '../generated/inlined.js';

/** The bytes of base64, which deflate has made smaller. */
async function unpack(text) {
  const packed = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
  return new Response(new Blob([packed]).stream().pipeThrough(new DecompressionStream('deflate-raw'))).arrayBuffer();
}
setDefaultSource(() => unpack(inlined));

export * from './exports.js';
