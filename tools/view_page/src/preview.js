// Where operations would open the posed surface, as line segments. No DOM. Strokes, planes and bores
// are cut exactly, but without snapping; for limbs it is what the page can tell without the library.
import { boneOf } from './limbs.js';
import { add, cross, distance, dot, frameAround, lerp, scaled, unit } from './vectors.js';

const BORE_SIDES = 32;
const SLASH_PLACES = 33;

const heights = (corners, { point, normal }) =>
  corners.map((corner) => dot(add(corner, point, -1), normal));

/** Where a triangle meets a plane: two places, or null. */
function chord(corners, plane) {
  const height = heights(corners, plane);
  const ends = [];
  for (const [i, j] of [[0, 1], [1, 2], [2, 0]])
    if ((height[i] > 0) !== (height[j] > 0))
      ends.push(lerp(corners[i], corners[j], height[i] / (height[i] - height[j])));
  return ends.length === 2 ? ends : null;
}

/** The part of a segment inside a convex polygon of the same plane; or null. */
function clipped([from, to], polygon, normal) {
  const centre = scaled(polygon.reduce((sum, corner) => add(sum, corner)), 1 / polygon.length);
  let [least, most] = [0, 1];
  for (const [i, corner] of polygon.entries()) {
    let inward = cross(normal, add(polygon[(i + 1) % polygon.length], corner, -1));
    if (dot(inward, add(centre, corner, -1)) < 0) inward = scaled(inward, -1);
    const [a, b] = [from, to].map((end) => dot(inward, add(end, corner, -1)));
    if (a < 0 && b < 0) return null;
    if (a >= 0 && b >= 0) continue;
    const t = a / (a - b);
    if (a < 0) least = Math.max(least, t);
    else most = Math.min(most, t);
  }
  return least < most ? [lerp(from, to, least), lerp(from, to, most)] : null;
}

/** Calls visit(corners, triangle) for the triangles of a surface. */
function forTriangles({ model, positions }, visit) {
  const { indices } = model;
  const at = (vertex) => [positions[3 * vertex], positions[3 * vertex + 1], positions[3 * vertex + 2]];
  for (let i = 0; i < indices.length; i += 3)
    visit([at(indices[i]), at(indices[i + 1]), at(indices[i + 2])], i / 3);
}

/** The box around points: [least, most]. */
const boxOf = (points) => [Math.min, Math.max].map((extreme) =>
  [0, 1, 2].map((k) => extreme(...points.map((point) => point[k]))));

const overlap = ([least, most], [otherLeast, otherMost]) =>
  [0, 1, 2].every((k) => least[k] <= otherMost[k] && otherLeast[k] <= most[k]);

/** Where polygons with their planes meet a surface. @param counts  (triangle) -> whether it is met */
function sections(surface, polygons, counts = () => true) {
  const segments = [];
  const isBounded = polygons.length > 0 && polygons.every(({ polygon }) => polygon);
  const box = isBounded && boxOf(polygons.flatMap(({ polygon }) => polygon));
  forTriangles(surface, (corners, triangle) => {
    if (box && !overlap(box, boxOf(corners))) return;
    for (const { plane, polygon } of polygons) {
      const ends = chord(corners, plane);
      if (!ends || !counts(triangle)) continue;
      const inside = polygon ? clipped(ends, polygon, plane.normal) : ends;
      if (inside) segments.push(inside);
    }
  });
  return segments;
}

/** A flat piece of a sweep. */
function flat(polygon) {
  const normal = cross(add(polygon[1], polygon[0], -1), add(polygon[2], polygon[0], -1));
  return Math.hypot(...normal) > 0 ? [{ plane: { point: polygon[0], normal: unit(normal) }, polygon }] : [];
}

/** The surface that a blade meets first hides those below it. */
function isFirst(surface, base, tip, place) {
  const way = unit(add(tip, base, -1));
  const start = add(place, way, -dot(add(place, base, -1), way));
  const reach = distance(start, place);
  return surface.freeDistance(start, way, 2 * reach) > reach * (1 - 1e-3);
}

function tearLines({ stroke, layers }, surface) {
  return stroke.slice(1).flatMap((blade, i) => {
    const before = stroke[i];
    const polygons = [...flat([before.base, before.tip, blade.base]),
      ...flat([before.tip, blade.tip, blade.base])];
    const found = sections(surface, polygons);
    return layers === 'all' ? found : found.filter(([from, to]) =>
      isFirst(surface, before.base, before.tip, lerp(from, to, 0.5)));
  });
}

function cutLines({ plane, bounds }, surface) {
  const normal = unit(plane.normal);
  const polygon = bounds?.map((corner) =>
    add(corner, normal, dot(add(plane.point, corner, -1), normal)));
  return sections(surface, [{ plane: { point: plane.point, normal }, polygon }]);
}

