// Keys of the page; lists keep their letters, and what space activates keeps that.

const ACTIVATED = 'button, summary, input[type=checkbox], input[type=radio]';

/** @param actions  {key: function}; @param onCanvas  the same, while the canvas has the focus */
export function listenToKeys(canvas, actions, onCanvas) {
  addEventListener('keydown', (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const { target } = event;
    if (document.querySelector('dialog[open]')) return;
    if (target.matches('select') || (event.key === ' ' && target.matches(ACTIVATED))) return;
    const key = event.key.length === 1 ? event.key.toLowerCase() : event.key;
    const action = (target === canvas && onCanvas[key]) || actions[key];
    if (!action) return;
    event.preventDefault();
    action();
  });
}
