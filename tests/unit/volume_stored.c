/* tests/unit/volume_stored.c - results about a volume larger than memory that are found while it is stored:
 * bounds of bricks, and the voxels at which choices look. */
#define _GNU_SOURCE
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>

#include "core/context.h"
#include "guess/analysis.h"
#include "guess/sample.h"
#include "scene/scene.h"
#include "small_volume.h"
#include "volume/brick_bounds.h"
#include "volume/io/destination.h"
#include "volume/store/glimpse.h"
#include "volume/store/pages.h"

static void put(hl_storage storage, void *voxels, size_t n, unsigned value) {
  if (storage == HL_STORAGE_U8) ((uint8_t *)voxels)[n] = (uint8_t)value;
  else if (storage == HL_STORAGE_U16) ((uint16_t *)voxels)[n] = (uint16_t)value;
  else ((float *)voxels)[n] = ((float)(value & 0xffff) - 32768) / 16;
}

static const hl_storage storages[] = {HL_STORAGE_U8, HL_STORAGE_U16, HL_STORAGE_F32};

/* ---- bounds of bricks ---- */

/* The least and greatest of the voxels 4b-3 to 4b+5 along each axis, one by one. */
static void bounds_of(hl_storage storage, const void *voxels, const size_t n[3], const size_t brick[3],
                      double *low, double *high) {
  *low = INFINITY, *high = -INFINITY;
  size_t first[3], end[3];
  for (int a = 0; a < 3; a++) {
    first[a] = 4 * brick[a] < 3 ? 0 : 4 * brick[a] - 3;
    end[a] = 4 * brick[a] + 6 < n[a] ? 4 * brick[a] + 6 : n[a];
  }
  for (size_t k = first[2]; k < end[2]; k++)
    for (size_t j = first[1]; j < end[1]; j++)
      for (size_t i = first[0]; i < end[0]; i++) {
        double value = hl_stored_number(storage, voxels, (k * n[1] + j) * n[0] + i);
        *low = fmin(*low, value), *high = fmax(*high, value);
      }
}

static void test_brick_bounds(void **state) {
  (void)state;
  static const size_t shapes[][3] = {{1, 1, 1}, {2, 3, 1}, {5, 6, 7}, {35, 36, 37}, {40, 4, 13}, {8, 9, 11}};
  enum { SHAPES = sizeof shapes / sizeof *shapes };
  static float voxels[36 * 36 * 37];
  hl_context *context = make_context();
  for (size_t c = 0; c < SHAPES * 3; c++) {
    const size_t *n = shapes[c % SHAPES];
    const hl_storage storage = storages[c / SHAPES];
    const size_t slice = n[0] * n[1] * hl_storage_bytes(storage);
    hl_brick_bounds *bounds;
    for (size_t v = 0; v < n[0] * n[1] * n[2]; v++)
      put(storage, voxels, v, (unsigned)(v * 2654435761u >> 13));
    assert_true(hl_brick_bounds_create(context, n, storage, &bounds));
    for (size_t odd = 0; odd < 2; odd++) /* three slices are stored at once every second time */
      for (size_t k = 3 * odd; k < n[2]; k += 6) {
        size_t end = k + 3 < n[2] ? k + 3 : n[2];
        assert_false(hl_brick_bounds_whole(bounds));
        hl_brick_bounds_add(bounds, k, end, (const unsigned char *)voxels + k * slice);
      }
    assert_true(hl_brick_bounds_whole(bounds));
    for (size_t b = 0; b < bounds->count[0] * bounds->count[1] * bounds->count[2]; b++) {
      const size_t brick[3] = {b % bounds->count[0], b / bounds->count[0] % bounds->count[1],
                               b / bounds->count[0] / bounds->count[1]};
      double low, high;
      bounds_of(storage, voxels, n, brick, &low, &high);
      assert_true(hl_stored_number(storage, bounds->bounds, 2 * b) == low);
      assert_true(hl_stored_number(storage, bounds->bounds, 2 * b + 1) == high);
    }
    hl_brick_bounds_release(bounds);
  }
  assert_int_equal(hl_context_memory_held(context), 0);
  hl_context_destroy(context);
}

/* ---- the glimpse ---- */

static const size_t size[3] = {240, 231, 229}; /* the volume is so large that every second row is looked at */
enum { VOXELS = 240 * 231 * 229 };

