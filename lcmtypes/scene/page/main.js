// Puts the page together: asks for what has changed, draws when something has, and counts frames.

import {EmbeddedSource} from './embedded.js';
import {LiveSource} from './live.js';
import {add, rotated, rotationRows, sub} from './math.js';
import {Objects} from './objects.js';
import {Orbit} from './orbit.js';
import {Panel} from './panel.js';
import {Renderer} from './renderer.js';
import {Tiles} from './tiles.js';

const kPoll_ms = 500;
const kMaxDrawn = 1.5e6;  // points in a picture while the view moves; fewer on a slow GPU
const kMaxStill = 3e6;    // while it stands still
const kPathColour = [255, 190, 40];
const kLoopColour = [255, 70, 200];
const kCameraColour = [120, 255, 80];

const element = (id) => document.getElementById(id);

class Page {
  constructor() {
    this.source = EmbeddedSource.isHere() ? new EmbeddedSource() : new LiveSource();
    this.renderer = new Renderer(element('map'));
    this.tiles = new Tiles(this.renderer);
    this.orbit = new Orbit(element('map'), (isMoving) => this.redraw(isMoving));
    this.orbit.onClick = (x, y) => this.panel.select(this.pick(x, y));
    this.look = {mode: 1, selected: 0, backs: false};
    this.panel = new Panel(this.source, (id) => {
      this.look.selected = id;
      this.redraw();
    }, (segment) => this.goTo(segment));
    this.objects = new Objects(element('map'), (box) => this.goTo(box));
    this.budget = kMaxDrawn;
    this.epoch = 0;
    this.version = 0;
    this.segmentsVersion = 0;
    this.chosenPart = null;  // by the person; null: that of the camera
    this.lines = [];
    this.path = new Float32Array(0);
    this.frames = {times: [], moving: false};
    this.listen();
    this.poll();
    this.pump();
    // For tests and for people at the console.
    window.kintsugi = {page: this, stats: () => this.stats(), spin: (n) => this.spin(n)};
  }

  listen() {
    window.addEventListener('resize', () => this.redraw());
    for (const radio of document.querySelectorAll('input[name=colouring]')) {
      radio.addEventListener('change', () => {
        this.look.mode = radio.value === 'segments' ? 1 : 0;
        this.redraw();
      });
    }
    element('backs').addEventListener('change', (event) => {
      this.look.backs = event.target.checked;
      this.redraw();
    });
    for (const id of ['path', 'boxes']) element(id).addEventListener('change', () => this.redraw());
    element('overview').addEventListener('click', () => this.overview());
    element('part').addEventListener('change', (event) => {
      this.chosenPart = event.target.value === 'camera' ? null : Number(event.target.value);
      this.showPart();
      this.redraw();
    });
    document.addEventListener('keydown', (event) => {
      if (event.target instanceof HTMLInputElement) return;
      if (event.key === 'Escape') this.panel.select(0);
      if (event.key === 'o') this.overview();
    });
  }

  // ---- what has changed

  async poll() {
    for (;;) {
      try {
        await this.update();
        element('problem').textContent = this.state?.problem ?? '';
      } catch (error) {
        element('problem').textContent = `no answer from the viewer: ${error.message}`;
      }
      if (!this.source.isLive) return;
      await new Promise((resolve) => setTimeout(resolve, kPoll_ms));
    }
  }

  async update() {
    const state = await this.source.state(this.epoch, this.version);
    if (!state.parts) return;  // nothing has come yet
    if (state.epoch !== this.epoch) {  // another map
      this.epoch = state.epoch;
      this.segmentsVersion = 0;
      this.shownPart = null;
      this.tiles.clear();
      this.panel.clear();
      this.orbit.isFree = false;
    }
    this.version = state.version;
    this.state = state;
    this.tiles.apply(state.tiles, state.removed);
    this.showPart();
    this.describe();
    const isSame = state.tiles.length + state.removed.length === 0;
    if (state.segments_version !== this.segmentsVersion) {
      this.panel.apply(await this.source.segments(this.epoch, this.segmentsVersion));
      this.segmentsVersion = state.segments_version;
    }
    const areObjectsNew = this.objects.set(state.objects, this.tiles.box(), this.tiles.origin);
    if (await this.showCamera() || areObjectsNew || !isSame) this.redraw();
    this.wake?.();
  }

