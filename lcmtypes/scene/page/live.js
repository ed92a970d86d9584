// The map of a running kintsugi-viewer.

async function answer(url) {
  const response = await fetch(url, {cache: 'no-store'});
  if (!response.ok) throw new Error((await response.text()).trim() || response.statusText);
  return response;
}

export class LiveSource {
  constructor() {
    this.isLive = true;
    this.bytes = 0;
  }

  async json(url) {
    const text = await (await answer(url)).text();
    this.bytes += text.length;
    return JSON.parse(text);
  }

  async buffer(url) {
    const buffer = await (await answer(url)).arrayBuffer();
    this.bytes += buffer.byteLength;
    return buffer;
  }

  /** What has changed since a state with this epoch and version. */
  state(epoch, version) { return this.json(`state?epoch=${epoch}&since=${version}`); }
  segments(epoch, version) { return this.json(`segments?epoch=${epoch}&since=${version}`); }
  segment(id) { return this.json(`segment?id=${id}`); }
  async path(part) { return new Float32Array(await this.buffer(`path?part=${part}`)); }
  points(wants) { return this.buffer(`points?want=${wants.map((w) => w.join('.')).join(',')}`); }
  labels(wants) { return this.buffer(`labels?want=${wants.map((w) => w.join('.')).join(',')}`); }
  imageUrl(version) { return `camera.jpg?version=${version}`; }
}
