/* render/sweep_constants.h - defines the constants that all slabs of a sweep have in common, in the form that
 * the loops over samples read. They are made from the plan, for every back end. */
#ifndef HL_RENDER_SWEEP_CONSTANTS_H
#define HL_RENDER_SWEEP_CONSTANTS_H

#include "core/memory.h"
#include "plan/frame_plan.h"
#include "render/slab.h"

typedef struct sweep_constants {
  shade_volume *volumes; /* [volumes] */
  shade_cut *cuts;       /* cuts of all volumes, one volume after the other */
  float *srgb_decode;    /* [256]: the linear values of sRGB's codes, for voxels with colours */
  float *tint_decode;    /* [256]: the linear values of a mask's codes, which are their squares */
  shade_light lights[FRAME_LIGHTS];
  attenuate_job attenuate[FRAME_LIGHTS];
  shade_job shade;
} sweep_constants;

/* Takes the arrays. */
void hl_sweep_constants_lay_out(const frame_plan *plan, sweep_constants *constants, hl_layout *layout);

/* Fills the arrays, which must be allocated, and the members of `constants`. A back end sets the members for
 * the shadow buffers and textures of lights. `constants` must not move in memory afterwards. */
void hl_sweep_constants_find(const frame_plan *plan, const sweep_plan *sweep, sweep_constants *constants);

/* The content of a frame on which the images of lights fall. */
texture_use hl_texture_use(const frame *frame);

#endif
