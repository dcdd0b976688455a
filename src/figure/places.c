/* figure/places.c - finds the places of the parts of an overlay on a picture: the legend, the scale bar,
 * the arrows and the texts. In: the matter that the picture shows, the boxes of other drawings, and boxes
 * in which a part could lie. Out: the best of these boxes. All parts of an overlay are placed by one rule
 * (hl_search in places.h), and differ only in the boxes that they try. */
#include "figure/places.h"

#include <math.h>

#include "core/memory.h"

/* ---- the matter in the picture ---- */

enum { MOST_CELLS = 512 }; /* the greatest number of cells along a side of the grid */

/* The number of pixels along the side of a cell. */
static int pixels_of_cell(int width, int height) {
  const int longest = width > height ? width : height;
  return (longest + MOST_CELLS - 1) / MOST_CELLS;
}

/* Converts an opacity to a whole number from 0 to 255. The number is 0 if the opacity is too small to change
 * an 8-bit colour. */
static int64_t code_of(float opacity) { return opacity > 0 ? lround(255 * fmin((double)opacity, 1)) : 0; }

/* Fills the cover's sums: adds the opacity of each pixel to the sum of its cell, and then adds to each cell
 * the sums of all cells above it and to its left.
 */
static void add_pixels(const hl_image *image, hl_cover *cover) {
  const int width = hl_image_width(image), height = hl_image_height(image);
  const size_t stride = (size_t)cover->columns + 1;
  const float *pixels = hl_image_pixels_const(image);
  for (int y = 0; y < height; y++) {
    int64_t *sums = cover->sums + (size_t)(y / cover->side + 1) * stride + 1;
    for (int x = 0; x < width; x++, pixels += 4) sums[x / cover->side] += code_of(pixels[3]);
  }
  for (size_t row = 1; row <= (size_t)cover->rows; row++)
    for (size_t n = row * stride + 1; n < (row + 1) * stride; n++)
      cover->sums[n] += cover->sums[n - 1] + cover->sums[n - stride] - cover->sums[n - stride - 1];
}

hl_status hl_cover_measure(hl_context *context, const hl_image *image, hl_cover *cover, hl_error *error) {
  *cover = (hl_cover){.context = context};
  if (image == NULL) return HL_OK;
  cover->width = hl_image_width(image);
  cover->height = hl_image_height(image);
  cover->side = pixels_of_cell(cover->width, cover->height);
  cover->columns = (cover->width + cover->side - 1) / cover->side;
  cover->rows = (cover->height + cover->side - 1) / cover->side;
  const size_t count = ((size_t)cover->columns + 1) * ((size_t)cover->rows + 1);
  cover->sums = hl_allocate_zeroed(context, count, sizeof *cover->sums);
  if (cover->sums == NULL) return hl_fail_memory(error, count * sizeof *cover->sums, "a figure's places");
  add_pixels(image, cover);
  return HL_OK;
}

void hl_cover_release(hl_cover *cover) {
  hl_release(cover->context, cover->sums);
  cover->sums = NULL;
}

/* Finds the cells, from number `low` up to but not including `high`, that a stretch of a side of the
 * picture touches. from, to: the ends of the stretch, as fractions of the side. pixels: the number of
 * pixels along the side. */
static void find_cells(double from, double to, int pixels, int side, int count, int *low, int *high) {
  static const double least = 1e-6; /* a touch by a smaller part of a cell is due to rounding */
  *low = (int)fmin(fmax(floor(from * pixels / side + least), 0), count);
  *high = (int)fmin(fmax(ceil(to * pixels / side - least), *low), count);
}

double hl_cover_in(const hl_cover *cover, hl_rectangle picture, hl_rectangle box) {
  int left, right, top, bottom;
  if (cover->sums == NULL) return 0;
  const double x = (box.left - picture.left) / picture.width, y = (box.top - picture.top) / picture.height;
  find_cells(x, x + box.width / picture.width, cover->width, cover->side, cover->columns, &left, &right);
  find_cells(y, y + box.height / picture.height, cover->height, cover->side, cover->rows, &top, &bottom);
  const size_t stride = (size_t)cover->columns + 1;
  const int64_t *above = cover->sums + (size_t)top * stride, *below = cover->sums + (size_t)bottom * stride;
  const int64_t sum = below[right] - below[left] - above[right] + above[left];
  return (double)sum / 255 * (picture.width / cover->width) * (picture.height / cover->height);
}

/* ---- rectangles ---- */

bool hl_rectangles_meet(hl_rectangle a, hl_rectangle b) {
  return a.left < b.left + b.width && b.left < a.left + a.width && a.top < b.top + b.height &&
         b.top < a.top + a.height;
}

bool hl_rectangle_lies_in(hl_rectangle box, hl_rectangle picture) {
  return box.left >= picture.left && box.left + box.width <= picture.left + picture.width &&
         box.top >= picture.top && box.top + box.height <= picture.top + picture.height;
}

