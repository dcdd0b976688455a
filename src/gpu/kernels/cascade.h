/* gpu/kernels/cascade.h - passes over the fields of soft lights (shadow_cascade/cascade.h). The functions
 * compute for one pixel the same numbers as shadow_cascade/cascade_lanes.h for sixteen pixels, if no mesh
 * leaves marks. */
#ifndef HL_GPU_CASCADE_H
#define HL_GPU_CASCADE_H

#include "core/sheet_constants.h"
#include "gpu/kernels/pass_place.h"

#if SOFT

/* lanes_store_short() */
DEVICE word16 rounded_pixel(float x) { return (word16)(int)(lesser(x, 65535.0f) + 0.5f); }

/* 1 - thin */
DEVICE float left_by(word16 thin) { return fused((float)thin, -1.0f / PASS_WHOLE, 1.0f); }

/* Computes a + (1 - thin) b at a pixel of the fields a and thin. */
DEVICE float left_and_a(float b, GLOBAL const plan_pass *pass, GLOBAL const word16 *fields, wide at) {
  if (pass->a == PASS_NOTHING) return pass->thin == PASS_NOTHING ? b : b * left_by(fields[pass->thin + at]);
  const float more = (float)fields[pass->a + at];
  return pass->thin == PASS_NOTHING ? b + more : fused(b, left_by(fields[pass->thin + at]), more);
}

/* The sum a + (1 - thin) b of absorbed light at one level. */
DEVICE float a_and_b(GLOBAL const plan_pass *pass, GLOBAL const word16 *fields, wide at) {
  if (pass->b == PASS_NOTHING) return (float)fields[pass->a + at];
  return left_and_a((float)fields[pass->b + at], pass, fields, at);
}

/* The value at a pixel of the field b, which is twice as coarse and is interpolated as in double_row(). */
DEVICE float doubled(GLOBAL const plan_pass *pass, GLOBAL const word16 *fields, int x, int y) {
  const int stride = pass->stride_in, other = x & 1 ? 1 : -1;
  GLOBAL const word16 *close = fields + place_in_field(pass->b, stride, x / 2, y / 2);
  GLOBAL const word16 *far = y & 1 ? close + stride : close - stride;
  const float own = fused((float)close[0], 0.75f, 0.25f * (float)far[0]);
  const float beside = fused((float)close[other], 0.75f, 0.25f * (float)far[other]);
  return fused(own, 0.75f, 0.25f * beside);
}

/* ---- blurs ---- */

/* Blurs a pixel of b along its row, in the rows of the level's tiles and of the margins above and below.
 * rows: [rows][columns of the tiles]. */
DEVICE void blur_row(GLOBAL const plan_pass *pass, GLOBAL const plan_blur *boxes, GLOBAL const word16 *fields,
                     GLOBAL float *rows, int number) {
  const int width = pass->tiles_x * 16, x = number % width, y = number / width - PASS_MARGIN;
  if (y >= pass->tiles_y * 16 + PASS_MARGIN) return;
  const plan_blur box = boxes[pass->boxes + (unsigned)(x / 16)];
  GLOBAL const word16 *from = fields + pass->b;
  from = y < 0 ? from - (wide)(-y) * (wide)pass->stride : from + (wide)y * (wide)pass->stride;
  from = from + x;
  const int ends = (int)from[-(box.reach + 1)] + (int)from[box.reach + 1];
  int sum = (int)from[0];
  for (int i = 1; i <= box.reach; i++) sum = sum + ((int)from[-i] + (int)from[i]);
  rows[number] = fused((float)ends, box.edge, (float)sum) * box.scale;
}

