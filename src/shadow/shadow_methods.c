/* shadow/shadow_methods.c - the method for a light. */
#include "shadow/shadow_method.h"

#define HL_SOFT_METHOD(value, name) [value] = &hl_shadow_##name,
static const shadow_method *const soft_methods[] = {HL_SOFT_METHODS};

const shadow_method *hl_shadow_method(const light_source *source) {
  if (source->shadows == HL_SHADOWS_OFF) return NULL;
  return source->shadows == HL_SHADOWS_HARD ? &hl_shadow_hard : soft_methods[source->soft_method];
}
