/* unit/small_triangles.c - sixteen small triangles or spheres are covered at a time. They cover the same
 * samples as one by one, at the heights of their planes, with the same bytes on every instruction set. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "../asserts.h"
#include "core/context.h"
#include "render/hot.h"
#include "surface/sphere_coverage.h"
#include "surface/surface_plane.h"
#include "surface/tile_fragments.h"

enum { ROUNDS = 200, CORNERS = 3 * SMALL_TRIANGLES };

static double random_between(uint32_t *seed, double low, double high) {
  *seed = *seed * 1664525u + 1013904223u;
  return low + (high - low) * (*seed >> 8) / (1 << 24);
}

/* Sixteen triangles in a tile of a view. */
typedef struct set_up {
  view view;
  sheet_stack sheets;
  surfaces all;
  float positions[CORNERS][3];
  uint32_t triangles[SMALL_TRIANGLES][3];
  small_view small;
  small_triangles input;
} set_up;

static void open_view(set_up *s, bool perspective) {
  s->view = (view){.perspective = perspective, .width = 16, .height = 16};
  vec3 along = vec3_normalise((vec3){0.1, 0.2, -1}), across = vec3_normalise((vec3){1, 0, 0.1});
  vec3 down = vec3_cross(along, across);
  s->view.origin = vec3_scale(along, -80);
  s->view.direction = along;
  s->view.du = vec3_scale(across, perspective ? 0.6 / 80 : 0.6);
  s->view.dv = vec3_scale(down, perspective ? 0.6 / 80 : 0.6);
  vec3 middle = vec3_scale(vec3_add(s->view.du, s->view.dv), -8);
  s->view.corner = vec3_add(middle, perspective ? along : s->view.origin);
  assert_true(hl_view_finish(&s->view));
  s->sheets = (sheet_stack){vec3_normalise((vec3){-0.3, 0.1, -1}), -20, 0.8, 50};
}

/* Corners around a point of the view. Some triangles are slivers, some reach across the tile's border, and
 * some are not small. */
static void place_triangles(set_up *s, uint32_t *seed) {
  for (int t = 0; t < SMALL_TRIANGLES; t++) {
    double u = random_between(seed, -1, 17), v = random_between(seed, -1, 17),
           size = t % 4 == 0   ? 1.2
                  : t % 4 == 1 ? 0.2
                               : 0.6,
           depth = random_between(seed, -4, 4);
    for (int i = 0; i < 3; i++) {
      vec3 start, way;
      hl_view_ray(&s->view, u + size * random_between(seed, -1, 1),
                  v + size * random_between(seed, -1, 1) * (t % 5 == 4 ? 0.05 : 1), &start, &way);
      double at = 80 + depth + 0.5 * random_between(seed, -1, 1);
      vec3 point = vec3_add(start, vec3_scale(way, at));
      vec3_store(s->positions[3 * t + i], point);
      s->triangles[t][i] = (uint32_t)(3 * t + i);
      double uv[2];
      assert_true(hl_view_project(&s->view, hl_surface_vector(s->positions[3 * t + i]), uv));
      s->input.x[i][t] = (int32_t)floor(uv[0] * SUBPIXELS + 0.5);
      s->input.y[i][t] = (int32_t)floor(uv[1] * SUBPIXELS + 0.5);
    }
  }
  s->all = (surfaces){.positions = s->positions, .triangles = s->triangles};
}

/* The heights, the normal and the first corner of triangle t, from its positions. */
static void describe_triangle(set_up *s, int t) {
  const float *const corner[3] = {s->positions[3 * t], s->positions[3 * t + 1], s->positions[3 * t + 2]},
                     *n = s->small.normal;
  float normal[3];
  hl_corner_product(corner, normal);
  for (int i = 0; i < 3; i++) {
    s->input.height[i][t] = n[0] * corner[i][0] + n[1] * corner[i][1] + n[2] * corner[i][2] - s->small.first;
    s->input.normal[i][t] = normal[i];
    s->input.corner[i][t] = corner[0][i];
  }
}

