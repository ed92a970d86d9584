// Memory of the GPU for the points of all tiles: few large pages, so that few calls draw them all.

const kPagePoints = 1 << 19;
const kGranule = 256;

/** 16 bytes of geometry and 4 of segment id for each point. */
export class Arena {
  constructor(gl) {
    this.gl = gl;
    this.pages = [];
  }

  /** A range {page, first, size} for so many points. */
  allocate(count) {
    const size = Math.max(kGranule, Math.ceil(count / kGranule) * kGranule);
    for (const page of this.pages) {
      const i = page.free.findIndex((range) => range.size >= size);
      if (i < 0) continue;
      const range = page.free[i];
      const allocated = {page, first: range.first, size};
      range.first += size;
      range.size -= size;
      if (range.size === 0) page.free.splice(i, 1);
      return allocated;
    }
    this.pages.push(this.makePage(Math.max(size, kPagePoints)));
    return this.allocate(count);
  }

  release({page, first, size}) {
    const free = page.free;
    let i = free.findIndex((range) => range.first > first);
    if (i < 0) i = free.length;
    free.splice(i, 0, {first, size});
    for (const k of [i, i - 1]) {
      if (k < 0 || k + 1 >= free.length || free[k].first + free[k].size !== free[k + 1].first) continue;
      free[k].size += free[k + 1].size;
      free.splice(k + 1, 1);
    }
  }

  makePage(size) {
    const gl = this.gl;
    const page = {size, free: [{first: 0, size}], array: gl.createVertexArray()};
    gl.bindVertexArray(page.array);
    page.points = gl.createBuffer();
    gl.bindBuffer(gl.ARRAY_BUFFER, page.points);
    gl.bufferData(gl.ARRAY_BUFFER, size * 16, gl.DYNAMIC_DRAW);
    gl.vertexAttribPointer(0, 3, gl.UNSIGNED_SHORT, true, 16, 0);
    gl.vertexAttribPointer(1, 2, gl.UNSIGNED_BYTE, false, 16, 6);
    gl.vertexAttribPointer(2, 3, gl.UNSIGNED_BYTE, true, 16, 8);
    gl.vertexAttribIPointer(3, 1, gl.UNSIGNED_INT, 16, 12);
    page.ids = gl.createBuffer();
    gl.bindBuffer(gl.ARRAY_BUFFER, page.ids);
    gl.bufferData(gl.ARRAY_BUFFER, size * 4, gl.DYNAMIC_DRAW);
    gl.vertexAttribIPointer(4, 1, gl.UNSIGNED_INT, 4, 0);
    for (let i = 0; i < 5; ++i) gl.enableVertexAttribArray(i);
    gl.bindVertexArray(null);
    return page;
  }

  writePoints(range, offset, bytes) {
    const gl = this.gl;
    gl.bindBuffer(gl.ARRAY_BUFFER, range.page.points);
    gl.bufferSubData(gl.ARRAY_BUFFER, (range.first + offset) * 16, bytes);
  }

  writeIds(range, offset, ids) {
    const gl = this.gl;
    gl.bindBuffer(gl.ARRAY_BUFFER, range.page.ids);
    gl.bufferSubData(gl.ARRAY_BUFFER, (range.first + offset) * 4, ids);
  }
}
