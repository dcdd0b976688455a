/* unit/splat_sheet.c - the reconstruction on sheets: constants, ramps, gathering and splatting that agree,
 * kernels, views. */
#include <stdlib.h>
#include <string.h>

#include "../asserts.h"
#include "sheet_bench.h"

enum { SIDE = 48, SIDE_TILES = SIDE / TILE, ORIENTATIONS = 50 };

/* A view, and a normal of sheets at most about 50 degrees from it. Every third view is in perspective. */
static void look_at_random(bench *bench, uint32_t *seed, int round, double pixel, hl_kernel which) {
  vec3 direction = bench_random_direction(seed), normal = bench_random_normal(direction, seed);
  bench_look(bench, direction, normal, pixel, round % 3 == 2 ? 15 : 0, which);
}

/* [y][x] of a whole sheet, by way of tiles and blocks. */
static void fill_sheet(const fill_source *source, fill_tile_function *fill, float sheet[SIDE][SIDE]) {
  float density[TILE_PIXELS];
  for (int tile = 0; tile < SIDE_TILES * SIDE_TILES; tile++) {
    for (int i = 0; i < TILE_PIXELS; i++) density[i] = NAN;
    fill(source, tile % SIDE_TILES, tile / SIDE_TILES, ALL_BLOCKS, 0, density);
    for (int i = 0; i < TILE_PIXELS; i++) {
      int block = i / BLOCK_PIXELS, lane = i % BLOCK_PIXELS;
      sheet[tile / SIDE_TILES * TILE + block / 4 * BLOCK + lane / 4]
           [tile % SIDE_TILES * TILE + block % 4 * BLOCK + lane % 4] = density[i];
    }
  }
}

static bool inside(const bench *bench, vec3 p, double margin) {
  const double at[3] = {p.x, p.y, p.z};
  for (int a = 0; a < 3; a++)
    if (at[a] < margin - 0.5 || at[a] > bench->grid.dimension[a] - 0.5 - margin) return false;
  return true;
}

/* ---- the sheet of a known volume ---- */

typedef double expected_function(vec3 index);

static double constant_value(vec3 p) {
  (void)p;
  return 1;
}
static double ramp_value(vec3 p) { return 0.1 + 0.03 * p.x + 0.02 * p.y + 0.01 * p.z; }

/* Checks all pixels that are at least `margin` voxels inside, on all sheets, in many orientations, by
 * gathering and splatting. */
static void check_known(expected_function *expected, double margin, double tolerance, hl_kernel which) {
  enum { N = 12 };
  static float voxels[N * N * N], sheet[SIDE][SIDE];
  for (int i = 0; i < N * N * N; i++) voxels[i] = (float)expected((vec3){i % N, i / N % N, i / N / N});
  bench bench;
  bench_open(&bench, (size_t[3]){N, N, N}, HL_STORAGE_F32, voxels, bench_oblique_axes());
  uint32_t seed = 7 + (uint32_t)which;
  long checked = 0;
  for (int round = 0; round < ORIENTATIONS; round++) {
    look_at_random(&bench, &seed, round, 0.25, which);
    for (int way = 0; way < 2; way++) {
      int k = round % bench.sheets.count;
      fill_source source = bench_source(&bench, which, k);
      fill_sheet(&source, way == 0 ? hl_hot_scalar.fill->splat : hl_hot_scalar.fill->gather, sheet);
      for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++) {
          vec3 p = bench_position(&bench, k, x, y);
          if (!inside(&bench, p, margin)) continue;
          assert_near((double)sheet[y][x] + bench.grid.empty, expected(p), tolerance);
          checked++;
        }
    }
  }
  assert_true(checked > 10000);
  bench_close(&bench);
}

static void test_constant_stays_constant(void **state) {
  (void)state;
  for (int which = HL_KERNEL_BSPLINE; which <= HL_KERNEL_LINEAR; which++)
    check_known(constant_value, 0.001, 1e-3, (hl_kernel)which);
}