  /** The part of the map that is shown: the chosen one, or that of the camera. */
  showPart() {
    const {parts, camera_part: ofCamera} = this.state;
    const part = parts.find((p) => p.part === (this.chosenPart ?? ofCamera)) ?? parts[0];
    this.listParts(parts);
    if (!part) return;
    this.orbit.setUp(part.up);
    if (part.part !== this.shownPart) {
      this.shownPart = part.part;
      this.shownPath = -1;
      const any = [...this.tiles.byId.values()].find((t) => t.part === part.part && t.count > 0);
      this.tiles.setPart(part.part, any ? any.t.map((t, i) => t + any.min[i]) : [0, 0, 0]);
      this.orbit.isFree = false;
    }
    if (!this.orbit.isFree) this.overview(false);
  }

  listParts(parts) {
    const select = element('part');
    const text = parts.map((p) => p.part).join();
    select.hidden = parts.length < 2;
    if (text === this.listedParts) return;
    this.listedParts = text;
    const options = [['camera', "the camera's part"], ...parts.map((p) => [p.part, `part ${p.part}`])];
    select.replaceChildren(...options.map(([value, name]) => new Option(name, value)));
    select.value = this.chosenPart ?? 'camera';
  }

  describe() {
    const s = this.state;
    element('name').textContent = s.map || 'Kintsugi';
    const number = (n) => n.toLocaleString('en');
    const parts = [`${number(s.points)} points`, `${number(s.segments)} segments`];
    if (this.source.isLive) {
      parts.unshift(`${s.time_s.toFixed(1)} s`);
      parts.push(`${number(s.slices)} slices`, s.final ? 'complete' : `lag ${number(s.lag)} slices`);
    }
    element('status').textContent = parts.join(', ');
  }

  /** True when the camera has moved. */
  async showCamera() {
    const {image_version: image, path_version: path, frustum} = this.state;
    element('camera').hidden = !image;
    if (image && image !== this.shownImage) {
      element('camera_image').src = this.source.imageUrl(image);
      this.shownImage = image;
    }
    if (path !== this.shownPath) {
      this.shownPath = path;
      this.path = await this.source.path(this.shownPart ?? 0);
    }
    const where = JSON.stringify([path, frustum, this.shownPart]);
    if (where === this.shownWhere) return false;
    this.shownWhere = where;
    const relative = (points) => Float32Array.from(points, (p, i) => p - this.tiles.origin[i % 3]);
    this.lines = [{positions: relative(this.path), colour: kPathColour, isStrip: true},
      {positions: relative(this.state.loops), colour: kLoopColour, isStrip: false}];
    if (frustum && this.state.camera_part === this.shownPart) {
      this.lines.push({positions: relative(pyramid(frustum)), colour: kCameraColour, isStrip: false});
    }
    return true;
  }

  /** Fetches points as long as some are missing. */
  async pump() {
    for (;;) {
      const request = this.tiles.nextRequest();
      if (!request) {
        await new Promise((resolve) => { this.wake = resolve; });
        continue;
      }
      try {
        const kind = request.points ? 'points' : 'labels';
        const {epoch} = this;
        const blocks = await this.source[kind](request[kind]);
        if (epoch === this.epoch) this.tiles.accept(blocks);
      } catch (error) {
        await new Promise((resolve) => setTimeout(resolve, 1000));
      }
      this.redraw();
      await new Promise((resolve) => setTimeout(resolve, 0));
    }
  }

  // ---- drawing

  redraw(isMoving = false) {
    this.frames.moving ||= isMoving;
    if (this.isScheduled) return;
    this.isScheduled = true;
    requestAnimationFrame((now) => this.frame(now));
  }

