/* volume/scraps.h - hides small bodies of matter that nothing connects to larger ones.
 *
 * A scan shows more than its object: specks of noise, and scraps of matter beside the object. A body is a set
 * of voxels beyond the value `firm` that are connected by their faces. Bodies that are small against the
 * largest one are hidden, and so is the matter between `faint` and `firm` that is far from all other bodies.
 * Hidden voxels get the value `faint`, from which on matter is seen, so that the matter beside them does not
 * change. */
#ifndef HL_VOLUME_SCRAPS_H
#define HL_VOLUME_SCRAPS_H

#include "volume/volume.h"

typedef struct hl_scraps_rule {
  double faint, firm; /* data values; if firm < faint, matter has lower values than its surroundings */
  double least;       /* bodies with fewer voxels than this part of the largest body's voxels are hidden */
} hl_scraps_rule;

/* What a rule hides. */
typedef struct hl_scraps {
  size_t bodies;     /* the number of hidden bodies */
  double share;      /* the hidden bodies' part of the voxels of all bodies */
  hl_volume *volume; /* the volume without the hidden matter; the caller owns a reference; null if no body is
                      * hidden */
} hl_scraps;

/* Returns whether a rule can hide matter of a volume: the volume has voxels in memory, and no colours. */
bool hl_scraps_apply(const hl_volume *volume);

/* Hides the scraps of a volume to which rules apply. The volume keeps the result for the next call with the
 * same rule. Fails for lack of memory, or if cancelled. */
hl_status hl_scraps_hide(hl_volume *volume, const hl_scraps_rule *rule, hl_scraps *scraps, hl_error *error);

/* The greatest number of bytes that hl_scraps_hide() takes beside the volume. */
uint64_t hl_scraps_bytes(const hl_volume *volume);

/* Releases what a volume keeps. */
void hl_scraps_release_kept(hl_volume *volume);

#endif
