// The page in a headset: a session of WebXR, a scalpel in each hand, and the read-out on a board.
import * as THREE from 'three';
import { Scalpel } from './scalpel.js';

const BOARD = { width: 512, height: 448, metres: 0.5 };

/** The figures of a frame and what was said, drawn where a headset sees them. */
class Board {
  #context = Object.assign(document.createElement('canvas'), BOARD).getContext('2d');
  #shown = '';
  constructor() {
    this.texture = new THREE.CanvasTexture(this.#context.canvas);
    this.texture.colorSpace = THREE.SRGBColorSpace;
    this.drawn = new THREE.Mesh(new THREE.PlaneGeometry(BOARD.metres, BOARD.metres * BOARD.height / BOARD.width),
      new THREE.MeshBasicMaterial({ map: this.texture, transparent: true }));
    this.drawn.position.set(0.62, 1.5, -0.9);
    this.drawn.rotation.y = -0.5;
  }
  /** @param lines  pairs of a name and a value, or of a text and nothing */
  show(lines) {
    const known = lines.flat().join('\n');
    if (known === this.#shown) return;
    this.#shown = known;
    const context = this.#context;
    context.clearRect(0, 0, BOARD.width, BOARD.height);
    context.fillStyle = '#1e2126e0';
    context.fillRect(0, 0, BOARD.width, BOARD.height);
    context.fillStyle = '#e9eaee';
    context.font = '22px system-ui, sans-serif';
    lines.forEach(([name, value], i) => {
      const y = 34 + 31 * i;
      context.textAlign = 'left';
      context.fillText(name, 18, y, value ? 320 : BOARD.width - 36);
      context.textAlign = 'right';
      context.fillText(value, BOARD.width - 18, y, 170);
    });
    this.texture.needsUpdate = true;
  }
  dispose() {
    this.drawn.removeFromParent();
    this.drawn.geometry.dispose();
    this.drawn.material.dispose();
    this.texture.dispose();
  }
}

export class Headset {
  #stage;
  #studio;
  #board = null;

  constructor(stage, studio) {
    this.#stage = stage;
    this.#studio = studio;
  }

  static async isThere() { return await navigator.xr?.isSessionSupported('immersive-vr').catch(() => false) ?? false; }

  get session() { return this.#stage.renderer.xr.getSession(); }

  /** @param onEnd  gets called when the session is over, whoever ends it */
  async enter(onEnd) {
    const session = await navigator.xr.requestSession('immersive-vr', { optionalFeatures: ['local-floor'] });
    const { renderer } = this.#stage;
    session.addEventListener('end', () => {
      this.#leave();
      onEnd();
    });
    // Before the session is set, because three tells controllers then that they are connected.
    this.#studio.hands = [0, 1].map((i) => new Scalpel(renderer.xr.getController(i), this.#studio));
    this.#board = new Board();
    this.#stage.enterRoom([this.#board.drawn, ...this.#studio.hands.map(({ controller }) => controller)]);
    try {
      await renderer.xr.setSession(session);
    } catch (error) {
      await session.end();
      throw error;
    }
  }

  #leave() {
    for (const hand of this.#studio.hands) hand.dispose();
    this.#studio.hands = [];
    this.#board.dispose();
    this.#board = null;
    this.#stage.leaveRoom();
  }

  /** Once per frame. @param lines  of the read-out */
  show(lines) { this.#board?.show(lines); }
}
