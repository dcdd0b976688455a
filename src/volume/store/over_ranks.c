/* volume/store/over_ranks.c - makes volumes whose voxels lie in the memory of several ranks
 * (halflight/ranks.h).
 *
 * In: this rank's block, which is a caller's block, or slices that destination.c has stored from a file. Out:
 * a volume whose pages (pages.h) are fetched from the ranks. */
#include "core/door.h"
#include "core/memory.h"
#include "volume/store/own_voxels.h"
#include "volume/store/pages.h"

static const char subject[] = "hl_volume_create_over_ranks";

static hl_status check(const hl_ranks *ranks, const hl_volume_description *whole, const hl_block *block,
                       hl_volume **volume, hl_error *error) {
  if (ranks == NULL || whole == NULL || block == NULL || volume == NULL)
    return hl_fail(error, HL_ERROR_ARGUMENT, "%s: ranks, whole, block and volume must not be null", subject);
  if (whole->struct_size != sizeof *whole || block->struct_size != sizeof *block)
    return hl_fail(error, HL_ERROR_ARGUMENT, "%s: struct_size is %zu and %zu, expected %zu and %zu", subject,
                   whole->struct_size, block->struct_size, sizeof *whole, sizeof *block);
  if (hl_volume_check_grid(whole, subject, error) != HL_OK) {
    if (error != NULL) error->code = HL_ERROR_ARGUMENT;
    return HL_ERROR_ARGUMENT;
  }
  size_t voxels = 1;
  for (int axis = 0; axis < 3; axis++) {
    if (block->size[axis] > whole->dimensions[axis] || block->ghost[axis] > INT32_MAX)
      return hl_fail(error, HL_ERROR_ARGUMENT, "%s: the block is larger than the volume along axis %d",
                     subject, axis);
    voxels *= block->size[axis];
  }
  if (voxels > 0 && block->voxels == NULL)
    return hl_fail(error, HL_ERROR_ARGUMENT, "%s: voxels is null", subject);
  return HL_OK;
}

hl_status hl_volume_over_ranks(hl_ranks *ranks, const hl_volume_description *whole, hl_own_voxels *own,
                               int shift, const char *name, hl_volume **volume, hl_error *error) {
  hl_pages *pages = NULL;
  *volume = NULL;
  hl_status status = hl_pages_create_over_ranks(ranks, own, whole, shift, &pages, error);
  return status == HL_OK ? hl_volume_adopt_pages(ranks->context, whole, name, pages, volume, error) : status;
}

hl_status hl_volume_create_over_ranks(hl_ranks *ranks, const hl_volume_description *whole,
                                      const hl_block *block, hl_volume **volume, hl_error *error) {
  HL_DOOR;
  hl_own_voxels *own = NULL;
  if (volume != NULL) *volume = NULL;
  hl_status status = check(ranks, whole, block, volume, error);
  if (status == HL_OK) status = hl_own_voxels_borrow(ranks, whole, block, &own, error);
  return status == HL_OK ? hl_volume_over_ranks(ranks, whole, own, PAGE_SHIFT, subject, volume, error)
                         : status;
}
