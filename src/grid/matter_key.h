/* grid/matter_key.h - what the extinction of a volume's matter depends on, for keys of what is kept
 * (core/key.h).
 */
#ifndef HL_GRID_MATTER_KEY_H
#define HL_GRID_MATTER_KEY_H

#include "core/key.h"
#include "grid/classifier.h"

/* Voxels are told apart by their volume's address: whoever keeps the result keeps the volume, too. */
void hl_matter_key_add(hl_key *key, const hl_scene_volume *volume, const grid *grid,
                       const classifier *classifier);

#endif