static void test_ramp_is_exact(void **state) {
  (void)state;
  check_known(ramp_value, 2.5, 1e-5, HL_KERNEL_BSPLINE);
  check_known(ramp_value, 2.5, 1e-5, HL_KERNEL_LINEAR);
}

/* ---- splat and gather ---- */

static void check_agreement(const size_t n[3], hl_storage storage, uint32_t seed) {
  static float f32[4096], splatted[SIDE][SIDE], gathered[SIDE][SIDE];
  static uint16_t u16[4096];
  static uint8_t u8[4096];
  size_t count = n[0] * n[1] * n[2];
  assert_true(count <= 4096);
  for (size_t i = 0; i < count; i++) {
    f32[i] = (float)bench_random(&seed);
    u16[i] = (uint16_t)(65536 * f32[i]);
    u8[i] = (uint8_t)(256 * f32[i]);
  }
  const void *voxels = storage == HL_STORAGE_U8    ? (void *)u8
                       : storage == HL_STORAGE_U16 ? (void *)u16
                                                   : (void *)f32;
  double scale = storage == HL_STORAGE_U8 ? 255 : storage == HL_STORAGE_U16 ? 65535 : 1;
  bench bench;
  bench_open(&bench, n, storage, voxels, bench_oblique_axes());
  for (int round = 0; round < 9; round++) {
    hl_kernel which = (hl_kernel)(round % 3);
    look_at_random(&bench, &seed, round / 3, 0.35, which);
    for (int k = 0; k < bench.sheets.count; k += 2) {
      fill_source source = bench_source(&bench, which, k);
      fill_sheet(&source, hl_hot_scalar.fill->splat, splatted);
      fill_sheet(&source, hl_hot_scalar.fill->gather, gathered);
      for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++) assert_near(splatted[y][x], gathered[y][x], 1e-5 * scale);
    }
  }
  bench_close(&bench);
}

static void test_splat_equals_gather(void **state) {
  (void)state;
  static const size_t sizes[][3] = {{11, 9, 13}, {4, 4, 4}, {5, 3, 7}, {1, 9, 8},
                                    {12, 1, 2},  {1, 1, 1}, {2, 2, 2}, {1, 1, 20}};
  for (size_t s = 0; s < sizeof sizes / sizeof *sizes; s++)
    for (int storage = HL_STORAGE_U8; storage <= HL_STORAGE_F32; storage++)
      check_agreement(sizes[s], (hl_storage)storage, (uint32_t)(31 * s + 5));
}

/* Blocks that are not needed are left alone, in either way. */
static void test_other_blocks_are_left_alone(void **state) {
  (void)state;
  static uint8_t voxels[8 * 8 * 8];
  for (int i = 0; i < 512; i++) voxels[i] = (uint8_t)(i * 37 + 1);
  bench bench;
  bench_open(&bench, (size_t[3]){8, 8, 8}, HL_STORAGE_U8, voxels, bench_oblique_axes());
  bench_look(&bench, (vec3){0, 0, 1}, (vec3){0, 0, 1}, 0.2, 0, HL_KERNEL_BSPLINE);
  fill_source source = bench_source(&bench, HL_KERNEL_BSPLINE, 2);
  for (int way = 0; way < 2; way++) {
    float density[TILE_PIXELS];
    for (int i = 0; i < TILE_PIXELS; i++) density[i] = -7;
    fill_tile_function *fill = way == 0 ? hl_hot_scalar.fill->splat : hl_hot_scalar.fill->gather;
    assert_int_equal(fill(&source, 1, 1, 0x8421, 0, density).filled, 0x8421);
    for (int i = 0; i < TILE_PIXELS; i++)
      assert_true((density[i] == -7) == !(0x8421 >> (i / BLOCK_PIXELS) & 1));
  }
  bench_close(&bench);
}

/* ---- the values that cells can reach, and the blocks that matter ---- */

enum { NOISE_SIDE = 14 };

static void fill_noise(uint8_t *voxels, uint32_t seed) {
  for (int i = 0; i < NOISE_SIDE * NOISE_SIDE * NOISE_SIDE; i++)
    voxels[i] = (uint8_t)(256 * bench_random(&seed));
}

