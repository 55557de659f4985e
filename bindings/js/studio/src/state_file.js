// A state that is saved: the library's snapshot of the character, and the parts that fell. Files are not trusted.

const MAGIC = new TextEncoder().encode('sunder studio 1\n');
/** How many numbers a body has of each kind. */
const BODY = { mass: 1, inertiaPiece: 9, modelFromPiece: 12, position: 3, quaternion: 4, velocity: 3, spin: 3 };

/** @param pieces  { glb, operations, materials, body } each, as FallingPiece.state gives them */
export function packState({ snapshot, pieces }) {
  const header = new TextEncoder().encode(JSON.stringify({
    snapshot: snapshot.length, pieces: pieces.map(({ glb, ...others }) => ({ ...others, glb: glb.length })) }));
  const size = new Uint8Array(Uint32Array.of(header.length).buffer), parts = [MAGIC, size, header, snapshot, ...pieces.map(({ glb }) => glb)];
  const bytes = new Uint8Array(parts.reduce((sum, { length }) => sum + length, 0));
  let at = 0;
  for (const part of parts) {
    bytes.set(part, at);
    at += part.length;
  }
  return bytes;
}

const isCount = (value) => Number.isInteger(value) && value >= 0;
const isBody = (body) => Object.entries(BODY).every(([name, count]) => {
  const numbers = [body?.[name]].flat();
  return numbers.length === count && numbers.every(Number.isFinite);
}) && body.mass > 0;
const isPiece = (piece) => isCount(piece?.glb) && isCount(piece.operations) && isBody(piece.body) &&
  Array.isArray(piece.materials) && piece.materials.every((mesh) => Array.isArray(mesh) && mesh.every(isCount));

/** What packState() got. A snapshot alone is a state without parts. */
export function unpackState(bytes) {
  if (!MAGIC.every((byte, i) => byte === bytes[i])) return { snapshot: bytes, pieces: [] };
  const damaged = () => { throw new Error('this state is damaged'); };
  const start = MAGIC.length + 4;
  if (bytes.length < start) damaged();
  const size = new DataView(bytes.buffer, bytes.byteOffset).getUint32(MAGIC.length, true);
  let header = null, at = start + size;
  try {
    header = JSON.parse(new TextDecoder().decode(bytes.subarray(start, at)));
  } catch {
    damaged();
  }
  if (!isCount(header?.snapshot) || !Array.isArray(header.pieces) || !header.pieces.every(isPiece)) damaged();
  const next = (length) => bytes.subarray(at, at += length);
  const snapshot = next(header.snapshot), pieces = header.pieces.map((piece) => ({ ...piece, glb: next(piece.glb) }));
  if (at !== bytes.length) damaged();
  return { snapshot, pieces };
}
