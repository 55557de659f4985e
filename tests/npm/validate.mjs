// Prints {"errors": n, "warnings": n, "messages": [...]} of a GLB, by the Khronos glTF validator.
// Usage: node validate.mjs <file.glb>
import { readFileSync } from 'node:fs';
import { dirname, resolve } from 'node:path';
import validator from 'gltf-validator';

const file = process.argv[2];
const report = await validator.validateBytes(new Uint8Array(readFileSync(file)), {
  uri: file,
  maxIssues: 0,
  externalResourceFunction: async (uri) => new Uint8Array(readFileSync(resolve(dirname(file), decodeURIComponent(uri)))),
});
const errors = report.issues.messages.filter((message) => message.severity === 0);
console.log(JSON.stringify({
  errors: report.issues.numErrors,
  warnings: report.issues.numWarnings,
  messages: errors.slice(0, 5).map(({ code, message, pointer }) => `${code} ${pointer ?? ''}: ${message}`),
}));
