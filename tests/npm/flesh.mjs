// Opens GLB files in three.js, looks into their wounds, and counts what is seen there: flesh, or the background.
//   node flesh.mjs [--pictures FOLDER] [--at SHARE] FILE...
// --at: share of the first clip at which the models stand, 0 to 1; without it, the pose of the file's nodes.
// Prints one line of JSON per file: a list of wounds.
import { readFile, writeFile } from 'node:fs/promises';
import { createServer } from 'node:http';
import { basename, dirname, join, normalize } from 'node:path';
import { fileURLToPath } from 'node:url';
import { launch } from './browser.mjs';

const MODULES = join(dirname(fileURLToPath(import.meta.url)), 'node_modules');
const TYPES = { '.js': 'text/javascript', '.glb': 'model/gltf-binary', '.html': 'text/html' };

const PAGE = `<!doctype html><script type="importmap">{"imports": {"three": "/three/build/three.module.js"}}</script>
<script type="module">
import * as THREE from 'three';
import { GLTFLoader } from '/three/examples/jsm/loaders/GLTFLoader.js';

const SIZE = 320, PICTURE = 640;
const BACKGROUND = 0x0000ff, FLESH = 0xff0000, OTHER = 0x00ff00;
const renderer = new THREE.WebGLRenderer({ preserveDrawingBuffer: true, antialias: false });
renderer.outputColorSpace = THREE.SRGBColorSpace;

/** Wounds: connected faces of walls, with where they are and where they look. */
function woundsOf(meshes) {
  const wounds = [];
  for (const mesh of meshes) {
    const index = mesh.geometry.index;
    const places = new Map();
    const place = (vertex) => {
      if (!places.has(vertex))
        places.set(vertex, mesh.getVertexPosition(vertex, new THREE.Vector3()).applyMatrix4(mesh.matrixWorld));
      return places.get(vertex);
    };
    const parent = new Map();
    const root = (v) => {
      while (parent.get(v) !== v) v = parent.get(v);
      return v;
    };
    for (let i = 0; i < index.count; ++i) if (!parent.has(index.getX(i))) parent.set(index.getX(i), index.getX(i));
    for (let i = 0; i < index.count; i += 3)
      for (const k of [1, 2]) parent.set(root(index.getX(i + k)), root(index.getX(i)));
    const of = new Map();
    for (let i = 0; i < index.count; i += 3) {
      const [a, b, c] = [0, 1, 2].map((k) => place(index.getX(i + k)));
      const wound = of.get(root(index.getX(i))) ?? { box: new THREE.Box3(), normal: new THREE.Vector3() };
      of.set(root(index.getX(i)), wound);
      for (const corner of [a, b, c]) wound.box.expandByPoint(corner);
      wound.normal.add(b.clone().sub(a).cross(c.clone().sub(a)));
    }
    wounds.push(...of.values());
  }
  return wounds.sort((a, b) => b.normal.length() - a.normal.length());
}

function cameraOf(wound) {
  const centre = wound.box.getCenter(new THREE.Vector3());
  const radius = 0.5 * wound.box.getSize(new THREE.Vector3()).length();
  const half = 1.2 * radius;
  const camera = new THREE.OrthographicCamera(-half, half, half, -half, 0, 1e3 * radius);
  const towards = wound.normal.clone().normalize();
  if (Math.abs(towards.y) > 0.9) camera.up.set(0, 0, 1);
  camera.position.copy(centre).addScaledVector(towards, 2 * radius);
  camera.lookAt(centre);
  camera.updateMatrixWorld();
  return camera;
}

/** What each pixel shows: 0 background, 1 walls of wounds, 2 anything else. */
function kinds(scene, camera, walls) {
  const meshes = [];
  scene.traverse((object) => object.isMesh && meshes.push([object, object.material]));
  for (const [mesh, material] of meshes)
    mesh.material = new THREE.MeshBasicMaterial({ color: walls.includes(mesh) ? FLESH : OTHER, side: material.side });
  renderer.setSize(SIZE, SIZE, false);
  renderer.setClearColor(BACKGROUND);
  scene.background = null;
  renderer.render(scene, camera);
  const gl = renderer.getContext(), pixels = new Uint8Array(4 * SIZE * SIZE);
  gl.readPixels(0, 0, SIZE, SIZE, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
  for (const [mesh, material] of meshes) mesh.material = material;
  return Array.from({ length: SIZE * SIZE }, (_, i) => pixels[4 * i] > 127 ? 1 : pixels[4 * i + 1] > 127 ? 2 : 0);
}

/** Pixels of the background that one sees through the surface: they do not reach the border of the picture. */
function enclosed(seen) {
  const outside = new Uint8Array(seen.length), open = [];
  const visit = (i) => {
    if (seen[i] !== 0 || outside[i]) return;
    outside[i] = 1;
    open.push(i);
  };
  for (let i = 0; i < SIZE; ++i)
    for (const border of [i, (SIZE - 1) * SIZE + i, i * SIZE, i * SIZE + SIZE - 1]) visit(border);
  while (open.length > 0) {
    const i = open.pop();
    for (const [next, is] of [[i - 1, i % SIZE > 0], [i + 1, i % SIZE < SIZE - 1],
      [i - SIZE, i >= SIZE], [i + SIZE, i < SIZE * (SIZE - 1)]])
      if (is) visit(next);
  }
  return seen.map((kind, i) => kind === 0 && !outside[i]);
}

function picture(scene, camera) {
  renderer.setSize(PICTURE, PICTURE, false);
  renderer.setClearColor(0x9cc8f0);  // The sky.
  const lights = [new THREE.HemisphereLight(0xffffff, 0x888888, 1.5), new THREE.DirectionalLight(0xffffff, 2.5)];
  lights[1].position.copy(camera.position).add(new THREE.Vector3(-1, 2, 1).multiplyScalar(camera.top));
  const ahead = camera.getWorldDirection(new THREE.Vector3());
  lights[1].target.position.copy(camera.position).addScaledVector(ahead, camera.top);
  scene.add(...lights, lights[1].target);
  renderer.render(scene, camera);
  scene.remove(...lights, lights[1].target);
  return renderer.domElement.toDataURL('image/png');
}

globalThis.look = async (url, { share, wantsPictures, most, material }) => {
  const { scene: model, animations } = await new GLTFLoader().loadAsync(url);
  const scene = new THREE.Scene();
  scene.add(model);
  if (share !== null && animations.length > 0) {
    const mixer = new THREE.AnimationMixer(model);
    mixer.clipAction(animations[0]).setLoop(THREE.LoopOnce).play();
    mixer.setTime(share * 0.999 * animations[0].duration);
  }
  scene.updateMatrixWorld(true);
  // Walls have a material of their own, or are named as such.
  const isWall = (of) => of.material.name === material || of.geometry.userData.name === material;
  const walls = [], opened = [];
  scene.traverse((object) => {
    if (!object.isMesh) return;
    object.frustumCulled = false;  // Its bounds are those of the rest pose.
    if (isWall(object)) walls.push(object);
    const target = object.morphTargetDictionary?.Open;
    if (target !== undefined) opened.push([object, target]);
  });
  const wounds = woundsOf(walls), all = [];
  for (const wound of wounds.slice(0, most)) {
    const camera = cameraOf(wound);
    const seen = kinds(scene, camera, walls);
    for (const mesh of walls) mesh.visible = false;
    const hollow = kinds(scene, camera, walls);
    for (const mesh of walls) mesh.visible = true;
    const weights = opened.map(([mesh, target]) => mesh.morphTargetInfluences[target]);
    for (const [mesh, target] of opened) mesh.morphTargetInfluences[target] = 0;
    const closed = kinds(scene, camera, walls);
    opened.forEach(([mesh, target], i) => { mesh.morphTargetInfluences[target] = weights[i]; });
    // What the closed surface covers, and the open one does not.
    const uncovered = (of) => {
      const holes = enclosed(of);
      return of.filter((_, i) => holes[i] && closed[i] !== 0).length / of.length;
    };
    all.push({
      flesh: seen.filter((kind) => kind === 1).length / seen.length,
      background: uncovered(seen),
      hollow: uncovered(hollow),  // If there were no flesh.
      fleshWhenClosed: closed.filter((kind) => kind === 1).length / seen.length,
      picture: wantsPictures ? picture(scene, camera) : undefined,
    });
  }
  const materials = new Set();
  scene.traverse((object) => object.isMesh && materials.add(object.material.name));
  return { wounds: all, count: wounds.length, targets: opened.length, materials: [...materials] };
};
globalThis.isReady = true;
</script>`;

