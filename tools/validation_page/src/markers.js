// Signs over the picture at the places of a finding, and a ring around the chosen one.
import { html, severitySign } from '../../page_parts/src/elements.js';

export class Markers {
  /** @param poseOf  (place) -> {position, normal} in the current pose */
  constructor(holder, stage, poseOf) {
    this.holder = holder;
    this.stage = stage;
    this.poseOf = poseOf;
    this.signs = [];
    this.ring = html('div', { class: 'ring', hidden: true });
    holder.append(this.ring);
  }

  /** @param onClick  (number of the place) */
  show(places, severity, onClick) {
    for (const { element } of this.signs) element.remove();
    this.signs = places.map((place, i) => {
      const element = html('button', { class: 'marker', tabindex: -1, 'aria-hidden': 'true',
        onclick: () => onClick(i) }, severitySign(severity, i + 1));
      return { place, element };
    });
    this.holder.append(...this.signs.map(({ element }) => element).reverse());
    this.stage.requestFrame();
  }

  /** @param place  or null; @param label  beside the ring */
  choose(place, label = '') {
    this.chosen = place;
    this.ring.dataset.label = label;
    this.stage.requestFrame();
  }

  /** Moves all signs to where their places are now. @param view  the viewport of the target */
  follow(view) {
    for (const { place, element } of this.signs) this.put(element, place, view);
    if (this.chosen) this.put(this.ring, this.chosen, view);
    else this.ring.hidden = true;
  }

  put(element, place, view) {
    const { position, normal } = this.poseOf(place);
    const seen = this.stage.placeOf(position, view);
    element.hidden = seen === null;
    if (!seen) return;
    element.style.transform = `translate(${seen[0].toFixed(1)}px, ${seen[1].toFixed(1)}px)`;
    const eye = this.stage.camera.position;
    const facing = normal ? normal[0] * (eye.x - position[0]) + normal[1] * (eye.y - position[1]) +
      normal[2] * (eye.z - position[2]) : 1;
    element.classList.toggle('behind', facing < 0);
  }
}
