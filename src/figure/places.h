/* figure/places.h - finds where the parts of an overlay lie over a picture. */
#ifndef HL_FIGURE_PLACES_H
#define HL_FIGURE_PLACES_H

#include <halflight/figure.h>
#include <stdbool.h>

#include "figure/map.h"

/* ---- the matter in the picture ---- */

/* The opacity of the picture, summed over the cells of a grid that covers the picture. */
typedef struct hl_cover {
  hl_context *context;
  int64_t *sums; /* owned; [(rows + 1) * (columns + 1)]; for each corner of cells, the sum of the opacities
                  * (0 to 255) of all pixels above the corner and to its left; null if the picture shows
                  * nothing */
  int columns, rows;
  int side;          /* the number of pixels along the side of a cell */
  int width, height; /* the number of the picture's pixels */
} hl_cover;

/* Measures a picture. image: may be null; the picture then shows nothing. */
hl_status hl_cover_measure(hl_context *context, const hl_image *image, hl_cover *cover, hl_error *error);
void hl_cover_release(hl_cover *cover);

/* The area of the picture, weighted by its opacity, in all cells that a box on the page touches; points
 * squared. picture: the rectangle of the picture on the page. */
double hl_cover_in(const hl_cover *cover, hl_rectangle picture, hl_rectangle box);

/* ---- rectangles ---- */

/* Returns whether two rectangles overlap. */
bool hl_rectangles_meet(hl_rectangle a, hl_rectangle b);
bool hl_rectangle_lies_in(hl_rectangle box, hl_rectangle picture);
/* A rectangle with a rim around it. */
hl_rectangle hl_rectangle_widened(hl_rectangle box, double rim);
/* The rectangle mirrored at the middle of the picture. across: whether the rectangle's distance from the
 * left edge becomes its distance from the right edge. down: whether its distance from the upper edge
 * becomes its distance from the lower edge. */
hl_rectangle hl_rectangle_in_corner(hl_rectangle box, hl_rectangle picture, bool across, bool down);

/* ---- the places that other drawings take ---- */

enum { HL_MOST_TAKEN = 128 };

typedef struct hl_taken {
  hl_rectangle picture;              /* the rectangle of the picture on the page, points */
  hl_rectangle boxes[HL_MOST_TAKEN]; /* [count]; rectangles on the page of which all searches keep clear */
  size_t count;
} hl_taken;

void hl_take(hl_taken *taken, hl_rectangle box);

/* The greatest height of a rectangle as wide as `column`, within `column`, that meets nothing taken. */
double hl_free_height(const hl_taken *taken, hl_rectangle column);

/* ---- the search ---- */

/* The search for the place of one part. Boxes that are tried count only if they lie within the picture and
 * keep clear of other drawings. The best box covers the least of the picture's matter. Among boxes that
 * cover equally little, the box nearest to the part's usual place is the best. */
typedef struct hl_search {
  const hl_taken *taken;
  const hl_cover *cover; /* null if the part may cover matter, as the text beside a point may */
  double rim;            /* the distance that the part keeps from other drawings, points */
  double unit;           /* the area by which covered areas are counted, points squared, above 0 */
  bool found;            /* whether any box counts */
  hl_rectangle box;      /* the best box */
  double covered;        /* the area that the box covers, with its rim, in units */
  double far;            /* the distance of the best box from the usual place */
} hl_search;

/* Tries a box. far: its distance from the usual place. Returns whether it is the best box so far. */
bool hl_search_try(hl_search *search, hl_rectangle box, double far);

/* Tries boxes along one edge of the picture, from the usual box to another one at the same edge: at equal
 * steps, and at the places where a box touches another drawing. step: the greatest distance of neighbouring
 * boxes, points. */
void hl_search_edge(hl_search *search, hl_rectangle usual, hl_rectangle other, double step);

/* Tries boxes along all four edges of the picture, in the same way, all as far from the edges as the usual
 * box. A box higher than half the picture stays at the left or right edge of the picture. A box wider than
 * half the picture stays at the upper or lower edge. */
void hl_search_edges(hl_search *search, hl_rectangle usual, double step);

#endif
