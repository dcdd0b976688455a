/* surface/late/seen_seams.c - see seen_seams.h. */
#include "surface/late/seen_seams.h"

#include "surface/late/surface_seams.h"
#include "surface/primitive.h"

static bool set_end(const fragments_source *source, uint32_t vertex, double at[2], double *height) {
  vec3 place = hl_surface_vector(source->surfaces->positions[vertex]);
  *height = vec3_dot(source->sheets->normal, place) - source->sheets->first;
  return hl_view_project(source->view, place, at);
}

/* Returns whether a triangle casts a shadow and lets no light through, and no cut may remove a part of it. */
static bool is_opaque_shade(const fragment_work *work, uint32_t triangle) {
  const surfaces *all = work->source->surfaces;
  size_t mesh = hl_surface_mesh_of(all, triangle);
  return all->meshes[mesh].look.casts_shadow && !all->meshes[mesh].is_cut && work->least[mesh] >= 1 &&
         hl_primitive_opacity(all, &all->meshes[mesh], triangle) >= 1;
}

void hl_see_seams(const fragment_work *work, const fragment *f, seen_seams *seams) {
  const fragments_source *source = work->source;
  size_t count;
  seams->count = 0;
  if (source->rise <= 0 || source->surfaces->seam_count == 0 || !is_opaque_shade(work, f->primitive)) return;
  const surface_seam *own = hl_surface_seams_of(source->surfaces, f->primitive, &count);
  for (size_t i = 0; i < count && seams->count < MOST_SEEN_SEAMS; i++) {
    seen_seam *seam = &seams->list[seams->count];
    if (!set_end(source, own[i].ends[0], seam->at[0], &seam->height[0]) ||
        !set_end(source, own[i].ends[1], seam->at[1], &seam->height[1]) ||
        !is_opaque_shade(work, own[i].other))
      continue;
    hl_plane_of_triangle(source->view, source->sheets, source->surfaces, own[i].other, &seam->other);
    seams->count++;
  }
}

/* The point of a corner's edge that is closest to the continuous pixel (u, v), as a fraction of the way from
 * the edge's first end to its second end. */
static double closest_part(const seen_seam *seam, double u, double v) {
  double x = seam->at[1][0] - seam->at[0][0], y = seam->at[1][1] - seam->at[0][1], square = x * x + y * y;
  if (!(square > 0)) return 0;
  return fmin(fmax(((u - seam->at[0][0]) * x + (v - seam->at[0][1]) * y) / square, 0), 1);
}

double hl_seam_end(const fragments_source *source, const seen_seams *seams, double u, double v, double end) {
  for (int i = 0; i < seams->count; i++) {
    const seen_seam *seam = &seams->list[i];
    double part = closest_part(seam, u, v), x = seam->at[0][0] + part * (seam->at[1][0] - seam->at[0][0]) - u,
           y = seam->at[0][1] + part * (seam->at[1][1] - seam->at[0][1]) - v;
    if (x * x + y * y > BESIDE_SEAM * BESIDE_SEAM) continue;
    double height = seam->height[0] + part * (seam->height[1] - seam->height[0]);
    end = fmax(end, height + (source->delay + SEAM_OVERLAP) * hl_plane_slope(&seam->other, u, v));
  }
  return end;
}
