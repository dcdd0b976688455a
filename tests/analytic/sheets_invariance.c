/* analytic/sheets_invariance.c - pictures do not depend on threads, instruction sets, earlier frames or
 * interruptions. */
#include <setjmp.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "core/context.h"
#include "reference_stage.h"
#include "volume/volume.h"

enum { MOST_SIDE = 96, MOST_FLOATS = MOST_SIDE * MOST_SIDE * 4 };

/* ---- a context that counts and can be told to stop ---- */

typedef struct watch {
  atomic_int allocations;
  int reports; /* the number of reports of the stage "render" in this picture */
  int allocations_at_report;
  int allocations_in_loop; /* the number of allocations between two reports of the sheet loop */
  double last_fraction;
  int falls; /* the number of reports whose fraction is smaller than the fraction of the report before */
  /* the picture's number of sweeps; each has a loop and an equal share of the fraction */
  int sweeps;
  int questions, cancel_after; /* the number of cancel questions; the question from which on the answer is
                                  "stop", 0: never */
} watch;

static void *watched_allocate(void *data, size_t size, size_t alignment) {
  atomic_fetch_add(&((watch *)data)->allocations, 1);
  return aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
}

static void watched_release(void *data, void *memory) {
  (void)data;
  free(memory);
}

/* Returns the number of the sweep whose share of the picture contains a fraction. */
static int share_of(const watch *w, double fraction) { return (int)(fraction * w->sweeps + 1e-9); }

static void watched_progress(void *data, const char *name, double fraction) {
  watch *w = data;
  if (strcmp(name, "render") != 0) return;
  int allocations = atomic_load(&w->allocations);
  /* Two fractions below 1 in one sweep's share are reports of one sheet loop. Nothing may be allocated
   * between two such reports. */
  if (w->reports > 0 && fraction < 1 && share_of(w, fraction) == share_of(w, w->last_fraction))
    w->allocations_in_loop += allocations - w->allocations_at_report;
  w->falls += fraction < w->last_fraction;
  w->allocations_at_report = allocations;
  w->last_fraction = fraction;
  w->reports++;
}

static int watched_cancelled(void *data) {
  watch *w = data;
  return w->cancel_after > 0 && ++w->questions > w->cancel_after;
}

static void open_watched(stage *set, watch *w, hl_instruction_set instructions) {
  hl_context_options options;
  hl_context_options_defaults(&options);
  memset(w, 0, sizeof *w);
  options.user_data = w;
  options.allocate = watched_allocate;
  options.release = watched_release;
  options.progress = watched_progress;
  options.cancelled = watched_cancelled;
  options.instruction_set = instructions;
  stage_open_with(set, &options);
}

/* ---- scenes ---- */

static const hl_opacity_point SOFT_EDGE[] = {{0, 0}, {0.35, 0}, {0.6, 0.7}, {1, 0.9}};
static const hl_color_point WARM[] = {{0, {0.2, 0.3, 0.9}}, {0.5, {0.9, 0.4, 0.2}}, {1, {1, 0.9, 0.6}}};

static const float QUARTERS[2 * 2 * 3] = {1, 0.2f, 0, 0.1f, 1, 0.9f, 1, 1, 1, 0, 0.5f, 1};

static hl_scene_volume *add_noise(stage *set, size_t n, vec3 corner, hl_voxel_type type) {
  float *voxels = malloc(n * n * n * sizeof *voxels);
  assert_non_null(voxels);
  for (size_t i = 0; i < n * n * n; i++) {
    double x = (double)(i % n), y = (double)(i / n % n), z = (double)(i / n / n), r = (double)(n - 1) / 2;
    double d = ((x - r) * (x - r) + (y - r) * (y - r) + (z - r) * (z - r)) / (r * r);
    voxels[i] = (float)fmax(0, 1 - d) * (0.5f + stage_noise(x / 3, y / 3, z / 3));
    if (voxels[i] > 1) voxels[i] = 1;
  }
  set->type = type;
  hl_scene_volume *volume = stage_add_grid(set, (size_t[3]){n, n, n}, (double[3]){1, 1, 1}, corner, voxels);
  free(voxels);
  volume->transfer_function.opacity = SOFT_EDGE;
  volume->transfer_function.opacity_count = sizeof SOFT_EDGE / sizeof *SOFT_EDGE;
  volume->transfer_function.color = WARM;
  volume->transfer_function.color_count = sizeof WARM / sizeof *WARM;
  volume->shading = HL_SHADING_PHONG;
  return volume;
}

