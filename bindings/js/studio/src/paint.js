// Regions that are painted on a character: factors of its tissue, one per vertex of its file, kept as attributes of its meshes.
/** In the order of the page's list. */
export const FIELDS = ['strength', 'toughness', 'stiffness', 'tension', 'thickness'];
const LEAST = 1e-3, MOST = 1e3;
/** By which `sunder tear --tissue-field tension=attribute:_TENSION` and sample_field() read what was painted. */
export const attributeOf = (field) => `_${field.toUpperCase()}`;
const isFactor = (field, value) => value >= (field === 'tension' ? 0 : LEAST) && value <= MOST;

/** The fields that the attributes of a model's meshes are: { mesh, field, values }. Attributes that hold something else are left out. */
export function fieldsIn(model) {
  const fields = [];
  for (let mesh = 0; mesh < model.meshCount; ++mesh)
    for (const { name, components, values } of model.mesh(mesh).attributes) {
      const field = FIELDS.find((one) => attributeOf(one) === name);
      if (field && components === 1 && values.every((value) => isFactor(field, value))) fields.push({ mesh, field, values: values.slice() });
    }
  return fields;
}

/** `fields` with one in place of that of the same mesh and name. */
export const withField = (fields, changed) => [...fields.filter(({ mesh, field }) => mesh !== changed.mesh || field !== changed.field), changed];

/** What `withAttributes()` takes of them. */
export const attributesOf = (fields) => fields.map(({ mesh, field, values }) => ({ mesh, name: attributeOf(field), values }));

/** The factors of a torn mesh, one per vertex: those of new vertices are the library's. */
export function factorsOf(instance, mesh, field) {
  const source = instance.source(mesh), found = source.attributes.find(({ name, components }) => name === attributeOf(field) && components === 1);
  return found && found.values.every((value) => isFactor(field, value)) ? found.values.slice() : new Float32Array(source.vertexCount).fill(1);
}

/** One stroke of the brush: however often it passes a vertex, that gets the factor once. */
export class PaintStroke {
  #actor;
  #brush;
  #settings;
  /** By mesh: { before, values, covered } per vertex of the torn mesh. */
  #meshes = new Map();
  #last = null;

  /** @param settings  { field, factor, radius }: metres @param brush  a Brush */
  constructor(actor, brush, settings) {
    this.#actor = actor;
    this.#brush = brush;
    this.#settings = settings;
  }
  get field() { return this.#settings.field; }
  /** Of the torn mesh, as far as painted; null where the stroke was not. */
  values(mesh) { return this.#meshes.get(mesh)?.values ?? null; }

  /** Paints from the place before, if that is on the same mesh, to a hit. */
  to(hit) {
    const { instance } = this.#actor, { field, factor, radius } = this.#settings, { mesh } = hit;
    const last = this.#last?.mesh === mesh ? this.#last : hit;
    this.#last = hit;
    if (!this.#meshes.has(mesh)) {
      const before = factorsOf(instance, mesh, field);
      this.#meshes.set(mesh, { before, values: before.slice(), covered: new Float32Array(before.length) });
    }
    const { before, values, covered } = this.#meshes.get(mesh);
    for (const [vertex, share] of this.#brush.under(instance, mesh, [last, hit], radius)) {
      if (vertex >= covered.length || share <= covered[vertex]) continue;
      covered[vertex] = share;
      values[vertex] = before[vertex] + share * (factor - before[vertex]);
    }
  }

  /** @returns { fields, text }: all fields with what was painted, of the vertices of the file */
  end() {
    const { model, fields } = this.#actor, { field, factor } = this.#settings;
    let all = fields, count = 0;
    for (const [mesh, { values, covered }] of this.#meshes) {
      const length = model.mesh(mesh).vertexCount;
      count += covered.subarray(0, length).filter((share) => share > 0).length;
      all = withField(all, { mesh, field, values: values.slice(0, length) });
    }
    return { fields: all, text: `${field} × ${factor} on ${count} vertices` };
  }
}
