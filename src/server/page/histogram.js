// A volume's histogram: bars whose heights are logarithms, so that rare values are seen beside common ones;
// and the axis of values below them.

import { make, shortNumber } from "./controls.js";

// counts: of equal bins over range. x(value): the place of a value. left, right: of the plot. base: the bars'
// lower end. height: of the tallest bar.
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

// The axis of values under a plot: ticks at round numbers of its range, and the name of the values. y: of the
// plot's lower end.
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

// A line for panels of the values that a picture shows: where the volume is smoothed, these are not the file's. about: of start.json.
export function smoothedLine({ range, unsmoothed }) {
  const told = (ends) => ends.map(shortNumber).join(" to ");
  return make("p", { class: "facts smoothed", hidden: !unsmoothed }, unsmoothed ? `The picture has smoothed values, ${told(range)}. The file's are ${told(unsmoothed.range)}.` : "");
}

// A canvas, emptied and as large as it is shown; null: it is not shown.
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
