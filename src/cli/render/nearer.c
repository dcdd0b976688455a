/* cli/render/nearer.c - reads the volume of a picture that is zoomed in.
 *
 * A volume of several resolutions (OME-Zarr) is read first as for a picture that shows all of it. The options
 * give this scene its camera. Then the resolution that the picture deserves is read, but only where the
 * camera sees the volume: elsewhere the first volume is interpolated, for shadows and light. */
#include <halflight/compose.h>
#include <string.h>

#include "cli/input.h"
#include "render.h"

int render_first_pixels(const cli_value *values, int count) {
  static const int whole[] = {RENDER_LEVEL,  RENDER_SPACING, RENDER_SLICE,       RENDER_LABELS, RENDER_MASK,
                              RENDER_VOLUME, RENDER_STRIPS,  RENDER_LABEL_TABLE, RENDER_SHOW};
  const cli_value *zoom = &values[RENDER_ZOOM];
  bool once = count != 1 || !zoom->given || !(zoom->number[0] > 1) ||
              input_has_channels(&values[RENDER_CHANNEL]);
  for (size_t n = 0; n < sizeof whole / sizeof *whole; n++) once = once || values[whole[n]].given;
  return once ? 0 : render_pixels(values, false);
}

/* Finds which resolution was read. Returns false if the scene has not one volume. */
static bool find_selection(const hl_scene *scene, hl_volume_selection *read) {
  const hl_scene_description *description = hl_scene_describe(scene);
  *read = (hl_volume_selection){.struct_size = sizeof *read};
  return description->volume_count == 1 &&
         hl_volume_get_selection(description->volumes[0].volume, read) == HL_OK;
}

bool render_is_first(const hl_scene *scene) {
  hl_volume_selection read;
  return find_selection(scene, &read) && read.level != read.aim;
}

/* Puts the camera of the first scene in the place of the scene's own. */
static int take_camera(cli_host *host, const hl_scene *first, hl_scene **scene) {
  const hl_scene_description *from = hl_scene_describe(first);
  hl_scene_description description = *hl_scene_describe(*scene);
  hl_scene *taken = NULL;
  hl_error error = {0};
  description.camera = from->camera;
  memcpy(description.sky.up, from->sky.up, sizeof description.sky.up);
  hl_status status = hl_scene_create(host->context, &description, &taken, &error);
  if (status != HL_OK) return host_fail(host, PHASE_CHANGE, status, &error);
  hl_scene_release(*scene);
  *scene = taken;
  return EXIT_CODE_OK;
}

/* Notes the part of the scene that the first scene's camera sees. Label maps are read whole, since numbers
 * between two labels are other labels. */
static void note_seen_part(cli_host *host, const hl_scene *first) {
  const hl_scene_description *description = hl_scene_describe(first);
  const hl_scene_volume *volume = &description->volumes[0];
  const char *kind = "";
  hl_volume_selection read;
  bool partly = find_selection(first, &read) && volume->label_count == 0 &&
                hl_volume_guess(volume->volume, NULL, &kind, NULL) == HL_OK && strcmp(kind, "labels") != 0 &&
                hl_scene_seen_part(description, host->seen.planes) == HL_OK;
  host->seen.coarse = partly ? volume->volume : NULL;
  host->seen.level = read.aim;
  host->seen.time = read.times > 1 ? read.time : HL_INDEX_DEFAULT;
  host->seen.channel = read.channels > 1 ? read.channel : HL_INDEX_DEFAULT;
}

int render_go_nearer(cli_host *host, const cli_value *values, char **operands, hl_scene **scene) {
  hl_scene *first = *scene;
  const bool quiet = host->quiet;
  bool bare;
  *scene = NULL;
  host->quiet = true; /* the options warn when they are applied again */
  int exit_code = render_change_scene(host, values, true, 0, &first);
  host->quiet = quiet;
  if (exit_code == EXIT_CODE_OK) {
    note_seen_part(host, first);
    host->preview_pixels = 0;
    exit_code = render_load_inputs(host, values, operands, &bare, scene);
    host->seen.coarse = NULL;
  }
  if (exit_code == EXIT_CODE_OK) exit_code = take_camera(host, first, scene);
  if (exit_code == EXIT_CODE_OK)
    exit_code = render_change_scene(host, values, true, HL_COMPOSE_CAMERA, scene);
  hl_scene_release(first);
  return exit_code;
}
