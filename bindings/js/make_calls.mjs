// Writes the low-level part of the package from sunder_api.json: enums, readers and writers of structs with the offsets of
// WebAssembly, and one method per function of the C library.
// Usage: node make_calls.mjs <sunder_api.json> <calls.js> <calls.d.ts>
import { readFileSync, writeFileSync } from 'node:fs';

const [apiFile, codeFile, typesFile] = process.argv.slice(2);
const api = JSON.parse(readFileSync(apiFile, 'utf8'));
const structs = new Map(api.structs.map((struct) => [struct.name, struct]));
const typedefs = new Map(api.types.map((type) => [type.name, type.type]));
const callbacks = new Set(api.callbacks.map((callback) => callback.name));
const makers = new Map(api.functions.filter((f) => structs.has(f.returns)).map((f) => [f.returns, f.name]));

/** The names in memory.js: u32, f64 ... */
const NUMBERS = { uint8_t: 'u8', uint32_t: 'u32', int32_t: 'i32', uint64_t: 'u64', float: 'f32', double: 'f64' };
const ARRAYS = { uint8_t: 'Uint8Array', uint32_t: 'Uint32Array', float: 'Float32Array', double: 'Float64Array' };

const plain = (type) => typedefs.get(type) ?? type;
const numberOf = (type) => (type.endsWith('*') || callbacks.has(type) ? 'u32' : NUMBERS[plain(type)]);
const pointee = (type) => type.replace(/^const /, '').replace(/\*$/, '').trim();
const isConst = (type) => type.startsWith('const ');
const wide = (type) => !type.endsWith('*') && plain(type) === 'uint64_t';
const at = (offset) => (offset ? `at + ${offset}` : 'at');

// ---- structs ----

function readField({ type, count, offset32 }) {
  if (structs.has(type)) return `${type}.read(m, ${at(offset32)})`;
  const number = numberOf(type);
  return count > 1 ? `m.${number}s(${at(offset32)}, ${count})` : `m.${number}(${at(offset32)})`;
}

/** The address of what a pointer field is to point to. */
function placed(type, value) {
  const to = pointee(type);
  if (type === 'const char*') return `m.string(${value})`;
  if (structs.has(to)) return `m.structs(${to}, ${value})`;
  if (to === 'const char* const') return `m.strings(${value})`;
  if (to.endsWith('* const')) return `m.arrays(${ARRAYS[pointee(to.replace(/ const$/, ''))]}, ${value})`;
  if (ARRAYS[plain(to)]) return `m.array(${ARRAYS[plain(to)]}, ${value})`;
  return value;  // an address
}

function writeField({ name, type, count, offset32 }) {
  const value = `v.${name}`;
  if (structs.has(type)) return `${type}.write(m, ${at(offset32)}, ${value})`;
  if (type.endsWith('*')) return `m.set_u32(${at(offset32)}, ${placed(type, value)})`;
  const number = numberOf(type);
  return count > 1 ? `m.set_${number}s(${at(offset32)}, ${count}, ${value})` : `m.set_${number}(${at(offset32)}, ${value})`;
}

function structCode(struct) {
  const sized = struct.fields[0].name === 'struct_size';
  return `export const ${struct.name} = {
  name: '${struct.name}', size: ${struct.size32}, sized: ${sized}, maker: ${makers.has(struct.name) ? `'${makers.get(struct.name)}'` : 'null'},
  fields: ${JSON.stringify(struct.fields.map((field) => field.name))},
  read: (m, at) => ({ ${struct.fields.map((field) => `${field.name}: ${readField(field)}`).join(', ')} }),
  write(m, at, v) {
${struct.fields.map((field) => `    if (v.${field.name} !== undefined) ${writeField(field)};`).join('\n')}
  },
};
`;
}

// ---- functions ----

const isPlural = (name) => name.endsWith('s');

/** What a parameter is: `in` with the code of its argument, `out` with that of its reader, or counted by the one before it. */
function roleOf(parameter, previous) {
  const { name, type } = parameter;
  if (!type.endsWith('*')) {
    const counts = previous && /^(const void\*|const char\*)$/.test(previous.type) ? name === 'size' :
      previous && isConst(previous.type) && (structs.has(pointee(previous.type)) || typedefs.has(pointee(previous.type))) && /count$/.test(name);
    if (counts) return { kind: 'counted', argument: wide(type) ? `BigInt(${previous.name}?.length ?? 0)` : `${previous.name}?.length ?? 0` };
    return { kind: 'in', argument: wide(type) ? `BigInt(${name})` : name };
  }
  const to = pointee(type);
  if (isConst(type) && !to.endsWith('*')) {
    if (type === 'const void*') return { kind: 'in', argument: `m.array(Uint8Array, ${name})` };
    if (type === 'const char*') return { kind: 'in', argument: `m.string(${name})` };
    if (!structs.has(to)) return { kind: 'in', argument: `m.array(${ARRAYS[plain(to)]}, ${name})` };
    return { kind: 'in', argument: isPlural(name) && !name.endsWith('options') ? `m.structs(${to}, ${name})` : `this.made(${to}, ${name})` };
  }
  if (to.endsWith('*')) return { kind: 'out', size: 4, read: `m.u32(${name})`, type: 'number' };
  if (structs.has(to) && !isPlural(name) || to === 'sunder_frame_stats')
    return { kind: 'out', struct: to, size: structs.get(to).size32, read: `${to}.read(m, ${name})`, type: to };
  if (structs.has(to) || ['float', 'double'].includes(to) && name !== 'tension') return { kind: 'in', argument: name, address: true };
  const number = NUMBERS[plain(to)];
  return { kind: 'out', size: 8, read: `m.${number}(${name})`, type: number === 'u64' ? 'bigint' : 'number' };
}

