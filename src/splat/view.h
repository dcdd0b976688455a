/* splat/view.h - how the pixels of the eye or of a light see the sheets.
 *
 * A view is a bundle of rays, one a pixel: from one point (perspective camera, point light) or parallel
 * (orthographic camera, directional light). The picture plane may have any tilt: a shadow buffer lies
 * perpendicular to its light for hard shadows and parallel to the sheets for soft ones (fig. 17).
 * Pixel (i, j) has its centre at (i + 1/2, j + 1/2). Positions are in frame space: world moved so that
 * the scene's centre is the origin, which keeps float arithmetic exact enough far from the world's. */
#ifndef HL_SPLAT_VIEW_H
#define HL_SPLAT_VIEW_H

#include <stddef.h>

#include "core/vector.h"

typedef struct view {
  bool perspective;
  int width, height;   /* pixels */
  vec3 origin;         /* perspective: where the rays meet; frame space */
  vec3 corner, du, dv; /* perspective: ray of continuous pixel (u, v) is corner + u du + v dv;
                          parallel: the ray's start point */
  vec3 direction;      /* parallel: unit direction of every ray */
  mat3 inverse;        /* (w, w u, w v) = inverse * (X - origin) for perspective,
                          (distance, u, v) = inverse * (X - corner) for parallel */
} view;

/* Fills inverse from the other members; false where the view is degenerate. */
bool hl_view_finish(view *view);

/* Continuous pixel coordinates of a point; false where a perspective view has it behind. */
bool hl_view_project(const view *view, vec3 point, double uv[2]);

/* The ray through continuous pixel (u, v): start and (unnormalised) direction. */
void hl_view_ray(const view *view, double u, double v, vec3 *start, vec3 *direction);

/* (w, w u, w v) as affine functions of a point p of another space (given by to_frame): rows of 4 floats,
 * the last is the constant. For a parallel view w is 1. */
void hl_view_homogeneous(const view *view, affine3 to_frame, double rows[3][4]);

/* Pixels on one sheet, in the space that was asked for; (u, v) counts whole pixels from the first pixel's
 * centre. perspective: position = base + P / H, direction W parallel:    position = P with P = p0 + u pu + v
 * pv, W = w0 + u wu + v wv and H = h.W = h0 + u hu + v hv. Derived: the ray E + s W meets the sheet h.X = z
 * at s = (z - h.E) / H; with any t and Wc, base = E + t Wc gives P = (z - h.E) W - t H Wc, linear as H is.
 * With Wc the middle ray and base where it meets the sheet, P stays as small as what is seen, however far the
 * eye is. */
typedef struct sheet_rays {
  int perspective;
  float base[3], p0[3], pu[3], pv[3];
  float w0[3], wu[3], wv[3]; /* perspective */
  float h0, hu, hv;
  float step; /* z - h.E */
} sheet_rays;

/* normal: unit normal of the sheets; height: the sheet's h.X; from_frame: frame space to the wanted space. */
void hl_view_sheet_rays(const view *view, vec3 normal, double height, affine3 from_frame, sheet_rays *rays);

#endif