static void build_scene(stage *set, hl_shadows shadows, hl_soft_method method, hl_reconstruction way) {
  set->scene.render.shadows = shadows;
  set->scene.render.soft_method = method;
  set->scene.render.reconstruction = way;
  set->scene.width = 44;
  set->scene.height = 30;
  set->scene.camera.type = HL_CAMERA_PERSPECTIVE;
  set->scene.camera.fovy_deg = 40;
  stage_look(set, (vec3){30, -25, 20}, (vec3){0, 0, 0}, (vec3){0, 0, 1});
  add_noise(set, 15, (vec3){-9, -8, -8}, HL_VOXEL_U8);
  add_noise(set, 8, (vec3){-1, -2, -1}, HL_VOXEL_F32)->attenuation_color[0] = 0.3;
  stage_add_directional(set, (vec3){-1, 0.5, -1})->angular_diameter_deg = 12;
  stage_add_directional(set, (vec3){1, 1, 0.2})->angular_diameter_deg =
      5; /* this light has a sweep of its own */
  hl_light *projector = stage_add_point(set, (vec3){25, 5, 30});
  projector->radius = 3;
  stage_set_texture(projector, 2, 2, QUARTERS, (vec3){12, 2, 15}, (vec3){3, 4, -2}, (vec3){1, -3, 4});
  set->scene.ambient[1] = 0.2;
}

typedef struct setting {
  const char *name;
  hl_shadows shadows;
  hl_soft_method method;
  hl_reconstruction way;
} setting;

static const setting SETTINGS[] = {
    {"off", HL_SHADOWS_OFF, HL_SOFT_CASCADE, HL_RECONSTRUCTION_GATHER},
    {"hard, gather", HL_SHADOWS_HARD, HL_SOFT_CASCADE, HL_RECONSTRUCTION_GATHER},
    {"hard, splat", HL_SHADOWS_HARD, HL_SOFT_CASCADE, HL_RECONSTRUCTION_SPLAT},
    {"paper, gather", HL_SHADOWS_SOFT, HL_SOFT_PAPER, HL_RECONSTRUCTION_GATHER},
    {"cascade, gather", HL_SHADOWS_SOFT, HL_SOFT_CASCADE, HL_RECONSTRUCTION_GATHER},
    {"cascade, splat", HL_SHADOWS_SOFT, HL_SOFT_CASCADE, HL_RECONSTRUCTION_SPLAT},
    {"sublights, gather", HL_SHADOWS_SOFT, HL_SOFT_SUBLIGHTS, HL_RECONSTRUCTION_GATHER},
};
enum { SETTING_COUNT = sizeof SETTINGS / sizeof *SETTINGS };

static void build_setting(stage *set, int index) {
  build_scene(set, SETTINGS[index].shadows, SETTINGS[index].method, SETTINGS[index].way);
}

static hl_renderer *create_renderer(stage *set) {
  hl_renderer *renderer = NULL;
  assert_int_equal(hl_renderer_create(set->context, &renderer, NULL), HL_OK);
  return renderer;
}

static size_t picture_floats(const stage *set) {
  return (size_t)set->scene.width * (size_t)set->scene.height * 4;
}

static void assert_same(const float *a, const float *b, size_t floats, const char *what, int setting_index) {
  size_t differing = 0;
  for (size_t i = 0; i < floats; i++) differing += memcmp(&a[i], &b[i], sizeof(float)) != 0;
  if (differing > 0)
    fail_msg("%s: %zu of %zu values differ (%s)", what, differing, floats, SETTINGS[setting_index].name);
}

static void assert_shows_something(const float *pixels, size_t floats) {
  double sum = 0;
  for (size_t i = 0; i < floats; i += 4) sum += pixels[i + 3];
  assert_true(sum > 0.05 * (double)floats / 4);
}

/* ---- the same bytes ---- */

