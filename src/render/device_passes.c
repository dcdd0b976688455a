/* render/device_passes.c - see device_passes.h. */
#include "render/device_passes.h"

hl_status hl_known_passes_begin(hl_context *context, int sheets, size_t most, known_passes *passes,
                                gpu_sweep *sweep, hl_error *error) {
  *passes = (known_passes){.context = context, .most = most};
  passes->list = hl_allocate_zeroed(context, most + 1, sizeof *passes->list);
  passes->boxes = hl_allocate_zeroed(context, most + 1, sizeof *passes->boxes);
  passes->first = hl_allocate_zeroed(context, (size_t)sheets + 1, sizeof *passes->first);
  passes->ends = hl_allocate_zeroed(context, (size_t)sheets, 1);
  if (passes->list == NULL || passes->boxes == NULL || passes->first == NULL || passes->ends == NULL)
    return hl_fail_memory(error, (most + 1) * sizeof *passes->list, "soft lights");
  passes->passes.list = passes->list;
  passes->passes.boxes = passes->boxes;
  sweep->passes = &passes->passes;
  sweep->first_pass = passes->first;
  sweep->ends = passes->ends;
  return HL_OK;
}

void hl_known_passes_add(known_passes *passes, plan_pass pass) {
  passes->list[passes->passes.count++] = pass;
}

unsigned hl_known_passes_add_box(known_passes *passes, plan_blur box) {
  passes->boxes[passes->passes.box_count] = box;
  return (unsigned)passes->passes.box_count++;
}

void hl_known_passes_release(known_passes *passes) {
  if (passes->context == NULL) return;
  hl_release(passes->context, passes->list);
  hl_release(passes->context, passes->boxes);
  hl_release(passes->context, passes->first);
  hl_release(passes->context, passes->ends);
  *passes = (known_passes){0};
}
