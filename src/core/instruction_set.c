/* core/instruction_set.c - finds which instruction sets the processor and the build have. */
#include <stddef.h>

#include "core/context.h"

#if defined(__x86_64__) && !defined(HL_SCALAR_ONLY)
#define ON_X86 1
#include <cpuid.h>
#else
#define ON_X86 0
#endif

#if ON_X86

/* Bits of the results of CPUID, and of the register XCR0, which says which registers the system saves when it
 * switches threads. Source: Intel 64 and IA-32 Architectures Software Developer's Manual, volume 2A, CPUID;
 * volume 1, 13.3. __builtin_cpu_supports() is not used, because it relies on the compiler's runtime library,
 * and ziglang's library for Windows recognises no processor. */
/* bits of CPUID's leaf 1, register ecx */
enum { FMA = 1 << 12, OSXSAVE = 1 << 27 };
/* bits of CPUID's leaf 7, register ebx */
enum { AVX2 = 1 << 5, AVX512F = 1 << 16, AVX512DQ = 1 << 17, AVX512BW = 1 << 30 };
static const unsigned AVX512VL = 1u << 31;
enum { VBMI = 1 << 1, VBMI2 = 1 << 6, VNNI = 1 << 11 }; /* bits of CPUID's leaf 7, register ecx */
enum { YMM_KEPT = 0x6, ZMM_KEPT = 0xe6 };

static int has_all(unsigned bits, unsigned wanted) { return (bits & wanted) == wanted; }

static unsigned kept_registers(void) {
  unsigned low, high;
  __asm__("xgetbv" : "=a"(low), "=d"(high) : "c"(0));
  return low;
}

static int processor_has(hl_instruction_set set) {
  unsigned a, b, c, d, ebx, ecx;
  if (!__get_cpuid(1, &a, &b, &c, &d) || !has_all(c, FMA | OSXSAVE)) return 0;
  unsigned kept = kept_registers();
  if (!has_all(kept, YMM_KEPT) || !__get_cpuid_count(7, 0, &a, &ebx, &ecx, &d)) return 0;
  int wide = has_all(kept, ZMM_KEPT) && has_all(ebx, AVX512F | AVX512DQ | AVX512BW | AVX512VL);
  if (set == HL_INSTRUCTION_SET_AVX2) return has_all(ebx, AVX2);
  if (set == HL_INSTRUCTION_SET_AVX512) return wide;
  return set == HL_INSTRUCTION_SET_AVX512_VBMI && wide && has_all(ecx, VBMI | VBMI2 | VNNI);
}

#endif

int hl_cpu_has_instruction_set(hl_instruction_set set) {
  if (set == HL_INSTRUCTION_SET_SCALAR) return 1;
#if ON_X86
  return processor_has(set);
#elif defined(__aarch64__) && !defined(HL_SCALAR_ONLY)
  return set == HL_INSTRUCTION_SET_NEON;
#else
  return 0;
#endif
}

hl_instruction_set hl_cpu_best_instruction_set(void) {
  static const hl_instruction_set best_first[] = {HL_INSTRUCTION_SET_AVX512_VBMI, HL_INSTRUCTION_SET_AVX512,
                                                  HL_INSTRUCTION_SET_AVX2, HL_INSTRUCTION_SET_NEON};
  for (size_t i = 0; i < sizeof best_first / sizeof best_first[0]; i++)
    if (hl_cpu_has_instruction_set(best_first[i])) return best_first[i];
  return HL_INSTRUCTION_SET_SCALAR;
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
