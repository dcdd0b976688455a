/* tests/unit/volume_smooth.c - voxels that are smoothed by a Gaussian, against closed forms; and which
 * volumes are smoothed without being asked. */
#include <float.h>
#include <stdio.h>
#include <unistd.h>

#include "guess/smoothing.h"
#include "scene_parts.h"

enum { N = 32, COUNT = N * N * N };

static hl_context *context;
static float values[COUNT];

static size_t at(int i, int j, int k) { return (size_t)((k * N + j) * N + i); }

/* A volume of values[], of voxels `thick` long along k. */
static hl_volume *make(double thick) {
  hl_volume_description d = describe_voxels(N, N, N, HL_VOXEL_F32, values);
  d.axis[2][2] = thick;
  d.origin[0] = 5;
  return create_volume(context, &d);
}

/* The weight of a Gaussian at the distance d, among the weights at whole distances that smooth.c takes. */
static double weight(double sigma, int d) {
  int radius = (int)ceil(3 * sigma);
  double sum = 0;
  for (int n = -radius; n <= radius; n++) sum += exp(-0.5 * n * n / (sigma * sigma));
  return abs(d) <= radius ? exp(-0.5 * d * d / (sigma * sigma)) / sum : 0;
}

static hl_volume *smooth(double thick, double sigma) {
  hl_volume *sharp = make(thick), *smoothed = NULL;
  assert_int_equal(hl_volume_smooth(sharp, sigma, &smoothed, NULL), HL_OK);
  hl_volume_release(sharp);
  return smoothed;
}

static void an_impulse_becomes_a_gaussian(void **state) {
  (void)state;
  static const double sigmas[] = {0.5, 0.8, 2.25};
  for (size_t s = 0; s < 3; s++) {
    memset(values, 0, sizeof values);
    values[at(15, 16, 14)] = 1000;
    hl_volume *smoothed = smooth(3, sigmas[s]);
    for (int k = 0; k < N; k++)
      for (int j = 0; j < N; j++)
        for (int i = 0; i < N; i++) {
          double want = 1000 * weight(sigmas[s], i - 15) * weight(sigmas[s], j - 16) *
                        weight(sigmas[s], k - 14);
          double is = hl_volume_value(smoothed, (size_t)i, (size_t)j, (size_t)k);
          assert_true(fabs(is - want) <= 4 * FLT_EPSILON * want);
        }
    assert_true(hl_volume_smoothing(smoothed) == sigmas[s]);
    hl_volume_release(smoothed);
  }
}

/* A step along k becomes the sum of the weights on its far side. Beyond the border, the border's value goes
 * on. */
static void a_step_becomes_a_ramp(void **state) {
  (void)state;
  for (int v = 0; v < COUNT; v++) values[v] = v / N / N < 20 ? -100.5f : 299.5f;
  hl_volume *smoothed = smooth(1, 0.8);
  for (int k = 0; k < N; k++) {
    double far = 0;
    for (int d = -3; d <= 3; d++) far += k + d >= 20 ? weight(0.8, d) : 0;
    assert_true(fabs(hl_volume_value(smoothed, 0, 31, (size_t)k) - (-100.5 + 400 * far)) < 1e-4);
  }
  hl_volume_info info = {.struct_size = sizeof info};
  assert_int_equal(hl_volume_get_info(smoothed, &info), HL_OK);
  assert_true(info.origin[0] == 5 && info.spacing[2] == 1);
  hl_volume_release(smoothed);
}

/* Whole numbers become numbers of 16 bits, at most half a step from the smoothed floats. */
static void whole_numbers_keep_16_bits(void **state) {
  (void)state;
  static uint8_t bytes[COUNT];
  for (int v = 0; v < COUNT; v++) values[v] = bytes[v] = (uint8_t)(v * 7919 % 251 > 200 ? 255 : v % 31);
  hl_volume_description d = describe_voxels(N, N, N, HL_VOXEL_U8, bytes);
  hl_volume *whole = create_volume(context, &d), *smoothed = NULL, *floats = smooth(1, 0.8);
  assert_int_equal(hl_volume_smooth(whole, 0.8, &smoothed, NULL), HL_OK);
  assert_int_equal(smoothed->storage, HL_STORAGE_U16);
  const double step = (floats->maximum - floats->minimum) / UINT16_MAX;
  for (size_t v = 0; v < COUNT; v++) {
    double is = hl_volume_value(smoothed, v % N, v / N % N, v / N / N),
           want = hl_volume_value(floats, v % N, v / N % N, v / N / N);
    assert_true(fabs(is - want) <= 0.501 * step);
  }
  assert_true(smoothed->minimum == floats->minimum && fabs(smoothed->maximum - floats->maximum) < 1e-4);
  hl_volume_release(floats);
  hl_volume_release(smoothed);
  hl_volume_release(whole);
}

