/* analytic/sheets_pages.c - volumes whose voxels are in pages of a scratch file give the bytes of volumes in
 * memory, whatever the size of volumes and pages, by every method of shadows. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "core/context.h"
#include "grid/make_grid.h"
#include "reference_stage.h"
#include "volume/store/pages.h"
#include "ways_to_draw.h"

enum { SIDE = 24, FLOATS = SIDE * SIDE * 4, MOST_VOXELS = 40 * 40 * 40 };

/* ---- the same volume in pages ---- */

/* Stores a volume's voxels in pages, in pieces that begin and end within rows. */
static hl_volume *in_pages(hl_context *context, const hl_volume *volume, int shift) {
  hl_volume_description description = stage_describe_volume(volume);
  hl_pages *pages;
  assert_int_equal(hl_pages_create(context, "/tmp", &description, shift, &pages, NULL), HL_OK);
  size_t bytes = hl_storage_bytes(volume->storage), count = hl_volume_voxel_count(volume);
  for (size_t done = 0, piece = 1; done < count; done += piece, piece = piece * 3 % 301 + 1) {
    if (piece > count - done) piece = count - done;
    hl_pages_store(pages, done, piece, (const unsigned char *)volume->voxels + done * bytes);
  }
  hl_volume *made = NULL;
  assert_int_equal(hl_volume_adopt_pages(context, &description, "pages", pages, &made, NULL), HL_OK);
  return made;
}

static hl_volume *packed_volume(hl_context *context, const size_t n[3], hl_voxel_type type) {
  static unsigned char voxels[MOST_VOXELS * sizeof(float)];
  hl_volume_description description;
  hl_volume_description_defaults(&description);
  memcpy(description.dimensions, n, sizeof description.dimensions);
  description.type = type;
  description.voxels = voxels;
  for (size_t v = 0; v < n[0] * n[1] * n[2]; v++) {
    unsigned value = (unsigned)(v * 2654435761u >> 11);
    if (type == HL_VOXEL_U8) voxels[v] = (unsigned char)value;
    else if (type == HL_VOXEL_U16) ((uint16_t *)(void *)voxels)[v] = (uint16_t)value;
    else ((float *)(void *)voxels)[v] = (float)(value & 0xffff) / 65536;
  }
  hl_volume *made = NULL;
  assert_int_equal(hl_volume_create(context, &description, &made, NULL), HL_OK);
  return made;
}

static const size_t shapes[][3] = {{1, 1, 1},   {2, 3, 1},   {3, 40, 5},   {4, 4, 4},
                                   {5, 6, 7},   {8, 11, 12}, {11, 19, 3},  {35, 36, 37},
                                   {19, 1, 40}, {40, 4, 13}, {10, 33, 35}, {13, 40, 9}};
enum { SHAPES = sizeof shapes / sizeof *shapes };
static const hl_voxel_type types[] = {HL_VOXEL_U8, HL_VOXEL_U16, HL_VOXEL_F32};

/* A volume in pages has the same voxels, rows and statistics as the volume in memory. */
static void test_voxels(void **state) {
  (void)state;
  stage set;
  stage_open(&set);
  for (int n = 0; n < SHAPES * 3 * 4; n++) {
    const size_t *size = shapes[n % SHAPES];
    hl_volume *packed = packed_volume(set.context, size, types[n / SHAPES % 3]);
    hl_volume *paged = in_pages(set.context, packed, 1 + n / SHAPES / 3);
    size_t bytes = size[0] * hl_storage_bytes(packed->storage);
    unsigned char row[40 * sizeof(float)];
    for (size_t k = 0; k < size[2]; k++)
      for (size_t j = 0; j < size[1]; j++) {
        assert_memory_equal(hl_volume_row_in(paged, j, k, row), hl_volume_row(packed, j, k), bytes);
        for (size_t i = 0; i < size[0]; i++)
          assert_true(hl_volume_value(paged, i, j, k) == hl_volume_value(packed, i, j, k));
      }
    assert_memory_equal(paged->histogram, packed->histogram, sizeof paged->histogram);
    assert_true(paged->minimum == packed->minimum && paged->maximum == packed->maximum &&
                paged->mean == packed->mean);
    hl_volume_release(packed);
    hl_volume_release(paged);
  }
  stage_close(&set);
}

