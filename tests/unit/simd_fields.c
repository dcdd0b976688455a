/* unit/simd_fields.c - see simd_trials.h: blurs, the products of the cascade and of sub-lights. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "shadow_cascade/cascade_field.h"
#include "shadow_sublights/sublight_field.h"
#include "simd_trials.h"

enum { FIELD = 256 /* floats a row and rows, margins included */ };

typedef struct field_state {
  int which;
  blur_job blur;
  field_job field;
  absorbed_job absorbed;
  split_job part;
  sublight_job sublight, dark; /* the other field has light in few pixels */
  half_pixel_job half_pixel;
  slab_rows rows[16];
  uint16_t lit[4];
  field_blur_job field_blur;
  refill_job left;
  emission_job image;
  field_emission_job field_image;
  ptrdiff_t offset[40];
  float a[FIELD][FIELD], b[FIELD][FIELD];
  field_pixel lacking[FIELD][FIELD], thin[FIELD][FIELD]; /* a and b are whole numbers */
  sublight_pixel shade[FIELD][FIELD];
  struct {
    float pixels[FIELD][FIELD];
    field_pixel lacking[FIELD][FIELD];
    sublight_pixel outside[FIELD][FIELD];
    int lit;
    unsigned char touched[4];
  } out;
} field_state;

static void call_field(const hot_functions *hot, void *state) {
  field_state *s = state;
  if (s->which == 0) hot->shadow->blur.rows(&s->blur, 1, 1);
  if (s->which == 1) hot->shadow->blur.columns(&s->blur, 1, 1);
  if (s->which == 2) s->out.lit = hot->shadow->cascade->add(&s->field, 1, 1);
  if (s->which == 3) s->out.lit = hot->shadow->cascade->add_half(&s->field, 1, 1);
  if (s->which == 4) s->out.lit = hot->shadow->cascade->add_double(&s->field, 1, 1);
  if (s->which == 5) s->out.lit = hot->shadow->cascade->blur_add(&s->field_blur, 1, 1);
  if (s->which == 6) hot->shadow->cascade->refill(&s->left, 1, 1);
  if (s->which == 7) s->out.lit = (int)hot->shadow->cascade->absorbed(&s->absorbed, 1, 1);
  if (s->which == 8) s->out.lit = hot->shadow->sublights->composite(&s->sublight, 1, 1);
  if (s->which == 13) {
    slab_rows rows = hot->shadow->sublights->half_pixel(&s->half_pixel, 1, 1);
    s->out.lit = (int)(rows ^ rows >> 32);
  }
  if (s->which == 14) hot->shadow->sublights->composite_row(&s->sublight, 1, 0, 3, s->lit, s->out.touched);
  if (s->which == 15) s->out.lit = (int)hot->shadow->sublights->lit(&s->dark, 1, 1, s->lit[1]);
  if (s->which == 9) s->out.lit = hot->shadow->cascade->double_tile(&s->field, 1, 1);
  if (s->which == 10) hot->shadow->blur.emission(&s->image, 1, 1);
  if (s->which == 12) s->out.lit = (int)hot->shadow->cascade->split(&s->part, 1, 1);
  if (s->which == 11) s->out.lit = hot->shadow->cascade->emission_add(&s->field_image, 1, 1);
}

/* Sets marks of surfaces in the dark (shadow/attenuate.h) in every seventh pixel. In every second one of them
 * `absorbed_at_start` is 1: the chunk began without light. */
static void mark_dark(float *pixels, float *absorbed_at_start, uint32_t *seed) {
  for (int i = 0; i < FIELD * TILE; i += 7) {
    pixels[i] = -DARK_MARK * random_between(seed, 0, 1);
    if (i % 2) absorbed_at_start[i] = 1;
  }
}

/* Sets surfaces that absorb all light, in pieces of forty pixels. */
static void mark_opaque(float *pixels) {
  for (int i = 0; i < FIELD * TILE; i++)
    if (i / 40 % 2) pixels[i] = -LEAST_MARK;
}

