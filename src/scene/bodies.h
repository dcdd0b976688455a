/* scene/bodies.h - which marked places of a lattice hang together. */
#ifndef HL_SCENE_BODIES_H
#define HL_SCENE_BODIES_H

#include <stdint.h>

#include "core/error.h"

/* Places are neighbours where they share a face. */
typedef struct hl_bodies {
  uint32_t *body;   /* owned; [size[2]][size[1]][size[0]]; 0: not marked; else 1 to count */
  uint32_t *places; /* owned; [count + 1]; how many places a body has */
  uint32_t count;
  uint32_t largest; /* the body with the most places, the first of equals; 0: there is none */
} hl_bodies;

/* marked: not 0 where a place is in some body. Fails for lack of memory alone; release in any case. */
hl_status hl_bodies_find(hl_context *context, const unsigned char *marked, const int size[3],
                         hl_bodies *bodies, hl_error *error);
void hl_bodies_release(hl_context *context, hl_bodies *bodies);

#endif
