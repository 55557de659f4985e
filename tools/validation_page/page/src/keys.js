// Keys of the page; inputs, lists and buttons keep theirs.

const OWN_KEYS = new Set(['INPUT', 'SELECT', 'TEXTAREA']);
const ACTIVATED = new Set(['BUTTON', 'SUMMARY']);

/** @param actions  {key: function}; @param onCanvas  the same, while the canvas has the focus */
export function listenToKeys(canvas, actions, onCanvas) {
  addEventListener('keydown', (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const { target } = event;
    if (document.querySelector('dialog[open]')) return;
    if (OWN_KEYS.has(target.tagName) && target.type !== 'checkbox') return;
    if (event.key === ' ' && (ACTIVATED.has(target.tagName) || target.type === 'checkbox')) return;
    const key = event.key.length === 1 ? event.key.toLowerCase() : event.key;
    const action = (target === canvas && onCanvas[key]) || actions[key];
    if (!action) return;
    event.preventDefault();
    action();
  });
}
