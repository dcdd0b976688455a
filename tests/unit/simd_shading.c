/* unit/simd_shading.c - see simd_trials.h: shading of volumes and surfaces, maximum projections, measures. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "plan/shown_values.h"
#include "render/surface_samples.h"
#include "shadow_sublights/sublight_field.h"
#include "simd_trials.h"

/* ---- shading ---- */

typedef struct shade_state {
  shade_job job;
  shade_volume volumes[2];
  shade_patch patches[2];
  int patch_count, covers;
  shade_light lights[3];
  shadow_lookup lookups[3];
  sublight_lookup sublights[3][3];
  uint32_t blocks;
  float density[4][TILE_PIXELS];
  float cut[2][TILE_PIXELS];
  float buffer[HL_CHANNELS][64][64];
  sublight_pixel left[HL_CHANNELS][64][64]; /* whole numbers of the buffer's pixels */
  struct {
    float pixels[4 * TILE_PIXELS];
    uint64_t samples;
    uint32_t open;
  } out;
  float scattered_light[12 * 60];
  scatter_field scattered;
  phase_table phase;
} shade_state;

/* The state's only tile. */
static tile_slab tile_of(const shade_state *s, void *scratch) {
  return (tile_slab){
      .patches = s->patches, .patch_count = s->patch_count, .blocks = s->blocks, .scratch = scratch};
}

static void call_shade(const hot_functions *hot, void *state) {
  shade_state *s = state;
  s->out.samples = 0;
  _Alignas(64) unsigned char scratch[2 * SHADE_SCRATCH_BYTES];
  shade_tile_function *function = s->covers ? hot->render->cover : hot->render->shade;
  const tile_slab tile = tile_of(s, scratch);
  s->out.open = function(&s->job, &tile, s->out.pixels, &s->out.samples);
}

/* steepest: the greatest distance in pixels between neighbouring places. */
static shadow_map random_map(uint32_t *seed, double steepest) {
  shadow_map map = {.stride = 64, .width = 60, .height = 50};
  for (int row = 0; row < 3; row++)
    for (int column = 0; column < 4; column++)
      map.rows[row][column] = random_between(seed, -steepest, steepest);
  map.rows[0][3] = 10;
  map.rows[1][3] = map.rows[2][3] = 250;
  return map;
}

static void set_up_lights(shade_state *s, uint32_t *seed, int round) {
  fill_salted(&s->buffer[0][0][0], sizeof s->buffer / 4, seed, 0, 1);
  for (int i = 0; i < HL_CHANNELS * 64 * 64; i++)
    (&s->left[0][0][0])[i] = nearest_pixel((&s->buffer[0][0][0])[i] * SUBLIGHT_ONE);
  for (int i = 0; i < 3; i++) {
    shade_light *light = &s->lights[i];
    vec3 towards = bench_random_direction(seed);
    *light = (shade_light){.parallel = (round + i) % 2,
                           .towards = {(float)towards.x, (float)towards.y, (float)towards.z},
                           .position = {3, -2, (float)i},
                           .color = {1, 0.5f, salted(seed, 0, 1)},
                           .inverse_square = i == 1,
                           .shadowed = i < 2,
                           .path = 0.7f,
                           .number = i,
                           .lookups = &s->lookups[i],
                           .sublights = s->sublights[i],
                           .sublight_count = round % 4,
                           .channels = s->job.channels,
                           .parallel_row = (round + i) % 4 < 2 ? i : -1,
                           .nearest = round % 5 == 4,
                           .cubic = round / 4 % 2};
    light->caps.count = light->parallel ? 0 : (round + i) % 5;
    for (int part = 0; part < light->caps.count; part++)
      light->caps.cap[part] = (light_cap){{3 + (float)part, salted(seed, -2, 2), 1},
                                          {1, 2, 0.5f, 0.3f, -0.2f, 0.1f}};
    s->lookups[i].map = random_map(seed, 9);
    s->lookups[i].young = 0.3f;
    for (int c = 0; c < HL_CHANNELS; c++) {
      s->lookups[i].transmittance[c] = &s->buffer[c][2][2];
      s->lookups[i].outside[c] = &s->buffer[c][6][5];
      s->lookups[i].older[c] = round % 2 ? &s->buffer[c][9][7] : NULL;
    }
    for (int part = 0; part < 3; part++) {
      s->sublights[i][part] = (sublight_lookup){.map = random_map(seed, part == 0 ? 9 : 2),
                                                .weight = {1, 0.7f, salted(seed, 0, 1)}};
      for (int c = 0; c < HL_CHANNELS; c++) {
        s->sublights[i][part].transmittance[c] = &s->left[c][2][2];
        s->sublights[i][part].outside[c] = &s->left[c][4][7];
      }
    }
    if (round % 4 == 3) light->cone = (light_cone){{-light->towards[0], 0.6f, -light->towards[2]}, 0.3f, 4};
    if ((round + i) % 3 == 0) {
      light->texture = (light_texture){
          .pixels = &s->buffer[0][0][0], .width = 1 + round % 30, .height = 20, .sharpness = {1, 2.5f}};
      for (int row = 0; row < 3; row++)
        for (int column = 0; column < 4; column++)
          light->texture.map[row][column] = random_between(seed, -1, 9);
      light->texture.level_count = round % 4;
      light->texture.first = 0.05f;
      light->texture.edge[0] = 0.3f;
      light->texture.parallel = round % 2;
      light->texture.beyond[i] = 1;
      for (int l = 0; l < light->texture.level_count; l++)
        light->texture.level[l] = (texture_level){
            &s->buffer[0][0][0] + 99 * l, 20 + l, 15, {0.7f, 1}, {2.5f, 3}};
    }
  }
}

