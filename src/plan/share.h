/* plan/share.h - divides a picture among several renderers: finds the pixels that each renderer makes.
 *
 * An eye's ray and a light's ray that meet lie in one plane with the eye and the light. In the picture, such
 * planes appear as lines through the light's image. If the image is infinitely far away, the lines are
 * parallel. So a band of the picture along such lines looks up only a band of the light's shadow buffer, over
 * all sheets. Each part of a picture is a band along the lines of the brightest light whose shadow method
 * lets parts work through their own light. Bands consist of whole cells, and each band has about the same
 * amount of matter under it. Where parts wait for each other at each depth, a part may have two or three
 * bands, so that the parts have more equal amounts of matter at each depth. Where all parts need all light
 * anyway, rows of cells are given to the parts in turn. */
#ifndef HL_PLAN_SHARE_H
#define HL_PLAN_SHARE_H

#include "core/light_exchange.h"
#include "core/memory.h"
#include "plan/frame.h"
#include "plan/frame_objects.h"

/* The division of a picture into parts, which consist of cells. A cell is `oversampling` tiles of the frame
 * wide and high, so that a cell has as many pixels of the picture as a tile has pixels of the frame. */
typedef struct picture_share {
  int part, parts;                /* part: number of this renderer's part; parts: number of parts */
  const light_exchange *exchange; /* borrowed; exchanges light with the other parts; null if light is not
                                   * exchanged */
  int cells_x, cells_y;           /* number of cells of the whole picture */
  int oversampling;               /* number of the frame's tiles along each side of a cell */
  unsigned char *memory;          /* owned; holds part_of; null if the picture is not shared */
  int32_t *part_of;               /* [cells_y][cells_x]; the part to which each cell belongs */
} picture_share;

/* The facts about a picture's content on which the division into parts depends. */
typedef struct share_content {
  const frame *frame;        /* the frame, whose eye and lights must be set up */
  const frame_light *lights; /* the frame's lights; a light source names its light by `row` */
  const grid *grids;         /* [grid_count]; the grids of the frame's volumes */
  int grid_count;
  const sheet_stack *sheets; /* sheets of the frame's first sweep */
} share_content;

/* Counts the memory that hl_share_create() takes for a picture of width x height pixels. */
void hl_share_count(int width, int height, int parts, hl_layout *layout);

/* Divides a picture into parts; the result is the same on every machine. share: its members part and parts
 * must be set. A single part needs no division, and the function does nothing. The caller owns `share`, and
 * must release it after a failure, too. */
hl_status hl_share_create(hl_context *context, const share_content *content, picture_share *share,
                          hl_error *error);
void hl_share_release(hl_context *context, picture_share *share);

/* Returns whether a tile of the frame belongs to this renderer's part. */
static inline bool hl_share_has(const picture_share *share, int tile_x, int tile_y) {
  if (share->part_of == NULL) return true;
  return share->part_of[tile_y / share->oversampling * share->cells_x + tile_x / share->oversampling] ==
         share->part;
}

#endif
