/* isosurface/vertex_colors.c - see vertex_colors.h. As in matter, a value of the other volume is interpolated
 * linearly between its voxels, and beyond its faces the values at the faces continue. */
#include "isosurface/vertex_colors.h"

#include "core/memory.h"
#include "scene/function/function_plane.h"

enum { RUN_VERTICES = 4096 };

typedef struct color_job {
  const hl_function_plane *plane;
  const iso_coloring *coloring;
  const iso_triangles *made;
  affine3 to_second; /* maps the grid's index space to the index space of the second volume */
  float (*colors)[4];
} color_job;

bool hl_iso_has_second_color(const hl_scene_volume *volume, size_t i) {
  return volume->iso[i].second_color && hl_has_second_colors(&volume->transfer_function);
}

static void color_run(void *data, size_t index, int worker) {
  (void)worker;
  const color_job *job = data;
  const size_t end = (index + 1) * RUN_VERTICES;
  for (size_t v = index * RUN_VERTICES; v < end && v < job->made->vertex_count; v++) {
    const float *p = job->made->positions[v];
    const vec3 point = affine3_apply(job->to_second, (vec3){p[0], p[1], p[2]});
    const double second = hl_volume_value_between(job->coloring->second->volume,
                                                  (double[3]){point.x, point.y, point.z}) *
                          hl_plane_second_scale(job->plane);
    double color[3];
    hl_curves_color(&job->plane->curves, second, job->coloring->own_color, color);
    for (int c = 0; c < 3; c++) job->colors[v][c] = (float)color[c];
    job->colors[v][3] = 1;
  }
}

hl_status hl_iso_color_vertices(hl_pool *pool, const hl_scene_volume *volume, const grid *grid,
                                const iso_coloring *coloring, const iso_triangles *made, float (**colors)[4],
                                hl_error *error) {
  hl_context *context = volume->volume->context;
  color_job job = {.plane = &volume->transfer_function.plane,
                   .coloring = coloring,
                   .made = made,
                   .to_second = coloring->index_to_second};
  const vec3 shift = mat3_apply(job.to_second.linear, vec3_of(grid->shift));
  job.to_second.offset = vec3_subtract(job.to_second.offset, shift);
  *colors = job.colors = hl_allocate(context, made->vertex_count, sizeof *job.colors);
  if (job.colors == NULL)
    return hl_fail_memory(error, made->vertex_count * sizeof *job.colors, "the colours of an isosurface");
  const size_t runs = (made->vertex_count + RUN_VERTICES - 1) / RUN_VERTICES;
  hl_status status = hl_lattice_run(pool, runs, color_run, &job, error);
  if (status == HL_OK) return HL_OK;
  hl_release(context, job.colors);
  *colors = NULL;
  return status;
}