/* A plane, a box and a sphere across the volumes. */
static const shade_cut cuts_bench[] = {
    {HL_CUT_PLANE, 0, {{0.6f, 0.3f, 0.7f, -2}, {0}, {0}}},
    {HL_CUT_BOX, 0, {{0.3f, 0.02f, 0, 0.1f}, {0, 0.25f, 0.03f, 0.2f}, {-0.02f, 0, 0.3f, 0}}},
    {HL_CUT_SPHERE, 1, {{0.2f, 0, 0, 0.1f}, {0, 0.2f, 0, 0}, {0, 0, 0.2f, 0.1f}}}};

static void set_up_shade(shade_state *s, uint32_t *seed, int round) {
  memset(s, 0, sizeof *s);
  s->job = (shade_job){.rays = random_rays(seed, round),
                       .through = {0.1f, 0.2f, 0.5f},
                       .towards_eye = {0, 0.6f, -0.8f},
                       .normal = {0, 0, 1},
                       .path = 0.6f,
                       .height = 1,
                       .spacing = 0.5f,
                       .back_to_front = round % 4 == 2,
                       .lights = s->lights,
                       .light_count = round % 4,
                       .ambient = {0.1f, 0.2f, 0},
                       .emission = 1,
                       .channels = round % 3 ? 3 : 1};
  s->patch_count = 1 + round % 2;
  fill_salted(s->scattered_light, sizeof s->scattered_light / sizeof(float), seed, 0, 2);
  s->scattered = (scatter_field){.nodes = {{4, 3, 5}, {-1, -2, 0.5f}, 2.5f},
                                 .light = s->scattered_light,
                                 .flux = round % 2 ? s->scattered_light + 180 : NULL,
                                 .channels = round % 3 ? 3 : 1};
  s->job.scattered = round % 5 ? &s->scattered : NULL;
  if (round == 0) s->job.light_count = 2;
  static float near_passing[3 * HL_CHANNELS][TILE_PIXELS];
  fill_salted(near_passing[0], sizeof near_passing / sizeof(float), seed, 0, 1);
  if (round % 3 == 2) s->job.near_passing = (const float(*)[TILE_PIXELS])near_passing;
  static float phase_rows[3][PHASE_COLUMNS], phase_caps[PHASE_CAPS][PHASE_COLUMNS][2];
  fill_salted(phase_rows[0], sizeof phase_rows / sizeof(float), seed, 0.1, 2);
  fill_salted(&phase_caps[0][0][0], sizeof phase_caps / sizeof(float), seed, 0.1, 2);
  s->phase = (phase_table){0.7, 9, phase_caps, phase_rows};
  set_up_lights(s, seed, round);
  for (int v = 0; v < 2; v++) {
    const classifier *classifier = classifier_of(round / 2 + v);
    int masked = classifier->mask.factors != NULL;
    fill_salted(s->density[2 * v], 2 * TILE_PIXELS, seed, -0.1, 1.1);
    if (round % 8 == 3) s->density[2 * v][20] = NAN;
    s->volumes[v] = (shade_volume){classifier,
                                   &gradient_bench[(round + v) % GRADIENT_GRIDS].grid,
                                   hl_kernel_get((hl_kernel)(round % 3)),
                                   (round + v) % 2,
                                   (round + v) % 7 != 6,
                                   v == 0,
                                   (round + v) % 6 != 5,
                                   round % 9 == 7,
                                   round % 4 ? 0.9f : 20,
                                   0.5f,
                                   0.8f,
                                   0.3f,
                                   25,
                                   round % 3 ? 0.4f : 0,
                                   {1, 0.5f, 0},
                                   {{0.9f, 0.1f, 0, 4}, {-0.1f, 0.8f, 0.2f, 5}, {0, -0.2f, 1.1f, 6}},
                                   {-0.5f, -0.5f, -0.5f},
                                   {8.5f, 9.5f, 10.5f},
                                   {{-1, 0}, {0, -1}, {-1, -1}},
                                   round % 4 == 3,
                                   NULL,
                                   /* a sky needs the field */
                                   v,
                                   round % 3 == 1 ? -0.7f : round % 3 * 0.4f,
                                   round / 3 % 4 || round % 3 != 1 ? &s->phase : NULL,
                                   round / 3 % 4 ? &s->phase : NULL,
                                   (round + v) % 3 == 1 ? colors_bench : (voxel_colors){.voxels = NULL},
                                   {0.9f, 0.8f, 1},
                                   round % 4 == 1,
                                   round % 4 < 2,
                                   cuts_bench,
                                   round % 3 == 1 ? 3 : 0,
                                   round % 6 == 1 ? 3 : 0,
                                   round % 2,
                                   masked,
                                   masked && round % 5 > 1 ? colors_bench : (voxel_colors){.voxels = NULL},
                                   v + 1};
    s->patches[v] = (shade_patch){&s->volumes[v],
                                  s->density[2 * v],
                                  s->density[2 * v + 1],
                                  round == 0 ? ALL_BLOCKS : (uint32_t)(65536 * bench_random(seed)),
                                  v == round % 3 ? s->cut[0] : NULL,
                                  v == round % 3 ? s->cut[1] : NULL,
                                  round % 5 == 4};
  }
  fill_salted(s->cut[0], TILE_PIXELS, seed, 0, 1);
  fill_salted(s->cut[1], TILE_PIXELS, seed, 0.5, 2);
  for (int i = 0; i < 4 * TILE_PIXELS; i++)
    s->out.pixels[i] = random_between(seed, 0, round % 5 ? 1 : 1.0005);
  s->blocks = round == 0 ? ALL_BLOCKS : (uint32_t)(65536 * bench_random(seed));
}

