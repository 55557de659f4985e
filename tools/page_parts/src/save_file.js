// A file that the page made, into the browser's folder of downloads.
import { html } from './elements.js';

export function saveFile(content, name, type = 'application/octet-stream') {
  const url = URL.createObjectURL(new Blob([content], { type }));
  html('a', { href: url, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(url), 10000);
}
