// The colours of segments: the same for an id as in the pictures of kintsugi-viewer.

export const kObjectColour = [90, 225, 255];  // boxes of known objects

function hsvChannel(offset, hue, saturation, value) {
  const k = (offset + 6 * hue) % 6;
  const ramp = Math.min(Math.max(Math.min(k, 4 - k), 0), 1);
  return Math.round(255 * value * (1 - saturation * ramp));
}

/** [red, green, blue], 0 to 255. */
export function segmentColour(id) {
  if (id === 0) return [120, 120, 120];
  const hue = (id * 0.618033988749895) % 1;
  const tone = (id * 0.754877666246693) % 1;
  const saturation = 0.45 + 0.45 * tone;
  const value = 1 - 0.3 * ((2 * tone) % 1);
  return [5, 3, 1].map((offset) => hsvChannel(offset, hue, saturation, value));
}

export const cssColour = (id) => `rgb(${segmentColour(id).join(',')})`;

/** The same in a shader. The fractions are computed in integers modulo 2^32, because the products
 * would lose their fractions as floats. */
export const kSegmentColourGlsl = `
float hsvChannel(float offset, float hue, float saturation, float value) {
  float k = mod(offset + 6.0 * hue, 6.0);
  return value * (1.0 - saturation * clamp(min(k, 4.0 - k), 0.0, 1.0));
}
vec3 segmentColour(uint id) {
  if (id == 0u) return vec3(120.0 / 255.0);
  float hue = float((id * 2654435769u) >> 8u) / 16777216.0;
  float tone = float((id * 3242174889u) >> 8u) / 16777216.0;
  float saturation = 0.45 + 0.45 * tone;
  float value = 1.0 - 0.3 * fract(2.0 * tone);
  return vec3(hsvChannel(5.0, hue, saturation, value), hsvChannel(3.0, hue, saturation, value),
              hsvChannel(1.0, hue, saturation, value));
}
`;