static int32_t cell_pair(const grid *grid, double at, int axis) {
  double held = fmax(-1, fmin(at, grid->dimension[axis] * (1 - 1e-6)));
  return ((int32_t)floor(held) + 1) / HL_LOOKUP_CELLS;
}

/* Each density lies between the bounds of its cell. The bounds are far tighter than the range of the voxels.
 */
static void test_cells_bound_the_reconstruction(void **state) {
  (void)state;
  static uint8_t voxels[NOISE_SIDE * NOISE_SIDE * NOISE_SIDE];
  static float sheet[SIDE][SIDE];
  fill_noise(voxels, 71);
  bench bench;
  bench_open(&bench, (size_t[3]){NOISE_SIDE, NOISE_SIDE, NOISE_SIDE}, HL_STORAGE_U8, voxels,
             bench_oblique_axes());
  const grid *grid = &bench.grid;
  uint32_t seed = 5;
  double width = 0;
  long checked = 0;
  for (int round = 0; round < ORIENTATIONS; round++) {
    look_at_random(&bench, &seed, round, 0.3, HL_KERNEL_BSPLINE);
    fill_source source = bench_source(&bench, HL_KERNEL_BSPLINE, round % bench.sheets.count);
    fill_sheet(&source, hl_hot_scalar.fill->gather, sheet);
    for (int y = 0; y < SIDE; y++)
      for (int x = 0; x < SIDE; x++) {
        vec3 p = bench_position(&bench, round % bench.sheets.count, x, y);
        if (!inside(&bench, p, 0.001)) continue;
        const int32_t cell[3] = {cell_pair(grid, p.x, 0), cell_pair(grid, p.y, 1), cell_pair(grid, p.z, 2)};
        float low, high;
        hl_cell_bounds_at(grid, cell, &low, &high);
        double value = (double)sheet[y][x] + (double)grid->empty;
        assert_true(value >= (double)low - 1e-3 && value <= (double)high + 1e-3);
        width += (double)(high - low);
        checked++;
      }
  }
  assert_true(checked > 10000);
  if (!(width / (double)checked < 180)) fail_msg("bounds are %g apart", width / (double)checked);
  bench_close(&bench);
}

static size_t place_of(const int32_t count[3], int32_t x, int32_t y, int32_t z) {
  return ((size_t)z * (size_t)count[1] + (size_t)y) * (size_t)count[0] + (size_t)x;
}

/* The least and greatest of the voxels on which a cell depends. */
static void cell_extremes(const grid *grid, const int32_t cell[3], uint8_t extremes[2]) {
  extremes[0] = 255, extremes[1] = 0;
  for (int tap = 0; tap < CELL_TAPS * CELL_TAPS * CELL_TAPS; tap++) {
    const int32_t taps[3] = {tap % CELL_TAPS, tap / CELL_TAPS % CELL_TAPS, tap / CELL_TAPS / CELL_TAPS};
    int32_t v[3];
    for (int axis = 0; axis < 3; axis++) {
      v[axis] = 2 * cell[axis] - 2 + taps[axis];
      v[axis] = v[axis] < 0 ? 0 : v[axis] >= grid->dimension[axis] ? grid->dimension[axis] - 1 : v[axis];
    }
    uint8_t value = ((const uint8_t *)grid->voxels)[place_of(grid->dimension, v[0], v[1], v[2])];
    if (value < extremes[0]) extremes[0] = value;
    if (value > extremes[1]) extremes[1] = value;
  }
}

/* The answer of a look at the cells from one on, by the bits of cells. */
static int look_at_cells(const cell_lookup *lookup, const unsigned char *visible, const int32_t first[3]) {
  int bits = 0;
  for (int bit = 0; bit < 8; bit++)
    for (int32_t z = first[2]; z < first[2] + 2 + (bit >> 2) && z < lookup->count[2]; z++)
      for (int32_t y = first[1]; y < first[1] + 2 + (bit >> 1 & 1) && y < lookup->count[1]; y++)
        for (int32_t x = first[0]; x < first[0] + 2 + (bit & 1) && x < lookup->count[0]; x++)
          bits |= visible[place_of(lookup->count, x, y, z)] << bit;
  return bits;
}

