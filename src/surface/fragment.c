/* surface/fragment.c - see fragment.h. */
#include "surface/fragment.h"

#include "surface/sample_rows.h"

/* Counts the set bits in each of four 16-bit words. */
static uint64_t count_bits(uint64_t words) {
  const uint64_t pairs = 0x5555555555555555u, fours = 0x3333333333333333u, eights = 0x0f0f0f0f0f0f0f0fu;
  words -= words >> 1 & pairs;
  words = (words & fours) + (words >> 2 & fours);
  words = (words + (words >> 4)) & eights;
  return (words + (words >> 8)) & 0x00ff00ff00ff00ffu;
}

/* Adds up the column numbers, or the row numbers, of some samples of a pixel. Word b of `set` holds the
 * samples in whose column or row number bit b is set. */
static int sum_places(uint16_t samples, uint64_t set) {
  uint64_t count = count_bits(samples * 0x0001000100010001u & set);
  return (int)((count & 255) + 2 * (count >> 16 & 255) + 4 * (count >> 32 & 255) + 8 * (count >> 48));
}

void hl_fragment_middle(uint16_t samples, double *u, double *v) {
  int count = (int)count_bits(samples), x = sum_places(samples, 0xff00f0f0ccccaaaau),
      y = sum_places(samples, SAMPLE_ROW_BITS);
  *u = ((double)x / count + 0.5) / FRAGMENT_SAMPLES;
  *v = ((double)y / count + 0.5) / FRAGMENT_SAMPLES;
}