static void set_small_view(set_up *s, bool closed) {
  s->small = (small_view){.first = (float)s->sheets.first,
                          .spacing = (float)s->sheets.spacing,
                          .last_slab = (float)(s->sheets.count - 1),
                          .columns = TILE,
                          .rows = TILE - 2,
                          .of_light = 1,
                          .perspective = s->view.perspective,
                          .delay = 0.75f,
                          .rise = 1.25f,
                          .dark_backs = closed};
  vec3_store(s->small.normal, s->sheets.normal);
  vec3_store(s->small.from, s->view.perspective ? s->view.origin : s->view.direction);
  vec3_store(s->small.du, s->view.du);
  vec3_store(s->small.dv, s->view.dv);
  vec3_store(s->small.depth, s->view.inverse.row[0]);
  const vec3 *rows = s->view.inverse.row, origin = s->view.perspective ? s->view.origin : s->view.corner;
  for (int i = 0; i < 3; i++)
    s->small.inverse[i][0] = rows[i].x, s->small.inverse[i][1] = rows[i].y,
    s->small.inverse[i][2] = rows[i].z;
  s->small.origin[0] = origin.x, s->small.origin[1] = origin.y, s->small.origin[2] = origin.z;
  for (int t = 0; t < SMALL_TRIANGLES; t++) describe_triangle(s, t);
}

/* Compares a covered pixel with the triangle's plane in doubles. */
static void check_pixel(const set_up *s, const small_cover *cover, int k, int t, int column, int row) {
  surface_plane plane;
  double u, v;
  hl_plane_of_triangle(&s->view, &s->sheets, &s->all, (uint32_t)t, &plane);
  hl_fragment_middle(cover->samples[k][t], &u, &v);
  u += column, v += row;
  double height = fmin(fmax(hl_plane_height(&plane, u, v), plane.lowest), plane.highest),
         slope = hl_plane_slope(&plane, u, v);
  bool leaving = s->small.dark_backs && hl_plane_linear(plane.way, u, v) > 0;
  double delay = leaving ? 0 : 0.75 * slope + LEAST_DELAY * s->sheets.spacing;
  double end = fmin(height + 1.25 * slope, plane.highest + SEAM * s->sheets.spacing) + delay,
         spacing = s->sheets.spacing;
  /* derived: in perspective a height between corners differs from the linear one by at most an eighth of
   * their difference times that of their depths, which is at most twice as large, 80 away; corners rounded to
   * 1/256 pixels move the plane by at most 1/512 pixels across and down; the slope is that of the first
   * corner: in perspective it grows from pixel to pixel, with its square */
  double range = plane.highest - plane.lowest;
  double near = 1e-3 + (s->view.perspective ? range * range / 4 / 80 : 0) +
                (slope < STEEPEST_SLOPE ? slope / 512 : range);
  double near_delay = near + slope * (s->view.perspective ? 0.01 + 0.025 * slope : 2e-3);
  assert_near((double)cover->height[k][t], height, near);
  assert_near((double)cover->start[k][t], height + delay, near_delay);
  assert_near(cover->slab[k][t], height / spacing + 0.5, 0.5 + near / spacing);
  assert_near(cover->first_slab[k][t], (height + delay) / spacing + 0.5, 0.5 + near_delay / spacing);
  assert_near(cover->last_slab[k][t], end / spacing + 0.5, 0.5 + 3 * near_delay / spacing);
}

/* The samples of each pixel of the tile that cover_small() reports. */
static void collect_samples(const small_cover *cover, int t, uint16_t samples[TILE_PIXELS]) {
  memset(samples, 0, TILE_PIXELS * sizeof *samples);
  for (int k = 0; k < SMALL_PIXELS; k++)
    if (cover->covered[k] >> t & 1) samples[cover->pixel[k][t]] = cover->samples[k][t];
}

static void check_triangle(const set_up *s, const small_cover *cover, int t, int *covered) {
  uint16_t samples[TILE_PIXELS], expected[TILE_PIXELS];
  pixel_span span;
  seen_polygon polygon = {.count = 3};
  for (int i = 0; i < 3; i++) polygon.x[i] = s->input.x[i][t], polygon.y[i] = s->input.y[i][t];
  bool any = hl_cover_tile(&polygon, 0, 0, &span, expected);
  collect_samples(cover, t, samples);
  for (int row = 0; row < TILE; row++)
    for (int column = 0; column < TILE; column++) {
      bool within = any && row < s->small.rows && column >= span.x0 && column <= span.x1 && row >= span.y0 &&
                    row <= span.y1;
      int number = (row / 4 * 4 + column / 4) * 16 + row % 4 * 4 + column % 4;
      assert_int_equal(samples[number], within ? expected[row * TILE + column] : 0);
      *covered += samples[number] != 0;
    }
  for (int k = 0; k < SMALL_PIXELS; k++) {
    if (!(cover->covered[k] >> t & 1)) continue;
    int number = cover->pixel[k][t], block = number / 16, lane = number % 16;
    check_pixel(s, cover, k, t, block % 4 * 4 + lane % 4, block / 4 * 4 + lane / 4);
  }
}