/* ---- pictures ---- */

/* Renders a scene with its volumes in memory and then in pages. */
static void assert_same_in_pages(stage *set, int shift, const char *what) {
  static float packed[FLOATS], paged[FLOATS];
  set->scene.width = set->scene.height = SIDE;
  stage_render_sheets(set, packed);
  for (size_t v = 0; v < set->scene.volume_count; v++) {
    hl_volume *old = set->volumes[v].volume;
    set->volumes[v].volume = in_pages(set->context, old, shift);
    hl_volume_release(old);
  }
  stage_render_sheets(set, paged);
  bool any = false;
  for (int i = 0; i < FLOATS; i++) {
    any |= packed[i] > 0;
    if (packed[i] != paged[i])
      fail_msg("%s, pages of %d: pixel %d, %d: %.9g in memory, %.9g in pages", what, 1 << shift, i / 4 % SIDE,
               i / 4 / SIDE, (double)packed[i], (double)paged[i]);
  }
  assert_true(any);
}

/* Adds noise in a box of 20 units, seen obliquely. Neighbouring voxels have different values. */
static hl_scene_volume *add_noise(stage *set, const size_t n[3], hl_voxel_type type) {
  static float voxels[MOST_VOXELS];
  double spacing[3];
  for (int a = 0; a < 3; a++) spacing[a] = 20 / (double)n[a];
  for (size_t v = 0; v < n[0] * n[1] * n[2]; v++) {
    double x = (double)(v % n[0]), y = (double)(v / n[0] % n[1]), z = (double)(v / n[0] / n[1]);
    voxels[v] = stage_noise(x * 0.9, y * 1.1, z * 1.3);
  }
  set->type = type;
  hl_scene_volume *made = stage_add_grid(set, n, spacing, (vec3){-10, -10, -10}, voxels);
  stage_set_opacity(set, made, 0.4, 6);
  stage_look(set, (vec3){31, 17, 23}, (vec3){0, 0, 0}, (vec3){0, 0, 1});
  return made;
}

static void open_with(stage *set, hl_instruction_set instructions) {
  hl_context_options options;
  hl_context_options_defaults(&options);
  options.instruction_set = instructions;
  stage_open_with(set, &options);
}

static void test_shapes(void **state) {
  (void)state;
  for (int n = 0; n < SHAPES; n++) {
    stage set;
    stage_open(&set);
    hl_scene_volume *volume = add_noise(&set, shapes[n], types[n % 3]);
    volume->shading = n % 2 ? HL_SHADING_PHONG : HL_SHADING_NONE;
    stage_add_directional(&set, (vec3){-3, -1, -2});
    set.scene.render.kernel = n % 5 == 0 ? HL_KERNEL_LINEAR : HL_KERNEL_BSPLINE;
    assert_same_in_pages(&set, 1 + n % 4, "shape");
    stage_close(&set);
  }
}

static void test_instruction_sets(void **state) {
  (void)state;
  for (int n = 0; n < 3 * HL_INSTRUCTION_SET_AVX512_VBMI; n++) {
    hl_instruction_set instructions = (hl_instruction_set)(HL_INSTRUCTION_SET_SCALAR + n / 3);
    if (!hl_cpu_has_instruction_set(instructions)) continue;
    stage set;
    open_with(&set, instructions);
    add_noise(&set, (const size_t[3]){40, 38, 33}, types[n % 3])->shading = HL_SHADING_PHONG;
    stage_add_point(&set, (vec3){14, -25, 30});
    assert_same_in_pages(&set, 3, hl_instruction_set_name(instructions));
    stage_close(&set);
  }
}

/* ---- by every way to draw ---- */

static void draw_hard_splat(stage *set) {
  set_method(set, HL_SHADOWS_HARD, HL_SOFT_CASCADE);
  set->scene.render.reconstruction = HL_RECONSTRUCTION_SPLAT;
}
static void draw_sky(stage *set) {
  draw_gradient_opacity(set);
  set->scene.sky.type = HL_SKY_UNIFORM;
  for (int c = 0; c < 3; c++) set->scene.sky.color[c] = 0.7;
}
/* In some cells, single voxels have visible values, but the values that the kernel reconstructs are
 * invisible. */
