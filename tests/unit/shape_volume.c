/* tests/unit/shape_volume.c - shapes, as distances and as voxels, against closed forms. */
#include <math.h>
#include <stdlib.h>

#include "core/memory.h"
#include "scene_parts.h"
#include "shape/shape.h"

static hl_volume *make(hl_context *context, const char *text, int size, int threads) {
  hl_shapes_options options;
  hl_shapes_options_defaults(&options);
  options.size = size;
  options.threads = threads;
  hl_volume *volume = NULL;
  hl_error error = {0};
  if (hl_volume_from_shapes(context, text, strlen(text), "S", &options, &volume, &error) != HL_OK)
    fail_msg("%s", error.message);
  return volume;
}

/* The weights of the cubic B-spline for the taps at -1 to 2, and their derivatives, at t in [0, 1). */
static void bspline(double t, double weight[4], double slope[4]) {
  double s = 1 - t;
  const double w[4] = {s * s * s / 6, (4 - 6 * t * t + 3 * t * t * t) / 6,
                       (4 - 6 * s * s + 3 * s * s * s) / 6, t * t * t / 6};
  const double d[4] = {-s * s / 2, (-12 * t + 9 * t * t) / 6, (12 * s - 9 * s * s) / 6, t * t / 2};
  memcpy(weight, w, sizeof w);
  memcpy(slope, d, sizeof d);
}

/* The reconstructed value and its gradient at a point in index space. */
static double reconstruct(const hl_volume *volume, const double p[3], double gradient[3]) {
  double weight[3][4], slope[3][4], value = 0;
  long base[3];
  for (int a = 0; a < 3; a++) {
    base[a] = (long)floor(p[a]);
    bspline(p[a] - (double)base[a], weight[a], slope[a]);
    gradient[a] = 0;
  }
  for (int k = 0; k < 4; k++)
    for (int j = 0; j < 4; j++)
      for (int i = 0; i < 4; i++) {
        double v = hl_volume_value(volume, (size_t)(base[0] - 1 + i), (size_t)(base[1] - 1 + j),
                                   (size_t)(base[2] - 1 + k));
        value += v * weight[0][i] * weight[1][j] * weight[2][k];
        gradient[0] += v * slope[0][i] * weight[1][j] * weight[2][k];
        gradient[1] += v * weight[0][i] * slope[1][j] * weight[2][k];
        gradient[2] += v * weight[0][i] * weight[1][j] * slope[2][k];
      }
  return value;
}

/* A point of the volume's frame in index space. */
static void to_index(const hl_volume *volume, vec3 p, double index[3]) {
  affine3 inverse = affine3_identity();
  assert_true(affine3_invert(volume->index_to_world, &inverse));
  vec3 q = affine3_apply(inverse, p);
  index[0] = q.x, index[1] = q.y, index[2] = q.z;
}

static double angle_deg(vec3 a, vec3 b) {
  double sine = vec3_length(vec3_cross(vec3_normalise(a), vec3_normalise(b)));
  return atan2(sine, vec3_dot(a, b)) * 180 / HL_PI;
}

/* The place of the surface and its normal, in voxels and degrees, near a point with a known normal. */
static void check_surface(const hl_volume *volume, vec3 point, vec3 normal, double voxels, double degrees) {
  double index[3], gradient[3];
  to_index(volume, point, index);
  double value = reconstruct(volume, index, gradient);
  vec3 down = {-gradient[0], -gradient[1], -gradient[2]};
  double off = (value - 0.5) / vec3_length(down);
  if (fabs(off) > voxels) fail_msg("the surface is %g voxels off", off);
  double turned = angle_deg(down, normal);
  if (turned > degrees) fail_msg("the normal is turned by %g degrees", turned);
}

static double random_number(uint32_t *state) {
  *state = *state * 1664525u + 1013904223u;
  return (double)(*state >> 8) / (1 << 24);
}

static vec3 random_direction(uint32_t *state) {
  vec3 v;
  do v = (vec3){2 * random_number(state) - 1, 2 * random_number(state) - 1, 2 * random_number(state) - 1};
  while (vec3_length(v) > 1 || vec3_length(v) < 0.1);
  return vec3_normalise(v);
}

