// The 3D picture: surfaces, light, camera.  Draws only when something changed.
import {
  BufferAttribute,
  Color,
  DirectionalLight,
  DoubleSide,
  HemisphereLight,
  Matrix4,
  Mesh,
  MeshLambertMaterial,
  PerspectiveCamera,
  Quaternion,
  Raycaster,
  Scene,
  Vector2,
  Vector3,
  WebGLRenderer,
} from 'three';
import {decode} from './geometry.js';
import {cross, mainAxes, shifts, unit} from './layout.js';
import {Orbit} from './orbit.js';

const SELECTED = 0x55400a;

export class Stage {
  /** @param tapped (index of the fragment, or null)  @throws if WebGL is not there */
  constructor(canvas, tapped) {
    this.canvas = canvas;
    this.renderer = new WebGLRenderer({canvas, antialias: true, alpha: true});
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio || 1, 2));
    this.scene = new Scene();
    this.camera = new PerspectiveCamera(28, 1, 0.1, 10);
    this.scene.add(new HemisphereLight(0xffffff, 0x5c574e, 1.5), this.camera);
    const key = new DirectionalLight(0xffffff, 2.1);
    key.position.set(-0.7, 0.9, 1);
    this.camera.add(key, key.target);
    key.target.position.set(0, 0, -1);
    this.orbit = new Orbit(this.camera, canvas, {
      changed: () => this.draw(),
      tapped: (x, y) => tapped(this.#at(x, y)),
    });
    this.pieces = [];
    this.explode = 0;
    new ResizeObserver(() => this.#resize()).observe(canvas.parentElement);
  }

  /** Decodes the surfaces; fragments without one are left out. */
  load(fragments) {
    fragments.forEach((fragment, index) => {
      if (!fragment.mesh) return;
      const decoded = decode(fragment.mesh);
      const material = new MeshLambertMaterial({side: DoubleSide});
      const mesh = new Mesh(decoded.geometry, material);
      mesh.matrixAutoUpdate = false;
      this.scene.add(mesh);
      const pose = new Matrix4().fromArray(fragment.pose ?? new Matrix4().elements);
      const centre = new Vector3(...decoded.centre).applyMatrix4(pose).toArray();
      this.pieces.push({index, mesh, pose, centre, ...pick(decoded), group: fragment.group, file: decoded.centre});
    });
    this.#chooseView();
    this.setExplode(0);
  }

  piece(index) {
    return this.pieces.find((piece) => piece.index === index);
  }

  /** 0 = together. */
  setExplode(explode) {
    this.explode = explode;
    shifts(this.pieces, explode, this.axes).forEach((shift, k) => {
      const {mesh, pose, file} = this.pieces[k];
      mesh.matrix.makeTranslation(...shift).multiply(pose).multiply(new Matrix4().makeTranslation(...file));
      mesh.matrixWorldNeedsUpdate = true;
      this.pieces[k].now = this.pieces[k].centre.map((c, axis) => c + shift[axis]);
    });
    this.draw();
  }

  /** @param visible (index) => boolean */
  setVisible(visible) {
    for (const piece of this.pieces) piece.mesh.visible = visible(piece.index);
    this.draw();
  }

  /** One colour a fragment. @param colourOf (index) => [r, g, b] sRGB */
  colourPieces(colourOf) {
    for (const {index, mesh} of this.pieces) {
      mesh.material.vertexColors = false;
      mesh.material.color.setRGB(...colourOf(index), 'srgb');
      mesh.material.needsUpdate = true;
    }
    this.draw();
  }

  /** One colour a vertex. @param colourOf (piece, vertex) => [r, g, b] sRGB */
  colourVertices(colourOf) {
    const colour = new Color();
    for (const piece of this.pieces) {
      const count = piece.mesh.geometry.attributes.position.count;
      const values = new Float32Array(3 * count);
      for (let k = 0; k < count; ++k) colour.setRGB(...colourOf(piece, k), 'srgb').toArray(values, 3 * k);
      piece.mesh.geometry.setAttribute('color', new BufferAttribute(values, 3));
      piece.mesh.material.vertexColors = true;
      piece.mesh.material.color.setRGB(1, 1, 1);
      piece.mesh.material.needsUpdate = true;
    }
    this.draw();
  }

  /** @param chosen set of indices that are marked */
  mark(chosen) {
    for (const {index, mesh} of this.pieces) mesh.material.emissive.setHex(chosen.has(index) ? SELECTED : 0);
    this.draw();
  }

  /** Shows everything that is visible. */
  fit() {
    const shown = this.pieces.filter((piece) => piece.mesh.visible);
    const balls = (shown.length ? shown : this.pieces).map(({now, radius}) => ({centre: now, radius}));
    if (balls.length > 0) this.orbit.fit(balls);
  }

  /** Back to the first view. */
  reset() {
    this.camera.quaternion.copy(this.firstTurn);
    this.fit();
  }

  draw() {
    if (this.waiting) return;
    this.waiting = true;
    requestAnimationFrame(() => {
      this.waiting = false;
      this.renderer.render(this.scene, this.camera);
    });
  }

  /** The flat side of the largest object towards the eye, its length from left to right, a little from above. */
  #chooseView() {
    const sizes = new Map();
    for (const {group, radius} of this.pieces) {
      if (group !== null) sizes.set(group, (sizes.get(group) ?? 0) + radius ** 2);
    }
    const largest = [...sizes].sort((a, b) => b[1] - a[1])[0]?.[0];
    const points = [];
    for (const piece of this.pieces) {
      if (largest !== undefined && piece.group !== largest) continue;
      const position = piece.mesh.geometry.attributes.position;
      const matrix = piece.pose.clone().multiply(new Matrix4().makeTranslation(...piece.file));
      const step = Math.max(1, Math.floor(position.count / 200));
      for (let k = 0; k < position.count; k += step) {
        points.push(new Vector3().fromBufferAttribute(position, k).applyMatrix4(matrix).toArray());
      }
    }
    const [right, up, back] = mainAxes(points);
    const eye = unit(back.map((c, k) => c - 0.45 * up[k]));
    this.axes = {right, up: unit(cross(eye, right))};
    const basis = new Matrix4().makeBasis(new Vector3(...right), new Vector3(...this.axes.up), new Vector3(...eye));
    this.firstTurn = new Quaternion().setFromRotationMatrix(basis);
    this.camera.quaternion.copy(this.firstTurn);
  }

  #at(x, y) {
    const ray = new Raycaster();
    const place = new Vector2((2 * x) / this.canvas.clientWidth - 1, 1 - (2 * y) / this.canvas.clientHeight);
    this.camera.updateMatrixWorld();
    ray.setFromCamera(place, this.camera);
    const shown = this.pieces.filter((piece) => piece.mesh.visible);
    const [hit] = ray.intersectObjects(shown.map((piece) => piece.mesh), false);
    return hit ? shown.find((piece) => piece.mesh === hit.object).index : null;
  }

  #resize() {
    const {clientWidth: width, clientHeight: height} = this.canvas.parentElement;
    if (width === 0 || height === 0) return;
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    if (this.pieces.length > 0 && !this.fitted) {
      this.fitted = true;
      this.fit();
    }
    this.draw();
  }
}

function pick({radius, gaps, scan}) {
  return {radius, gaps, scan};
}
