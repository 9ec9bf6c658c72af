// The 3D section: picture, slider, list of fragments, what is chosen.
import {css, evenColour, gapColour, gradient, NONE} from './colours.js';
import {h, nameElement, replace, shortened, tidy} from './dom.js';
import {ready} from './geometry.js';
import {counted, percent, short} from './numbers.js';
import {Stage} from './stage.js';

const KEYS = [
  ['arrows', 'turn'],
  ['Shift + arrows', 'move'],
  ['+  \u2212', 'nearer, farther'],
  ['N  P', 'next, previous fragment'],
  ['H', 'hide the chosen'],
  ['I', 'show the chosen alone'],
  ['A', 'show all'],
  ['F', 'fit the view'],
  ['R', 'first view'],
  ['[  ]', 'closer together, farther apart'],
  ['Esc', 'choose none'],
];

export class Assembly {
  /** @param data  the page's data  @param openJoin (pair) shows a joint */
  constructor(data, openJoin) {
    this.data = data;
    this.openJoin = openJoin;
    this.chosen = new Set();
    this.hidden = new Set();
    this.showLoose = !data.fragments.some((fragment) => fragment.pose);
    this.element = h('section', {id: 'assembly', 'aria-labelledby': 'assembly-title'});
    this.#build();
  }

  async start() {
    await ready;
    try {
      this.stage = new Stage(this.canvas, (index) => this.choose(index === null ? [] : [index]));
      this.stage.load(this.data.fragments);
    } catch (error) {
      this.stage = null;
      replace(this.frame, h('p', {class: 'note'}, `No 3D picture: ${error.message}. All else on this page works.`));
      return;
    }
    this.#show();
    this.#colour();
    this.stage.fit();
  }

  choose(indices) {
    this.chosen = new Set(indices);
    for (const index of indices) this.hidden.delete(index);
    if (indices.some((index) => !this.data.fragments[index].pose)) this.#setLoose(true);
    this.#show();
  }

  /** Only these, whole in view. */
  isolate(indices) {
    this.chosen = new Set(indices);
    this.hidden = new Set(this.data.fragments.keys());
    for (const index of indices) this.hidden.delete(index);
    if (indices.some((index) => !this.data.fragments[index].pose)) this.#setLoose(true);
    this.#show();
    this.stage?.fit();
  }