static void a_sphere_faces_outwards(void **state) {
  (void)state;
  hl_context *context = make_context();
  hl_volume *volume = make(context,
                           "{\"shapes\": [{\"type\": \"sphere\", \"radius\": 20, \"position\": [0.3, -0.2, "
                           "0.7]}], \"voxel_size\": 1}",
                           0, 1);
  uint32_t seed = 1;
  for (int n = 0; n < 2000; n++) {
    vec3 normal = random_direction(&seed), centre = {0.3, -0.2, 0.7};
    /* the kernel's variance of 1/3 for each axis moves a curved surface by its mean curvature: (1/3) / R =
     * 0.017 */
    check_surface(volume, vec3_add(centre, vec3_scale(normal, 20)), normal, 0.02, 0.05);
  }
  hl_volume_release(volume);
  hl_context_destroy(context);
}

static void a_tilted_box_is_flat(void **state) {
  (void)state;
  hl_context *context = make_context();
  hl_volume *volume = make(context,
                           "{\"shapes\": [{\"type\": \"box\", \"size\": [15, 20, 12],"
                           " \"rotate\": {\"axis\": [1, 2, 3], \"angle_deg\": 33}}], \"voxel_size\": 0.5}",
                           0, 2);
  mat3 turn = mat3_rotation(vec3_normalise((vec3){1, 2, 3}), 33 * HL_PI / 180);
  uint32_t seed = 2;
  for (int n = 0; n < 2000; n++) {
    /* a point of the face z = 6, farther from its edges than two voxels and the kernel's reach */
    vec3 local = {9 * (random_number(&seed) - 0.5), 14 * (random_number(&seed) - 0.5), 6}, up = {0, 0, 1};
    /* the outermost taps lie beyond the two voxels in which the density is linear */
    check_surface(volume, mat3_apply(turn, local), mat3_apply(turn, up), 0.001, 0.02);
  }
  hl_volume_release(volume);
  hl_context_destroy(context);
}

static void the_grid_is_empty_at_its_faces(void **state) {
  (void)state;
  hl_context *context = make_context();
  for (size_t p = 0; hl_shape_preset_name(p) != NULL; p++) {
    const char *name = hl_shape_preset_name(p);
    assert_non_null(hl_shape_preset_summary(p));
    hl_volume *volume = make(context, hl_shape_preset_text(name), 64, 2);
    const size_t *n = volume->dimension;
    size_t longest = n[0] > n[1] ? n[0] : n[1];
    longest = n[2] > longest ? n[2] : longest;
    if (longest < 62 || longest > 64) fail_msg("%s: %zu voxels along the longest side", name, longest);
    for (size_t k = 0; k < n[2]; k++)
      for (size_t j = 0; j < n[1]; j++)
        for (size_t i = 0; i < n[0]; i++)
          if (i == 0 || j == 0 || k == 0 || i + 1 == n[0] || j + 1 == n[1] || k + 1 == n[2])
            if (hl_volume_value(volume, i, j, k) != 0) fail_msg("%s: a face is not empty", name);
    assert_true(volume->maximum > 0.9 && volume->maximum <= 1);
    hl_volume_release(volume);
  }
  assert_null(hl_shape_preset_text("no such preset"));
  hl_context_destroy(context);
}

/* FNV-1a of the voxels. */
static uint64_t fingerprint(const hl_volume *volume) {
  const unsigned char *bytes = volume->voxels;
  uint64_t hash = 0xcbf29ce484222325u;
  for (size_t n = 0; n < hl_volume_voxel_count(volume) * hl_storage_bytes(volume->storage); n++)
    hash = (hash ^ bytes[n]) * 0x100000001b3u;
  return hash;
}

static void threads_do_not_matter(void **state) {
  (void)state;
  hl_context *context = make_context();
  for (size_t p = 0; hl_shape_preset_name(p) != NULL; p++) {
    uint64_t first = 0;
    const int threads[] = {1, 2, 7};
    for (int t = 0; t < 3; t++) {
      hl_volume *volume = make(context, hl_shape_preset_text(hl_shape_preset_name(p)), 40, threads[t]);
      if (t == 0) first = fingerprint(volume);
      else assert_int_equal(fingerprint(volume), first);
      hl_volume_release(volume);
    }
  }
  assert_int_equal(hl_context_memory_held(context), 0);
  hl_context_destroy(context);
}