static void test_threads(void **state) {
  (void)state;
  static float one[MOST_FLOATS], more[MOST_FLOATS];
  for (int index = 0; index < SETTING_COUNT; index++) {
    stage set;
    stage_open(&set);
    build_setting(&set, index);
    set.scene.render.threads = 1;
    stage_render_sheets(&set, one);
    assert_shows_something(one, picture_floats(&set));
    for (int threads = 2; threads <= 7; threads += 5) {
      set.scene.render.threads = threads;
      stage_render_sheets(&set, more);
      assert_same(one, more, picture_floats(&set), "threads", index);
    }
    stage_close(&set);
  }
}

/* Pictures have the same bytes with several numbers of slabs at once and with one to seven threads, with hard
 * shadows and with the cascade. */
static void test_stretches(void **state) {
  (void)state;
  static float one[MOST_FLOATS], more[MOST_FLOATS];
  static const int slabs[] = {1, 2, 8, 32};
  for (int index = 0; index < SETTING_COUNT; index++) {
    stage set;
    stage_open(&set);
    build_setting(&set, index);
    set.scene.render.threads = 1;
    set.scene.render.slabs_at_once = 1;
    stage_render_sheets(&set, one);
    for (int i = 0; i < 4; i++)
      for (int threads = 1; threads <= 7; threads += index == 1 || index == 4 ? 1 : 2) {
        set.scene.render.slabs_at_once = slabs[i];
        set.scene.render.threads = threads;
        stage_render_sheets(&set, more);
        assert_same(one, more, picture_floats(&set), "slabs at once", index);
      }
    stage_close(&set);
  }
}

/* Threads wait once for each range of slabs with hard shadows, and three times for each slab if no slab can
 * be worked on ahead. */
static void test_waits(void **state) {
  (void)state;
  static float pixels[MOST_FLOATS];
  uint64_t waits[2];
  for (int i = 0; i < 2; i++) {
    stage set;
    stage_open(&set);
    build_setting(&set, 1);
    set.scene.light_count = 1;
    set.scene.render.threads = 2;
    set.scene.render.slabs_at_once = i == 0 ? 1 : 8;
    hl_render_statistics counted = stage_render_counted(&set, pixels);
    uint64_t slabs = (uint64_t)counted.sheets - 1;
    assert_int_equal(counted.sweeps, 1);
    waits[i] = counted.waits;
    assert_true(waits[i] <= (i == 0 ? 2 * slabs : (slabs + 7) / 8 + 1));
    stage_close(&set);
  }
  assert_true(waits[0] > 4 * waits[1] && waits[1] > 1);
}

static void test_instruction_sets(void **state) {
  (void)state;
  static float scalar[MOST_FLOATS], other[MOST_FLOATS];
  if (hl_cpu_best_instruction_set() == HL_INSTRUCTION_SET_SCALAR) skip();
  for (int index = 0; index < SETTING_COUNT; index++)
    for (int set_index = HL_INSTRUCTION_SET_SCALAR; set_index <= HL_INSTRUCTION_SET_AVX512_VBMI;
         set_index++) {
      if (!hl_cpu_has_instruction_set((hl_instruction_set)set_index)) continue;
      stage set;
      watch w;
      open_watched(&set, &w, (hl_instruction_set)set_index);
      assert_int_equal(hl_context_instruction_set(set.context), set_index);
      build_setting(&set, index);
      set.scene.render.threads = 1;
      stage_render_sheets(&set, set_index == HL_INSTRUCTION_SET_SCALAR ? scalar : other);
      if (set_index != HL_INSTRUCTION_SET_SCALAR)
        assert_same(scalar, other, picture_floats(&set),
                    hl_instruction_set_name((hl_instruction_set)set_index), index);
      stage_close(&set);
    }
}

/* Makes a volume that borrows voxels with gaps between rows and between slices. The gaps hold bytes that are
 * not finite floats, and nothing follows the last row. *memory: the caller frees it. */
