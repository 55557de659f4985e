// The skeleton: a line from each bone to its parent, drawn over the surface.
import { BufferAttribute, BufferGeometry, LineBasicMaterial, LineSegments, Points, PointsMaterial }
  from 'three';
import { NONE } from './decode.js';

export class BoneLines {
  constructor(parents) {
    this.parents = parents;
    this.lines = new LineSegments(new BufferGeometry(),
      new LineBasicMaterial({ vertexColors: true, depthTest: false, transparent: true }));
    this.heads = new Points(new BufferGeometry(),
      new PointsMaterial({ vertexColors: true, depthTest: false, transparent: true, size: 6,
        sizeAttenuation: false }));
    const attribute = (count) => new BufferAttribute(new Float32Array(count * 3), 3);
    for (const [object, count] of [[this.lines, parents.length * 2], [this.heads, parents.length]]) {
      object.geometry.setAttribute('position', attribute(count));
      object.geometry.setAttribute('color', attribute(count));
      object.frustumCulled = false;
      object.renderOrder = 2;
      object.visible = false;
    }
    this.select(NONE, [1, 1, 1], [1, 1, 1]);
  }

  get objects() {
    return [this.lines, this.heads];
  }

  show(isShown) {
    for (const object of this.objects) object.visible = isShown;
  }

  setPose(modelFromBone) {
    const lines = this.lines.geometry.getAttribute('position');
    const heads = this.heads.geometry.getAttribute('position');
    this.parents.forEach((parent, bone) => {
      const head = modelFromBone.subarray(bone * 12 + 9, bone * 12 + 12);
      const from = parent === NONE ? bone : parent;
      heads.array.set(head, bone * 3);
      lines.array.set(modelFromBone.subarray(from * 12 + 9, from * 12 + 12), bone * 6);
      lines.array.set(head, bone * 6 + 3);
    });
    lines.needsUpdate = heads.needsUpdate = true;
  }

  /** Draws one bone in another colour. */
  select(selected, colour, selectedColour) {
    const lines = this.lines.geometry.getAttribute('color');
    const heads = this.heads.geometry.getAttribute('color');
    this.parents.forEach((parent, bone) => {
      heads.array.set(bone === selected ? selectedColour : colour, bone * 3);
      const ofLine = parent === selected && selected !== NONE ? selectedColour : colour;
      lines.array.set(ofLine, bone * 6);
      lines.array.set(ofLine, bone * 6 + 3);
    });
    lines.needsUpdate = heads.needsUpdate = true;
  }
}
