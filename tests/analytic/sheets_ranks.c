/* analytic/sheets_ranks.c - volumes over the ranks of an MPI job give the bytes of volumes in memory, on
 * every rank, whatever blocks the ranks hold, by every method of shadows. The script over_ranks.sh runs this
 * program. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include <cmocka.h>

#include "core/context.h"
#include "ranks/ranks.h"
#include "reference_stage.h"
#include "volume/store/gathered.h"
#include "volume/store/pages.h"

enum { SIDE = 24, FLOATS = SIDE * SIDE * 4, MOST_VOXELS = 40 * 40 * 40 };

static hl_context *context; /* the context of all volumes over ranks */
static hl_ranks *ranks;

/* ---- a volume's blocks ---- */

/* a seed with which part_of() gives each rank its share of whole slices, in the order of ranks */
enum { BY_SLICES = 1u << 31 };

/* Cuts a box into as many parts as there are ranks, by repeated cuts along changing axes at random places.
 * Returns the part of a rank. Parts may be empty. */
static hl_box part_of(const size_t n[3], int rank, int size, unsigned seed) {
  hl_box box = {{0, 0, 0}, {n[0], n[1], n[2]}};
  if (seed == BY_SLICES) {
    box.begin[2] = hl_ranks_part(ranks, n[2], rank);
    box.count[2] = hl_ranks_part(ranks, n[2], rank + 1) - box.begin[2];
    return box;
  }
  for (int first = 0, count = size; count > 1; seed = seed * 1664525u + 1013904223u) {
    int axis = (int)(seed >> 8) % 3, before = count / 2;
    uint64_t cut = box.count[axis] * ((seed >> 16) % 7 + 1) / 8;
    if (rank < first + before) {
      box.count[axis] = cut;
      count = before;
    } else {
      box.begin[axis] += cut;
      box.count[axis] -= cut;
      first += before;
      count -= before;
    }
  }
  return box;
}

/* The memory of this rank's own block. */
typedef struct held_block {
  hl_block block;
  unsigned char *memory;
} held_block;

/* How a block lies in memory: packed, with ghost layers, or with ghost layers and gaps between all voxels. */
enum { PACKED = 0, WITH_GHOSTS = 1, WITH_GAPS = 2, LAYOUTS = 3 };

static held_block hold_block(const hl_volume *volume, const hl_box *box, int layout) {
  size_t bytes = hl_storage_bytes(volume->storage), step = layout == WITH_GAPS ? 3 * bytes : bytes;
  held_block held = {.block = {.struct_size = sizeof held.block}};
  size_t around[3], count = step;
  for (int a = 0; a < 3; a++) {
    held.block.offset[a] = box->begin[a];
    held.block.size[a] = box->count[a];
    held.block.ghost[a] = layout == PACKED ? 0 : (size_t)a + 1;
    around[a] = box->count[a] + 2 * held.block.ghost[a];
    held.block.stride_bytes[a] = (ptrdiff_t)count;
    count *= around[a];
  }
  held.memory = malloc(count + 1);
  /* if bytes of ghost layers or gaps were read, the picture would change */
  memset(held.memory, 0xa5, count + 1);
  for (size_t k = 0; k < box->count[2]; k++)
    for (size_t j = 0; j < box->count[1]; j++)
      for (size_t i = 0; i < box->count[0]; i++) {
        const size_t at[3] = {i, j, k};
        unsigned char *to = held.memory;
        for (int a = 0; a < 3; a++) to += (at[a] + held.block.ghost[a]) * (size_t)held.block.stride_bytes[a];
        const unsigned char *row = hl_volume_row(volume, j + box->begin[1], k + box->begin[2]);
        memcpy(to, row + (i + box->begin[0]) * bytes, bytes);
      }
  held.block.voxels = held.memory;
  if (layout != WITH_GAPS) memset(held.block.stride_bytes, 0, sizeof held.block.stride_bytes);
  return held;
}

/* Makes a copy of a volume that lies over the ranks, with small pages. *held: this rank's block, to be
 * released after the volume. */
static hl_volume *over_ranks(const hl_volume *volume, const hl_box *box, int layout, int shift,
                             held_block *held) {
  hl_volume_description whole = stage_describe_volume(volume);
  hl_own_voxels *own = NULL;
  hl_volume *made = NULL;
  *held = hold_block(volume, box, layout);
  if (shift == PAGE_SHIFT) {
    assert_int_equal(hl_volume_create_over_ranks(ranks, &whole, &held->block, &made, NULL), HL_OK);
    return made;
  }
  assert_int_equal(hl_own_voxels_borrow(ranks, &whole, &held->block, &own, NULL), HL_OK);
  assert_int_equal(hl_volume_over_ranks(ranks, &whole, own, shift, "test", &made, NULL), HL_OK);
  return made;
}

