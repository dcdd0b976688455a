/* compose/clip.c - applies the option "clip" AXIS=LO:HI,..., which keeps a part of each volume along axes of
 * the world of the volume's file.
 *
 * A bare number is a fraction of the box around the volume's voxels; a number
 * with a unit is a coordinate. An end that the text leaves out is the end of the scene's own clip box, or
 * without a clip box the end of the volume. A text NAME=AXIS=LO:HI clips the volume NAME alone. */
#include <math.h>
#include <string.h>

#include "compose/composer.h"
#include "compose/coordinates.h"
#include "core/context.h"

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

/* Judges the ends between which a clip keeps a volume along an axis. Refuses ends that leave nothing of the
 * picture's only volume. If the picture has several volumes, an option may clip one away, and a warning is
 * logged. */
static hl_status judge_ends(const hl_composer *composer, const char *text, const double ends[2], int axis,
                            const hl_world_box *bounds, bool alone) {
  char place[HL_BOX_TEXT];
  if (fmax(ends[0], bounds->low[axis]) < fmin(ends[1], bounds->high[axis])) return HL_OK;
  hl_describe_box(bounds, "volume", place);
  if (alone || !(ends[0] < ends[1]))
    return hl_fail(composer->error, HL_ERROR_ARGUMENT,
                   "--clip: '%.300s': nothing is left between %.9g and %.9g: %s", text, ends[0], ends[1],
                   place);
  hl_log(composer->context, HL_LOG_WARNING, "--clip '%.300s' leaves nothing of a volume: %s", text, place);
  return HL_OK;
}

hl_status hl_compose_clip(const hl_composer *composer, hl_scene_volume *volume, size_t index, bool alone) {
  const hl_asked *clip = &composer->asked[HL_ASK_CLIP];
  hl_world_box bounds;
  if (!hl_world_box_of(volume->volume, composer->asked[HL_ASK_UNIT].text, &bounds))
    return hl_fail(composer->error, HL_ERROR_INTERNAL, "--clip: the volume's place is not known");
  const double *low = bounds.low, *high = bounds.high, metres = hl_metres_of_box(&bounds);
  for (int n = 0; n < clip->count; n++) {
    hl_axis_range box[3];
    const char *rest, *text = read_clip(clip->texts[n], box);
    if (text == NULL) continue; /* hl_check_clip() has refused such a text before */
    if (text != clip->texts[n] && !hl_text_is_for(composer, clip->texts[n], volume, index, &rest)) continue;
    if (!volume->clipped) {
      memcpy(volume->clip_min, low, sizeof volume->clip_min);
      memcpy(volume->clip_max, high, sizeof volume->clip_max);
      volume->clipped = 1;
    }
    for (int axis = 0; axis < 3; axis++) {
      const hl_coordinate *ends = box[axis].ends;
      double *least = &volume->clip_min[axis], *greatest = &volume->clip_max[axis];
      if (!hl_range_is_given(&box[axis])) continue;
      *least = hl_coordinate_of(&ends[0], *least, low[axis], high[axis], metres);
      *greatest = hl_coordinate_of(&ends[1], *greatest, low[axis], high[axis], metres);
      const hl_status status = judge_ends(composer, clip->texts[n], (double[]){*least, *greatest}, axis,
                                          &bounds, alone);
      if (status != HL_OK) return status;
    }
  }
  return HL_OK;
}
