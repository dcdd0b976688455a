/* simd/select.c - the table of an instruction set. */
#include "simd/hot.h"

const hot_functions *hl_hot_functions(hl_instruction_set set) {
#if defined(__x86_64__)
  if (set == HL_INSTRUCTION_SET_AVX512_VBMI) return &hl_hot_avx512_vbmi;
  if (set == HL_INSTRUCTION_SET_AVX512) return &hl_hot_avx512;
  if (set == HL_INSTRUCTION_SET_AVX2) return &hl_hot_avx2;
#elif defined(__aarch64__)
  if (set == HL_INSTRUCTION_SET_NEON) return &hl_hot_neon;
#endif
  (void)set;
  return &hl_hot_scalar;
}