/* Compares the bounds and look-ups of all cells with those of their voxels. Returns the number of cells that
 * show something. */
static long check_cells(const bench *bench) {
  static unsigned char visible[LOOKUP_SIZES][4096];
  const grid *grid = &bench->grid;
  const int32_t *count = grid->lookup[0].count;
  long shown = 0;
  memset(visible, 0, sizeof visible);
  for (int32_t z = 0; z < count[2]; z++)
    for (int32_t y = 0; y < count[1]; y++)
      for (int32_t x = 0; x < count[0]; x++) {
        uint8_t extremes[2];
        float low, high;
        cell_extremes(grid, (const int32_t[3]){x, y, z}, extremes);
        hl_cell_bounds_at(grid, (const int32_t[3]){x, y, z}, &low, &high);
        assert_true(low == (float)extremes[0] && high == (float)extremes[1]);
        size_t brick = place_of(grid->brick_count, x / 2, y / 2, z / 2);
        if (!grid->relevant[brick] || !hl_classifier_span_visible(&bench->classifier, grid, low, high))
          continue;
        visible[0][place_of(count, x, y, z)] = visible[1][brick] = 1;
        shown++;
      }
  for (int i = 0; i < LOOKUP_SIZES; i++) {
    const cell_lookup *lookup = &grid->lookup[i];
    for (int32_t z = 0; z < lookup->count[2]; z++)
      for (int32_t y = 0; y < lookup->count[1]; y++)
        for (int32_t x = 0; x < lookup->count[0]; x++)
          assert_int_equal(lookup->visible[place_of(lookup->count, x, y, z)],
                           look_at_cells(lookup, visible[i], (const int32_t[3]){x, y, z}));
  }
  return shown;
}

/* The bounds of even and of noisy bricks, whole or cut by the grid's end, and look-ups in them. */
static void test_cells_are_what_their_voxels_say(void **state) {
  (void)state;
  static const size_t sizes[][3] = {{13, 10, 17}, {8, 12, 5}, {30, 9, 11}, {1, 3, 2}, {16, 16, 16}};
  static const hl_opacity_point ramp[] = {{168, 0}, {170, 0.9}};
  for (size_t n = 0; n < sizeof sizes / sizeof *sizes; n++) {
    uint8_t voxels[16 * 16 * 16];
    const size_t *size = sizes[n];
    uint32_t seed = 90 + (uint32_t)n;
    for (size_t v = 0; v < size[0] * size[1] * size[2]; v++) {
      bool grainy = v % size[0] < size[0] / 2 && v / size[0] / size[1] <= size[2] / 2,
           full = v % size[0] == size[0] - 1;
      voxels[v] = grainy && bench_random(&seed) < 0.1 ? (uint8_t)(256 * bench_random(&seed)) : full ? 200 : 7;
    }
    bench bench;
    bench_open(&bench, size, HL_STORAGE_U8, voxels, bench_oblique_axes());
    hl_classifier_release(bench.context, &bench.classifier);
    hl_grid_release(bench.context, &bench.grid);
    bench.scene.transfer_function.opacity = ramp;
    bench.scene.transfer_function.opacity_count = 2;
    const grid_source source = {&bench.scene, hl_kernel_get(HL_KERNEL_LINEAR), affine3_identity(), 7};
    assert_int_equal(
        hl_grid_create(bench.context, bench.pool, hl_hot_scalar.grid, &source, &bench.grid, NULL), HL_OK);
    assert_int_equal(
        hl_classifier_create(bench.context, &bench.scene, NULL, &bench.grid, &bench.classifier, NULL), HL_OK);
    hl_grid_mark_relevant(&bench.grid, hl_hot_scalar.grid, &bench.classifier, bench.pool);
    assert_true(check_cells(&bench) > 0);
    bench_close(&bench);
  }
}

/* ---- bits of cells ---- */

