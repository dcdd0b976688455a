// Isolines of a plane of values: marching squares (Lorensen and Cline 1987, in two dimensions), where each
// piece ends on the sides of a cell, at the places that have the value by linear interpolation. A cell in
// which a corner has no value has no piece.

// values: [height][width]. Returns pieces [x0, y0, x1, y1, ...] in columns and rows.
export function contourPieces(values, width, height, level) {
  const pieces = [], at = (x, y) => values[y * width + x];
  for (let y = 0; y + 1 < height; y++)
    for (let x = 0; x + 1 < width; x++) {
      const a = at(x, y), b = at(x + 1, y), c = at(x + 1, y + 1), d = at(x, y + 1);
      const above = (a >= level) + (b >= level) + (c >= level) + (d >= level);
      if (above === 0 || above === 4 || Number.isNaN(a + b + c + d)) continue;
      const ends = [];
      const side = (from, to, x0, y0, dx, dy) => {
        if ((from >= level) === (to >= level)) return;
        const t = (level - from) / (to - from);
        ends.push(x0 + t * dx, y0 + t * dy);
      };
      side(a, b, x, y, 1, 0);
      side(b, c, x + 1, y, 0, 1);
      side(c, d, x + 1, y + 1, -1, 0);
      side(d, a, x, y + 1, 0, -1);
      if (ends.length === 4) pieces.push(...ends);
      // At a saddle, the mean value in the middle says which corners belong together.
      else if ((a + b + c + d) / 4 >= level === a >= level) pieces.push(ends[0], ends[1], ends[2], ends[3], ends[4], ends[5], ends[6], ends[7]);
      else pieces.push(ends[6], ends[7], ends[0], ends[1], ends[2], ends[3], ends[4], ends[5]);
    }
  return pieces;
}
