/* render/picture.h - makes the caller's picture from the tiles of a frame's sweeps.
 *
 * The lights' contributions from all sweeps are added up; opacity is the same in every sweep. Pixels are
 * averaged where the frame is oversampled. */
#ifndef HL_RENDER_PICTURE_H
#define HL_RENDER_PICTURE_H

#include "core/pool.h"
#include "view/view.h"

typedef struct picture {
  const float *tiles; /* [sweeps][tiles_of_sweep][16][4][16]; R G B A, premultiplied, linear */
  int sweeps;
  size_t tiles_x, tiles_of_sweep;
  int oversampling;  /* a pixel of the picture is the mean of oversampling x oversampling of the frame's
                      * pixels */
  float *pixels;     /* the caller's pixels; [height][row_stride]; R G B A */
  size_t row_stride; /* counted in floats */
  int width, height; /* size of the picture */
} picture;

/* Writes the caller's pixels. */
void hl_picture_write(const picture *picture, hl_pool *pool);

/* Reorders the caller's pixels, which hold the tiles of the only sweep, to rows of pixels. This is possible
 * without oversampling, if the picture consists of whole tiles and has no gaps between rows. rows:
 * [threads][tiles_x][16][4][16], memory for this call. */
void hl_picture_reorder(const picture *picture, float *rows, hl_pool *pool);

#endif
