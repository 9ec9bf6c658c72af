// Scores of all pairs as a picture; the pointer or the arrow keys tell which is which.
import {evenColour, gradient} from './colours.js';
import {h, nameElement, replace, shortened, tidy} from './dom.js';
import {bytesOf} from './numbers.js';

const NOT_COMPARED = 255;
const FAILED = 254;
const FULL_SCORE = 253;
const LABELLED = 48; // fragments that still get their names written beside

export class Matrix {
  /** @param pick (pair or null, indices) a cell was chosen */
  constructor(data, pick) {
    Object.assign(this, {data, pick});
    this.count = data.fragments.length;
    this.scores = bytesOf(data.scores);
    this.order = [...data.fragments.keys()].sort((a, b) => this.#rank(a) - this.#rank(b) || a - b);
    this.used = this.#usedCells();
    this.cursor = [0, Math.min(1, this.count - 1)];
    this.canvas = h('canvas', {
      tabindex: 0,
      role: 'application',
      'aria-label': 'Matrix of pair scores. Arrow keys move, Enter opens the pair.',
      onkeydown: (event) => this.#key(event),
      onpointermove: (event) => this.#point(event),
      onclick: (event) => this.#point(event) && this.#choose(),
      onfocus: () => this.draw(),
      onblur: () => this.draw(),
    });
    this.readout = h('p', {class: 'readout', 'aria-live': 'polite'}, 'Point at a cell, or move with the arrow keys.');
    const scale = h(
      'div',
      {class: 'legend'},
      h('span', {class: 'scale'}, h('span', {class: 'bar', style: {background: gradient(evenColour, 0, 1)}}), h('span', {class: 'ends'}, h('span', {}, '0'), h('span', {}, 'score'), h('span', {}, '1'))),
    );
    this.element = h('section', {id: 'matrix', 'aria-labelledby': 'matrix-title'}, h('h2', {id: 'matrix-title'}, 'All pairs'), h('p', {class: 'note'}, 'Fragments of one object stand together; a frame marks the joins that the assembly uses.'), h('div', {class: 'matrix'}, this.canvas), scale, this.readout);
    new ResizeObserver(() => this.draw()).observe(this.element);
  }

  /** Place in the order: objects first, loose pieces last. */
  #rank(index) {
    return this.data.fragments[index].group ?? Infinity;
  }