/* Measuring writes more floats for each pixel than a colour has. */
typedef struct measure_state {
  shade_state shade;
  struct {
    float pixels[MEASURES * TILE_PIXELS];
    uint32_t open;
  } out;
} measure_state;

static void call_measure(const hot_functions *hot, void *state) {
  measure_state *s = state;
  uint64_t samples = 0;
  _Alignas(64) unsigned char scratch[2 * SHADE_SCRATCH_BYTES];
  const tile_slab tile = tile_of(&s->shade, scratch);
  s->out.open = hot->render->measure(&s->shade.job, &tile, s->out.pixels, &samples);
}

void test_measure(void **unused) {
  (void)unused;
  static measure_state state;
  uint32_t seed = 53;
  int marked = 0;
  for (int round = 0; round < 4 * ROUNDS; round++) {
    set_up_shade(&state.shade, &seed, round);
    state.shade.job.back_to_front = 0; /* measured only from front to back */
    for (int i = 0; i < MEASURES * TILE_PIXELS; i++) {
      int row = i / BLOCK_PIXELS % MEASURES;
      /* alpha on both sides of 0.01, above which a ray has met something */
      state.out.pixels[i] = row == MEASURE_ALPHA         ? random_between(&seed, 0, i % 2 ? 1 : 0.012)
                            : row == MEASURE_DEPTH_FIRST ? INFINITY
                                                         : random_between(&seed, -9, 9);
    }
    trial trial = {call_measure, &state, &state.out, sizeof state.out};
    try_it("measure_tile", &trial, round);
    for (int i = 0; i < MEASURES * TILE_PIXELS; i++)
      marked += i / BLOCK_PIXELS % MEASURES == MEASURE_DEPTH_FIRST && isfinite(state.out.pixels[i]);
  }
  assert_true(marked > ROUNDS);
}

