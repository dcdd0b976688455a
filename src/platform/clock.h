/* platform/clock.h - reads the system's clocks. */
#ifndef HL_PLATFORM_CLOCK_H
#define HL_PLATFORM_CLOCK_H

#include <stdint.h>

/* The time since a fixed moment in the past, in nanoseconds and in seconds. The clock of these functions
 * never runs backwards.
 */
int64_t hl_clock_nanoseconds(void);
double hl_clock_seconds(void);

/* The processor time of all threads of this process so far, in seconds. On a busy machine, processor time is
 * a better measure than elapsed time. The result is 0 if the system does not tell the processor time. */
double hl_processor_seconds(void);

#endif
