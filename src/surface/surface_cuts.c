/* surface/surface_cuts.c - see surface_cuts.h. */
#include "surface/surface_cuts.h"

#include "surface/primitive.h"
#include "surface/sample_rows.h"
#include "surface/sphere_coverage.h"

cut_answer hl_surface_cut(const surfaces *all, const surface_mesh *mesh, uint32_t primitive) {
  if (!mesh->is_cut) return CUT_LEAVES_ALL;
  float from[3], to[3];
  hl_primitive_kind(all, primitive)->bound(all, primitive, from, to);
  const double low[3] = {from[0], from[1], from[2]}, high[3] = {to[0], to[1], to[2]};
  if (hl_cuts_remove_box(all->cuts, all->cut_count, low, high)) return CUT_LEAVES_NOTHING;
  return hl_cuts_leave_box(all->cuts, all->cut_count, low, high) ? CUT_LEAVES_ALL : CUT_LEAVES_SOME;
}

/* The point of the part at continuous pixel (u, v). */
static vec3 point_of(const seen_part *part, double u, double v) {
  const view *view = part->view;
  vec3 point = {NAN, NAN, NAN};
  if (part->sphere != NULL) {
    const sphere_rays rays = hl_sphere_rays(view, part->sphere);
    (void)hl_meet_sphere(&rays, u, v, part->leaving, &point);
    return point;
  }
  vec3 pixel = vec3_add(view->corner, vec3_add(vec3_scale(view->du, u), vec3_scale(view->dv, v)));
  double along = hl_plane_linear(part->plane->rise, u, v) / hl_plane_linear(part->plane->way, u, v);
  return view->perspective ? vec3_add(view->origin, vec3_scale(pixel, along))
                           : vec3_add(pixel, vec3_scale(view->direction, along));
}

uint16_t hl_left_samples(const seen_part *part, int x, int y, uint16_t samples) {
  uint16_t left = 0;
  if (part->all == NULL) return samples;
  for (int s = 0; s < FRAGMENT_SAMPLES; s++) {
    if ((samples >> s & 1) == 0) continue;
    vec3 point = point_of(part, x + (s + 0.5) / FRAGMENT_SAMPLES,
                          y + (SAMPLE_ROWS[s] + 0.5) / FRAGMENT_SAMPLES);
    if (hl_cuts_leave(part->all->cuts, part->all->cut_count, point)) left |= (uint16_t)(1u << s);
  }
  return left;
}
