/* cli/render/nearer.c - reads the volumes of pictures that are zoomed in.
 *
 * A volume of several resolutions (OME-Zarr) is read first as for a picture that shows all of it. The options
 * make a scene of it, and the scene has a camera. Then the resolution that the picture deserves is read, but
 * only where the cameras see the volume: elsewhere the first volume is interpolated, for shadows and
 * light. */
#include "render.h"

int render_first_pixels(const cli_value *values) {
  static const int whole[] = {RENDER_LEVEL, RENDER_SPACING,     RENDER_SLICE,  RENDER_LABELS,
                              RENDER_MASK,  RENDER_VOLUME,      RENDER_STRIPS, RENDER_LABEL_TABLE,
                              RENDER_SHOW,  RENDER_RANGE_OF_ALL};
  const cli_value *zoom = &values[RENDER_ZOOM];
  bool once = !zoom->given || !(zoom->number[0] > 1);
  for (size_t n = 0; n < sizeof whole / sizeof *whole; n++) once = once || values[whole[n]].given;
  return once ? 0 : render_pixels(values, false);
}

int render_go_nearer(cli_host *host, const hl_camera *cameras, size_t count, hl_scene **scene) {
  hl_scene *finer = NULL;
  hl_error error = {0};
  if (host->preview_pixels == 0) return EXIT_CODE_OK;
  hl_status status = hl_scene_read_finer(host->context, *scene, cameras, count, &finer, &error);
  if (status != HL_OK) return host_fail(host, PHASE_READ, status, &error);
  hl_scene_release(*scene);
  *scene = finer;
  return EXIT_CODE_OK;
}
