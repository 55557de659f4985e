// Skins compared through the package: the figures of `sunder validate`, and what the newest operation did.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import test from 'node:test';
import { Sunder, SunderError } from 'sunder-tear';
import { FRONT_STROKE, commandFile, rig, rigFile } from './support.mjs';

/** The tube, torn with one influence per new vertex, which is deliberately wrong. */
async function badlyTorn(maximumInfluences = 1) {
  const model = await Sunder.load(rig('tube'), { soft: false }), scene = await Sunder.createScene(), it = scene.spawn(model);
  it.tear(FRONT_STROKE, { weights: 'barycentric', maximumInfluences });
  scene.update(0);
  return { model, scene, it };
}
const largest = (values) => values.reduce((most, value) => (value > most ? value : most), 0);
const near = (a, b, what) => assert.ok(Math.abs(a - b) <= 1e-9 + 1e-6 * Math.abs(b), `${what}: ${a} and ${b}`);

test('a model compared with itself differs nowhere, and with a badly torn one where it was torn', async () => {
  const { model, it } = await badlyTorn(), torn = await Sunder.load(it.toGLB(), { soft: false });
  assert.ok(Sunder.features.validation);
  const same = Sunder.validate(model, model);
  assert.deepEqual([same.sampled, same.certified, same.errorCount, same.warningCount, same.unmatched], [0, 0, 0, 0, 0]);
  assert.deepEqual(same.newest, { points: 0, uncertified: 0, sampled: 0, certified: 0 });
  const other = Sunder.validate(model, torn);
  assert.equal(other.vertexCount, other.deviations.length);
  assert.equal(other.vertexCount, other.bounds.length);
  near(largest(other.deviations), other.sampled, 'the worst vertex');
  near(largest(other.bounds), other.certified, 'the largest bound');
  assert.ok(other.sampled > 0.01 && other.found >= 0.9 * other.sampled && other.certified >= other.found);
  other.deviations.forEach((deviation, v) => { if (!Number.isNaN(other.bounds[v])) assert.ok(deviation <= other.bounds[v] * (1 + 1e-6) + 1e-9); });
  const finding = other.findings.find(({ code }) => code === 'SUNDER_W_DEVIATION');
  assert.equal(finding.severity, 'error');
  assert.equal(finding.evidence, 'sampled');
  assert.ok(finding.count > 0 && finding.vertex !== null && finding.advice.length > 0);
  assert.equal(other.findings.length, other.errorCount + other.warningCount + other.noteCount);
});

test('an instance knows the bound of its newest operation', async () => {
  const { model, scene, it } = await badlyTorn(), vertices = model.mesh(0).vertexCount;
  const first = it.validate();
  assert.equal(first.vertexCount, it.mesh(0).vertexCount, 'as it is drawn');
  assert.equal(largest(first.deviations.subarray(0, vertices)), 0, 'what was there is as it was');
  near(first.newest.sampled, first.sampled, 'nothing else is wrong');
  near(first.newest.certified, first.certified, 'nothing else has a bound');
  assert.ok(first.newest.points > 5 && first.newest.uncertified === 0);
  it.tear(FRONT_STROKE.map((blade) => blade.map(([x, y, z]) => [x, y, -z])), { weights: 'barycentric' });
  scene.update(0);
  const second = it.validate();
  near(second.certified, first.certified, 'the first tear is still there');
  assert.ok(second.newest.certified < 0.5 * first.newest.certified, 'the second one keeps all influences');
  it.undo();
  scene.update(0);
  assert.deepEqual(it.validate().newest, first.newest);
});

test('options and objects that are wrong are refused', async () => {
  const { model, scene, it } = await badlyTorn();
  assert.throws(() => Sunder.validate(model, model, { randomPoses: 100001 }), SunderError);
  assert.throws(() => it.validate({ poses: 3 }), /no option/);
  assert.throws(() => it.validate({ maximumDeviation: -1 }), SunderError);
  it.dispose();
  scene.update(0);
  assert.throws(() => it.validate(), SunderError);
});

test('the figures are those of the command', { skip: existsSync(commandFile) ? false : 'the command is not built' }, async () => {
  const folder = mkdtempSync(join(tmpdir(), 'sunder-validate-'));
  try {
    const { model, it } = await badlyTorn(), file = join(folder, 'torn.glb'), report = join(folder, 'report.json');
    writeFileSync(file, it.toGLB());
    const ours = Sunder.validate(model, await Sunder.load(readFileSync(file), { soft: false }));
    // Its exit code says that there are errors.
    try {
      execFileSync(commandFile, ['validate', rigFile('tube'), file, '--report', report], { stdio: 'ignore' });
    } catch (error) {
      assert.equal(error.status, 1);
    }
    const theirs = JSON.parse(readFileSync(report, 'utf8'));
    near(ours.found, theirs.certificate.found, 'found');
    near(ours.certified, theirs.certificate.certified, 'certified');
    near(ours.sampled, Math.max(...theirs.posed.map(({ max = 0 }) => max)), 'sampled');
    near(ours.diagonal, theirs.diagonal, 'diagonal');
    // The command also judges the weights as the file stores them, and what loading repaired.
    const codes = new Map(theirs.findings.map((finding) => [finding.code, finding]));
    for (const { code, value, count, severity } of ours.findings) {
      near(value, codes.get(code).value, code);
      assert.deepEqual([count, severity], [codes.get(code).count, codes.get(code).severity], code);
    }
  } finally {
    rmSync(folder, { recursive: true, force: true });
  }
});
