/* surface/coverage.h - finds which samples a polygon covers. Each pixel of a tile has sixteen samples.
 *
 * Coordinates are whole numbers of 1/256 pixels. So a sample on an edge that two triangles share belongs to
 * exactly one of these triangles, on every machine. */
#ifndef HL_SURFACE_COVERAGE_H
#define HL_SURFACE_COVERAGE_H

#include "surface/seen.h"

/* A rectangle of a tile's pixels; the last column and row are included. */
typedef struct pixel_span {
  int x0, y0, x1, y1;
} pixel_span;

/* Finds the samples of a tile that a polygon covers. covered: [TILE rows][TILE columns], one bit for each
 * sample; set only within *span, because nothing is covered outside of it. Returns whether any sample is
 * covered. The polygon must be convex; its corners may have either orientation. */
bool hl_cover_tile(const seen_polygon *polygon, int tile_x, int tile_y, pixel_span *span,
                   uint16_t covered[TILE_PIXELS]);

#endif