static double held_voxel(const grid *grid, int32_t x, int32_t y, int32_t z) {
  int32_t at[3] = {x, y, z};
  for (int axis = 0; axis < 3; axis++)
    at[axis] = at[axis] < 0 ? 0 : at[axis] >= grid->dimension[axis] ? grid->dimension[axis] - 1 : at[axis];
  size_t place = place_of(grid->dimension, at[0], at[1], at[2]);
  return grid->storage == HL_STORAGE_U8    ? ((const uint8_t *)grid->voxels)[place]
         : grid->storage == HL_STORAGE_U16 ? ((const uint16_t *)grid->voxels)[place]
                                           : (double)((const float *)grid->voxels)[place];
}

/* Weights of four voxels in the Bezier points of the cubic B-spline's span between the second and the
 * third. */
static const double bezier[4][4] = {{1 / 6.0, 4 / 6.0, 1 / 6.0, 0},
                                    {0, 2 / 3.0, 1 / 3.0, 0},
                                    {0, 1 / 3.0, 2 / 3.0, 0},
                                    {0, 1 / 6.0, 4 / 6.0, 1 / 6.0}};

/* The greatest of the Bezier points of a span of four values. */
static double greatest_of_span(const double value[4]) {
  double greatest = -HUGE_VAL;
  for (int point = 0; point < 4; point++) {
    double sum = 0;
    for (int tap = 0; tap < 4; tap++) sum += value[tap] * bezier[point][tap];
    greatest = fmax(greatest, sum);
  }
  return greatest;
}

/* The bound, times `sign`, of the cell that begins at the point's whole coordinates: along z, then y, then x.
 */
static double bound_of_cell(const grid *grid, const int32_t floor[3], double sign) {
  double across[4];
  for (int a = 0; a < 4; a++) {
    double along_y[4];
    for (int b = 0; b < 4; b++) {
      double along_z[4];
      for (int c = 0; c < 4; c++)
        along_z[c] = sign * held_voxel(grid, floor[0] - 1 + a, floor[1] - 1 + b, floor[2] - 1 + c);
      along_y[b] = greatest_of_span(along_z);
    }
    across[a] = greatest_of_span(along_y);
  }
  return greatest_of_span(across);
}

/* The field at a point of that cell. */
static double value_in_cell(const grid *grid, const int32_t floor[3], const double phase[3]) {
  const kernel *kernel = hl_kernel_get(HL_KERNEL_BSPLINE);
  double sum = 0;
  for (int tap = 0; tap < 64; tap++) {
    const int32_t at[3] = {tap % 4 - 1, tap / 4 % 4 - 1, tap / 16 - 1};
    double weight = 1;
    for (int axis = 0; axis < 3; axis++) weight *= hl_kernel_value(kernel, at[axis] - phase[axis]);
    sum += weight * held_voxel(grid, floor[0] + at[0], floor[1] + at[1], floor[2] + at[2]);
  }
  return sum;
}

typedef struct bit_counts {
  long set, clear, near;
} bit_counts;

/* Each cell has a bit if its bound shows, and none if it does not, except for rounding. No point of a cell
 * without a bit shows. */
static bit_counts check_bits(const bench *bench, uint32_t *seed) {
  const grid *grid = &bench->grid;
  const classifier *classifier = &bench->classifier;
  double sign = classifier->scale > 0 ? 1 : -1, scale = (double)classifier->scale,
         blur = 0.2; /* table entries */
  bit_counts counts = {0};
  for (int32_t z = -1; z < grid->dimension[2]; z++)
    for (int32_t y = -1; y < grid->dimension[1]; y++)
      for (int32_t x = -1; x < grid->dimension[0]; x++) {
        const int32_t floor[3] = {x, y, z};
        uint64_t word = grid->cell_bits[place_of(grid->brick_count, (x + 1) / 4, (y + 1) / 4, (z + 1) / 4)];
        bool bit = word >> ((x + 1) % 4 + 4 * ((y + 1) % 4) + 16 * ((z + 1) % 4)) & 1;
        double greatest = bound_of_cell(grid, floor, sign) * sign;
        double above = (greatest - (double)grid->empty) * scale + (double)classifier->offset -
                       (double)classifier->first_visible;
        if (fabs(above) > blur && bit != (above > 0))
          fail_msg("the bit of cell (%d, %d, %d) is %d, its bound lies %g above what shows", x, y, z, bit,
                   above);
        counts.near += fabs(above) <= blur;
        counts.set += bit;
        counts.clear += !bit;
        for (int point = 0; point < 4; point++) {
          const double phase[3] = {bench_random(seed), bench_random(seed), bench_random(seed)};
          float density = (float)(value_in_cell(grid, floor, phase) - (double)grid->empty);
          if (density * classifier->scale + classifier->offset > classifier->first_visible) assert_true(bit);
        }
      }
  return counts;
}

