/* platform/posix/clock.c - see platform/clock.h. */
#define _GNU_SOURCE /* clock_gettime */
#include "platform/clock.h"

#include <time.h>

static int64_t nanoseconds_of(clockid_t clock) {
  struct timespec now;
  clock_gettime(clock, &now);
  return (int64_t)now.tv_sec * 1000000000 + now.tv_nsec;
}

int64_t hl_clock_nanoseconds(void) { return nanoseconds_of(CLOCK_MONOTONIC); }

double hl_clock_seconds(void) { return 1e-9 * (double)hl_clock_nanoseconds(); }

double hl_processor_seconds(void) {
#ifdef CLOCK_PROCESS_CPUTIME_ID
  return 1e-9 * (double)nanoseconds_of(CLOCK_PROCESS_CPUTIME_ID);
#else
  return 0;
#endif
}
