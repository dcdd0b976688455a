/* analytic/reference_field.c - how the reference reconstructs a field: kernels, gradients, empty bricks. */
#include <stdlib.h>

#include "../asserts.h"
#include "core/memory.h"
#include "reference/reference.h"
#include "reference_stage.h"

static const size_t SIZE[3] = {23, 18, 14};
static const double SPACING[3] = {1, 1.25, 2};

/* A scene of one volume, prepared for the reference's functions. */
typedef struct field {
  stage set;
  reference all;
  hl_pool *pool;
  reference_volume volume;
} field;

static void field_open(field *made, const float *voxels) {
  hl_error error;
  stage_open(&made->set);
  hl_scene_volume *described = stage_add_grid(&made->set, SIZE, SPACING, (vec3){-3, 7, 1}, voxels);
  described->rotate_axis[0] = 1;
  described->rotate_axis[1] = -2;
  described->rotate_angle_deg = 40;
  described->scale = 1.5;
  made->all = (reference){.context = made->set.context, .scene = &made->set.scene};
  assert_int_equal(hl_pool_create(made->set.context, 1, &made->pool, &error), HL_OK);
  made->volume = (reference_volume){0};
}

static void field_make(field *made, hl_kernel kernel) {
  hl_error error;
  hl_reference_volume_release(made->set.context, &made->volume);
  made->set.scene.render.kernel = kernel;
  assert_int_equal(
      hl_reference_volume_create(&made->all, &made->set.volumes[0], made->pool, &made->volume, &error),
      HL_OK);
}

static void field_close(field *made) {
  hl_reference_volume_release(made->set.context, &made->volume);
  hl_pool_destroy(made->pool);
  stage_close(&made->set);
}

/* Returns point n of a fixed sequence that fills the index-space box, including its faces. */
static vec3 probe(int n) {
  double t[3] = {fmod(n * 0.7548776662, 1), fmod(n * 0.5698402910, 1), fmod(n * 0.8191725134, 1)};
  for (int a = 0; a < 3; a++) t[a] = fmin(fmax(t[a] * 1.1 - 0.05, 0), 1) * (double)SIZE[a] - 0.5;
  return (vec3){t[0], t[1], t[2]};
}

static float *make_voxels(float (*value)(double, double, double)) {
  float *voxels = malloc(SIZE[0] * SIZE[1] * SIZE[2] * sizeof *voxels), *out = voxels;
  assert_non_null(voxels);
  for (size_t k = 0; k < SIZE[2]; k++)
    for (size_t j = 0; j < SIZE[1]; j++)
      for (size_t i = 0; i < SIZE[0]; i++) *out++ = value((double)i, (double)j, (double)k);
  return voxels;
}

static float ramp(double i, double j, double k) { return (float)(5 + 2 * i - 3 * j + 0.5 * k); }
static float rough(double i, double j, double k) { return stage_noise(i, j, k); }
static float constant(double i, double j, double k) { return i + j + k < -1 ? 0 : 7.5f; }
/* Returns a voxel of a field that is 0 except for a few small blobs. */
static float sparse(double i, double j, double k) {
  double a = hypot(hypot(i - 4, j - 5), k - 3), b = hypot(hypot(i - 22, j - 17), k - 13);
  return (float)fmax(fmax(2.2 - a, 1.2 - b), 0);
}

/* The interpolating kernel passes through the voxels' values, also at the grid's faces. */
static void test_interpolating_keeps_values(void **state) {
  (void)state;
  field f;
  float *voxels = make_voxels(rough);
  field_open(&f, voxels);
  field_make(&f, HL_KERNEL_INTERPOLATING);
  const float *voxel = voxels;
  for (size_t z = 0; z < SIZE[2]; z++)
    for (size_t y = 0; y < SIZE[1]; y++)
      for (size_t x = 0; x < SIZE[0]; x++)
        assert_near(hl_reference_value(&f.volume, (vec3){(double)x, (double)y, (double)z}), *voxel++, 1e-12);
  field_close(&f);
  free(voxels);
}

