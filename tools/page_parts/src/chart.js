// Series over the time of a clip, above the slider of the time.
import { setText, svg } from './elements.js';
import { quantity } from './format.js';

const WIDTH = 1000, HEIGHT = 64;

function path(series, duration, top) {
  return Array.from(series.times, (time, i) => {
    const x = (time / duration) * WIDTH;
    const y = HEIGHT - (series.values[i] / top) * (HEIGHT - 4);
    return `${i ? 'L' : 'M'}${x.toFixed(1)} ${y.toFixed(2)}`;
  }).join('');
}

const mostOf = (series) => series.values.reduce((a, b) => Math.max(a, b), 0);

function titleOf(list) {
  const limits = list.filter((series) => series.threshold)
    .map((series) => `, threshold ${quantity(series.threshold, series.unit)}`);
  return list.map((series) => `${series.name} up to ${quantity(mostOf(series), series.unit)}`)
    .join(', ') + limits.join('');
}

/**
 * Draws the series of a clip, or nothing; the first one has an area and its threshold. Returns
 * what says the time: f(seconds).
 */
export function drawChart(holder, title, list, clip) {
  setText(title, titleOf(list));
  holder.replaceChildren();
  holder.hidden = !list.length || !clip || !(clip.duration > 0);
  if (holder.hidden) return () => {};
  const [series, ...others] = list;
  const top = Math.max(...list.map(mostOf), series.threshold ?? 0) * 1.08 || 1;
  const line = path(series, clip.duration, top);
  const cursor = svg('line', { class: 'cursor', y1: 0, y2: HEIGHT });
  const children = [
    svg('path', { class: 'area', d: `${line}V${HEIGHT}H0Z` }),
    svg('path', { class: 'line', d: line }),
    ...others.map((other) => svg('path', { class: 'line other', d: path(other, clip.duration, top) })),
  ];
  if (series.threshold) {
    const y = HEIGHT - (series.threshold / top) * (HEIGHT - 4);
    children.push(svg('line', { class: 'threshold', x1: 0, x2: WIDTH, y1: y, y2: y }));
  }
  holder.append(svg('svg', { viewBox: `0 0 ${WIDTH} ${HEIGHT}`, preserveAspectRatio: 'none' },
    ...children, cursor));
  return (time) => {
    const x = (time / clip.duration) * WIDTH;
    cursor.setAttribute('x1', x);
    cursor.setAttribute('x2', x);
  };
}

/** The value of a series at a time. */
export function valueAt(series, time) {
  const { times, values } = series;
  const after = times.findIndex((other) => other >= time);
  if (after <= 0) return values[after === 0 ? 0 : values.length - 1];
  const t = (time - times[after - 1]) / (times[after] - times[after - 1]);
  return (1 - t) * values[after - 1] + t * values[after];
}
