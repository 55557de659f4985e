// Operations of a log, made from places that were clicked. No DOM.
import { surfacePlace } from './limbs.js';
import { add, cross, distance, dot, frameAround, lerp, scaled, unit } from './vectors.js';

/** Blades are added where the surface leaves the line between two others by this share of their
 * depth, or where they turn by more than 40 degrees: a tear refuses 90. */
const LARGEST_SAG = 0.2;
const LEAST_COSINE = 0.76;
const MOST_HALVINGS = 6;

/** Corners of the bounds of a plane through three points. */
const DISC_CORNERS = 24;

/** A place that was clicked: {position, normal, eye}, all in model space. */
const outward = (click, direction) => (direction === 'view'
  ? unit(add(click.eye, click.position, -1)) : click.normal);

/** Height over a place at which nothing else is in the way. */
const heightOver = (surface, position, direction, wanted) =>
  Math.min(wanted, surface.freeDistance(position, direction, 2 * wanted) / 2);

function blade(surface, { position, direction }, settings) {
  const height = heightOver(surface, position, direction, settings.height);
  return { base: add(position, direction, height), tip: add(position, direction, -settings.depth) };
}

/** Places between two of a stroke, where the surface is not straight; without the ends. */
function placesBetween(surface, a, b, depth, halvings) {
  const direction = unit(add(a.direction, b.direction));
  const middle = lerp(a.position, b.position, 0.5);
  const reach = Math.max(depth, distance(a.position, b.position) / 2);
  const position = surface.nearestOnLine(middle, direction, reach) ?? middle;
  const isStraight = distance(position, middle) < LARGEST_SAG * depth &&
    dot(a.direction, b.direction) > LEAST_COSINE;
  if (isStraight || halvings === 0) return [];
  const place = { position, direction };
  return [...placesBetween(surface, a, place, depth, halvings - 1), place,
    ...placesBetween(surface, place, b, depth, halvings - 1)];
}

function withWeights(operation, settings) {
  return settings.weights ? { ...operation, weights: { policy: settings.weights } } : operation;
}

/**
 * A tear through all places. Throws a text if the blades turn too sharply.
 * @param surface  PosedSurface; @param settings  of settings.js
 */
export function makeTear(clicks, settings, pose, surface) {
  const places = clicks.map((click) =>
    ({ position: click.position, direction: outward(click, settings.direction) }));
  const all = places.flatMap((place, i) => (i === 0 ? [place] : [
    ...placesBetween(surface, places[i - 1], place, settings.depth, MOST_HALVINGS), place]));
  if (all.some((place, i) => i > 0 && dot(place.direction, all[i - 1].direction) < 0.1))
    throw new Error('The surface turns too sharply between two points: click closer ones, or choose the line of sight.');
  return withWeights({ op: 'tear', pose, width: settings.width, layers: settings.layers,
    wall_depth: settings.wallDepth, stroke: all.map((place) => blade(surface, place, settings)) },
  settings);
}

/** A cut through two places in the line of sight, or through three. Throws a text if they do not say a plane. */
export function makeCut(clicks, settings, pose) {
  const [a, b, c] = clicks.map(({ position }) => position);
  const { eye } = clicks[1];
  const third = settings.by === 'sight' ? eye : c;
  const across = cross(add(b, a, -1), add(third, a, -1));
  if (!(Math.hypot(...across) > 1e-9 * distance(a, b) * distance(a, third)))
    throw new Error('These places lie on one line: they do not say a plane.');
  const normal = unit(across);
  const cut = { op: 'cut', pose, plane: { point: a, normal } };
  if (settings.bounds === 'points')
    cut.bounds = settings.by === 'sight' ? sightBounds(a, b, eye, settings)
      : discAround([a, b, c], normal);
  return withWeights({ ...cut, caps: settings.caps }, settings);
}

/** From over the surface to below it, between two lines of sight. */
function sightBounds(a, b, eye, { height, depth }) {
  const [toEyeA, toEyeB] = [a, b].map((place) => unit(add(eye, place, -1)));
  return [add(a, toEyeA, height), add(b, toEyeB, height), add(b, toEyeB, -depth),
    add(a, toEyeA, -depth)];
}

function discAround(places, normal) {
  const centre = scaled(places.reduce((sum, place) => add(sum, place)), 1 / places.length);
  const radius = Math.max(...places.map((place) => distance(place, centre))) /
    Math.cos(Math.PI / DISC_CORNERS) * 1.02;
  const [right, up] = frameAround(normal);
  return Array.from({ length: DISC_CORNERS }, (_, i) => {
    const angle = (2 * Math.PI * i) / DISC_CORNERS;
    return add(add(centre, right, radius * Math.cos(angle)), up, radius * Math.sin(angle));
  });
}

/** A bore into the surface at a place. */
export function makeBore([click], settings, pose, surface) {
  const direction = outward(click, settings.direction);
  const height = heightOver(surface, click.position, direction,
    Math.max(settings.height, 1.5 * settings.radius));
  return withWeights({ op: 'drill', pose,
    axis: { origin: add(click.position, direction, height), direction: scaled(direction, -1) },
    radius: settings.radius, depth: height + settings.depth, wall: settings.wall }, settings);
}

/** What is aimed at the limb under a click. Throws a text where no bone moves the place. */
export function makeAimed([click], settings, pose, surface, rig) {
  const place = rig.limbs.placeOf(click, rig.bones);
  if (!place) throw new Error('No bone moves this place.');
  const { what, length, turn, radius, through } = settings;
  const at = place.at === undefined ? {} : { at: place.at };
  const from = unit(add(click.eye, click.position, -1)).map((x) => Number(x.toFixed(6)));
  const operation = {
    sever: () => ({ op: 'sever', bone: place.bone, ...at, pose }),
    slash: () => ({ op: 'slash', around: place.bone, ...at, from, length: { widths: length }, turn, pose }),
    puncture: () => ({ op: 'puncture', around: place.bone, ...at, from, radius: { widths: radius },
      through, pose }),
  }[what]();
  return withWeights(operation, settings);
}

/** A stroke along the surface through all places, which are places of its triangles. */
export function makeIncision(clicks, settings, pose, surface) {
  return withWeights({ op: 'incision', pose, depth: settings.depth, width: settings.width,
    layers: settings.layers, wall_depth: settings.wallDepth,
    points: clicks.map((click) => surfacePlace(surface.model, click)) }, settings);
}

/** The polygon that shows a cut: its bounds on its plane, or a square of a size around a centre. */
export function cutPolygon({ plane, bounds }, centre, size) {
  const normal = unit(plane.normal);
  const onPlane = (point) => add(point, normal, dot(add(plane.point, point, -1), normal));
  if (bounds) return bounds.map(onPlane);
  const [right, up] = frameAround(normal);
  const middle = onPlane(centre);
  return [[-1, -1], [1, -1], [1, 1], [-1, 1]].map(([x, y]) =>
    add(add(middle, right, x * size), up, y * size));
}