static void test_against_one_by_one(void **state) {
  (void)state;
  uint32_t seed = 7;
  int small_count = 0, covered = 0;
  for (int round = 0; round < ROUNDS; round++) {
    set_up s = {0};
    small_cover cover;
    open_view(&s, round % 2);
    place_triangles(&s, &seed);
    set_small_view(&s, round % 4 >= 2);
    uint32_t small =
        hl_hot_functions(HL_INSTRUCTION_SET_SCALAR)->surface->cover_small(&s.small, &s.input, &cover);
    for (int t = 0; t < SMALL_TRIANGLES; t++) {
      if (!(small >> t & 1)) continue;
      small_count++;
      check_triangle(&s, &cover, t, &covered);
    }
  }
  assert_true(small_count > ROUNDS * SMALL_TRIANGLES / 2);
  assert_true(covered > ROUNDS * SMALL_TRIANGLES / 2);
}

/* A triangle that covers more pixels or is higher than the bounds is left to other code. */
static void test_not_small(void **state) {
  (void)state;
  uint32_t seed = 11;
  set_up s = {0};
  small_cover cover;
  cover_small_function *function = hl_hot_functions(HL_INSTRUCTION_SET_SCALAR)->surface->cover_small;
  open_view(&s, false);
  place_triangles(&s, &seed);
  set_small_view(&s, false);
  for (int i = 0; i < 3; i++) s.input.x[i][3] = 256 * 2 + (i == 1 ? 256 * 4 : 0); /* columns 2 to 6 */
  for (int i = 0; i < 3; i++) s.input.x[i][5] = s.input.y[i][5] = 256 * 4 + 100 * i;
  s.input.height[1][5] = s.input.height[0][5] + (float)(4.5 * s.sheets.spacing);
  for (int i = 0; i < 3; i++) s.input.y[i][8] = 256 * 17 + 8; /* below the tile */
  uint32_t small = function(&s.small, &s.input, &cover), not_small = 1 << 3 | 1 << 5 | 1 << 8;
  assert_int_equal(small & not_small, 0);
  assert_int_equal(cover.large & not_small, 1 << 3 | 1 << 5);
}

/* Each output that is set, byte for byte. */
static void assert_same(const small_cover *a, const small_cover *b) {
  assert_memory_equal(a->covered, b->covered, sizeof a->covered);
  for (int k = 0; k < SMALL_PIXELS; k++)
    for (int t = 0; t < SMALL_TRIANGLES; t++) {
      if (!(a->covered[k] >> t & 1)) continue;
      assert_int_equal(a->pixel[k][t], b->pixel[k][t]);
      assert_int_equal(a->samples[k][t], b->samples[k][t]);
      assert_memory_equal(&a->height[k][t], &b->height[k][t], sizeof(float));
      assert_memory_equal(&a->start[k][t], &b->start[k][t], sizeof(float));
      assert_int_equal(a->slab[k][t], b->slab[k][t]);
      assert_int_equal(a->first_slab[k][t], b->first_slab[k][t]);
      assert_int_equal(a->last_slab[k][t], b->last_slab[k][t]);
    }
}

static void test_instruction_sets(void **state) {
  (void)state;
  uint32_t seed = 3;
  for (int round = 0; round < ROUNDS; round++) {
    set_up s = {0};
    small_cover first, other;
    open_view(&s, round % 2);
    place_triangles(&s, &seed);
    set_small_view(&s, round % 4 >= 2);
    uint32_t small =
        hl_hot_functions(HL_INSTRUCTION_SET_SCALAR)->surface->cover_small(&s.small, &s.input, &first);
    for (int set = HL_INSTRUCTION_SET_AVX2; set <= HL_INSTRUCTION_SET_AVX512_VBMI; set++) {
      if (!hl_cpu_has_instruction_set((hl_instruction_set)set)) continue;
      const hot_functions *hot = hl_hot_functions((hl_instruction_set)set);
      assert_int_equal(hot->surface->cover_small(&s.small, &s.input, &other), small);
      assert_same(&first, &other);
    }
  }
}

/* The same triangles as a cluster. The cluster's vertices are seen at the same places. The triangles that are
 * asked for cover the same samples as one by one. */
