import assert from 'node:assert/strict';
import {readFileSync} from 'node:fs';
import {test} from 'node:test';
import {evenColour, gapColour, NONE} from '../src/colours.js';
import {constraintsText} from '../src/decisions.js';
import {shortened, tidy} from '../src/dom.js';
import {ballOf, cross, frameOf, mainAxes, rows, shifts} from '../src/layout.js';
import {bytesOf, counted, percent, short} from '../src/numbers.js';

const distance = (a, b) => Math.hypot(...a.map((c, k) => c - b[k]));

test('discs in rows never touch and stand about the middle', () => {
  const radii = [3, 1, 2, 2, 5, 0.5, 1, 1];
  const {places, height} = rows(radii);
  places.forEach((place, i) => {
    for (let j = 0; j < i; ++j) assert.ok(distance(place, places[j]) > radii[i] + radii[j], `${i} and ${j}`);
    assert.ok(place[1] + radii[i] <= height && place[1] - radii[i] >= 0);
  });
  const edge = (side) => Math.max(...places.map(([x], k) => side * x + radii[k]));
  assert.ok(Math.abs(edge(1) - edge(-1)) < 2);
});

test('no discs make no rows', () => assert.deepEqual(rows([]), {places: [], height: 0}));

test('a ball holds the balls it is made for', () => {
  const balls = [{centre: [0, 0, 0], radius: 1}, {centre: [5, 0, 1], radius: 2}];
  const ball = ballOf(balls);
  for (const {centre, radius} of balls) assert.ok(distance(centre, ball.centre) + radius <= ball.radius + 1e-12);
});

test('a frame holds the balls in the axes of the eye', () => {
  const balls = [{centre: [0, 0, 0], radius: 1}, {centre: [5, 0, 1], radius: 2}];
  const frame = frameOf(balls, {right: [1, 0, 0], up: [0, 1, 0], back: [0, 0, 1]});
  assert.deepEqual(frame.half, [4, 2, 2]);
  assert.deepEqual(frame.centre, [3, 0, 1]);
});

const PIECES = [
  {centre: [10, 0, 0], radius: 1, group: 0},
  {centre: [12, 0, 0], radius: 1, group: 0},
  {centre: [900, 5, 5], radius: 2, group: 4},
  {centre: [-3, 0, 0], radius: 1, group: null},
];
const AXES = {right: [1, 0, 0], up: [0, 1, 0]};
const standing = (explode) => shifts(PIECES, explode, AXES).map((shift, k) => shift.map((s, axis) => s + PIECES[k].centre[axis]));

test('together, the fragments of an object keep their places to each other', () => {
  const at = standing(0);
  assert.deepEqual(at[1].map((c, k) => c - at[0][k]), [2, 0, 0]);
});

test('pulled apart, they stand farther from each other by the slider', () => {
  const at = standing(1.5);
  assert.ok(Math.abs(distance(at[0], at[1]) - 2 * 2.5) < 1e-12);
});

test('objects and loose pieces never overlap, however far apart the fragments are pulled', () => {
  for (const explode of [0, 0.7, 2]) {
    const at = standing(explode);
    for (const [i, j] of [[0, 2], [1, 2], [0, 3], [1, 3], [2, 3]]) {
      assert.ok(distance(at[i], at[j]) > PIECES[i].radius + PIECES[j].radius, `${i} and ${j} at ${explode}`);
    }
  }
});

test('main axes are those of a box, longest first, right-handed', () => {
  const points = [];
  for (const x of [-3, 3]) for (const y of [-1, 1]) for (const z of [-2, 2]) points.push([100 + x, y, z]);
  const [most, middle, least] = mainAxes(points);
  assert.ok(Math.abs(Math.abs(most[0]) - 1) < 1e-6);
  assert.ok(Math.abs(Math.abs(middle[2]) - 1) < 1e-6);
  assert.ok(distance(cross(most, middle), least) < 1e-12);
});

test('main axes of points without extent are still axes', () => {
  for (const axis of mainAxes([[1, 1, 1], [1, 1, 1]])) assert.ok(Math.abs(Math.hypot(...axis) - 1) < 1e-9);
});

test('long names keep both ends and whole characters', () => {
  assert.equal(shortened('abcdefghij', 5), 'ab\u2026ij');
  assert.equal(shortened('\u{1f3fa}'.repeat(10), 3), '\u{1f3fa}\u2026\u{1f3fa}');
  assert.equal(shortened('short', 5), 'short');
});

test('characters that could fake another name are made visible', () => {
  assert.equal(tidy('a\u202eb\nc\u0000'), 'a\ufffdb\ufffdc\ufffd');
  assert.equal(tidy(''), '(no name)');
  assert.equal(tidy('\u05e9\u05d1\u05e8 \u7881'), '\u05e9\u05d1\u05e8 \u7881');
});

test('the constraints file has a line a pair, holds any name, and shows what is invisible', () => {
  const names = ['Rand S\u00fcd.ply', 'a "b"\\.ply', 'x\u202e\n.ply'];
  const turned = [0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 5.5, 6, 7, 1]; // column major
  const text = constraintsText(names, {must_join: [[0, 1], [2, 0]], must_not_join: [[1, 2]]}, [[2, turned]]);
  assert.deepEqual(JSON.parse(text), {
    must_join: [[names[0], names[1]], [names[2], names[0]]],
    must_not_join: [[names[1], names[2]]],
    poses: {[names[2]]: [[0, -1, 0, 5.5], [1, 0, 0, 6], [0, 0, 1, 7], [0, 0, 0, 1]]},
  });
  assert.ok(text.includes('\\u202e\\n') && text.includes('S\u00fcd'), text);
  assert.ok(text.split('\n').includes('  ["Rand S\u00fcd.ply", "a \\"b\\"\\\\.ply"],'), text);
  assert.deepEqual(JSON.parse(constraintsText(names, {must_join: [], must_not_join: []}, [])), {});
});

test('numbers are short, and missing ones a dash', () => {
  assert.equal(short(0.012345), '0.0123');
  assert.equal(short(1234.5), '1,235');
  assert.equal(short(1e-9), '1.00e-9');
  assert.equal(short(null), '\u2013');
  assert.equal(percent(0.934), '93 %');
  assert.equal(percent(null), '\u2013');
  assert.equal(counted(1, 'piece'), '1 piece');
});

test('base64 gives its bytes back', () => assert.deepEqual([...bytesOf('//79')], [255, 254, 253]));

test('gap colours tell overlap, touch, apart and nothing', () => {
  assert.ok(gapColour(-1)[0] > gapColour(-1)[2] + 0.2);
  assert.ok(gapColour(1)[2] > gapColour(1)[0] + 0.2);
  assert.ok(Math.min(...gapColour(0)) > 0.8);
  assert.deepEqual(gapColour(null), NONE);
});

test('confidence grows with lightness', () => {
  const light = [0, 0.25, 0.5, 0.75, 1].map((share) => evenColour(share).reduce((sum, c, k) => sum + c * [0.2126, 0.7152, 0.0722][k], 0));
  light.slice(1).forEach((value, k) => assert.ok(value > light[k]));
});

test('the lock file names no host, so that any registry may serve it', () => {
  assert.doesNotMatch(readFileSync(new URL('../package-lock.json', import.meta.url), 'utf8'), /"resolved"|:\/\//);
});