static void test_constant_stays_constant(void **state) {
  (void)state;
  field f;
  float *voxels = make_voxels(constant);
  field_open(&f, voxels);
  for (int kernel = HL_KERNEL_BSPLINE; kernel <= HL_KERNEL_LINEAR; kernel++) {
    field_make(&f, (hl_kernel)kernel);
    for (int n = 0; n < 200; n++) {
      assert_near(hl_reference_value(&f.volume, probe(n)), 7.5, 1e-13);
      assert_near(vec3_length(hl_reference_gradient(&f.volume, probe(n))), 0, 1e-13);
    }
  }
  field_close(&f);
  free(voxels);
}

/* B-spline and linear kernel reproduce linear functions. The gradient is (dindex/dworld)^T (2, -3, 0.5). */
static void test_ramp_is_exact(void **state) {
  (void)state;
  field f;
  float *voxels = make_voxels(ramp);
  field_open(&f, voxels);
  affine3 to_world = hl_scene_volume_index_to_world(&f.set.volumes[0]);
  const hl_kernel kernels[] = {HL_KERNEL_BSPLINE, HL_KERNEL_LINEAR};
  for (int kernel = 0; kernel < 2; kernel++) {
    field_make(&f, kernels[kernel]);
    for (int n = 0; n < 200; n++) {
      vec3 p = probe(n);
      bool inside = p.x > 1 && p.y > 1 && p.z > 1 && p.x < 21 && p.y < 16 &&
                    p.z < 12; /* this point is not near a face of the grid */
      if (!inside) continue;
      assert_near(hl_reference_value(&f.volume, p), 5 + 2 * p.x - 3 * p.y + 0.5 * p.z, 1e-12);
      vec3 gradient = hl_reference_gradient(&f.volume, p);
      /* one step along an index axis changes the value by the function's slope along this axis */
      assert_near(vec3_dot(gradient, mat3_column(to_world.linear, 0)), 2, 1e-12);
      assert_near(vec3_dot(gradient, mat3_column(to_world.linear, 1)), -3, 1e-12);
      assert_near(vec3_dot(gradient, mat3_column(to_world.linear, 2)), 0.5, 1e-12);
    }
  }
  field_close(&f);
  free(voxels);
}

/* The reconstruction of a single bright voxel has the kernel's shape. */
static void test_kernel_values(void **state) {
  (void)state;
  float *voxels = calloc(SIZE[0] * SIZE[1] * SIZE[2], sizeof *voxels);
  assert_non_null(voxels);
  voxels[(7 * SIZE[1] + 9) * SIZE[0] + 11] = 1;
  field f;
  field_open(&f, voxels);
  double e2 = exp(-2), e_half = exp(-0.5), e_far = exp(-4.5);
  double at_voxel = 1 / (1 + 2 * e2), midway = e_half / (2 * e_half + 2 * e_far);
  const double expected[3][3] = {/* [kernel][distance]; the kernel's weight along one axis at the bright
                                  * voxel, half a voxel beside it and one and a half voxels beside it */
                                 {2.0 / 3, 23.0 / 48, 1.0 / 48},
                                 {at_voxel, midway, e_far / (2 * e_half + 2 * e_far)},
                                 {1, 0.5, 0}};
  for (int kernel = HL_KERNEL_BSPLINE; kernel <= HL_KERNEL_LINEAR; kernel++) {
    field_make(&f, (hl_kernel)kernel);
    const double *k = expected[kernel];
    assert_near(hl_reference_value(&f.volume, (vec3){11, 9, 7}), k[0] * k[0] * k[0], 1e-9);
    assert_near(hl_reference_value(&f.volume, (vec3){11.5, 9, 7}), k[1] * k[0] * k[0], 1e-9);
    assert_near(hl_reference_value(&f.volume, (vec3){11, 8.5, 8.5}), k[0] * k[1] * k[2], 1e-9);
  }
  field_close(&f);
  free(voxels);
}