void test_fields(void **unused) {
  (void)unused;
  static const char *const names[] = {
      "blur_rows_tile",  "blur_columns_tile", "add_tile",      "add_half_tile",
      "add_double_tile", "field_blur_tile",   "refill_tile",   "absorbed_tile",
      "sublight_tile",   "double_tile",       "emission_tile", "field_emission_tile",
      "split_tile",      "half_pixel_tile",   "sublight_row",  "sublight_lit"};
  static field_state s;
  uint32_t seed = 23;
  enum { MARGIN = 100 };
  for (int round = 0; round < ROUNDS; round++) {
    fill_salted(&s.a[0][0], FIELD * FIELD, &seed, 0, 1);
    fill_salted(&s.b[0][0], FIELD * FIELD, &seed, 0, 1);
    for (int i = 0; i < FIELD * FIELD; i++) {
      (&s.lacking[0][0])[i] = nearest_pixel((&s.a[0][0])[i] * (round % 4 ? FIELD_ONE : 65535));
      (&s.thin[0][0])[i] = nearest_pixel((&s.b[0][0])[i] * FIELD_ONE);
    }
    field_pixel *lacking = &s.lacking[MARGIN][MARGIN], *thin = &s.thin[MARGIN][MARGIN],
                *out = &s.out.lacking[MARGIN][MARGIN];
    s.blur = (blur_job){&s.a[MARGIN][MARGIN], &s.out.pixels[MARGIN][MARGIN], FIELD, FIELD,
                        hl_blur_box(random_between(&seed, 1, round % 5 ? 30 : 150))};
    s.field = (field_job){lacking, thin, out, FIELD, FIELD, round % 2 ? thin + 3 * FIELD : NULL, ALL_ROWS};
    /* arrays that both read and write: the light of pixels, and in the rows below, the light that was lacking
     * and the older light */
    s.left = (refill_job){.absorbed = lacking,
                          .absorbed_at_start = &s.out.pixels[MARGIN + 2 * TILE][MARGIN],
                          .to = &s.out.pixels[MARGIN][MARGIN],
                          .older = &s.out.pixels[MARGIN + 4 * TILE][MARGIN],
                          .outside = round % 3 ? &s.out.pixels[MARGIN + 4 * TILE][MARGIN + 2 * TILE] : NULL,
                          .stride = FIELD,
                          .stride_to = FIELD,
                          .kept = round & 1,
                          .again = round >> 1 & 1};
    s.absorbed = (absorbed_job){&s.a[MARGIN][MARGIN],
                                &s.b[MARGIN][MARGIN],
                                &s.out.pixels[MARGIN][MARGIN],
                                0.8f,
                                round % 3 ? lacking : NULL,
                                out + 16 * FIELD,
                                out + 32 * FIELD,
                                out + 48 * FIELD,
                                out + 64 * FIELD,
                                FIELD,
                                FIELD,
                                round % (GREATEST_EDGE + 1)};
    s.part = (split_job){lacking,
                         thin,
                         {out, out + 16 * FIELD},
                         {out + 32 * FIELD, out + 48 * FIELD},
                         FIELD,
                         random_between(&seed, 0, 1)};
    s.field_blur = (field_blur_job){lacking,
                                    round % 3 ? thin : NULL,
                                    round % 2 ? thin + 3 * FIELD : NULL,
                                    out,
                                    FIELD,
                                    hl_blur_box(random_between(&seed, 1, 90)),
                                    hl_blur_box(random_between(&seed, 1, 2 * BLUR_GREATEST_REACH)),
                                    ALL_ROWS};
    s.sublight = (sublight_job){.slab_stride = FIELD,
                                .stride = FIELD,
                                .rows = s.rows,
                                .slab_tiles_x = 4,
                                .slab_tiles_y = 4,
                                .tiles_x = 4,
                                .carry = random_between(&seed, 0.01f, 0.99f),
                                .channels = 1 + 2 * (round % 2)};
    for (int axis = 0; axis < 2; axis++) {
      s.sublight.place.scale[axis] = round % 3 == 0 ? 1
                                                    : random_between(&seed, round % 3 == 1 ? 0.8f : 0.3f,
                                                                     round % 3 == 1 ? 1.25f : 3);
      s.sublight.place.shift[axis] = random_between(&seed, -20, 20);
      s.sublight.place.half[axis] = (int)(2 * s.sublight.place.shift[axis]);
    }
    for (int c = 0; c < HL_CHANNELS; c++) {
      for (int i = 0; i < SLAB_COPIES; i++) s.sublight.slab[c][i] = &s.a[MARGIN + c][MARGIN + 5 * i];
      s.sublight.transmittance[c] = out;
      if (round % 4 == 3) continue;
      for (int i = 0; i < SLAB_COPIES; i++)
        s.sublight.slab_outside[c][i] = &s.a[MARGIN + c + 3][MARGIN + 5 * i + 1];
      s.sublight.outside[c] = &s.out.outside[MARGIN][MARGIN];
    }
    s.dark = s.sublight;
    for (int c = 0; c < HL_CHANNELS; c++) s.dark.transmittance[c] = &s.shade[0][0], s.dark.outside[c] = NULL;
    for (int i = 0; i < FIELD * FIELD; i++)
      (&s.shade[0][0])[i] = random_between(&seed, 0, 1) < 0.95f
                                ? 0
                                : (sublight_pixel)random_between(&seed, 60, 68);
    for (int i = 0; i < 16; i++) s.rows[i] = (uint64_t)random_between(&seed, 0, 65535) * 0x1000100010001u;
    for (int i = 0; i < 4; i++)
      s.lit[i] = random_between(&seed, 0, 1) < 0.3f ? 0 : (uint16_t)random_between(&seed, 1, 65535);
    s.half_pixel = (half_pixel_job){.slab = &s.a[MARGIN][MARGIN], .slab_stride = FIELD};
    for (int i = 1; i < SLAB_COPIES; i++) s.half_pixel.moved[i] = &s.out.pixels[MARGIN + 16 * i][MARGIN];
    s.image = (emission_job){.from = &s.a[MARGIN][MARGIN],
                             .to = &s.out.pixels[MARGIN][MARGIN],
                             .stride = FIELD,
                             .count = 1 + round % 40,
                             .offset = s.offset,
                             .weight = &s.b[MARGIN + 30][MARGIN]};
    s.field_image = (field_emission_job){.from = lacking,
                                         .thin = thin,
                                         .to = out,
                                         .stride = FIELD,
                                         .count = 1 + round % 40,
                                         .offset = s.offset,
                                         .weight = &s.b[MARGIN + 30][MARGIN]};
    for (int i = 0; i < 40; i++)
      s.offset[i] = (ptrdiff_t)random_between(&seed, -20, 20) * FIELD +
                    (ptrdiff_t)random_between(&seed, -20, 20);
    for (s.which = 0; s.which < 16; s.which++) {
      if (s.which == 6) mark_dark(s.left.to, s.left.absorbed_at_start, &seed);
      if (s.which == 7) {
        mark_dark(&s.b[MARGIN][MARGIN], &s.a[MARGIN][MARGIN], &seed);
        mark_opaque(&s.b[MARGIN][MARGIN]);
      }
      trial trial = {call_field, &s, &s.out, sizeof s.out};
      try_it(names[s.which], &trial, round);
    }
  }
}
