// The adapter for three.js: posed like three poses, uploaded in ranges that suffice, drawn in groups that cover everything once.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { basename } from 'node:path';
import test from 'node:test';
import { AnimationMixer, Box3, Group, Raycaster, Vector3 } from 'three';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
import { Sunder } from 'sunder-tear';
import { SunderObject } from 'sunder-tear/three';
import { FRONT_STROKE, rigFile, rigNames, sharedRigs } from './support.mjs';

globalThis.self ??= globalThis;

async function character(file, options = { soft: false }) {
  const bytes = new Uint8Array(readFileSync(file));
  const gltf = await new GLTFLoader().parseAsync(bytes.slice().buffer, '');
  const model = await Sunder.load(bytes, options);
  const scene = await Sunder.createScene();
  const it = scene.spawn(model);
  return { gltf, model, scene, it, object: new SunderObject(it, { gltf }) };
}

/** Where three puts the vertices that triangles use, in the space of the scene. */
function threePositions(gltf) {
  const places = [], place = new Vector3();
  gltf.scene.updateMatrixWorld(true);
  gltf.scene.traverse((mesh) => {
    if (!mesh.isMesh) return;
    const { index, attributes } = mesh.geometry;
    const used = new Set(index ? index.array : attributes.position.array.keys());
    for (const vertex of used) if (vertex < attributes.position.count) places.push(mesh.getVertexPosition(vertex, place).applyMatrix4(mesh.matrixWorld).toArray());
  });
  return places;
}
function ownPositions(object) {
  const places = [];
  for (const { geometry } of object.children)
    for (const vertex of new Set(geometry.index.array)) places.push([0, 1, 2].map((k) => geometry.attributes.position.array[3 * vertex + k]));
  return places;
}

/** The largest distance of a place to the nearest of others. */
function farthest(places, others) {
  const sorted = [...others].sort((a, b) => a[0] - b[0]), xs = sorted.map(([x]) => x);
  let most = 0;
  for (const place of places) {
    let low = 0, high = xs.length;
    while (low < high) xs[(low + high) >> 1] < place[0] ? (low = ((low + high) >> 1) + 1) : (high = (low + high) >> 1);
    let best = Infinity;
    for (const step of [-1, 1])
      for (let i = step < 0 ? low - 1 : low; i >= 0 && i < xs.length && Math.abs(xs[i] - place[0]) < best; i += step)
        best = Math.min(best, Math.hypot(sorted[i][0] - place[0], sorted[i][1] - place[1], sorted[i][2] - place[2]));
    most = Math.max(most, best);
  }
  return most;
}

function assertSamePlaces(gltf, object, what) {
  const theirs = threePositions(gltf), ours = ownPositions(object);
  const diagonal = new Box3().setFromPoints(theirs.map((place) => new Vector3(...place))).getSize(new Vector3()).length();
  const distance = Math.max(farthest(theirs, ours), farthest(ours, theirs)) / diagonal;
  assert.ok(distance < 1e-5, `${what}: ${distance} of the diagonal`);
  return distance;
}

for (const file of [...rigNames.map(rigFile), ...sharedRigs]) {
  const name = basename(file);
  test(`${name} is posed as three poses it`, async (t) => {
    const { gltf, model, scene, it, object } = await character(file, { soft: false, maximumBytes: 1 << 28 });
    if (gltf.parser.json.meshes.some(({ primitives }) => primitives.some(({ attributes }) => 'JOINTS_1' in attributes)))
      return t.skip('three poses four influences only');
    const mixer = new AnimationMixer(gltf.scene);
    object.copyPose();
    scene.update(0);
    object.update();
    let most = assertSamePlaces(gltf, object, 'rest');
    for (const [i, clip] of gltf.animations.entries()) {
      mixer.stopAllAction();
      mixer.clipAction(clip).play();
      for (const share of [0.17, 0.61]) {
        mixer.setTime(share * clip.duration);
        object.copyPose();
        scene.update(0);
        object.update();
        most = Math.max(most, assertSamePlaces(gltf, object, `${clip.name} copied at ${share}`));
        it.play(i, { time: share * clip.duration });
        scene.update(0);
        object.update();
        most = Math.max(most, assertSamePlaces(gltf, object, `${clip.name} played at ${share}`));
        it.stop();
      }
    }
    t.diagnostic(`${model.meshCount} meshes, ${gltf.animations.length} clips: ${most.toExponential(1)} of the diagonal`);
  });
}

