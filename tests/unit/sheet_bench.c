/* unit/sheet_bench.c - see sheet_bench.h. */
#include "sheet_bench.h"

#include <setjmp.h>
#include <stdarg.h>
#include <string.h>

#include <cmocka.h>

#include "core/context.h"

enum { BENCH_SIDE = 48, BENCH_SHEETS = 5 };

double bench_random(uint32_t *state) {
  *state ^= *state << 13;
  *state ^= *state >> 17;
  *state ^= *state << 5;
  return *state / 4294967296.0;
}

vec3 bench_random_direction(uint32_t *state) {
  for (;;) {
    vec3 v = {2 * bench_random(state) - 1, 2 * bench_random(state) - 1, 2 * bench_random(state) - 1};
    if (vec3_length(v) > 0.1 && vec3_length(v) < 1) return vec3_normalise(v);
  }
}

vec3 bench_random_normal(vec3 direction, uint32_t *state) {
  return vec3_normalise(vec3_add(direction, vec3_scale(bench_random_direction(state), 0.8)));
}

mat3 bench_oblique_axes(void) {
  return mat3_from_columns((vec3){1, 0.1, 0}, (vec3){-0.2, 1.3, 0.1}, (vec3){0.1, 0.15, 0.8});
}

static void require(hl_status status, const hl_error *error) {
  if (status != HL_OK) fail_msg("%s", error->message);
}

void bench_open(bench *bench, const size_t dimensions[3], hl_storage storage, const void *voxels, mat3 axes) {
  static const hl_voxel_type types[] = {HL_VOXEL_U8, HL_VOXEL_U16, HL_VOXEL_F32};
  hl_error error = {0};
  memset(bench, 0, sizeof *bench);
  require(hl_context_create(NULL, &bench->context, &error), &error);
  require(hl_pool_create(bench->context, 1, &bench->pool, &error), &error);
  hl_volume_description description;
  hl_volume_description_defaults(&description);
  vec3 middle = {0, 0, 0};
  for (int a = 0; a < 3; a++) {
    vec3 step = mat3_column(axes, a);
    description.dimensions[a] = dimensions[a];
    description.axis[a][0] = step.x;
    description.axis[a][1] = step.y;
    description.axis[a][2] = step.z;
    middle = vec3_add(middle, vec3_scale(step, ((double)dimensions[a] - 1) / 2));
  }
  description.type = types[storage];
  description.voxels = voxels;
  hl_scene_volume_defaults(&bench->scene);
  require(hl_volume_create(bench->context, &description, &bench->scene.volume, &error), &error);
  bench->opacity = (hl_opacity_point){0, 0.5};
  bench->color = (hl_color_point){0, {1, 1, 1}};
  bench->scene.transfer_function = (hl_transfer_function){.unit_distance = 1,
                                                          .opacity = &bench->opacity,
                                                          .opacity_count = 1,
                                                          .color = &bench->color,
                                                          .color_count = 1};
  affine3 placement = {axes, vec3_scale(middle, -1)};
  const grid_source source = {&bench->scene, hl_kernel_get(HL_KERNEL_BSPLINE), placement,
                              hl_scene_volume_empty_value(&bench->scene)};
  require(hl_grid_create(bench->context, bench->pool, hl_hot_functions(hl_cpu_best_instruction_set())->grid,
                         &source, &bench->grid, &error),
          &error);
  require(hl_classifier_create(bench->context, &bench->scene, NULL, &bench->grid, &bench->classifier, &error),
          &error);
  hl_grid_mark_relevant(&bench->grid, hl_hot_functions(hl_cpu_best_instruction_set())->grid,
                        &bench->classifier, bench->pool);
}

void bench_show(bench *bench, const hl_opacity_point *opacity, size_t count) {
  hl_error error = {0};
  hl_classifier_release(bench->context, &bench->classifier);
  bench->scene.transfer_function.opacity = opacity;
  bench->scene.transfer_function.opacity_count = count;
  require(hl_classifier_create(bench->context, &bench->scene, NULL, &bench->grid, &bench->classifier, &error),
          &error);
  hl_grid_mark_relevant(&bench->grid, hl_hot_scalar.grid, &bench->classifier, bench->pool);
}

void bench_look(bench *bench, vec3 direction, vec3 normal, double pixel, double distance, hl_kernel which) {
  hl_error error = {0};
  view *view = &bench->view;
  vec3 u = vec3_perpendicular(direction), v = vec3_cross(direction, u);
  view->perspective = distance > 0;
  view->width = view->height = BENCH_SIDE;
  view->direction = direction;
  view->origin = vec3_scale(direction, -distance);
  double edge = view->perspective ? pixel / distance : pixel;
  view->du = vec3_scale(u, edge);
  view->dv = vec3_scale(v, edge);
  view->corner = vec3_scale(vec3_add(view->du, view->dv), -BENCH_SIDE / 2.0);
  view->corner = vec3_add(view->corner, view->perspective ? direction : vec3_scale(direction, -50));
  assert_true(hl_view_finish(view));
  bench->sheets = (sheet_stack){normal, -0.7, 1.0 / 3, BENCH_SHEETS};
  hl_voxel_lists_release(bench->context, &bench->lists);
  const voxel_sort sort = {&bench->grid, hl_kernel_get(which), view, &bench->sheets};
  require(hl_voxel_lists_build(bench->context, bench->pool, &sort, &bench->lists, &error), &error);
}

fill_source bench_source(const bench *bench, hl_kernel which, int sheet) {
  fill_source source = {
      .grid = &bench->grid, .kernel = hl_kernel_get(which), .lists = &bench->lists, .sheet = sheet};
  hl_view_sheet_rays(&bench->view, bench->sheets.normal, bench->sheets.first + sheet * bench->sheets.spacing,
                     bench->grid.frame_to_index, &source.rays);
  return source;
}

slab_run bench_run(const bench *bench, double beside) {
  slab_run run = {.grid = &bench->grid};
  for (int axis = 0; axis < 3; axis++) {
    run.low[axis] = (float)(bench->grid.box_low[axis] + beside);
    run.high[axis] = (float)(bench->grid.box_high[axis] - beside);
  }
  for (int sheet = 0; sheet <= RUN_SLABS; sheet++)
    hl_view_sheet_rays(&bench->view, bench->sheets.normal,
                       bench->sheets.first + sheet * bench->sheets.spacing, bench->grid.frame_to_index,
                       &run.rays[sheet]);
  return run;
}

vec3 bench_position(const bench *bench, int sheet, int x, int y) {
  vec3 start, direction, normal = bench->sheets.normal;
  hl_view_ray(&bench->view, x + 0.5, y + 0.5, &start, &direction);
  double height = bench->sheets.first + sheet * bench->sheets.spacing;
  double s = (height - vec3_dot(normal, start)) / vec3_dot(normal, direction);
  return affine3_apply(bench->grid.frame_to_index, vec3_add(start, vec3_scale(direction, s)));
}

void bench_close(bench *bench) {
  hl_voxel_lists_release(bench->context, &bench->lists);
  hl_classifier_release(bench->context, &bench->classifier);
  hl_grid_release(bench->context, &bench->grid);
  hl_volume_release(bench->scene.volume);
  hl_pool_destroy(bench->pool);
  assert_true(hl_context_memory_held(bench->context) == 0);
  hl_context_destroy(bench->context);
}
