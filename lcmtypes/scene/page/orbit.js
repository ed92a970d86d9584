// The virtual camera: it turns around a target with the mouse, fingers and keys.

import {add, cross, dot, lookAt, norm, perspective, product, scaled, sub, unit} from './math.js';

const kFov_rad = 0.9;

/** Positions are relative to the origin of the view, which is near the map: floats are exact there. */
export class Orbit {
  /** `onChange(isMoving)`: draw again; isMoving: a person moves the view. */
  constructor(canvas, onChange) {
    this.canvas = canvas;
    this.onChange = onChange;
    this.up = [0, -1, 0];
    this.ahead = [0, 0, 1];
    this.target = [0, 0, 0];
    this.distance = 5;
    this.yaw = -0.5;
    this.pitch = 0.8;
    this.isFree = false;  // the person has moved it: it does not follow the growing map
    this.onClick = () => {};
    this.pointers = new Map();
    this.listen();
  }

  /** Axes: ahead and right are horizontal. */
  setUp(up) {
    this.up = unit(up);
    const forward = Math.abs(this.up[2]) < 0.9 ? [0, 0, 1] : [1, 0, 0];
    this.ahead = unit(sub(forward, scaled(this.up, dot(forward, this.up))));
  }

  offset() {
    const right = cross(this.ahead, this.up);
    const away = add(scaled(this.ahead, -Math.cos(this.yaw)), scaled(right, Math.sin(this.yaw)));
    return add(scaled(away, Math.cos(this.pitch)), scaled(this.up, Math.sin(this.pitch)));
  }

  /** The whole box [min, max] in the picture. */
  fit(min, max) {
    this.target = scaled(add(min, max), 0.5);
    this.distance = Math.max(0.5, 0.5 * norm(sub(max, min)) / Math.tan(kFov_rad / 2) * 0.9);
    this.onChange(false);
  }

  /** Matrices of the present view, its eye, and the focal length in pixels of the canvas. */
  view() {
    const eye = add(this.target, scaled(this.offset(), this.distance));
    const aspect = this.canvas.width / this.canvas.height;
    const near = Math.max(0.02, this.distance / 500);
    const projection = perspective(kFov_rad, aspect, near, near * 50000);
    const view = lookAt(eye, this.target, this.up);
    return {eye, projection, view, both: product(projection, view),
      focal_px: this.canvas.height / 2 / Math.tan(kFov_rad / 2)};
  }

  turn(dx, dy) {
    this.yaw += dx * 0.006;
    this.pitch = Math.min(1.55, Math.max(-1.55, this.pitch + dy * 0.006));
    this.changed();
  }

  move(dx, dy) {
    const scale = 2 * this.distance * Math.tan(kFov_rad / 2) / this.canvas.clientHeight;
    const back = this.offset();
    const right = unit(cross(this.up, back));
    const top = cross(back, right);
    this.target = add(this.target, add(scaled(right, -dx * scale), scaled(top, dy * scale)));
    this.changed();
  }

  zoom(factor) {
    this.distance = Math.min(1e4, Math.max(0.1, this.distance * factor));
    this.changed();
  }

  changed() {
    this.isFree = true;
    this.onChange(true);
  }

  listen() {
    const canvas = this.canvas;
    canvas.addEventListener('contextmenu', (event) => event.preventDefault());
    canvas.addEventListener('wheel', (event) => {
      event.preventDefault();
      this.zoom(Math.exp(Math.max(-200, Math.min(200, event.deltaY)) * 0.0015));
    }, {passive: false});
    canvas.addEventListener('pointerdown', (event) => {
      canvas.setPointerCapture(event.pointerId);
      this.pointers.set(event.pointerId, {x: event.offsetX, y: event.offsetY});
      this.moved_px = 0;
    });
    canvas.addEventListener('pointermove', (event) => this.drag(event));
    for (const name of ['pointerup', 'pointercancel']) {
      canvas.addEventListener(name, (event) => {
        const isClick = this.pointers.size === 1 && this.moved_px < 5 && event.button === 0;
        this.pointers.delete(event.pointerId);
        if (isClick && name === 'pointerup') this.onClick(event.offsetX, event.offsetY);
      });
    }
    canvas.addEventListener('keydown', (event) => {
      const turns = {ArrowLeft: [-20, 0], ArrowRight: [20, 0], ArrowUp: [0, 20], ArrowDown: [0, -20]};
      if (turns[event.key]) this.turn(...turns[event.key]);
      if (event.key === '+') this.zoom(0.85);
      if (event.key === '-') this.zoom(1.18);
    });
  }

  drag(event) {
    const before = this.pointers.get(event.pointerId);
    if (!before) return;
    const here = {x: event.offsetX, y: event.offsetY};
    const [dx, dy] = [here.x - before.x, here.y - before.y];
    this.moved_px += Math.abs(dx) + Math.abs(dy);
    if (this.pointers.size === 2) {
      const [other] = [...this.pointers].filter(([id]) => id !== event.pointerId).map(([, p]) => p);
      const length = (p) => Math.max(1, Math.hypot(p.x - other.x, p.y - other.y));
      this.zoom(length(before) / length(here));
      this.move(dx / 2, dy / 2);
    } else if (event.buttons & 2 || event.buttons & 4 || event.shiftKey) {
      this.move(dx, dy);
    } else {
      this.turn(dx, dy);
    }
    this.pointers.set(event.pointerId, here);
  }
}