/* The bytes of a hypertexture with all its features are the same on every machine, with every compiler and at
 * any time. */
static void a_seed_gives_the_same_bytes(void **state) {
  (void)state;
  static const char text[] =
      "{\"shapes\": [{\"type\": \"group\", \"scale\": 1.3, \"rotate\": {\"axis\": [1, 2, 3], \"angle_deg\": "
      "40},"
      " \"shapes\": [{\"type\": \"sphere\", \"radius\": 8}, {\"type\": \"torus\", \"radius\": 9, "
      "\"tube_radius\": 2}],"
      " \"hypertexture\": {\"frequency\": 0.31, \"octaves\": 5, \"bias\": 0.4, \"gain\": 0.7, \"amplitude\": "
      "4,"
      " \"soft\": 3, \"seed\": 7}}], \"voxel_size\": 1}";
  hl_context *context = make_context();
  hl_volume *volume = make(context, text, 0, 2);
  assert_int_equal(fingerprint(volume), UINT64_C(0x7a1f4e57e622a0ee));
  hl_volume_release(volume);
  hl_shapes_options options;
  hl_shapes_options_defaults(&options);
  options.seed = 1;
  assert_int_equal(hl_volume_from_shapes(context, text, strlen(text), "S", &options, &volume, NULL), HL_OK);
  assert_int_not_equal(fingerprint(volume), UINT64_C(0x7a1f4e57e622a0ee));
  hl_volume_release(volume);
  hl_context_destroy(context);
}

/* hydrogen's 2p (m = 0) is z e^(-r / 2a), its 1s e^(-r / a); a = radius / (n (2 n + 4)) */
static void orbitals_are_hydrogens(void **state) {
  (void)state;
  hl_context *context = make_context();
  hl_volume *p = make(context,
                      "{\"shapes\": [{\"type\": \"orbital\", \"n\": 2, \"l\": 1, \"m\": 0, \"radius\": 32}], "
                      "\"voxel_size\": 1}",
                      0, 1);
  hl_volume *s = make(context,
                      "{\"shapes\": [{\"type\": \"orbital\", \"n\": 1, \"l\": 0, \"m\": 0, \"radius\": 24}], "
                      "\"voxel_size\": 1}",
                      0, 1);
  double a = 2, scale = 4 * exp(-1); /* for whole numbers z, |z| e^(-|z| / 4) is greatest at 4 */
  uint32_t seed = 3;
  for (int n = 0; n < 500; n++) {
    double index[3];
    vec3 at = {floor(40 * random_number(&seed)) - 20, floor(40 * random_number(&seed)) - 20,
               floor(40 * random_number(&seed)) - 20};
    double r = vec3_length(at);
    if (r >= 24) continue;
    to_index(p, at, index);
    double value = hl_volume_value(p, (size_t)lround(index[0]), (size_t)lround(index[1]),
                                   (size_t)lround(index[2]));
    assert_float_equal(value, at.z * exp(-r / (2 * a)) / scale, 1e-6);
    to_index(s, at, index);
    value = hl_volume_value(s, (size_t)lround(index[0]), (size_t)lround(index[1]), (size_t)lround(index[2]));
    assert_float_equal(value, exp(-r / 4), 1e-6);
  }
  assert_float_equal(p->minimum, -1, 1e-7);
  assert_float_equal(p->maximum, 1, 1e-7);
  hl_volume_release(p);
  hl_volume_release(s);
  hl_context_destroy(context);
}

/* Wave functions of different quantum numbers are orthogonal: the sum of their product over the grid
 * vanishes. */
