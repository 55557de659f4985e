// What a drag does: each tool begins with a pointer, follows it and ends. Lengths of settings are shares of the size.
import * as THREE from 'three';

/** Along the line of sight, from above the surface to the depth below it. */
const bladeAt = (hit, depth) => {
  const along = (distance) => hit.at.clone().addScaledVector(hit.direction, distance);
  return { base: along(-depth), tip: along(depth) };
};
/** Between threads, as a share of the size. */
const THREAD_SPACING = 0.015;
const NO_WOUND = 'There is no wound without a gap';
const stopped = { move() {}, end() {} };

const blade = {
  name: 'Blade', hint: 'Drag over the surface: it tears below the pointer while it moves.', needsHit: true,
  begin({ actor, hit, settings, time }) {
    const depth = settings.depth * actor.size, stroke = actor.beginTear(bladeAt(hit, depth), settings);
    let last = time;
    return {
      move({ hit: next, time: now }) {
        if (!next || now <= last) return;
        last = now;
        stroke.extend(bladeAt(next, depth), now);
      },
      end() { stroke.end(); },
    };
  },
};

const plane = {
  name: 'Plane', hint: 'Draw a line across: the plane through it and your eye cuts everything behind it. Cuts are closed.', needsHit: false,
  begin({ actor, ray }) {
    const first = actor.object.localRay(ray);
    let second = null;
    return {
      move({ ray: next }) { second = actor.object.localRay(next); },
      end() {
        if (!second) return null;
        const normal = new THREE.Vector3().crossVectors(first.direction, second.direction);
        if (normal.length() < 0.01) return null;
        return actor.instance.cut({ point: first.origin, normal: normal.normalize(), caps: true });
      },
    };
  },
};

const bore = {
  name: 'Bore', hint: 'Click: a round hole along the line of sight.', needsHit: true,
  begin({ actor, hit, settings }) {
    const radius = settings.radius * actor.size, depth = settings.depth * actor.size;
    const origin = hit.at.clone().addScaledVector(hit.direction, -2 * radius);
    return { ...stopped, command: actor.instance.drill({ origin, direction: hit.direction, radius, depth: depth + 2 * radius }) };
  },
};

const pull = {
  name: 'Pull', hint: 'Drag the surface: tissue follows, springs back when you let go, and gives way if it is pulled too far.', needsHit: true,
  begin({ actor, hit, settings }) {
    const hold = actor.instance.hold(hit, hit.at), distance = hit.distance;
    return {
      move({ ray }) {
        const { origin, direction } = actor.object.localRay(ray);
        hold.move(origin.addScaledVector(direction, distance));
      },
      frame() { if (settings.givesWay) actor.instance.tearOverstretched({ metres: 0.01 * actor.size }); },
      end() { hold.release(); },
    };
  },
};

const takeOff = {
  name: 'Take off', hint: 'Click on a part that a cut has freed: it falls.', needsHit: true,
  begin({ actor, hit }) {
    return { ...stopped, command: actor.instance.detach({ mesh: hit.mesh, triangle: hit.triangle }) };
  },
};

/** Threads and a wound that heals need lips of one tear: a gap has lost what was between its own. */
const sew = {
  name: 'Sew', hint: 'Click on a wound: threads hold its lips together, one beside the other. Wounds with a gap cannot be sewn.', needsHit: true,
  begin({ actor, hit }) {
    return {
      ...stopped, command: actor.instance.suture({ places: [hit.at], spacing: THREAD_SPACING * actor.size }),
      says({ runs }) {
        if (runs === 0) return NO_WOUND;
        return `${actor.instance.threads.filter(({ left, right, isBroken }) => left && right && !isBroken).length} threads hold`;
      },
    };
  },
};

const heal = {
  name: 'Heal', hint: 'Click on a wound: it closes, and only a scar is left. Wounds with a gap cannot heal.', needsHit: true,
  begin({ actor, hit }) {
    return { ...stopped, command: actor.instance.weld({ places: [hit.at] }), says: ({ runs }) => (runs === 0 ? NO_WOUND : 'The wound is closed') };
  },
};

const paint = {
  name: 'Paint', hint: 'Drag over the surface: its tissue gets the factor of the chosen field, with a soft edge. Erase gives it the factor 1.', needsHit: true, paints: true,
  begin({ actor, hit, settings: { field, factor, radius, erases } }) {
    const stroke = actor.beginPaint({ field, factor: erases ? 1 : factor, radius });
    stroke.to(hit);
    return { stroke, move({ hit: next }) { if (next) stroke.to(next); }, end: () => stroke.end() };
  },
};

const turn = { name: 'Turn', hint: 'Drag to turn the character, scroll to zoom.', needsHit: false, begin: null };

/** In the order of their keys. */
export const tools = [turn, blade, plane, bore, pull, takeOff, sew, heal, paint];
