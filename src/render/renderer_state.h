/* render/renderer_state.h - defines the struct hl_renderer with the data that a renderer keeps between
 * frames, and a caller's request for a frame. */
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

/* Results of a frame that the next frame may use again. The struct owns all of them. */
typedef struct frame_cache {
  prepared_volume *prepared; /* [prepared_count] */
  size_t prepared_count;
  shadow_buffer *buffers; /* [buffer_count]; LIGHT_SECTORS buffers for each of the scene's lights */
  size_t buffer_count;
  shadow_memory shadow_memory[FRAME_LIGHTS]; /* memory of the lights of a sweep */
  surfaces surfaces;       /* the surfaces of the last frame's meshes; kept while the meshes do not move */
  surface_tree contact;    /* the tree of these surfaces */
  scatter_field scattered; /* scattered light; kept while the scene's matter and lights stay the same */
  sky_field sky;           /* the light of the scene's sky */
  phase_tables phases;     /* means of the media's phase functions over the scene's lights */
  hl_reserve reserve;      /* blocks of memory that frames and sweeps have returned, kept for later frames */
} frame_cache;

/* The device that makes a renderer's frames. */
typedef struct renderer_device {
  struct hl_gpu *gpu; /* owned; if null, the processors make the frames */
  char wanted[128];   /* name of the wanted device; empty: the device that the context names is wanted */
  bool tried;         /* whether the renderer has searched for the device */
  char problem[400];  /* the reason why the device makes no frames */
} renderer_device;

/* A renderer. renderer.c creates it and releases it. */
struct hl_renderer {
  hl_context *context;
  atomic_bool busy;      /* whether a call is using the renderer; other calls are refused meanwhile */
  atomic_bool abandoned; /* whether the renderer was destroyed during a frame; if so, it is released at the
                          * end of the frame */
  hl_pool *pool;
  int threads;             /* number of threads that the scene asks for: 0 means one per processor */
  int part, parts;         /* part: number of the part of each picture that this renderer makes; parts: number
                            * of parts */
  light_exchange exchange; /* exchanges light with the other parts; its member `gather` is null if no light is
                            * exchanged */
  frame_cache cache;
  renderer_device device;
  uint64_t estimate; /* bytes; see render/estimate.h */
};

/* A caller's request for a frame: a picture of a scene, and its layers. */
typedef struct frame_request {
  const hl_scene *scene;   /* borrowed until the frame ends */
  const hl_layers *layers; /* null if there is none */
  float *pixels;           /* the caller's memory */
  size_t row_stride;       /* counted in floats */
} frame_request;

/* Lets the renderer make one part of each picture, as hl_renderer_share() does. Here the renderers of the
 * parts exchange light. The renderers of all parts must render the same scenes in the same order. */
void hl_renderer_exchange(hl_renderer *renderer, const light_exchange *exchange);

/* Refuses a frame that does not fit into memory. Before that, it tries to make room: it releases blocks that
 * are kept for later frames, and then pages of volumes. */
hl_status hl_renderer_check_room(hl_renderer *renderer, uint64_t bytes, hl_error *error);

/* Releases the shadow buffers and everything that shadow methods keep beside them. */
void hl_renderer_release_buffers(hl_renderer *renderer);

#endif
