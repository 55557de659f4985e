// The operation log as text, and how its poses are named. No DOM.

/** A name without its namespace: what follows the last ':' or '|'. */
const withoutNamespace = (name) => name.slice(Math.max(name.lastIndexOf(':'), name.lastIndexOf('|')) + 1);

/** The clip of a pose, by index; -1: there is none. By its name, or by the only one like it behind a namespace. */
export function clipIndex({ clips }, { clip }) {
  if (typeof clip === 'number') return clip < clips.length ? clip : -1;
  const whole = clips.findIndex(({ name }) => name === clip);
  if (whole >= 0) return whole;
  const isLike = ({ name }) => withoutNamespace(name) === clip;
  return clips.filter(isLike).length === 1 ? clips.findIndex(isLike) : -1;
}

/** A clip is named by its name if that is its own, else by its index. */
function clipName(data, clip) {
  const { name } = data.clips[clip];
  return name && clipIndex(data, { clip: name }) === clip ? name : clip;
}

/** The pose that a player shows, as a log says it. */
export function poseSpec(data, player) {
  if (player.pose !== null) return player.poses[player.pose].spec;
  if (player.clip === null) return 'rest';
  return { clip: clipName(data, player.clip), time: player.time };
}

export function isSamePose(data, a, b) {
  const [first, second] = [a ?? 'rest', b ?? 'rest'];
  if (first.clip === undefined || second.clip === undefined)
    return JSON.stringify(first) === JSON.stringify(second);
  return clipIndex(data, first) === clipIndex(data, second) &&
    Math.abs(first.time - second.time) < 1e-9;
}

export function poseText(spec = 'rest') {
  if (typeof spec === 'string') return spec;
  if (spec.clip !== undefined) return `${spec.time.toFixed(2)} s of ${spec.clip}`;
  return spec.bones ? 'given bones' : 'given matrices';
}

/** Whether an operation is made in a pose. */
export const isPlaced = ({ op }) => !['weights', 'undo', 'redo'].includes(op);

const NAMES = { tear: 'Tear', cut: 'Cut', drill: 'Bore', slash: 'Slash', sever: 'Sever',
  puncture: 'Puncture', incision: 'Incision', detach: 'Detach', weld: 'Weld', suture: 'Suture', weights: 'Weights', undo: 'Undo', redo: 'Redo' };

/** "Tear", "3 blades · 0.40 s of Walk" */
export function describe(operation) {
  const facts = [];
  if (operation.op === 'tear') facts.push(`${operation.stroke.length} blades`);
  if (operation.op === 'cut') {
    const sections = operation.sections?.length ?? 0;
    if (sections > 0) facts.push(sections === 1 ? '1 section' : `${sections} sections`);
    else facts.push(operation.bounds?.length > 0 ? 'bounded' : 'whole plane');
  }
  if (operation.op === 'drill') facts.push(`radius ${Number(operation.radius.toPrecision(3))} m`);
  const bone = operation.around ?? (operation.op === 'sever' ? operation.bone : undefined);
  if (bone !== undefined) facts.push(operation.at === undefined ? bone : `${bone} at ${operation.at}`);
  if (operation.op === 'incision') facts.push(`${operation.points.length} places`);
  if (operation.op === 'weld' || operation.op === 'suture') facts.push(operation.places ? `${operation.places.length} places` : 'all wounds');
  if (operation.op === 'weights') facts.push(operation.weights.policy ?? 'barycentric');
  if (operation.count > 1) facts.push(`${operation.count}`);
  if (isPlaced(operation)) facts.push(poseText(operation.pose));
  return { name: NAMES[operation.op], facts: facts.join(' · ') };
}

function line(operation) {
  if (operation.op !== 'tear') return JSON.stringify(operation);
  const { stroke, ...rest } = operation;
  const blades = stroke.map((blade) => `\n      ${JSON.stringify(blade)}`).join(',');
  return `${JSON.stringify(rest).slice(0, -1)},"stroke":[${blades}]}`;
}

/** As docs/operation_log.md says, an operation per line. */
export function formatLog(operations) {
  const lines = operations.map((operation) => `\n    ${line(operation)}`).join(',');
  return `{\n  "sunder_operations": 1,\n  "operations": [${lines}${lines ? '\n  ' : ''}]\n}\n`;
}

export const parseLog = (text) => (text ? JSON.parse(text).operations : []);

/** A word of a command line, as a shell takes it: names of files may say anything. */
export const shellWord = (word) => (/^[\w.][\w.-]*$/.test(word) ? word
  : `'${`${word.startsWith('-') ? './' : ''}${word}`.replaceAll("'", "'\\''")}'`);
