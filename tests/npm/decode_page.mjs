// Prints what the page makes of its data: arrays, influences, and posed positions. No browser.
// Usage: node decode_page.mjs <data> <clip> <time>
import { readFileSync } from 'node:fs';
import { bytesOf, decode, influencesOf } from '../../tools/page_parts/src/decode.js';
import { modelFromBone, sampleClip } from '../../tools/page_parts/src/pose.js';
import { poseOf, posePositions } from '../../tools/page_parts/src/skin.js';

const [file, clip, time] = process.argv.slice(2);
const data = decode(bytesOf(readFileSync(file, 'latin1')));
const sampled = sampleClip(data, data.clips[clip], Number(time));
const ofClip = modelFromBone(data, sampled.parts);

function describe(model) {
  const posed = (bones, morphWeights) =>
    Array.from(posePositions(model, poseOf(model, bones, morphWeights)));
  return {
    title: model.title,
    meshes: model.meshes,
    bones: model.bones,
    positions: Array.from(model.positions),
    normals: Array.from(model.smoothNormals),
    indices: Array.from(model.indices),
    influences: Array.from({ length: model.vertexCount }, (_, v) => influencesOf(model, v)),
    posed_by_clip: posed(ofClip, sampled.morphWeights),
    posed: data.poses.map((pose) => posed(pose.matrices, data.skeleton.morph_weights)),
  };
}

console.log(JSON.stringify({
  source: describe(data.source),
  target: describe(data.target),
  // JSON has no NaN.
  arrays: data.arrays.map(({ values, ...rest }) => ({
    ...rest, values: Array.from(values, (value) => (Number.isNaN(value) ? null : value)),
  })),
  series: data.series.map(({ times, values, ...rest }) =>
    ({ ...rest, times: Array.from(times), values: Array.from(values) })),
  findings: data.findings,
}));
