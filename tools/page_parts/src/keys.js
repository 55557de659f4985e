// Keys of the page; lists and numbers keep what is typed, and what space or Enter activates keeps these.
// Without three.js, because the studio brings its own.

const ACTIVATED = 'button, summary, input[type=checkbox], input[type=radio]';

function turn({ camera, controls }, right, up) {
  const offset = camera.position.clone().sub(controls.target);
  const side = camera.up.clone().cross(offset).normalize();
  offset.applyAxisAngle(camera.up, right);
  const height = offset.angleTo(camera.up) - up;
  if (height > 0.05 && height < Math.PI - 0.05) offset.applyAxisAngle(side, -up);
  camera.position.copy(controls.target).add(offset);
  controls.update();
}

function zoom({ camera, controls }, factor) {
  camera.position.sub(controls.target).multiplyScalar(factor).add(controls.target);
  controls.update();
}

/** While the canvas has the focus. */
const ON_CANVAS = {
  ArrowLeft: (stage) => turn(stage, -0.12, 0), ArrowRight: (stage) => turn(stage, 0.12, 0),
  ArrowUp: (stage) => turn(stage, 0, 0.1), ArrowDown: (stage) => turn(stage, 0, -0.1),
  '+': (stage) => zoom(stage, 0.9), '=': (stage) => zoom(stage, 0.9), '-': (stage) => zoom(stage, 1.1),
};

/** @param stage  {camera, controls}, of three.js; @param actions  {key: function} */
export function listenToKeys(canvas, stage, actions) {
  addEventListener('keydown', (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const { target } = event;
    if (document.querySelector('dialog[open]')) return;
    if (target.matches('select, input[type=number]')) return;
    if ((event.key === ' ' || event.key === 'Enter') && target.matches(ACTIVATED)) return;
    const key = event.key.length === 1 ? event.key.toLowerCase() : event.key;
    const action = (target === canvas && ON_CANVAS[key]) || actions[key];
    if (!action) return;
    event.preventDefault();
    action(stage);
  });
}
