// Time against path error, both logarithmic, as SVG.
const COLOURS = { Sunder: '#b3261e', Rapier: '#1f6fb2', Manifold: '#2e7d4f', 'three-bvh-csg': '#9a6a00' };
const WIDTH = 720, HEIGHT = 420, LEFT = 74, RIGHT = 170, TOP = 22, BOTTOM = 52;

export function chart(rows) {
  const shown = rows.filter((row) => !row.refused && row.pathMost !== null);
  const LEAST = 1e-9;  // where an error of zero is drawn
  const error = (row) => Math.max(LEAST, row.pathMost);
  const spread = (values) => [Math.floor(Math.log10(Math.min(...values))), Math.ceil(Math.log10(Math.max(...values)))];
  const [x0, x1] = spread(shown.map((row) => row.milliseconds)), [y0, y1] = spread(shown.map(error));
  const x = (value) => LEFT + ((Math.log10(value) - x0) / (x1 - x0)) * (WIDTH - LEFT - RIGHT);
  const y = (value) => HEIGHT - BOTTOM - ((Math.log10(value) - y0) / (y1 - y0)) * (HEIGHT - TOP - BOTTOM);
  const lines = [];
  for (let power = x0; power <= x1; ++power)
    lines.push(`<path class="grid" d="M${x(10 ** power)} ${TOP}V${HEIGHT - BOTTOM}"/><text x="${x(10 ** power)}" y="${HEIGHT - BOTTOM + 18}" text-anchor="middle">${Number((10 ** power).toPrecision(1))}</text>`);
  for (let power = y0; power <= y1; power += y1 - y0 > 6 ? 2 : 1)
    lines.push(`<path class="grid" d="M${LEFT} ${y(10 ** power)}H${WIDTH - RIGHT}"/><text x="${LEFT - 8}" y="${y(10 ** power) + 4}" text-anchor="end">1e${power}</text>`);
  const point = (row, px, py) => (row.kind === 'tear' ? `<circle cx="${px}" cy="${py}" r="5" fill="${COLOURS[row.peer]}"/>` :
    `<path d="M${px - 5} ${py - 5}h10v10h-10z" fill="none" stroke="${COLOURS[row.peer]}" stroke-width="2"/>`);
  const points = shown.map((row) => `<g><title>${row.peer}, ${row.mesh}</title>${point(row, x(row.milliseconds), y(error(row)))}</g>`);
  const legend = Object.entries(COLOURS).map(([peer, colour], i) => `<text x="${WIDTH - RIGHT + 20}" y="${TOP + 20 + 20 * i}" fill="${colour}">${peer}</text>`);
  return `<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 ${WIDTH} ${HEIGHT}" font-family="sans-serif" font-size="13">
<style>.grid{stroke:#888;stroke-opacity:.3}text{fill:#777}</style>
<rect width="${WIDTH}" height="${HEIGHT}" fill="#fff"/>
${[...lines, ...points, ...legend].join('\n').replaceAll('fill="#', 'style="fill:#').replace(/style="fill:(#\w+)"/g, 'style="fill:$1"')}
<text x="${(LEFT + WIDTH - RIGHT) / 2}" y="${HEIGHT - 12}" text-anchor="middle">milliseconds</text>
<text transform="translate(18 ${(TOP + HEIGHT - BOTTOM) / 2}) rotate(-90)" text-anchor="middle">largest path error, edge lengths</text>
<text x="${WIDTH - RIGHT + 20}" y="${TOP + 120}">dots: local tears</text><text x="${WIDTH - RIGHT + 20}" y="${TOP + 140}">squares: planes</text>
</svg>
`;
}
