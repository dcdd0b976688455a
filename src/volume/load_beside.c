/* volume/load_beside.c - see load_beside.h. */
#include "volume/load_beside.h"

#include <string.h>

#include "core/context.h"
#include "text/units.h"
#include "volume/volume.h"

static void spacing_of(const hl_volume *volume, double spacing[3]) {
  hl_volume_info info = {.struct_size = sizeof info};
  memset(spacing, 0, 3 * sizeof *spacing);
  if (hl_volume_get_info(volume, &info) == HL_OK) memcpy(spacing, info.spacing, 3 * sizeof *spacing);
}

void hl_spacing_beside(const hl_volume *volume, const double stated[3], double spacing[3]) {
  if (stated[0] > 0) memcpy(spacing, stated, 3 * sizeof *spacing);
  else spacing_of(volume, spacing);
}

/* Returns whether a volume's file tells neither the voxels' spacing nor a unit of lengths. The spacing of
 * such a volume is 1. */
static bool tells_no_spacing(const hl_volume *volume) {
  double spacing[3];
  spacing_of(volume, spacing);
  return volume->unit == NULL && !volume->is_anatomical && spacing[0] == 1 && spacing[1] == 1 &&
         spacing[2] == 1;
}

bool hl_takes_spacing_beside(const hl_volume *map, const hl_volume *volume, const double stated[3]) {
  return volume != NULL && memcmp(map->dimension, volume->dimension, sizeof map->dimension) == 0 &&
         (stated[0] > 0 || (tells_no_spacing(map) && !tells_no_spacing(volume)));
}

bool hl_takes_space_beside(const hl_volume *map, const char *stated_space) {
  return stated_space != NULL && map->space == HL_SPACE_UNKNOWN;
}

/* Warns if the boxes of a map and of the volume have no place in common, so that nothing of the map is seen.
 */
static void tell_of_place(hl_context *context, const char *path, const hl_volume *map,
                          const hl_volume *volume) {
  double low[3], high[3], own_low[3], own_high[3];
  hl_volume_info info = {.struct_size = sizeof info};
  if (hl_volume_get_info(volume, &info) != HL_OK) return;
  hl_volume_world_box(&info, low, high);
  if (hl_volume_get_info(map, &info) != HL_OK) return;
  hl_volume_world_box(&info, own_low, own_high);
  const double unit = hl_unit_ratio(map->unit, volume->unit);
  for (int axis = 0; axis < 3; axis++) own_low[axis] *= unit, own_high[axis] *= unit;
  for (int axis = 0; axis < 3; axis++)
    if (own_low[axis] >= high[axis] || own_high[axis] <= low[axis]) {
      hl_log(context, HL_LOG_WARNING,
             "%s: lies beside the volume: %c %.6g to %.6g, where the volume has %.6g to %.6g", path,
             "xyz"[axis], own_low[axis], own_high[axis], low[axis], high[axis]);
      return;
    }
}

hl_status hl_volume_load_beside(hl_context *context, const char *path, const hl_volume *volume,
                                const double stated[3], const char *stated_space,
                                hl_volume_load_options *options, hl_volume **map, hl_error *error) {
  hl_status status = hl_volume_load_with(context, path, options, map, error);
  if (status != HL_OK || volume == NULL) return status;
  const bool spaced = !(options->spacing[0] > 0) && hl_takes_spacing_beside(*map, volume, stated);
  const bool turned = options->file_space == NULL && hl_takes_space_beside(*map, stated_space);
  if (spaced) hl_spacing_beside(volume, stated, options->spacing);
  if (turned) options->file_space = stated_space;
  if (spaced || turned) {
    hl_volume_release(*map);
    *map = NULL;
    status = hl_volume_load_with(context, path, options, map, error);
  }
  if (status == HL_OK) tell_of_place(context, path, *map, volume);
  return status;
}