/** A GLB whose JSON was changed. */
function edited(glb, edit) {
  const view = new DataView(glb.buffer, glb.byteOffset, glb.length), length = view.getUint32(12, true);
  const json = JSON.parse(new TextDecoder().decode(glb.subarray(20, 20 + length)));
  edit(json);
  const text = new TextEncoder().encode(JSON.stringify(json)), padded = new Uint8Array(Math.ceil(text.length / 4) * 4).fill(0x20);
  padded.set(text);
  const rest = glb.subarray(20 + length), result = new Uint8Array(20 + padded.length + rest.length), header = new DataView(result.buffer);
  result.set(glb.subarray(0, 20));
  header.setUint32(8, result.length, true);
  header.setUint32(12, padded.length, true);
  result.set(padded, 20);
  result.set(rest, 20 + padded.length);
  return result;
}

test('copyPose() carries morph weights, of each mesh its own', async () => {
  const bytes = edited(new Uint8Array(readFileSync(rigFile('two_skins'))), ({ meshes }) => meshes.forEach((mesh, i) => {
    for (const primitive of mesh.primitives) primitive.targets = Array(i + 1).fill({ POSITION: primitive.attributes.POSITION });
    mesh.weights = Array(i + 1).fill(0.25);
  }));
  const gltf = await new GLTFLoader().parseAsync(bytes.slice().buffer, ''), model = await Sunder.load(bytes, { soft: false });
  const scene = await Sunder.createScene(), it = scene.spawn(model), object = new SunderObject(it, { gltf });
  assert.equal(model.morphWeightCount, 3);
  const meshes = gltf.scene.getObjectsByProperty('isMesh', true);
  for (const weights of [[0.25, 0.25, 0.25], [0, 0.5, -0.2], [1, 0, 0.7]]) {
    for (const { morphTargetInfluences: own } of meshes) own.length === 1 ? (own[0] = weights[0]) : own.splice(0, 2, weights[1], weights[2]);
    object.copyPose();
    scene.update(0);
    object.update();
    assertSamePlaces(gltf, object, String(weights));
  }
  assert.throws(() => it.setMatrices(it.matrices.slice(), [1, 2]), /2 morph weights; the model has 3/);
});

