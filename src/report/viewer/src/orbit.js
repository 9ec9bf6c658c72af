// Turning a camera about a point by mouse, fingers or keys; free in all directions, as sherds have no upright.
import {Quaternion, Vector3} from 'three';
import {frameOf} from './layout.js';

const TURN = 0.008; // radians a pixel
const TAP = 5; // pixels that a finger may slip in a tap

export class Orbit {
  /** @param changed called after every movement  @param tapped (x, y) in pixels of the element */
  constructor(camera, element, {changed, tapped}) {
    Object.assign(this, {camera, element, changed, tapped});
    this.target = new Vector3();
    this.distance = 1;
    this.reach = 1;
    this.pointers = new Map();
    this.travel = 0;
    element.style.touchAction = 'none';
    element.addEventListener('pointerdown', (event) => this.#down(event));
    element.addEventListener('pointermove', (event) => this.#move(event));
    for (const name of ['pointerup', 'pointercancel']) element.addEventListener(name, (event) => this.#up(event));
    element.addEventListener('wheel', (event) => this.#wheel(event), {passive: false});
    element.addEventListener('contextmenu', (event) => event.preventDefault());
  }

  /** Angles in radians about the camera's own axes. */
  turn(right, down) {
    const about = (x, y, z, angle) => new Quaternion().setFromAxisAngle(new Vector3(x, y, z), angle);
    this.camera.quaternion.multiply(about(0, 1, 0, -right)).multiply(about(1, 0, 0, -down)).normalize();
    this.#place();
  }

  /** Shares of the picture's height. */
  pan(right, down) {
    const height = 2 * this.distance * Math.tan((this.camera.fov * Math.PI) / 360);
    this.target.add(new Vector3(-right * height, down * height, 0).applyQuaternion(this.camera.quaternion));
    this.#place();
  }

  zoom(factor) {
    this.distance = Math.min(Math.max(this.distance * factor, 0.02 * this.reach), 20 * this.reach);
    this.#place();
  }

  /** Shows balls [{centre, radius}] whole. */
  fit(balls) {
    const axis = (x, y, z) => new Vector3(x, y, z).applyQuaternion(this.camera.quaternion).toArray();
    const {centre, half} = frameOf(balls, {right: axis(1, 0, 0), up: axis(0, 1, 0), back: axis(0, 0, 1)});
    const slope = Math.tan((this.camera.fov * Math.PI) / 360);
    this.target.set(...centre);
    this.reach = Math.hypot(...half) || 1;
    this.distance = 1.03 * Math.max(half[1] / slope, half[0] / (slope * this.camera.aspect)) + 0.6 * half[2];
    this.#place();
  }

  #place() {
    const back = new Vector3(0, 0, 1).applyQuaternion(this.camera.quaternion);
    this.camera.position.copy(this.target).addScaledVector(back, this.distance);
    this.camera.near = Math.max(this.distance - 6 * this.reach, this.distance / 200);
    this.camera.far = this.distance + 12 * this.reach;
    this.camera.updateProjectionMatrix();
    this.changed();
  }

  #down(event) {
    this.element.setPointerCapture(event.pointerId);
    if (this.pointers.size === 0) this.travel = 0;
    this.pointers.set(event.pointerId, [event.clientX, event.clientY]);
  }

  #move(event) {
    const before = this.pointers.get(event.pointerId);
    if (!before) return;
    const now = [event.clientX, event.clientY];
    const [dx, dy] = [now[0] - before[0], now[1] - before[1]];
    this.travel += Math.hypot(dx, dy);
    const height = this.element.clientHeight;
    if (this.pointers.size === 2) this.#pinch(event.pointerId, before, now, height);
    else if (event.shiftKey || event.buttons > 1) this.pan(dx / height, dy / height);
    else this.turn(dx * TURN, dy * TURN);
    this.pointers.set(event.pointerId, now);
  }

  #pinch(id, before, now, height) {
    const other = [...this.pointers].find(([key]) => key !== id)[1];
    const span = (p) => Math.hypot(p[0] - other[0], p[1] - other[1]) || 1;
    this.zoom(span(before) / span(now));
    this.pan((now[0] - before[0]) / 2 / height, (now[1] - before[1]) / 2 / height);
  }

  #up(event) {
    const tap = event.type === 'pointerup' && this.pointers.size === 1 && this.travel < TAP;
    this.pointers.delete(event.pointerId);
    if (!tap) return;
    const box = this.element.getBoundingClientRect();
    this.tapped(event.clientX - box.left, event.clientY - box.top);
  }

  /** Only while the picture has the focus, so that it does not catch a reader who scrolls past. */
  #wheel(event) {
    if (document.activeElement !== this.element && !event.ctrlKey) return;
    event.preventDefault();
    this.zoom(Math.exp(Math.min(Math.max(event.deltaY, -120), 120) / 500));
  }
}