static hl_volume *with_gaps(hl_context *context, const hl_volume *volume, void **memory) {
  const size_t *n = volume->dimension, bytes = hl_storage_bytes(volume->storage);
  size_t row = (n[0] + 3) * bytes, slice = (n[1] + 2) * row, end = n[0] * bytes;
  size_t whole = (n[2] - 1) * slice + (n[1] - 1) * row + end;
  hl_volume_info info = {.struct_size = sizeof info};
  assert_int_equal(hl_volume_get_info(volume, &info), HL_OK);
  hl_volume_description description;
  hl_volume_description_defaults(&description);
  description.type = volume->type;
  description.value_scale = volume->value_scale;
  description.value_offset = volume->value_offset;
  description.voxels = *memory = memset(malloc(whole), 0xff, whole);
  description.borrow = 1;
  for (size_t a = 0; a < 3; a++) {
    description.dimensions[a] = n[a];
    description.stride_bytes[a] = (ptrdiff_t)(const size_t[]){bytes, row, slice}[a];
    description.origin[a] = info.origin[a];
    for (size_t b = 0; b < 3; b++) description.axis[a][b] = info.direction[b][a] * info.spacing[a];
  }
  for (size_t j = 0; j < n[1] * n[2]; j++)
    memcpy((char *)*memory + j / n[1] * slice + j % n[1] * row, hl_volume_row(volume, j % n[1], j / n[1]),
           end);
  hl_volume *made = NULL;
  assert_int_equal(hl_volume_create(context, &description, &made, NULL), HL_OK);
  assert_ptr_equal(made->voxels, *memory);
  return made;
}

/* Borrowed rows of voxels with gaps give the bytes of packed rows. */
static void test_rows_that_lie_apart(void **state) {
  (void)state;
  static float packed[MOST_FLOATS], apart[MOST_FLOATS];
  static const hl_voxel_type types[] = {HL_VOXEL_U8, HL_VOXEL_U16, HL_VOXEL_F32};
  for (int n = 0; n < 3 * HL_INSTRUCTION_SET_AVX512_VBMI; n++) {
    hl_instruction_set instructions = (hl_instruction_set)(HL_INSTRUCTION_SET_SCALAR + n / 3);
    if (!hl_cpu_has_instruction_set(instructions)) continue;
    stage set;
    watch w;
    open_watched(&set, &w, instructions);
    build_setting(&set, 4);
    add_noise(&set, 9, (vec3){-5, 1, 2}, types[n % 3]);
    stage_render_sheets(&set, packed);
    void *memory[STAGE_VOLUMES];
    for (size_t v = 0; v < set.scene.volume_count; v++) {
      hl_volume *old = set.volumes[v].volume;
      set.volumes[v].volume = with_gaps(set.context, old, &memory[v]);
      hl_volume_release(old);
    }
    stage_render_sheets(&set, apart);
    assert_same(packed, apart, picture_floats(&set), "rows that lie apart", 4);
    size_t count = set.scene.volume_count;
    stage_close(&set);
    for (size_t v = 0; v < count; v++) free(memory[v]);
  }
}

/* Renders a scene again: by the same renderer, by a new renderer, and by a renderer whose buffers another
 * scene of another size has used. */
static void test_history(void **state) {
  (void)state;
  static float first[MOST_FLOATS], again[MOST_FLOATS];
  for (int index = 0; index < SETTING_COUNT; index++) {
    stage set, other;
    stage_open(&set);
    build_setting(&set, index);
    set.scene.render.threads = 2;
    hl_renderer *renderer = create_renderer(&set);
    stage_render_with(&set, renderer, first);
    stage_render_with(&set, renderer, again);
    assert_same(first, again, picture_floats(&set), "rerun", index);

    stage_open(&other);
    hl_context *own = other.context;
    other.context = set.context; /* the other scene's volumes live in the renderer's context */
    build_setting(&other, (index + 2) % SETTING_COUNT);
    other.scene.width = 33;
    other.scene.height = 91;
    other.volumes[0].transfer_function.unit_distance = 3;
    stage_look(&other, (vec3){-30, -15, 30}, (vec3){0, 0, 0}, (vec3){0, 0, 1});
    stage_render_with(&other, renderer, again);
    stage_render_with(&set, renderer, again);
    assert_same(first, again, picture_floats(&set), "after another scene", index);
    hl_volume_release(other.volumes[0].volume);
    other.scene.volume_count = other.scene.light_count = 1; /* fewer volumes and lights */
    other.volumes[0] = other.volumes[1];
    stage_render_with(&other, renderer, again);
    stage_render_with(&set, renderer, again);
    assert_same(first, again, picture_floats(&set), "after a smaller scene", index);
    hl_volume_release(other.volumes[0].volume);
    hl_renderer_destroy(renderer);
    stage_render_sheets(&set, again);
    assert_same(first, again, picture_floats(&set), "a fresh renderer", index);
    hl_context_destroy(own);
    stage_close(&set);
  }
}

