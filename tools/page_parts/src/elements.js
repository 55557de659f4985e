// Small pieces of HTML and SVG.

const SVG = 'http://www.w3.org/2000/svg';

/** Attributes that are shown. */
const TEXTS = ['title', 'label', 'aria-label'];

/** The same characters as those of tools/messages/visible.cpp. */
const UNSEEN = /[\u0000-\u001f\u007f-\u009f\u00ad\u061c\u180e\u200b\u200e\u200f\u2028-\u202e\u2060-\u206f\ufeff\ufff9-\ufffb\u{e0000}-\u{e007f}]/gu;

/** A text in which names of files and models may stand, with what is not seen or turns the direction of writing shown
 * as an escape: "\u202e". All texts of the page pass through here. */
export const visible = (text) => String(text).replace(UNSEEN, (unseen) => {
  const number = unseen.codePointAt(0).toString(16);
  return number.length > 4 ? `\\U${number.padStart(8, '0')}` : `\\u${number.padStart(4, '0')}`;
});

export function setText(node, text) {
  node.textContent = visible(text);
}

function filled(node, attributes, children) {
  for (const [name, value] of Object.entries(attributes))
    if (name.startsWith('on')) node.addEventListener(name.slice(2), value);
    else if (value !== null && value !== false)
      node.setAttribute(name, value === true ? '' : TEXTS.includes(name) ? visible(value) : value);
  node.append(...children.map((child) => (child instanceof Node ? child : visible(child))));
  return node;
}

/** html('button', {class: 'x', onclick: f}, 'text', child) */
export function html(tag, attributes = {}, ...children) {
  return filled(document.createElement(tag), attributes, children);
}

export function svg(tag, attributes = {}, ...children) {
  return filled(document.createElementNS(SVG, tag), attributes, children);
}

export const byId = (id) => document.getElementById(id);

const SHAPES = {
  error: ['polygon', { points: '6,1 14,1 19,6 19,14 14,19 6,19 1,14 1,6' }],
  warning: ['polygon', { points: '10,1 19.5,18.5 0.5,18.5' }],
  note: ['circle', { cx: 10, cy: 10, r: 9 }],
};

/** A sign that differs in shape and colour; @param text  one or two characters in it. */
export function severitySign(severity, text) {
  const [tag, attributes] = SHAPES[severity];
  const label = text === undefined ? [] : [svg('text', {
    x: 10, y: severity === 'warning' ? 16 : 14.2, 'text-anchor': 'middle',
  }, String(text))];
  return svg('svg', { class: `sign ${severity}`, viewBox: '0 0 20 20', 'aria-hidden': 'true' },
    svg(tag, attributes), ...label);
}
