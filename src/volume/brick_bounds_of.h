/* volume/brick_bounds_of.h - bounds of bricks for one type of stored values. The file brick_bounds.c includes
 * this file once for each type, and defines
 *
 *
 *     BOUNDS_TYPE                the type
 *     BOUNDS_NAME(name)          a function's name for the type
 *     BOUNDS_LEAST, BOUNDS_MOST  the type's least and greatest value
 *
 * and the functions and macros that all types share. Bounds are separable. The bounds of a slice's voxels are
 * found along y and then along x; these bounds then widen the bounds of the bricks that depend on the slice.
 * Comparisons with NaN are false, so that NaN voxels do not widen the bounds. */

static void BOUNDS_NAME(begin)(const hl_brick_bounds *b) {
  BOUNDS_TYPE *bounds = b->bounds;
  for (size_t n = 0; n < bricks_of(b); n++) bounds[2 * n] = BOUNDS_MOST, bounds[2 * n + 1] = BOUNDS_LEAST;
}

/* Finds, along x, the least or the greatest value of the nine voxels on which each brick depends. The values
 * of two, four and eight neighbours are found first. row: [padded]; overwritten. out: [bricks]. */
static void BOUNDS_NAME(reduce)(BOUNDS_TYPE *restrict row, size_t bricks, size_t padded, bool greatest,
                                BOUNDS_TYPE *restrict out) {
  for (size_t shift = 1; shift <= 4; shift *= 2)
    for (size_t i = 0; i + shift < padded; i++)
      row[i] = greatest ? MORE(row[i + shift], row[i]) : LESS(row[i + shift], row[i]);
  for (size_t b = 0; b < bricks; b++) {
    BOUNDS_TYPE first = row[BRICK_SIDE * b], second = row[BRICK_SIDE * b + 1];
    out[b] = greatest ? MORE(second, first) : LESS(second, first);
  }
}

/* Finds, in one slice, the bounds of the voxels on which each brick depends, along y and then along x.
 * padded: scratch memory, [2][PADDED(width)]. low, high: [bricks y][bricks x]. */
static void BOUNDS_NAME(bound_slice)(const hl_brick_bounds *b, const BOUNDS_TYPE *slice, BOUNDS_TYPE *padded,
                                     BOUNDS_TYPE *low, BOUNDS_TYPE *high) {
  const size_t width = b->dimension[0], room = PADDED(width);
  BOUNDS_TYPE *restrict rows = padded + BRICK_BEFORE, *restrict tops = padded + room + BRICK_BEFORE;
  for (size_t y = 0; y < b->count[1]; y++) {
    size_t first, last;
    range_of(y, b->dimension[1], &first, &last);
    for (size_t i = 0; i < room; i++) padded[i] = BOUNDS_MOST, padded[room + i] = BOUNDS_LEAST;
    for (size_t j = first; j <= last; j++) {
      const BOUNDS_TYPE *restrict row = slice + j * width;
      for (size_t i = 0; i < width; i++) {
        rows[i] = LESS(row[i], rows[i]);
        tops[i] = MORE(row[i], tops[i]);
      }
    }
    BOUNDS_NAME(reduce)(padded, b->count[0], room, false, low + y * b->count[0]);
    BOUNDS_NAME(reduce)(padded + room, b->count[0], room, true, high + y * b->count[0]);
  }
}

/* Widens the bounds of a layer of bricks so that the bounds include the bounds that were found in a slice. */
static void BOUNDS_NAME(widen)(BOUNDS_TYPE *restrict bounds, const BOUNDS_TYPE *restrict low,
                               const BOUNDS_TYPE *restrict high, size_t bricks) {
  for (size_t n = 0; n < bricks; n++) {
    bounds[2 * n] = LESS(low[n], bounds[2 * n]);
    bounds[2 * n + 1] = MORE(high[n], bounds[2 * n + 1]);
  }
}

/* Widens the bounds of all bricks that depend on slice k by the bounds of its voxels. scratch: [2 *
 * (PADDED(width) + bricks y * bricks x)]. */
static void BOUNDS_NAME(add_slice)(hl_brick_bounds *b, size_t k, const BOUNDS_TYPE *slice,
                                   BOUNDS_TYPE *scratch) {
  const size_t plane = b->count[0] * b->count[1];
  BOUNDS_TYPE *low = scratch + 2 * PADDED(b->dimension[0]), *high = low + plane;
  BOUNDS_NAME(bound_slice)(b, slice, scratch, low, high);
  pthread_mutex_lock(&b->lock);
  for (size_t z = k / BRICK_SIDE < 1 ? 0 : k / BRICK_SIDE - 1; z < b->count[2]; z++) {
    size_t first, last;
    range_of(z, b->dimension[2], &first, &last);
    if (first > k) break;
    if (last >= k) BOUNDS_NAME(widen)((BOUNDS_TYPE *)b->bounds + 2 * z * plane, low, high, plane);
  }
  b->slices++;
  pthread_mutex_unlock(&b->lock);
}

#undef BOUNDS_TYPE
#undef BOUNDS_NAME
#undef BOUNDS_LEAST
#undef BOUNDS_MOST