/* One renderer makes pictures of many sizes. Each picture has the bytes of a new renderer's picture. */
static void test_sizes(void **state) {
  (void)state;
  static const int sizes[][2] = {{1, 1}, {96, 7}, {16, 16}, {17, 65}, {8, 8}, {64, 48}};
  static float fresh[MOST_FLOATS], reused[MOST_FLOATS];
  for (int index = 1; index < SETTING_COUNT; index += 3) {
    stage set;
    stage_open(&set);
    build_setting(&set, index);
    hl_renderer *renderer = create_renderer(&set);
    for (size_t s = 0; s < sizeof sizes / sizeof *sizes; s++) {
      set.scene.width = sizes[s][0];
      set.scene.height = sizes[s][1];
      stage_render_with(&set, renderer, reused);
      stage_render_sheets(&set, fresh);
      assert_same(fresh, reused, picture_floats(&set), "size", index);
    }
    hl_renderer_destroy(renderer);
    stage_close(&set);
  }
}

/* A small picture of fine voxels is the mean of a large one, so that no voxel falls between pixels. A picture
 * of 12 pixels over a grid of 36 voxels is rendered with three pixels in place of one. */
static void test_small_pictures_are_averaged(void **state) {
  (void)state;
  enum { WIDTH = 12, HEIGHT = 10, SIDE = 3 };
  static float small[WIDTH * HEIGHT * 4], large[WIDTH * HEIGHT * SIDE * SIDE * 4];
  stage set;
  stage_open(&set);
  add_noise(&set, 33, (vec3){-16.5, -16.5, -16.5}, HL_VOXEL_U8);
  stage_add_directional(&set, (vec3){-1, 0.5, -1});
  stage_look(&set, (vec3){30, -25, 20}, (vec3){0, 0, 0}, (vec3){0, 0, 1});
  set.scene.camera.height = HEIGHT * SIDE;
  set.scene.width = WIDTH;
  set.scene.height = HEIGHT;
  stage_render_sheets(&set, small);
  assert_shows_something(small, picture_floats(&set));
  set.scene.width *= SIDE;
  set.scene.height *= SIDE;
  stage_render_sheets(&set, large);
  for (int y = 0; y < HEIGHT; y++)
    for (int x = 0; x < WIDTH * 4; x++) {
      double sum = 0;
      for (int i = 0; i < SIDE * SIDE; i++)
        sum += large[((y * SIDE + i / SIDE) * WIDTH * SIDE + x / 4 * SIDE + i % SIDE) * 4 + x % 4];
      double mean = sum / (SIDE * SIDE), value = small[y * WIDTH * 4 + x];
      if (fabs(value - mean) > 1e-6) fail_msg("%.9g at %d,%d is not the mean %.9g", value, x / 4, y, mean);
    }
  stage_close(&set);
}

/* The reference averages as many rays in a pixel as the sheets average pixels. One ray through each pixel's
 * centre would make another picture. Two volumes overlap. */