  #byte(i, j) {
    const row = Math.min(i, j);
    return this.scores[(row * (2 * this.count - row - 1)) / 2 + Math.max(i, j) - row - 1];
  }

  /** null: there is none. */
  score(i, j) {
    const byte = this.#byte(i, j);
    return byte > FULL_SCORE ? null : byte / FULL_SCORE;
  }

  #text(i, j) {
    const score = this.score(i, j);
    if (score !== null) return `score ${score.toFixed(2)}`;
    return this.#byte(i, j) === FAILED ? 'could not be compared' : 'not compared';
  }

  draw() {
    const style = getComputedStyle(this.element);
    const room = this.canvas.parentElement.clientWidth;
    const labelled = this.count <= LABELLED;
    this.margin = !labelled ? 0 : room > 520 ? 132 : 96;
    this.cell = Math.max(labelled ? 12 : 3, Math.min(28, Math.floor((Math.min(room, 1100) - this.margin) / Math.max(1, this.count))));
    const side = this.margin + this.cell * this.count;
    const ratio = Math.min(window.devicePixelRatio || 1, 2);
    Object.assign(this.canvas, {width: side * ratio, height: side * ratio});
    this.canvas.style.width = this.canvas.style.height = `${side}px`;
    const context = this.canvas.getContext('2d');
    context.scale(ratio, ratio);
    this.#cells(context, style);
    if (labelled) this.#labels(context, style);
    if (document.activeElement === this.canvas) this.#frame(context, ...this.cursor, style.getPropertyValue('--accent'), 3);
  }

  #cells(context, style) {
    const {margin, cell, count} = this;
    if (count === 0) return;
    const side = cell * count;
    context.fillStyle = style.getPropertyValue('--faint');
    context.fillRect(margin, margin, side, side);
    context.imageSmoothingEnabled = false;
    this.small ??= this.#smallPicture();
    context.drawImage(this.small, margin, margin, side, side);
    context.fillStyle = style.getPropertyValue('--line');
    for (let k = 0; k < count; ++k) context.fillRect(margin + k * cell, margin + k * cell, cell, cell);
    if (cell > 6) this.#gaps(context);
    const ink = style.getPropertyValue('--ink');
    for (const [row, column] of this.used) this.#frame(context, row, column, ink, cell > 8 ? 2 : 1);
  }

  /** One pixel a cell, which scales up at once where hundreds of thousands of cells would take seconds; clear without a score. */
  #smallPicture() {
    const canvas = h('canvas', {width: this.count, height: this.count});
    const colours = Array.from({length: FULL_SCORE + 1}, (_, byte) => evenColour(byte / FULL_SCORE).map((c) => 255 * c));
    const context = canvas.getContext('2d');
    const picture = context.createImageData(this.count, this.count);
    this.order.forEach((i, row) =>
      this.order.forEach((j, column) => {
        const byte = i === j ? NOT_COMPARED : this.#byte(i, j);
        if (byte <= FULL_SCORE) picture.data.set([...colours[byte], 255], 4 * (row * this.count + column));
      }),
    );
    context.putImageData(picture, 0, 0);
    return canvas;
  }

  #gaps(context) {
    const side = this.cell * this.count;
    for (let k = 1; k <= this.count; ++k) {
      context.clearRect(this.margin + k * this.cell - 1, this.margin, 1, side);
      context.clearRect(this.margin, this.margin + k * this.cell - 1, side, 1);
    }
  }

  /** [row, column] of the joins that the assembly uses, on both sides of the diagonal. */
  #usedCells() {
    const places = [];
    this.order.forEach((index, place) => (places[index] = place));
    return this.data.pairs.filter((pair) => pair.used).flatMap(({a, b}) => [[places[a], places[b]], [places[b], places[a]]]);
  }

  #frame(context, row, column, colour, width) {
    context.strokeStyle = colour;
    context.lineWidth = width;
    context.strokeRect(this.margin + column * this.cell + width / 2 - 0.5, this.margin + row * this.cell + width / 2 - 0.5, this.cell - width, this.cell - width);
  }

  #labels(context, style) {
    context.fillStyle = style.getPropertyValue('--ink');
    context.font = `${Math.min(13, this.cell - 2)}px system-ui, sans-serif`;
    context.textBaseline = 'middle';
    this.order.forEach((index, k) => {
      const text = shortened(tidy(this.data.fragments[index].name), 18);
      const at = this.margin + (k + 0.5) * this.cell;
      context.textAlign = 'right';
      context.fillText(text, this.margin - 8, at, this.margin - 10);
      context.save();
      context.translate(at, this.margin - 8);
      context.rotate(-Math.PI / 2);
      context.textAlign = 'left';
      context.fillText(text, 0, 0, this.margin - 10);
      context.restore();
    });
  }

  #point(event) {
    const box = this.canvas.getBoundingClientRect();
    const column = Math.floor((event.clientX - box.left - this.margin) / this.cell);
    const row = Math.floor((event.clientY - box.top - this.margin) / this.cell);
    if (row < 0 || column < 0 || row >= this.count || column >= this.count) return false;
    this.cursor = [row, column];
    this.#tell();
    return true;
  }

  #key(event) {
    const step = {ArrowLeft: [0, -1], ArrowRight: [0, 1], ArrowUp: [-1, 0], ArrowDown: [1, 0]}[event.key];
    if (step) this.cursor = this.cursor.map((at, k) => Math.min(Math.max(at + step[k], 0), this.count - 1));
    else if (event.key === 'Enter') this.#choose();
    else return;
    event.preventDefault();
    this.draw();
    this.#reveal();
    this.#tell();
  }

  /** Scrolls to the cursor's cell. */
  #reveal() {
    const [top, left] = this.cursor.map((at) => this.margin + at * this.cell);
    const box = this.canvas.parentElement;
    box.scrollLeft = Math.min(Math.max(box.scrollLeft, left + 2 * this.cell - box.clientWidth), Math.max(0, left - this.cell));
    const y = this.canvas.getBoundingClientRect().top + top;
    if (y < 0) window.scrollBy(0, y - 2 * this.cell);
    else if (y + this.cell > window.innerHeight) window.scrollBy(0, y + 2 * this.cell - window.innerHeight);
  }

  #chosen() {
    return this.cursor.map((at) => this.order[at]);
  }

  #tell() {
    const [i, j] = this.#chosen();
    const name = (index) => nameElement(this.data.fragments[index].name, {limit: 48});
    this.canvas.title = tidy(this.data.fragments[i].name);
    if (i === j) return replace(this.readout, name(i));
    replace(this.readout, name(i), ' \u2013 ', name(j), ': ', this.#text(i, j));
    this.canvas.title = this.readout.textContent;
  }

  #choose() {
    const [i, j] = this.#chosen();
    if (i === j) return;
    this.pick(this.data.pairs.find(({a, b}) => (a === i && b === j) || (a === j && b === i)) ?? null, [i, j]);
  }
}
