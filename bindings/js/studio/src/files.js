// Files that are opened and dropped. Their contents are not trusted: what the library refuses is said.

/** What a file is, by its first bytes: 'glb', 'log', 'gltf' or 'state'. */
export function kindOf(bytes) {
  const start = new TextDecoder().decode(bytes.subarray(0, 4096));
  if (start.startsWith('glTF')) return 'glb';
  if (!start.trimStart().startsWith('{')) return 'state';
  return /"sunder_operations"/.test(start) ? 'log' : 'gltf';
}

/** Calls back with { name, bytes } of each file that is chosen or dropped. */
export function receiveFiles({ button, input, target, onFile }) {
  const read = async (files) => {
    for (const file of files) await onFile({ name: file.name, bytes: new Uint8Array(await file.arrayBuffer()) });
  };
  button.addEventListener('click', () => input.click());
  input.addEventListener('change', async () => {
    await read(input.files);
    input.value = '';
  });
  addEventListener('dragover', (event) => {
    event.preventDefault();
    target.classList.add('dropping');
  });
  addEventListener('dragleave', () => target.classList.remove('dropping'));
  addEventListener('drop', (event) => {
    event.preventDefault();
    target.classList.remove('dropping');
    read(event.dataTransfer.files);
  });
}
