/* core/cpu.c - detection of instruction sets and processors. */
#define _GNU_SOURCE
#include "core/cpu.h"

#include <sched.h>

hl_instruction_set hl_cpu_best_instruction_set(void) {
#if defined(__x86_64__)
  __builtin_cpu_init();
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
      __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vl") &&
      __builtin_cpu_supports("avx512vbmi") && __builtin_cpu_supports("avx512vnni"))
    return HL_INSTRUCTION_SET_AVX512;
  if (__builtin_cpu_supports("avx2")) return HL_INSTRUCTION_SET_AVX2;
#endif
  return HL_INSTRUCTION_SET_SCALAR;
}

int hl_cpu_count(void) {
  cpu_set_t set;
  if (sched_getaffinity(0, sizeof set, &set) != 0) return 1;
  int count = CPU_COUNT(&set);
  return count < 1 ? 1 : count;
}

const char *hl_instruction_set_name(hl_instruction_set set) {
  switch (set) {
    case HL_INSTRUCTION_SET_AUTO: return "auto";
    case HL_INSTRUCTION_SET_SCALAR: return "scalar";
    case HL_INSTRUCTION_SET_AVX2: return "avx2";
    case HL_INSTRUCTION_SET_AVX512: return "avx512";
  }
  return "unknown";
}
