/* scatter/sky.c - finds the sky's light that enters the grid at both ends of each of its lines. */
#include "scene/light/sky.h"
#include "elementary/elementary.h"

#include <math.h>

#include "scatter/parts.h"

/* The sky is sampled in BANDS bands of equal height. If the sky's image has more rows, there is a band for
 * each row, up to MOST_BANDS. */
enum { BANDS = 64, MOST_BANDS = 512 };

enum { DIRECTIONS = 2 * SCATTER_LINES };

/* The radiance of the sky, summed up for each direction of the grid in which light travels: first for the
 * directions of all lines, then for the opposite directions. */
typedef struct sky_sums {
  vec3 directions[DIRECTIONS];
  double sums[DIRECTIONS][3], samples[DIRECTIONS];
} sky_sums;

/* Among the directions of the grid, the number of the direction that is nearest to the direction in which
 * light of the sky travels. from: the direction from which the light comes, which is opposite to its
 * travel. */
static int nearest_direction(const sky_sums *sums, vec3 from) {
  int nearest = 0;
  double greatest = -INFINITY;
  for (int d = 0; d < DIRECTIONS; d++) {
    double cosine = -vec3_dot(sums->directions[d], from);
    if (cosine > greatest) greatest = cosine, nearest = d;
  }
  return nearest;
}

static void add_bands(const hl_sky *sky, int bands, sky_sums *sums) {
  const sky_axes axes = hl_sky_axes(sky);
  for (int i = 0; i < 2 * bands * bands; i++) {
    double height = 1 - (i / (2 * bands) + 0.5) * 2 / bands, turn = HL_PI * (i % (2 * bands) + 0.5) / bands;
    double side = sqrt(fmax(1 - height * height, 0)), radiance[3];
    vec3 level = vec3_add(vec3_scale(axes.middle, side * hl_cos(turn)),
                          vec3_scale(axes.right, side * hl_sin(turn)));
    vec3 from = vec3_add(level, vec3_scale(axes.up, height));
    int d = nearest_direction(sums, from);
    hl_sky_radiance(sky, &axes, from, radiance);
    for (int c = 0; c < 3; c++) sums->sums[d][c] += radiance[c];
    sums->samples[d]++;
  }
}

void hl_scatter_sky_inflow(const hl_sky *sky, scatter_inflow inflow[3]) {
  sky_sums sums = {.samples = {0}};
  for (int d = 0; d < DIRECTIONS; d++)
    sums.directions[d] = hl_scatter_way(d % SCATTER_LINES, d < SCATTER_LINES);
  int bands = sky->type == HL_SKY_IMAGE && sky->height > BANDS ? sky->height : BANDS;
  bands = bands < MOST_BANDS ? bands : MOST_BANDS;
  add_bands(sky, bands, &sums);
  for (int c = 0; c < 3; c++) {
    double total = 0, taken = 0;
    for (int d = 0; d < DIRECTIONS; d++) {
      total += sums.sums[d][c] / (2.0 * bands * bands);
      taken += (double)hl_scatter_line_weight(d % SCATTER_LINES) / 2 * sums.sums[d][c] / sums.samples[d];
    }
    double scale = taken > 0 ? total / taken : 0;
    for (int line = 0; line < SCATTER_LINES; line++) {
      int back = line + SCATTER_LINES;
      inflow[c].along[line] = (float)(scale * sums.sums[line][c] / sums.samples[line]);
      inflow[c].against[line] = (float)(scale * sums.sums[back][c] / sums.samples[back]);
    }
  }
}