static void draw_noise_under_a_sky(stage *set) {
  static const hl_opacity_point opacity[] = {{0.6, 0}, {0.9, 0.9}};
  set->scene.sky.type = HL_SKY_UNIFORM;
  for (int c = 0; c < 3; c++) set->scene.sky.color[c] = 0.7;
  set->volumes[0].transfer_function.opacity = opacity;
  set->volumes[0].transfer_function.opacity_count = 2;
}
static void draw_scattering(stage *set) {
  draw_gradient_opacity(set);
  set->volumes[0].shading = HL_SHADING_NONE;
  set->volumes[0].multiple_scattering = 1;
}
static void draw_clipped(stage *set) {
  set->volumes[0].clipped = 1;
  for (int a = 0; a < 3; a++) {
    set->volumes[0].clip_min[a] = -7.3;
    set->volumes[0].clip_max[a] = 8.1;
  }
}
static void draw_two(stage *set) {
  set_method(set, HL_SHADOWS_SOFT, HL_SOFT_CASCADE);
  add_noise(set, (const size_t[3]){13, 40, 9}, HL_VOXEL_F32);
}

static const way ways[] = {{"hard, splat", draw_hard_splat},
                           {"paper", draw_paper},
                           {"cascade", draw_cascade},
                           {"sublights", draw_sublights},
                           {"maximum", draw_maximum},
                           {"gradient opacity", draw_gradient_opacity},
                           {"sky", draw_sky},
                           {"sky over noise", draw_noise_under_a_sky},
                           {"scattering", draw_scattering},
                           {"clipped", draw_clipped},
                           {"isosurface", draw_isosurface},
                           {"two volumes", draw_two}};

static void test_ways(void **state) {
  (void)state;
  for (size_t n = 0; n < sizeof ways / sizeof *ways; n++) {
    stage set;
    stage_open(&set);
    hl_scene_volume *volume = add_noise(&set, (const size_t[3]){37, 29, 34}, types[n % 3]);
    volume->shading = HL_SHADING_PHONG;
    set_soft_edge(volume);
    set.scene.camera.type = HL_CAMERA_PERSPECTIVE;
    set.scene.camera.fovy_deg = 40;
    stage_add_directional(&set, (vec3){-1, 0.5, -1})->angular_diameter_deg = 10;
    stage_add_point(&set, (vec3){14, 25, 30})->radius = 3;
    ways[n].draw(&set);
    assert_same_in_pages(&set, 2 + (int)n % 3, ways[n].name);
    stage_close(&set);
  }
}

/* ---- memory ---- */

/* Leaves room for LEAST_PAGES pages alone, as if pages of other volumes took the rest of the limit. */
static void leave_no_room(hl_context *context) {
  context->options.memory_limit = (uint64_t)1 << 40;
  atomic_store(&context->paged, (uint64_t)1 << 40);
}

static void make_room_again(hl_context *context) {
  assert_int_equal(atomic_load(&context->paged), (uint64_t)1 << 40);
  atomic_store(&context->paged, 0);
}

/* Returns how many bytes of a mapping are in memory, by the system's own count. */
static size_t resident_bytes(const unsigned char *mapping) {
  FILE *maps = fopen("/proc/self/smaps", "r");
  char line[512];
  bool found = false;
  size_t kilobytes = SIZE_MAX;
  assert_non_null(maps);
  while (kilobytes == SIZE_MAX && fgets(line, sizeof line, maps) != NULL) {
    unsigned long long begin, end;
    if (sscanf(line, "%llx-%llx ", &begin, &end) == 2) found = begin == (uintptr_t)mapping;
    else if (found) sscanf(line, "Rss: %zu kB", &kilobytes);
  }
  fclose(maps);
  assert_true(kilobytes != SIZE_MAX);
  return kilobytes * 1024;
}

static void assert_held(const hl_pages *pages, size_t most) {
  uint64_t held = 0;
  for (size_t n = 0; n < pages->count[0] * pages->count[1] * pages->count[2]; n++)
    held += pages->state[n] == PAGE_FORGOTTEN ? 0 : pages->page_bytes;
  assert_int_equal(held, pages->held_bytes);
  assert_in_range(held, 0, most * pages->page_bytes);
}

