/* ranks/exchange.h - the ranks of an MPI job as the parts of one picture: what renderers know of MPI. */
#ifndef HL_RANKS_EXCHANGE_H
#define HL_RANKS_EXCHANGE_H

#include <halflight/ranks.h>

#include "core/light_exchange.h"

/* The exchange by which each rank makes the part of a picture that has the rank's number. Of a single rank:
 * zeros, for it has nobody to exchange bytes with. ranks: borrowed by the exchange. */
light_exchange hl_ranks_exchange(hl_ranks *ranks);

#endif
