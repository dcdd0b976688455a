/* volume/components.c - reads voxels of several components: one of them, or their magnitude.
 *
 * In: a stream of values [outer][component][block], block voxels of one component at a time: 1 where
 * components lie side by side, all voxels where they follow each other. Out: one stored value per voxel. The
 * magnitude is summed up in the voxels themselves, component by component, so that any order needs no more
 * memory.
 */
#include <math.h>
#include <string.h>

#include "volume/convert.h"
#include "volume/payload_parts.h"

enum { STAGE_VALUES = 8192, SKIPPED_BYTES = 1 << 16 };

/* Where in the file's order the next value is. */
typedef struct component_place {
  size_t first; /* voxel of the block's first value */
  size_t component;
  size_t in_block;
} component_place;

static double value_of(const hl_payload *payload, const void *stage, size_t index) {
  double stored = 0;
  switch (hl_voxel_type_storage(payload->grid.type)) {
    case HL_STORAGE_U8: stored = ((const uint8_t *)stage)[index]; break;
    case HL_STORAGE_U16: stored = ((const uint16_t *)stage)[index]; break;
    case HL_STORAGE_F32: stored = (double)((const float *)stage)[index]; break;
  }
  return payload->grid.value_scale * (stored - hl_voxel_type_bias(payload->grid.type)) +
         payload->grid.value_offset;
}

/* The square root of the sum of squares so far (in double, which holds the squares of all floats). */
static void add_square(float *magnitude, size_t component, double value) {
  double before = component > 0 ? (double)*magnitude : 0;
  *magnitude = (float)(component > 0 ? sqrt(before * before + value * value) : fabs(value));
}

static void take_value(const hl_payload *payload, const unsigned char *stage, size_t index,
                       const component_place *place, unsigned char *voxels) {
  size_t voxel = place->first + place->in_block;
  if (payload->component == HL_COMPONENT_MAGNITUDE) {
    add_square((float *)voxels + voxel, place->component, value_of(payload, stage, index));
  } else if (place->component == (size_t)payload->component) {
    size_t bytes = hl_storage_bytes(hl_voxel_type_storage(payload->grid.type));
    memcpy(voxels + voxel * bytes, stage + index * bytes, bytes);
  }
}

static void advance(const hl_payload *payload, component_place *place) {
  if (++place->in_block < payload->block) return;
  place->in_block = 0;
  if (++place->component < payload->components) return;
  place->component = 0;
  place->first += payload->block;
}

/* Passes over a large block that is not wanted. */
static hl_status skip_block(hl_stream *stream, const hl_payload *payload, component_place *place,
                            bool *skipped, hl_error *error) {
  uint64_t bytes = (uint64_t)payload->block * hl_voxel_type_bytes(payload->grid.type);
  *skipped = place->in_block == 0 && !payload->text && bytes >= SKIPPED_BYTES &&
             payload->component != HL_COMPONENT_MAGNITUDE && place->component != (size_t)payload->component;
  if (!*skipped) return HL_OK;
  place->in_block = payload->block - 1;
  advance(payload, place);
  return hl_stream_skip(stream, bytes, error);
}

hl_status hl_components_read(hl_stream *stream, const hl_payload *payload, void *voxels, hl_error *error) {
  unsigned char stage[STAGE_VALUES * sizeof(float)];
  component_place place = {0, 0, 0};
  size_t count = hl_payload_voxels(payload);
  for (uint64_t done = 0; place.first < count;) {
    /* Planes after the wanted one need not be read. */
    if (payload->block == count && payload->component >= 0 && place.component > (size_t)payload->component)
      break;
    bool skipped;
    hl_status status = skip_block(stream, payload, &place, &skipped, error);
    if (status != HL_OK) return status;
    if (skipped) {
      done += payload->block;
      continue;
    }
    uint64_t left = (uint64_t)(count - place.first) * payload->components; /* at least what is left */
    size_t wanted = left < STAGE_VALUES ? (size_t)left : STAGE_VALUES;
    if (payload->block - place.in_block < wanted && payload->block > 1)
      wanted = payload->block - place.in_block;
    if (payload->block == 1 && left - place.component < wanted) wanted = (size_t)(left - place.component);
    status = hl_payload_stage(stream, payload, done, wanted, stage, error);
    if (status != HL_OK) return status;
    for (size_t n = 0; n < wanted; n++) {
      take_value(payload, stage, n, &place, voxels);
      advance(payload, &place);
    }
    done += wanted;
    status = hl_payload_report(stream, place.first, count, error);
    if (status != HL_OK) return status;
  }
  return HL_OK;
}