/* A grid with noise in some places, or with a plane or a ball. The transfer function shows values above a
 * threshold, or below it if stored values fall as data rise. */
static void open_bits(bench *bench, const size_t size[3], int which, bool falling, void *voxels) {
  static hl_opacity_point ramp[2];
  hl_storage storage = (hl_storage)(which % 3);
  static const double greatest[] = {255, 65535, 2};
  uint32_t seed = 60 + (uint32_t)which;
  for (size_t v = 0; v < size[0] * size[1] * size[2]; v++) {
    double x = (double)(v % size[0]), y = (double)(v / size[0] % size[1]),
           z = (double)(v / size[0] / size[1]);
    double noise = x < 6 || bench_random(&seed) < 0.3 ? bench_random(&seed) : 0.1,
           ball = 1 - hypot(hypot(x - 7, y - 6), z - 8) / 14;
    double value = (which / 3 == 0   ? noise
                    : which / 3 == 1 ? (x + y / 2 + z / 4) / 40
                                     : fmax(ball, 0)) *
                   greatest[storage];
    if (storage == HL_STORAGE_U8) ((uint8_t *)voxels)[v] = (uint8_t)value;
    if (storage == HL_STORAGE_U16) ((uint16_t *)voxels)[v] = (uint16_t)value;
    if (storage == HL_STORAGE_F32) ((float *)voxels)[v] = (float)(value - 0.5);
  }
  bench_open(bench, size, storage, voxels, bench_oblique_axes());
  double low = bench->scene.volume->minimum, high = bench->scene.volume->maximum;
  if (falling) bench->grid.value_scale = -1, bench->grid.value_offset = low + high;
  ramp[0] = (hl_opacity_point){low + 0.55 * (high - low), 0};
  ramp[1] = (hl_opacity_point){low + 0.6 * (high - low), 0.9};
  bench_show(bench, ramp, 2);
}

static void test_bits_are_what_cells_can_show(void **state) {
  (void)state;
  static const size_t sizes[][3] = {{14, 13, 15}, {9, 12, 16}, {19, 5, 8}, {3, 17, 2}};
  static float voxels[16 * 16 * 16];
  uint32_t seed = 12;
  bit_counts all = {0};
  for (int which = 0; which < 9; which++)
    for (int round = 0; round < 8; round++) {
      bench bench;
      open_bits(&bench, sizes[round / 2], which, round % 2, voxels);
      assert_true(bench.grid.cell_bits != NULL);
      if (bench.grid.cell_bits_tell) {
        bit_counts counts = check_bits(&bench, &seed);
        all.set += counts.set, all.clear += counts.clear, all.near += counts.near;
      }
      bench_close(&bench);
    }
  assert_true(all.set > 10000 && all.clear > 10000 && all.near < 1000);
}