/* If there is room for few pages, few pages are in memory, and the voxels stay the same. After all pages are
 * forgotten, no page is in memory.
 */
static void test_few_pages(void **state) {
  (void)state;
  enum { WIDE = 40 };
  hl_context *context = NULL;
  assert_int_equal(hl_context_create(NULL, &context, NULL), HL_OK);
  hl_volume *packed = packed_volume(context, (const size_t[3]){WIDE, WIDE, WIDE}, HL_VOXEL_F32);
  leave_no_room(context);
  hl_volume *paged = in_pages(context, packed, 3);
  const hl_pages *pages = paged->pages;
  for (int round = 0; round < 2; round++) {
    for (size_t v = 0; v < (size_t)WIDE * WIDE * WIDE; v++) {
      size_t i = v % WIDE, j = v / WIDE % WIDE, k = v / WIDE / WIDE;
      assert_true(hl_volume_value(paged, i, j, k) == hl_volume_value(packed, i, j, k));
    }
    assert_held(pages, LEAST_PAGES);
    hl_pages_forget(pages);
    assert_held(pages, 0);
    assert_int_equal(resident_bytes(pages->mapping), 0);
  }
  hl_volume_release(packed);
  hl_volume_release(paged);
  make_room_again(context);
  assert_int_equal(hl_context_memory_held(context), 0);
  hl_context_destroy(context);
}

/* Passes over 8 million voxels leave only a bounded number of bytes in memory. */
static void test_resident_bytes(void **state) {
  (void)state;
  enum { WIDE = 200, WINDOW = 1 << 16, ROWS_AND_HALF = 5 * WIDE / 2 };
  hl_context *context = NULL;
  hl_volume_description grid;
  hl_pages *pages;
  static unsigned char slice[WIDE * WIDE], row[WIDE];
  assert_int_equal(hl_context_create(NULL, &context, NULL), HL_OK);
  leave_no_room(context);
  hl_volume_description_defaults(&grid);
  grid.type = HL_VOXEL_U8;
  for (int a = 0; a < 3; a++) grid.dimensions[a] = WIDE;
  assert_int_equal(hl_pages_create(context, "/tmp", &grid, PAGE_SHIFT, &pages, NULL), HL_OK);
  for (size_t k = 0; k < WIDE; k++) {
    memset(slice, (int)k, sizeof slice);
    /* each piece has whole rows and a part of a row */
    for (size_t done = 0; done < sizeof slice; done += ROWS_AND_HALF)
      hl_pages_store(pages, k * sizeof slice + done, ROWS_AND_HALF, slice);
  }
  static uint64_t counts[256];
  assert_true(hl_pages_take_counts(pages, counts));
  for (size_t k = 0; k < 256; k++) assert_int_equal(counts[k], k < WIDE ? WIDE * WIDE : 0);
  assert_false(hl_pages_take_counts(pages, counts));
  size_t most = LEAST_PAGES * (pages->page_bytes + 2 * WINDOW);
  assert_in_range(resident_bytes(pages->mapping), 1, most);
  for (size_t k = 0; k < WIDE; k++)
    for (size_t j = 0; j < WIDE; j++) {
      hl_pages_load_row(pages, j, k, row);
      assert_int_equal(row[j], k);
    }
  assert_in_range(resident_bytes(pages->mapping), 1, most);
  hl_pages_release(pages);
  make_room_again(context);
  hl_context_destroy(context);
}

/* Renders on several threads while pages come and go. */
static void test_pictures_of_few_pages(void **state) {
  (void)state;
  enum { MOST_THREADS = 64 }; /* each thread may hold one page beyond the limit for a moment */
  for (size_t n = 0; n < 4; n++) {
    stage set;
    stage_open(&set);
    hl_scene_volume *volume = add_noise(&set, (const size_t[3]){40, 38, 39}, types[n % 3]);
    volume->shading = HL_SHADING_PHONG;
    stage_add_directional(&set, (vec3){-1, 0.5, -1})->angular_diameter_deg = 10;
    ways[n].draw(&set);
    leave_no_room(set.context);
    assert_same_in_pages(&set, 2 + (int)n % 2, ways[n].name);
    assert_held(set.volumes[0].volume->pages, LEAST_PAGES + MOST_THREADS);
    stage_close(&set);
  }
}

