/* volume/load_beside.c - see load_beside.h. */
#include "volume/load_beside.h"

#include <string.h>

#include "volume/volume.h"

hl_status hl_volume_load_beside(hl_context *context, const char *path, const hl_volume *volume,
                                const double spacing[3], hl_volume_load_options *options, hl_volume **map,
                                hl_error *error) {
  hl_volume_info own = {.struct_size = sizeof own}, other = {.struct_size = sizeof other};
  hl_status status = hl_volume_load_with(context, path, options, map, error);
  if (status != HL_OK || volume == NULL || !(spacing[0] > 0) || options->spacing[0] > 0 ||
      hl_volume_get_info(*map, &own) != HL_OK || hl_volume_get_info(volume, &other) != HL_OK ||
      memcmp(own.dimensions, other.dimensions, sizeof own.dimensions) != 0)
    return status;
  hl_volume_release(*map);
  *map = NULL;
  memcpy(options->spacing, spacing, sizeof options->spacing);
  return hl_volume_load_with(context, path, options, map, error);
}