static void test_cluster(void **state) {
  (void)state;
  uint32_t seed = 5, covered = 0;
  for (int round = 0; round < ROUNDS; round++) {
    set_up s = {0};
    small_cover first, other;
    seen_cluster seen;
    float positions[3][CORNERS], normals[3][CLUSTER_TRIANGLES] = {0};
    uint8_t corners[3][CLUSTER_TRIANGLES] = {0};
    open_view(&s, round % 2);
    place_triangles(&s, &seed);
    set_small_view(&s, round % 4 >= 2);
    for (int v = 0; v < CORNERS; v++)
      for (int axis = 0; axis < 3; axis++) positions[axis][v] = s.positions[CORNERS - 1 - v][axis];
    for (int t = 0; t < SMALL_TRIANGLES; t++)
      for (int i = 0; i < 3; i++) {
        corners[i][16 + t] = (uint8_t)(CORNERS - 1 - (3 * t + i));
        normals[i][16 + t] = s.input.normal[i][t];
      }
    const cluster_shape shape = {positions[0], CORNERS, corners, normals};
    uint32_t small =
        hl_hot_functions(HL_INSTRUCTION_SET_SCALAR)->surface->cover_small(&s.small, &s.input, &first);
    for (int set = HL_INSTRUCTION_SET_SCALAR; set <= HL_INSTRUCTION_SET_AVX512_VBMI; set++) {
      if (!hl_cpu_has_instruction_set((hl_instruction_set)set)) continue;
      const hot_functions *hot = hl_hot_functions((hl_instruction_set)set);
      hot->surface->see_cluster(&s.small, &shape, &seen);
      for (int t = 0; t < SMALL_TRIANGLES; t++)
        for (int i = 0; i < 3; i++) {
          assert_int_equal(seen.x[corners[i][16 + t]], s.input.x[i][t]);
          assert_int_equal(seen.y[corners[i][16 + t]], s.input.y[i][t]);
        }
      assert_int_equal(hot->surface->cover_cluster(&s.small, &shape, &seen, 16, 0xffff, &other), small);
      assert_int_equal(other.large, first.large);
      assert_same(&first, &other);
      assert_int_equal(hot->surface->cover_cluster(&s.small, &shape, &seen, 16, 0xff, &other), small & 0xff);
      assert_int_equal(other.covered[0], first.covered[0] & 0xff);
    }
    covered += (uint32_t)__builtin_popcount(first.covered[0]);
  }
  assert_true(covered > ROUNDS);
}

/* Triangles that are smaller than a pixel, for cover_columns(), cover the same samples as each by itself. */
static void test_tiny(void **state) {
  (void)state;
  uint32_t seed = 13;
  int covered = 0;
  for (int round = 0; round < ROUNDS; round++) {
    set_up s = {0};
    small_cover cover;
    open_view(&s, false);
    place_triangles(&s, &seed);
    set_small_view(&s, false);
    for (int t = 0; t < SMALL_TRIANGLES; t++) {
      int32_t x = (int32_t)random_between(&seed, -256, 4096), y = (int32_t)random_between(&seed, -256, 4096);
      for (int i = 0; i < 3; i++) {
        s.input.x[i][t] = x + (int32_t)random_between(&seed, 0, 250);
        s.input.y[i][t] = y + (int32_t)random_between(&seed, 0, 250);
        s.input.height[i][t] = 1;
      }
    }
    for (int set = HL_INSTRUCTION_SET_SCALAR; set <= HL_INSTRUCTION_SET_AVX512_VBMI; set++) {
      if (!hl_cpu_has_instruction_set((hl_instruction_set)set)) continue;
      uint32_t small =
          hl_hot_functions((hl_instruction_set)set)->surface->cover_small(&s.small, &s.input, &cover);
      for (int t = 0; t < SMALL_TRIANGLES; t++) {
        uint16_t samples[TILE_PIXELS], expected[TILE_PIXELS] = {0};
        pixel_span span = {0};
        seen_polygon polygon = {.count = 3};
        for (int i = 0; i < 3; i++) polygon.x[i] = s.input.x[i][t], polygon.y[i] = s.input.y[i][t];
        bool any = hl_cover_tile(&polygon, 0, 0, &span, expected);
        if (!(small >> t & 1)) {
          assert_false(any);
          continue;
        }
        collect_samples(&cover, t, samples);
        for (int row = 0; row < s.small.rows; row++)
          for (int column = 0; column < TILE; column++) {
            bool within = any && column >= span.x0 && column <= span.x1 && row >= span.y0 && row <= span.y1;
            uint16_t own = samples[hl_pixel_number(column, row)];
            assert_int_equal(own, within ? expected[row * TILE + column] : 0);
            covered += own != 0;
          }
      }
    }
  }
  assert_true(covered > ROUNDS);
}

