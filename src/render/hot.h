/* render/hot.h - declares the tables of all hot functions, one table for each instruction set.
 *
 * Each function is written once, in a file *_lanes.h, and src/hot compiles it for every instruction set; all
 * versions give the same bytes. The code of a folder gets only the table of its own functions. */
#ifndef HL_RENDER_HOT_H
#define HL_RENDER_HOT_H

#include "field/field.h"
#include "fill/fill.h"
#include "grid/grid.h"
#include "render/slab.h"
#include "shadow/shadow_method.h"
#include "surface/small_triangles.h"
#include "view/occupancy.h"

typedef struct hot_functions {
  const grid_functions *grid;
  const view_functions *view;
  const field_functions *field;
  const fill_functions *fill;
  const surface_functions *surface;
  const shadow_functions *shadow;
  const render_functions *render;
} hot_functions;

/* ---- one table for each instruction set (src/hot/tables.c) ---- */

extern const hot_functions hl_hot_scalar;
#if defined(__x86_64__)
extern const hot_functions hl_hot_avx2, hl_hot_avx512, hl_hot_avx512_vbmi;
#elif defined(__aarch64__)
extern const hot_functions hl_hot_neon;
#endif

static inline const hot_functions *hl_hot_functions(hl_instruction_set set) {
#if defined(HL_SCALAR_ONLY)
  /* no other table is built */
#elif defined(__x86_64__)
  if (set == HL_INSTRUCTION_SET_AVX512_VBMI) return &hl_hot_avx512_vbmi;
  if (set == HL_INSTRUCTION_SET_AVX512) return &hl_hot_avx512;
  if (set == HL_INSTRUCTION_SET_AVX2) return &hl_hot_avx2;
#elif defined(__aarch64__)
  if (set == HL_INSTRUCTION_SET_NEON) return &hl_hot_neon;
#endif
  (void)set;
  return &hl_hot_scalar;
}

#endif