/* Blurs blurred rows along a column. */
DEVICE float blurred(GLOBAL const plan_pass *pass, GLOBAL const plan_blur *boxes, GLOBAL const float *rows,
                     int x, int y) {
  const plan_blur box = boxes[pass->boxes + (unsigned)(pass->tiles_x + y / 16)];
  const int width = pass->tiles_x * 16;
  GLOBAL const float *from = rows + (wide)(y + PASS_MARGIN) * (wide)width + x;
  const float ends = from[-(box.reach + 1) * width] + from[(box.reach + 1) * width];
  float sum = fused(ends, box.edge, from[0]);
  for (int i = 1; i <= box.reach; i++) sum = sum + (from[-i * width] + from[i * width]);
  return sum * box.scale;
}

/* Computes a pixel of a + (1 - thin) b, where b may first be blurred, halved or doubled. */
DEVICE void sum_pixel(GLOBAL const plan_pass *pass, GLOBAL const plan_blur *boxes, GLOBAL word16 *fields,
                      GLOBAL const float *rows, int number) {
  const int width = pass->tiles_x * 16, x = number % width, y = number / width;
  if (y >= pass->tiles_y * 16) return;
  const wide at = place_in_field(0u, pass->stride, x, y);
  float sum;
  if (pass->kind == PASS_HALF) {
    const wide upper = place_in_field(0u, pass->stride_in, 2 * x, 2 * y),
               lower = upper + (wide)pass->stride_in;
    const float of_upper = a_and_b(pass, fields, upper) + a_and_b(pass, fields, upper + 1);
    const float of_lower = a_and_b(pass, fields, lower) + a_and_b(pass, fields, lower + 1);
    sum = 0.25f * (of_upper + of_lower);
  } else if (pass->kind == PASS_DOUBLE) {
    sum = left_and_a(doubled(pass, fields, x, y), pass, fields, at);
  } else if (pass->kind == PASS_BLUR) {
    sum = left_and_a(blurred(pass, boxes, rows, x, y), pass, fields, at);
  } else {
    sum = a_and_b(pass, fields, at);
  }
  fields[pass->to + at] = rounded_pixel(sum);
}

/* ---- matter ---- */

typedef struct matter_pair {
  float absorbed[2], thin[2];
} matter_pair;

DEVICE matter_pair split_matter(float absorbed, float thin, float late) {
  const float depth = log_of_two(greater(1.0f - thin, 1e-6f));
  matter_pair to;
  to.thin[0] = thin > 0.0f ? 1.0f - power_of_two(depth * (1.0f - late)) : 0.0f;
  to.thin[1] = thin > 0.0f ? 1.0f - power_of_two(depth * late) : 0.0f;
  const float solid = divided(absorbed - thin, greater(fused(1.0f - to.thin[1], 1.0f - late, late), 1e-3f));
  to.absorbed[0] = fused(solid, 1.0f - late, to.thin[0]);
  to.absorbed[1] = fused(solid, late, to.thin[1]);
  return to;
}

DEVICE float fraction_at(GLOBAL const word16 *fields, wide at) {
  return (float)fields[at] * (1.0f / PASS_WHOLE);
}
DEVICE void store_fraction(GLOBAL word16 *fields, wide at, float fraction) {
  fields[at] = rounded_pixel(fraction * (float)PASS_WHOLE);
}

DEVICE void split_pixel(GLOBAL const plan_pass *pass, GLOBAL word16 *fields, int number) {
  const int width = pass->tiles_x * 16, x = number % width, y = number / width;
  if (y >= pass->tiles_y * 16) return;
  const wide at = place_in_field(0u, pass->stride, x, y);
  const matter_pair to = split_matter(fraction_at(fields, pass->a + at), fraction_at(fields, pass->thin + at),
                                      pass->late);
  store_fraction(fields, pass->to + at, to.absorbed[0]);
  store_fraction(fields, pass->to_thin + at, to.thin[0]);
  store_fraction(fields, pass->second + at, to.absorbed[1]);
  store_fraction(fields, pass->second_thin + at, to.thin[1]);
}

/* Adds the light that a chunk's slabs absorbed in a pixel to the groups at the chunk's two ends (absorbed_job
 * in shadow_cascade/cascade_field.h). before: the light at the chunk's beginning. taken: the part of this
 * light that the slabs absorbed. moment: the function clears it. counts: whether the slabs absorbed light in
 * the pixel's row of its tile. */