static void test_glimpse(void **state) {
  (void)state;
  hl_context *context = make_context();
  hl_glimpse *glimpse;
  uint16_t *voxels = malloc(VOXELS * sizeof *voxels);
  assert_non_null(voxels);
  for (size_t v = 0; v < VOXELS; v++) voxels[v] = (uint16_t)(v * 2654435761u >> 13);
  assert_true(hl_glimpse_create(context, size, HL_STORAGE_U16, 1 << 20, &glimpse));
  assert_null(glimpse);
  assert_true(hl_glimpse_create(context, size, HL_STORAGE_U16, 1 << 30, &glimpse));
  for (size_t done = 0, piece = 1; done < VOXELS; done += piece, piece = piece * 7 % 70001 + 1) {
    if (piece > VOXELS - done) piece = VOXELS - done;
    hl_glimpse_store(glimpse, done, piece, voxels + done);
  }
  size_t kept = 0, rows = 0;
  for (size_t v = 0; v < VOXELS; v++) {
    size_t i = v % size[0], j = v / size[0] % size[1], k = v / size[0] / size[1];
    const uint16_t *voxel = hl_glimpse_voxel(glimpse, i, j, k);
    const uint16_t *row = i == 0 ? hl_glimpse_row(glimpse, j, k) : NULL;
    if (voxel != NULL) assert_int_equal(*voxel, voxels[v]);
    if (row != NULL) assert_memory_equal(row, voxels + v, size[0] * sizeof *row);
    kept += voxel != NULL, rows += row != NULL;
  }
  assert_in_range(rows, 116 * 115, size[1] * size[2]);
  assert_in_range(kept, VOXELS / 4, VOXELS);
  hl_glimpse_release(glimpse);
  free(voxels);
  assert_int_equal(hl_context_memory_held(context), 0);
  hl_context_destroy(context);
}

/* ---- choices ---- */

/* A ball of noise. */
static hl_volume *make_ball(hl_context *context, hl_voxel_type type, bool paged) {
  hl_volume_description grid;
  hl_volume_description_defaults(&grid);
  memcpy(grid.dimensions, size, sizeof grid.dimensions);
  grid.type = type;
  const hl_storage storage = hl_voxel_type_storage(type);
  unsigned char *voxels = malloc(VOXELS * hl_storage_bytes(storage));
  assert_non_null(voxels);
  for (size_t v = 0; v < VOXELS; v++) {
    double x = (double)(v % size[0]) - 130, y = (double)(v / size[0] % size[1]) - 100,
           z = (double)(v / size[0] / size[1]) - 120;
    bool inside = x * x + y * y * 1.5 + z * z < 90 * 90;
    put(storage, voxels, v, inside ? 40000 + ((unsigned)(v * 2654435761u >> 13) & 8191) : 32768);
  }
  hl_volume *volume = NULL;
  if (paged) {
    hl_pages *pages = NULL;
    assert_int_equal(hl_pages_create(context, "/tmp", &grid, PAGE_SHIFT, &pages, NULL), HL_OK);
    hl_pages_store(pages, 0, VOXELS, voxels);
    assert_int_equal(hl_volume_adopt_pages(context, &grid, "a ball", pages, &volume, NULL), HL_OK);
  } else {
    grid.voxels = voxels;
    assert_int_equal(hl_volume_create(context, &grid, &volume, NULL), HL_OK);
  }
  free(voxels);
  return volume;
}

typedef struct choices {
  hl_data_analysis analysis;
  hl_view view;
  hl_camera camera;
  double roughness;
} choices;

static void choose(const hl_volume *volume, choices *made) {
  memset(made, 0, sizeof *made);
  const double low = volume->minimum, high = volume->maximum;
  const hl_opacity_point points[2] = {{low + 0.1 * (high - low), 0}, {high, 0.5}};
  hl_scene_volume shown;
  hl_scene_volume_defaults(&shown);
  shown.volume = (hl_volume *)volume;
  shown.transfer_function.opacity = points;
  shown.transfer_function.opacity_count = 2;
  shown.transfer_function.unit_distance = 1;
  hl_scene_description scene;
  hl_scene_description_defaults(&scene);
  scene.volumes = &shown;
  scene.volume_count = 1;
  made->camera = scene.camera;
  assert_int_equal(hl_data_analyse(volume, &made->analysis, NULL), HL_OK);
  assert_int_equal(hl_data_find_labels(volume, &made->analysis, NULL), HL_OK);
  assert_int_equal(hl_view_choose(&scene, HL_SIDE_AUTOMATIC, NULL, &made->view, NULL), HL_OK);
  assert_int_equal(hl_camera_frame_view(&scene, &made->view, 1, &made->camera, NULL), HL_OK);
  if (volume->storage != HL_STORAGE_F32) return;
  hl_sample sample;
  assert_int_equal(hl_sample_make(volume, &sample, NULL), HL_OK);
  made->roughness = hl_roughness(volume, &sample, made->analysis.background, 0.01);
  hl_sample_release(&sample);
}