/* Sixteen spheres around the view. Every fourth one is too large. */
static void place_spheres(const set_up *s, uint32_t *seed, small_spheres *spheres) {
  for (int n = 0; n < SMALL_TRIANGLES; n++) {
    vec3 start, way;
    hl_view_ray(&s->view, random_between(seed, -1, 17), random_between(seed, -1, 17), &start, &way);
    vec3 centre = vec3_add(start, vec3_scale(way, 80 + random_between(seed, -4, 4)));
    float own[3];
    vec3_store(own, centre);
    for (int axis = 0; axis < 3; axis++) spheres->centre[axis][n] = own[axis];
    spheres->radius[n] = (float)random_between(seed, n % 4 == 3 ? 2.5 : 0.05, n % 4 == 3 ? 4 : 0.8);
  }
}

/* Each covered pixel of a sphere has the bytes of a sphere that is covered by itself. */
static void check_sphere(const set_up *s, const small_cover *cover, const float sphere[4], int n,
                         int *covered) {
  uint16_t samples[TILE_PIXELS], expected[TILE_PIXELS] = {0};
  pixel_span span = {0};
  seen_bounds bounds;
  bool any = hl_see_sphere(&s->view, sphere, &bounds) &&
             hl_cover_sphere(&s->view, sphere, &bounds, 0, 0, &span, expected);
  const sphere_rays rays = hl_sphere_rays(&s->view, sphere);
  collect_samples(cover, n, samples);
  for (int row = 0; row < s->small.rows; row++)
    for (int column = 0; column < TILE; column++) {
      bool within = any && column >= span.x0 && column <= span.x1 && row >= span.y0 && row <= span.y1;
      uint16_t own = samples[hl_pixel_number(column, row)];
      assert_int_equal(own, within ? expected[row * TILE + column] : 0);
      *covered += own != 0;
    }
  for (int k = 0; k < SMALL_PIXELS; k++) {
    if (!(cover->covered[k] >> n & 1)) continue;
    surface_plane plane;
    vec3 point;
    double u, v;
    hl_fragment_middle(cover->samples[k][n], &u, &v);
    u += hl_pixel_column(cover->pixel[k][n]), v += hl_pixel_row(cover->pixel[k][n]);
    assert_true(hl_meet_sphere(&rays, u, v, false, &point));
    hl_plane_of_sphere(&s->view, &s->sheets, sphere, point, &plane);
    float height = (float)fmin(fmax(hl_plane_height(&plane, u, v), plane.lowest), plane.highest);
    double start = (double)height + (0.75 * hl_plane_slope(&plane, u, v) + LEAST_DELAY * s->sheets.spacing);
    assert_memory_equal(&cover->height[k][n], &height, sizeof height);
    assert_int_equal(cover->slab[k][n], hl_slab_of(&s->sheets, (double)height));
    assert_true(fabs((double)cover->start[k][n] - start) <= 1e-6 * (1 + fabs(start)));
    assert_int_equal(cover->first_slab[k][n], hl_slab_of(&s->sheets, start));
    assert_int_equal(cover->last_slab[k][n], hl_slab_of(&s->sheets, start));
  }
}

/* Small spheres are covered as one by one, on every instruction set. Larger ones are left to other code. */
static void test_spheres(void **state) {
  (void)state;
  uint32_t seed = 17;
  int covered = 0;
  for (int round = 0; round < ROUNDS; round++) {
    set_up s = {0};
    small_cover cover;
    small_spheres spheres;
    open_view(&s, round % 2);
    set_small_view(&s, false);
    s.small.view = &s.view;
    s.small.sheets = &s.sheets;
    place_spheres(&s, &seed, &spheres);
    for (int set = HL_INSTRUCTION_SET_SCALAR; set <= HL_INSTRUCTION_SET_AVX512_VBMI; set++) {
      if (!hl_cpu_has_instruction_set((hl_instruction_set)set)) continue;
      uint32_t small =
          hl_hot_functions((hl_instruction_set)set)->surface->cover_spheres(&s.small, &spheres, &cover);
      assert_int_equal(small & cover.large, 0);
      assert_int_equal(small | cover.large, 0xffff);
      assert_int_equal(small & 0x7777, 0x7777);
      for (int n = 0; n < SMALL_TRIANGLES; n++) {
        const float sphere[4] = {spheres.centre[0][n], spheres.centre[1][n], spheres.centre[2][n],
                                 spheres.radius[n]};
        if (small >> n & 1) check_sphere(&s, &cover, sphere, n, &covered);
      }
    }
  }
  assert_true(covered > ROUNDS);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_against_one_by_one),
                                     cmocka_unit_test(test_not_small),
                                     cmocka_unit_test(test_instruction_sets),
                                     cmocka_unit_test(test_cluster),
                                     cmocka_unit_test(test_tiny),
                                     cmocka_unit_test(test_spheres)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