const files = [], options = { share: null, wantsPictures: false, most: 4, material: 'Wound' };
let folder = '';
for (let i = 2; i < process.argv.length; ++i) {
  const [name, value] = [process.argv[i], process.argv[i + 1]];
  if (name === '--pictures') [folder, options.wantsPictures] = [value, true];
  else if (name === '--at') options.share = Number(value);
  else if (name === '--most') options.most = Number(value);
  else if (name === '--material') options.material = value;
  else files.push(name);
  if (name.startsWith('--')) ++i;
}

// Modules are not loaded from files.
const server = createServer(async (request, response) => {
  const url = new URL(request.url, 'http://localhost');
  try {
    const model = /^\/model\/(\d+)\.glb$/.exec(url.pathname);
    const bytes = url.pathname === '/' ? Buffer.from(PAGE)
      : await readFile(model ? files[Number(model[1])] : join(MODULES, normalize(url.pathname)));
    const type = url.pathname === '/' ? TYPES['.html'] : TYPES[/\.\w+$/.exec(url.pathname)[0]];
    response.writeHead(200, { 'Content-Type': type }).end(bytes);
  } catch {
    response.writeHead(404).end();
  }
});
await new Promise((resolve) => { server.listen(0, '127.0.0.1', resolve); });
const browser = await launch();
try {
  const page = await browser.newPage();
  page.on('pageerror', (error) => console.error(String(error)));
  await page.goto(`http://127.0.0.1:${server.address().port}/`);
  await page.waitForFunction('globalThis.isReady');
  for (let i = 0; i < files.length; ++i) {
    const found = await page.evaluate((url, how) => globalThis.look(url, how), `/model/${i}.glb`, options);
    for (const [w, wound] of found.wounds.entries()) {
      if (wound.picture)
        await writeFile(join(folder, `${basename(files[i], '.glb')}_${w}.png`),
          Buffer.from(wound.picture.split(',')[1], 'base64'));
      delete wound.picture;
    }
    console.log(JSON.stringify({ file: basename(files[i]), ...found }));
  }
} finally {
  await browser.close();
  server.close();
}
