// Cutters of meshes on npm beside ours, in one process on the same meshes.
// Usage: node run.mjs [--summary] [--write] [--quick]   --write: into docs/peers.md and its picture
import { readFileSync, writeFileSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { chart } from './chart.mjs';
import { clippedAreas, cutAreas, distances, halfSpace, localCut, meanEdge } from './geometry.mjs';
import { meshes } from './meshes.mjs';
import { csg, manifold, rapier, sunder } from './peers.mjs';

const here = dirname(fileURLToPath(import.meta.url));
const has = (flag) => process.argv.includes(flag);
const runs = has('--quick') ? 2 : 5, notCounted = has('--quick') ? 1 : 2;

/** The least processor time of some runs: what else happens makes runs longer, and none shorter. */
async function shortest(cut) {
  let least = Infinity, last = null;
  for (let i = 0; i < notCounted + runs; ++i) {
    last = await cut();
    if (last.refused) return last;
    if (i >= notCounted) least = Math.min(least, last.milliseconds);
  }
  return { ...last, milliseconds: least };
}

function measured(kind, mesh, peer, plane, result) {
  const row = { kind, mesh: mesh.name, vertices: mesh.positions.length / 3, peer: peer.name, milliseconds: result.milliseconds, refused: result.refused ?? null };
  if (row.refused) return row;
  row.changed = result.changed ?? null;
  // Unconnected parts became bodies of their own, and their particles were numbered anew.
  row.growth = row.area = row.pathMean = row.pathMost = null;
  if (result.pieces > 0) return row;
  const edge = meanEdge(mesh), path = distances(result.mesh.positions, result.fresh, plane);
  row.pathMean = path && path.mean / edge;
  row.pathMost = path && path.most / edge;
  row.growth = result.mesh.triangles.length / 3 - mesh.triangles.length / 3;
  const expected = clippedAreas(mesh, plane), found = cutAreas(result.mesh, plane), whole = expected[0] + expected[1];
  row.area = kind === 'plane' ? Math.max(...[0, 1].map((side) => Math.abs(found[side] - expected[side]))) / whole : Math.abs(found[0] + found[1] - whole) / whole;
  return row;
}

const ours = await sunder('sunder-tear');
const peers = [ours, await rapier(), await manifold(), await csg()];
const rows = [];
for (const mesh of meshes()) {
  const local = localCut(mesh);
  for (const peer of peers) {
    if (peer.tear && local) rows.push(measured('tear', mesh, peer, local.plane, await shortest(() => peer.tear(mesh, local))));
    if (peer.halve) rows.push(measured('plane', mesh, peer, halfSpace, await shortest(() => peer.halve(mesh))));
  }
  console.error(`${mesh.name}: ${mesh.positions.length / 3} vertices`);
}

const find = (kind, peer, ...names) => names.map((name) => rows.find((row) => row.kind === kind && row.peer === peer && row.mesh === name)).find(Boolean);
const ratio = (kind, peer, ...names) => {
  const theirs = find(kind, peer, ...names), own = find(kind, 'Sunder', ...names);
  return theirs?.milliseconds && own?.milliseconds && !theirs.refused ? theirs.milliseconds / own.milliseconds : null;
};
if (has('--summary')) {
  const small = ['bunny', 'blob'], large = ['large bunny', 'large blob'];
  console.log(JSON.stringify({
    tear_vs_rapier_3k: ratio('tear', 'Rapier', ...small), tear_vs_rapier_36k: ratio('tear', 'Rapier', ...large),
    plane_vs_manifold_3k: ratio('plane', 'Manifold', ...small), plane_vs_csg_3k: ratio('plane', 'three-bvh-csg', ...small),
    path_error_edges: find('tear', 'Sunder', ...small)?.pathMost ?? null,
  }));
}

const number = (value, digits = 3) => (value === null || value === undefined ? '–' : value !== 0 && (Math.abs(value) < 1e-3 || Math.abs(value) >= 1e5) ? value.toExponential(1) : String(Number(value.toPrecision(digits))));
const line = (row) => `| ${row.mesh} | ${row.vertices} | ${row.peer} | ${number(row.milliseconds)} | ${row.refused ? `refused: ${row.refused} | | | | ` :
  `${row.growth ?? '–'} | ${number(row.pathMean)} | ${number(row.pathMost)} | ${number(row.area)} | ${row.changed ?? '–'}`} |`;
const table = (kind) => ['| mesh | vertices | peer | ms | triangles added | path error, mean | largest | area error | numbers changed |', '|---|---|---|---|---|---|---|---|---|',
  ...rows.filter((row) => row.kind === kind).map(line)].join('\n');
const parts = { tears: table('tear'), planes: table('plane') };
if (has('--write')) {
  const page = join(here, '..', '..', 'docs', 'peers.md');
  let text = readFileSync(page, 'utf8');
  for (const [name, part] of Object.entries(parts)) text = text.replace(new RegExp(`(<!-- ${name} -->\n)[^]*?(<!-- end -->)`), (_, begin, end) => `${begin}${part}\n${end}`);
  writeFileSync(page, text);
  writeFileSync(join(here, '..', '..', 'docs', 'pictures', 'web_peers.svg'), chart(rows));
} else if (!has('--summary')) {
  console.log(Object.values(parts).join('\n\n'));
}
process.exit(0);  // some peers keep threads
