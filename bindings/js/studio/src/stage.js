// Camera, light and floor; the rays of pointers.
import * as THREE from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';

/** Of a character before somebody who stands. */
const IN_ROOM = { size: 1, place: new THREE.Vector3(0, 1.2, -0.6) };

export class Stage {
  #canvas;
  #raycaster = new THREE.Raycaster();
  #box = new THREE.Box3();
  #things = [];
  #lamp = new THREE.DirectionalLight(0xfff4e6, 2.2);
  #floor = new THREE.Mesh(new THREE.PlaneGeometry(1, 1), new THREE.ShadowMaterial({ opacity: 0.28 }));

  constructor(canvas) {
    this.#canvas = canvas;
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: true, alpha: true });
    this.renderer.shadowMap.enabled = true;
    this.camera = new THREE.PerspectiveCamera(35, 1, 0.01, 100);
    this.controls = new OrbitControls(this.camera, canvas);
    this.#lamp.castShadow = true;
    this.#lamp.shadow.mapSize.set(1024, 1024);
    this.#floor.rotation.x = -Math.PI / 2;
    this.#floor.receiveShadow = true;
    /** Characters, their parts, light and floor: what becomes small or large in a headset's room. */
    this.world = new THREE.Group().add(this.#lamp, this.#lamp.target, this.#floor);
    this.scene = new THREE.Scene().add(new THREE.HemisphereLight(0xffffff, 0x665548, 2), this.world);
    this.renderer.xr.enabled = true;
  }

  /** Looks at a box of the world, and puts the floor below it. */
  show(box) {
    this.#box = box;
    const centre = box.getCenter(new THREE.Vector3()), size = box.getSize(new THREE.Vector3()).length() || 1;
    this.camera.near = size / 200;
    this.camera.far = size * 20;
    this.camera.position.copy(centre).add(new THREE.Vector3(0.5, 0.25, 1.5).multiplyScalar(size));
    this.controls.target.copy(centre);
    this.#floor.position.set(centre.x, box.min.y, centre.z);
    this.#floor.scale.setScalar(12 * size);
    this.#lamp.position.copy(centre).add(new THREE.Vector3(-0.8, 1.6, 1.2).multiplyScalar(size));
    this.#lamp.target.position.copy(centre);
    this.#lamp.shadow.bias = -0.002;
    this.controls.update();
    if (this.#things.length) this.#standInRoom();
    else this.#lightUp(size);
  }
  /** @param reach  of what casts shadows, in metres of the scene */
  #lightUp(reach) {
    Object.assign(this.#lamp.shadow.camera, { left: -reach, right: reach, top: reach, bottom: -reach, near: reach / 10, far: 5 * reach });
    this.#lamp.shadow.camera.updateProjectionMatrix();
  }

  // ---- the room of a headset, whose scene is in metres from its floor ----

  /** @param things  that are in the room beside the world */
  enterRoom(things) {
    this.#things = things;
    this.scene.add(...things);
    this.scene.background = new THREE.Color(0x23262d);
    this.#standInRoom();
  }
  leaveRoom() {
    this.scene.remove(...this.#things);
    this.#things = [];
    this.scene.background = null;
    this.world.position.setScalar(0);
    this.world.scale.setScalar(1);
    this.show(this.#box);
  }
  /** The character before the user, as large as arms reach. */
  #standInRoom() {
    const size = this.#box.getSize(new THREE.Vector3()).length() || 1, scale = IN_ROOM.size / size;
    this.world.scale.setScalar(scale);
    this.world.position.copy(IN_ROOM.place).addScaledVector(this.#box.getCenter(new THREE.Vector3()), -scale);
    this.camera.near = 0.02;
    this.camera.far = 50;
    this.#lightUp(IN_ROOM.size);
  }

  get floorHeight() { return this.#floor.position.y; }

  /** The ray through a pointer. */
  ray({ clientX, clientY }) {
    const { left, top, width, height } = this.#canvas.getBoundingClientRect();
    this.#raycaster.setFromCamera(new THREE.Vector2(2 * (clientX - left) / width - 1, 1 - 2 * (clientY - top) / height), this.camera);
    return this.#raycaster.ray;
  }

  draw() {
    const { clientWidth: width, clientHeight: height } = this.#canvas.parentElement;
    const ratio = Math.min(devicePixelRatio, 2), size = this.renderer.getSize(new THREE.Vector2());
    if (!this.renderer.xr.isPresenting && (size.x !== width || size.y !== height || this.renderer.getPixelRatio() !== ratio)) {
      this.renderer.setPixelRatio(ratio);
      this.renderer.setSize(width, height, false);
      this.camera.aspect = width / Math.max(height, 1);
      this.camera.updateProjectionMatrix();
    }
    this.renderer.render(this.scene, this.camera);
  }
}
