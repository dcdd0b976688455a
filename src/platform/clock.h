/* platform/clock.h - reads the system's clocks. */
#ifndef HL_PLATFORM_CLOCK_H
#define HL_PLATFORM_CLOCK_H

#include <stdint.h>

/* The time since a fixed moment in the past, in nanoseconds and in seconds. This clock never runs backwards.
 */
int64_t hl_clock_nanoseconds(void);
double hl_clock_seconds(void);

/* The processor time of all threads of this process so far, in seconds. Beside the work of others it is a
 * better measure than the elapsed time. 0 where the system does not tell it. */
double hl_processor_seconds(void);

#endif