/* ---- memory that a frame allocates ---- */

static void *(*plain_allocate)(void *, size_t, size_t);
/* the greatest sum of blocks and pages in memory, at the times when a block was allocated */
static uint64_t most_in_memory;

static void *watch_allocation(void *user_data, size_t size, size_t alignment) {
  hl_context *context = user_data;
  uint64_t bytes = atomic_load(&context->held) + atomic_load(&context->paged);
  if (bytes > most_in_memory) most_in_memory = bytes;
  return plain_allocate(user_data, size, alignment);
}

static void render_size(stage *set, hl_renderer *renderer, int side) {
  static float pixels[160 * 160 * 4];
  hl_scene *scene = NULL;
  set->scene.width = set->scene.height = side;
  assert_int_equal(hl_scene_create(set->context, &set->scene, &scene, NULL), HL_OK);
  assert_int_equal(hl_renderer_render(renderer, scene, pixels, (size_t)side * 4, NULL, NULL), HL_OK);
  hl_scene_release(scene);
}

/* Pages that fill the memory are forgotten before a larger frame takes its memory. */
static void test_pages_make_room(void **state) {
  (void)state;
  enum { SMALL = 16, LARGE = 160, PAGE_SIZES = 125 /* pages */, SLACK = 64 << 10 };
  uint64_t limit = 0;
  for (int round = 0; round < 2; round++) { /* the first frame finds how much memory the larger frame takes */
    stage set;
    hl_renderer *renderer = NULL;
    stage_open(&set);
    set.scene.render.threads = 1;
    hl_volume *packed = add_noise(&set, (const size_t[3]){40, 40, 40}, HL_VOXEL_F32)->volume;
    set.volumes[0].volume = in_pages(set.context, packed, 3);
    hl_volume_release(packed);
    stage_add_directional(&set, (vec3){-1, 0.5, -1})->angular_diameter_deg = 10;
    plain_allocate = set.context->options.allocate;
    set.context->options.allocate = watch_allocation;
    set.context->options.user_data = set.context;
    set.context->options.memory_limit = limit;
    assert_int_equal(hl_renderer_create(set.context, &renderer, NULL), HL_OK);
    render_size(&set, renderer, SMALL);
    const hl_pages *pages = set.volumes[0].volume->pages;
    assert_int_equal(atomic_load(&set.context->paged), PAGE_SIZES * pages->page_bytes);
    most_in_memory = 0;
    render_size(&set, renderer, LARGE);
    if (round == 1) assert_in_range(most_in_memory, limit / 2, limit + SLACK);
    else limit = hl_context_memory_peak(set.context) + PAGE_SIZES / 2 * pages->page_bytes;
    hl_renderer_destroy(renderer);
    stage_close(&set);
  }
}

static void assert_starts(const char *text, const char *start) {
  if (strncmp(text, start, strlen(start)) != 0) fail_msg("\"%s\" does not begin with \"%s\"", text, start);
}

static void test_no_room(void **state) {
  (void)state;
  hl_context *context = NULL;
  hl_error error = {0};
  hl_pages *pages = NULL;
  hl_volume_description grid;
  hl_volume_description_defaults(&grid);
  grid.type = HL_VOXEL_U8;
  for (int a = 0; a < 3; a++) grid.dimensions[a] = 10;
  assert_int_equal(hl_context_create(NULL, &context, NULL), HL_OK);
  assert_int_equal(hl_pages_create(context, "/nowhere", &grid, PAGE_SHIFT, &pages, &error), HL_ERROR_MEMORY);
  assert_starts(error.message, "/nowhere: no scratch file of 0.0 MiB for a volume larger than memory: ");
  for (int a = 0; a < 3; a++) grid.dimensions[a] = (size_t)1 << 20; /* an exbibyte */
  assert_int_equal(hl_pages_create(context, "/tmp", &grid, PAGE_SHIFT, &pages, &error), HL_ERROR_MEMORY);
  assert_starts(error.message, "/tmp: no scratch file of ");
  assert_null(pages);
  assert_int_equal(hl_context_memory_held(context), 0);
  hl_context_destroy(context);
}

