// The findings, errors first, each with its places.
import { html, severitySign } from '../../page_parts/src/elements.js';
import { plural, quantity } from '../../page_parts/src/format.js';

const ORDER = ['error', 'warning', 'note'];

const GLYPH = { error: '!', warning: '!', note: 'i' };

const EVIDENCE = {
  exact: 'exact', certified: 'certified for all poses', sampled: 'largest of the poses tried',
  not_tested: 'not tested',
};

/** "2 errors · 1 warning" */
export function verdict(findings) {
  const counts = ORDER.map((severity) => [severity,
    findings.filter((finding) => finding.severity === severity).length]);
  const worst = counts.find(([, count]) => count > 0)?.[0];
  const text = counts.filter(([, count]) => count > 0).map(([word, count]) => plural(count, word));
  return { worst, text: text.join(' · ') || 'No findings' };
}

function facts(finding) {
  const rows = [['Evidence', EVIDENCE[finding.evidence]]];
  if (finding.evidence !== 'not_tested')
    rows.push(['Worst', quantity(finding.value, finding.unit)],
      ['Reported from', quantity(finding.threshold, finding.unit)]);
  if (finding.gltf_code) rows.push(['glTF Validator', finding.gltf_code]);
  return html('dl', {}, ...rows.flatMap(([name, text]) =>
    [html('dt', {}, name), html('dd', {}, text)]));
}

function placesTitle(finding) {
  const [place] = finding.places;
  if (!place) return '';
  const kind = place.vertex !== null ? 'Vertices' : place.bone !== null ? 'Bones' : 'Places';
  return html('h3', {}, `${kind}, worst first`);
}

function placeName(place, model) {
  if (place.vertex !== null) return String(place.vertex);
  return place.bone !== null ? model.bones[place.bone] : 'place';
}

function places(finding, model, onPlace) {
  const buttons = finding.places.map((place, i) => html('li', {}, html('button', {
    class: 'place', onclick: () => onPlace(finding, i),
  }, html('b', {}, `${i + 1} · ${placeName(place, model)}`), html('span', {}, quantity(place.value, finding.unit)))));
  return html('ol', { class: 'places' }, ...buttons);
}

/** @param onOpen  (finding or null), @param onPlace  (finding, number of the place) */
export function listFindings(holder, findings, model, { onOpen, onPlace }) {
  if (!findings.length) holder.append(html('p', { class: 'none' }, 'No findings.'));
  const sorted = [...findings].sort((a, b) => ORDER.indexOf(a.severity) - ORDER.indexOf(b.severity));
  for (const finding of sorted) {
    const details = html('details', { name: 'finding', class: finding.severity, ontoggle: () => {
      if (details.open) onOpen(finding);
      else if (!holder.querySelector('details[open]')) onOpen(null);
    } },
    html('summary', {}, severitySign(finding.severity, GLYPH[finding.severity]),
      html('span', { class: 'head' }, html('b', {}, finding.severity), html('code', {}, finding.code),
        finding.count ? html('span', { class: 'count', title: 'vertices, bones or edges concerned' },
          `${finding.count.toLocaleString('en')} ×`) : ''),
      html('span', { class: 'text' }, finding.text)),
    html('p', { class: 'advice' }, finding.advice), facts(finding), placesTitle(finding),
    places(finding, model, onPlace));
    holder.append(details);
  }
}
