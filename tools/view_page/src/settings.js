// What a tool can be told: fields of a form, and their values.
import { html } from '../../page_parts/src/elements.js';

const DIRECTION = { name: 'direction', label: 'Direction',
  choices: { normal: 'along the normal', view: 'line of sight' } };
const WEIGHTS = { name: 'weights', label: 'New weights', choices: { '': 'as sunder tear is told',
  barycentric: 'barycentric', pose_exact: 'exact in this pose', refit: 'refit over poses',
  exact: 'exact in every pose' } };
const length = (name, label, share, least = 0) => ({ name, label: `${label}, m`, share, least });

/** Lengths are shares of the model's diagonal at first. A function says when a field counts. */
const FIELDS = {
  look: [],
  tear: [DIRECTION, length('depth', 'Depth', 0.03, 1e-9), length('width', 'Gap width', 0),
    { name: 'layers', label: 'Layers', choices: { nearest: 'nearest', all: 'all that it meets' } },
    length('wallDepth', 'Wall depth', 0), WEIGHTS],
  cut: [{ name: 'by', label: 'Plane by',
    choices: { sight: 'two points and sight', points: 'three points' } },
  { name: 'bounds', label: 'Reach', choices: { none: 'whole plane', points: 'between the points' } },
  { ...length('depth', 'Depth', 0.2, 1e-9),
    counts: ({ by, bounds }) => by === 'sight' && bounds === 'points' },
  { name: 'caps', label: 'Close sections', isFlag: true }, WEIGHTS],
  limb: [{ name: 'what', label: 'Operation', choices: { slash: 'slash the limb',
    sever: 'sever the limb', puncture: 'puncture the limb' } },
  { name: 'length', label: 'Length, widths of the limb', first: 0.6, least: 1e-3,
    counts: ({ what }) => what === 'slash' },
  { name: 'turn', label: 'Turn, degrees', first: 0, least: -360, counts: ({ what }) => what === 'slash' },
  { name: 'radius', label: 'Radius, widths of the limb', first: 0.1, least: 1e-3,
    counts: ({ what }) => what === 'puncture' },
  { name: 'through', label: 'Through the limb', isFlag: true,
    counts: ({ what }) => what === 'puncture' }, WEIGHTS],
  incision: [length('depth', 'Depth', 0.005, 1e-9), length('width', 'Gap width', 0),
    { name: 'layers', label: 'Layers', choices: { nearest: 'nearest', all: 'all that it meets' } },
    length('wallDepth', 'Wall depth', 0), WEIGHTS],
  drill: [DIRECTION, length('radius', 'Radius', 0.015, 1e-9), length('depth', 'Depth', 0.1, 1e-9),
    { name: 'wall', label: 'Line the bore', isFlag: true }, WEIGHTS],
};

/** Three digits: a start value is no measurement. */
const rounded = (value) => Number(value.toPrecision(3));

export class Settings {
  /** @param diagonal  of the model, metres; @param onChange  () */
  constructor(holder, diagonal, onChange) {
    Object.assign(this, { holder, diagonal, onChange });
    this.values = {};
    for (const [tool, fields] of Object.entries(FIELDS))
      this.values[tool] = Object.fromEntries(fields.map((field) => [field.name, this.first(field)]));
  }

  first({ choices, share, isFlag, first }) {
    if (choices) return Object.keys(choices)[0];
    if (first !== undefined) return first;
    return isFlag ? false : rounded(share * this.diagonal);
  }

  show(tool) {
    this.tool = tool;
    this.rows = FIELDS[tool].map((field) => this.row(field));
    this.holder.replaceChildren(...this.rows);
    this.update();
  }

  row(field) {
    const id = `setting-${field.name}`;
    const input = this.input(field, id);
    return html('div', {}, html('label', { for: id }, field.label), input);
  }

  input(field, id) {
    const values = this.values[this.tool];
    const changed = (event) => {
      const { target } = event;
      if (!target.validity.valid || target.value === '' && !field.choices) return;
      values[field.name] = field.isFlag ? target.checked
        : field.choices ? target.value : Number(target.value);
      this.update();
      this.onChange();
    };
    if (field.choices) {
      const select = html('select', { id, onchange: changed },
        ...Object.entries(field.choices).map(([value, text]) => html('option', { value }, text)));
      select.value = values[field.name];
      return select;
    }
    if (field.isFlag)
      return html('input', { id, type: 'checkbox', checked: values[field.name], onchange: changed });
    return html('input', { id, type: 'number', step: 'any', min: field.least, max: 1e6, required: true,
      value: values[field.name], oninput: changed });
  }

  update() {
    const fields = FIELDS[this.tool];
    fields.forEach(({ counts }, i) => {
      this.rows[i].hidden = Boolean(counts && !counts(this.values[this.tool]));
    });
  }

  /** The values of the tool, and how high over the surface a blade begins. */
  get current() {
    return { ...this.values[this.tool], height: 0.02 * this.diagonal };
  }
}