/* A hole stays a hole and takes nothing from its neighbours: equal values stay equal. */
static void holes_stay(void **state) {
  (void)state;
  for (int v = 0; v < COUNT; v++) values[v] = (float)(v / 7 % 2 + 40);
  values[at(3, 4, 5)] = NAN;
  for (int v = 0; v < COUNT; v++)
    if (!isnan(values[v])) values[v] = v % N < 16 ? 40 : 41;
  hl_volume *smoothed = smooth(1, 1);
  assert_true(isnan(hl_volume_value(smoothed, 3, 4, 5)));
  assert_true(fabs(hl_volume_value(smoothed, 4, 4, 5) - 40) < 1e-4);
  hl_volume_release(smoothed);
}

static double noise(int i, int j, int k) { /* 0..1 */
  unsigned state = (unsigned)((k * N + j) * N + i) * 2654435761u;
  state = (state ^ (state >> 15)) * 2246822519u;
  return (double)((state ^ (state >> 13)) & 0xffff) / 65536;
}

/* Matter of the values 130 to 130 + grain in air. It is cut out, or has the rim that a scanner gives. The air
 * has noise or none. */
static void fill(bool cut_out, double air, double grain) {
  for (int k = 0; k < N; k++)
    for (int j = 0; j < N; j++)
      for (int i = 0; i < N; i++) {
        double r = sqrt((i - 15.3) * (i - 15.3) + (j - 15.8) * (j - 15.8) + (k - 16.2) * (k - 16.2));
        double matter = 130 + grain * noise(i, j, k),
               share = cut_out ? r < 12 : 1 / (1 + exp((r - 12) / 0.8));
        values[at(i, j, k)] = (float)floor(matter * share + (cut_out ? 0 : air * noise(k, i, j)));
      }
}

static double smoothed_by(double thick) {
  hl_volume *volume = make(thick);
  hl_data_analysis analysis;
  assert_int_equal(hl_data_analyse(volume, &analysis, NULL), HL_OK);
  assert_int_equal(analysis.kind, HL_DATA_SURFACES);
  const double sigma = hl_smoothing_for(volume, "head.nii", &analysis);
  hl_volume_release(volume);
  return sigma;
}

static void cliffs_are_smoothed(void **state) {
  (void)state;
  fill(true, 0, 40);
  assert_true(smoothed_by(1) == 0.8);
  fill(false, 4, 4);
  assert_true(smoothed_by(1) == 0);
  assert_true(smoothed_by(1.5) == 0); /* if the rim is that wide, slices are not too thick */
}

/* A plane across an axis, at all places between two voxels, blurred by a Gaussian. */
static void fill_step(int axis, double sigma) {
  for (int v = 0; v < COUNT; v++) {
    const int place[3] = {v % N, v / N % N, v / N / N};
    const double lean = (place[(axis + 1) % 3] + 0.37 * place[(axis + 2) % 3]) / 17;
    values[v] = (float)(0.5 * erfc((place[axis] - 14 - lean) / (sigma * sqrt(2))));
  }
}

/* The fraction of a blurred step that lies between two voxels, in the mean over all places t between them;
 * divided by the fraction over three edges of a voxel. */
static double expected_sharpness(double sigma) {
  enum { PLACES = 1000 };
  double sum = 0;
  for (int n = 0; n < PLACES; n++) {
    const double t = (n + 0.5) / PLACES - 0.5, scale = sigma * sqrt(2);
    sum += (erf((t + 0.5) / scale) - erf((t - 0.5) / scale)) /
           (erf((t + 1.5) / scale) - erf((t - 1.5) / scale));
  }
  return sum / PLACES;
}

static void sharpness_is_the_part_of_a_step_between_two_voxels(void **state) {
  (void)state;
  static const double sigmas[] = {0.3, 0.5, 0.8};
  const hl_sample sample = {.context = context, .low = 0, .range = 1, .step = 1};
  for (int axis = 0; axis < 3; axis++)
    for (int n = 0; n < 3; n++) {
      fill_step(axis, sigmas[n]);
      hl_volume *volume = make(1);
      hl_data_analysis analysis = {.background = 0, .direction = 1, .solid = 0.5};
      assert_int_equal(hl_data_find_boundary(volume, &sample, &analysis, NULL), HL_OK);
      assert_true(fabs(analysis.sharpness - expected_sharpness(sigmas[n])) < 0.005);
      hl_volume_release(volume);
    }
  /* volumes with steps of this sharpness, or sharper, are smoothed */
  assert_true(fabs(expected_sharpness(0.5) - 0.614) < 0.001);
}

