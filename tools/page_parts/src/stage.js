// The picture: one camera and up to two viewports side by side, each with what it shows.
import { Color, LinearSRGBColorSpace, MathUtils, PerspectiveCamera, Scene, Vector3, WebGLRenderer }
  from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';

const FLIGHT_SECONDS = 0.45;

/** The share of a viewport that "Fit" fills. */
const FILLED = 0.84;
const prefersStillness = matchMedia('(prefers-reduced-motion: reduce)');

export class Stage {
  constructor(canvas) {
    this.canvas = canvas;
    this.renderer = new WebGLRenderer({ canvas, antialias: true, preserveDrawingBuffer: true });
    this.renderer.outputColorSpace = LinearSRGBColorSpace;  // colours are given as displayed
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.renderer.setScissorTest(true);
    this.scene = new Scene();
    this.background = new Color();
    this.camera = new PerspectiveCamera(32, 1, 0.01, 100);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.addEventListener('change', () => this.requestFrame());
    this.controls.addEventListener('start', () => {
      this.flight = null;
    });
    this.views = [];
    this.flight = null;
    this.beforeFrame = () => {};
    this.afterFrame = () => {};
    this.isRequested = false;
    new ResizeObserver(() => this.resize()).observe(canvas.parentElement);
  }

  /** @param views  per viewport, from left to right, the objects that it shows. */
  setViews(views) {
    this.views = views;
    this.scene.clear();
    this.scene.add(...new Set(views.flat()));
    this.resize();
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.canvas.parentElement;
    if (!width || !height || !this.views.length) return;
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / this.views.length / height;
    this.camera.updateProjectionMatrix();
    this.requestFrame();
  }

  requestFrame() {
    if (this.isRequested) return;
    this.isRequested = true;
    requestAnimationFrame((now) => {
      this.isRequested = false;
      this.beforeFrame(now / 1000);
      this.fly(now / 1000);
      this.draw();
      this.afterFrame();
    });
  }

  draw() {
    const { clientWidth: width, clientHeight: height } = this.canvas.parentElement;
    const objects = new Set(this.views.flat());
    const shown = new Map([...objects].map((object) => [object, object.visible]));
    this.views.forEach((view, i) => {
      const area = [(i * width) / this.views.length, 0, width / this.views.length, height];
      this.renderer.setViewport(...area);
      this.renderer.setScissor(...area);
      this.renderer.setClearColor(this.background);
      for (const object of objects) object.visible = shown.get(object) && view.includes(object);
      this.renderer.render(this.scene, this.camera);
    });
    for (const object of objects) object.visible = shown.get(object);
  }

  /** Sets the distances at which things are cut off, by the size of what is shown. */
  setSize(radius) {
    this.camera.near = radius / 200;
    this.camera.far = radius * 40;
    this.controls.minDistance = radius / 50;
    this.controls.maxDistance = radius * 12;
    this.camera.updateProjectionMatrix();
  }

  /** Moves the camera so that all points fill its view. @param points  3 numbers per point */
  fit(points, towardsEye = [0.34, 0.16, 1]) {
    const z = new Vector3(...towardsEye).normalize();
    const x = new Vector3().crossVectors(this.camera.up, z).normalize();
    const y = new Vector3().crossVectors(z, x);
    const point = new Vector3();
    const seen = [];
    for (let i = 0; i < points.length; i += 3) {
      point.fromArray(points, i);
      seen.push([point.dot(x), point.dot(y), point.dot(z)]);
    }
    const middle = [0, 1, 2].map((k) => {
      const [least, most] = seen.reduce(
        ([low, high], p) => [Math.min(low, p[k]), Math.max(high, p[k])], [Infinity, -Infinity]);
      return (least + most) / 2;
    });
    const tall = Math.tan(MathUtils.degToRad(this.camera.fov / 2)) * FILLED;
    const wide = tall * this.camera.aspect;
    const distance = seen.reduce((most, p) => Math.max(most,
      p[2] - middle[2] + Math.max(Math.abs(p[0] - middle[0]) / wide,
        Math.abs(p[1] - middle[1]) / tall)), 0);
    const target = new Vector3().addScaledVector(x, middle[0]).addScaledVector(y, middle[1])
      .addScaledVector(z, middle[2]);
    this.goTo(target, z, distance);
  }

  /** Moves the camera so that it looks at a point from a direction. */
  goTo(target, direction, distance) {
    const toTarget = new Vector3(...target);
    const toEye = new Vector3(...direction).normalize().multiplyScalar(distance).add(toTarget);
    const first = this.camera.position.length() === 0;
    this.flight = {
      start: null, seconds: first || prefersStillness.matches ? 0 : FLIGHT_SECONDS,
      fromEye: this.camera.position.clone(), fromTarget: this.controls.target.clone(),
      toEye, toTarget,
    };
    this.requestFrame();
  }

  fly(now) {
    if (!this.flight) return;
    const { flight } = this;
    flight.start ??= now;
    const t = flight.seconds ? Math.min((now - flight.start) / flight.seconds, 1) : 1;
    const eased = t * t * (3 - 2 * t);
    this.camera.position.lerpVectors(flight.fromEye, flight.toEye, eased);
    this.controls.target.lerpVectors(flight.fromTarget, flight.toTarget, eased);
    if (t === 1) this.flight = null;
    this.controls.update();
    if (this.flight) this.requestFrame();
  }

  /** The viewport under a place of the canvas, and the ray from the eye through it. */
  rayAt(x, y) {
    const { clientWidth: width, clientHeight: height } = this.canvas.parentElement;
    const share = width / this.views.length;
    const view = Math.min(Math.floor(x / share), this.views.length - 1);
    const point = new Vector3(((x - view * share) / share) * 2 - 1, 1 - (y / height) * 2, 0.5)
      .unproject(this.camera);
    const origin = this.camera.position;
    return { view, origin: origin.toArray(), direction: point.sub(origin).normalize().toArray() };
  }

  /** Where a point appears in a viewport, in pixels of the canvas; null behind the eye. */
  placeOf(position, view) {
    const { clientWidth: width, clientHeight: height } = this.canvas.parentElement;
    const share = width / this.views.length;
    const seen = new Vector3(...position).project(this.camera);
    if (seen.z > 1 || Math.abs(seen.x) > 1 || Math.abs(seen.y) > 1) return null;
    return [view * share + ((seen.x + 1) / 2) * share, ((1 - seen.y) / 2) * height];
  }
}
