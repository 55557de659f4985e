// The inside of a character that was opened: dark flesh, where three would draw nothing.
import * as THREE from 'three';

const DARK_FLESH = new THREE.Color(0x3b0d0b);

/** Of the materials that show one side. Until it is shown, they are drawn as the file says. */
export class Inside {
  #materials;
  #isShown = false;

  /** @param materials  of a character's skin */
  constructor(materials) {
    this.#materials = [...new Set(materials)].filter(({ side, transparent }) => side === THREE.FrontSide && !transparent);
    for (const material of this.#materials) {
      material.shadowSide = THREE.BackSide;  // as three casts the shadow of a front side
      material.onBeforeCompile = (shader) => {
        const { r, g, b } = DARK_FLESH;
        shader.fragmentShader = shader.fragmentShader.replace('#include <color_fragment>',
          `#include <color_fragment>\n  if (!gl_FrontFacing) diffuseColor.rgb = vec3(${[r, g, b].map((value) => value.toFixed(4))});`);
      };
    }
  }
  get isShown() { return this.#isShown; }
  set isShown(shown) {
    if (shown === this.#isShown) return;
    this.#isShown = shown;
    for (const material of this.#materials) {
      material.side = shown ? THREE.DoubleSide : THREE.FrontSide;
      material.needsUpdate = true;
    }
  }
}