static void orbitals_are_orthogonal(void **state) {
  (void)state;
  hl_context *context = make_context();
  static const int numbers[][3] = {{3, 2, 0}, {3, 2, 1}, {3, 2, -2}, {3, 1, 0},
                                   {3, 0, 0}, {4, 2, 0}, {4, 3, -3}};
  enum { COUNT = sizeof numbers / sizeof *numbers };
  hl_shape shape[COUNT];
  double product[COUNT][COUNT] = {{0}};
  for (int o = 0; o < COUNT; o++) { /* one Bohr radius for all wave functions */
    hl_shape_defaults(&shape[o]);
    memcpy(shape[o].quantum, numbers[o], sizeof numbers[o]);
    shape[o].radius = numbers[o][0] * (2 * numbers[o][0] + 4);
  }
  for (int k = -48; k <= 48; k += 2)
    for (int j = -48; j <= 48; j += 2)
      for (int i = -48; i <= 48; i += 2) {
        double value[COUNT];
        for (int o = 0; o < COUNT; o++) value[o] = hl_orbital_at(&shape[o], (vec3){i, j, k});
        for (int a = 0; a < COUNT; a++)
          for (int b = 0; b < COUNT; b++) product[a][b] += value[a] * value[b];
      }
  for (int a = 0; a < COUNT; a++)
    for (int b = 0; b < a; b++)
      if (fabs(product[a][b]) > 0.02 * sqrt(product[a][a] * product[b][b]))
        fail_msg("%d and %d: %g", a, b, product[a][b] / sqrt(product[a][a] * product[b][b]));
  hl_context_destroy(context);
}

static void noise_is_perlins(void **state) {
  (void)state;
  hl_noise noise, other;
  hl_noise_begin(&noise, 0);
  hl_noise_begin(&other, 1);
  uint32_t seed = 5;
  double least = 0, greatest = 0, difference = 0;
  for (int n = 0; n < 20000; n++) {
    vec3 whole = {floor(600 * random_number(&seed)) - 300, floor(600 * random_number(&seed)) - 300,
                  floor(600 * random_number(&seed)) - 300};
    assert_true(hl_noise_at(&noise, whole) == 0);
    vec3 p = vec3_add(whole, vec3_scale(random_direction(&seed), random_number(&seed)));
    double value = hl_noise_at(&noise, p);
    least = fmin(least, value), greatest = fmax(greatest, value);
    assert_float_equal(hl_noise_at(&noise, vec3_add(p, (vec3){256, -256, 512})), value, 1e-9);
    difference = fmax(difference, fabs(value - hl_noise_at(&other, p)));
    /* on the lattice, the slope is the gradient; towards an edge of a cube, two components are 1 and one is 0
     */
    double h = 1e-4, sum = 0;
    for (int a = 0; a < 3; a++) {
      vec3 step = {a == 0 ? h : 0, a == 1 ? h : 0, a == 2 ? h : 0};
      double slope = (hl_noise_at(&noise, vec3_add(whole, step)) -
                      hl_noise_at(&noise, vec3_subtract(whole, step))) /
                     (2 * h);
      assert_float_equal(fabs(slope), round(fabs(slope)), 1e-6);
      sum += fabs(slope);
    }
    assert_float_equal(sum, 2, 1e-6);
  }
  assert_true(least < -0.7 && least > -1.1 && greatest > 0.7 && greatest < 1.1 && difference > 0.5);
  vec3 p = {0.3, 1.7, -2.2};
  double sum = fabs(hl_noise_at(&noise, p)) + fabs(hl_noise_at(&noise, vec3_scale(p, 2))) / 2 +
               fabs(hl_noise_at(&noise, vec3_scale(p, 4))) / 4;
  assert_float_equal(hl_turbulence(&noise, p, 3), sum, 1e-12);
}

static void bias_and_gain_are_perlins(void **state) {
  (void)state;
  for (double b = 0.05; b < 1; b += 0.05) {
    assert_float_equal(hl_bias(b, 0.5), b, 1e-12);
    assert_float_equal(hl_gain(b, 0.5), 0.5, 1e-12);
    assert_float_equal(hl_gain(b, 0.25), (1 - b) / 2, 1e-12);
    assert_float_equal(hl_gain(b, 0.75), (1 + b) / 2, 1e-12);
    for (double t = 0; t <= 1; t += 0.125)
      assert_float_equal(hl_bias(b, t), t == 0 ? 0 : pow(t, log(b) / log(0.5)), 1e-12);
  }
}

