/* shadow/shadow_methods.c - the registry of shadow methods: the one place that asks which is which. */
#include "shadow/shadow_method.h"

static const shadow_method *const soft_methods[] = {
    [HL_SOFT_CASCADE] = &hl_shadow_cascade,
    [HL_SOFT_PAPER] = &hl_shadow_paper,
    [HL_SOFT_SUBLIGHTS] = &hl_shadow_sublights,
};

const shadow_method *hl_shadow_method(const light_source *source) {
  if (source->shadows == HL_SHADOWS_OFF) return NULL;
  return source->shadows == HL_SHADOWS_HARD ? &hl_shadow_hard : soft_methods[source->soft_method];
}
