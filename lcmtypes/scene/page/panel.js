// The table of segments: searching, and what is known of the one that is selected.

import {cssColour} from './palette.js';

const kMaxRows = 200;
const kAskAgain_ms = 3000;  // about a segment that changes
const byId = (id) => document.getElementById(id);
const metres = (v) => `${v.map((x) => x.toFixed(2)).join(', ')} m`;

export function made(tag, properties, ...children) {
  const element = Object.assign(document.createElement(tag), properties);
  element.append(...children);
  return element;
}

function swatch(id) {
  const square = document.createElement('i');
  square.style.background = cssColour(id);
  return square;
}

export class Panel {
  /** `onSelect(id)`: 0 for none; `onCloser(segment)`: the view is to go to it. */
  constructor(source, onSelect, onCloser) {
    this.source = source;
    this.onSelect = onSelect;
    this.segments = new Map();
    this.selected = 0;
    for (const id of ['find_id', 'min_points', 'planar_only']) {
      byId(id).addEventListener('input', () => this.list());
    }
    byId('find_id').addEventListener('keydown', (event) => {
      if (event.key === 'Enter') this.select(Number(event.target.value));
    });
    byId('unselect').addEventListener('click', () => this.select(0));
    byId('closer').addEventListener('click', () => {
      const segment = this.segments.get(this.selected);
      if (segment) onCloser(segment);
    });
  }

  clear() {
    this.segments.clear();
    this.select(0);
  }

  apply({segments, removed}) {
    for (const segment of segments) this.segments.set(segment.id, segment);
    for (const id of removed) this.segments.delete(id);
    this.list();
    if (this.selected === 0) return;
    this.describe();
    this.isOutdated ||= segments.some((s) => s.id === this.selected);
    if (this.isOutdated && performance.now() - this.askedAt_ms > kAskAgain_ms) {
      this.askAbout(this.selected);
    }
  }

  /** Segments whose id begins with the text, of enough points, the largest first. */
  matching() {
    const text = byId('find_id').value.trim();
    const least = Number(byId('min_points').value) || 0;
    const planar = byId('planar_only').checked;
    return [...this.segments.values()]
      .filter((s) => String(s.id).startsWith(text) && s.points >= least && (s.planar || !planar))
      .sort((a, b) => b.points - a.points || a.id - b.id);
  }

  list() {
    const matching = this.matching();
    byId('matches').textContent = `${matching.length} of ${this.segments.size}`;
    byId('list').replaceChildren(...matching.slice(0, kMaxRows).map((s) => this.item(
      s.id, `${s.points.toLocaleString('en')} points, ${s.area.toFixed(2)} m\u00b2${s.planar ? ', planar' : ''}`)));
  }

  item(id, text) {
    const button = made('button', {className: id === this.selected ? 'item chosen' : 'item'},
                        swatch(id), made('b', {textContent: id}), made('span', {textContent: text}));
    button.addEventListener('click', () => this.select(id));
    return button;
  }

  select(id) {
    if (!Number.isInteger(id) || id < 0) return;
    this.selected = id;
    byId('selected').hidden = id === 0;
    byId('neighbours').replaceChildren();
    byId('timeline_block').hidden = true;
    this.onSelect(id);
    this.list();
    if (id === 0) return;
    this.describe();
    this.askAbout(id);
  }

  /** What is in the table. */
  describe() {
    const s = this.segments.get(this.selected);
    byId('selected_name').textContent = `Segment ${this.selected}`;
    byId('swatch').style.background = cssColour(this.selected);
    const rows = s ? [
      ['points', s.points.toLocaleString('en')],
      ['area', `${s.area.toFixed(3)} m\u00b2`],
      ['box', metres(s.box_max.map((x, i) => x - s.box_min[i]))],
      ['centroid', metres(s.centroid)],
      ['plane', s.plane ? `${s.planar ? 'planar' : 'not planar'}, rms ${(1000 * s.plane.rms).toFixed(1)} mm` : 'unknown'],
      ['normal', (s.plane?.normal ?? s.mean_normal).map((x) => x.toFixed(3)).join(', ')],
      ['colour', s.mean_color.join(', ')],
      ['slices', `${s.first_slice} to ${s.last_slice}`],
      ['may change', `${Math.round(100 * s.points_in_volume / Math.max(1, s.points))} % of its points`],
    ] : [['', 'There is no such segment now.']];
    byId('facts').replaceChildren(...rows.map(([name, value]) => made('tr', {},
      made('td', {textContent: name}), made('td', {textContent: value}))));
  }

  /** What takes the server some time. */
  async askAbout(id) {
    this.askedAt_ms = performance.now();
    this.isOutdated = false;
    const {neighbours, timeline} = await this.source.segment(id).catch(() => ({neighbours: []}));
    if (this.selected !== id) return;
    byId('neighbours').replaceChildren(...neighbours.map(([other, pairs]) =>
      this.item(other, `${pairs.toLocaleString('en')} contacts`)));
    if (neighbours.length === 0) byId('neighbours').textContent = 'none';
    byId('timeline_block').hidden = !timeline;
    if (timeline) drawTimeline(timeline, id);
  }
}

/** The size of a segment over the slices of the map, and its events. */
function drawTimeline({slices, sizes, events}, id) {
  const canvas = byId('timeline');
  const context = canvas.getContext('2d');
  const {width, height} = canvas;
  context.clearRect(0, 0, width, height);
  const end = Math.max(slices, 1);
  const most = Math.max(1, ...sizes.map(([, points]) => points));
  const x = (slice) => slice / end * (width - 2) + 1;
  const y = (points) => height - 14 - points / most * (height - 28);
  context.beginPath();
  context.moveTo(x(sizes[0]?.[0] ?? 0), y(0));
  sizes.forEach(([slice, points], i) => {
    context.lineTo(x(slice), y(points));
    context.lineTo(x(sizes[i + 1]?.[0] ?? end), y(points));
  });
  context.lineTo(x(end), y(0));
  context.fillStyle = cssColour(id);
  context.fill();
  context.fillStyle = '#ebebeb';
  for (const [slice] of events) context.fillRect(x(slice) - 1, 10, 2, height - 24);
  context.fillStyle = '#9aa4b0';
  context.fillText(`${most.toLocaleString('en')} points`, 2, 9);
  context.fillText(`slice ${end}`, width - 60, height - 2);
  byId('events').replaceChildren(...events.slice(-30).map(([slice, what, other]) =>
    made('div', {textContent: `slice ${slice}: ${what}${other ? ` ${other}` : ''}`})));
}
