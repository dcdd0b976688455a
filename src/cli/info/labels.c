/* cli/info/labels.c - see labels.h. */
#include "labels.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "text/units.h"

/* Adds the map's voxels to the counts of their labels. labels: [count], rising by value. */
static void count_voxels(const hl_volume *map, const hl_volume_info *info, const hl_label *labels,
                         size_t count, uint64_t *voxels) {
  size_t last = 0;
  for (size_t k = 0; k < info->dimensions[2]; k++)
    for (size_t j = 0; j < info->dimensions[1]; j++)
      for (size_t i = 0; i < info->dimensions[0]; i++) {
        const double value = hl_volume_value(map, i, j, k);
        if (value == 0 || !isfinite(value)) continue;
        if ((double)labels[last].value != value) { /* neighbours mostly have one label */
          size_t low = 0, high = count;
          while (low < high) {
            const size_t middle = low + (high - low) / 2;
            if ((double)labels[middle].value < value) low = middle + 1;
            else high = middle;
          }
          if (low == count || (double)labels[low].value != value) continue;
          last = low;
        }
        voxels[last]++;
      }
}

/* The number of cubes with an edge of a unit in a millilitre, which is a cube with an edge of a centimetre.
 */
static double per_millilitre(const hl_unit *unit) {
  const double edge = hl_length_ratio(1e-2, unit->metres);
  return edge * edge * edge;
}

static void print_json(json_writer *json, const hl_label *labels, size_t count, const uint64_t *voxels,
                       double voxel, const hl_unit *unit) {
  json_open_array(json, "labels");
  for (size_t n = 0; n < count; n++) {
    json_open_object(json, NULL);
    json_signed_number(json, "value", labels[n].value);
    json_text(json, "name", labels[n].name != NULL ? labels[n].name : "");
    json_whole_number(json, "voxels", voxels[n]);
    json_number(json, "volume", (double)voxels[n] * voxel);
    if (unit != NULL) json_number(json, "volume_ml", (double)voxels[n] * voxel / per_millilitre(unit));
    json_close(json);
  }
  json_close(json);
}

static void print_text(const hl_label *labels, size_t count, const uint64_t *voxels, double voxel,
                       const hl_unit *unit) {
  for (size_t n = 0; n < count; n++) {
    const char *name = labels[n].name != NULL ? labels[n].name : "";
    const double volume = (double)voxels[n] * voxel;
    printf("  %s  %" PRId64 ": %s%s%" PRIu64 " voxel%s, %.6g ", n == 0 ? "labels    " : "          ",
           labels[n].value, name, name[0] != '\0' ? ", " : "", voxels[n], voxels[n] == 1 ? "" : "s", volume);
    if (unit != NULL) printf("%s³, %.6g ml\n", unit->symbol, volume / per_millilitre(unit));
    else printf("cubic units\n");
  }
}

hl_status info_tell_labels(hl_context *context, json_writer *json, const hl_volume *map, const char *unit,
                           const char *table, hl_error *error) {
  hl_label *labels = NULL;
  size_t count = 0;
  hl_volume_info info = {.struct_size = sizeof info};
  hl_status status = hl_labels_of_volume(context, map, table, &labels, &count, error);
  if (status == HL_OK) status = hl_volume_get_info(map, &info);
  if (status != HL_OK || count == 0) return status;
  const double voxel = info.spacing[0] * info.spacing[1] * info.spacing[2];
  uint64_t *voxels = calloc(count, sizeof *voxels);
  if (voxels != NULL) {
    count_voxels(map, &info, labels, count, voxels);
    const hl_unit *known = unit != NULL ? hl_unit_find(unit) : NULL;
    if (json != NULL) print_json(json, labels, count, voxels, voxel, known);
    else print_text(labels, count, voxels, voxel, known);
  }
  free(voxels);
  hl_labels_release(context, labels);
  return HL_OK;
}
