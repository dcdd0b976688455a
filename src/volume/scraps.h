/* volume/scraps.h - hides small bodies of matter that nothing connects to larger ones.
 *
 * A scan often shows specks of noise and scraps of matter beside its object. A body is a set of voxels beyond
 * the value `firm` that are connected by their faces. Bodies that are much smaller than the largest body are
 * hidden. Matter between `faint` and `firm` that is far from all other bodies is hidden, too. Hidden voxels
 * get the value `faint`, from which on matter is seen, so that the surfaces of neighbouring matter do not
 * change. */
#ifndef HL_VOLUME_SCRAPS_H
#define HL_VOLUME_SCRAPS_H

#include "volume/volume.h"

typedef struct hl_scraps_rule {
  double faint, firm; /* data values; if firm < faint, matter has lower values than its surroundings */
  double least;       /* a fraction of the largest body's number of voxels; bodies with fewer voxels are
                       * hidden */
} hl_scraps_rule;

/* The result of hiding scraps: the number and the share of the hidden bodies, and the volume without them. */
typedef struct hl_scraps {
  size_t bodies;     /* the number of hidden bodies */
  double share;      /* the number of the hidden bodies' voxels, as a fraction of the voxels of all bodies */
  hl_volume *volume; /* the volume without the hidden matter; the caller owns a reference; null if no body is
                      * hidden */
} hl_scraps;

/* Returns whether a rule can hide matter of a volume: the volume has voxels in memory, and no colours. */
bool hl_scraps_apply(const hl_volume *volume);

/* Hides the scraps of a volume to which rules apply. The volume keeps the result for the next call with the
 * same rule. Fails if memory is short, or if the user has cancelled. */
hl_status hl_scraps_hide(hl_volume *volume, const hl_scraps_rule *rule, hl_scraps *scraps, hl_error *error);

/* The greatest number of bytes that hl_scraps_hide() allocates beside the volume. */
uint64_t hl_scraps_bytes(const hl_volume *volume);

/* Releases the result of hl_scraps_hide() that a volume keeps. */
void hl_scraps_release_kept(hl_volume *volume);

#endif
