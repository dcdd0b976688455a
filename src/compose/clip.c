/* compose/clip.c - applies the option "clip" AXIS=LO:HI, which keeps a part of each volume along an axis of
 * its file's world.
 *
 * A bare number is a fraction of the box around the volume's voxels; a number with a unit is a coordinate. If
 * the option leaves out an end, the part ends where the scene's own clip box ends. Without a clip box, the
 * part ends where the volume ends. */
#include <string.h>

#include "compose/composer.h"
#include "compose/coordinates.h"

/* Reads a text that must be a range and nothing else. */
static bool read_range(const char *text, hl_axis_range *range) {
  return hl_read_range(&text, range) && *text == '\0';
}

hl_status hl_check_clip(const hl_asked *clip, hl_error *error) {
  hl_axis_range range;
  for (int n = 0; n < clip->count; n++)
    if (!read_range(clip->texts[n], &range))
      return hl_fail(
          error, HL_ERROR_ARGUMENT,
          "--clip: '%.300s' is not AXIS=LO:HI with LO below HI: fractions from 0 to 1 (x=0:0.5), or "
          "coordinates in the "
          "file's world with their unit (x=10mm:40mm; u is the file's own unit, whatever it is)",
          clip->texts[n]);
  return HL_OK;
}

hl_status hl_compose_clip(const hl_composer *composer, hl_scene_volume *volume) {
  const hl_asked *clip = &composer->asked[HL_ASK_CLIP];
  hl_error *error = composer->error;
  double low[3], high[3];
  const double metres = hl_metres_of_volume(volume->volume);
  hl_volume_info info = {.struct_size = sizeof info};
  if (hl_volume_get_info(volume->volume, &info) != HL_OK)
    return hl_fail(error, HL_ERROR_INTERNAL, "--clip: the volume's place is not known");
  hl_volume_world_box(&info, low, high);
  if (!volume->clipped) {
    memcpy(volume->clip_min, low, sizeof low);
    memcpy(volume->clip_max, high, sizeof high);
    volume->clipped = 1;
  }
  for (int n = 0; n < clip->count; n++) {
    hl_axis_range range;
    if (!read_range(clip->texts[n], &range)) continue; /* hl_check_clip() has refused such a text before */
    double *least = &volume->clip_min[range.axis], *greatest = &volume->clip_max[range.axis];
    *least = hl_coordinate_of(&range.ends[0], *least, low[range.axis], high[range.axis], metres);
    *greatest = hl_coordinate_of(&range.ends[1], *greatest, low[range.axis], high[range.axis], metres);
    if (!(*least < *greatest))
      return hl_fail(
          error, HL_ERROR_ARGUMENT,
          "--clip: '%.300s': nothing is left between %.9g and %.9g; the volume goes from %.9g to %.9g",
          clip->texts[n], *least, *greatest, low[range.axis], high[range.axis]);
  }
  return HL_OK;
}
