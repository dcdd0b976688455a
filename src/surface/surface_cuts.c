/* surface/surface_cuts.c - see surface_cuts.h. */
#include "surface/surface_cuts.h"

#include "surface/primitive.h"
#include "surface/sample_rows.h"

cut_answer hl_surface_cut(const surfaces *all, const surface_mesh *mesh, uint32_t primitive) {
  if (!mesh->is_cut) return CUT_LEAVES_ALL;
  float from[3], to[3];
  hl_primitive_kind(all, primitive)->bound(all, primitive, from, to);
  const double low[3] = {from[0], from[1], from[2]}, high[3] = {to[0], to[1], to[2]};
  if (hl_cuts_remove_box(all->cuts, all->cut_count, low, high)) return CUT_LEAVES_NOTHING;
  return hl_cuts_leave_box(all->cuts, all->cut_count, low, high) ? CUT_LEAVES_ALL : CUT_LEAVES_SOME;
}

uint16_t hl_left_samples(const seen_part *part, int x, int y, uint16_t samples) {
  uint16_t left = 0;
  if (part->all == NULL) return samples;
  for (int s = 0; s < FRAGMENT_SAMPLES; s++) {
    if ((samples >> s & 1) == 0) continue;
    vec3 point = part->point(part->shape, x + (s + 0.5) / FRAGMENT_SAMPLES,
                             y + (SAMPLE_ROWS[s] + 0.5) / FRAGMENT_SAMPLES);
    if (hl_cuts_leave(part->all->cuts, part->all->cut_count, point)) left |= (uint16_t)(1u << s);
  }
  return left;
}
