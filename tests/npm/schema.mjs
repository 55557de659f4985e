// Prints what in a JSON file does not follow a JSON schema, as a list. It knows the keywords that
// docs/operation_log.schema.json uses and refuses others.
// Usage: node schema.mjs <schema.json> <file.json>
import { readFileSync } from 'node:fs';

const [schemaFile, file] = process.argv.slice(2);
const root = JSON.parse(readFileSync(schemaFile, 'utf8'));

const typeOf = (value) => (Array.isArray(value) ? 'array' : value === null ? 'null' : typeof value);
const hasType = (value, type) =>
  (type === 'integer' ? Number.isInteger(value) : typeOf(value) === type);
const isEqual = (a, b) => JSON.stringify(a) === JSON.stringify(b);
const isObject = (value) => typeOf(value) === 'object';
const when = (condition, text) => (condition ? [text] : []);

/** Per keyword: (its value, the value, its place, the whole schema) -> texts of faults. */
const KEYWORDS = {
  type: (type, value, at) => when(!hasType(value, type), `${at}: expected ${type}`),
  const: (wanted, value, at) => when(!isEqual(value, wanted), `${at}: expected ${wanted}`),
  enum: (list, value, at) =>
    when(!list.some((wanted) => isEqual(value, wanted)), `${at}: none of ${list}`),
  minimum: (least, value, at) => when(value < least, `${at}: below ${least}`),
  maximum: (most, value, at) => when(value > most, `${at}: above ${most}`),
  exclusiveMinimum: (least, value, at) => when(value <= least, `${at}: not above ${least}`),
  minLength: (least, value, at) => when(value.length < least, `${at}: too short`),
  minItems: (least, value, at) => when(value.length < least, `${at}: below ${least} items`),
  maxItems: (most, value, at) => when(value.length > most, `${at}: above ${most} items`),
  required: (names, value, at) => (isObject(value)
    ? names.filter((name) => !(name in value)).map((name) => `${at}: no ${name}`) : []),
  dependentRequired: (of, value, at) => (isObject(value)
    ? Object.keys(of).filter((name) => name in value).flatMap((name) => of[name]
      .filter((needed) => !(needed in value)).map((needed) => `${at}: ${name} without ${needed}`)) : []),
  properties: (of, value, at) => (isObject(value)
    ? Object.keys(of).filter((name) => name in value)
      .flatMap((name) => faults(of[name], value[name], `${at}/${name}`)) : []),
  additionalProperties: (schema, value, at, { properties = {} }) => (isObject(value)
    ? Object.keys(value).filter((name) => !(name in properties)).flatMap((name) =>
      (schema === false ? [`${at}: unknown ${name}`] : faults(schema, value[name], `${at}/${name}`))) : []),
  propertyNames: (schema, value, at) =>
    Object.keys(value).flatMap((name) => faults(schema, name, `${at} (name)`)),
  prefixItems: (list, value, at) => list.flatMap((schema, i) =>
    (i < value.length ? faults(schema, value[i], `${at}/${i}`) : [])),
  items: (schema, value, at, { prefixItems = [] }) =>
    value.slice(prefixItems.length).flatMap((item, i) => faults(schema, item, `${at}/${i + prefixItems.length}`)),
  oneOf: (list, value, at) => {
    const found = list.map((schema) => faults(schema, value, at));
    const count = found.filter((one) => !one.length).length;
    return count === 1 ? [] : [`${at}: ${count} of oneOf fit`, ...found.flat()];
  },
  allOf: (list, value, at) => list.flatMap((schema) => faults(schema, value, at)),
  if: (schema, value, at, whole) =>
    (faults(schema, value, at).length ? [] : faults(whole.then ?? {}, value, at)),
  then: () => [],
  $ref: (ref, value, at) =>
    faults(ref.split('/').slice(1).reduce((schema, name) => schema[name], root), value, at),
  ...Object.fromEntries(['$schema', 'title', 'description', 'default', '$defs'].map((name) => [name, () => []])),
};

function faults(schema, value, at) {
  // What has another type has no further faults: keywords rely on it.
  if (schema.type && !hasType(value, schema.type)) return KEYWORDS.type(schema.type, value, at);
  return Object.entries(schema).flatMap(([keyword, of]) => {
    if (!KEYWORDS[keyword]) throw new Error(`unknown keyword ${keyword}`);
    return KEYWORDS[keyword](of, value, at, schema);
  });
}

console.log(JSON.stringify(faults(root, JSON.parse(readFileSync(file, 'utf8')), '')));
