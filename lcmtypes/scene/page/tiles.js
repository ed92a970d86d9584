// The tiles of the map: what is known of them, which of their points are here, which are drawn.
// The format of the blocks that bring points is in tile.hpp.

import {Arena} from './arena.js';
import {add, norm, rotated, rotationRows, sub} from './math.js';

const kMagic = 0x314C544B;  // "KTL1"
const kPointBytes = 11;
const kMaxRequestTiles = 60;
const kMaxRequestPoints = 250000;
const kMaxHeldPoints = 6e6;  // of the GPU's memory: 120 MB

export class Tiles {
  constructor(renderer) {
    this.renderer = renderer;
    this.arena = new Arena(renderer.gl);
    this.bytes = 0;  // received
    this.clear();
  }

  clear() {
    for (const tile of this.byId?.values() ?? []) this.drop(tile);
    this.byId = new Map();
    this.freeIndices = [];
    this.nextIndex = 0;
    this.part = 0;
    this.origin = [0, 0, 0];
    this.held = 0;
  }

  /** What the state says of tiles, as tile_json() writes it. */
  apply(entries, removed) {
    for (const e of entries) {
      let tile = this.byId.get(e[0]);
      if (!tile) {
        tile = {id: e[0], loaded: 0, index: this.freeIndices.pop() ?? this.nextIndex++};
        this.byId.set(tile.id, tile);
      }
      Object.assign(tile, {newRevision: e[1], newLabels: e[2], count: e[3], part: e[4],
        resolution: e[5], min: e.slice(6, 9), size: e.slice(9, 12), t: e.slice(12, 15),
        rows: rotationRows(e.slice(15, 19))});
      this.place(tile);
    }
    for (const id of removed) {
      const tile = this.byId.get(id);
      if (!tile) continue;
      this.drop(tile);
      this.freeIndices.push(tile.index);
      this.byId.delete(id);
    }
  }

  drop(tile) {
    if (tile.range) this.arena.release(tile.range);
    this.held -= tile.loaded;
    tile.range = null;
    tile.loaded = 0;
  }

  /** Shows this part of the map; positions are relative to a point of it. */
  setPart(part, origin) {
    this.part = part;
    this.origin = origin;
    for (const tile of this.byId.values()) this.place(tile);
  }

  /** Puts the tile where its pose says, with the box of the points that are here. */
  place(tile) {
    const {min, size} = tile.range ? tile.box : tile;
    const corner = sub(add(rotated(tile.rows, min), tile.t), this.origin);
    const rows = tile.rows.map((row, i) => [...row, corner[i]]);
    this.renderer.placeTile(tile.index, rows, size, tile.resolution);
    const half = tile.size.map((s) => s / 2);
    tile.centre = sub(add(rotated(tile.rows, add(tile.min, half)), tile.t), this.origin);
    tile.radius = norm(half);
  }

  /** [min, max] of the part that is shown, relative to the origin; null: nothing is known. */
  box() {
    let min = null;
    let max = null;
    for (const {part, count, centre, radius} of this.byId.values()) {
      if (part !== this.part || count === 0) continue;
      const r = radius * 0.6;  // a tile is flat more often than not
      min = centre.map((c, i) => Math.min(c - r, min?.[i] ?? Infinity));
      max = centre.map((c, i) => Math.max(c + r, max?.[i] ?? -Infinity));
    }
    return min && [min, max];
  }

  /** Decides how many points of each tile are drawn, at most `budget` of all: one for each pixel or
   * so. Returns what Renderer.draw() takes. */
  select(view, budget) {
    let total = 0;
    const m = view.both;
    for (const tile of this.byId.values()) {
      tile.wanted = 0;
      if (tile.part !== this.part || tile.count === 0) continue;
      const [x, y, z] = tile.centre;
      const w = m[3] * x + m[7] * y + m[11] * z + m[15];
      if (w < -tile.radius) continue;
      const X = m[0] * x + m[4] * y + m[8] * z + m[12];
      const Y = m[1] * x + m[5] * y + m[9] * z + m[13];
      const rX = tile.radius * Math.hypot(m[0], m[4], m[8]);
      const rY = tile.radius * Math.hypot(m[1], m[5], m[9]);
      const reach = Math.max(w, 0) + tile.radius;
      if (Math.abs(X) - rX > reach || Math.abs(Y) - rY > reach) continue;
      tile.distance = Math.max(norm(sub(tile.centre, view.eye)) - tile.radius, 0.1);
      const voxel_px = tile.resolution * view.focal_px / tile.distance;
      const share = Math.min(1, 1.6 * voxel_px * voxel_px);
      tile.wanted = Math.min(tile.count, Math.max(64, Math.ceil(tile.count * share)));
      total += tile.wanted;
    }
    const cut = Math.min(1, budget / Math.max(total, 1));
    const pages = new Map();
    this.drawn = 0;
    for (const tile of this.byId.values()) {
      if (tile.wanted === 0 || tile.loaded === 0) continue;
      const drawn = Math.min(tile.loaded, Math.ceil(tile.wanted * cut));
      // Fewer points are wider, so that the surface stays closed.
      const width = drawn < tile.total ? 1.9 * Math.sqrt(tile.total / drawn) : 1.3;
      this.renderer.setWidth(tile.index, Math.min(width, 24) * tile.resolution);
      let batch = pages.get(tile.range.page);
      if (!batch) pages.set(tile.range.page, batch = {page: tile.range.page, firsts: [], counts: []});
      batch.firsts.push(tile.range.first);
      batch.counts.push(drawn);
      this.drawn += drawn;
    }
    return [...pages.values()];
  }

