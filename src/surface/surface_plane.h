/* surface/surface_plane.h - finds the height at which a view's rays meet a plane: the plane of a triangle, or
 * a plane that touches a sphere. */
#ifndef HL_SURFACE_SURFACE_PLANE_H
#define HL_SURFACE_SURFACE_PLANE_H

#include "surface/surfaces.h"
#include "view/view.h"

/* A plane as linear functions of the pixel. Each function is given by its value at pixel (0, 0) and its
 * changes by u and by v. Derived: the ray A + s B meets the plane n.X = d at s = (d - n.A) / (n.B), at the
 * height h.A + s h.B. In a perspective view A is the eye and B depends on the pixel; in a parallel view A
 * depends on the pixel and B is constant. */
typedef struct surface_plane {
  double rise[3], way[3], above[3], climb[3]; /* the linear functions d - n.A (rise), n.B (way), h.A
                                               * (above) and h.B (climb) */
  double lowest, highest;                     /* the least and the greatest height of the primitive above
                                               * the first sheet */
  bool leaving; /* whether the light's rays leave the mesh at this plane, and do not light the inside of the
                 * mesh */
} surface_plane;

/* The value of one of a surface_plane's linear functions at a continuous pixel (u, v). */
static inline double hl_plane_linear(const double f[3], double u, double v) {
  return f[0] + f[1] * u + f[2] * v;
}

void hl_plane_of_triangle(const view *view, const sheet_stack *sheets, const surfaces *all, uint32_t triangle,
                          surface_plane *plane);

/* The slab that holds a height above the first sheet. The slab is given by the number k of the sheet at its
 * end. */
static inline int32_t hl_slab_of(const sheet_stack *sheets, double height) {
  return (int32_t)fmin(fmax(ceil(height / sheets->spacing), 1), sheets->count - 1);
}

/* The plane that touches a sphere at a point. */
void hl_plane_of_sphere(const view *view, const sheet_stack *sheets, const float sphere[4], vec3 point,
                        surface_plane *plane);

/* Two functions that make a plane in two steps: hl_plane_begin() sets the members that depend only on the
 * view, hl_plane_touch_sphere() sets the other members. */
void hl_plane_begin(const view *view, const sheet_stack *sheets, surface_plane *plane);
void hl_plane_touch_sphere(const view *view, const sheet_stack *sheets, const float sphere[4], vec3 point,
                           surface_plane *plane);

/* The height of a plane above the first sheet, at a continuous pixel. */
double hl_plane_height(const surface_plane *plane, double u, double v);

/* The change of a plane's height from pixel to pixel. */
double hl_plane_slope(const surface_plane *plane, double u, double v);

#endif
