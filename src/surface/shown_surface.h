/* surface/shown_surface.h - the surface that a fragment of the eye's view shows, and the surface's heights
 * there. */
#ifndef HL_SURFACE_SHOWN_SURFACE_H
#define HL_SURFACE_SHOWN_SURFACE_H

#include "surface/primitive_raster.h"
#include "surface/sphere_coverage.h"

struct shown_surface {
  const primitive_raster *raster; /* the table of the primitive's kind. The members below that belong to other
                                   * kinds are not set */
  double lowest, highest;         /* the least and the greatest height of the primitive above the first
                                   * sheet */
  /* Of a triangle. */
  surface_plane plane;
  bool by_corners;         /* whether no corner of the triangle was cut by the view; then the height is rise /
                            * part */
  double rise[3], part[3]; /* linear functions of the pixel, like those of surface_plane */
  /* Of a sphere. */
  sphere_rays rays;
  bool leaving; /* the side where rays leave it */
};

/* The surface's height above the first sheet at a continuous pixel of the view. */
static inline double hl_shown_height(const sheet_stack *sheets, const shown_surface *shown, double u,
                                     double v) {
  return shown->raster->height(sheets, shown, u, v);
}

#endif
