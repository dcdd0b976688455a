/* core/cpu.c - detection of instruction sets and processors. */
#define _GNU_SOURCE
#include "core/cpu.h"

#include <sched.h>

int hl_cpu_has_instruction_set(hl_instruction_set set) {
  if (set == HL_INSTRUCTION_SET_SCALAR) return 1;
#if defined(HL_SCALAR_ONLY)
  return 0;
#elif defined(__x86_64__)
  __builtin_cpu_init();
  if (set == HL_INSTRUCTION_SET_AVX2) return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  int wide = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
             __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vl");
  if (set == HL_INSTRUCTION_SET_AVX512) return wide;
  if (set == HL_INSTRUCTION_SET_AVX512_VBMI)
    return wide && __builtin_cpu_supports("avx512vbmi") && __builtin_cpu_supports("avx512vbmi2") &&
           __builtin_cpu_supports("avx512vnni");
#elif defined(__aarch64__)
  if (set == HL_INSTRUCTION_SET_NEON) return 1;
#endif
  return 0;
}

hl_instruction_set hl_cpu_best_instruction_set(void) {
  static const hl_instruction_set best_first[] = {HL_INSTRUCTION_SET_AVX512_VBMI, HL_INSTRUCTION_SET_AVX512,
                                                  HL_INSTRUCTION_SET_AVX2, HL_INSTRUCTION_SET_NEON};
  for (size_t i = 0; i < sizeof best_first / sizeof best_first[0]; i++)
    if (hl_cpu_has_instruction_set(best_first[i])) return best_first[i];
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
    case HL_INSTRUCTION_SET_AVX512_VBMI: return "avx512-vbmi";
    case HL_INSTRUCTION_SET_NEON: return "neon";
  }
  return "unknown";
}
