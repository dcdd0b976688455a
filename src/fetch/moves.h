/* fetch/moves.h - decides whether a server may redirect the request for a file to another URL. */
#ifndef HL_FETCH_MOVES_H
#define HL_FETCH_MOVES_H

#include <stdbool.h>

/* Returns whether a request for the URL `from` may be redirected to the URL `to`. This is the case if `to` is
 * a URL of the same server, with the same scheme, or with https in place of http. Without this rule, a store
 * could make the program send requests to any address, even to an address that only this machine can
 * reach. */
bool move_is_allowed(const char *from, const char *to);

#endif
