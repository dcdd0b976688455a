/* analytic/label_shapes.c - labels in the shape of balls and boxes, in many orientations: the smooth surface
 * lies where the shape's surface does, and encloses the same volume. */
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "core/vector.h"
#include "label/occupancy.h"
#include "reference_stage.h"

enum { N = 48, ORIENTATIONS = 50 };

static hl_context *context;
static hl_pool *pool;

static int open_context(void **state) {
  (void)state;
  return hl_context_create(NULL, &context, NULL) == HL_OK && hl_pool_create(context, 0, &pool, NULL) == HL_OK
             ? 0
             : -1;
}

static int close_context(void **state) {
  (void)state;
  hl_pool_destroy(pool);
  hl_context_destroy(context);
  return 0;
}

/* Returns how far inside the shape a point lies; below 0: the point lies outside. */
typedef double depth_function(const void *shape, vec3 p);

typedef struct ball {
  vec3 centre;
  double radius;
} ball;

static double depth_in_ball(const void *shape, vec3 p) {
  const ball *b = shape;
  return b->radius - vec3_length(vec3_subtract(p, b->centre));
}

typedef struct box {
  vec3 centre, axis[3];
  double half[3];
} box;

static double depth_in_box(const void *shape, vec3 p) {
  const box *b = shape;
  double depth = INFINITY;
  for (int a = 0; a < 3; a++)
    depth = fmin(depth, b->half[a] - fabs(vec3_dot(vec3_subtract(p, b->centre), b->axis[a])));
  return depth;
}

/* Makes a label map in which the shape has label 7 and the rest has label 3, and the occupancy field of
 * label 7. */
static hl_volume *occupancy_of(depth_function *depth, const void *shape, double *label_count) {
  static unsigned char voxels[N * N * N];
  hl_volume_description d;
  hl_volume_description_defaults(&d);
  *label_count = 0;
  for (int k = 0; k < N; k++)
    for (int j = 0; j < N; j++)
      for (int i = 0; i < N; i++) {
        bool is = depth(shape, (vec3){i, j, k}) > 0;
        voxels[(k * N + j) * N + i] = is ? 7 : i < 3 ? 3 : 0;
        *label_count += is;
      }
  d.dimensions[0] = d.dimensions[1] = d.dimensions[2] = N;
  d.type = HL_VOXEL_U8;
  d.voxels = voxels;
  hl_volume *map = NULL, *made = NULL;
  assert_int_equal(hl_volume_create(context, &d, &map, NULL), HL_OK);
  const int64_t labels[] = {3, 7};
  hl_label_part parts[2];
  assert_int_equal(hl_label_parts(context, pool, map, labels, 2, parts, NULL), HL_OK);
  hl_label_work work = {.context = context, .whole = (double)hl_label_part_voxels(&parts[1])};
  assert_int_equal(hl_label_occupancy(context, pool, map, &labels[1], 1, &parts[1], &work, &made, NULL),
                   HL_OK);
  assert_true(work.done == HL_LABEL_STEPS * work.whole);
  assert_non_null(made);
  hl_volume_release(map);
  return made;
}

static double spline(double t) { /* the cubic B-spline */
  t = fabs(t);
  if (t >= 2) return 0;
  return t < 1 ? 2.0 / 3 + t * t * (t / 2 - 1) : (2 - t) * (2 - t) * (2 - t) / 6;
}

/* Returns the occupancy field's value at a point of the label map. */
static double field_at(const hl_volume *field, vec3 p) {
  const vec3 origin = field->index_to_world.offset;
  const double at[3] = {p.x - origin.x, p.y - origin.y, p.z - origin.z};
  int64_t base[3];
  for (int a = 0; a < 3; a++) base[a] = (int64_t)floor(at[a]) - 1;
  double sum = 0;
  for (int n = 0; n < 64; n++) {
    size_t index[3];
    double weight = 1;
    for (int a = 0; a < 3; a++) {
      int64_t i = base[a] + (n >> 2 * a & 3), last = (int64_t)field->dimension[a] - 1;
      weight *= spline(at[a] - (double)i);
      index[a] = (size_t)(i < 0 ? 0 : i > last ? last : i);
    }
    sum += weight * hl_volume_value(field, index[0], index[1], index[2]);
  }
  return sum;
}

/* Returns the distance from a point of the shape's surface, outwards along its normal, to the place where the
 * field passes 1/2. */