DEVICE void absorb_pixel(GLOBAL const plan_pass *pass, GLOBAL word16 *fields, wide at, float before,
                         float taken, GLOBAL float *moment, int counts) {
  if (!counts) {
    fields[pass->second + at] = 0;
    fields[pass->second_thin + at] = 0;
    return;
  }
  const float fraction = divided(taken, greater(before, 1e-3f));
  const float position = limited(divided(moment[0], greater(taken * pass->length, 1e-6f)), 0.0f, 1.0f);
  const float solid = limited((fraction - THIN_MATTER) * (1.0f / (SOLID_MATTER - THIN_MATTER)), 0.0f, 1.0f);
  const float thin = fraction * (1.0f - solid);
  const matter_pair to = split_matter(fused(taken, solid, thin), thin, position);
  moment[0] = 0.0f;
  store_fraction(fields, pass->second + at, to.absorbed[1]);
  store_fraction(fields, pass->second_thin + at, to.thin[1]);
  const float left = 1.0f - to.thin[0];
  store_fraction(fields, pass->to + at, fused(fraction_at(fields, pass->to + at), left, to.absorbed[0]));
  store_fraction(fields, pass->to_thin + at,
                 fused(fraction_at(fields, pass->to_thin + at), left, to.thin[0]));
}

/* ---- the buffer's pixels at a chunk's end ---- */

DEVICE float outside_umbra(word16 absorbed) {
  const float left = left_by(absorbed);
  return limited(lesser(left, 2.0f * (left - UMBRA)), 0.0f, 1.0f);
}

DEVICE float chunk_transmittance(float end, float start) {
  return start < DARK_AT_START ? 1.0f
                               : lesser(divided(greater(end, 0.0f), greater(start, DARK_AT_START)), 1.0f);
}

/* Refills one channel of a pixel of a light's buffer, from the light that the groups absorbed (pass->a). */
DEVICE void refill_pixel(GLOBAL const device_sweep *plan, GLOBAL const plan_pass *pass,
                         GLOBAL const byte *marks, GLOBAL const word16 *fields, GLOBAL float *planes,
                         GLOBAL float *light_state, GLOBAL float *soft, GLOBAL const int *touched,
                         GLOBAL int *changed, int number) {
  GLOBAL const plan_light *light = &plan->lights[pass->light];
  const light_place place = place_of_member(plan, pass, number);
  const byte mark = marks[pass->marks + (unsigned)(place.tile - light->first_tile)];
  if ((mark & MARK_READ) == 0) return;
  GLOBAL float *state = light_state + (wide)place.tile * (256 * PLANES_OF_SHEET) + place.member;
  GLOBAL float *at_start = soft + ((wide)place.tile * CHANNELS + pass->channel) * 512 + 256 + place.member;
  GLOBAL float *pixel = pixel_in_plane(plan, light, planes, pass->sheet, 0, place.x, place.y);
  const int c = pass->channel;
  const float before = state[c * 256];
  float left = outside_umbra(fields[pass->a + place.at]);
  if (touched[place.tile] == pass->chunk) left = left * chunk_transmittance(before, 1.0f - *at_start);
  const float older = mark & MARK_AGAIN ? greater(before, 0.0f) : left;
  state[(OLDER_PLANE + c) * 256] = older;
  pixel[(OLDER_PLANE + c) * (wide)light->plane] = older;
  state[c * 256] = left;
  pixel[c * (wide)light->plane] = left;
#if OUTSIDE
  const float taken = state[(CHANNELS + c) * 256] - greater(before, 0.0f);
  const float outside = lesser(left + greater(taken, 0.0f), 1.0f);
  state[(CHANNELS + c) * 256] = outside;
  pixel[(CHANNELS + c) * (wide)light->plane] = outside;
#endif
  *at_start = 1.0f - left;
  changed[(wide)place.tile * 256 + place.member] = pass->sheet;
}

#endif

#endif
