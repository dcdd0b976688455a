/* image/tone.c - how bright light fits into the range of a PNG.
 *
 * In: the linear light of one pixel. Out: a factor on it. The encoder applies it before the sRGB curve
 * (codes.c).
 */
#include "image/tone.h"

#include <float.h>

#define SHOULDER 0.6f /* light up to SHOULDER is left unchanged; the sRGB code of SHOULDER is 203 of 255 */

/* Maps light x from the value s on. Derived: the hyperbola that leaves the line f(x) = x at s with slope 1
 * and comes near 1 for endless light is f(x) = 1 - d^2 / (x - s + d), d = 1 - s: f(s) = s, f'(x) = d^2 / (x -
 * s + d)^2. Twice the light of white, 1, comes to 0.911, four times to 0.958. */
static float shoulder(float x) {
  const float rest = 1 - SHOULDER;
  return x > SHOULDER ? 1 - rest * rest / (x - SHOULDER + rest) : x;
}

float hl_tone_factor(hl_tone tone, const float light[3]) {
  if (tone != HL_TONE_FILMIC) return 1;
  float brightest = light[0] > light[1] ? light[0] : light[1];
  if (light[2] > brightest) brightest = light[2];
  if (!(brightest > SHOULDER)) return 1;
  if (brightest > FLT_MAX) brightest = FLT_MAX;
  return shoulder(brightest) / brightest;
}
