/* render/device_paper.c - see device_paper.h. */
#include "render/device_paper.h"

#include "shadow/blur.h"
#include "shadow_paper/paper.h"

bool hl_is_convolved(const light_shadow *shadow) { return shadow->method == &hl_shadow_paper; }

/* The greatest number of passes of one convolution. Two passes find the tiles that it changes. Two passes
 * convolve the transmittance, along rows and along columns. Two more convolve the light at the outside of
 * surfaces. */
enum { PASSES_OF_CONVOLUTION = 2 + 2 * 2 };

/* Adds the passes that convolve the buffer of one light. */
static void add_convolution(const gpu_sweep *sweep, int light, int sheet, int width, known_passes *passes) {
  const plan_light *of = &sweep->plan->lights[light];
  const int kinds = 1 + sweep->variant.outside;
  const blur_box box = hl_blur_box((float)width);
  plan_pass pass = {.tiles_x = of->tiles_x,
                    .tiles_y = of->tiles / of->tiles_x,
                    .light = light,
                    .sheet = sheet,
                    .reach = hl_paper_reach(width)};
  pass.boxes = hl_known_passes_add_box(passes, (plan_blur){box.reach, box.edge, box.scale});
  for (pass.kind = PASS_BELOW; pass.kind <= PASS_WANTED; pass.kind++) hl_known_passes_add(passes, pass);
  for (int i = 0; i < 2 * kinds; i++) {
    pass.kind = i % 2 == 0 ? PASS_ROWS : PASS_COLUMNS;
    pass.channel = i / 2 * sweep->variant.channels;
    hl_known_passes_add(passes, pass);
  }
}

hl_status hl_device_paper_begin(hl_context *context, const sweep_plan *plan, device_sweep *planned,
                                known_passes *passes, gpu_sweep *sweep, hl_error *error) {
  const sheet_stack *sheets = &plan->geometry->sheets;
  const size_t lights = (size_t)plan->geometry->light_count, count = (size_t)sheets->count;
  int32_t *widths = hl_allocate_zeroed(context, (lights + 1) * count, sizeof *widths);
  if (widths == NULL) return hl_fail_memory(error, (lights + 1) * count * sizeof *widths, "soft lights");
  for (size_t i = 0; i < lights; i++) {
    const light_shadow *shadow = &plan->lights[i].shadow;
    plan_light *light = &planned->lights[i];
    if (!hl_is_convolved(shadow)) continue;
    hl_paper_find_widths(shadow, hl_first_beyond(sheets, shadow->setup.source), widths + i * count);
    light->rows = (unsigned)(sweep->row_floats / 16);
    sweep->row_floats += ((size_t)sweep->variant.channels * (size_t)light->plane + 15) / 16 * 16;
  }
  hl_status status = hl_known_passes_begin(context, sheets->count, PASSES_OF_CONVOLUTION * lights * count,
                                           passes, sweep, error);
  for (int sheet = 0; sheet < sheets->count && status == HL_OK; sheet++) {
    for (int i = 0; i < (int)lights; i++) {
      const int32_t width = widths[(size_t)i * count + (size_t)sheet];
      if (width > 0) add_convolution(sweep, i, sheet, width, passes);
      passes->ends[sheet] |= width > 0;
    }
    passes->first[sheet + 1] = (int32_t)passes->passes.count;
  }
  hl_release(context, widths);
  return status;
}