/* ---- other values than the voxels' ---- */

/* In volumes in pages, values that are not finite are replaced, and the interpolating kernel's coefficients
 * are computed, as in volumes in memory. */
static void test_other_values(void **state) {
  (void)state;
  static const size_t sizes[][3] = {{40, 38, 39}, {9, 9, 2}, {12, 9, 1}, {4, 30, 21}};
  for (size_t n = 0; n < 4 * 5; n++) {
    stage set;
    stage_open(&set);
    set.context->options.scratch_folder = "/tmp";
    bool interpolates = n / 4 > 0, not_finite = n / 4 % 4 == 0;
    add_noise(&set, sizes[n % 4], not_finite ? HL_VOXEL_F32 : types[n / 4 - 1]);
    if (not_finite) stage_spoil(&set);
    if (interpolates) set.scene.render.kernel = HL_KERNEL_INTERPOLATING;
    set.volumes[0].shading = HL_SHADING_PHONG;
    stage_add_directional(&set, (vec3){-1, 0.5, -1});
    if (n % 4 == 0) leave_no_room(set.context);
    assert_same_in_pages(&set, 2 + (int)n % 3, interpolates ? "interpolating" : "not finite");
    stage_close(&set);
  }
}

static void assert_frame_refused(stage *set, const char *message) {
  static float pixels[16 * 16 * 4];
  hl_error error = {0};
  hl_scene *scene = NULL;
  hl_renderer *renderer = NULL;
  assert_int_equal(hl_scene_create(set->context, &set->scene, &scene, NULL), HL_OK);
  assert_int_equal(hl_renderer_create(set->context, &renderer, NULL), HL_OK);
  assert_int_equal(hl_renderer_render(renderer, scene, pixels, 16 * 4, NULL, &error), HL_ERROR_UNSUPPORTED);
  assert_string_equal(error.message, message);
  hl_renderer_destroy(renderer);
  hl_scene_release(scene);
}

static void test_no_scratch_folder(void **state) {
  (void)state;
  stage set;
  stage_open(&set);
  add_noise(&set, (const size_t[3]){9, 9, 9}, HL_VOXEL_F32);
  hl_volume *old = set.volumes[0].volume;
  set.volumes[0].volume = in_pages(set.context, old, 2);
  hl_volume_release(old);
  set.scene.render.kernel = HL_KERNEL_INTERPOLATING;
  assert_frame_refused(
      &set, "values of a volume larger than memory: they need a scratch folder, or a higher memory limit");
  stage_close(&set);
}

/* The frame is refused before memory is allocated or voxels are read: the volume has no voxels. */
static void test_too_many_bricks(void **state) {
  (void)state;
  hl_context *context = NULL;
  hl_error error = {0};
  assert_int_equal(hl_context_create(NULL, &context, NULL), HL_OK);
  hl_volume volume = {.context = context, .dimension = {8192, 8192, 4096}};
  const hl_scene_volume shown = {.volume = &volume};
  const grid_source source = {.volume = &shown, .kernel = hl_kernel_get(HL_KERNEL_BSPLINE)};
  grid grid;
  assert_int_equal(hl_grid_create(context, NULL, NULL, &source, &grid, &error), HL_ERROR_UNSUPPORTED);
  assert_string_equal(error.message,
                      "a volume of 8192 x 8192 x 4096 voxels has 4.3e+09 bricks of 4 x 4 x 4 "
                      "cells, and 4294967295 can be numbered");
  assert_int_equal(hl_context_memory_held(context), 0);
  hl_context_destroy(context);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_voxels),
                                     cmocka_unit_test(test_shapes),
                                     cmocka_unit_test(test_instruction_sets),
                                     cmocka_unit_test(test_ways),
                                     cmocka_unit_test(test_few_pages),
                                     cmocka_unit_test(test_resident_bytes),
                                     cmocka_unit_test(test_pictures_of_few_pages),
                                     cmocka_unit_test(test_pages_make_room),
                                     cmocka_unit_test(test_no_room),
                                     cmocka_unit_test(test_other_values),
                                     cmocka_unit_test(test_no_scratch_folder),
                                     cmocka_unit_test(test_too_many_bricks)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
