// Draws a volume's histogram: bars with logarithmic heights, so that rare values are visible beside common
// values, and an axis of values below the bars.

import { make, shortNumber } from "./controls.js";

// counts: the counts of bins of equal width over `range`. x(value): returns the pixel column of a value.
// left, right: the plot's edges. base: the lower end of the bars. height: the height of the tallest bar.
export function drawBars(context, { counts, range, x, left, right, base, height }) {
  const most = Math.log1p(Math.max(...counts)), step = (range[1] - range[0]) / counts.length;
  context.beginPath();
  for (let bin = 0; bin < counts.length && most > 0; bin++) {
    const from = x(range[0] + bin * step), to = x(range[0] + (bin + 1) * step);
    if (to < left || from > right) continue;
    const tall = (Math.log1p(counts[bin]) / most) * height;
    context.rect(from, base - tall, to - from + 0.3, tall);
  }
  context.fill();
}

const TICK_ROOM = 46; // least number of pixels from tick to tick
const TICK_LINE = 3;

// The axis of values under a plot: ticks at round numbers of its range, and the name of the values. y: the
// pixel row of the plot's lower end.
export function drawValueAxis(context, { range: [low, high], x, left, right, y, color }) {
  const least = ((high - low) * TICK_ROOM) / (right - left), power = 10 ** Math.floor(Math.log10(least));
  const step = [1, 2, 5, 10].map((n) => n * power).find((size) => size >= least * 0.9999999);
  context.strokeStyle = context.fillStyle = color;
  context.font = "10px system-ui, sans-serif";
  context.textBaseline = "top";
  context.lineWidth = 1;
  for (let n = Math.ceil(low / step); n * step <= high + 1e-9 * step; n++) {
    const at = x(n * step), text = shortNumber(+(n * step).toPrecision(12)), half = context.measureText(text).width / 2;
    context.beginPath();
    context.moveTo(at, y);
    context.lineTo(at, y + TICK_LINE);
    context.stroke();
    context.fillText(text, Math.min(Math.max(at - half, left - 8), right + 8 - 2 * half), y + TICK_LINE + 1);
  }
}

// Makes a line for panels that tells the ranges of the smoothed values and of the file's values. The line is hidden if the volume is
// not smoothed. about: the volume's entry in start.json.
export function smoothedLine({ range, unsmoothed }) {
  const told = (ends) => ends.map(shortNumber).join(" to ");
  return make("p", { class: "facts smoothed", hidden: !unsmoothed }, unsmoothed ? `The picture has smoothed values, ${told(range)}. The file's are ${told(unsmoothed.range)}.` : "");
}

// Empties a canvas, gives the canvas the resolution of its size on the screen, and returns its
// drawing context. Null: the canvas is not shown.
export function blankContext(canvas, width, height) {
  const density = devicePixelRatio || 1;
  if (width === 0) return null;
  canvas.width = width * density;
  canvas.height = height * density;
  canvas.style.height = `${height}px`;
  const context = canvas.getContext("2d");
  context.scale(density, density);
  return context;
}
