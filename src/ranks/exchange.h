/* ranks/exchange.h - lets the ranks of an MPI job be the parts of one picture. This file is the only
 * interface between renderers and MPI. */
#ifndef HL_RANKS_EXCHANGE_H
#define HL_RANKS_EXCHANGE_H

#include <halflight/ranks.h>

#include "core/light_exchange.h"

/* The exchange for a picture of which each rank makes one part: the part that has the rank's number. A job of
 * a single rank exchanges nothing, and all members are zero. The exchange borrows the ranks. */
light_exchange hl_ranks_exchange(hl_ranks *ranks);

#endif
