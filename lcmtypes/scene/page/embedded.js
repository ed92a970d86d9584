// The map in the page itself: a file that kintsugi-export has written.

export class EmbeddedSource {
  static isHere() { return document.getElementById('scene') !== null; }

  constructor() {
    this.isLive = false;
    this.bytes = 0;
    this.scene = JSON.parse(document.getElementById('scene').textContent);
    this.blocks = document.getElementById('tiles').textContent.split('\n');
    this.lineOf = new Map(this.scene.state.tiles.map((tile, i) => [tile[0], i]));
  }

  async state() { return this.scene.state; }
  async segments() { return this.scene.segments; }

  async segment(id) {
    const found = this.scene.segments.segments.find((s) => s.id === id);
    return {neighbours: found?.neighbours ?? [], timeline: null};
  }

  async path() { return new Float32Array(0); }

  /** Whole tiles: nothing is transferred. */
  async points(wants) {
    const parts = wants.map(([id]) => atob(this.blocks[this.lineOf.get(id)]));
    const bytes = new Uint8Array(parts.reduce((sum, part) => sum + part.length, 0));
    let at = 0;
    for (const part of parts) {
      for (let i = 0; i < part.length; ++i) bytes[at++] = part.charCodeAt(i);
    }
    return bytes.buffer;
  }

  labels(wants) { return this.points(wants); }
}
