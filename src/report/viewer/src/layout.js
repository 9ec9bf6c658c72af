// Where everything stands: objects beside each other, their fragments pulled apart, loose pieces below.

/** Rows of discs that do not touch, filled from the left; rows about as long as `aspect` times their number. */
export function rows(radii, aspect = 1.6) {
  const room = radii.map((r) => 2.15 * r);
  const area = room.reduce((sum, side) => sum + side * side, 0);
  const width = Math.max(Math.max(0, ...room), Math.sqrt(area * aspect));
  const places = [];
  let x = 0;
  let y = 0;
  let height = 0;
  room.forEach((side, k) => {
    if (x > 0 && x + side > width * 1.001) {
      x = 0;
      y += height;
      height = 0;
    }
    places[k] = [x + side / 2, y + side / 2];
    x += side;
    height = Math.max(height, side);
  });
  const right = Math.max(0, ...places.map(([px], k) => px + room[k] / 2));
  return {places: places.map(([px, py]) => [px - right / 2, py]), height: y + height};
}

/** A ball about the mean centre that holds all the balls given. */
export function ballOf(balls) {
  const weight = balls.reduce((sum, {radius}) => sum + radius ** 2, 0) || 1;
  const centre = [0, 1, 2].map((k) => balls.reduce((sum, ball) => sum + ball.centre[k] * ball.radius ** 2, 0) / weight);
  const radius = Math.max(0, ...balls.map((ball) => distance(ball.centre, centre) + ball.radius));
  return {centre, radius};
}

/** The box about balls in the axes of the eye {right, up, back}: its centre, and half its sides along them. */
export function frameOf(balls, axes) {
  const [right, up, back] = [axes.right, axes.up, axes.back].map((axis) => {
    const at = (ball) => ball.centre.reduce((sum, c, k) => sum + c * axis[k], 0);
    const low = Math.min(...balls.map((ball) => at(ball) - ball.radius));
    const high = Math.max(...balls.map((ball) => at(ball) + ball.radius));
    return {axis, middle: (low + high) / 2, half: (high - low) / 2};
  });
  const centre = [0, 1, 2].map((k) => [right, up, back].reduce((sum, {axis, middle}) => sum + axis[k] * middle, 0));
  return {centre, half: [right.half, up.half, back.half]};
}

function distance(a, b) {
  return Math.hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

/**
 * Shifts of all fragments in world axes.
 * @param pieces  [{centre, radius, group}]: where each stands in the common frame; group null: loose
 * @param explode 0 = together; 1 = fragments twice as far from their object's centre
 * @param axes    {right, up}: unit vectors along which objects and loose pieces are laid out
 * @returns one shift [x, y, z] a piece
 */
export function shifts(pieces, explode, axes) {
  const groups = new Map();
  const loose = [];
  pieces.forEach((piece, k) => {
    if (piece.group === null) loose.push(k);
    else groups.set(piece.group, [...(groups.get(piece.group) ?? []), k]);
  });
  const result = pieces.map(() => [0, 0, 0]);
  const balls = [...groups.values()].map((members) => ballOf(members.map((k) => pieces[k])));
  const grown = balls.map((ball) => ball.radius * (1 + explode));
  const placed = rows(grown);
  const at = ([x, y]) => axes.right.map((c, k) => c * x - axes.up[k] * y);
  [...groups.values()].forEach((members, number) => {
    const {centre} = balls[number];
    const place = at(placed.places[number]);
    for (const k of members) {
      result[k] = place.map((p, axis) => p - centre[axis] + explode * (pieces[k].centre[axis] - centre[axis]));
    }
  });
  const below = rows(loose.map((k) => pieces[k].radius), 6);
  loose.forEach((k, number) => {
    const [x, y] = below.places[number];
    const place = at([x, placed.height + y]);
    result[k] = place.map((p, axis) => p - pieces[k].centre[axis]);
  });
  return result;
}

/** Unit axes of a cloud of points by size of spread: [most, middle, least]. */
export function mainAxes(points) {
  const n = Math.max(1, points.length);
  const mean = [0, 1, 2].map((k) => points.reduce((sum, p) => sum + p[k], 0) / n);
  const matrix = [0, 1, 2].map((i) =>
    [0, 1, 2].map((j) => points.reduce((sum, p) => sum + (p[i] - mean[i]) * (p[j] - mean[j]), 0) / n),
  );
  const most = mainAxis(matrix, [1, 0.37, 0.11]);
  const size = most.reduce((sum, c, i) => sum + c * matrix[i].reduce((row, m, j) => row + m * most[j], 0), 0);
  const rest = matrix.map((row, i) => row.map((m, j) => m - size * most[i] * most[j]));
  const middle = mainAxis(rest, perpendicular(most));
  return [most, middle, cross(most, middle)];
}

/** By power iteration; `start` where the matrix is zero. */
function mainAxis(matrix, start) {
  let axis = unit(start);
  for (let k = 0; k < 60; ++k) {
    const next = matrix.map((row) => row.reduce((sum, m, j) => sum + m * axis[j], 0));
    if (Math.hypot(...next) < 1e-30) break;
    axis = unit(next);
  }
  return axis;
}

export function unit(v) {
  const length = Math.hypot(...v) || 1;
  return v.map((c) => c / length);
}

export function cross(a, b) {
  return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
}

function perpendicular(v) {
  const least = v.map(Math.abs).indexOf(Math.min(...v.map(Math.abs)));
  return unit(cross(v, [0, 1, 2].map((k) => (k === least ? 1 : 0))));
}
