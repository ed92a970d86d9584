// Draws tiles and lines, and tells which segment is at a pixel.

import {product} from './math.js';
import {kLineFragment, kLineVertex, kPointFragment, kPointVertex} from './shaders.js';

const kTexelsPerTile = 4;
const kTilesPerRow = 256;
const kPickWidth = 7;  // pixels around the pointer

function compiled(gl, vertex, fragment) {
  const program = gl.createProgram();
  for (const [type, source] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
    const shader = gl.createShader(type);
    gl.shaderSource(shader, source);
    gl.compileShader(shader);
    gl.attachShader(program, shader);
    if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS) && !gl.isContextLost()) {
      throw new Error(gl.getShaderInfoLog(shader));
    }
  }
  gl.linkProgram(program);
  const uniforms = {};
  for (let i = gl.getProgramParameter(program, gl.ACTIVE_UNIFORMS) - 1; i >= 0; --i) {
    const {name} = gl.getActiveUniform(program, i);
    uniforms[name] = gl.getUniformLocation(program, name);
  }
  return {program, uniforms};
}

export class Renderer {
  constructor(canvas) {
    const gl = canvas.getContext('webgl2', {antialias: false, preserveDrawingBuffer: true});
    if (!gl) throw new Error('this browser has no WebGL 2');
    this.gl = gl;
    this.canvas = canvas;
    this.multi = gl.getExtension('WEBGL_multi_draw');
    this.points = compiled(gl, kPointVertex, kPointFragment);
    this.lines = compiled(gl, kLineVertex, kLineFragment);
    this.tiles = gl.createTexture();
    this.texels = new Float32Array(0);
    this.lineBuffer = gl.createBuffer();
    this.lineArray = gl.createVertexArray();
    gl.bindVertexArray(this.lineArray);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.lineBuffer);
    gl.vertexAttribPointer(0, 3, gl.FLOAT, false, 0, 0);
    gl.enableVertexAttribArray(0);
    gl.bindVertexArray(null);
    gl.enable(gl.DEPTH_TEST);
    this.makePickTarget();
  }

  makePickTarget() {
    const gl = this.gl;
    this.pickTarget = gl.createFramebuffer();
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.pickTarget);
    for (const [format, attachment] of
      [[gl.RGBA8, gl.COLOR_ATTACHMENT0], [gl.DEPTH_COMPONENT24, gl.DEPTH_ATTACHMENT]]) {
      const buffer = gl.createRenderbuffer();
      gl.bindRenderbuffer(gl.RENDERBUFFER, buffer);
      gl.renderbufferStorage(gl.RENDERBUFFER, format, kPickWidth, kPickWidth);
      gl.framebufferRenderbuffer(gl.FRAMEBUFFER, attachment, gl.RENDERBUFFER, buffer);
    }
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
  }

  /** `rows`: three rows of rotation and translation; `size`: of the box; `width`: of a point, m. */
  placeTile(index, rows, size, width) {
    const length = kTilesPerRow * kTexelsPerTile * 4;
    const needed = (Math.floor(index / kTilesPerRow) + 1) * length;
    if (this.texels.length < needed) {
      const grown = new Float32Array(Math.max(needed, 2 * this.texels.length));
      grown.set(this.texels);
      this.texels = grown;
    }
    this.texels.set([...rows[0], ...rows[1], ...rows[2], ...size, width], index * kTexelsPerTile * 4);
    this.tilesChanged = true;
  }

  setWidth(index, width) {
    const place = index * kTexelsPerTile * 4 + 15;
    if (Math.abs(this.texels[place] - width) < 0.02 * width) return;
    this.texels[place] = width;
    this.tilesChanged = true;
  }

  uploadTiles() {
    const gl = this.gl;
    gl.activeTexture(gl.TEXTURE0);
    gl.bindTexture(gl.TEXTURE_2D, this.tiles);
    if (!this.tilesChanged) return;
    this.tilesChanged = false;
    const width = kTilesPerRow * kTexelsPerTile;
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA32F, width, this.texels.length / (4 * width), 0, gl.RGBA,
                  gl.FLOAT, this.texels);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
  }

  /** Fits the picture to the canvas; true when its size has changed. */
  resize() {
    const ratio = Math.min(window.devicePixelRatio || 1, 1.5);
    const width = Math.max(1, Math.round(this.canvas.clientWidth * ratio));
    const height = Math.max(1, Math.round(this.canvas.clientHeight * ratio));
    if (this.canvas.width === width && this.canvas.height === height) return false;
    this.canvas.width = width;
    this.canvas.height = height;
    return true;
  }

  /** `batches`: of each page {page, firsts, counts}; `view`: of Orbit; `look`: mode, selected,
   * backs. */
  drawPoints(batches, view, look, projection = view.projection) {
    const gl = this.gl;
    const {program, uniforms} = this.points;
    this.uploadTiles();
    gl.useProgram(program);
    gl.uniform1i(uniforms.u_tiles, 0);
    gl.uniformMatrix4fv(uniforms.u_projection, false, projection);
    gl.uniformMatrix4fv(uniforms.u_view, false, view.view);
    gl.uniform1f(uniforms.u_focal_px, view.focal_px);
    gl.uniform1f(uniforms.u_min_px, 1.5);
    gl.uniform1i(uniforms.u_mode, look.mode);
    gl.uniform1ui(uniforms.u_selected, look.selected);
    gl.uniform1i(uniforms.u_backs, look.backs ? 1 : 0);
    for (const {page, firsts, counts} of batches) {
      gl.bindVertexArray(page.array);
      if (this.multi) {
        this.multi.multiDrawArraysWEBGL(gl.POINTS, Int32Array.from(firsts), 0,
                                        Int32Array.from(counts), 0, firsts.length);
      } else {
        for (let i = 0; i < firsts.length; ++i) gl.drawArrays(gl.POINTS, firsts[i], counts[i]);
      }
    }
    gl.bindVertexArray(null);
  }

  draw(batches, view, look, lines) {
    const gl = this.gl;
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.viewport(0, 0, this.canvas.width, this.canvas.height);
    gl.clearColor(24 / 255, 28 / 255, 34 / 255, 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    this.drawPoints(batches, view, look);
    this.drawLines(lines, view);
  }

  /** `lines`: {positions (relative to the origin of the view), colour, isStrip}. */
  drawLines(lines, view) {
    const gl = this.gl;
    const {program, uniforms} = this.lines;
    gl.useProgram(program);
    gl.uniformMatrix4fv(uniforms.u_projection, false, view.projection);
    gl.uniformMatrix4fv(uniforms.u_view, false, view.view);
    gl.disable(gl.DEPTH_TEST);
    gl.bindVertexArray(this.lineArray);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.lineBuffer);
    for (const {positions, colour, isStrip} of lines) {
      gl.bufferData(gl.ARRAY_BUFFER, positions, gl.STREAM_DRAW);
      gl.uniform3f(uniforms.u_colour, colour[0] / 255, colour[1] / 255, colour[2] / 255);
      gl.drawArrays(isStrip ? gl.LINE_STRIP : gl.LINES, 0, positions.length / 3);
    }
    gl.bindVertexArray(null);
    gl.enable(gl.DEPTH_TEST);
  }

  /** The segment nearest to a place of the canvas, in its CSS pixels; 0: there is none. */
  pick(batches, view, look, x, y) {
    const gl = this.gl;
    const {clientWidth: width, clientHeight: height} = this.canvas;
    const zoom = this.canvas.width / width;
    // The projection of the pixels around the pointer to the whole of a small picture.
    const sx = this.canvas.width / kPickWidth;
    const sy = this.canvas.height / kPickWidth;
    const window = Float64Array.from([sx, 0, 0, 0, 0, sy, 0, 0, 0, 0, 1, 0,
      -sx * (2 * x / width - 1), -sy * (1 - 2 * y / height), 0, 1]);
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.pickTarget);
    gl.viewport(0, 0, kPickWidth, kPickWidth);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    this.drawPoints(batches, view, {...look, mode: 2}, product(window, view.projection));
    const pixels = new Uint8Array(4 * kPickWidth * kPickWidth);
    gl.readPixels(0, 0, kPickWidth, kPickWidth, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    const ids = new Uint32Array(pixels.buffer);
    const middle = (kPickWidth - 1) / 2;
    let best = 0;
    let least = Infinity;
    ids.forEach((id, i) => {
      const distance = Math.hypot(i % kPickWidth - middle, Math.floor(i / kPickWidth) - middle) / zoom;
      if (id !== 0 && distance < least) [best, least] = [id, distance];
    });
    return best;
  }
}