/* No pixel outside of the blocks that are said to matter shows anything. */
static void test_relevant_blocks_miss_nothing(void **state) {
  (void)state;
  static const hl_opacity_point ramp[] = {{168, 0}, {170, 0.9}};
  static uint8_t voxels[NOISE_SIDE * NOISE_SIDE * NOISE_SIDE];
  static float sheet[SIDE][SIDE];
  fill_noise(voxels, 72);
  bench bench;
  bench_open(&bench, (size_t[3]){NOISE_SIDE, NOISE_SIDE, NOISE_SIDE}, HL_STORAGE_U8, voxels,
             bench_oblique_axes());
  bench_show(&bench, ramp, 2);
  uint32_t seed = 6;
  long shown = 0, left_out = 0, left_out_by_bits = 0;
  assert_true(bench.grid.cell_bits_tell);
  static const double pixels[] = {0.05, 0.2, 0.45, 1, 3}; /* the last blocks are too large for a look */
  for (int round = 0; round < 2 * ORIENTATIONS; round++) {
    look_at_random(&bench, &seed, round, pixels[round % 5], HL_KERNEL_BSPLINE);
    int at = round % (bench.sheets.count - 1);
    fill_source source = bench_source(&bench, HL_KERNEL_BSPLINE, at);
    slab_run run = bench_run(&bench, 0);
    fill_sheet(&source, hl_hot_scalar.fill->gather, sheet);
    for (int tile = 0; tile < SIDE_TILES * SIDE_TILES; tile++) {
      int tile_x = tile % SIDE_TILES, tile_y = tile / SIDE_TILES;
      relevant_blocks found = {0};
      uint32_t slabs = at > 0 ? 3u << (at - 1) : 1;
      hl_hot_scalar.fill->relevant_blocks(&run, tile_x, tile_y, slabs, ALL_BLOCKS, &found);
      uint32_t near = at > 0 ? found.blocks[at - 1] & found.blocks[at] : found.blocks[at];
      float density[TILE_PIXELS];
      uint32_t relevant = hl_hot_scalar.fill->gather(&source, tile_x, tile_y, 0, near, density).filled;
      assert_int_equal(hl_hot_scalar.fill->splat(&source, tile_x, tile_y, 0, near, density).filled, relevant);
      assert_int_equal(relevant & ~near, 0);
      left_out += 16 - __builtin_popcount(near);
      left_out_by_bits += __builtin_popcount(near & ~relevant);
      for (int i = 0; i < TILE_PIXELS; i++) {
        int x = tile % SIDE_TILES * TILE + i % TILE, y = tile / SIDE_TILES * TILE + i / TILE;
        vec3 p = bench_position(&bench, at, x, y);
        if (!inside(&bench, p, 0.001) || sheet[y][x] + bench.grid.empty < 168.1f) continue;
        shown++;
        assert_true(relevant >> (y % TILE / BLOCK * 4 + x % TILE / BLOCK) & 1);
      }
    }
  }
  assert_true(shown > 1000 && left_out > 1000 && left_out_by_bits > 300);
  bench_close(&bench);
}

/* The rays of all pixels in the blocks that matter stay in the box through all slabs that are said to be
 * whole. */
static void test_uncut_slabs_are_not_cut(void **state) {
  (void)state;
  static uint8_t voxels[NOISE_SIDE * NOISE_SIDE * NOISE_SIDE];
  fill_noise(voxels, 73);
  bench bench;
  bench_open(&bench, (size_t[3]){NOISE_SIDE, NOISE_SIDE, NOISE_SIDE}, HL_STORAGE_U8, voxels,
             bench_oblique_axes());
  uint32_t seed = 8;
  long uncut = 0, cut = 0;
  for (int round = 0; round < 2 * ORIENTATIONS; round++) {
    look_at_random(&bench, &seed, round, 0.2, HL_KERNEL_BSPLINE);
    slab_run run = bench_run(&bench, 0);
    box_rays rays;
    hl_box_rays(&bench.view, bench.sheets.normal, bench.sheets.first, bench.grid.frame_to_index,
                bench.grid.box_low, bench.grid.box_high, &rays);
    for (int tile = 0; tile < SIDE_TILES * SIDE_TILES; tile++) {
      relevant_blocks found = {0};
      _Alignas(64) float enter[TILE_PIXELS], leave[TILE_PIXELS];
      hl_hot_scalar.view->coverage(&rays, tile % SIDE_TILES, tile / SIDE_TILES, enter, leave);
      hl_hot_scalar.fill->relevant_blocks(&run, tile % SIDE_TILES, tile / SIDE_TILES, (1u << RUN_SLABS) - 1,
                                          ALL_BLOCKS, &found);
      for (int slab = 0; slab < RUN_SLABS; slab++)
        for (int i = 0; i < TILE_PIXELS; i++) {
          if (!(found.blocks[slab] >> (i / BLOCK_PIXELS) & 1)) continue;
          bool inside = enter[i] <= slab * bench.sheets.spacing &&
                        leave[i] >= (slab + 1) * bench.sheets.spacing;
          if (found.uncut >> slab & 1) assert_true(inside);
          uncut += found.uncut >> slab & 1;
          cut += !inside;
        }
    }
  }
  assert_true(uncut > 1000 && cut > 1000);
  bench_close(&bench);
}

