// Bytes that a call has made are copied out of the memory of the library and destroyed there.
export function takeBytes(calls, handle) {
  try {
    const { data, size } = calls.sunder_get_bytes(handle);
    return calls.memory.viewOf(Uint8Array, data, Number(size)).slice();
  } finally {
    calls.sunder_destroy_bytes(handle);
  }
}
export const takeText = (calls, handle) => new TextDecoder().decode(takeBytes(calls, handle));
