/* scene/geometry/lengths.c - see lengths.h. */
#include "scene/geometry/lengths.h"

#include <math.h>

#include "text/units.h"

/* The length in metres of the unit that a volume's file tells; 0 if the file tells no known unit. */
static double metres_of_file(const hl_volume *volume) {
  const hl_unit *unit = volume->unit != NULL ? hl_unit_find(volume->unit) : NULL;
  return unit != NULL ? unit->metres : 0;
}

double hl_scene_world_metres(const hl_scene_description *scene) {
  for (size_t v = 0; v < scene->volume_count; v++) {
    const hl_scene_volume *volume = &scene->volumes[v];
    const double *axes = volume->axis_scale, metres = metres_of_file(volume->volume);
    if (metres > 0 && axes[0] == axes[1] && axes[0] == axes[2]) return metres / fabs(volume->scale * axes[0]);
  }
  return 0;
}

double hl_scene_file_scale(const hl_scene_description *scene, const hl_volume *volume) {
  const double world = hl_scene_world_metres(scene), metres = metres_of_file(volume);
  return world > 0 && metres > 0 ? hl_length_ratio(metres, world) : 1;
}
