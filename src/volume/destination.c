/* volume/destination.c - see destination.h. */
#include "volume/destination.h"

#include "core/context.h"
#include "core/memory.h"
#include "volume/convert.h"

hl_status hl_destination_open(hl_context *context, const hl_volume_description *grid,
                              hl_destination_kind kind, const char *path, hl_destination *destination,
                              hl_error *error) {
  size_t count = grid->dimensions[0] * grid->dimensions[1] * grid->dimensions[2];
  size_t bytes = kind == HL_DESTINATION_COLORS ? HL_COLOR_BYTES
                                               : hl_storage_bytes(hl_voxel_type_storage(grid->type));
  *destination = (hl_destination){.context = context, .path = path, .voxel_bytes = bytes};
  if (kind == HL_DESTINATION_PIECES && hl_pages_wanted(context, grid))
    return hl_pages_create(context, context->options.scratch_folder, grid, PAGE_SHIFT, &destination->pages,
                           error);
  destination->voxels = hl_allocate(context, count, bytes);
  return destination->voxels != NULL ? HL_OK : hl_fail_memory(error, count * bytes, path);
}

hl_status hl_destination_take(hl_destination *destination, size_t first, size_t count, void **place,
                              hl_error *error) {
  size_t bytes = destination->voxel_bytes;
  *place = destination->pages == NULL ? destination->voxels + first * bytes
                                      : hl_allocate(destination->context, count, bytes);
  return *place != NULL ? HL_OK : hl_fail_memory(error, count * bytes, destination->path);
}

void hl_destination_put(hl_destination *destination, size_t first, size_t count, void *place) {
  if (destination->pages == NULL || place == NULL) return;
  hl_pages_store(destination->pages, first, count, place);
  hl_release(destination->context, place);
}

hl_status hl_destination_adopt(hl_destination *destination, const hl_volume_description *grid,
                               hl_volume **volume, hl_error *error) {
  const hl_destination given = *destination;
  destination->voxels = NULL;
  destination->pages = NULL;
  return given.pages != NULL
             ? hl_volume_adopt_pages(given.context, grid, given.path, given.pages, volume, error)
             : hl_volume_adopt(given.context, grid, given.path, given.voxels, volume, error);
}

hl_status hl_destination_adopt_colors(hl_destination *destination, const hl_color_source *source,
                                      hl_volume **volume, hl_error *error) {
  unsigned char *colors = destination->voxels;
  destination->voxels = NULL;
  return hl_volume_adopt_colors(destination->context, source, colors, volume, error);
}

void hl_destination_close(hl_destination *destination) {
  hl_release(destination->context, destination->voxels);
  hl_pages_release(destination->pages);
  *destination = (hl_destination){.context = NULL};
}
