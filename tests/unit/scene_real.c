/* tests/unit/scene_real.c - automatic transfer functions of real volumes, if they are on this machine. */
#define _GNU_SOURCE
#include <stdio.h>
#include <unistd.h>

#include "guess/analysis.h"
#include "guess/looks.h"
#include "guess/sample.h"
#include "image/srgb.h"
#include "scene_parts.h"

static const struct {
  const char *file;
  hl_data_kind kind;
  double border;
  bool held; /* a board, rails or a head rest beside the object are cut away */
} SETS[] = {{"bonsai/bonsai.nrrd", HL_DATA_SURFACES, 0.2, true},
            {"boston_teapot/boston_teapot.nrrd", HL_DATA_SURFACES, 0.01, true},
            {"bucky/Bucky_32x32x32_uint8.raw", HL_DATA_FIELD, 0.08, false},
            {"cranium_mha/cranium.mha", HL_DATA_SURFACES, 0.15, true},
            {"engine/engine.nrrd", HL_DATA_SURFACES, 0.12, false},
            {"fuel/fuel_64x64x64_uint8.raw", HL_DATA_FIELD, 0.01, false},
            {"headmr_mhd/HeadMRVolume.mhd", HL_DATA_SURFACES, 0.12, false},
            {"hydrogen_orbital/hydrogen.vti", HL_DATA_FIELD, 0.01, false},
            {"hipip_signed/hipip_signed_64x64x64_int16.nrrd", HL_DATA_SIGNED, 0.12, false},
            {"ironprot/ironProt.vtk", HL_DATA_FIELD, 0.01, false},
            {"mrbrain/head256x256x109_uint8.raw.gz", HL_DATA_SURFACES, 0.06, false},
            {"neghip/neghip_64x64x64_uint8.raw", HL_DATA_FIELD, 0.05, false},
            {"nucleon/nucleon.nrrd", HL_DATA_FIELD, 0.01, false},
            {"silicium/silicium_98x34x34_uint8.raw", HL_DATA_FIELD, 0.01, false},
            {"skull_malformed_nrrd/skull_256x256x68_uint8_fixed.nrrd", HL_DATA_SURFACES, 0.02, false},
            {"smoke_plume_pbrt/smoke_plume_100x100x40_float.nrrd", HL_DATA_MEDIUM, 0.06, false},
            {"smoke_vdb/smoke_density.nrrd", HL_DATA_MEDIUM, 0.06, false},
            {"stent/stent.nrrd", HL_DATA_SURFACES, 0.12, false},
            {"stroke_t1_nii/T1.nii.gz", HL_DATA_SURFACES, 0.01, false},
            {"wdas_cloud/wdas_cloud_sixteenth_density.nrrd", HL_DATA_MEDIUM, 0.01, false}};

enum { SET_COUNT = sizeof SETS / sizeof *SETS };

/* The folder named in HALFLIGHT_DATA; null: none is named. */
static const char *named_folder(void) {
  const char *folder = getenv("HALFLIGHT_DATA");
  return folder != NULL && folder[0] != 0 ? folder : NULL;
}

static void path_of(size_t n, char path[500]) {
  const char *folder = named_folder();
  snprintf(path, 500, "%s/%s", folder != NULL ? folder : HALFLIGHT_SOURCE "/../shared/data", SETS[n].file);
}

/* Real volumes. Hardly any of the volume's border shows, something shows, and little of it lies outside of
 * the picture. */
static void real_volumes(void **state) {
  (void)state;
  hl_context *context = make_context();
  for (size_t n = 0; n < SET_COUNT; n++) {
    char path[500];
    path_of(n, path);
    if (access(path, R_OK) != 0) {
      /* If HALFLIGHT_DATA names a folder, it must hold all volumes of the test. A folder that is found by
       * chance may hold some. */
      if (named_folder() != NULL) fail_msg("HALFLIGHT_DATA names a folder without %s", SETS[n].file);
      print_message("# %s is not there\n", SETS[n].file);
      continue;
    }
    hl_volume *volume = NULL;
    hl_error error = {0};
    if (hl_volume_load(context, path, &volume, &error) != HL_OK) fail_msg("%s", error.message);
    hl_data_analysis a;
    hl_transfer_function f;
    hl_sample sample;
    assert_int_equal(hl_data_analyse(volume, &a, NULL), HL_OK);
    assert_int_equal(hl_transfer_function_automatic(context, volume, &f, NULL), HL_OK);
    assert_int_equal(hl_sample_make(volume, &sample, NULL), HL_OK);
    size_t seen = 0, seen_border = 0;
    bool low = false, high = false;
    for (size_t s = 0; s < sample.count; s++) {
      double value = sample.low + sample.range * (double)sample.values[s];
      if (hl_transfer_function_opacity(&f, value) < 0.02) continue;
      seen++;
      if (value < a.background) low = true;
      else high = true;
    }
    for (size_t s = 0; s < sample.border_count; s++)
      seen_border += hl_transfer_function_opacity(&f, sample.low + sample.range * (double)sample.border[s]) >=
                     0.02;
    double part = (double)seen / (double)sample.count,
           border = (double)seen_border / (double)sample.border_count;
    if (a.kind != SETS[n].kind || border > SETS[n].border || part < 0.005 || part > 0.5)
      fail_msg("%s: kind %d, %.4f of the voxels and %.4f of the border visible", SETS[n].file, (int)a.kind,
               part, border);
    assert_true(high && (low == (a.kind == HL_DATA_SIGNED)));
    hl_scene *scene = NULL;
    assert_int_equal(hl_scene_for_volume(context, volume, NULL, &scene, NULL), HL_OK);
    if ((hl_scene_describe(scene)->volumes[0].cut_count > 0) != SETS[n].held)
      fail_msg("%s: %zu planes", SETS[n].file, hl_scene_describe(scene)->volumes[0].cut_count);
    hl_scene_release(scene);
    hl_sample_release(&sample);
    hl_transfer_function_release(context, &f);
    hl_volume_release(volume);
  }
  assert_int_equal(hl_context_memory_held(context), 0);
  hl_context_destroy(context);
}