/* ---- kernels and views ---- */

static void test_kernels_sum_to_one(void **state) {
  (void)state;
  for (int which = HL_KERNEL_BSPLINE; which <= HL_KERNEL_LINEAR; which++) {
    const kernel *kernel = hl_kernel_get((hl_kernel)which);
    for (int step = 0; step <= 1000; step++) {
      double phase = step / 1000.0, sum = 0, variance = 0;
      for (int n = -3; n <= 3; n++) {
        double value = hl_kernel_value(kernel, phase + n);
        assert_true(value >= -1e-6); /* bricks are dropped by the convex hull of their voxels */
        assert_near(value, hl_kernel_value(kernel, -phase - n), 0);
        sum += value;
        variance += value * (phase + n) * (phase + n);
      }
      assert_near(sum, 1, 1e-6);
      /* over the lattice, the second moment is the kernel's variance, for the B-spline at any phase */
      if (which == HL_KERNEL_BSPLINE) assert_near(variance, kernel->variance, 1e-6);
    }
  }
}

static void test_projection_inverts_rays(void **state) {
  (void)state;
  uint32_t seed = 99;
  for (int round = 0; round < 200; round++) {
    vec3 direction = bench_random_direction(&seed), tilt = vec3_scale(bench_random_direction(&seed), 0.5);
    view view = {.perspective = round % 2, .width = 40, .height = 30, .direction = direction};
    view.origin = vec3_scale(bench_random_direction(&seed), 9);
    vec3 u = vec3_perpendicular(direction);
    view.du = vec3_scale(vec3_add(u, tilt), 0.02);
    view.dv = vec3_scale(vec3_cross(direction, u), 0.03);
    view.corner = vec3_add(view.perspective ? direction : view.origin, vec3_scale(view.du, -20));
    if (!hl_view_finish(&view)) continue;
    for (int i = 0; i < 20; i++) {
      double at_u = 60 * bench_random(&seed) - 10, at_v = 50 * bench_random(&seed) - 10, uv[2];
      vec3 start, way;
      hl_view_ray(&view, at_u, at_v, &start, &way);
      assert_true(
          hl_view_project(&view, vec3_add(start, vec3_scale(way, 0.1 + 30 * bench_random(&seed))), uv));
      assert_near(uv[0], at_u, 1e-9);
      assert_near(uv[1], at_v, 1e-9);
      if (view.perspective) assert_false(hl_view_project(&view, vec3_add(start, vec3_scale(way, -1)), uv));
    }
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_constant_stays_constant),
      cmocka_unit_test(test_ramp_is_exact),
      cmocka_unit_test(test_splat_equals_gather),
      cmocka_unit_test(test_other_blocks_are_left_alone),
      cmocka_unit_test(test_cells_bound_the_reconstruction),
      cmocka_unit_test(test_cells_are_what_their_voxels_say),
      cmocka_unit_test(test_bits_are_what_cells_can_show),
      cmocka_unit_test(test_relevant_blocks_miss_nothing),
      cmocka_unit_test(test_uncut_slabs_are_not_cut),
      cmocka_unit_test(test_kernels_sum_to_one),
      cmocka_unit_test(test_projection_inverts_rays),
  };
  return cmocka_run_group_tests_name("splat_sheet", tests, NULL, NULL);
}
