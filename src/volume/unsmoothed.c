/* volume/unsmoothed.c - see unsmoothed.h. */
#include "volume/unsmoothed.h"

#include "core/context.h"
#include "core/door.h"
#include "volume/exact.h"
#include "volume/store/glimpse.h"
#include "volume/store/pages.h"

/* The number of slices that are stored before the next check for cancellation. */
enum { SLICES_AT_ONCE = 8 };

/* Stores all voxels of a volume whose rows and slices have no gaps. Returns false if the user has
 * cancelled. */
static bool store_voxels(const hl_volume *volume, hl_pages *pages) {
  const size_t *n = volume->dimension, slice = n[0] * n[1];
  for (size_t k = 0, count; k < n[2]; k += count) {
    if (hl_cancelled(volume->context)) return false;
    count = n[2] - k < SLICES_AT_ONCE ? n[2] - k : SLICES_AT_ONCE;
    hl_pages_store(pages, k * slice, count * slice, hl_volume_row(volume, 0, k));
  }
  return true;
}

/* Writes the file's own numbers, if the volume has such numbers beside the stored values, to the second
 * scratch file. */
static hl_status store_exact(const hl_volume *volume, hl_pages *pages) {
  const size_t count = hl_volume_voxel_count(volume);
  hl_exact exact;
  if (volume->exact == NULL) return HL_OK;
  hl_exact_begin(volume->context, volume->type, count, HL_EXACT_IN_FILE, &exact);
  hl_exact_note(&exact, false, volume->exact, 0, count);
  hl_status status = hl_exact_take_file(&exact, &pages->exact_file, NULL);
  hl_exact_release(&exact);
  return status;
}

/* Makes a copy of a volume in a scratch file. *copy is owned by the caller. */
static hl_status copy_to_pages(const hl_volume *volume, hl_volume **copy) {
  hl_context *context = volume->context;
  hl_volume_description grid = hl_volume_own_grid(volume);
  hl_pages *pages = NULL;
  grid.type = volume->type;
  grid.value_scale = volume->value_scale;
  grid.value_offset = volume->value_offset + volume->value_scale * hl_voxel_type_bias(volume->type);
  hl_status status = hl_pages_create(context, context->options.scratch_folder, &grid, PAGE_SHIFT, &pages,
                                     NULL);
  if (status != HL_OK) return status;
  /* the copy needs no glimpse, because automatic choices use the glimpse of the volume itself */
  hl_glimpse_release(pages->glimpse);
  pages->glimpse = NULL;
  if (!store_voxels(volume, pages)) status = HL_ERROR_CANCELLED;
  if (status == HL_OK) status = store_exact(volume, pages);
  if (status != HL_OK) {
    hl_pages_release(pages);
    return status;
  }
  status = hl_volume_adopt_pages(context, &grid, "unsmoothed voxels", pages, copy, NULL);
  if (status == HL_OK) status = hl_volume_take_about(*copy, volume, NULL);
  if (status != HL_OK) {
    hl_volume_release(*copy);
    *copy = NULL;
  }
  return status;
}

hl_status hl_volume_keep_unsmoothed(hl_volume *smoothed, hl_volume *volume, hl_error *error) {
  const hl_context_options *options = &volume->context->options;
  hl_volume *kept = volume->unsmoothed != NULL ? volume->unsmoothed : volume, *copy = NULL;
  if (!options->keep_unsmoothed) return HL_OK;
  if (kept == volume && volume->owned_voxels != NULL && options->scratch_folder != NULL &&
      copy_to_pages(volume, &copy) == HL_ERROR_CANCELLED)
    return hl_fail(error, HL_ERROR_CANCELLED, "cancelled while unsmoothed voxels were kept");
  if (copy == NULL) hl_volume_retain(kept);
  smoothed->unsmoothed = copy != NULL ? copy : kept;
  return HL_OK;
}

const hl_volume *hl_volume_unsmoothed(const hl_volume *volume) {
  HL_DOOR;
  return volume != NULL ? volume->unsmoothed : NULL;
}