/* Only the exposure reads the scratch file. For all other choices, a read of it would end the program here.
 */
static void test_choices_read_no_pages(void **state) {
  (void)state;
  static const hl_voxel_type types[] = {HL_VOXEL_U16, HL_VOXEL_F32};
  for (size_t n = 0; n < 2; n++) {
    hl_context *context = make_context();
    hl_volume *packed = make_ball(context, types[n], false);
    context->options.memory_limit = (uint64_t)1 << 32;
    hl_volume *paged = make_ball(context, types[n], true);
    static choices of_packed, of_paged;
    choose(packed, &of_packed);
    assert_int_equal(mprotect(paged->pages->mapping, paged->pages->mapping_bytes, PROT_NONE), 0);
    choose(paged, &of_paged);
    assert_memory_equal(&of_packed.view, &of_paged.view, sizeof of_paged.view);
    assert_memory_equal(&of_packed.camera, &of_paged.camera, sizeof of_paged.camera);
    assert_int_equal(of_packed.analysis.kind, of_paged.analysis.kind);
    assert_true(of_packed.analysis.solid == of_paged.analysis.solid);
    assert_true(of_packed.roughness == of_paged.roughness && (n == 0 || of_paged.roughness > 0));
    hl_volume_release(packed);
    hl_volume_release(paged);
    assert_int_equal(hl_context_memory_held(context), 0);
    hl_context_destroy(context);
  }
}

/* ---- warnings before anything is read ---- */

static char warned[1000];

static void keep_warning(void *user_data, hl_log_level level, const char *message) {
  (void)user_data;
  if (level == HL_LOG_WARNING) snprintf(warned, sizeof warned, "%s", message);
}

/* If the limit is less than a picture of the volume will need, that is reported before its file is made: the
 * folder for the file does not exist. */
static void test_warning_of_pictures(void **state) {
  (void)state;
  static const struct {
    size_t side;
    hl_voxel_type type;
    uint64_t limit;
    const char *warning;
  } cases[] = {{2048, HL_VOXEL_U16, 1u << 30,
                "huge: a picture of it will need more than 1159 MiB for the bounds of its bricks, and the "
                "memory limit is "
                "1024 MiB"},
               {2048, HL_VOXEL_U16, 1160u << 20, ""},
               {2048, HL_VOXEL_U8, 1u << 30, ""}, /* 903 MiB */
               {6600, HL_VOXEL_U8, 1u << 30,
                "huge: a picture of it will be refused: it has 4.5e+09 bricks of 4 x 4 x 4 voxels, and "
                "4294967295 can be "
                "numbered"}};
  for (size_t n = 0; n < sizeof cases / sizeof *cases; n++) {
    hl_context_options options;
    hl_context_options_defaults(&options);
    options.log = keep_warning;
    options.memory_limit = cases[n].limit;
    options.scratch_folder = "/nowhere";
    hl_context *context = NULL;
    assert_int_equal(hl_context_create(&options, &context, NULL), HL_OK);
    hl_volume_description grid;
    hl_volume_description_defaults(&grid);
    for (int a = 0; a < 3; a++) grid.dimensions[a] = cases[n].side;
    grid.type = cases[n].type;
    hl_destination destination;
    warned[0] = '\0';
    assert_int_equal(hl_destination_open(context, &grid, HL_DESTINATION_PIECES, "huge", &destination, NULL),
                     HL_ERROR_MEMORY);
    assert_string_equal(warned, cases[n].warning);
    hl_destination_close(&destination);
    hl_context_destroy(context);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_brick_bounds),
      cmocka_unit_test(test_glimpse),
      cmocka_unit_test(test_choices_read_no_pages),
      cmocka_unit_test(test_warning_of_pictures),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
