// The page of a run, made of the data that lies in it.
import {Assembly} from './assembly.js';
import {Decisions} from './decisions.js';
import {h, nameElement, replace} from './dom.js';
import {Joins} from './joins.js';
import {Matrix} from './matrix.js';
import {overview} from './overview.js';

const SECTIONS = [
  ['overview', 'Overview'],
  ['assembly', 'Assembly'],
  ['joins', 'Joins'],
  ['matrix', 'Pairs'],
  ['parameters', 'Parameters'],
];

function parameters(data) {
  const rows = data.parameters.map(([name, value]) => h('tr', {}, h('th', {scope: 'row'}, name), h('td', {}, h('bdi', {class: 'path'}, value))));
  return h('section', {id: 'parameters', 'aria-labelledby': 'parameters-title'}, h('h2', {id: 'parameters-title'}, 'Parameters'), h('div', {class: 'scroll', tabindex: 0, role: 'region', 'aria-label': 'Parameters'}, h('table', {}, h('tbody', {}, rows))), h('footer', {}, `Made by rejoin ${data.version}. Lengths are in the unit of the scans.`));
}

/** A picture over the page. */
function lightbox() {
  const body = h('div', {class: 'large'});
  const dialog = h('dialog', {'aria-label': 'Picture', onclick: () => dialog.close()}, body);
  const open = (picture, names) => {
    replace(body, h('img', {src: `data:image/jpeg;base64,${picture.jpeg}`, alt: picture.title, width: picture.width, height: picture.height}), h('p', {}, names, h('br'), picture.title), h('button', {type: 'button', onclick: () => dialog.close()}, 'Close'));
    dialog.showModal();
  };
  return {dialog, open};
}

function themeButton() {
  const root = document.documentElement;
  const dark = () => (root.dataset.theme ?? (matchMedia('(prefers-color-scheme: dark)').matches ? 'dark' : 'light')) === 'dark';
  const button = h('button', {type: 'button', class: 'theme', onclick: () => turn()}, dark() ? 'Light' : 'Dark');
  const turn = () => {
    root.dataset.theme = dark() ? 'light' : 'dark';
    button.textContent = dark() ? 'Light' : 'Dark';
    window.dispatchEvent(new Event('themechange'));
  };
  return button;
}

function start() {
  const data = JSON.parse(document.getElementById('report').textContent);
  const large = lightbox();
  const toView = () => assembly.element.scrollIntoView({block: 'start'});
  const assembly = new Assembly(data, (pair) => joins.open(pair));
  const isolate = (indices) => {
    assembly.isolate(indices);
    toView();
  };
  const joins = new Joins(data, new Decisions(data), isolate, large.open);
  const choose = (indices) => {
    assembly.choose(indices);
    toView();
  };
  const matrix = new Matrix(data, (pair, indices) => (pair ? joins.open(pair) : isolate(indices)));
  window.addEventListener('themechange', () => matrix.draw());
  const links = SECTIONS.map(([id, label]) => h('a', {href: `#${id}`}, label));
  document.body.append(
    h('header', {class: 'top'}, nameElement(data.title, {tag: 'h1', limit: 60}), h('nav', {'aria-label': 'Sections'}, links), themeButton()),
    h('main', {}, overview(data, choose, () => joins.check()), assembly.element, joins.element, matrix.element, parameters(data)),
    large.dialog,
  );
  assembly.start().then(() => document.body.classList.add('ready'));
}

start();
