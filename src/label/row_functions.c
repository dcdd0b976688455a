/* label/row_functions.c - see row_functions.h. */
#include "label/row_functions.h"

extern const label_row_functions hl_label_rows_scalar;
#if defined(__x86_64__)
extern const label_row_functions hl_label_rows_avx2, hl_label_rows_avx512, hl_label_rows_avx512_vbmi;
#elif defined(__aarch64__)
extern const label_row_functions hl_label_rows_neon;
#endif

const label_row_functions *hl_label_row_functions(hl_instruction_set set) {
#if defined(HL_SCALAR_ONLY)
  /* builds without vectors have no other table */
#elif defined(__x86_64__)
  if (set == HL_INSTRUCTION_SET_AVX512_VBMI) return &hl_label_rows_avx512_vbmi;
  if (set == HL_INSTRUCTION_SET_AVX512) return &hl_label_rows_avx512;
  if (set == HL_INSTRUCTION_SET_AVX2) return &hl_label_rows_avx2;
#elif defined(__aarch64__)
  if (set == HL_INSTRUCTION_SET_NEON) return &hl_label_rows_neon;
#endif
  (void)set;
  return &hl_label_rows_scalar;
}
