/* cli/render_clip.c - `--clip AXIS=LO:HI`: keeps a part of each volume along an axis of its file's world.
 *
 * A bare number is a fraction of the box around the volume's voxels; a number with a unit is a coordinate. An
 * end that is left out stays at the end of the scene's own clip box, or else of the volume.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "input.h"
#include "render.h"
#include "text/plain.h"

bool render_read_coordinate(const char **text, render_coordinate *coordinate) {
  size_t length = strspn(*text, "0123456789+-.eE");
  char *rest;
  *coordinate = (render_coordinate){.given = length > 0};
  if (length == 0) return true;
  coordinate->number = hl_plain_number(*text, &rest);
  if (rest != *text + length || !isfinite(coordinate->number)) return false;
  *text = rest + (strncmp(rest, "mm", 2) == 0 ? 2 : *rest == 'u' ? 1 : 0);
  coordinate->fraction = *text == rest;
  return !coordinate->fraction || (coordinate->number >= 0 && coordinate->number <= 1);
}

bool render_read_range(const char **text, render_axis_range *range) {
  range->axis = **text >= 'x' && **text <= 'z' ? **text - 'x' : -1;
  if (range->axis < 0 || (*text)[1] != '=') return false;
  render_coordinate *low = &range->ends[0], *high = &range->ends[1];
  *text += 2;
  if (!render_read_coordinate(text, low) || *(*text)++ != ':' || !render_read_coordinate(text, high))
    return false;
  bool comparable = low->given && high->given && low->fraction == high->fraction;
  return (low->given || high->given) && (!comparable || low->number < high->number);
}

/* The whole text is a range. */
static bool read_range(const char *text, render_axis_range *range) {
  return render_read_range(&text, range) && *text == '\0';
}

int render_check_clip(const cli_value *clip) {
  render_axis_range range;
  for (int n = 0; n < clip->count; n++)
    if (!read_range(clip->texts[n], &range))
      return fail(EXIT_CODE_USAGE,
                  "--clip: '%s' is not AXIS=LO:HI with LO below HI: fractions from 0 to 1 (x=0:0.5), or "
                  "coordinates in the "
                  "file's own unit, which is written mm or u whatever it is (x=10mm:40mm)",
                  clip->texts[n]);
  return EXIT_CODE_OK;
}

double render_coordinate_of(const render_coordinate *end, double otherwise, double low, double high) {
  if (!end->given) return otherwise;
  return end->fraction ? low + end->number * (high - low) : end->number;
}

int render_clip(const cli_value *clip, hl_scene_volume *volume) {
  double low[3], high[3];
  hl_volume_info info = {.struct_size = sizeof info};
  if (hl_volume_get_info(volume->volume, &info) != HL_OK)
    return fail(EXIT_CODE_FAILURE, "--clip: the volume's place is not known");
  input_world_box(&info, low, high);
  if (!volume->clipped) {
    memcpy(volume->clip_min, low, sizeof low);
    memcpy(volume->clip_max, high, sizeof high);
    volume->clipped = 1;
  }
  for (int n = 0; n < clip->count; n++) {
    render_axis_range range;
    if (!read_range(clip->texts[n], &range)) continue; /* refused before: render_check_clip() */
    double *least = &volume->clip_min[range.axis], *greatest = &volume->clip_max[range.axis];
    *least = render_coordinate_of(&range.ends[0], *least, low[range.axis], high[range.axis]);
    *greatest = render_coordinate_of(&range.ends[1], *greatest, low[range.axis], high[range.axis]);
    if (!(*least < *greatest))
      return fail(EXIT_CODE_USAGE,
                  "--clip: '%s': nothing is left between %.9g and %.9g; the volume goes from %.9g to %.9g",
                  clip->texts[n], *least, *greatest, low[range.axis], high[range.axis]);
  }
  return EXIT_CODE_OK;
}