/* Rods that are one voxel thin would vanish, so that they are not smoothed. */
static void thin_matter_is_left(void **state) {
  (void)state;
  for (int v = 0; v < COUNT; v++)
    values[v] = (v % N % 8 == 4 && v / N / N % 8 == 4 && v / N % N > 8 && v / N % N < 24) ? 250 : 0;
  hl_volume *volume = make(1);
  const hl_sample sample = {.context = context, .low = 0, .range = 250, .step = 1};
  hl_data_analysis analysis = {.background = 0, .direction = 1, .solid = 0.5};
  assert_int_equal(hl_data_find_boundary(volume, &sample, &analysis, NULL), HL_OK);
  assert_true(analysis.sharpness < 0.1);
  hl_volume_release(volume);
}

/* A rim that is narrower along k than the distance of slices makes terraces. */
static void terraces_are_smoothed(void **state) {
  (void)state;
  for (int flat = 0; flat < 2; flat++) {
    for (int v = 0; v < COUNT; v++) {
      const double x = v % N - 15.3, y = v / N % N - 15.8, z = (v / N / N - 16.2) * (flat ? 4 : 1);
      values[v] = (float)floor(130 / (1 + exp((sqrt(x * x + y * y + z * z) - 12) / 0.8)) +
                               4 * noise(v % N, v / N % N, v / N / N));
    }
    assert_true(smoothed_by(1) == (flat ? 0.8 : 0));
  }
}

/* Noise moves a surface by its standard deviation divided by the slope. Uniform noise of the width w has w /
 * sqrt(12). The rim m / (1 + exp(r / .8)) in air has the slope s (1 - s / m) / .8 at the value s. */
static void grain_is_smoothed_and_objects_stay_what_they_are(void **state) {
  (void)state;
  fill(false, 16, 0);
  hl_volume *volume = make(1), *smoothed = NULL;
  hl_data_analysis before, after;
  assert_int_equal(hl_data_analyse(volume, &before, NULL), HL_OK);
  const double slope = before.solid * (1 - before.solid / 130) / 0.8, grain = 16 / sqrt(12) / slope;
  assert_true(fabs(before.grain - grain) < 0.05 * grain);
  assert_true(hl_smoothing_for(volume, NULL, &before) == 0.8);
  assert_int_equal(hl_volume_smooth(volume, 2, &smoothed, NULL), HL_OK);
  assert_int_equal(hl_data_analyse(smoothed, &after, NULL), HL_OK);
  assert_true(before.kind == HL_DATA_SURFACES && after.kind == HL_DATA_SURFACES);
  assert_true(after.solid == before.solid && after.faint == before.faint);
  hl_volume_release(smoothed);
  hl_volume_release(volume);
  /* noise alone, without an object */
  for (int v = 0; v < COUNT; v++) values[v] = (float)noise(v % N, v / N % N, v / N / N);
  volume = make(1);
  assert_int_equal(hl_data_analyse(volume, &after, NULL), HL_OK);
  assert_true(hl_smoothing_for(volume, NULL, &after) == 0);
  hl_volume_release(volume);
}

/* A bare scene is smoothed, and it is not if 0 was asked for. */
static void bare_scenes_are_smoothed(void **state) {
  (void)state;
  fill(true, 0, 40);
  hl_volume *volume = make(1), *same = NULL;
  hl_scene *scene = NULL;
  assert_int_equal(hl_scene_for_volume(context, volume, "head.nii", &scene, NULL), HL_OK);
  assert_true(hl_volume_smoothing(hl_scene_describe(scene)->volumes[0].volume) == 0.8);
  hl_scene_release(scene);
  assert_int_equal(hl_volume_smooth(volume, 0, &same, NULL), HL_OK);
  assert_ptr_equal(same, volume);
  assert_int_equal(hl_scene_for_volume(context, same, "head.nii", &scene, NULL), HL_OK);
  assert_ptr_equal(hl_scene_describe(scene)->volumes[0].volume, volume);
  hl_scene_release(scene);
  hl_volume_release(same);
  hl_volume_release(volume);
}

/* With any memory limit, a bare scene is smoothed if there is memory for it, and else shows the voxels as
 * they are. */
