/* gpu/gpu_passes.c - launches the passes over the buffers of lights. */
#include "gpu/gpu_state.h"

enum { TILE_SIDE = 16 };

bool hl_gpu_upload_passes(hl_gpu *gpu, const gpu_passes *passes) {
  return hl_gpu_reserve_and_upload(gpu, BUFFER_PASSES, passes->list, passes->count * sizeof *passes->list) &&
         hl_gpu_reserve_and_upload(gpu, BUFFER_BOXES, passes->boxes,
                                   passes->box_count * sizeof *passes->boxes) &&
         hl_gpu_reserve_and_upload(gpu, BUFFER_MARKS, passes->marks, passes->mark_count);
}

/* The kernel of each kind of pass. */
static const int kernels_of_passes[] = {[PASS_ADD] = KERNEL_FIELDS,
                                        [PASS_HALF] = KERNEL_FIELDS,
                                        [PASS_DOUBLE] = KERNEL_FIELDS,
                                        [PASS_BLUR] = KERNEL_FIELDS,
                                        [PASS_SPLIT] = KERNEL_FIELDS,
                                        [PASS_ABSORB] = KERNEL_ABSORBED,
                                        [PASS_REFILL] = KERNEL_REFILL,
                                        [PASS_BELOW] = KERNEL_BELOW,
                                        [PASS_WANTED] = KERNEL_WANTED,
                                        [PASS_ROWS] = KERNEL_CONVOLVE_ROWS,
                                        [PASS_COLUMNS] = KERNEL_CONVOLVE_COLUMNS,
                                        [PASS_HALVES] = KERNEL_HALVES,
                                        [PASS_SUBLIGHTS] = KERNEL_SUBLIGHTS,
                                        [PASS_DARK] = KERNEL_DARK,
                                        [PASS_REACHED] = KERNEL_REACHED};

/* The number of members that make a pass: one for each pixel of the output, or for each tile. */
static size_t members_of_pass(const plan_pass *pass) {
  const size_t tiles = (size_t)pass->tiles_x * (size_t)pass->tiles_y;
  const bool of_tiles = pass->kind == PASS_WANTED || pass->kind == PASS_DARK || pass->kind == PASS_REACHED;
  return of_tiles ? tiles : tiles * 256;
}

static bool launch_sublights(hl_gpu *gpu, const gpu_program *program, int kernel, size_t members, int index) {
  const gpu_argument arguments[] = {hl_gpu_memory(gpu, BUFFER_PLAN),
                                    hl_gpu_memory(gpu, BUFFER_PASSES),
                                    hl_gpu_memory(gpu, BUFFER_PLACES),
                                    hl_gpu_memory(gpu, BUFFER_MAPS),
                                    hl_gpu_memory(gpu, BUFFER_PLANES),
                                    hl_gpu_memory(gpu, BUFFER_HALVES),
                                    hl_gpu_memory(gpu, BUFFER_OF_SUBLIGHTS),
                                    hl_gpu_memory(gpu, BUFFER_SUBLIGHT_MARKS),
                                    hl_gpu_number(index)};
  return hl_gpu_launch(gpu, program, kernel, LINE_AHEAD, hl_gpu_groups(members), arguments,
                       (int)(sizeof arguments / sizeof *arguments));
}

static bool launch_pass(hl_gpu *gpu, const gpu_program *program, int kernel, size_t members, int index) {
  const gpu_argument arguments[] = {hl_gpu_memory(gpu, BUFFER_PLAN),    hl_gpu_memory(gpu, BUFFER_PASSES),
                                    hl_gpu_memory(gpu, BUFFER_BOXES),   hl_gpu_memory(gpu, BUFFER_MARKS),
                                    hl_gpu_memory(gpu, BUFFER_FIELDS),  hl_gpu_memory(gpu, BUFFER_ROWS),
                                    hl_gpu_memory(gpu, BUFFER_PLANES),  hl_gpu_memory(gpu, BUFFER_LIGHT),
                                    hl_gpu_memory(gpu, BUFFER_SOFT),    hl_gpu_memory(gpu, BUFFER_TOUCHED),
                                    hl_gpu_memory(gpu, BUFFER_CHANGED), hl_gpu_number(index)};
  return hl_gpu_launch(gpu, program, kernel, LINE_AHEAD, hl_gpu_groups(members), arguments,
                       (int)(sizeof arguments / sizeof *arguments));
}

bool hl_gpu_launch_passes(hl_gpu *gpu, const gpu_program *program, const gpu_passes *passes, size_t first,
                          size_t end) {
  bool done = true;
  for (size_t i = first; i < end && done; i++) {
    const plan_pass *pass = &passes->list[i];
    if (pass->kind == PASS_BLUR)
      done = launch_pass(gpu, program, KERNEL_ROWS,
                         members_of_pass(pass) + (size_t)pass->tiles_x * TILE_SIDE * 2 * PASS_MARGIN, (int)i);
    done = done && (pass->kind >= PASS_HALVES ? launch_sublights : launch_pass)(
                       gpu, program, kernels_of_passes[pass->kind], members_of_pass(pass), (int)i);
  }
  return done;
}

bool hl_gpu_pass(hl_gpu *gpu, const gpu_sweep *sweep, const gpu_passes *passes) {
  const gpu_program *program = hl_gpu_program_of(gpu, &sweep->variant);
  return program != NULL && hl_gpu_upload_passes(gpu, passes) &&
         gpu->device.driver->follow(&gpu->device, LINE_AHEAD, LINE_PICTURE) &&
         hl_gpu_launch_passes(gpu, program, passes, 0, passes->count);
}

bool hl_gpu_touched(hl_gpu *gpu, const plan_light *light, int32_t *chunks) {
  return gpu->device.driver->download(&gpu->device, &gpu->buffers[BUFFER_TOUCHED],
                                      (size_t)light->first_tile * sizeof *chunks, chunks,
                                      (size_t)light->tiles * sizeof *chunks);
}
