/* fetch/curl.h - runs the program curl once, which makes many transfers at a time. */
#ifndef HL_FETCH_CURL_H
#define HL_FETCH_CURL_H

#include "fetcher.h"
#include "ranges.h"

enum { FETCH_URL_BYTES = 4096, FETCH_CONDITION_BYTES = 300, FETCH_SAID_BYTES = 160 };

/* Some of curl's exit codes (curl's manual, "EXIT CODES"). */
enum { CURL_TOO_LONG = 63 };

typedef struct curl_transfer {
  char url[FETCH_URL_BYTES];             /* printable ASCII */
  const char *output;                    /* borrowed; the file that curl writes to */
  char condition[FETCH_CONDITION_BYTES]; /* a line for the request's header, by which the server can tell
                                          * whether its file has changed; "" if there is no such line */
  char range[RANGE_BYTES];               /* the part of the file that is wanted, as range_write() writes it */
  /* Results. */
  int problem; /* curl's exit code for this transfer; -1 if curl ended before the transfer did */
  int answer;  /* the server's status code; 0 if the server gave no answer */
  char next_condition[FETCH_CONDITION_BYTES]; /* the condition for the next request; "" if there is none */
  char content_range[RANGE_BYTES]; /* the part of the file that was sent, as the server states it; "" if the
                                    * server does not state it */
  char moved[FETCH_URL_BYTES];     /* the URL to which the server redirects; "" if it does not redirect */
  char said[FETCH_SAID_BYTES];     /* curl's words about the problem */
} curl_transfer;

/* Makes the transfers. most: the greatest number of bytes of each file. Fails if there is no curl, or if the
 * run is cancelled. The function does not fail if a transfer fails. The members `problem` and `answer` of the
 * transfer report the failure. */
hl_status curl_run(const fetcher *f, curl_transfer *transfers, size_t count, uint64_t most, hl_error *error);

#endif