static void smoothing_keeps_to_the_memory_limit(void **state) {
  (void)state;
  enum { SIDE = 128, VOXELS = SIDE * SIDE * SIDE };
  fill(true, 0, 40);
  uint8_t *bytes = malloc(VOXELS);
  assert_non_null(bytes);
  for (int v = 0; v < VOXELS; v++)
    bytes[v] = (uint8_t)values[at(v % SIDE / 4, v / SIDE % SIDE / 4, v / SIDE / SIDE / 4)];
  bool was_smoothed = false;
  for (size_t limit = 10u << 20; limit <= 20u << 20; limit += 1u << 19) {
    hl_context_options options;
    hl_context *own = NULL;
    hl_scene *scene = NULL;
    hl_error error = {0};
    hl_context_options_defaults(&options);
    options.memory_limit = limit;
    assert_int_equal(hl_context_create(&options, &own, NULL), HL_OK);
    hl_volume_description d = describe_voxels(SIDE, SIDE, SIDE, HL_VOXEL_U8, bytes);
    hl_volume *volume = create_volume(own, &d);
    if (hl_scene_for_volume(own, volume, "head.nii", &scene, &error) != HL_OK)
      fail_msg("a limit of %zu bytes: %s", limit, error.message);
    const bool is_smoothed = hl_volume_smoothing(hl_scene_describe(scene)->volumes[0].volume) > 0;
    assert_true(is_smoothed || !was_smoothed);
    assert_true(is_smoothed ? limit > 7 * VOXELS : limit < 9 * VOXELS);
    was_smoothed = is_smoothed;
    hl_scene_release(scene);
    hl_volume_release(volume);
    hl_context_destroy(own);
  }
  free(bytes);
}

static void what_has_no_mean_is_refused(void **state) {
  (void)state;
  hl_error error = {0};
  hl_volume *smoothed = NULL;
  for (int v = 0; v < COUNT; v++) values[v] = v % N < 8 ? 0 : v % N < 20 ? 3 : v / N % N < 16 ? 17 : 42;
  hl_volume *labels = make(1);
  assert_int_equal(hl_volume_smooth(labels, 1, &smoothed, &error), HL_ERROR_ARGUMENT);
  assert_non_null(strstr(error.message, "label map"));
  hl_volume_release(labels);

  /* A segmentation with one label does not look like a label map, but its file names the label. */
  FILE *file = fopen("halflight-one.seg.nrrd", "wb");
  assert_non_null(file);
  fputs(
      "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 4 4 4\nencoding: raw\nSegment0_Name:=liver\n"
      "Segment0_LabelValue:=1\n\n",
      file);
  for (int v = 0; v < 64; v++) fputc(v >= 32, file);
  assert_int_equal(fclose(file), 0);
  assert_int_equal(hl_volume_load(context, "halflight-one.seg.nrrd", &labels, NULL), HL_OK);
  unlink("halflight-one.seg.nrrd");
  assert_int_equal(hl_volume_smooth(labels, 1, &smoothed, &error), HL_ERROR_ARGUMENT);
  assert_non_null(strstr(error.message, "label map"));
  hl_volume_release(labels);
  fill(false, 12, 40);
  hl_volume *scan = make(1);
  static const double wrong[] = {-1, 16.5, NAN};
  for (int n = 0; n < 3; n++) {
    assert_int_equal(hl_volume_smooth(scan, wrong[n], &smoothed, &error), HL_ERROR_ARGUMENT);
    assert_non_null(strstr(error.message, "from 0 to 16"));
    assert_null(smoothed);
  }
  hl_volume_release(scan);
}

/* ---- the voxels before they were smoothed ---- */

static hl_context *keeping(const char *scratch_folder) {
  hl_context_options options;
  hl_context *made = NULL;
  hl_context_options_defaults(&options);
  options.keep_unsmoothed = 1;
  options.scratch_folder = scratch_folder;
  assert_int_equal(hl_context_create(&options, &made, NULL), HL_OK);
  return made;
}

/* A volume of noise in a grid whose sides are no multiples of a page's. The numbers are odd, so that floats
 * round those of 32 bits, which lie beyond 2^24. */
static hl_volume *make_odd(hl_context *own, hl_voxel_type type) {
  enum { NI = 70, NJ = 9, NK = 19 };
  static int32_t numbers[NI * NJ * NK];
  int16_t *shorter = (int16_t *)numbers;
  const bool wide = type == HL_VOXEL_I32;
  for (int v = 0; v < NI * NJ * NK; v++) {
    const int number = (int)(noise(v % N, v / N % N, v / N / N) * (wide ? 1e9 : 3e4)) | 1;
    if (wide) numbers[v] = number;
    else shorter[v] = (int16_t)(number - 15000);
  }
  hl_volume_description d = describe_voxels(NI, NJ, NK, type, numbers);
  d.axis[2][2] = 3;
  d.origin[1] = -7;
  d.value_scale = wide ? 1 : 0.25;
  d.value_offset = wide ? 0 : 12;
  return create_volume(own, &d);
}

