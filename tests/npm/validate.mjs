// Prints {"errors": n, "warnings": n, "unused": n, "messages": [...]} of GLBs, by the Khronos glTF validator; one line per file.
// Usage: node validate.mjs <file.glb> ... or, for many, node validate.mjs --folder <folder> (in the order of names)
import { readFileSync, readdirSync } from 'node:fs';
import { dirname, join, resolve } from 'node:path';
import validator from 'gltf-validator';

const wanted = process.argv.slice(2);
const files = wanted[0] === '--folder'
  ? readdirSync(wanted[1]).filter((name) => name.endsWith('.glb')).sort().map((name) => join(wanted[1], name))
  : wanted;
for (const file of files) {
  let report;
  try {
    report = await validator.validateBytes(new Uint8Array(readFileSync(file)), {
      uri: file,
      maxIssues: 0,
      externalResourceFunction: async (uri) => new Uint8Array(readFileSync(resolve(dirname(file), decodeURIComponent(uri)))),
    });
  } catch (error) {
    console.log(JSON.stringify({ errors: 1, warnings: 0, messages: [String(error)] }));
    continue;
  }
  const errors = report.issues.messages.filter((message) => message.severity === 0);
  console.log(JSON.stringify({
    errors: report.issues.numErrors,
    warnings: report.issues.numWarnings,
    unused: report.issues.messages.filter(({ code }) => code === 'UNUSED_OBJECT').length,
    messages: errors.slice(0, 5).map(({ code, message, pointer }) => `${code} ${pointer ?? ''}: ${message}`),
  }));
}