/* Renders a scene with its volumes in memory, and then over ranks. */
static void assert_same(stage *set, int shift, unsigned seed, const char *what) {
  static float packed[FLOATS], shared[FLOATS];
  held_block held[STAGE_VOLUMES];
  set->scene.width = set->scene.height = SIDE;
  set->scene.render.shadow_resolution = 32;
  set->scene.render.light_samples = 4;
  stage_render_sheets(set, packed);
  for (size_t v = 0; v < set->scene.volume_count; v++) {
    hl_volume *old = set->volumes[v].volume;
    hl_box box = part_of(old->dimension, hl_ranks_rank(ranks), hl_ranks_size(ranks), seed + (unsigned)v);
    set->volumes[v].volume = over_ranks(old, &box, (int)((seed + v) % LAYOUTS), shift, &held[v]);
    hl_volume_release(old);
  }
  stage_render_sheets(set, shared);
  bool any = false;
  for (int i = 0; i < FLOATS; i++) {
    any |= packed[i] > 0;
    if (packed[i] != shared[i])
      fail_msg("%s, rank %d: pixel %d, %d: %.9g in memory, %.9g over ranks", what, hl_ranks_rank(ranks),
               i / 4 % SIDE, i / 4 / SIDE, (double)packed[i], (double)shared[i]);
  }
  assert_true(any);
  for (size_t v = 0; v < set->scene.volume_count; v++) {
    hl_volume_release(set->volumes[v].volume);
    free(held[v].memory);
  }
  set->scene.volume_count = 0; /* the stage has already released the volume */
  stage_close(set);
}

/* ---- voxels ---- */

static const hl_voxel_type types[] = {HL_VOXEL_U8, HL_VOXEL_U16, HL_VOXEL_F32};
static const size_t shapes[][3] = {{1, 1, 1}, {2, 3, 1}, {3, 29, 5}, {5, 6, 7}, {19, 1, 23}, {15, 16, 17}};
enum { SHAPES = sizeof shapes / sizeof *shapes };

