/* render/sheet_loop.c - the paper's loop over the sheets (section 3.1, eighteen steps).
 *
 *    1. transform voxels to the half-way vector's frame      hl_sweep_begin
 *    2. bucket sort them by height                           hl_sweep_begin
 *    3. opacity map = 0                                      hl_sweep_begin
 *    4. shadow buffer = full light                           hl_sweep_begin
 *    5. for each sheet
 *    6, 7.   image and shadow sheets = 0                     hl_sweep_shade, hl_sweep_attenuate
 *    8 - 11. add every footprint to both                     hl_sweep_shade, hl_sweep_attenuate
 *   12 - 15. gradient, classification, shadow, illumination  hl_sweep_shade
 *   16.      composite to the frame buffer                   hl_sweep_shade
 *   17.      classify and composite the shadow sheet         hl_sweep_attenuate
 *            (soft: convolve for the next sheet)             hl_sweep_soften
 *   18. end
 *
 * The slab between a sheet and the one before is classified, lit and composited, not the sheet: so nothing
 * that a sharp transfer function shows falls between sheets. A slab is lit by the light that has passed the
 * slabs before it. The first and the last sheet lie outside the content. */
#include "core/context.h"
#include "render/sweep.h"

hl_status hl_sweep_run(sweep *sweep, hl_error *error) {
  int sheets = sweep->geometry->sheets.count;
  for (int sheet = 1; sheet < sheets; sheet++) {
    hl_sweep_shade(sweep, sheet);
    hl_sweep_attenuate(sweep, sheet);
    hl_sweep_soften(sweep, sheet);
    if ((sheet & 7) == 0 && !sweep->preparatory)
      hl_progress(sweep->content.context, "render", (double)sheet / sheets);
    if (hl_pool_cancelled(sweep->content.pool))
      return hl_fail(error, HL_ERROR_CANCELLED, "cancelled while rendering");
  }
  return HL_OK;
}
