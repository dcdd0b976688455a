/* platform/processors.h - finds the number of processors that this process may use. */
#ifndef HL_PLATFORM_PROCESSORS_H
#define HL_PLATFORM_PROCESSORS_H

#include <stdbool.h>

/* The number of processors that this process may use, at least 1: the processors of its affinity mask, but no
 * more than the quota of its control groups, rounded up. */
int hl_cpu_count(void);

/* The processor time that the control groups of this process allow, as a number of processors. The quota is
 * read from cpu.max (version 2 of control groups) or cpu.cfs_quota_us (version 1). The result is infinite if
 * the groups set no limit. root: a folder put before /proc and /sys; "" except in tests. */
double hl_cpu_quota(const char *root);

#endif
