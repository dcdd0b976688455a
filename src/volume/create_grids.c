/* volume/create_grids.c - makes volumes of a caller's meshes of cells (hl_volume_create_cells()) and of a
 * caller's adaptive grids (hl_volume_create_amr()). */
#include <halflight/grids.h>
#include <string.h>

#include "core/context.h"
#include "core/door.h"
#include "core/memory.h"
#include "volume/formats/amr/amr.h"
#include "volume/formats/vtk/cell_mesh.h"

/* ---- meshes of cells ---- */

void hl_cells_description_defaults(hl_cells_description *description) {
  if (description == NULL) return;
  *description = (hl_cells_description){.struct_size = sizeof *description};
}

/* Copies whole numbers to new memory as doubles, the type that the reader of cells takes. */
static double *doubles_of(hl_context *context, const int64_t *numbers, size_t count) {
  double *made = hl_allocate(context, count, sizeof *made);
  for (size_t n = 0; made != NULL && n < count; n++) made[n] = (double)numbers[n];
  return made;
}

static hl_status collect(const hl_cells_description *d, hl_cell_mesh *mesh, hl_error *error) {
  double *ends = doubles_of(mesh->context, d->ends, d->cell_count),
         *corners = doubles_of(mesh->context, d->corners, d->corner_count),
         *types = hl_allocate(mesh->context, d->cell_count, sizeof *types);
  hl_status status = ends != NULL && corners != NULL && types != NULL
                         ? HL_OK
                         : hl_fail_memory(error, d->corner_count * sizeof *corners, mesh->subject);
  for (size_t n = 0; status == HL_OK && n < d->cell_count; n++) types[n] = d->types[n];
  if (status == HL_OK) status = hl_cell_mesh_begin_piece(mesh, d->points, d->point_count, error);
  if (status == HL_OK)
    status = hl_cell_mesh_add_cells(mesh, types, ends, d->cell_count, corners, d->corner_count, error);
  if (status == HL_OK)
    status = hl_cell_mesh_set_values(mesh, d->values, d->of_cells ? d->cell_count : d->point_count, 1, 0,
                                     d->of_cells != 0, error);
  hl_release(mesh->context, ends);
  hl_release(mesh->context, corners);
  hl_release(mesh->context, types);
  return status;
}

hl_status hl_volume_create_cells(hl_context *context, const hl_cells_description *description,
                                 hl_volume **volume, hl_error *error) {
  HL_DOOR;
  static const char subject[] = "hl_volume_create_cells";
  if (volume != NULL) *volume = NULL;
  if (context == NULL || description == NULL || volume == NULL)
    return hl_fail(error, HL_ERROR_ARGUMENT, "%s: context, description and volume must not be null", subject);
  if (description->struct_size != sizeof *description)
    return hl_fail(error, HL_ERROR_ARGUMENT,
                   "%s: struct_size is %zu, expected %zu: call hl_cells_description_defaults first", subject,
                   description->struct_size, sizeof *description);
  if (description->points == NULL || description->types == NULL || description->ends == NULL ||
      description->corners == NULL || description->values == NULL)
    return hl_fail(error, HL_ERROR_ARGUMENT, "%s: points, types, ends, corners and values must not be null",
                   subject);
  hl_cell_mesh mesh = {.context = context, .subject = "the mesh of cells"};
  hl_status status = collect(description, &mesh, error);
  if (status == HL_OK) status = hl_cell_mesh_finish(&mesh, volume, error);
  hl_cell_mesh_release(&mesh);
  return status;
}

/* ---- adaptive grids ---- */

void hl_amr_description_defaults(hl_amr_description *description) {
  if (description == NULL) return;
  *description = (hl_amr_description){.struct_size = sizeof *description, .levels = 1, .spacing = {1, 1, 1}};
}

static hl_status add_patch(hl_amr *amr, const hl_patch *patch, hl_error *error) {
  ptrdiff_t first[3];
  if (patch->values == NULL)
    return hl_fail(error, HL_ERROR_ARGUMENT, "%s: a patch without values", amr->subject);
  for (int axis = 0; axis < 3; axis++) {
    if (patch->first[axis] <= INT32_MIN || patch->first[axis] >= INT32_MAX)
      return hl_fail(error, HL_ERROR_INPUT, "%s: a patch begins at cell %lld: beyond 2^31", amr->subject,
                     (long long)patch->first[axis]);
    first[axis] = (ptrdiff_t)patch->first[axis];
  }
  return hl_amr_add(amr, patch->level, first, patch->count, patch->values, error);
}

hl_status hl_volume_create_amr(hl_context *context, const hl_amr_description *description, hl_volume **volume,
                               hl_error *error) {
  HL_DOOR;
  static const char subject[] = "hl_volume_create_amr";
  if (volume != NULL) *volume = NULL;
  if (context == NULL || description == NULL || volume == NULL)
    return hl_fail(error, HL_ERROR_ARGUMENT, "%s: context, description and volume must not be null", subject);
  if (description->struct_size != sizeof *description)
    return hl_fail(error, HL_ERROR_ARGUMENT,
                   "%s: struct_size is %zu, expected %zu: call hl_amr_description_defaults first", subject,
                   description->struct_size, sizeof *description);
  if (description->patches == NULL || (description->levels > 1 && description->ratios == NULL))
    return hl_fail(error, HL_ERROR_ARGUMENT, "%s: patches and ratios must not be null", subject);
  hl_amr_shape shape = {.levels = description->levels};
  hl_amr amr = {.context = context};
  for (int level = 0; level + 1 < shape.levels && level < HL_AMR_LEVELS_MOST; level++)
    shape.ratio[level] = description->ratios[level];
  for (int axis = 0; axis < 3; axis++)
    shape.first[axis] = description->first[axis] > INT32_MIN && description->first[axis] < INT32_MAX
                            ? (ptrdiff_t)description->first[axis]
                            : INT32_MAX; /* hl_amr_begin() refuses the index INT32_MAX */
  memcpy(shape.count, description->count, sizeof shape.count);
  memcpy(shape.origin, description->origin, sizeof shape.origin);
  memcpy(shape.spacing, description->spacing, sizeof shape.spacing);
  hl_status status = hl_amr_begin(context, &shape, "the adaptive grid", &amr, error);
  for (size_t n = 0; n < description->patch_count && status == HL_OK; n++)
    status = add_patch(&amr, &description->patches[n], error);
  if (status == HL_OK) status = hl_amr_finish(&amr, volume, error);
  hl_amr_close(&amr);
  return status;
}
