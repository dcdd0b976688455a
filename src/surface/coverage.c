/* surface/coverage.c - see coverage.h. A polygon is divided into a fan of triangles. A triangle covers a
 * sample where its three edge functions (Pineda 1988) are all at least 0. */
#include "surface/coverage.h"

#include <string.h>

#include "surface/sample_rows.h"

enum { SAMPLES = 16 };

/* An edge of a polygon, as an edge function. The function is value + x * across + y * down, where x and y are
 * the column and the row of a pixel, counted from the tile's corner. The function is at least 0 on the side
 * of the edge on which the polygon lies. */
typedef struct edge {
  int64_t value, across, down;
  int64_t offset[SAMPLES]; /* for each sample of a pixel, the difference of the edge function from its value
                            * at the pixel's corner */
  int64_t least, greatest; /* the least and the greatest of these offsets */
} edge;

/* Sets the edge from a to b. The caller chooses the order of the corners, and by it the side of the edge that
 * is the inside. A sample that lies on an edge must belong to only one of the two triangles of the edge. The
 * edge has opposite directions in these triangles. So the function is reduced by 1 for edges in one half of
 * all directions. */
static void set_edge(edge *e, int64_t ax, int64_t ay, int64_t bx, int64_t by) {
  int64_t dx = bx - ax, dy = by - ay;
  bool owns = dy > 0 || (dy == 0 && dx < 0);
  e->across = dy * SUBPIXELS;
  e->down = -dx * SUBPIXELS;
  e->value = -ax * dy + ay * dx - (owns ? 0 : 1);
  e->least = INT64_MAX;
  e->greatest = INT64_MIN;
  for (int s = 0; s < SAMPLES; s++) {
    int64_t x = (2 * s + 1) * SUBPIXELS / 32, y = (2 * SAMPLE_ROWS[s] + 1) * SUBPIXELS / 32;
    e->offset[s] = x * dy - y * dx;
    if (e->offset[s] < e->least) e->least = e->offset[s];
    if (e->offset[s] > e->greatest) e->greatest = e->offset[s];
  }
}

static uint32_t cover_pixel(const edge edges[3], int x, int y) {
  int64_t at[3];
  bool whole = true;
  for (int i = 0; i < 3; i++) {
    at[i] = edges[i].value + x * edges[i].across + y * edges[i].down;
    if (at[i] + edges[i].greatest < 0) return 0;
    whole = whole && at[i] + edges[i].least >= 0;
  }
  if (whole) return 0xffff;
  uint32_t bits = 0;
  for (int s = 0; s < SAMPLES; s++) {
    int64_t outside = (at[0] + edges[0].offset[s]) | (at[1] + edges[1].offset[s]) |
                      (at[2] + edges[2].offset[s]);
    bits |= (uint32_t)(outside >= 0) << s;
  }
  return bits;
}

static int clamp_pixel(int64_t subpixels) {
  int64_t pixel = subpixels < 0 ? 0 : subpixels / SUBPIXELS;
  return pixel > TILE - 1 ? TILE - 1 : (int)pixel;
}

/* ---- triangles and polygons ---- */

/* Finds the samples that a triangle covers. x, y: its corners, in 1/256 pixels from the tile's corner. */
static bool cover_triangle(const int64_t x[3], const int64_t y[3], const pixel_span *span,
                           uint16_t covered[TILE_PIXELS]) {
  int64_t area = (x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0]);
  edge edges[3];
  uint32_t any = 0;
  if (area == 0) return false;
  for (int i = 0; i < 3; i++) {
    int from = area < 0 ? i : (i + 1) % 3, to = area < 0 ? (i + 1) % 3 : i;
    set_edge(&edges[i], x[from], y[from], x[to], y[to]);
  }
  for (int row = span->y0; row <= span->y1; row++)
    for (int column = span->x0; column <= span->x1; column++) {
      uint32_t bits = cover_pixel(edges, column, row);
      covered[row * TILE + column] |= (uint16_t)bits;
      any |= bits;
    }
  return any != 0;
}

/* Finds the pixels of the tile that lie within a polygon's bounds. Returns false if there are none. */
static bool find_span(const seen_polygon *polygon, int64_t left, int64_t top, pixel_span *span) {
  int64_t x0 = INT64_MAX, y0 = INT64_MAX, x1 = INT64_MIN, y1 = INT64_MIN;
  for (int i = 0; i < polygon->count; i++) {
    int64_t x = polygon->x[i] - left, y = polygon->y[i] - top;
    x0 = x < x0 ? x : x0, x1 = x > x1 ? x : x1;
    y0 = y < y0 ? y : y0, y1 = y > y1 ? y : y1;
  }
  if (polygon->count == 0 || x1 < 0 || y1 < 0 || x0 >= TILE * SUBPIXELS || y0 >= TILE * SUBPIXELS)
    return false;
  *span = (pixel_span){clamp_pixel(x0), clamp_pixel(y0), clamp_pixel(x1), clamp_pixel(y1)};
  return true;
}

bool hl_cover_tile(const seen_polygon *polygon, int tile_x, int tile_y, pixel_span *span,
                   uint16_t covered[TILE_PIXELS]) {
  int64_t left = (int64_t)tile_x * TILE * SUBPIXELS, top = (int64_t)tile_y * TILE * SUBPIXELS;
  bool any = false;
  if (!find_span(polygon, left, top, span)) return false;
  for (int row = span->y0; row <= span->y1; row++)
    memset(covered + row * TILE + span->x0, 0, (size_t)(span->x1 - span->x0 + 1) * sizeof *covered);
  for (int i = 1; i + 1 < polygon->count; i++) {
    const int corner[3] = {0, i, i + 1};
    int64_t x[3], y[3];
    for (int k = 0; k < 3; k++) {
      x[k] = polygon->x[corner[k]] - left;
      y[k] = polygon->y[corner[k]] - top;
    }
    any = cover_triangle(x, y, span, covered) || any;
  }
  return any;
}
