/* render/renderer_state.h - hl_renderer: what it keeps between frames, and what a caller asks of a frame. */
#ifndef HL_RENDER_RENDERER_STATE_H
#define HL_RENDER_RENDERER_STATE_H

#include <halflight/render.h>
#include <stdatomic.h>

#include "light/phase_table.h"
#include "plan/frame.h"
#include "render/prepare.h"
#include "render/sky.h"
#include "scatter/scatter.h"
#include "shadow/shadow_method.h"

/* What frames leave behind for the next one; all of it owned. */
typedef struct frame_cache {
  prepared_volume *prepared; /* [prepared_count] */
  size_t prepared_count;
  shadow_buffer *buffers; /* [buffer_count]; LIGHT_SECTORS for each of the scene's lights */
  size_t buffer_count;
  shadow_memory shadow_memory[FRAME_LIGHTS]; /* of a sweep's lights */
  surfaces surfaces;                         /* of the last frame's meshes, while they stay where they are */
  surface_tree contact;                      /* of these */
  scatter_field scattered;                   /* while the scene's matter and lights stay the same */
  sky_field sky;                             /* the light of the scene's sky */
  phase_tables phases;                       /* of the scene's media and lights */
  hl_reserve reserve;                        /* blocks that frames and sweeps have returned */
} frame_cache;

/* The device that makes a renderer's frames. */
typedef struct renderer_device {
  struct hl_gpu *gpu; /* owned; null: the processors make them */
  char wanted[128];   /* its name; empty: what the context names */
  bool tried;         /* it was looked for */
  char problem[400];  /* why it makes no frames */
} renderer_device;

/* renderer.c creates it and releases it. */
struct hl_renderer {
  hl_context *context;
  atomic_bool busy;      /* a call uses it; another one is refused */
  atomic_bool abandoned; /* destroyed during a frame, whose end releases it */
  hl_pool *pool;
  int threads;             /* as the scene says: 0 means one per processor */
  int part, parts;         /* of each picture */
  light_exchange exchange; /* with the other parts; gather null: there is none */
  frame_cache cache;
  renderer_device device;
  uint64_t estimate; /* bytes; see render/estimate.h */
};

/* What the caller wants: a picture of a scene, and its layers. */
typedef struct frame_request {
  const hl_scene *scene;   /* borrowed until the frame ends */
  const hl_layers *layers; /* null: none */
  float *pixels;           /* the caller's */
  size_t row_stride;       /* floats */
} frame_request;

/* Makes each picture one part of several, as hl_renderer_share() does, of renderers that exchange light: all
 * of them render the same scenes, in the same order. */
void hl_renderer_exchange(hl_renderer *renderer, const light_exchange *exchange);

/* Refuses a frame that does not fit; first releases blocks kept for later frames if they are in the way, and
 * then pages of volumes. */
hl_status hl_renderer_check_room(hl_renderer *renderer, uint64_t bytes, hl_error *error);

/* Releases the shadow buffers and what methods keep beside them. */
void hl_renderer_release_buffers(hl_renderer *renderer);

#endif
