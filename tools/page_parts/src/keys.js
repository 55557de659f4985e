// Keys of the page; lists and numbers keep what is typed, and what space or Enter activates keeps these.

const ACTIVATED = 'button, summary, input[type=checkbox], input[type=radio]';

/** @param actions  {key: function}; @param onCanvas  the same, while the canvas has the focus */
export function listenToKeys(canvas, actions, onCanvas) {
  addEventListener('keydown', (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const { target } = event;
    if (document.querySelector('dialog[open]')) return;
    if (target.matches('select, input[type=number]')) return;
    if ((event.key === ' ' || event.key === 'Enter') && target.matches(ACTIVATED)) return;
    const key = event.key.length === 1 ? event.key.toLowerCase() : event.key;
    const action = (target === canvas && onCanvas[key]) || actions[key];
    if (!action) return;
    event.preventDefault();
    action();
  });
}