/** What a renderer's buffers hold: all at first, then only the ranges. */
class Uploads {
  #copies = new Map();
  bytes = 0;
  draw(object) {
    this.bytes = 0;
    for (const { geometry } of object.children) {
      for (const attribute of [geometry.index, ...Object.values(geometry.attributes)]) {
        const copy = this.#copies.get(attribute);
        if (!copy) {
          this.#copies.set(attribute, { array: attribute.array.slice(), version: attribute.version });
          this.bytes += attribute.array.byteLength;
        } else if (copy.version !== attribute.version) {
          copy.version = attribute.version;
          for (const { start, count } of attribute.updateRanges) {
            copy.array.set(attribute.array.subarray(start, start + count), start);
            this.bytes += 4 * count;
          }
        }
        attribute.clearUpdateRanges();
        assert.deepEqual(this.#copies.get(attribute).array, attribute.array);
      }
    }
  }
}

function assertDrawn(object) {
  object.children.forEach((mesh, i) => {
    const { geometry, material } = mesh, posed = object.instance.mesh(i), source = object.instance.source(i);
    assert.deepEqual(geometry.attributes.position.array.subarray(0, 3 * posed.vertexCount), posed.positions);
    source.uvSets.forEach((uvs, k) => assert.deepEqual(geometry.attributes[k ? `uv${k}` : 'uv'].array.subarray(0, 2 * posed.vertexCount), uvs));
    const ofSubmesh = source.submeshes.map(() => []);
    const name = (a, b, c) => { const least = Math.min(a, b, c); return (a === least ? [a, b, c] : b === least ? [b, c, a] : [c, a, b]).join(); };
    for (const { start, count, materialIndex } of geometry.groups) {
      assert.ok(material[materialIndex], `material ${materialIndex}`);
      for (let t = start; t < start + count; t += 3) {
        const [a, b, c] = geometry.index.array.subarray(t, t + 3);
        if (a !== b) ofSubmesh[materialIndex].push(name(a, b, c));
      }
    }
    const expected = source.submeshes.map(() => []);
    const { triangles, triangleSubmesh } = source;
    triangleSubmesh.forEach((submesh, t) => {
      const [a, b, c] = triangles.subarray(3 * t, 3 * t + 3);
      if (a !== b) expected[submesh].push(name(a, b, c));
    });
    assert.deepEqual(ofSubmesh.map((list) => list.sort()), expected.map((list) => list.sort()));
    const place = new Vector3();
    for (let v = 0; v < posed.vertexCount; ++v) {
      place.fromArray(posed.positions, 3 * v);
      assert.ok(geometry.boundingBox.containsPoint(place) && place.distanceTo(geometry.boundingSphere.center) <= geometry.boundingSphere.radius * (1 + 1e-6));
    }
  });
}

test('uploaded ranges suffice while a character plays, is torn, gapes and is undone', async () => {
  const { scene, it, object } = await character(rigFile('tube'), { tension: 10 });
  const uploads = new Uploads();
  it.play('Bend');
  const frame = () => {
    scene.update(1 / 60);
    object.update();
    uploads.draw(object);
  };
  frame();
  for (let i = 0; i < 6; ++i) {
    it.tear(FRONT_STROKE.map((position) => position.map(([x, y, z]) => [x + 0.12 * (i - 3), y, z])), { width: 0.01, wallDepth: 0.1 });
    frame();
    assertDrawn(object);
    for (let k = 0; k < 10; ++k) frame();
  }
  it.undo();
  frame();
  assertDrawn(object);
  it.stop();
  it.setTension(0);
  for (let i = 0; i < 1500 && it.tissue.isAwake; ++i) scene.update(1 / 60);
  frame();
  frame();
  assert.equal(object.uploadedBytes, 0, 'nothing is uploaded at rest');
  assert.equal(uploads.bytes, 0);
});

test('frames that are not drawn are made up for', async () => {
  const { scene, it, object } = await character(rigFile('tube'));
  const uploads = new Uploads();
  scene.update(0);
  object.update();
  uploads.draw(object);
  for (let i = 0; i < 4; ++i) {
    it.tear(FRONT_STROKE.map((position) => position.map(([x, y, z]) => [x + 0.1 * i, y, z])));
    scene.update(1 / 60);
    object.update();
  }
  uploads.draw(object);
  assertDrawn(object);
});

test('materials are those of the file, and walls are flesh', async () => {
  const { gltf, scene, it, object } = await character(rigFile('tube'));
  const materials = new Set(gltf.scene.getObjectsByProperty('isMesh', true).map(({ material }) => material));
  scene.update(0);
  object.update();
  assert.ok(object.children[0].material.every((material) => materials.has(material)));
  it.tear(FRONT_STROKE, { width: 0.02, wallDepth: 0.1 });
  scene.update(0);
  object.update();
  const { material, geometry } = object.children[0];
  assert.ok(material.includes(object.flesh));
  assert.ok(geometry.groups.some(({ materialIndex, count }) => material[materialIndex] === object.flesh && count > 0));
});

test('a Raycaster hits the posed surface where the library does', async () => {
  const { scene, it, object } = await character(rigFile('tube'));
  const parent = new Group();
  parent.position.set(1, 2, 3);
  parent.rotation.set(0.2, 0.4, 0.1);
  parent.scale.setScalar(2);
  parent.add(object);
  it.play('Bend');
  it.prepareToTear();
  scene.update(0.7);
  object.update();
  parent.updateMatrixWorld(true);
  const raycaster = new Raycaster(new Vector3(0, 0.7, 3).applyMatrix4(parent.matrixWorld), new Vector3(0.02, 0, -1).transformDirection(parent.matrixWorld));
  const [hit] = raycaster.intersectObject(object);
  const { origin, direction } = object.localRay(raycaster.ray);
  const contact = it.raycast(origin, direction);
  assert.ok(hit.point.distanceTo(new Vector3(...contact.place).applyMatrix4(parent.matrixWorld)) < 1e-5);
});
