// Line segments some pixels wide, a little in front of the surface on which they lie.
import { Color, LinearSRGBColorSpace } from 'three';
import { LineMaterial } from 'three/addons/lines/LineMaterial.js';
import { LineSegments2 } from 'three/addons/lines/LineSegments2.js';
import { LineSegmentsGeometry } from 'three/addons/lines/LineSegmentsGeometry.js';

/** A colour as it is displayed: the stage does not convert colours. */
export const displayed = (hex) => new Color().setHex(hex, LinearSRGBColorSpace);

export class FatLines {
  /** @param count  of segments; @param width  in pixels */
  constructor(count, colour, width) {
    const geometry = new LineSegmentsGeometry();
    geometry.setPositions(new Float32Array(count * 6));
    this.buffer = geometry.getAttribute('instanceStart').data;
    this.material = new LineMaterial({ color: displayed(colour), linewidth: width, polygonOffset: true,
      polygonOffsetFactor: -4, polygonOffsetUnits: -8 });
    this.object = new LineSegments2(geometry, this.material);
    this.object.frustumCulled = false;
    this.object.renderOrder = 1;
  }

  /** @param ends  six numbers per segment */
  setEnds(ends) {
    this.buffer.array.set(ends);
    this.buffer.needsUpdate = true;
  }
}
