// Before all else, so that whatever fails is seen. The message may name what a file calls its parts: it is no HTML, and
// what is not seen or turns the direction of writing is shown as an escape.
function showError(text) {
  const holder = document.getElementById('error');
  holder.textContent = text.replace(/[\p{Cc}\p{Cf}\p{Zl}\p{Zp}]/gu,
    (unseen) => `\\u${unseen.codePointAt(0).toString(16).padStart(4, '0')}`);
  holder.hidden = false;
}
addEventListener('error', ({ message }) => {
  // A browser says this when a size changes again while it is laid out; nothing has failed.
  if (!message.startsWith('ResizeObserver loop')) showError(`This page failed: ${message}`);
});
addEventListener('unhandledrejection', (event) => showError(`This page failed: ${event.reason}`));
