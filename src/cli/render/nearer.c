/* cli/render/nearer.c - reads the volumes of pictures that are zoomed in.
 *
 * A volume of several resolutions (OME-Zarr) is read first as for a picture that shows all of it. The options
 * make a scene of it, and the scene has a camera. Then the resolution that the picture deserves is read, but
 * only where the cameras see the volume: elsewhere the first volume is interpolated, for shadows and
 * light. */
#include "cli/input.h"
#include "render.h"

/* Returns whether any of these options is given. */
static bool has_any(const cli_value *values, const int *options, size_t count) {
  for (size_t n = 0; n < count; n++)
    if (values[options[n]].given) return true;
  return false;
}

/* Returns whether the options ask for all voxels of volumes, so that no coarser ones are read first. */
static bool reads_whole(const cli_value *values) {
  static const int whole[] = {RENDER_LEVEL,       RENDER_SPACING, RENDER_SPACE,       RENDER_SLICE,
                              RENDER_LABELS,      RENDER_MASK,    RENDER_VOLUME,      RENDER_STRIPS,
                              RENDER_LABEL_TABLE, RENDER_SHOW,    RENDER_RANGE_OF_ALL};
  return has_any(values, whole, sizeof whole / sizeof *whole);
}

int render_scene_pixels(const cli_value *values) {
  /* options that find a look, a camera or lights by the voxels: a scene says these for its own voxels */
  static const int chosen[] = {
      RENDER_LOOK,  RENDER_TF,          RENDER_COLORMAP,  RENDER_COLOR_BY, RENDER_RANGE,   RENDER_VIEW,
      RENDER_VIEWS, RENDER_RANGE_SCALE, RENDER_THRESHOLD, RENDER_UP,       RENDER_AZIMUTH, RENDER_ELEVATION,
      RENDER_FOVY,  RENDER_ORTHO,       RENDER_LIGHT_RIG, RENDER_WHOLE,    RENDER_SMOOTH};
  const bool is_said = !has_any(values, chosen, sizeof chosen / sizeof *chosen);
  return is_said && !reads_whole(values) ? input_picture_side() : 0;
}

int render_first_pixels(const cli_value *values) {
  const cli_value *zoom = &values[RENDER_ZOOM];
  const bool is_near = zoom->given && zoom->number[0] > 1;
  return is_near && !reads_whole(values) ? render_pixels(values, false) : 0;
}

int render_go_nearer(cli_host *host, const hl_camera *cameras, size_t count, hl_scene **scene) {
  hl_scene *finer = NULL;
  hl_error error = {0};
  hl_status status = hl_scene_read_finer(host->context, *scene, cameras, count, &finer, &error);
  if (status != HL_OK) return host_fail(host, PHASE_READ, status, &error);
  hl_scene_release(*scene);
  *scene = finer;
  return EXIT_CODE_OK;
}