hl_rectangle hl_rectangle_widened(hl_rectangle box, double rim) {
  return (hl_rectangle){box.left - rim, box.top - rim, box.width + 2 * rim, box.height + 2 * rim};
}

hl_rectangle hl_rectangle_in_corner(hl_rectangle box, hl_rectangle picture, bool across, bool down) {
  if (across) box.left = 2 * picture.left + picture.width - box.left - box.width;
  if (down) box.top = 2 * picture.top + picture.height - box.top - box.height;
  return box;
}

/* ---- the places that other drawings take ---- */

void hl_take(hl_taken *taken, hl_rectangle box) {
  if (taken->count < HL_MOST_TAKEN) taken->boxes[taken->count++] = box;
}

static bool is_taken(const hl_taken *taken, hl_rectangle box) {
  for (size_t n = 0; n < taken->count; n++)
    if (hl_rectangles_meet(taken->boxes[n], box)) return true;
  return false;
}

/* Returns the lower end of the stretch of a column that begins at `top` and meets nothing taken. */
static double end_of_stretch(const hl_taken *taken, hl_rectangle column, double top) {
  double end = column.top + column.height;
  column.height = end - top;
  column.top = top;
  for (size_t n = 0; n < taken->count; n++)
    if (hl_rectangles_meet(taken->boxes[n], column)) end = fmin(end, fmax(taken->boxes[n].top, top));
  return end;
}

double hl_free_height(const hl_taken *taken, hl_rectangle column) {
  double greatest = end_of_stretch(taken, column, column.top) - column.top;
  for (size_t n = 0; n < taken->count; n++) {
    const double top = taken->boxes[n].top + taken->boxes[n].height;
    if (top > column.top && top < column.top + column.height)
      greatest = fmax(greatest, end_of_stretch(taken, column, top) - top);
  }
  return greatest;
}

/* ---- the search ---- */

bool hl_search_try(hl_search *search, hl_rectangle box, double far) {
  static const double least = 1e-6; /* a way in points, or a part of the unit, that is due to rounding */
  const hl_rectangle widened = hl_rectangle_widened(box, search->rim), picture = search->taken->picture;
  if (!hl_rectangle_lies_in(box, picture) || is_taken(search->taken, hl_rectangle_widened(widened, -least)))
    return false;
  const double area = search->cover != NULL ? hl_cover_in(search->cover, picture, widened) : 0;
  const double covered = ceil(area / search->unit - least);
  if (search->found && (covered > search->covered || (covered == search->covered && far >= search->far)))
    return false;
  search->found = true;
  search->box = box;
  search->covered = covered;
  search->far = far;
  return true;
}

/* Tries a box at an edge of the picture. at: the coordinate along the edge at which the box begins. */
static void try_at(hl_search *search, hl_rectangle box, bool along_x, double at, hl_rectangle usual) {
  if (along_x) box.left = at;
  else box.top = at;
  hl_search_try(search, box, fabs(box.left - usual.left) + fabs(box.top - usual.top));
}

/* Tries the boxes from `first` to `last`, which lie at one edge of the picture. */
static void try_edge(hl_search *search, hl_rectangle first, hl_rectangle last, hl_rectangle usual,
                     double step) {
  const bool along_x = last.left != first.left;
  const double from = along_x ? first.left : first.top, to = along_x ? last.left : last.top;
  const double length = along_x ? first.width : first.height;
  const int count = (int)fmax(ceil(fabs(to - from) / step), 1);
  for (int n = 0; n <= count; n++) try_at(search, first, along_x, from + (to - from) * n / count, usual);
  for (size_t n = 0; n < search->taken->count; n++) {
    const hl_rectangle box = search->taken->boxes[n];
    const double before = (along_x ? box.left : box.top) - search->rim - length,
                 after = (along_x ? box.left + box.width : box.top + box.height) + search->rim;
    const double low = fmin(from, to), high = fmax(from, to);
    if (before >= low && before <= high) try_at(search, first, along_x, before, usual);
    if (after >= low && after <= high) try_at(search, first, along_x, after, usual);
  }
}

void hl_search_edge(hl_search *search, hl_rectangle usual, hl_rectangle other, double step) {
  try_edge(search, usual, other, usual, step);
}

void hl_search_edges(hl_search *search, hl_rectangle usual, double step) {
  const hl_rectangle picture = search->taken->picture;
  const hl_rectangle across = hl_rectangle_in_corner(usual, picture, true, false),
                     down = hl_rectangle_in_corner(usual, picture, false, true),
                     opposite = hl_rectangle_in_corner(usual, picture, true, true);
  const bool high = usual.height > picture.height / 2, wide = usual.width > picture.width / 2;
  if (!high || wide) {
    try_edge(search, usual, across, usual, step);
    try_edge(search, down, opposite, usual, step);
  }
  if (!wide || high) {
    try_edge(search, usual, down, usual, step);
    try_edge(search, across, opposite, usual, step);
  }
}
