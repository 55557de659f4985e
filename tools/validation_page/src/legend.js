// The legend of the heat map: a histogram above the colours, with ticks and the threshold.
import { BEYOND } from './colours.js';
import { html, svg } from '../../page_parts/src/elements.js';
import { quantity } from '../../page_parts/src/format.js';

const WIDTH = 340, BINS = 68, BARS = 62, RAMP = 14, BEYOND_WIDTH = 22, GAP = 6;
const RAMP_WIDTH = WIDTH - BEYOND_WIDTH - GAP;

function counts(shown, scale) {
  const bins = new Uint32Array(BINS);
  let beyond = 0;
  for (const value of shown.target) {
    if (Number.isNaN(value)) continue;
    const fraction = scale.fraction(value);
    if (fraction > 1 + 1e-6 || (scale.signed && fraction < -1e-6)) ++beyond;
    else ++bins[Math.min(Math.max(Math.floor(fraction * BINS), 0), BINS - 1)];
  }
  return { bins, beyond };
}

function bars({ bins, beyond }, scale) {
  const most = Math.log1p(Math.max(beyond, ...bins));
  const height = (count) => (count ? 3 + ((BARS - 3) * Math.log1p(count)) / (most || 1) : 0);
  const bar = (x, width, count, fill, label) => svg('rect', {
    x, width, y: BARS - height(count), height: height(count), fill,
  }, svg('title', {}, label));
  const width = RAMP_WIDTH / BINS;
  return [
    ...Array.from(bins, (count, i) => bar(i * width, width - 0.8, count,
      scale.css((i + 0.5) / BINS), `${count} vertices`)),
    bar(RAMP_WIDTH + GAP, BEYOND_WIDTH, beyond, BEYOND, `${beyond} beyond the scale`),
  ];
}

function rampStops(scale) {
  return Array.from({ length: 33 }, (_, i) =>
    svg('stop', { offset: i / 32, 'stop-color': scale.css(i / 32) }));
}

function thresholdMark(value, shown, scale) {
  const fraction = scale.fraction(value);
  if (!(fraction >= 0 && fraction <= 1)) return [];
  const x = fraction * RAMP_WIDTH;
  const end = x > RAMP_WIDTH * 0.6;
  return [
    svg('line', { class: 'threshold', x1: x, x2: x, y1: 0, y2: BARS + RAMP }),
    svg('text', { class: 'threshold', x: end ? x - 5 : x + 5, y: 10,
      'text-anchor': end ? 'end' : 'start' }, `threshold ${quantity(value, shown.unit)}`),
  ];
}

function ticks(shown, scale) {
  const values = scale.ticks();
  return values.map((value, i) => svg('text', {
    x: scale.fraction(value) * RAMP_WIDTH, y: BARS + RAMP + 15,
    'text-anchor': i === 0 ? 'start' : i === values.length - 1 ? 'end' : 'middle',
  }, value === 0 ? '0' : quantity(value, shown.unit)));
}

/** Draws the legend into a figure. */
export function drawLegend(figure, shown, scale) {
  const counted = counts(shown, scale);
  const thresholds = shown.threshold
    ? (shown.signed ? [-shown.threshold, shown.threshold] : [shown.threshold]) : [];
  const picture = svg('svg', { viewBox: `0 0 ${WIDTH} ${BARS + RAMP + 20}`, role: 'img',
    'aria-label': `Histogram and colours: ${shown.name}` },
  svg('defs', {},
    svg('linearGradient', { id: 'ramp' }, ...rampStops(scale)),
    svg('pattern', { id: 'hatch', width: 6, height: 6, patternUnits: 'userSpaceOnUse',
      patternTransform: 'rotate(45)' },
    svg('rect', { width: 6, height: 6, fill: BEYOND }),
    svg('rect', { width: 3, height: 6, fill: '#000', 'fill-opacity': 0.28 }))),
  ...bars(counted, scale),
  svg('rect', { x: 0, y: BARS, width: RAMP_WIDTH, height: RAMP, fill: 'url(#ramp)', class: 'ramp' }),
  svg('rect', { x: RAMP_WIDTH + GAP, y: BARS, width: BEYOND_WIDTH, height: RAMP,
    fill: 'url(#hatch)' }),
  ...thresholds.flatMap((value) => thresholdMark(value, shown, scale)),
  ...ticks(shown, scale),
  svg('text', { x: WIDTH - BEYOND_WIDTH / 2, y: BARS + RAMP + 15, 'text-anchor': 'middle' }, '>'));
  figure.replaceChildren(picture, html('figcaption', {}, caption(shown, counted.beyond)));
}

function caption(shown, beyond) {
  const above = shown.threshold
    ? shown.target.reduce((n, value) => n + (Math.abs(value) > shown.threshold), 0) : 0;
  const parts = [`${shown.target.length.toLocaleString('en')} vertices, heights logarithmic`];
  if (shown.threshold) parts.push(`${above.toLocaleString('en')} above the threshold`);
  if (beyond) parts.push(`${beyond.toLocaleString('en')} beyond the scale`);
  return `${parts.join(' · ')}.`;
}
