// A torn character: node torn.mjs character.glb torn.glb
import { readFileSync, writeFileSync } from 'node:fs';
import { Sunder } from 'sunder-tear';

const character = (await Sunder.createScene()).spawn(await Sunder.load(readFileSync(process.argv[2])));
character.tear([[[0, 1.6, 1], [0, 1.6, 0]], [[0, 0.5, 1], [0, 0.5, 0]]], { width: 0.02, wallDepth: 0.1 });
const [result] = character.scene.update(1 / 60);
console.log(`${result.facesCrossed} faces crossed, ${result.length.toFixed(3)} m torn`);
writeFileSync(process.argv[3], character.toGLB());
