/* surface/shown_surface.h - describes the surface that a fragment of the eye's view shows, and the heights of
 * this surface. */
#ifndef HL_SURFACE_SHOWN_SURFACE_H
#define HL_SURFACE_SHOWN_SURFACE_H

#include "surface/primitive_raster.h"
#include "surface/sphere_coverage.h"

struct shown_surface {
  const primitive_raster *raster; /* the table of the primitive's kind; members below that belong to other
                                   * kinds are not set */
  double lowest, highest;         /* the least and the greatest height of the primitive above the first
                                   * sheet */
  /* for a triangle: its plane */
  surface_plane plane;
  /* for a triangle: whether the view cut no corner of it; if so, the surface's height is rise / part */
  bool by_corners;
  double rise[3], part[3]; /* linear functions of the pixel, as in surface_plane */
  /* for a sphere: the view's rays, relative to the sphere's centre */
  sphere_rays rays;
  bool leaving; /* for a sphere: whether the fragment lies on the side where rays leave the sphere */
};

/* The surface's height above the first sheet at a continuous pixel of the view. */
static inline double hl_shown_height(const sheet_stack *sheets, const shown_surface *shown, double u,
                                     double v) {
  return shown->raster->height(sheets, shown, u, v);
}

#endif
