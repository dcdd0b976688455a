/* hot/tables.c - defines one table for each instruction set. The table has the hot functions of all rooms. */
#include "hot/tables.h"

#define HL_HOT_TABLE(set)                                                                    \
  HL_HOT_DECLARE(set);                                                                       \
  const hot_functions hl_hot_##set = {&HL_HOT_NAME(grid, set),    &HL_HOT_NAME(view, set),   \
                                      &HL_HOT_NAME(field, set),   &HL_HOT_NAME(fill, set),   \
                                      &HL_HOT_NAME(surface, set), &HL_HOT_NAME(shadow, set), \
                                      &HL_HOT_NAME(render, set)}

HL_HOT_TABLE(scalar);
#if defined(HL_SCALAR_ONLY)
/* no other table is built */
#elif defined(__x86_64__)
HL_HOT_TABLE(avx2);
HL_HOT_TABLE(avx512);
HL_HOT_TABLE(avx512_vbmi);
#elif defined(__aarch64__)
HL_HOT_TABLE(neon);
#endif
