/* unit/simd_light.c - see simd_trials.h: how a tile's light is attenuated. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "simd_trials.h"

typedef struct attenuate_state {
  attenuate_job job;
  attenuate_volume volumes[2];
  float density[2][4][TILE_PIXELS];
  struct {
    float field[3 * HL_CHANNELS][TILE][TILE];
    attenuated_blocks blocks;
    uint32_t lit;
  } out;
} attenuate_state;

static void call_attenuate(const hot_functions *hot, void *state) {
  attenuate_state *s = state;
  s->out.blocks = hot->shadow->attenuate(&s->job, 1, 1);
}

static void call_lit_blocks(const hot_functions *hot, void *state) {
  attenuate_state *s = state;
  s->out.lit = hot->shadow->lit_blocks((const float *const *)s->job.transmittance, s->job.channels, TILE);
}

static void set_up_attenuate(attenuate_state *s, uint32_t *seed, int round) {
  memset(s, 0, sizeof *s);
  s->job = (attenuate_job){.rays = random_rays(seed, round),
                           .path = 1,
                           .height = 1,
                           .spacing = 0.5f,
                           .volumes = s->volumes,
                           .volume_count = 1 + round % 2,
                           .channels = round % 3 ? 3 : 1,
                           .stride = TILE,
                           .moment_stride = TILE,
                           .position = 0.7f};
  for (int c = 0; c < HL_CHANNELS; c++) {
    s->job.transmittance[c] = &s->out.field[c][0][0];
    s->job.moment[c] = round % 4 ? &s->out.field[HL_CHANNELS + c][0][0] : NULL;
    s->job.outside[c] = round % 5 ? &s->out.field[2 * HL_CHANNELS + c][0][0] : NULL;
  }
  for (int v = 0; v < 2; v++) {
    fill_salted(s->density[v][0], 2 * TILE_PIXELS, seed, -0.1, 1.1);
    fill_salted(s->density[v][2], 2 * TILE_PIXELS, seed, 0, 2);
    if (round % 8 == 3) s->density[v][0][v] = NAN;
    static const float to_index[3][4] = {{0.4f, 0.1f, 0, 3}, {0, 0.3f, 0.1f, 2}, {0.1f, 0, 0.5f, 4}};
    s->volumes[v] = (attenuate_volume){
        .classifier = classifier_of(round + v),
        .density = s->density[v][0],
        .before = s->density[v][1],
        .enter = v == round % 3 ? s->density[v][2] : NULL,
        .leave = v == round % 3 ? s->density[v][3] : NULL,
        .blocks = round == 0 ? ALL_BLOCKS : (uint32_t)(65536 * bench_random(seed)),
        .surface = (round + v) % 3 != 0,
        .voxel = 0.9f,
        .weight = {0, 0.5f, 1},
        .uncut = round % 5 == 4,
        .grid = &gradient_bench[(round + v) % GRADIENT_GRIDS].grid,
        .kernel = hl_kernel_get((hl_kernel)(round % 3)),
        .to_index = to_index};
  }
  for (int c = 0; c < 3 * HL_CHANNELS; c++) {
    fill_salted(&s->out.field[c][0][0], TILE_PIXELS, seed, 0, 1);
    for (int i = 0; i < TILE_PIXELS && round % 2; i++) (&s->out.field[c][0][0])[i] *= 1e-3f; /* around dark */
  }
}

void test_light(void **unused) {
  (void)unused;
  static attenuate_state state;
  uint32_t seed = 11;
  for (int round = 0; round < 2 * ROUNDS; round++) {
    set_up_attenuate(&state, &seed, round);
    trial attenuate = {call_attenuate, &state, &state.out, sizeof state.out};
    trial lit = {call_lit_blocks, &state, &state.out, sizeof state.out};
    try_it("attenuate_tile", &attenuate, round);
    try_it("lit_blocks_tile", &lit, round);
  }
}