/* The values of grey and of white matter in heads: the means of the middle and of the greatest of three
 * groups of the brain's values (k-means). The least group is fluid. */
static const struct {
  const char *set;
  const char *file; /* the name by which the look knows the file */
  double grey, white;
} BRAINS[] = {{"mrbrain/head256x256x109_uint8.raw.gz", NULL, 58.5, 85.8},
              {"stroke_t1_nii/T1.nii.gz", "T1.nii.gz", 112.7, 165.5}};

/* A percentile of the values from which objects may begin. */
static double part_of_objects(const hl_sample *sample, const hl_data_analysis *a, double part) {
  size_t first = 0;
  while (first < sample->count &&
         sample->low + sample->range * (double)sample->values[first] < a->background + a->faint)
    first++;
  const size_t at = first + (size_t)(part * (double)(sample->count - 1 - first));
  return sample->low + sample->range * (double)sample->values[at];
}

static double level_of(const hl_transfer_function *function, double value) {
  double color[3];
  hl_transfer_function_color(function, value, color);
  return hl_srgb_encode_number(0.2126 * color[0] + 0.7152 * color[1] + 0.0722 * color[2]);
}

/* Grey and white matter differ by at least .6 of their difference in a slice whose window goes from the first
 * to the last hundredth of the objects' values. */
static void brains_are_like_slices(void **state) {
  (void)state;
  hl_context *context = make_context();
  for (size_t n = 0; n < SET_COUNT; n++)
    for (size_t b = 0; b < sizeof BRAINS / sizeof *BRAINS; b++) {
      char path[500];
      path_of(n, path);
      if (strcmp(SETS[n].file, BRAINS[b].set) != 0 || access(path, R_OK) != 0) continue;
      hl_volume *volume = NULL;
      hl_data_analysis a;
      hl_transfer_function f;
      hl_sample sample;
      assert_int_equal(hl_volume_load(context, path, &volume, NULL), HL_OK);
      assert_int_equal(hl_data_analyse(volume, &a, NULL), HL_OK);
      assert_int_equal(hl_sample_make(volume, &sample, NULL), HL_OK);
      assert_int_equal(
          hl_look_write(hl_look_for(volume, BRAINS[b].file, &a), NULL, context, volume, &a, &f, NULL), HL_OK);
      const double window = part_of_objects(&sample, &a, 0.99) - part_of_objects(&sample, &a, 0.01),
                   slice = (BRAINS[b].white - BRAINS[b].grey) / window,
                   shown = level_of(&f, BRAINS[b].white) - level_of(&f, BRAINS[b].grey);
      print_message("# %s: %.3f of the slice's contrast\n", SETS[n].file, shown / slice);
      assert_true(shown > 0.6 * slice);
      hl_transfer_function_release(context, &f);
      hl_sample_release(&sample);
      hl_volume_release(volume);
    }
  hl_context_destroy(context);
}

static size_t volumes_at_hand(void) {
  size_t count = 0;
  for (size_t n = 0; n < SET_COUNT; n++) {
    char path[500];
    path_of(n, path);
    count += access(path, R_OK) == 0;
  }
  return count;
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(real_volumes),
                                     cmocka_unit_test(brains_are_like_slices)};
  if (named_folder() != NULL || volumes_at_hand() > 0) return cmocka_run_group_tests(tests, NULL, NULL);
  puts("1..0 # SKIP the real volumes are not there: name their folder in HALFLIGHT_DATA");
  return 0;
}