/* Blocks and shapes that are skipped must not change a voxel. Each voxel is computed anew from all shapes. */
static void bounds_hold(void **state) {
  (void)state;
  hl_shape shapes[6];
  for (int n = 0; n < 6; n++) {
    hl_shape_defaults(&shapes[n]);
    shapes[n].end = (size_t)n + 1;
  }
  shapes[0].type = HL_SHAPE_GROUP, shapes[0].end = 3, shapes[0].scale = 1.5, shapes[0].rotate_angle_deg = 20;
  shapes[0].texture = (hl_hypertexture){.pattern = HL_PATTERN_TURBULENCE,
                                        .frequency = 0.4,
                                        .octaves = 3,
                                        .bias = 0.4,
                                        .gain = 0.6,
                                        .amplitude = 3,
                                        .soft = 2};
  shapes[1].type = HL_SHAPE_SPHERE, shapes[1].radius = 6;
  shapes[2].type = HL_SHAPE_CONE, shapes[2].radius = 5, shapes[2].end_radius = 1, shapes[2].to[2] = 12,
  shapes[2].blend = 3;
  shapes[3].type = HL_SHAPE_BOX, shapes[3].operation = HL_SHAPE_SUBTRACT, shapes[3].size[0] = 30,
  shapes[3].blend = 2;
  shapes[3].size[1] = 4, shapes[3].size[2] = 4;
  shapes[4].type = HL_SHAPE_TORUS, shapes[4].radius = 14, shapes[4].tube_radius = 2;
  shapes[5].type = HL_SHAPE_SPHERE, shapes[5].radius = 15, shapes[5].operation = HL_SHAPE_INTERSECT;
  hl_shape_list list = {shapes, 6, 6};
  hl_shapes_place(&list, 1);
  uint32_t seed = 6;
  int dead = 0;
  for (int n = 0; n < 20000; n++) {
    vec3 centre = vec3_scale(random_direction(&seed), 20 * random_number(&seed));
    double radius = 4 * random_number(&seed);
    unsigned char live[6];
    hl_interval bounds = hl_shapes_bounds(&list, centre, radius, live);
    vec3 p = vec3_add(centre, vec3_scale(random_direction(&seed), radius * random_number(&seed)));
    double with = hl_shapes_distance(&list, live, p), all = hl_shapes_distance(&list, NULL, p);
    assert_true(with == all);
    assert_true(all >= bounds.low - 1e-9 && all <= bounds.high + 1e-9);
    for (int s = 0; s < 6; s++) dead += !live[s];
  }
  assert_true(dead > 10000); /* the blocks leave out some shapes */
}