static void test_reference_of_small_pictures(void **state) {
  (void)state;
  enum { SIDE = 24 };
  static float sheets[SIDE * SIDE * 4], mean[SIDE * SIDE * 4], centres[SIDE * SIDE * 4];
  for (int orthographic = 0; orthographic < 2; orthographic++) {
    stage set;
    stage_open(&set);
    add_noise(&set, 33, (vec3){-16.5, -16.5, -16.5}, HL_VOXEL_U8);
    add_noise(&set, 25, (vec3){-4.5, -2.5, -12.5}, HL_VOXEL_U8);
    stage_add_directional(&set, (vec3){-1, 0.5, -1});
    set.scene.render.shadows = HL_SHADOWS_OFF;
    stage_look(&set, (vec3){60, -50, 40}, (vec3){0, 0, 0}, (vec3){0, 0, 1});
    if (!orthographic) set.scene.camera.type = HL_CAMERA_PERSPECTIVE;
    set.scene.camera.fovy_deg = 36;
    set.scene.camera.height = 3 * SIDE;
    set.scene.width = set.scene.height = SIDE;
    hl_reference_options options;
    hl_reference_options_defaults(&options);
    stage_render(&set, &options, centres);
    options.rays = 0;
    stage_render(&set, &options, mean);
    stage_render_sheets(&set, sheets);
    stage_close(&set);
    double with_mean = 0, with_centres = 0;
    for (int i = 0; i < SIDE * SIDE * 4; i++) {
      with_mean = fmax(with_mean, fabs((double)sheets[i] - (double)mean[i]));
      with_centres = fmax(with_centres, fabs((double)sheets[i] - (double)centres[i]));
    }
    print_message(
        "# a small picture against the reference: greatest difference %.4f, of one ray a pixel %.4f\n",
        with_mean, with_centres);
    assert_true(with_mean < 0.01);
    assert_true(with_centres > 0.1);
  }
}

/* ---- memory and interruptions ---- */

static int count_sweeps(stage *set) {
  static float pixels[MOST_FLOATS];
  hl_renderer *renderer = create_renderer(set);
  hl_scene *scene = NULL;
  hl_render_statistics statistics = {.struct_size = sizeof statistics};
  assert_int_equal(hl_scene_create(set->context, &set->scene, &scene, NULL), HL_OK);
  assert_int_equal(
      hl_renderer_render(renderer, scene, pixels, 4 * (size_t)set->scene.width, &statistics, NULL), HL_OK);
  hl_scene_release(scene);
  hl_renderer_destroy(renderer);
  return statistics.sweeps;
}

/* The reported fraction of a picture rises to 1 over all sweeps. Nothing is allocated in a sweep's loop. */
static void test_reports_of_the_loop(void **state) {
  (void)state;
  static float pixels[MOST_FLOATS];
  int most_sweeps = 0;
  for (int index = 0; index < SETTING_COUNT; index++) {
    stage set;
    watch w;
    open_watched(&set, &w, HL_INSTRUCTION_SET_AUTO);
    build_setting(&set, index);
    w.sweeps = count_sweeps(&set);
    if (w.sweeps > most_sweeps) most_sweeps = w.sweeps;
    w.reports = w.falls = w.allocations_in_loop = 0;
    w.last_fraction = 0;
    atomic_store(&w.allocations, 0);
    stage_render_sheets(&set, pixels);
    assert_true(w.reports >= 4);
    assert_true(atomic_load(&w.allocations) > 10);
    assert_int_equal(w.allocations_in_loop, 0);
    assert_int_equal(w.falls, 0);
    assert_true(w.last_fraction == 1);
    stage_close(&set); /* fails if memory is still held */
  }
  assert_true(most_sweeps > 1);
}

static void test_cancel(void **state) {
  (void)state;
  static float expected[MOST_FLOATS], pixels[MOST_FLOATS];
  for (int index = 0; index < SETTING_COUNT; index++) {
    stage set;
    watch w;
    open_watched(&set, &w, HL_INSTRUCTION_SET_AUTO);
    build_setting(&set, index);
    stage_render_sheets(&set, expected);
    hl_renderer *renderer = create_renderer(&set);
    hl_scene *scene = NULL;
    hl_error error = {0};
    assert_int_equal(hl_scene_create(set.context, &set.scene, &scene, &error), HL_OK);
    for (int after = 1; after <= 3; after++) {
      w.questions = 0;
      w.cancel_after = after;
      assert_int_equal(hl_renderer_render(renderer, scene, pixels, 4 * (size_t)set.scene.width, NULL, &error),
                       HL_ERROR_CANCELLED);
      assert_int_equal(error.code, HL_ERROR_CANCELLED);
      w.cancel_after = 0;
      stage_render_with(&set, renderer, pixels);
      assert_same(expected, pixels, picture_floats(&set), "after a cancelled one", index);
    }
    hl_scene_release(scene);
    hl_renderer_destroy(renderer);
    stage_close(&set);
  }
}

