/* core/cpu.h - what the processor and this build can do. */
#ifndef HL_CORE_CPU_H
#define HL_CORE_CPU_H

#include <halflight/context.h>

hl_instruction_set hl_cpu_best_instruction_set(void);

/* Whether this build has the set's functions and this processor can run them. */
int hl_cpu_has_instruction_set(hl_instruction_set set);

/* Processors this process may run on; at least 1. */
int hl_cpu_count(void);

#endif
