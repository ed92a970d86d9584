// Known objects that were detected in the map: boxes, names, a list.

import {add, dot, norm, rotated, rotationRows, scaled, sub} from './math.js';
import {kObjectColour} from './palette.js';
import {made} from './panel.js';

const kMinExtent_px = 3;  // a smaller box has no name
const kDashes = 7;        // of an edge, with gaps of the same length between them
const kRows = 5;          // of names above each other, where they would cover each other

/** The corners of its box in W; bit i of the index: the upper side along axis i. */
function cornersOf({t, q, box_min_O: min, box_max_O: max}) {
  const rows = rotationRows(q);
  return Array.from({length: 8}, (_, i) =>
    add(rotated(rows, min.map((low, axis) => (i >> axis & 1 ? max[axis] : low))), t));
}

/** Ends of lines along the edges; what is not confirmed is dashed. */
function linesOf({corners, confirmed}) {
  const lines = [];
  corners.forEach((a, i) => {
    for (const axis of [1, 2, 4]) {
      if (i & axis) continue;
      const edge = sub(corners[i | axis], a);
      const count = confirmed ? 1 : kDashes;
      for (let k = 0; k < count; ++k) {
        const place = (step) => add(a, scaled(edge, step / (2 * count - 1)));
        lines.push(...place(2 * k), ...place(2 * k + 1));
      }
    }
  });
  return lines;
}

/** What a box covers of the canvas, in its CSS pixels; null: nothing, or too little. */
function extentOf(corners, {both, eye}, {clientWidth: width, clientHeight: height}) {
  let [left, right, top, bottom] = [Infinity, -Infinity, Infinity, -Infinity];
  for (const p of corners) {
    const [x, y, , w] = [0, 1, 2, 3].map((row) => dot([both[row], both[4 + row], both[8 + row]], p) + both[12 + row]);
    if (w <= 0) continue;  // behind the view
    left = Math.min(left, (1 + x / w) * width / 2);
    right = Math.max(right, (1 + x / w) * width / 2);
    top = Math.min(top, (1 - y / w) * height / 2);
    bottom = Math.max(bottom, (1 - y / w) * height / 2);
  }
  const isSeen = right > 0 && left < width && bottom > 0 && top < height;
  if (!isSeen || Math.max(right - left, bottom - top) < kMinExtent_px) return null;
  return {middle: Math.min(Math.max((left + right) / 2, 0), width), top: Math.max(top, 0),
    distance: norm(sub(scaled(add(corners[0], corners[7]), 0.5), eye))};
}

export class Objects {
  /** `onCloser({box_min, box_max})`: the view is to go to it. `canvas`: the names lie over it. */
  constructor(canvas, onCloser) {
    this.canvas = canvas;
    this.onCloser = onCloser;
    this.shown = [];
    this.lines = {positions: new Float32Array(0), colour: kObjectColour, isStrip: false};
  }

  /** Shows those in the part of the map that is shown: in its box [min, max], relative to `origin`.
   * False: nothing has changed. */
  set(objects, box, origin) {
    const all = objects.map((object) => ({...object, corners: cornersOf(object)}));
    this.shown = all.filter(({corners}) => {
      const size = norm(sub(corners[7], corners[0]));
      const middle = sub(scaled(add(corners[0], corners[7]), 0.5), origin);
      return box && middle.every((x, i) => x > box[0][i] - size && x < box[1][i] + size);
    });
    this.lines.positions = Float32Array.from(this.shown.flatMap(linesOf), (p, i) => p - origin[i % 3]);
    this.origin = origin;
    return this.list();
  }

  list() {
    const text = JSON.stringify(this.shown);
    if (text === this.listed) return false;
    this.listed = text;
    for (const id of ['objects', 'boxes_block']) document.getElementById(id).hidden = this.shown.length === 0;
    document.getElementById('object_list').replaceChildren(...this.shown.map((object) => {
      const button = made('button', {className: 'item'}, made('b', {textContent: object.name}),
                          made('span', {textContent: object.confirmed ? 'confirmed' : 'found'}));
      button.addEventListener('click', () => this.onCloser(boxOf(object.corners)));
      return button;
    }));
    document.getElementById('names').replaceChildren(
      ...this.shown.map(({name}) => made('span', {textContent: name})));
    return true;
  }

  /** Names above the boxes, those of near objects first; they do not cover each other where there is room. */
  placeNames(view, areShown) {
    const names = [...document.getElementById('names').children];
    const seen = [];
    this.shown.forEach(({corners}, i) => {
      const extent = areShown ? extentOf(corners.map((p) => sub(p, this.origin)), view, this.canvas) : null;
      names[i].hidden = !extent;
      if (extent) seen.push({...extent, name: names[i]});
    });
    seen.sort((a, b) => a.distance - b.distance);
    const taken = [];
    for (const {middle, top, name} of seen) {
      const [width, height] = [name.offsetWidth + 1, name.offsetHeight + 1];  // those are rounded
      const left = Math.min(Math.max(0, middle - width / 2), this.canvas.clientWidth - width);
      const places = Array.from({length: kRows}, (_, row) => Math.max(0, top - (row + 1) * height));
      const isFree = (y) => taken.every((t) => left > t.right || left + width < t.left || Math.abs(y - t.y) >= height);
      const y = places.find(isFree) ?? places[0];
      taken.push({left, right: left + width, y});
      name.style.transform = `translate(${left}px, ${y}px)`;
    }
  }
}

function boxOf(corners) {
  const along = (axis, pick) => pick(...corners.map((p) => p[axis]));
  return {box_min: [0, 1, 2].map((axis) => along(axis, Math.min)),
    box_max: [0, 1, 2].map((axis) => along(axis, Math.max))};
}