  /** The next request: {points: [[id, first, count], ...]} or {labels: [[id, count], ...]}; null:
   * everything that is wanted is here. */
  nextRequest() {
    const points = [];
    const labels = [];
    for (const tile of this.byId.values()) {
      if (!tile.wanted) continue;
      const isOld = tile.loaded > 0 && tile.revision !== tile.newRevision;
      // Whole steps, so that turning the view does not ask for a few points again and again.
      const steps = [1 / 16, 1 / 4, 1].map((share) => Math.ceil(tile.count * share));
      const goal = steps.find((step) => step >= Math.min(tile.wanted, tile.count)) ?? tile.count;
      if (isOld) {
        points.push([tile.distance, tile.id, 0, Math.max(goal, Math.min(tile.loaded, tile.count))]);
      } else if (tile.loaded < goal) {
        if (this.held > kMaxHeldPoints && tile.loaded > 0) continue;
        points.push([tile.distance, tile.id, tile.loaded, goal - tile.loaded]);
      } else if (tile.labels !== tile.newLabels) {
        labels.push([tile.distance, tile.id, tile.loaded]);
      }
    }
    const nearest = (wants) => {
      let sum = 0;
      wants.sort((a, b) => a[0] - b[0]);
      return wants.slice(0, kMaxRequestTiles).map((want) => want.slice(1)).filter((want, i) => {
        sum += want[want.length - 1];
        return i === 0 || sum <= kMaxRequestPoints;
      });
    };
    if (labels.length > 0 && (points.length === 0 || (this.wasPoints = !this.wasPoints))) {
      return {labels: nearest(labels)};
    }
    return points.length > 0 ? {points: nearest(points)} : null;
  }

  /** Takes blocks of points or labels, one behind the other. */
  accept(buffer) {
    this.bytes += buffer.byteLength;
    let at = 0;
    while (at + 64 <= buffer.byteLength) at = this.acceptBlock(buffer, at);
  }

  acceptBlock(buffer, at) {
    const [magic, id, revision, labelsRevision, first, count, total, tableLength, indexBytes, hasPoints] =
      new Uint32Array(buffer, at, 10);
    if (magic !== kMagic) throw new Error('the answer is no block of a tile');
    const floats = new Float32Array(buffer, at + 40, 6);
    const table = new Uint32Array(buffer, at + 64, tableLength);
    const indicesAt = at + 64 + 4 * tableLength;
    const Indices = {1: Uint8Array, 2: Uint16Array, 4: Uint32Array}[indexBytes];
    const ids = Uint32Array.from(new Indices(buffer, indicesAt, count), (i) => table[i]);
    const padded = (n) => (n + 3) & ~3;
    const pointsAt = indicesAt + padded(count * indexBytes);
    const end = hasPoints ? pointsAt + padded(count * kPointBytes) : pointsAt;
    const tile = this.byId.get(id);
    if (!tile) return end;
    // The answer may be newer than the state that was asked for last.
    tile.newRevision = Math.max(tile.newRevision, revision);
    tile.newLabels = Math.max(tile.newLabels, labelsRevision);
    const block = {revision, labels: labelsRevision, first, count, total, ids,
      box: {min: [...floats.slice(0, 3)], size: [...floats.slice(3, 6)]}};
    if (hasPoints) {
      this.acceptPoints(tile, block, new Uint8Array(buffer, pointsAt, count * kPointBytes));
    } else if (tile.revision === revision && first === 0 && tile.range) {
      this.arena.writeIds(tile.range, 0, ids.subarray(0, tile.loaded));
      if (count >= tile.loaded) tile.labels = labelsRevision;
    }
    return end;
  }

  acceptPoints(tile, block, records) {
    if (block.first === 0) {
      const before = tile.range;
      tile.range = this.arena.allocate(block.total);
      if (before) this.arena.release(before);
      this.held -= tile.loaded;
      Object.assign(tile, {revision: block.revision, labels: block.labels, box: block.box,
        total: block.total, loaded: 0});
      this.place(tile);
    } else if (tile.revision !== block.revision || block.first !== tile.loaded) {
      return;  // the tile has changed meanwhile: it is asked for again
    }
    this.arena.writePoints(tile.range, block.first, widened(records, block.count, tile.index));
    this.arena.writeIds(tile.range, block.first, block.ids);
    // Labels of other points are older: they are asked for again.
    if (tile.labels !== block.labels) tile.labels = -1;
    tile.loaded = block.first + block.count;
    this.held += block.count;
  }
}

/** Points as the GPU takes them, 16 bytes each: the record, and the index of the tile. */
function widened(records, count, index) {
  const bytes = new Uint8Array(16 * count);
  const words = new Uint32Array(bytes.buffer);
  for (let i = 0, from = 0, to = 0; i < count; ++i, from += kPointBytes, to += 16) {
    for (let k = 0; k < kPointBytes; ++k) bytes[to + k] = records[from + k];
    words[4 * i + 3] = index;
  }
  return bytes;
}