/* Distances that are easy to see. */
static void distances_are_euclidean(void **state) {
  (void)state;
  hl_shape s;
  hl_shape_list list = {&s, 1, 1};
  hl_shape_defaults(&s);
  s.end = 1;
  s.type = HL_SHAPE_BOX, s.size[0] = 2, s.size[1] = 4, s.size[2] = 6;
  hl_shapes_place(&list, 1);
  assert_float_equal(hl_shapes_distance(&list, NULL, (vec3){4, 6, 3}), 5, 1e-12);
  assert_float_equal(hl_shapes_distance(&list, NULL, (vec3){0.5, 0, 0}), -0.5, 1e-12);
  s.rounding = 1;
  assert_float_equal(hl_shapes_distance(&list, NULL, (vec3){3, 5, 6}), sqrt(9 + 16 + 16) - 1, 1e-12);
  s.rounding = 0;
  s.type = HL_SHAPE_PLANE, s.size[0] = s.size[1] = 10, s.size[2] = 2;
  assert_float_equal(hl_shapes_distance(&list, NULL, (vec3){1, 1, 3}), 3, 1e-12);
  assert_float_equal(hl_shapes_distance(&list, NULL, (vec3){1, 1, -3}), 1, 1e-12);
  s.from[2] = -3, s.to[2] = 3, s.radius = 2, s.end_radius = 2;
  const hl_shape_type round[] = {HL_SHAPE_CYLINDER,
                                 HL_SHAPE_CONE}; /* a cone with two equal ends is a cylinder */
  for (int n = 0; n < 2; n++) {
    s.type = round[n];
    assert_float_equal(hl_shapes_distance(&list, NULL, (vec3){3, 4, 0}), 3, 1e-12);
    assert_float_equal(hl_shapes_distance(&list, NULL, (vec3){5, 0, 7}), 5, 1e-12);
    assert_float_equal(hl_shapes_distance(&list, NULL, (vec3){0, 1, 0}), -1, 1e-12);
    assert_float_equal(hl_shapes_distance(&list, NULL, (vec3){0, 0.5, -2.5}), -0.5, 1e-12);
  }
  s.type = HL_SHAPE_CAPSULE;
  assert_float_equal(hl_shapes_distance(&list, NULL, (vec3){3, 0, 7}), 3, 1e-12);
  s.type = HL_SHAPE_CONE, s.radius = 3, s.end_radius = 0, s.from[2] = 0, s.to[2] = 4; /* sides 3, 4, 5 */
  assert_float_equal(hl_shapes_distance(&list, NULL, (vec3){0, 0, 9}), 5, 1e-12);
  assert_float_equal(hl_shapes_distance(&list, NULL, (vec3){1.5 + 4, 0, 2 + 3}), 5, 1e-12);
  assert_float_equal(hl_shapes_distance(&list, NULL, (vec3){1.5 - 0.4, 0, 2 - 0.3}), -0.5, 1e-12);
  s.type = HL_SHAPE_TORUS, s.radius = 5, s.tube_radius = 1;
  assert_float_equal(hl_shapes_distance(&list, NULL, (vec3){0, 8, 4}), 4, 1e-12);
  s.scale = 2, s.position[0] = 1;
  hl_shapes_place(&list, 1);
  assert_float_equal(hl_shapes_distance(&list, NULL, (vec3){1, 16, 8}), 8, 1e-12);
}

static void limits_and_cancelling_are_kept(void **state) {
  (void)state;
  hl_context_options context_options;
  hl_context_options_defaults(&context_options);
  context_options.memory_limit = 1 << 20;
  hl_context *context = NULL;
  assert_int_equal(hl_context_create(&context_options, &context, NULL), HL_OK);
  static const char text[] = "{\"shapes\": [{\"type\": \"sphere\", \"radius\": 100}], \"voxel_size\": 1}";
  hl_volume *volume = NULL;
  hl_error error = {0};
  assert_int_equal(hl_volume_from_shapes(context, text, strlen(text), "S", NULL, &volume, &error),
                   HL_ERROR_MEMORY);
  assert_null(volume);
  assert_int_equal(hl_context_memory_held(context), 0);
  hl_shapes_options options;
  hl_shapes_options_defaults(&options);
  options.size = 15;
  assert_int_equal(hl_volume_from_shapes(context, text, strlen(text), "S", &options, &volume, &error),
                   HL_ERROR_ARGUMENT);
  options.struct_size = 1;
  assert_int_equal(hl_volume_from_shapes(context, text, strlen(text), "S", &options, &volume, &error),
                   HL_ERROR_ARGUMENT);
  assert_int_equal(hl_volume_from_shapes(context, "{}", 2, "S", NULL, &volume, &error), HL_ERROR_INPUT);
  assert_string_equal(error.message, "S: /shapes: is missing: give a list of shapes");
  hl_context_destroy(context);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(distances_are_euclidean),        cmocka_unit_test(bounds_hold),
      cmocka_unit_test(a_sphere_faces_outwards),        cmocka_unit_test(a_tilted_box_is_flat),
      cmocka_unit_test(the_grid_is_empty_at_its_faces), cmocka_unit_test(threads_do_not_matter),
      cmocka_unit_test(a_seed_gives_the_same_bytes),    cmocka_unit_test(orbitals_are_hydrogens),
      cmocka_unit_test(orbitals_are_orthogonal),        cmocka_unit_test(noise_is_perlins),
      cmocka_unit_test(bias_and_gain_are_perlins),      cmocka_unit_test(limits_and_cancelling_are_kept),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