  frame(now) {
    this.isScheduled = false;
    this.renderer.resize();
    const {moving} = this.frames;
    this.frames.moving = false;
    this.view = this.orbit.view();
    this.batches = this.tiles.select(this.view, moving ? this.budget : Math.max(this.budget, kMaxStill));
    const lines = element('path').checked ? [...this.lines] : [];
    if (element('boxes').checked) lines.push(this.objects.lines);
    this.renderer.draw(this.batches, this.view, this.look, lines);
    this.objects.placeNames(this.view, element('boxes').checked);
    if (moving) this.countFrame(now);
    this.wake?.();
  }

  /** Adapts the number of points to the speed of the GPU: 30 frames a second or more. */
  countFrame(now) {
    const {times} = this.frames;
    if (times.length > 0 && now - times[times.length - 1] > 1000) times.length = 0;
    times.push(now);
    clearTimeout(this.stillTimer);
    this.stillTimer = setTimeout(() => this.redraw(), 250);
    if (times.length > 12) times.shift();
    if (times.length < 6) return;
    const mean_ms = (now - times[0]) / (times.length - 1);
    if (mean_ms > 33) this.setBudget(Math.max(5e4, this.budget * Math.max(0.5, 30 / mean_ms)));
    if (mean_ms < 20) this.setBudget(Math.min(kMaxDrawn, this.budget * 1.3));
    const text = `${Math.round(1000 / mean_ms)} frames/s, ${(this.tiles.drawn / 1e6).toFixed(2)} M points drawn`;
    element('frame_rate').textContent = text;
  }

  setBudget(points) {
    this.budget = points;
    this.frames.times.length = 0;  // those of another number of points
  }

  overview(isAsked = true) {
    const box = this.tiles.box();
    if (!box) return;
    const text = box.join();  // a map that stands still is not drawn again and again
    if (!isAsked && text === this.fitted) return;
    this.fitted = text;
    this.orbit.fit(...box);
    this.orbit.isFree = false;
  }

  /** `box_min`, `box_max`: of what is to fill the view; W, metres. */
  goTo({box_min: min, box_max: max}) {
    const origin = this.tiles.origin;
    this.orbit.fit(sub(min, origin), sub(max, origin));
    this.orbit.distance *= 1.3;
    this.orbit.changed();
  }

  pick(x, y) {
    return this.batches ? this.renderer.pick(this.batches, this.view, this.look, x, y) : 0;
  }

  // ---- measuring

  stats() {
    let known = 0;
    for (const tile of this.tiles.byId.values()) known += tile.count;
    return {points_known: known, points_held: this.tiles.held, points_drawn: this.tiles.drawn ?? 0,
      tiles: this.tiles.byId.size, bytes: this.source.bytes, block_bytes: this.tiles.bytes,
      is_waiting: this.tiles.nextRequest() === null, selected: this.look.selected,
      segments: this.panel.segments.size, objects: this.objects.shown.length, version: this.version,
      multi_draw: Boolean(this.renderer.multi)};
  }

  /** Turns the view through `count` frames; resolves to frames a second and points drawn. */
  async spin(count) {
    const start = performance.now();
    let drawn = 0;
    for (let i = 0; i < count; ++i) {
      this.orbit.turn(4, 0);
      await new Promise((resolve) => requestAnimationFrame(resolve));
      this.renderer.gl.finish();
      drawn += this.tiles.drawn;
    }
    const seconds = (performance.now() - start) / 1000;
    return {frames_per_s: count / seconds, points_drawn: Math.round(drawn / count)};
  }
}

/** The edges of the pyramid that a camera sees; `frustum`: t_WC, q_WC, half widths at 1 m. */
function pyramid({t, q, x, y}, depth = 0.35) {
  const rows = rotationRows(q);
  const corners = [[-1, -1], [1, -1], [1, 1], [-1, 1]].map(([i, k]) =>
    add(rotated(rows, [i * x * depth, k * y * depth, depth]), t));
  return corners.flatMap((corner, i) => [...t, ...corner, ...corner, ...corners[(i + 1) % 4]]);
}

try {
  new Page();
} catch (error) {
  element('status').textContent = `The map cannot be drawn: ${error.message}`;
}
