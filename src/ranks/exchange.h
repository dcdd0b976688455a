/* ranks/exchange.h - lets the ranks of an MPI job be the parts of one picture. Renderers know of MPI by this
 * alone. */
#ifndef HL_RANKS_EXCHANGE_H
#define HL_RANKS_EXCHANGE_H

#include <halflight/ranks.h>

#include "core/light_exchange.h"

/* The exchange for a picture of which each rank makes one part: the part with the rank's number. All its
 * members are zero if there is only one rank, which has nobody to exchange bytes with. The exchange borrows
 * the ranks. */
light_exchange hl_ranks_exchange(hl_ranks *ranks);

#endif