/* The analytic gradient equals the difference of values at two near points of the world. */
static void test_gradient_is_the_slope(void **state) {
  (void)state;
  field f;
  float *voxels = make_voxels(rough);
  field_open(&f, voxels);
  affine3 to_world = hl_scene_volume_index_to_world(&f.set.volumes[0]);
  const double h = 1e-5;
  for (int kernel = HL_KERNEL_BSPLINE; kernel <= HL_KERNEL_LINEAR; kernel++) {
    field_make(&f, (hl_kernel)kernel);
    for (int n = 0; n < 200; n++) {
      vec3 p = probe(n), world = affine3_apply(to_world, p);
      bool on_border = p.x < -0.4 || p.y < -0.4 || p.z < -0.4 || p.x > 22.4 || p.y > 17.4 || p.z > 13.4;
      if (on_border) continue;
      vec3 gradient = hl_reference_gradient(&f.volume, p), steps[3] = {{h, 0, 0}, {0, h, 0}, {0, 0, h}};
      const double slope[3] = {gradient.x, gradient.y, gradient.z};
      for (int a = 0; a < 3; a++) {
        vec3 before = affine3_apply(f.volume.world_to_index, vec3_subtract(world, steps[a]));
        vec3 after = affine3_apply(f.volume.world_to_index, vec3_add(world, steps[a]));
        double difference = hl_reference_value(&f.volume, after) - hl_reference_value(&f.volume, before);
        assert_near(slope[a], difference / (2 * h), 1e-7);
      }
    }
  }
  field_close(&f);
  free(voxels);
}

/* On the part of a ray that hl_reference_clearance() reports as empty, the field shows nothing. The reported
 * parts are long enough to be useful. */
static void test_clear_ways_are_clear(void **state) {
  (void)state;
  field f;
  float *voxels = make_voxels(sparse);
  field_open(&f, voxels);
  const hl_opacity_point points[2] = {{0, 0}, {1, 1}};
  f.set.volumes[0].transfer_function.opacity = points;
  f.set.volumes[0].transfer_function.opacity_count = 2;
  int promised = 0, longest = 0;
  for (int kernel = HL_KERNEL_BSPLINE; kernel <= HL_KERNEL_LINEAR; kernel++) {
    field_make(&f, (hl_kernel)kernel);
    for (int n = 1; n < 4000; n++) {
      vec3 p = probe(n), direction = vec3_subtract(probe(3 * n + 1), p);
      double clear = hl_reference_clearance(&f.volume, p, direction);
      promised += clear > 0;
      longest += clear >= 1;
      for (int i = 0; i < 20 && clear > 0; i++) {
        vec3 q = vec3_add(p, vec3_scale(direction, fmin(clear, 1) * i / 19.0));
        assert_true(hl_reference_extinction(&f.volume, hl_reference_value(&f.volume, q), q) == 0);
      }
    }
  }
  assert_true(promised > 6000 && longest > 500);
  field_close(&f);
  free(voxels);
}

/* Voxels that are not finite are empty. If the volume has no empty value, voxels that are not finite are
 * holes in the matter. */
static void test_nonfinite_voxels(void **state) {
  (void)state;
  float *voxels = make_voxels(constant);
  for (size_t i = 0; i < SIZE[0] * SIZE[1] * 6; i++) voxels[i] = i % 2 ? NAN : INFINITY;
  field f;
  field_open(&f, voxels);
  field_make(&f, HL_KERNEL_BSPLINE);
  assert_true(hl_reference_extinction(&f.volume, hl_reference_value(&f.volume, (vec3){9, 9, 2}),
                                      (vec3){9, 9, 2}) == 0);
  double solid = hl_reference_extinction(&f.volume, hl_reference_value(&f.volume, (vec3){9, 9, 10}),
                                         (vec3){9, 9, 10});
  assert_near(solid, -log(0.5), 1e-12);
  for (double z = 0; z < 13; z += 0.25)
    assert_true(isfinite(vec3_length(hl_reference_gradient(&f.volume, (vec3){9, 9, z}))));
  field_close(&f);
  free(voxels);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_constant_stays_constant), cmocka_unit_test(test_interpolating_keeps_values),
      cmocka_unit_test(test_ramp_is_exact),           cmocka_unit_test(test_kernel_values),
      cmocka_unit_test(test_gradient_is_the_slope),   cmocka_unit_test(test_clear_ways_are_clear),
      cmocka_unit_test(test_nonfinite_voxels),
  };
  return cmocka_run_group_tests_name("reference_field", tests, NULL, NULL);
}
