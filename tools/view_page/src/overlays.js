// Operations and clicked points, drawn over the model.
import {
  BufferAttribute, BufferGeometry, CylinderGeometry, DoubleSide, Group, Mesh, MeshBasicMaterial,
  Points, PointsMaterial, Vector3,
} from 'three';
import { displayed, FatLines } from './fat_lines.js';
import { cutPolygon } from './operations.js';
import { add, unit } from './vectors.js';

const COLOURS = { tear: 0xe0731d, cut: 0x2f6fd0, drill: 0x8a3fd1 };
const POINT = 0x111111;
/** Where the surface would open. */
const OPENED = 0xd0142c;
/** Opacity of a sheet: chosen, in the pose that is shown, in another pose. */
const OPACITY = { chosen: 0.5, here: 0.24, elsewhere: 0.05 };

function sheet(points, triangles) {
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(Float32Array.from(points.flat()), 3));
  geometry.setIndex(triangles.flat());
  return geometry;
}

function lines(colour, segments) {
  const fat = new FatLines(segments.length, colour, 2.5);
  fat.setEnds(segments.flat(2));
  return fat.object;
}

const loop = (points) => points.map((point, i) => [point, points[(i + 1) % points.length]]);

/** The sheet that a tear's blades sweep. */
function tearParts({ stroke }) {
  const points = stroke.flatMap(({ base, tip }) => [base, tip]);
  const triangles = stroke.slice(1).flatMap((_, i) =>
    [[2 * i, 2 * i + 1, 2 * i + 2], [2 * i + 2, 2 * i + 1, 2 * i + 3]]);
  const segments = [...stroke.map(({ base, tip }) => [base, tip]),
    ...stroke.slice(1).map(({ base }, i) => [stroke[i].base, base])];
  return { geometry: sheet(points, triangles), segments };
}

function cutParts(operation, centre, size) {
  const polygon = cutPolygon(operation, centre, size);
  return { geometry: sheet(polygon, polygon.slice(2).map((_, i) => [0, i + 1, i + 2])),
    segments: loop(polygon) };
}

function drillParts({ axis, radius, depth }) {
  const geometry = new CylinderGeometry(radius, radius, depth, 32, 1, true);
  geometry.translate(0, depth / 2, 0);
  const direction = unit(axis.direction);
  const mesh = new Mesh(geometry);
  mesh.quaternion.setFromUnitVectors(new Vector3(0, 1, 0), new Vector3(...direction));
  mesh.position.set(...axis.origin);
  mesh.updateMatrix();
  geometry.applyMatrix4(mesh.matrix);
  const at = geometry.getAttribute('position');
  const rim = (first) => Array.from({ length: 32 }, (_, i) =>
    [at.getX(first + i), at.getY(first + i), at.getZ(first + i)]);
  return { geometry, segments: [...loop(rim(0)), ...loop(rim(33)),
    [axis.origin, add(axis.origin, direction, depth)]] };
}

export class Overlays {
  /** @param centre, size  of the model: how large a whole plane is drawn */
  constructor(centre, size) {
    Object.assign(this, { centre, size });
    this.group = new Group();
    this.shown = [];
    this.pending = new Group();
    this.pending.renderOrder = 3;
    this.opened = new Group();
  }

  get objects() {
    return [this.group, this.opened, this.pending];
  }

  /** @param segments  along which operations would open the surface that is shown */
  setOpened(segments) {
    release(this.opened);
    if (segments.length) this.opened.add(lines(OPENED, segments));
  }

  /** @param stateOf  (index) -> 'chosen', 'here' or 'elsewhere' */
  setOperations(operations, stateOf) {
    release(this.group);
    this.shown = operations.map((operation) => this.draw(operation));
    for (const object of this.shown) if (object) this.group.add(object);
    this.setStates(stateOf);
  }

  setStates(stateOf) {
    this.shown.forEach((object, i) => {
      if (!object) return;
      const opacity = OPACITY[stateOf(i)];
      const [surface, outline] = object.children;
      surface.material.opacity = opacity;
      outline.material.opacity = Math.min(1, 3 * opacity);
    });
  }

  draw(operation) {
    const parts = { tear: tearParts, cut: cutParts, drill: drillParts }[operation.op]
      ?.(operation, this.centre, this.size);
    if (!parts) return null;
    const colour = COLOURS[operation.op];
    const object = new Group();
    object.add(new Mesh(parts.geometry, new MeshBasicMaterial({ color: displayed(colour), side: DoubleSide,
      transparent: true,
      depthWrite: false })), lines(colour, parts.segments));
    object.children[1].material.transparent = true;
    return object;
  }

  /** Places that were clicked and are not an operation yet. */
  setPending(places) {
    release(this.pending);
    if (!places.length) return;
    const geometry = new BufferGeometry();
    geometry.setAttribute('position', new BufferAttribute(Float32Array.from(places.flat()), 3));
    const material = (color, size) =>
      new PointsMaterial({ color, size, sizeAttenuation: false, depthTest: false, transparent: true });
    this.pending.add(new Points(geometry, material(0xffffff, 11)), new Points(geometry, material(POINT, 7)));
    this.pending.children.forEach((points, i) => {
      points.renderOrder = 3 + i;
      points.frustumCulled = false;
    });
    if (places.length > 1)
      this.pending.add(lines(POINT, places.slice(1).map((place, i) => [places[i], place])));
  }
}

function release(group) {
  group.traverse(({ geometry, material }) => {
    geometry?.dispose();
    material?.dispose();
  });
  group.clear();
}
