/* render/sweep_counts.h - what a sweep counts and how long its stages take. */
#ifndef HL_RENDER_SWEEP_COUNTS_H
#define HL_RENDER_SWEEP_COUNTS_H

#include <stdint.h>

/* Seconds of a clock that never runs backwards. */
double hl_clock_seconds(void);

/* One thread's counts, on cache lines of its own. */
typedef struct sweep_counts {
  _Alignas(64) uint64_t samples, filled_image, filled_light, skipped_image,
      skipped_light; /* pixels shaded; tiles */
  uint64_t pixels_image, pixels_light, pixels_skipped_image, pixels_skipped_light;
  uint64_t pixels_seen, pixels_covered; /* counted only by the sweep of hidden.c */
  double seconds_fill, seconds_shade;   /* of the image stage */
  double seconds_light;                 /* the light stage */
  double seconds_composite;             /* the compositing in it */
} sweep_counts;

#endif
