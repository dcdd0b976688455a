/* render/sweep_counts.c - adds a sweep's counts and times to the statistics. */
#define _POSIX_C_SOURCE 200809L
#include <time.h>

#include "render/sweep.h"

double hl_clock_seconds(void) {
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

void hl_sweep_count(const sweep *sweep, hl_render_statistics *statistics) {
  double fill = 0, shade = 0, light = 0, composite = 0;
  for (int i = 0; i < hl_pool_threads(sweep->content.pool); i++) {
    statistics->samples_shaded += sweep->counts[i].samples;
    statistics->tiles_filled_image += sweep->counts[i].filled_image;
    statistics->tiles_filled_light += sweep->counts[i].filled_light;
    statistics->tiles_skipped_image += sweep->counts[i].skipped_image;
    statistics->tiles_skipped_light += sweep->counts[i].skipped_light;
    statistics->pixels_filled_image += sweep->counts[i].pixels_image;
    statistics->pixels_filled_light += sweep->counts[i].pixels_light;
    statistics->pixels_skipped_image += sweep->counts[i].pixels_skipped_image;
    statistics->pixels_skipped_light += sweep->counts[i].pixels_skipped_light;
    fill += sweep->counts[i].seconds_fill;
    shade += sweep->counts[i].seconds_shade;
    light += sweep->counts[i].seconds_light;
    composite += sweep->counts[i].seconds_composite;
  }
  if (!sweep->preparatory) statistics->sheets += sweep->geometry->sheets.count;
  statistics->seconds_sort += sweep->seconds_sort;
  double share = fill + shade > 0 ? fill / (fill + shade) : 1;
  statistics->seconds_fill_image += sweep->seconds_image * share;
  statistics->seconds_shade += sweep->seconds_image * (1 - share);
  statistics->seconds_fill_light += sweep->seconds_light;
  if (light > 0) statistics->seconds_composite_light += sweep->seconds_light * composite / light;
  statistics->seconds_soften += sweep->seconds_soften;
}