static hl_volume *noisy_volume(const size_t n[3], hl_voxel_type type) {
  static unsigned char voxels[MOST_VOXELS * sizeof(double)];
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

/* A volume over ranks has the same voxels and statistics as the volume in memory, for blocks of every shape
 * and layout. */
static void test_voxels(void **state) {
  (void)state;
  for (int n = 0; n < 3 * SHAPES; n++) {
    const size_t *size = shapes[n % SHAPES];
    hl_volume *packed = noisy_volume(size, types[n % 3]);
    hl_box box = part_of(size, hl_ranks_rank(ranks), hl_ranks_size(ranks), (unsigned)n);
    held_block held;
    hl_volume *shared = over_ranks(packed, &box, n % LAYOUTS, n % 4 == 0 ? PAGE_SHIFT : 2 + n % 3, &held);
    for (size_t v = 0; v < size[0] * size[1] * size[2]; v++) {
      size_t i = v % size[0], j = v / size[0] % size[1], k = v / size[0] / size[1];
      assert_true(hl_volume_value(shared, i, j, k) == hl_volume_value(packed, i, j, k));
    }
    static const double percents[] = {0, 1, 37, 50, 99.9, 100};
    double expected[6], found[6];
    assert_int_equal(hl_volume_percentiles(packed, percents, 6, expected, NULL), HL_OK);
    assert_int_equal(hl_volume_percentiles(shared, percents, 6, found, NULL), HL_OK);
    assert_memory_equal(found, expected, sizeof found);
    assert_memory_equal(shared->histogram, packed->histogram, sizeof shared->histogram);
    assert_true(shared->minimum == packed->minimum && shared->maximum == packed->maximum);
    assert_true(fabs(shared->mean - packed->mean) <= 1e-14 * fabs(packed->mean));
    hl_volume_release(packed);
    hl_volume_release(shared);
    free(held.memory);
  }
}

/* In a label map over ranks with 64-bit numbers that floats would round, the labels and the voxels of the
 * copy in memory are exact, for blocks of any shape. */
static void test_label_shapes(void **state) {
  (void)state;
  static int64_t voxels[MOST_VOXELS];
  static const int64_t labels[] = {0, -614454278, 614454277, 614454278, (int64_t)1 << 62};
  for (int n = 0; n < SHAPES; n++) {
    const size_t *size = shapes[n];
    hl_box box = part_of(size, hl_ranks_rank(ranks), hl_ranks_size(ranks), (unsigned)n);
    hl_volume_description whole;
    hl_volume_description_defaults(&whole);
    memcpy(whole.dimensions, size, sizeof whole.dimensions);
    whole.type = HL_VOXEL_I64;
    hl_block block = {.struct_size = sizeof block, .voxels = voxels};
    for (int a = 0; a < 3; a++) {
      block.offset[a] = box.begin[a];
      block.size[a] = box.count[a];
    }
    for (size_t v = 0; v < box.count[0] * box.count[1] * box.count[2]; v++) {
      size_t i = box.begin[0] + v % box.count[0], j = box.begin[1] + v / box.count[0] % box.count[1],
             k = box.begin[2] + v / box.count[0] / box.count[1];
      voxels[v] = labels[(i + 2 * j + 3 * k) % 5];
    }
    hl_volume *map = NULL, *copy = NULL;
    hl_label *found = NULL;
    size_t count = 0;
    assert_int_equal(hl_volume_create_over_ranks(ranks, &whole, &block, &map, NULL), HL_OK);
    assert_int_equal(hl_labels_of_volume(context, map, NULL, &found, &count, NULL), HL_OK);
    for (size_t c = 1; c < count; c++) assert_true(found[c - 1].value < found[c].value);
    if (size[0] * size[1] * size[2] > 20) assert_int_equal(count, 4);
    assert_int_equal(hl_volume_in_memory(map, &copy, NULL), HL_OK);
    for (size_t v = 0; v < size[0] * size[1] * size[2]; v++) {
      size_t i = v % size[0], j = v / size[0] % size[1], k = v / size[0] / size[1];
      int64_t value;
      assert_int_equal(hl_volume_whole(copy, i, j, k, &value), HL_WHOLE_FOUND);
      assert_true(value == labels[(i + 2 * j + 3 * k) % 5]);
    }
    hl_labels_release(context, found);
    hl_volume_release(map);
  }
}

/* ---- pictures ---- */

/* Adds noise in a box of 20 units around the origin, seen obliquely. */
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

static void test_shapes(void **state) {
  (void)state;
  for (int n = 0; n < SHAPES; n++) {
    stage set;
    stage_open(&set);
    set.scene.render.threads = 1;
    add_noise(&set, shapes[n], types[n % 3])->shading = n % 2 ? HL_SHADING_PHONG : HL_SHADING_NONE;
    stage_add_directional(&set, (vec3){-3, -1, -2});
    set.scene.render.kernel = n % 5 == 0 ? HL_KERNEL_LINEAR : HL_KERNEL_BSPLINE;
    assert_same(&set, 2 + n % 3, (unsigned)n, "shape");
  }
}

static void draw_hard(stage *set) { set->scene.render.shadows = HL_SHADOWS_HARD; }
static void draw_splat(stage *set) { set->scene.render.reconstruction = HL_RECONSTRUCTION_SPLAT; }
static void draw_soft(stage *set, hl_soft_method method) {
  set->scene.render.shadows = HL_SHADOWS_SOFT;
  set->scene.render.soft_method = method;
}
static void draw_paper(stage *set) { draw_soft(set, HL_SOFT_PAPER); }
static void draw_cascade(stage *set) { draw_soft(set, HL_SOFT_CASCADE); }
static void draw_sublights(stage *set) { draw_soft(set, HL_SOFT_SUBLIGHTS); }
static void draw_two(stage *set) {
  draw_cascade(set);
  add_noise(set, (const size_t[3]){13, 40, 9}, HL_VOXEL_F32);
}
static void draw_scattering(stage *set) {
  set->volumes[0].shading = HL_SHADING_NONE;
  set->volumes[0].multiple_scattering = 1;
}

static void (*const ways[])(stage *set) = {draw_hard,      draw_splat, draw_paper,     draw_cascade,
                                           draw_sublights, draw_two,   draw_scattering};

/* Pictures under four lights, one of them within a block, have the same bytes by every method. */
static void test_ways(void **state) {
  (void)state;
  for (size_t n = 0; n < sizeof ways / sizeof *ways; n++) {
    stage set;
    stage_open(&set);
    set.scene.render.threads = 1;
    add_noise(&set, (const size_t[3]){23, 29, 19}, types[n % 3])->shading = HL_SHADING_PHONG;
    set.scene.camera.type = HL_CAMERA_PERSPECTIVE;
    set.scene.camera.fovy_deg = 40;
    stage_add_directional(&set, (vec3){-1, 0.5, -1})->angular_diameter_deg = 10;
    stage_add_directional(&set, (vec3){0, 0, -1}); /* this light shines along the faces of blocks */
    stage_add_point(&set, (vec3){14, 25, 30})->radius = 3;
    stage_add_point(&set, (vec3){1.5, -2.5, 3.5})->radius = 1;
    ways[n](&set);
    assert_same(&set, 4, 7 * (unsigned)n, "way");
  }
}

/* One visible voxel lies where the blocks of eight ranks meet, or where the blocks of all ranks meet if there
 * are fewer. */
static void test_corner(void **state) {
  (void)state;
  enum { N = 16 };
  for (int corner = 0; corner < 8; corner++) {
    static float voxels[N * N * N];
    memset(voxels, 0, sizeof voxels);
    size_t at = (size_t)(8 - (corner & 1)) + N * (size_t)(8 - (corner >> 1 & 1)) +
                N * N * (size_t)(8 - (corner >> 2 & 1));
    voxels[at] = 1;
    stage set;
    stage_open(&set);
    stage_add_grid(&set, (const size_t[3]){N, N, N}, (const double[3]){1, 1, 1}, (vec3){-8, -8, -8}, voxels);
    stage_look(&set, (vec3){3, 4, 20}, (vec3){0, 0, 0}, (vec3){0, 1, 0});
    stage_add_directional(&set, (vec3){-1, -1, -1});
    static float packed[FLOATS], shared[FLOATS];
    set.scene.width = set.scene.height = SIDE;
    set.scene.render.threads = 1;
    stage_render_sheets(&set, packed);
    hl_volume *old = set.volumes[0].volume;
    int rank = hl_ranks_rank(ranks);
    bool used = hl_ranks_size(ranks) >= 8 ? rank < 8 : rank == 0;
    size_t side = hl_ranks_size(ranks) >= 8 ? N / 2 : N, n = used ? side : 0;
    size_t low = hl_ranks_size(ranks) >= 8 ? N / 2 : 0;
    hl_box box = {
        {used ? low * (rank & 1) : 0, used ? low * (rank >> 1 & 1) : 0, used ? low * (rank >> 2 & 1) : 0},
        {n, n, n}};
    held_block held;
    set.volumes[0].volume = over_ranks(old, &box, WITH_GHOSTS, 3, &held);
    hl_volume_release(old);
    stage_render_sheets(&set, shared);
    assert_memory_equal(shared, packed, sizeof packed);
    float most = 0;
    for (int i = 0; i < FLOATS; i++) most = fmaxf(most, shared[i]);
    assert_true(most > 0);
    stage_close(&set);
    free(held.memory);
  }
}

/* ---- memory ---- */

/* Renders on several threads while pages come and go. There is room for LEAST_PAGES pages alone. */
static void test_few_pages(void **state) {
  (void)state;
  context->options.memory_limit = (uint64_t)1 << 40;
  atomic_store(&context->paged, (uint64_t)1 << 40);
  for (unsigned n = 0; n < 2; n++) {
    stage set;
    stage_open(&set);
    set.scene.render.threads = 4;
    add_noise(&set, (const size_t[3]){30, 28, 29}, types[n])->shading = HL_SHADING_PHONG;
    stage_add_directional(&set, (vec3){-1, 0.5, -1})->angular_diameter_deg = 10;
    ways[n == 1 ? 3 : 0](&set);
    assert_same(&set, hl_ranks_size(ranks) == 1 ? 2 : 3, n, "few pages");
  }
  assert_int_equal(atomic_load(&context->paged), (uint64_t)1 << 40);
  atomic_store(&context->paged, 0);
  context->options.memory_limit = 0;
}

/* ---- other values than the voxels' ---- */

static void test_other_values(void **state) {
  (void)state;
  static const size_t sizes[][3] = {{23, 21, 25}, {9, 11, 3}, {12, 9, 1}};
  for (int n = 0; n < 5; n++) {
    stage set;
    stage_open(&set);
    set.scene.render.threads = 1;
    add_noise(&set, sizes[n % 3], n % 3 == 2 ? HL_VOXEL_U16 : HL_VOXEL_F32)->shading = HL_SHADING_PHONG;
    stage_add_directional(&set, (vec3){-1, 0.5, -1});
    if (n % 3 != 2) stage_spoil(&set);
    if (n > 1) set.scene.render.kernel = HL_KERNEL_INTERPOLATING;
    assert_same(&set, 3, n > 1 ? (unsigned)BY_SLICES : (unsigned)n, n > 1 ? "interpolating" : "not finite");
  }
}

/* ---- calls that are refused on all ranks ---- */

static void test_coefficients_refused(void **state) {
  (void)state;
  static float pixels[16 * 16 * 4];
  stage set;
  if (hl_ranks_size(ranks) == 1) return; /* a single rank has all slices */
  stage_open(&set);
  add_noise(&set, (const size_t[3]){8, 8, 8}, HL_VOXEL_U16);
  set.scene.render.kernel = HL_KERNEL_INTERPOLATING;
  set.scene.width = set.scene.height = 16;
  hl_volume *old = set.volumes[0].volume;
  hl_box all = {{0, 0, 0}, {8, 8, 8}}, none = {{0, 0, 0}, {0, 0, 0}};
  held_block held;
  set.volumes[0].volume = over_ranks(old, hl_ranks_rank(ranks) == 0 ? &all : &none, PACKED, 3, &held);
  hl_volume_release(old);
  hl_scene *scene = NULL;
  hl_renderer *renderer = NULL;
  hl_error error = {0};
  assert_int_equal(hl_scene_create(set.context, &set.scene, &scene, NULL), HL_OK);
  assert_int_equal(hl_renderer_create(set.context, &renderer, NULL), HL_OK);
  assert_int_equal(hl_renderer_render(renderer, scene, pixels, 16 * 4, NULL, &error), HL_ERROR_UNSUPPORTED);
  assert_string_equal(error.message,
                      "the interpolating kernel needs, of a volume over ranks, whole slices in "
                      "the order of the ranks: take another kernel");
  hl_renderer_destroy(renderer);
  hl_scene_release(scene);
  stage_close(&set);
  free(held.memory);
}

static void assert_refused(const size_t offset[3], const size_t size[3], const char *part_of_message) {
  static const unsigned char voxels[4 * 4 * 4];
  hl_volume_description whole;
  hl_volume *volume = NULL;
  hl_error error = {0};
  hl_volume_description_defaults(&whole);
  for (int a = 0; a < 3; a++) whole.dimensions[a] = 4;
  hl_block block = {.struct_size = sizeof block, .voxels = voxels};
  memcpy(block.offset, offset, sizeof block.offset);
  memcpy(block.size, size, sizeof block.size);
  assert_int_equal(hl_volume_create_over_ranks(ranks, &whole, &block, &volume, &error), HL_ERROR_ARGUMENT);
  if (strstr(error.message, part_of_message) == NULL)
    fail_msg("\"%s\" has no \"%s\"", error.message, part_of_message);
  assert_null(volume);
}

static void test_refused(void **state) {
  (void)state;
  size_t layer = hl_ranks_rank(ranks) == 0 ? 4 : 0;
  assert_refused((const size_t[3]){0, 0, 0}, (const size_t[3]){4, 4, layer == 0 ? 0 : 3},
                 "the ranks hold 48 of the volume's 64 voxels");
  assert_refused((const size_t[3]){0, 0, layer == 0 ? 0 : 1}, (const size_t[3]){4, 4, layer},
                 "rank 0 holds 4 x 4 x 4 voxels from 0, 0, 1 on: they reach beyond the volume");
  assert_refused((const size_t[3]){0, 0, 0}, (const size_t[3]){5, 1, 1},
                 "larger than the volume along axis 0");
  if (hl_ranks_size(ranks) > 1)
    assert_refused((const size_t[3]){0, 0, 0}, (const size_t[3]){4, 4, 4},
                   "rank 1 holds 4 x 4 x 4 voxels from 0, 0, 0 on: another rank holds some of them, too");
}

/* ---- times: no test ---- */

static int compare_doubles(const void *a, const void *b) {
  double x = *(const double *)a, y = *(const double *)b;
  return x < y ? -1 : x > y;
}

/* Prints the time in which rank 0 gets a page of 67^3 voxels, from another rank if there is one.
 */
static void print_times(void) {
  enum { N = 258, PAGES = 4 * 4 * 4, ROUNDS = 20, MEASURED = PAGES * ROUNDS };
  static double seconds[MEASURED];
  bool holds = hl_ranks_rank(ranks) == hl_ranks_size(ranks) - 1;
  unsigned char *voxels = calloc(holds ? (size_t)N * N * N : 1, 1);
  hl_volume_description whole;
  hl_volume *volume = NULL;
  hl_volume_description_defaults(&whole);
  hl_block block = {.struct_size = sizeof block, .voxels = voxels};
  for (int a = 0; a < 3; a++) {
    whole.dimensions[a] = N;
    block.size[a] = holds ? N : 0;
  }
  assert_int_equal(hl_volume_create_over_ranks(ranks, &whole, &block, &volume, NULL), HL_OK);
  for (size_t n = 0; n < MEASURED && hl_ranks_rank(ranks) == 0; n++) {
    if (n % PAGES == 0) hl_pages_forget(volume->pages);
    struct timespec begin, end;
    clock_gettime(CLOCK_MONOTONIC, &begin);
    assert_true(hl_volume_value(volume, n % 4 * 64, n / 4 % 4 * 64, n / 16 % 4 * 64) == 0);
    clock_gettime(CLOCK_MONOTONIC, &end);
    seconds[n] = (double)(end.tv_sec - begin.tv_sec) + 1e-9 * (double)(end.tv_nsec - begin.tv_nsec);
  }
  qsort(seconds, MEASURED, sizeof *seconds, compare_doubles);
  if (hl_ranks_rank(ranks) == 0)
    printf("a page of %zu bytes: least %.0f us, median %.0f us\n", volume->pages->page_bytes,
           1e6 * seconds[0], 1e6 * seconds[MEASURED / 2]);
  hl_volume_release(volume);
  free(voxels);
}

/* Joins all processes, or the communicator of a program that has started MPI itself. */
static hl_status join(bool by_communicator, mpi *mpi, hl_error *error) {
  int given = 0;
  if (!by_communicator) return hl_ranks_join(context, NULL, &ranks, error);
  hl_status status = hl_mpi_load(context->options.mpi, mpi, error);
  if (status != HL_OK || hl_mpi_init_thread(mpi, MPI_MULTIPLE, &given) != 0) return HL_ERROR_IO;
  context->options.mpi = HL_MPI_AUTO; /* the library of MPI that this process has already loaded */
  void *world = mpi->calls == hl_mpich.calls ? (void *)(intptr_t)mpi->world.number : mpi->world.address;
  return hl_ranks_join(context, world, &ranks, error);
}

/* Makes a context that uses the launcher's library of MPI. */
static hl_status make_context(hl_error *error) {
  hl_context_options options;
  hl_context_options_defaults(&options);
  options.mpi = getenv("OMPI_COMM_WORLD_SIZE") != NULL ? HL_MPI_OPEN_MPI : HL_MPI_MPICH;
  return hl_context_create(&options, &context, error);
}

/* usage: sheets_ranks [TESTS [communicator]]: runs the tests whose names match; --time: prints times. */
int main(int count, char **arguments) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_voxels),       cmocka_unit_test(test_label_shapes),
      cmocka_unit_test(test_shapes),       cmocka_unit_test(test_ways),
      cmocka_unit_test(test_corner),       cmocka_unit_test(test_few_pages),
      cmocka_unit_test(test_other_values), cmocka_unit_test(test_coefficients_refused),
      cmocka_unit_test(test_refused)};
  hl_error error = {0};
  mpi mpi;
  bool by_communicator = count > 2;
  if (make_context(&error) != HL_OK || join(by_communicator, &mpi, &error) != HL_OK) {
    fprintf(stderr, "%s\n", error.message);
    return 1;
  }
  if (count > 1 && strcmp(arguments[1], "--time") == 0) {
    print_times();
    hl_ranks_leave(ranks);
    hl_context_destroy(context);
    return 0;
  }
  if (count > 1) cmocka_set_test_filter(arguments[1]);
  int failed = cmocka_run_group_tests(tests, NULL, NULL);
  /* other ranks may wait for messages of this rank, which has skipped the rest of its test */
  if (failed) hl_ranks_abort(ranks, 1);
  hl_ranks_leave(ranks);
  if (by_communicator) hl_mpi_finalize(&mpi);
  if (hl_context_memory_held(context) != 0) failed = 1;
  hl_context_destroy(context);
  return failed;
}