void test_shade(void **unused) {
  (void)unused;
  static shade_state state;
  uint32_t seed = 41;
  for (int round = 0; round < 4 * ROUNDS; round++) {
    set_up_shade(&state, &seed, round);
    trial trial = {call_shade, &state, &state.out, sizeof state.out};
    try_it("shade_tile", &trial, round);
    state.covers = 1;
    try_it("cover_tile", &trial, round);
  }
}

typedef struct maximum_state {
  shade_state shade;
  float shown[CLASSIFIER_ENTRIES + 2][4];
  struct {
    float values[2 * MAXIMUM_ROWS * TILE_PIXELS];
    uint64_t samples;
    uint32_t open;
  } out;
} maximum_state;

static void call_maximum(const hot_functions *hot, void *state) {
  maximum_state *s = state;
  s->out.samples = 0;
  const tile_slab tile = tile_of(&s->shade, NULL);
  s->out.open = hot->render->maximum(&s->shade.job, &tile, s->out.values, &s->out.samples);
}

void test_maximum(void **unused) {
  (void)unused;
  static maximum_state state;
  uint32_t seed = 47;
  for (int round = 0; round < 4 * ROUNDS; round++) {
    set_up_shade(&state.shade, &seed, round);
    state.shade.job.sheet = 7;
    for (int v = 0; v < 2; v++) state.shade.volumes[v].shown = (const float(*)[4])state.shown;
    for (int entry = 0; entry < CLASSIFIER_ENTRIES + 2; entry++) {
      double from = entry + random_between(&seed, -0.2, 1.2);
      state.shown[entry][SHOWN_FROM] = (float)from;
      state.shown[entry][SHOWN_TO] = (float)(from + 0.5);
      state.shown[entry][SHOWN_BELOW] = entry % 7 == 0 ? -1 : (float)entry - 1;
    }
    for (int i = 0; i < 2 * MAXIMUM_ROWS * TILE_PIXELS; i++)
      state.out.values[i] = i / TILE_PIXELS % MAXIMUM_ROWS == MAXIMUM_SHEET
                                ? (i % 3 ? 6 : -1)
                                : random_between(&seed, -1, CLASSIFIER_ENTRIES);
    trial trial = {call_maximum, &state, &state.out, sizeof state.out};
    try_it("maximum_tile", &trial, round);
  }
}

/* ---- surfaces ---- */

enum { SKY_CELLS = 4 * 3 * 5 };

typedef struct surface_state {
  shade_state shade; /* its job, with lights */
  sky_light sky;
  _Alignas(64) int16_t sky_cells[SKY_CELLS * SKY_CELL];
  surface_samples out;
} surface_state;

static void call_surface(const hot_functions *hot, void *state) {
  surface_state *s = state;
  hot->render->surface(&s->shade.job, &s->out);
}

static void set_unit_vectors(float to[3][SURFACE_SAMPLES], uint32_t *seed) {
  for (int i = 0; i < SURFACE_SAMPLES; i++) {
    vec3 unit = bench_random_direction(seed);
    to[0][i] = (float)unit.x, to[1][i] = (float)unit.y, to[2][i] = (float)unit.z;
  }
}

