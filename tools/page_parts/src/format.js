// Numbers with units, as people read them. No DOM.

const LENGTHS = [[1, 'm'], [1e-3, 'mm'], [1e-6, 'µm'], [1e-9, 'nm']];

function digits(value) {
  if (value === 0) return '0';
  const size = Math.abs(value);
  if (size >= 1e6 || size < 1e-3) return value.toExponential(1).replace('e+', 'e').replace('e-', 'e−');
  if (size >= 100) return Math.round(value).toString();
  return Number(value.toPrecision(3)).toString();
}

/** With a minus sign in place of the hyphen. */
const signed = (text) => text.replace('-', '−');

/** "2.31 mm", "42 %", "17". */
export function quantity(value, unit) {
  if (value === null || value === undefined || Number.isNaN(value)) return 'no value';
  if (!Number.isFinite(value)) return 'unbounded';
  if (unit === 'share') return signed(`${digits(value * 100)} %`);
  if (unit === 'count') return signed(value.toLocaleString('en'));
  if (!unit) return signed(digits(value));
  if (unit !== 'm' || value === 0) return signed(`${digits(value)} ${unit}`);
  const [size, name] = LENGTHS.find(([length]) => Math.abs(value) >= length) ?? LENGTHS.at(-1);
  return signed(`${digits(value / size)} ${name}`);
}

/** "1 error", "2 errors". */
export function plural(count, word) {
  return `${count.toLocaleString('en')} ${word}${count === 1 ? '' : 's'}`;
}

/** The smallest of 1, 1.5, 2, 3, 4, 5, 6, 8 times a power of ten that is not below a value. */
export function niceTop(value) {
  if (!(value > 0)) return 1;
  const power = 10 ** Math.floor(Math.log10(value));
  return [1, 1.5, 2, 3, 4, 5, 6, 8, 10].find((step) => step * power >= value * (1 - 1e-6)) * power;
}
