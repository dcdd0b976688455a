// Isolines of a plane of values: marching squares (Lorensen and Cline 1987, in two dimensions), where each
// piece of line ends on two sides of a cell, at the points where linear interpolation along the side gives
// the isoline's value. A cell with a corner that has no value gets no piece of line.

// values: [height][width]. Returns the end points of all pieces of line, [x0, y0, x1, y1, ...], in
// columns and rows.
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
      // At a saddle, the mean of the four corners decides which corners the pieces of line join.
      else if ((a + b + c + d) / 4 >= level === a >= level) pieces.push(ends[0], ends[1], ends[2], ends[3], ends[4], ends[5], ends[6], ends[7]);
      else pieces.push(ends[6], ends[7], ends[0], ends[1], ends[2], ends[3], ends[4], ends[5]);
    }
  return pieces;
}
