// Surfaces out of the page's data (src/report/detail/page_geometry.hpp packs them).
import {BufferAttribute, BufferGeometry} from 'three';
import {MeshoptDecoder} from 'three/examples/jsm/libs/meshopt_decoder.module.js';
import {bytesOf} from './numbers.js';

/** Resolves when surfaces can be decoded. */
export const ready = MeshoptDecoder.ready;

/**
 * A fragment's surface about its own centre, so that single precision is enough wherever the scan lies.
 * @returns {{geometry: BufferGeometry, centre: number[], radius: number, gaps: Uint8Array, scan: Uint8Array|null}}
 *   centre: file coordinates; gaps: 0 = no contact, else 128 + 127 * gap / scale; scan: red, green, blue, 255
 */
export function decode(packed) {
  const count = packed.vertices;
  const vertices = new Uint8Array(8 * count);
  MeshoptDecoder.decodeVertexBuffer(vertices, count, 8, bytesOf(packed.vertex));
  const steps = new Uint16Array(vertices.buffer);
  const low = [65535, 65535, 65535];
  const high = [0, 0, 0];
  for (let k = 0; k < count; ++k) {
    for (let axis = 0; axis < 3; ++axis) {
      const at = steps[4 * k + axis];
      if (at < low[axis]) low[axis] = at;
      if (at > high[axis]) high[axis] = at;
    }
  }
  const middle = low.map((at, axis) => (at + high[axis]) / 2);
  const positions = new Float32Array(3 * count);
  const gaps = new Uint8Array(count);
  for (let k = 0; k < count; ++k) {
    for (let axis = 0; axis < 3; ++axis) positions[3 * k + axis] = (steps[4 * k + axis] - middle[axis]) * packed.step;
    gaps[k] = vertices[8 * k + 6];
  }
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(positions, 3));
  geometry.setIndex(new BufferAttribute(decodeIndex(packed), 1));
  geometry.computeVertexNormals();
  geometry.computeBoundingSphere();
  return {
    geometry,
    centre: packed.low.map((at, axis) => at + middle[axis] * packed.step),
    radius: geometry.boundingSphere.radius,
    gaps,
    scan: packed.colour === '' ? null : decodeColours(packed),
  };
}

function decodeIndex(packed) {
  const wide = new Uint8Array(12 * packed.faces);
  MeshoptDecoder.decodeIndexBuffer(wide, 3 * packed.faces, 4, bytesOf(packed.index));
  return new Uint32Array(wide.buffer);
}

function decodeColours(packed) {
  const colours = new Uint8Array(4 * packed.vertices);
  MeshoptDecoder.decodeVertexBuffer(colours, packed.vertices, 4, bytesOf(packed.colour));
  return colours;
}
