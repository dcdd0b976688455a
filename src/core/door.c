/* core/door.c - sets and restores the floating-point environment (door.h). Reading and writing the whole
 * environment takes about a hundred nanoseconds, which is too long in functions that hosts call for each
 * voxel. On x86, reading two control words takes a few nanoseconds and shows whether the environment must be
 * changed. On x86, MXCSR, one of the two words, also holds the exception flags. */
#include "core/door.h"

#if defined(__x86_64__)

/* Values and bits of MXCSR, the control register for vectors (Intel 64 and IA-32 Architectures Software
 * Developer's Manual, volume 1, 10.2.3 and 8.1.5). In VECTOR_DEFAULT all exceptions are masked, rounding is
 * to nearest, and neither DAZ (bit 6) nor FZ (bit 15) is set. The lowest six bits are flags, which
 * VECTOR_CONTROL leaves out. */
static const unsigned int VECTOR_CONTROL = 0xffc0, VECTOR_DEFAULT = 0x1f80;
/* The control word of the x87 unit: all exceptions are masked, precision is 64 bits, and rounding is to
 * nearest. */
static const unsigned short SCALAR_CONTROL = 0x0f3f, SCALAR_DEFAULT = 0x033f;

static bool is_default(unsigned int vector) {
  /* initialised, because the memory sanitizer does not see that the assembler instruction writes this
   * variable */
  unsigned short scalar = 0;
  __asm__ volatile("fnstcw %0" : "=m"(scalar));
  return (vector & VECTOR_CONTROL) == VECTOR_DEFAULT && (scalar & SCALAR_CONTROL) == SCALAR_DEFAULT;
}

hl_door hl_door_enter(void) {
  hl_door door;
  door.vector = __builtin_ia32_stmxcsr();
  door.changed = !is_default(door.vector);
  if (!door.changed) return door;
  fegetenv(&door.host);
  fesetenv(FE_DFL_ENV);
  return door;
}

void hl_door_leave(hl_door *door) {
  if (door->changed) fesetenv(&door->host);
  else __builtin_ia32_ldmxcsr(door->vector);
}

#else

hl_door hl_door_enter(void) {
  hl_door door;
  fegetenv(&door.host);
  fesetenv(FE_DFL_ENV);
  return door;
}

void hl_door_leave(hl_door *door) { fesetenv(&door->host); }

#endif
