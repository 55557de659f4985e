// What a comparison of skins found, copied out of the library.
import { sunder_finding, sunder_validation_options } from '../generated/calls.js';
import { fieldsOf, namesOf } from './options.js';

const SEVERITIES = ['note', 'warning', 'error'];
const EVIDENCES = ['exact', 'certified', 'sampled', 'notTested'];
const orNull = (index) => (index === 0xFFFFFFFF ? null : index);

export const validationFields = (options) => fieldsOf(sunder_validation_options, options);

const newestOf = ({ newest_points, newest_uncertified, newest_sampled, newest_certified }) => ({
  points: newest_points, uncertified: newest_uncertified, sampled: newest_sampled, certified: newest_certified });

/** Reads a report and destroys it. */
export function takeReport(calls, report) {
  const { memory } = calls;
  try {
    const info = calls.sunder_get_report(report), { findings, count } = calls.sunder_get_findings(report);
    const vertices = calls.sunder_get_vertex_deviations(report);
    const array = (at) => memory.viewOf(Float32Array, at, vertices.count).slice();
    return {
      ...namesOf(info, { without: Object.keys(info).filter((name) => name.startsWith('newest_')) }),
      newest: newestOf(info),
      findings: memory.readStructs(sunder_finding, findings, count).map((finding) => ({
        code: memory.text(finding.code), text: memory.text(finding.text), advice: memory.text(finding.advice), unit: memory.text(finding.unit),
        value: finding.value, threshold: finding.threshold, count: Number(finding.count),
        severity: SEVERITIES[finding.severity], evidence: EVIDENCES[finding.evidence],
        mesh: orNull(finding.mesh), vertex: orNull(finding.vertex), bone: orNull(finding.bone) })),
      deviations: array(vertices.deviations),
      bounds: array(vertices.bounds),
    };
  } finally {
    calls.sunder_destroy_report(report);
  }
}
