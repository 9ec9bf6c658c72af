// What the user says of joins, and the file of it that rejoin assemble --constraints reads.
import {h, replace} from './dom.js';
import {counted} from './numbers.js';

const FILE = 'constraints.json';
const keyOf = (a, b) => (a < b ? `${a} ${b}` : `${b} ${a}`);

/** JSON in which nothing is invisible or turns the line round; it is read as the same text. */
function quoted(text) {
  return JSON.stringify(text).replace(/[\u007f-\u009f\u061c\u200b\u200e\u200f\u2028-\u202e\u2060-\u2069\ufeff]/g, (letter) => `\\u${letter.charCodeAt(0).toString(16).padStart(4, '0')}`);
}

/** The constraints file, with a line for each pair.
 *  @param pairs {must_join: [[a, b]], must_not_join: [[a, b]]} indices of names  @param poses [[index, matrix]], column major */
export function constraintsText(names, pairs, poses) {
  const block = (key, open, lines, close) => (lines.length > 0 ? [`"${key}": ${open}\n  ${lines.join(',\n  ')}\n ${close}`] : []);
  const couples = (key) => block(key, '[', pairs[key].map(([a, b]) => `[${quoted(names[a])}, ${quoted(names[b])}]`), ']');
  const rows = (matrix) => [0, 1, 2, 3].map((row) => [0, 1, 2, 3].map((column) => matrix[4 * column + row]));
  const places = poses.map(([index, matrix]) => `${quoted(names[index])}: ${JSON.stringify(rows(matrix))}`);
  return `{${[...couples('must_join'), ...couples('must_not_join'), ...block('poses', '{', places, '}')].join(',\n ')}}\n`;
}

export class Decisions {
  constructor(data) {
    this.data = data;
    this.made = new Map();
    for (const what of ['must_join', 'must_not_join']) for (const [a, b] of data.constraints[what]) this.made.set(keyOf(a, b), {what, a, b});
    this.element = h('div', {class: 'decisions', role: 'region', 'aria-label': 'Your decisions'});
    this.#show();
  }

  /** Two buttons for a pair; pressing the pressed one takes the decision back. */
  buttons({a, b}) {
    const key = keyOf(a, b);
    const mark = () => list.forEach(([what, button]) => button.setAttribute('aria-pressed', this.made.get(key)?.what === what));
    const decide = (what) => {
      if (this.made.get(key)?.what === what) this.made.delete(key);
      else this.made.set(key, {what, a, b});
      mark();
      this.#show();
    };
    const list = [['must_join', 'They join'], ['must_not_join', 'They do not join']].map(([what, label]) => [what, h('button', {type: 'button', class: 'decide', onclick: () => decide(what)}, label)]);
    mark();
    return list.map(([, button]) => button);
  }

  #text() {
    const list = (wanted) => [...this.made.values()].filter(({what}) => what === wanted).map(({a, b}) => [a, b]);
    return constraintsText(this.data.fragments.map(({name}) => name), {must_join: list('must_join'), must_not_join: list('must_not_join')}, this.data.constraints.poses);
  }

  #show() {
    const {poses} = this.data.constraints;
    if (this.made.size === 0 && poses.length === 0) {
      replace(this.element, h('p', {class: 'note'}, 'If the pieces in your hands, or the pictures, tell more than the scores, say so with the buttons of a join: a file for rejoin assemble is made of it here.'));
      return;
    }
    const text = this.#text();
    const given = poses.length > 0 ? [counted(poses.length, 'given pose')] : [];
    const kept = this.made.size > 0 ? `${[counted(this.made.size, 'decision'), ...given].join(' and ')}, those of the last assembly included` : `${given} of the last assembly`;
    const area = h('textarea', {readonly: true, rows: Math.min(text.split('\n').length, 12), spellcheck: 'false', 'aria-label': FILE, onfocus: () => area.select()});
    area.value = text;
    replace(
      this.element,
      h('p', {}, `${kept}. Save the file before you close the page, then put the pieces together again and make the page anew (RUN is its folder):`),
      h('pre', {}, `rejoin assemble RUN --constraints ${FILE} --out DIR\nrejoin report RUN`),
      area,
      h('p', {class: 'buttons'}, h('button', {type: 'button', onclick: () => save(text)}, `Save ${FILE}`)),
    );
  }
}

function save(text) {
  const url = URL.createObjectURL(new Blob([text], {type: 'application/json'}));
  h('a', {href: url, download: FILE}).click();
  setTimeout(() => URL.revokeObjectURL(url), 60e3);
}