static bool is_same(const hl_volume *a, const hl_volume *b) {
  hl_volume_info of_a = {.struct_size = sizeof of_a}, of_b = {.struct_size = sizeof of_b};
  assert_int_equal(hl_volume_get_info(a, &of_a), HL_OK);
  assert_int_equal(hl_volume_get_info(b, &of_b), HL_OK);
  for (size_t k = 0; k < of_a.dimensions[2]; k++)
    for (size_t j = 0; j < of_a.dimensions[1]; j++)
      for (size_t i = 0; i < of_a.dimensions[0]; i++)
        if (hl_volume_value(a, i, j, k) != hl_volume_value(b, i, j, k)) return false;
  return of_a.type == of_b.type && memcmp(of_a.origin, of_b.origin, sizeof of_a.origin) == 0 &&
         memcmp(of_a.spacing, of_b.spacing, sizeof of_a.spacing) == 0 &&
         memcmp(of_a.range, of_b.range, sizeof of_a.range) == 0 &&
         memcmp(of_a.histogram, of_b.histogram, sizeof of_a.histogram) == 0;
}

/* The exact voxels of a smoothed volume are kept, out of memory if there is a scratch folder; also those of a
 * volume that was smoothed twice. They are released with the smoothed volume. */
static void unsmoothed_voxels_are_kept(void **state) {
  (void)state;
  static const hl_voxel_type types[] = {HL_VOXEL_I16, HL_VOXEL_I32};
  static const char *const folders[] = {"/tmp", NULL, "/nowhere"};
  for (size_t n = 0; n < 6; n++) {
    hl_context *own = keeping(folders[n / 2]);
    hl_volume *volume = make_odd(own, types[n % 2]), *want = make_odd(context, types[n % 2]), *smoothed,
              *twice;
    assert_int_equal(hl_volume_is_exact(volume), types[n % 2] == HL_VOXEL_I32);
    assert_int_equal(hl_volume_smooth(volume, 0.8, &smoothed, NULL), HL_OK);
    hl_volume_release(volume);
    assert_int_equal(hl_volume_smooth(smoothed, 0.6, &twice, NULL), HL_OK);
    assert_false(is_same(smoothed, want));
    assert_true(is_same(hl_volume_unsmoothed(smoothed), want));
    assert_int_equal(hl_volume_unsmoothed(smoothed)->pages != NULL, n / 2 == 0);
    hl_volume_release(smoothed);
    assert_true(is_same(hl_volume_unsmoothed(twice), want));
    assert_null(hl_volume_unsmoothed(hl_volume_unsmoothed(twice)));
    hl_volume_release(twice);
    hl_volume_release(want);
    assert_int_equal(hl_context_memory_held(own), 0);
    hl_context_destroy(own);
  }
  assert_null(hl_volume_unsmoothed(NULL));
}

/* A context that is not told to keep exact voxels releases them. */
static void unsmoothed_voxels_are_let_go(void **state) {
  (void)state;
  hl_volume *smoothed = smooth(1, 0.8);
  assert_null(hl_volume_unsmoothed(smoothed));
  hl_volume_release(smoothed);
}

static int begin(void **state) {
  (void)state;
  context = make_context();
  return 0;
}

static int end(void **state) {
  (void)state;
  assert_int_equal(hl_context_memory_held(context), 0);
  hl_context_destroy(context);
  return 0;
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(an_impulse_becomes_a_gaussian),
      cmocka_unit_test(a_step_becomes_a_ramp),
      cmocka_unit_test(whole_numbers_keep_16_bits),
      cmocka_unit_test(holes_stay),
      cmocka_unit_test(cliffs_are_smoothed),
      cmocka_unit_test(sharpness_is_the_part_of_a_step_between_two_voxels),
      cmocka_unit_test(terraces_are_smoothed),
      cmocka_unit_test(thin_matter_is_left),
      cmocka_unit_test(grain_is_smoothed_and_objects_stay_what_they_are),
      cmocka_unit_test(bare_scenes_are_smoothed),
      cmocka_unit_test(smoothing_keeps_to_the_memory_limit),
      cmocka_unit_test(what_has_no_mean_is_refused),
      cmocka_unit_test(unsmoothed_voxels_are_kept),
      cmocka_unit_test(unsmoothed_voxels_are_let_go),
  };
  return cmocka_run_group_tests(tests, begin, end);
}
