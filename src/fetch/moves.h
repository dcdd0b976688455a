/* fetch/moves.h - where a server may redirect the request for a file. */
#ifndef HL_FETCH_MOVES_H
#define HL_FETCH_MOVES_H

#include <stdbool.h>

/* Returns whether a request for the URL `from` may be made of the URL `to` instead: whether `to` is a URL of
 * the same server, by the same scheme or by https in place of http. Otherwise a store could make the program
 * ask any address, also one that only this machine reaches. */
bool move_is_allowed(const char *from, const char *to);

#endif
