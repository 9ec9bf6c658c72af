// Elements without markup: texts only ever become text nodes, so no name can turn into HTML.

/** h('a', {href, class, onclick, 'aria-label'}, child, 'text', [more]); null, undefined and false children are skipped. */
export function h(tag, attributes = {}, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (value === null || value === undefined || value === false) continue;
    if (name.startsWith('on')) element.addEventListener(name.slice(2), value);
    else if (name === 'style') for (const [key, text] of Object.entries(value)) element.style.setProperty(key, text);
    else element.setAttribute(name, value === true ? '' : String(value));
  }
  append(element, children);
  return element;
}

export function append(element, children) {
  for (const child of children.flat(Infinity)) {
    if (child === null || child === undefined || child === false) continue;
    element.append(child instanceof Node ? child : document.createTextNode(String(child)));
  }
}

export function replace(element, ...children) {
  element.textContent = '';
  append(element, children);
}

/** A name of unknown script and direction that cannot disturb the line around it. */
export function nameElement(name, {tag = 'bdi', limit = 80, ...attributes} = {}) {
  const text = tidy(name);
  return h(tag, {class: 'name', dir: 'auto', title: text, ...attributes}, shortened(text, limit));
}

/** Control and direction characters made visible, as they could fake another name. */
export function tidy(name) {
  const text = name.replace(/[\u0000-\u001f\u007f-\u009f\u061c\u200b\u200e\u200f\u2028-\u202e\u2060-\u2069\ufeff]/g, '\ufffd');
  return text.length === 0 ? '(no name)' : text;
}

/** At most `limit` characters, cut in the middle: names of scans differ at their ends. */
export function shortened(text, limit) {
  const letters = Array.from(text);
  if (letters.length <= limit) return text;
  const tail = Math.floor((limit - 1) / 2);
  return `${letters.slice(0, limit - 1 - tail).join('')}\u2026${letters.slice(-tail).join('')}`;
}
