/* core/processors.h - how many processors this process may use. */
#ifndef HL_CORE_PROCESSORS_H
#define HL_CORE_PROCESSORS_H

#include <stdbool.h>

/* Processors that this process may use, at least 1: those of its affinity, and no more than the quota of its
 * control groups, rounded up. */
int hl_cpu_count(void);

/* The processor time that the control groups of this process grant, in processors, by cpu.max (version 2) or
 * cpu.cfs_quota_us (version 1); infinite where they set no limit. root: before /proc and /sys; "" but in
 * tests. */
double hl_cpu_quota(const char *root);

#endif
