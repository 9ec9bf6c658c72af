// What came out, in numbers, and what became of each fragment.
import {h, nameElement} from './dom.js';
import {TO_CHECK} from './joins.js';
import {counted, percent} from './numbers.js';

const LIKELY = 0.5;  // confidence from which a place is more likely right than wrong

/** @param choose (index) shows a fragment in 3D  @param check () shows the joins that somebody should look at */
export function overview(data, choose, check) {
  const placed = data.fragments.filter((fragment) => fragment.pose);
  const groups = new Set(placed.map((fragment) => fragment.group));
  const used = data.pairs.filter((pair) => pair.used);
  const figures = [
    [data.fragments.length, data.fragments.length === 1 ? 'fragment' : 'fragments'],
    [placed.length, 'placed'],
    [data.fragments.length - placed.length, 'not placed'],
    [groups.size, groups.size === 1 ? 'object' : 'objects'],
    [used.length, used.length === 1 ? 'join used' : 'joins used'],
    [data.compared, data.compared === 1 ? 'pair compared' : 'pairs compared'],
  ];
  if (data.failed > 0) figures.push([data.failed, data.failed === 1 ? 'pair failed' : 'pairs failed']);
  if (data.apart > 0) figures.push([data.apart, data.apart === 1 ? 'pair apart in the layout' : 'pairs apart in the layout']);
  if (data.missing > 0) figures.push([data.missing, data.missing === 1 ? 'pair not compared yet' : 'pairs not compared yet']);
  return h(
    'section',
    {id: 'overview', 'aria-labelledby': 'overview-title'},
    h('h2', {id: 'overview-title'}, 'Overview'),
    h('ul', {class: 'counts'}, figures.map(([number, word]) => h('li', {}, h('b', {}, number.toLocaleString('en')), word))),
    data.warnings.length > 0 && h('div', {class: 'warnings', role: 'note'}, h('h3', {}, counted(data.warnings.length, 'warning')), h('ul', {}, data.warnings.map((text) => h('li', {}, h('bdi', {}, text))))),
    missing(data, choose),
    objects(data, groups, choose),
    toCheck(data, check),
  );
}

function button(data, index, choose, limit = 32) {
  return h('button', {type: 'button', class: 'link', onclick: () => choose([index])}, nameElement(data.fragments[index].name, {limit}));
}

function allPlaced(unsure) {
  if (unsure.length === 0) return h('p', {class: 'good'}, 'Every fragment has its place.');
  return h('p', {}, `Every fragment has a place, ${unsure.length.toLocaleString('en')} of them with a confidence below ${percent(LIKELY)}: look at their joins.`);
}

function missing(data, choose) {
  const loose = [...data.fragments.keys()].filter((index) => !data.fragments[index].pose);
  if (loose.length === 0) return allPlaced(data.fragments.filter(({confidence}) => confidence !== null && confidence < LIKELY));
  return h(
    'div',
    {class: 'missing'},
    h('h3', {}, 'Not placed, and why'),
    h('div', {class: 'scroll', tabindex: 0, role: 'region', 'aria-label': 'Fragments not placed'}, h('table', {}, h('thead', {}, h('tr', {}, h('th', {scope: 'col'}, 'fragment'), h('th', {scope: 'col'}, 'why'), h('th', {scope: 'col'}, 'best score'))), h('tbody', {}, loose.map((index) => h('tr', {}, h('td', {}, button(data, index, choose)), h('td', {}, data.fragments[index].reason || 'no joint was sure enough'), h('td', {class: 'number'}, best(data, index))))))),
  );
}

function best(data, index) {
  const pair = data.pairs.find(({a, b, failed}) => !failed && (a === index || b === index));
  if (!pair) return '\u2013';
  const other = data.fragments[pair.a === index ? pair.b : pair.a];
  return [percent(pair.score), ' with ', nameElement(other.name, {limit: 24})];
}

function toCheck(data, check) {
  const count = data.pairs.filter(TO_CHECK).length;
  if (count === 0) return null;
  return h('p', {class: 'next'}, 'Next: ', h('button', {type: 'button', class: 'link', onclick: check}, `look at ${counted(count, 'join')}`), ' of which the scores are not sure, and say which are true.');
}

function objects(data, groups, choose) {
  if (groups.size === 0) return null;
  const rows = [...groups].sort((a, b) => a - b).map((group) => {
    const members = [...data.fragments.keys()].filter((index) => data.fragments[index].pose && data.fragments[index].group === group);
    const sure = members.map((index) => data.fragments[index].confidence).filter((value) => value !== null);
    return h('tr', {}, h('th', {scope: 'row'}, group + 1), h('td', {class: 'number'}, members.length), h('td', {class: 'number'}, sure.length ? percent(Math.min(...sure)) : '\u2013'), h('td', {class: 'members'}, members.map((index, k) => [k > 0 && ' ', h('span', {class: 'member'}, button(data, index, choose, 24), k + 1 < members.length && ',')])));
  });
  return h('div', {class: 'objects'}, h('h3', {}, 'Objects'), h('div', {class: 'scroll', tabindex: 0, role: 'region', 'aria-label': 'Objects'}, h('table', {}, h('thead', {}, h('tr', {}, h('th', {scope: 'col'}, 'object'), h('th', {scope: 'col'}, 'pieces'), h('th', {scope: 'col'}, 'least confidence'), h('th', {scope: 'col'}, 'fragments'))), h('tbody', {}, rows))));
}
