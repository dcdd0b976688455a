// A volume's histogram: bars whose heights are logarithms, so that rare values are seen beside common ones.

// counts: of equal bins over range; x(value): where a value lies; left, right: of the plot; base: the bars' lower end;
// height: of the tallest.
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

// A canvas made as large as it is shown, emptied; null: it is not shown.
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