const rolesOf = (f) => f.parameters.map((parameter, i) => ({ ...parameter, ...roleOf(parameter, f.parameters[i - 1]) }));

function functionCode(f) {
  const roles = rolesOf(f);
  const given = roles.filter((role) => role.kind === 'in').map((role) => role.name).join(', ');
  if (structs.has(f.returns)) return `  ${f.name}() { return this.defaults(${f.returns}); }\n`;
  const outs = roles.filter((role) => role.kind === 'out');
  const values = roles.map((role) => (role.kind === 'out' ? role.name : role.argument)).join(', ');
  const call = `this.exports.${f.name}(${values})`;
  if (f.returns !== 'sunder_status') return `  ${f.name}(${given}) { return ${f.returns === 'const char*' ? `this.memory.text(${call})` : `${call} >>> 0`}; }\n`;
  const rooms = outs.map((role) => `      const ${role.name} = m.room(${role.size});\n${
    role.struct && structs.get(role.struct).fields[0].name === 'struct_size' ? `      m.set_u32(${role.name}, ${role.size});\n` : ''}`).join('');
  const result = outs.length === 0 ? '' : outs.length === 1 ? `      return ${outs[0].read};\n` :
    `      return { ${outs.map((role) => `${role.name}: ${role.read}`).join(', ')} };\n`;
  return `  ${f.name}(${given}) {
    const m = this.memory, mark = m.mark();
    try {
${rooms}      this.check(${call});
${result}    } finally {
      m.release(mark);
    }
  }
`;
}

const constants = [...api.enums.flatMap((one) => one.constants),
  ...Object.entries(api.constants).map(([name, value]) => ({ name, value }))];

const code = `// Written by make_calls.mjs from sunder_api.json.
import { CallsBase } from '../src/calls_base.js';

${constants.map(({ name, value }) => `export const ${name} = ${value};`).join('\n')}

${api.structs.map(structCode).join('')}
export const FUNCTIONS = ${JSON.stringify(api.functions.map((f) => f.name))};

export class Calls extends CallsBase {
${api.functions.map(functionCode).join('')}}
`;

// ---- types ----

const comment = (doc, indent = '') => (doc ? `${indent}/** ${doc.replace(/\*\//g, '* /')} */\n` : '');

function fieldType({ type, count }) {
  if (structs.has(type)) return type;
  if (type.endsWith('*')) {
    const to = pointee(type);
    if (type === 'const char*') return 'number | string | null';
    if (structs.has(to)) return `number | Partial<${to}>[] | null`;
    return ARRAYS[plain(to)] ? `number | ${ARRAYS[plain(to)]} | null` : to.endsWith('* const') ? 'number | Float32Array[] | null' : 'number';
  }
  const one = wide(type) ? 'bigint' : 'number';
  return count > 1 ? `${one}[]` : one;
}

function argumentType({ type, name, address }) {
  if (address) return 'number';
  if (!type.endsWith('*')) return wide(type) ? 'bigint | number' : 'number';
  const to = pointee(type);
  if (type === 'const void*') return 'Uint8Array';
  if (type === 'const char*') return 'string | Uint8Array';
  if (structs.has(to)) return isPlural(name) && !name.endsWith('options') ? `Partial<${to}>[] | null` : `Partial<${to}> | null`;
  return `${ARRAYS[plain(to)]} | number[] | null`;
}

function functionType(f) {
  const roles = rolesOf(f);
  const given = roles.filter((role) => role.kind === 'in').map((role) => `${role.name}: ${argumentType(role)}`).join(', ');
  const outs = roles.filter((role) => role.kind === 'out');
  const returns = structs.has(f.returns) ? f.returns : f.returns === 'const char*' ? 'string' : f.returns !== 'sunder_status' ? 'number' :
    outs.length === 0 ? 'void' : outs.length === 1 ? outs[0].type : `{ ${outs.map((role) => `${role.name}: ${role.type}`).join('; ')} }`;
  return `${comment(f.doc, '  ')}  ${f.name}(${given}): ${returns};\n`;
}

const types = `// Written by make_calls.mjs from sunder_api.json. Pointers are addresses in the memory of the library.

${constants.map(({ name, value, doc }) => `${comment(doc)}export const ${name}: ${value};`).join('\n')}

${api.structs.map((struct) => `${comment(struct.doc)}export interface ${struct.name} {
${struct.fields.map((field) => `${comment(field.doc, '  ')}  ${field.name}: ${fieldType(field)};\n`).join('')}}
`).join('\n')}
/** The functions of the C library. A status other than 0 is thrown as a SunderError. */
export interface Calls {
${api.functions.map(functionType).join('')}}
`;

writeFileSync(codeFile, code);
writeFileSync(typesFile, types);