static void set_up_surface(surface_state *s, uint32_t *seed, int round) {
  surface_samples *out = &s->out;
  set_up_shade(&s->shade, seed, round);
  for (int i = 0; i < SKY_CELLS * SKY_CELL; i++) {
    bool passing = i % SKY_CELL == SKY_PASSING || i % SKY_CELL == SKY_PASSING + 1, whole = i % 7 == 0;
    float number = whole ? SKY_MOST : random_between(seed, passing ? 0 : -SKY_MOST, SKY_MOST);
    s->sky_cells[i] = (int16_t)(i % 5 == 0 && !passing ? -number : number);
  }
  s->sky = (sky_light){.cells = s->sky_cells,
                       .row_numbers = 4 * SKY_CELL,
                       .stored_unit = {1e-4f, 2e-4f, 3e-4f},
                       .count = {4, 3, 5},
                       .low = {-3, -2, -1},
                       .inverse_cell = 0.5f,
                       .cell = 2,
                       .lift = 1,
                       .channels = round % 3 ? 3 : 1,
                       .color = {0.9f, 1, 0.4f}};
  fill_salted(&s->sky.open[0][0], 3 * FIELD_HARMONICS, seed, 0, 1);
  s->shade.job.sky = round % 3 == 1 ? NULL : &s->sky;
  fill_salted(&out->position[0][0], 3 * SURFACE_SAMPLES, seed, -2, 4);
  set_unit_vectors(out->normal, seed);
  set_unit_vectors(out->towards_eye, seed);
  for (int axis = 0; axis < 3; axis++) out->normal[axis][round % SURFACE_SAMPLES] = 0; /* black */
  fill_salted(&out->color[0][0], 3 * SURFACE_SAMPLES, seed, 0, 1);
  out->ambient = 0.2f, out->diffuse = 0.8f, out->specular = 0.3f, out->shininess = 25, out->emission = 0.1f;
  out->even = round % 2 ? 0.4f : 0;
  for (int c = 0; c < 3; c++) out->behind[c] = random_between(seed, 0, 1);
  out->receives_shadow = round % 5 != 4;
}

void test_surface(void **unused) {
  (void)unused;
  static surface_state state;
  uint32_t seed = 59;
  int lit = 0;
  for (int round = 0; round < 4 * ROUNDS; round++) {
    set_up_surface(&state, &seed, round);
    trial trial = {call_surface, &state, &state.out, sizeof state.out};
    try_it("shade_surface", &trial, round);
    for (int i = 0; i < SURFACE_SAMPLES; i++) lit += state.out.lit[1][i] > 0.1f;
  }
  assert_true(lit > SURFACE_SAMPLES * ROUNDS);
}

/* For one volume there is code of its own. A second volume that has nothing in the tile changes nothing,
 * except for rounding. */
void test_shade_beside_nothing(void **unused) {
  (void)unused;
  static shade_state alone, beside;
  uint32_t seed = 43;
  int lit = 0;
  for (int round = 0; round < 4 * ROUNDS; round += 2) {
    set_up_shade(&alone, &seed, round);
    /* a difference by rounding would be another pixel there */
    for (int i = 0; i < 3; i++) alone.lights[i].nearest = 0;
    beside = alone;
    beside.job.lights = beside.lights;
    beside.patch_count = 2;
    beside.patches[1].blocks = 0;
    call_shade(&hl_hot_scalar, &alone);
    call_shade(&hl_hot_scalar, &beside);
    assert_int_equal(alone.out.open, beside.out.open);
    assert_int_equal(alone.out.samples, beside.out.samples);
    lit += alone.out.samples > 0;
    for (int i = 0; i < 4 * TILE_PIXELS; i++) {
      float pixel = alone.out.pixels[i];
      if (isfinite(pixel)) assert_float_equal(beside.out.pixels[i], pixel, 1e-4f * (1 + fabsf(pixel)));
    }
  }
  assert_true(lit > ROUNDS);
}
