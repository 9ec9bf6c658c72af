// Joins, best first, with pictures and figures.
import {h, nameElement, replace} from './dom.js';
import {short} from './numbers.js';

const PAGE = 30;

export class Joins {
  /** @param decisions  what the user says of them  @param show (indices) shows fragments alone in 3D  @param enlarge (picture, caption) */
  constructor(data, decisions, show, enlarge) {
    Object.assign(this, {data, decisions, show, enlarge});
    this.shown = PAGE;
    this.list = h('ol', {class: 'joins'});
    this.more = h('button', {type: 'button', onclick: () => this.#grow()}, 'Show more');
    this.select = h('select', {onchange: () => this.#fill()}, this.#choices().map(([value, label]) => h('option', {value}, label)));
    this.element = h(
      'section',
      {id: 'joins', 'aria-labelledby': 'joins-title'},
      h('h2', {id: 'joins-title'}, 'Joins'),
      decisions.element,
      h('p', {class: 'controls'}, h('label', {}, 'Show', this.select)),
      this.list,
      this.more,
    );
    this.#fill();
  }

  /** Brings a pair into view. */
  open(pair) {
    if (!this.#matching().includes(pair)) this.select.value = 'all';
    this.shown = Math.max(this.shown, this.#matching().indexOf(pair) + 1);
    this.#fill();
    const item = document.getElementById(`join-${this.data.pairs.indexOf(pair)}`);
    item.scrollIntoView({block: 'start'});
    item.focus({preventScroll: true});
  }

  /** Brings those that somebody should look at into view. */
  check() {
    this.select.value = 'check';
    this.#fill();
    this.element.scrollIntoView({block: 'start'});
    this.select.focus({preventScroll: true});
  }

  #choices() {
    const {pairs} = this.data;
    const count = (test) => pairs.filter(test).length;
    return [
      ['likely', `used or likely (${count(LIKELY)})`],
      ['used', `used in the assembly (${count((pair) => pair.used)})`],
      ['check', `to check: unsure, or used by the witness of others (${count(TO_CHECK)})`],
      ['open', `likely but not used (${count((pair) => LIKELY(pair) && !pair.used)})`],
      ['all', `all that are listed (${pairs.length})`],
    ];
  }

  #matching() {
    const tests = {likely: LIKELY, used: (pair) => pair.used, check: TO_CHECK, open: (pair) => LIKELY(pair) && !pair.used, all: () => true};
    return this.data.pairs.filter(tests[this.select.value]);
  }

  #fill() {
    const pairs = this.#matching();
    replace(this.list, pairs.slice(0, this.shown).map((pair) => this.#item(pair)));
    if (pairs.length === 0) replace(this.list, h('li', {class: 'note'}, 'None.'));
    this.more.hidden = pairs.length <= this.shown;
  }

  #grow() {
    const first = this.shown;
    this.shown += PAGE;
    this.#fill();
    this.list.children[first]?.focus();
  }

  #item(pair) {
    const [a, b] = [this.data.fragments[pair.a], this.data.fragments[pair.b]];
    const rank = this.data.pairs.indexOf(pair);
    return h(
      'li',
      {class: 'join', id: `join-${rank}`, tabindex: -1},
      h('header', {}, h('span', {class: 'rank'}, `${rank + 1}`), h('h3', {}, nameElement(a.name, {limit: 48}), h('span', {class: 'and'}, ' \u2013 '), nameElement(b.name, {limit: 48})), h('span', {class: `verdict ${VERDICTS[pair.verdict] ?? ''}`}, pair.verdict), pair.used && h('span', {class: 'verdict used'}, 'in the assembly')),
      h('div', {class: 'score'}, !pair.failed && h('meter', {min: 0, max: 1, value: pair.score, 'aria-label': 'score'}), !pair.failed && h('span', {}, `score ${pair.score.toFixed(2)}`), (a.mesh || b.mesh) && h('button', {type: 'button', onclick: () => this.show([pair.a, pair.b])}, 'Show both in 3D'), !pair.failed && this.decisions.buttons(pair)),
      pair.note && h('p', {class: 'note'}, pair.note),
      pair.pictures.length > 0 && h('div', {class: 'pictures'}, pair.pictures.map((picture) => this.#picture(pair, picture))),
      pair.figures.length > 0 && h('dl', {class: 'figures'}, pair.figures.map(([name, value]) => h('div', {}, h('dt', {}, name), h('dd', {}, short(value))))),
    );
  }

  #picture(pair, picture) {
    const [a, b] = [this.data.fragments[pair.a].name, this.data.fragments[pair.b].name];
    const image = h('img', {src: `data:image/jpeg;base64,${picture.jpeg}`, alt: '', width: picture.width, height: picture.height, loading: 'lazy', decoding: 'async'});
    return h('figure', {}, h('button', {type: 'button', class: 'enlarge', 'aria-label': `Enlarge: ${picture.title}`, onclick: () => this.enlarge(picture, [nameElement(a), ' \u2013 ', nameElement(b)])}, image), h('figcaption', {}, picture.title));
  }
}

const LIKELY = (pair) => pair.used || pair.verdict === 'join' || pair.verdict === 'unsure';
/** The scores alone do not settle these. */
export const TO_CHECK = (pair) => !pair.failed && (pair.verdict === 'unsure' || (pair.used && pair.verdict !== 'join'));
const VERDICTS = {join: 'join-yes', unsure: 'join-unsure', 'no join': 'join-no'};

