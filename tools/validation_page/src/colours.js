// Colour scales. Sequential: viridis, whose lightness is linear. Signed: purple to orange, neutral in
// the middle. Both can be told apart by people with colour vision deficiencies.
import { rgb } from 'd3-color';
import { interpolatePuOr, interpolateViridis } from 'd3-scale-chromatic';

const STEPS = 256;

/** Above the scale; in the picture also hatched. */
export const BEYOND = '#ff2e93';

/** Range of a logarithmic scale: top / LOG_RANGE is its lower end. */
const LOG_RANGE = 1e4;

function table(interpolate) {
  const bytes = new Uint8Array(STEPS * 4);
  for (let i = 0; i < STEPS; ++i) {
    const { r, g, b } = rgb(interpolate(i / (STEPS - 1)));
    bytes.set([r, g, b, 255], i * 4);
  }
  return bytes;
}

export const RAMPS = {
  sequential: table(interpolateViridis),
  signed: table((t) => interpolatePuOr(1 - t)),
};

/** What turns values into places on a ramp. */
export class Scale {
  constructor({ top, log = false, signed = false }) {
    this.top = top;
    this.log = log && !signed;
    this.signed = signed;
    this.bottom = signed ? -top : this.log ? top / LOG_RANGE : 0;
  }

  get ramp() {
    return this.signed ? RAMPS.signed : RAMPS.sequential;
  }

  /** 0 at the bottom, 1 at the top; beyond them outside of [0, 1]. */
  fraction(value) {
    if (!this.log) return (value - this.bottom) / (this.top - this.bottom || 1);
    return value > 0 ? Math.log(value / this.bottom) / Math.log(LOG_RANGE) : -1;
  }

  value(fraction) {
    return this.log
      ? this.bottom * LOG_RANGE ** fraction
      : this.bottom + fraction * (this.top - this.bottom);
  }

  css(fraction) {
    if (fraction > 1 + 1e-6 || (this.signed && fraction < -1e-6)) return BEYOND;
    const i = Math.round(Math.min(Math.max(fraction, 0), 1) * (STEPS - 1)) * 4;
    return `rgb(${this.ramp[i]}, ${this.ramp[i + 1]}, ${this.ramp[i + 2]})`;
  }

  /** Values worth a label. */
  ticks() {
    if (this.log) return [0, 1, 2, 3, 4].map((decade) => this.bottom * 10 ** decade);
    return [0, 0.25, 0.5, 0.75, 1].map((fraction) => this.value(fraction));
  }
}
