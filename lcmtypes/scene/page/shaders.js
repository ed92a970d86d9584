// The programs of the GPU.

import {kSegmentColourGlsl} from './palette.js';

// The place of a tile is in four texels of u_tiles: three rows of its rotation and translation (to
// the map, relative to the origin of the view), then the size of its box and the width of its
// points, metres.
export const kPointVertex = `#version 300 es
precision highp float;
precision highp int;
precision highp sampler2D;
layout(location = 0) in vec3 a_share;
layout(location = 1) in vec2 a_normal;
layout(location = 2) in vec3 a_colour;
layout(location = 3) in uint a_tile;
layout(location = 4) in uint a_id;
uniform sampler2D u_tiles;
uniform mat4 u_projection;
uniform mat4 u_view;
uniform float u_focal_px;
uniform float u_min_px;
uniform int u_mode;
uniform uint u_selected;
uniform bool u_backs;
flat out vec4 v_colour;
${kSegmentColourGlsl}
vec3 normalOf(vec2 a) {
  vec2 f = a / 127.0 - 1.0;
  vec3 n = vec3(f, 1.0 - abs(f.x) - abs(f.y));
  if (n.z < 0.0) n.xy = (1.0 - abs(n.yx)) * vec2(n.x < 0.0 ? -1.0 : 1.0, n.y < 0.0 ? -1.0 : 1.0);
  return normalize(n);
}
void main() {
  ivec2 texel = ivec2(int(a_tile & 255u) * 4, int(a_tile >> 8u));
  vec4 row0 = texelFetch(u_tiles, texel, 0);
  vec4 row1 = texelFetch(u_tiles, texel + ivec2(1, 0), 0);
  vec4 row2 = texelFetch(u_tiles, texel + ivec2(2, 0), 0);
  vec4 box = texelFetch(u_tiles, texel + ivec2(3, 0), 0);
  vec4 p = vec4(a_share * box.xyz, 1.0);
  vec4 p_V = u_view * vec4(dot(row0, p), dot(row1, p), dot(row2, p), 1.0);
  gl_Position = u_projection * p_V;
  gl_PointSize = clamp(box.w * u_focal_px / max(-p_V.z, 1e-3), u_min_px, 64.0);
  float facing = 1.0;
  if (a_normal.x < 254.5) {
    vec3 n = normalOf(a_normal);
    vec3 n_V = mat3(u_view) * vec3(dot(row0.xyz, n), dot(row1.xyz, n), dot(row2.xyz, n));
    facing = dot(n_V, normalize(-p_V.xyz));
    if (facing < 0.0 && !u_backs) {
      gl_Position = vec4(2.0, 2.0, 2.0, 1.0);  // outside: looks into rooms through their walls
      return;
    }
  }
  if (u_mode == 2) {
    uvec4 bytes = uvec4(a_id, a_id >> 8u, a_id >> 16u, a_id >> 24u) & 255u;
    v_colour = vec4(bytes) / 255.0;
    return;
  }
  bool colourless = u_mode == 0 && a_colour == vec3(0.0);  // none was seen: as in the pictures
  vec3 colour = u_mode == 1 ? segmentColour(a_id) : colourless ? vec3(0.745) : a_colour;
  float light = u_mode == 1 || colourless ? 0.5 + 0.5 * abs(facing) : 0.75 + 0.25 * abs(facing);
  if (u_selected != 0u) {
    if (a_id == u_selected) {
      colour = mix(colour, u_mode == 1 ? vec3(1.0) : segmentColour(a_id), 0.35);
      light = max(light, 0.85);
    } else {
      colour = mix(vec3(0.12, 0.14, 0.17), vec3(dot(colour, vec3(0.3, 0.5, 0.2))), 0.45);
    }
  }
  v_colour = vec4(colour * light, 1.0);
}`;

export const kPointFragment = `#version 300 es
precision mediump float;
flat in vec4 v_colour;
out vec4 o_colour;
void main() { o_colour = v_colour; }`;

export const kLineVertex = `#version 300 es
precision highp float;
layout(location = 0) in vec3 a_position;
uniform mat4 u_projection;
uniform mat4 u_view;
void main() { gl_Position = u_projection * u_view * vec4(a_position, 1.0); }`;

export const kLineFragment = `#version 300 es
precision mediump float;
uniform vec3 u_colour;
out vec4 o_colour;
void main() { o_colour = vec4(u_colour, 1.0); }`;
