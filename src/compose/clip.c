/* compose/clip.c - applies the option "clip" AXIS=LO:HI,..., which keeps a part of each volume along axes of
 * its file's world.
 *
 * A bare number is a fraction of the box around the volume's voxels; a number with a unit is a coordinate. An
 * end that is left out stays where the scene's own clip box has it; without a clip box it is the end of the
 * volume. NAME=AXIS=LO:HI clips the volume NAME alone. */
#include <string.h>

#include "compose/composer.h"
#include "compose/coordinates.h"

/* Reads a box that may begin with NAME=. Returns the part of the text after NAME=, or null if the text is no
 * box. */
static const char *read_clip(const char *text, hl_axis_range box[3]) {
  const char *equals = strchr(text, '=');
  if (hl_read_box(text, box)) return text;
  return equals != NULL && hl_read_box(equals + 1, box) ? equals + 1 : NULL;
}

hl_status hl_check_clip(const hl_asked *clip, hl_error *error) {
  hl_axis_range box[3];
  for (int n = 0; n < clip->count; n++) {
    if (read_clip(clip->texts[n], box) != NULL) continue;
    const hl_status status = hl_refuse_side("clip", clip->texts[n], error);
    if (status != HL_OK) return status;
    return hl_fail(
        error, HL_ERROR_ARGUMENT,
        "--clip: '%.300s' is not AXIS=LO:HI,... with LO below HI: fractions from 0 to 1 (x=0:0.5), or "
        "coordinates in the "
        "file's world with their unit (x=10mm:40mm; u is the file's own unit, whatever it is)",
        clip->texts[n]);
  }
  return HL_OK;
}

hl_status hl_check_clip_names(const hl_composer *composer, const hl_scene_description *description) {
  const hl_asked *clip = &composer->asked[HL_ASK_CLIP];
  hl_axis_range box[3];
  hl_status status = HL_OK;
  for (int n = 0; n < clip->count && status == HL_OK; n++)
    if (read_clip(clip->texts[n], box) != clip->texts[n])
      status = hl_check_volume_name(composer, HL_ASK_CLIP, clip->texts[n], description);
  return status;
}

hl_status hl_compose_clip(const hl_composer *composer, hl_scene_volume *volume, size_t index) {
  const hl_asked *clip = &composer->asked[HL_ASK_CLIP];
  hl_error *error = composer->error;
  double low[3], high[3];
  const double metres = hl_metres_of_volume(volume->volume);
  hl_volume_info info = {.struct_size = sizeof info};
  if (hl_volume_get_info(volume->volume, &info) != HL_OK)
    return hl_fail(error, HL_ERROR_INTERNAL, "--clip: the volume's place is not known");
  hl_volume_world_box(&info, low, high);
  for (int n = 0; n < clip->count; n++) {
    hl_axis_range box[3];
    const char *rest, *text = read_clip(clip->texts[n], box);
    if (text == NULL) continue; /* hl_check_clip() has refused such a text before */
    if (text != clip->texts[n] && !hl_text_is_for(composer, clip->texts[n], volume, index, &rest)) continue;
    if (!volume->clipped) {
      memcpy(volume->clip_min, low, sizeof low);
      memcpy(volume->clip_max, high, sizeof high);
      volume->clipped = 1;
    }
    for (int axis = 0; axis < 3; axis++) {
      const hl_coordinate *ends = box[axis].ends;
      double *least = &volume->clip_min[axis], *greatest = &volume->clip_max[axis];
      if (!hl_range_is_given(&box[axis])) continue;
      *least = hl_coordinate_of(&ends[0], *least, low[axis], high[axis], metres);
      *greatest = hl_coordinate_of(&ends[1], *greatest, low[axis], high[axis], metres);
      if (!(*least < *greatest))
        return hl_fail(
            error, HL_ERROR_ARGUMENT,
            "--clip: '%.300s': nothing is left between %.9g and %.9g; the volume goes from %.9g to %.9g",
            clip->texts[n], *least, *greatest, low[axis], high[axis]);
    }
  }
  return HL_OK;
}
