/* grid/matter_key.h - makes the key (core/key.h) of results that depend on the extinction of a volume's
 * matter. */
#ifndef HL_GRID_MATTER_KEY_H
#define HL_GRID_MATTER_KEY_H

#include "core/key.h"
#include "grid/classifier.h"

/* Adds everything on which a volume's extinction depends to a key. The key holds the volume's address in
 * place of the volume's voxels. So code that keeps a result with this key must also keep the volume. */
void hl_matter_key_add(hl_key *key, const hl_scene_volume *volume, uint64_t plane_mark, const grid *grid,
                       const classifier *classifier);

#endif