function drillLines({ axis, radius, depth }, surface) {
  const direction = unit(axis.direction);
  const [right, up] = frameAround(direction);
  const rim = Array.from({ length: BORE_SIDES }, (_, i) => {
    const angle = (2 * Math.PI * i) / BORE_SIDES;
    return add(add(axis.origin, right, radius * Math.cos(angle)), up, radius * Math.sin(angle));
  });
  return sections(surface, rim.flatMap((corner, i) => {
    const next = rim[(i + 1) % BORE_SIDES];
    return flat([corner, next, add(next, direction, depth), add(corner, direction, depth)]);
  }));
}

/** A limb where an operation is aimed at it: {place, direction, segments across it}; or null. */
function limbAt(name, at, surface, { limbs, bones }) {
  const bone = limbs.model.bones.indexOf(name);
  const segment = bone < 0 ? null : limbs.segment(bone, bones);
  if (!segment || limbs.model !== surface.model) return null;
  const place = lerp(segment.from, segment.to, at);
  const direction = unit(add(segment.to, segment.from, -1));
  const { indices } = surface.model;
  const counts = (triangle) => limbs.isBelow(boneOf(surface.model, {
    corners: [0, 1, 2].map((i) => indices[3 * triangle + i]), shares: [1, 1, 1] }), bone);
  return { bone, place, direction,
    across: sections(surface, [{ plane: { point: place, normal: direction } }], counts) };
}

function severLines({ bone, at = 0 }, surface, rig) {
  return limbAt(bone, at, surface, rig)?.across ?? [];
}

/** The middle and the width of a limb as it is seen, and the way across it. */
function seenLimb({ around, at = 0.5, from }, surface, rig) {
  const limb = limbAt(around, at, surface, rig);
  if (!limb || !limb.across.length || !Array.isArray(from)) return null;
  const view = unit(add(from, limb.direction, -dot(from, limb.direction)));
  const across = cross(limb.direction, view);
  const seen = limb.across.flat().map((place) => dot(add(place, limb.place, -1), across));
  const [least, most] = [Math.min(...seen), Math.max(...seen)];
  return { ...limb, view, across, width: most - least,
    middle: add(limb.place, across, (least + most) / 2) };
}

function slashLines(operation, surface, rig) {
  const limb = seenLimb(operation, surface, rig);
  if (!limb) return [];
  const length = (operation.length?.widths ?? 0.6) * limb.width;
  const turn = ((operation.turn ?? 0) * Math.PI) / 180;
  const way = add(scaled(limb.across, Math.cos(turn)), limb.direction, Math.sin(turn));
  const places = Array.from({ length: SLASH_PLACES }, (_, i) => {
    const offset = (i / (SLASH_PLACES - 1) - 0.5) * length;
    const start = add(add(limb.middle, way, offset), limb.view, 2 * limb.width);
    return surface.hit(start, scaled(limb.view, -1))?.position;
  });
  return places.slice(1).flatMap((place, i) => (place && places[i] ? [[places[i], place]] : []));
}

function punctureLines(operation, surface, rig) {
  const limb = seenLimb(operation, surface, rig);
  if (!limb) return [];
  const radius = (operation.radius?.widths ?? 0.1) * limb.width;
  const origin = add(limb.middle, limb.view, 2 * limb.width);
  const found = surface.hit(origin, scaled(limb.view, -1));
  const depth = operation.through ? 4 * limb.width : (found?.distance ?? 0) + limb.width / 2;
  return drillLines({ axis: { origin, direction: scaled(limb.view, -1) }, radius, depth }, surface);
}

function incisionLines({ points }, { model, positions }) {
  const places = points.map(({ mesh, triangle, barycentrics }) => {
    const { first_vertex: first } = model.meshes[mesh];
    let begin = 0;
    while (model.indices[3 * begin] < first) begin += 1;
    return [0, 1, 2].map((k) => barycentrics.reduce((sum, share, i) =>
      sum + share * positions[3 * model.indices[3 * (begin + triangle) + i] + k], 0));
  });
  return places.slice(1).map((place, i) => [places[i], place]);
}

const LINES = { tear: tearLines, cut: cutLines, drill: drillLines, slash: slashLines,
  sever: severLines, puncture: punctureLines, incision: incisionLines };

/**
 * The segments along which an operation would open a surface in its pose.
 * @param surface  PosedSurface of the source; @param rig  {limbs, bones} in that pose
 */
export const openedLines = (operation, surface, rig) =>
  LINES[operation.op]?.(operation, surface, rig) ?? [];
