/* tests/unit/small_volume.h - makes volumes for tests: a context, a description of voxels that the test
 * holds, and the volume of a description. */
#ifndef HL_TESTS_SMALL_VOLUME_H
#define HL_TESTS_SMALL_VOLUME_H

#include "../asserts.h"
#include "volume/volume.h"

static inline hl_context *make_context(void) {
  hl_context *context = NULL;
  assert_int_equal(hl_context_create(NULL, &context, NULL), HL_OK);
  return context;
}

/* ni x nj x nk voxels of unit size, the first at 0. The voxels are borrowed. */
static inline hl_volume_description describe_voxels(size_t ni, size_t nj, size_t nk, hl_voxel_type type,
                                                    const void *voxels) {
  hl_volume_description description;
  hl_volume_description_defaults(&description);
  description.dimensions[0] = ni;
  description.dimensions[1] = nj;
  description.dimensions[2] = nk;
  description.type = type;
  description.voxels = voxels;
  return description;
}

/* The volume of a description. It holds a copy of the voxels. */
static inline hl_volume *create_volume(hl_context *context, const hl_volume_description *description) {
  hl_volume *volume = NULL;
  assert_int_equal(hl_volume_create(context, description, &volume, NULL), HL_OK);
  return volume;
}

/* The volume of ni x nj x nk voxels of unit size, the first at 0. */
static inline hl_volume *volume_of_voxels(hl_context *context, size_t ni, size_t nj, size_t nk,
                                          hl_voxel_type type, const void *voxels) {
  const hl_volume_description description = describe_voxels(ni, nj, nk, type, voxels);
  return create_volume(context, &description);
}

#endif