/* Only the picture's part of each row is written. A picture of whole tiles, which is made in the caller's
 * memory, has the bytes of a picture that is made in the renderer's memory. */
static void test_row_stride(void **state) {
  (void)state;
  static _Alignas(64) float packed[MOST_FLOATS];
  static float wide[2 * MOST_FLOATS];
  stage set;
  stage_open(&set);
  build_setting(&set, 1);
  set.scene.width = 96;
  set.scene.height = 64;
  stage_render_sheets(&set, packed);
  hl_scene *scene = NULL;
  hl_renderer *renderer = create_renderer(&set);
  size_t row = 4 * (size_t)set.scene.width, stride = row + 5;
  memset(wide, 0x5a, sizeof wide);
  assert_int_equal(hl_scene_create(set.context, &set.scene, &scene, NULL), HL_OK);
  assert_int_equal(hl_renderer_render(renderer, scene, wide, stride, NULL, NULL), HL_OK);
  for (size_t y = 0; y < (size_t)set.scene.height; y++) {
    assert_memory_equal(&wide[y * stride], &packed[y * row], row * sizeof(float));
    for (size_t byte = 0; byte < 5 * sizeof(float); byte++)
      assert_int_equal(((unsigned char *)&wide[y * stride + row])[byte], 0x5a);
  }
  assert_int_equal(hl_renderer_render(renderer, scene, wide, row - 1, NULL, NULL), HL_ERROR_ARGUMENT);
  hl_scene_release(scene);
  hl_renderer_destroy(renderer);
  stage_close(&set);
}

/* With ambient light alone, the order of the sheets changes pixels by at most 1/2048 of the light, because
 * matter behind nearly opaque matter is left out. */
static void test_order_of_sheets(void **state) {
  (void)state;
  enum { WIDTH = 272, HEIGHT = 200, FLOATS = WIDTH * HEIGHT * 4 };
  float *of[2];
  uint64_t samples[2];
  for (int behind = 0; behind < 2; behind++) {
    stage set;
    of[behind] = malloc(FLOATS * sizeof *of[behind]);
    assert_non_null(of[behind]);
    stage_open(&set);
    vec3 eye = {30, -25, 20};
    set.scene.width = WIDTH;
    set.scene.height = HEIGHT;
    stage_look(&set, eye, (vec3){0, 0, 0}, (vec3){0, 0, 1});
    set.scene.camera.height = 14;
    set.scene.render.shadows = HL_SHADOWS_HARD;
    add_noise(&set, 24, (vec3){-18, -4, -20}, HL_VOXEL_U8)->shading = HL_SHADING_NONE;
    add_noise(&set, 10, (vec3){-1, -8, -1}, HL_VOXEL_F32)->shading = HL_SHADING_NONE;
    stage_add_directional(&set, behind ? eye : vec3_scale(eye, -1))->intensity = 0;
    for (int c = 0; c < 3; c++) set.scene.ambient[c] = 1;
    samples[behind] = stage_render_counted(&set, of[behind]).samples_shaded;
    stage_close(&set);
  }
  double greatest = 0;
  for (int i = 0; i < FLOATS; i++) greatest = fmax(greatest, fabs((double)of[0][i] - (double)of[1][i]));
  if (!(greatest <= 1.0 / 2048 + 1e-5)) fail_msg("pictures differ by %g", greatest);
  assert_true(samples[0] > 100000 && (double)samples[1] < 1.1 * (double)samples[0]);
  free(of[0]);
  free(of[1]);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_threads),
      cmocka_unit_test(test_stretches),
      cmocka_unit_test(test_waits),
      cmocka_unit_test(test_order_of_sheets),
      cmocka_unit_test(test_instruction_sets),
      cmocka_unit_test(test_rows_that_lie_apart),
      cmocka_unit_test(test_history),
      cmocka_unit_test(test_sizes),
      cmocka_unit_test(test_small_pictures_are_averaged),
      cmocka_unit_test(test_reference_of_small_pictures),
      cmocka_unit_test(test_reports_of_the_loop),
      cmocka_unit_test(test_cancel),
      cmocka_unit_test(test_row_stride),
  };
  return cmocka_run_group_tests_name("sheets_invariance", tests, NULL, NULL);
}
