// Conversions of colours between linear values, which scenes have, and sRGB, which the browser
// has.

const toCode = (linear) =>
  linear <= 0.0031308 ? 12.92 * linear : 1.055 * Math.pow(linear, 1 / 2.4) - 0.055;
const toLinear = (code) => (code <= 0.04045 ? code / 12.92 : Math.pow((code + 0.055) / 1.055, 2.4));
const byte = (x) => Math.round(255 * Math.min(Math.max(x, 0), 1));

// Returns "#rrggbb" for linear r, g, b.
export function hexOf(color) {
  return "#" + color.map((c) => byte(toCode(Math.max(c, 0))).toString(16).padStart(2, "0")).join("");
}

export function linearOf(hex) {
  return [1, 3, 5].map((at) => toLinear(parseInt(hex.slice(at, at + 2), 16) / 255));
}