  #build() {
    this.canvas = h('canvas', {
      tabindex: 0,
      role: 'application',
      'aria-label': '3D view of the assembly. Arrow keys turn it, plus and minus zoom, N and P choose a fragment.',
      'aria-describedby': 'keys',
      onkeydown: (event) => this.#key(event),
    });
    this.frame = h('div', {class: 'stage'}, this.canvas);
    this.detail = h('div', {class: 'detail', 'aria-live': 'polite', id: 'chosen'});
    this.legend = h('div', {class: 'legend'});
    this.list = h('ul', {class: 'fragments', 'aria-label': 'Fragments'});
    const loose = this.data.fragments.filter((fragment) => !fragment.pose && fragment.mesh).length;
    const help = h(
      'details',
      {class: 'help', id: 'keys'},
      h('summary', {}, 'Mouse, fingers, keys'),
      h('p', {}, 'Drag turns, with Shift or the right button it moves; the wheel zooms once the picture was clicked; a click chooses a fragment. Two fingers zoom and move.'),
      h('dl', {class: 'keys'}, KEYS.map(([key, what]) => [h('dt', {}, h('kbd', {}, key)), h('dd', {}, what)])),
    );
    this.element.append(
      h('h2', {id: 'assembly-title'}, 'Assembly'),
      h('div', {class: 'assembly'}, h('div', {class: 'view'}, this.#controls(loose), this.frame, this.legend, help), h('div', {class: 'side'}, this.detail, this.#filter(), this.list)),
    );
    this.#fillList('');
  }

  #controls(loose) {
    this.slider = h('input', {type: 'range', id: 'explode', min: 0, max: 200, value: 0, step: 1, oninput: () => this.#explode()});
    this.modes = this.#modes();
    this.mode = h('select', {id: 'colour', onchange: () => this.#colour()}, this.modes.map(([value, label]) => h('option', {value}, label)));
    this.loose = h('input', {type: 'checkbox', id: 'loose', checked: this.showLoose, onchange: () => this.#setLoose(this.loose.checked, true)});
    return h(
      'div',
      {class: 'controls'},
      h('label', {class: 'slider'}, 'Pull apart', this.slider),
      h('label', {}, 'Colour by', this.mode),
      loose > 0 && h('label', {class: 'check'}, this.loose, `Show ${counted(loose, 'unplaced piece')}`),
      h('span', {class: 'buttons'}, h('button', {type: 'button', onclick: () => this.stage?.fit()}, 'Fit'), h('button', {type: 'button', onclick: () => this.#all()}, 'Show all'), h('button', {type: 'button', onclick: () => this.#first()}, 'First view')),
    );
  }

  #modes() {
    const {fragments} = this.data;
    const modes = [['fragment', 'fragment']];
    if (new Set(fragments.map((fragment) => fragment.group)).size > 1) modes.push(['object', 'object']);
    if (fragments.some((fragment) => fragment.confidence !== null)) modes.push(['confidence', 'confidence']);
    if (fragments.some((fragment) => fragment.pose)) modes.push(['gap', 'gap']);
    if (fragments.some((fragment) => fragment.mesh?.colour)) modes.push(['scan', "the scan's own"]);
    return modes;
  }

  #filter() {
    if (this.data.fragments.length < 16) return null;
    return h('input', {type: 'search', class: 'filter', placeholder: 'Find a fragment', 'aria-label': 'Find a fragment', oninput: (event) => this.#fillList(event.target.value)});
  }

  #fillList(wanted) {
    this.rows = new Map();
    const rows = this.data.fragments.map((fragment, index) => {
      if (!fragment.name.toLowerCase().includes(wanted.toLowerCase())) return null;
      const box = h('input', {type: 'checkbox', disabled: !fragment.mesh, 'aria-label': `show ${shortened(tidy(fragment.name), 60)}`, onchange: () => this.#setHidden(index, !box.checked)});
      const button = h('button', {type: 'button', class: 'pick', onclick: () => this.choose(this.chosen.has(index) ? [] : [index])}, h('i', {class: 'swatch'}), nameElement(fragment.name, {limit: 40}));
      const row = h('li', {}, box, button, h('small', {}, fragment.pose ? percent(fragment.confidence) : 'not placed'));
      this.rows.set(index, {row, box, button});
      return row;
    });
    replace(this.list, rows);
    this.#fillSwatches();
    this.#mark();
  }

  #setHidden(index, hidden) {
    if (hidden) this.hidden.add(index);
    else this.hidden.delete(index);
    if (!hidden && !this.data.fragments[index].pose) this.#setLoose(true);
    this.#show();
  }

  #setLoose(show, fit = false) {
    if (show && !this.showLoose) {
      // Those that were hidden with all others stay so; the switch alone shows them.
      this.data.fragments.forEach((fragment, index) => fit && !fragment.pose && this.hidden.delete(index));
    }
    this.showLoose = show;
    this.loose.checked = show;
    this.#show();
    if (fit) this.stage?.fit();
  }

  #all() {
    this.hidden.clear();
    this.#show();
    this.stage?.fit();
  }

  #first() {
    this.slider.value = 0;
    this.#explode();
    this.stage?.reset();
  }

  #visible(index) {
    return !this.hidden.has(index) && (this.showLoose || this.data.fragments[index].pose !== null);
  }

  #explode() {
    this.slider.setAttribute('aria-valuetext', `${this.slider.value} percent`);
    this.stage?.setExplode(this.slider.value / 100);
    if (Number(this.slider.value) > 0) this.stage?.fit();
  }

  #show() {
    this.stage?.setVisible((index) => this.#visible(index));
    this.#mark();
  }

  #mark() {
    for (const [index, {row, box, button}] of this.rows) {
      row.classList.toggle('chosen', this.chosen.has(index));
      box.checked = this.#visible(index);
      button.setAttribute('aria-pressed', this.chosen.has(index));
    }
    this.stage?.mark(this.chosen);
    const focused = [...this.detail.querySelectorAll('button')].indexOf(document.activeElement);
    replace(this.detail, this.#detail());
    if (focused >= 0) this.detail.querySelectorAll('button')[focused]?.focus();
  }

  #detail() {
    if (this.chosen.size === 0) return h('p', {class: 'note'}, 'Choose a fragment in the picture or in the list.');
    return [...this.chosen].map((index) => this.#card(index));
  }

  #card(index) {
    const fragment = this.data.fragments[index];
    const joins = this.data.pairs.filter((pair) => !pair.failed && (pair.a === index || pair.b === index) && (pair.used || pair.verdict !== 'no join'));
    const other = (pair) => this.data.fragments[pair.a === index ? pair.b : pair.a];
    const facts = [
      ['object', fragment.pose ? fragment.group + 1 : 'not placed'],
      ['confidence', fragment.pose ? percent(fragment.confidence) : null],
      ['faces', fragment.faces ? fragment.faces.toLocaleString('en') : null],
      ['diameter', fragment.diameter ? short(fragment.diameter) : null],
      ['file', h('bdi', {class: 'path', dir: 'auto'}, tidy(fragment.path))],
    ];
    return h(
      'div',
      {class: 'card'},
      nameElement(fragment.name, {tag: 'h3', limit: 120}),
      fragment.reason && h('p', {}, fragment.reason),
      h('dl', {class: 'facts'}, facts.filter(([, value]) => value !== null && value !== '').map(([name, value]) => [h('dt', {}, name), h('dd', {}, value)])),
      joins.length > 0 && h('p', {class: 'joins-of'}, 'Joins: ', joins.slice(0, 12).map((pair, k) => [k > 0 && ', ', h('button', {type: 'button', class: 'link', onclick: () => this.openJoin(pair)}, nameElement(other(pair).name, {limit: 24}), ` (${percent(pair.score)}${pair.used ? '' : ', not used'})`)])),
      h('p', {class: 'buttons'}, h('button', {type: 'button', onclick: () => this.#setHidden(index, !this.hidden.has(index))}, this.hidden.has(index) ? 'Show' : 'Hide'), h('button', {type: 'button', onclick: () => this.isolate([index])}, 'Show alone')),
    );
  }

  /** The colour of whole pieces, where they have one. */
  #ofPiece() {
    const {fragments} = this.data;
    return {
      fragment: (index) => fragments[index].colour,
      object: (index) => fragments[index].object_colour ?? NONE,
      confidence: (index) => evenColour(fragments[index].confidence),
    }[this.mode.value];
  }

  #fillSwatches() {
    const ofPiece = this.#ofPiece();
    for (const [index, {button}] of this.rows) button.querySelector('.swatch').style.background = ofPiece ? css(ofPiece(index)) : 'transparent';
  }

  #colour() {
    const mode = this.mode.value;
    const ofPiece = this.#ofPiece();
    if (ofPiece) this.stage?.colourPieces(ofPiece);
    else this.stage?.colourVertices(mode === 'gap' ? (piece, k) => GAP_TABLE[piece.gaps[k]] : (piece, k) => (piece.scan ? [0, 1, 2].map((c) => piece.scan[4 * k + c] / 255) : NONE));
    this.#fillSwatches();
    replace(this.legend, this.#legend(mode, this.data.gap_scale));
  }

  #legend(mode, scale) {
    const bar = (colour, low, high, labels) => h('span', {class: 'scale'}, h('span', {class: 'bar', style: {background: gradient(colour, low, high)}}), h('span', {class: 'ends'}, labels.map((label) => h('span', {}, label))));
    if (mode === 'confidence') return bar(evenColour, 0, 1, ['0 %', 'confidence', '100 %']);
    if (mode === 'gap') return [bar(gapColour, -1, 1, [`overlap ${short(scale)}`, 'touch', `apart ${short(scale)}`]), h('span', {class: 'grey'}, h('i', {class: 'swatch', style: {background: css(NONE)}}), 'no contact; in the scans\u2019 unit, the darkest for larger ones too')];
    return [];
  }

  #key(event) {
    if (event.ctrlKey || event.metaKey || event.altKey || !this.stage) return;
    const {orbit} = this.stage;
    const step = 0.12;
    const arrow = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1]}[event.key];
    const act = {
      '+': () => orbit.zoom(0.87),
      '=': () => orbit.zoom(0.87),
      '-': () => orbit.zoom(1.15),
      n: () => this.#step(1),
      p: () => this.#step(-1),
      h: () => [...this.chosen].forEach((index) => this.#setHidden(index, true)),
      i: () => this.chosen.size > 0 && this.isolate([...this.chosen]),
      a: () => this.#all(),
      f: () => this.stage.fit(),
      r: () => this.#first(),
      '[': () => this.#pull(-10),
      ']': () => this.#pull(10),
      Escape: () => this.choose([]),
    }[event.key.length === 1 ? event.key.toLowerCase() : event.key];
    if (!arrow && !act) return;
    event.preventDefault();
    if (arrow && event.shiftKey) orbit.pan(0.05 * arrow[0], 0.05 * arrow[1]);
    else if (arrow) orbit.turn(step * arrow[0], step * arrow[1]);
    else act();
  }

  #pull(by) {
    this.slider.value = Number(this.slider.value) + by;
    this.#explode();
  }

  #step(by) {
    const count = this.data.fragments.length;
    const at = this.chosen.size === 1 ? [...this.chosen][0] : by > 0 ? -1 : count;
    for (let k = 1; k <= count; ++k) {
      const index = (((at + by * k) % count) + count) % count;
      if (this.data.fragments[index].mesh && this.#visible(index)) return this.choose([index]);
    }
  }
}

const GAP_TABLE = Array.from({length: 256}, (_, byte) => (byte === 0 ? NONE : gapColour((byte - 128) / 127)));