static double surface_offset(const hl_volume *field, vec3 point, vec3 normal) {
  double low = -2, high = 2;
  for (int step = 0; step < 24; step++) {
    double middle = (low + high) / 2;
    if (field_at(field, vec3_add(point, vec3_scale(normal, middle))) > 0.5) low = middle;
    else high = middle;
  }
  return (low + high) / 2;
}

typedef struct offsets {
  double sum, squares, greatest;
  int count;
} offsets;

static void add_offset(offsets *all, double offset) {
  all->sum += offset;
  all->squares += offset * offset;
  all->greatest = fmax(all->greatest, fabs(offset));
  all->count++;
}

static vec3 random_centre(uint32_t *seed) {
  return (vec3){N / 2 + stage_random(seed), N / 2 + stage_random(seed), N / 2 + stage_random(seed)};
}

/* Returns the volume that a star-shaped surface encloses, computed from the surface's distance in many
 * directions. */
static double volume_around(const hl_volume *field, vec3 centre, depth_function *depth, const void *shape) {
  enum { DIRECTIONS = 3000 };
  double sum = 0;
  for (int n = 0; n < DIRECTIONS; n++) {
    double z = 1 - (2 * n + 1) / (double)DIRECTIONS, turn = n * 2.399963229728653, r = sqrt(1 - z * z);
    vec3 way = {r * cos(turn), r * sin(turn), z};
    double low = 0, high = N / 2 - 2;
    for (int step = 0; step < 30; step++) { /* the volume that the shape itself encloses */
      double middle = (low + high) / 2;
      if (depth(shape, vec3_add(centre, vec3_scale(way, middle))) > 0) low = middle;
      else high = middle;
    }
    double extent = low + surface_offset(field, vec3_add(centre, vec3_scale(way, low)), way);
    sum += extent * extent * extent;
  }
  return 4 * HL_PI / 3 * sum / DIRECTIONS;
}

static void test_balls(void **state) {
  (void)state;
  static const double radii[] = {4, 7, 11, 16};
  uint32_t seed = 1;
  for (int k = 0; k < 12; k++) {
    double count;
    ball b = {random_centre(&seed), radii[k % 4]};
    hl_volume *field = occupancy_of(depth_in_ball, &b, &count);
    offsets all = {0};
    for (int n = 0; n < 400; n++) {
      vec3 way = stage_random_direction(&seed);
      add_offset(&all, surface_offset(field, vec3_add(b.centre, vec3_scale(way, b.radius)), way));
    }
    double volume = volume_around(field, b.centre, depth_in_ball, &b);
    assert_true(fabs(volume / count - 1) < 0.01);
    assert_true(sqrt(all.squares / all.count) < 0.12);
    hl_volume_release(field);
  }
}

static void test_boxes(void **state) {
  (void)state;
  uint32_t seed = 5;
  offsets every = {0};
  for (int k = 0; k < ORIENTATIONS; k++) {
    double count;
    box b = {random_centre(&seed), {stage_random_direction(&seed)}, {13, 10, 8}};
    b.axis[1] = vec3_normalise(vec3_cross(b.axis[0], stage_random_direction(&seed)));
    b.axis[2] = vec3_cross(b.axis[0], b.axis[1]);
    hl_volume *field = occupancy_of(depth_in_box, &b, &count);
    for (int n = 0; n < 300; n++) { /* these points lie on the faces, at least 3 voxels from the edges */
      int a = n % 3, u = (a + 1) % 3, v = (a + 2) % 3;
      double side = n % 2 ? 1 : -1, on_u = (2 * stage_random(&seed) - 1) * (b.half[u] - 4),
             on_v = (2 * stage_random(&seed) - 1) * (b.half[v] - 4);
      vec3 normal = vec3_scale(b.axis[a], side);
      vec3 point = vec3_add(b.centre,
                            vec3_add(vec3_scale(normal, b.half[a]),
                                     vec3_add(vec3_scale(b.axis[u], on_u), vec3_scale(b.axis[v], on_v))));
      add_offset(&every, surface_offset(field, point, normal));
    }
    double volume = volume_around(field, b.centre, depth_in_box, &b);
    assert_true(fabs(volume / count - 1) < 0.005);
    hl_volume_release(field);
  }
  /* Faces move outwards evenly, which makes up for the volume that rounded edges lose. The steps of voxels,
   * 0.29 voxels high, do not show. */
  double mean = every.sum / every.count;
  assert_true(fabs(mean) < 0.25);
  assert_true(sqrt(every.squares / every.count - mean * mean) < 0.09);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_balls), cmocka_unit_test(test_boxes)};
  return cmocka_run_group_tests(tests, open_context, close_context);
}
