/* light/light_screen_lanes.h - what a light's image gives at sixteen samples. */
#ifndef HL_LIGHT_LIGHT_SCREEN_LANES_H
#define HL_LIGHT_LIGHT_SCREEN_LANES_H

#include "light/light_screen.h"
#include "splat/rays_lanes.h"

/* How far within the screen's two edges of one axis a place is: 0 to 1 over one pixel of the picture. */
LANES_INLINE lanes within_edges(lanes u, float size, float sharpness) {
  return lanes_clamp(u * sharpness + 0.5f, 0, 1) * lanes_clamp((size - u) * sharpness + 0.5f, 0, 1);
}

/* One axis of a bilinear lookup: the two pixels, held at the image's borders, and the way between them. */
typedef struct screen_taps { lanes_int first, second; lanes part; } screen_taps;

LANES_INLINE screen_taps taps_at(lanes u, int size) {
  lanes at = lanes_clamp(u - 0.5f, 0, (float)(size - 1));
  screen_taps taps = {.first = lanes_truncate(at)};
  taps.part = at - lanes_from_int(taps.first);
  lanes_int next = taps.first + 1, last = lanes_set_int(size - 1);
  taps.second = lanes_select_int(next > last, last, next);
  return taps;
}

/* light_color(x) of eq. (2) at samples of frame space. */
LANES_INLINE void screen_pattern(const light_screen *screen, lanes3 position, lanes pattern[3]) {
  lanes place[3];
  for (int row = 0; row < 3; row++)
    place[row] = position.x * screen->map[row][0] + position.y * screen->map[row][1] +
                 (position.z * screen->map[row][2] + screen->map[row][3]);
  lanes_int ahead = place[0] > 0.0f;
  lanes safe = lanes_select(ahead, place[0], lanes_set(1.0f)), u = place[1] / safe, v = place[2] / safe;
  lanes inside = within_edges(u, (float)screen->width, screen->sharpness[0]) *
                 within_edges(v, (float)screen->height, screen->sharpness[1]);
  inside = lanes_keep(ahead, inside);
  if (lanes_bits(inside > 0.0f) == 0) {
    pattern[0] = pattern[1] = pattern[2] = lanes_set(0);
    return;
  }
  screen_taps x = taps_at(u, screen->width), y = taps_at(v, screen->height);
  lanes_int top = y.first * (int32_t)screen->width, bottom = y.second * (int32_t)screen->width;
  lanes_int at[4] = {(top + x.first) * 3, (top + x.second) * 3, (bottom + x.first) * 3, (bottom + x.second) * 3};
  for (int c = 0; c < 3; c++) {
    lanes a = lanes_gather(screen->pixels + c, at[0]), b = lanes_gather(screen->pixels + c, at[1]);
    lanes d = lanes_gather(screen->pixels + c, at[2]), e = lanes_gather(screen->pixels + c, at[3]);
    lanes upper = a + (b - a) * x.part, lower = d + (e - d) * x.part;
    pattern[c] = (upper + (lower - upper) * y.part) * inside;
  }
}

#endif
