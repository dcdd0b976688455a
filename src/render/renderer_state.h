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

/* Results of a frame that the next frame may use; all of it is owned. */
typedef struct frame_cache {
  prepared_volume *prepared; /* [prepared_count] */
  size_t prepared_count;
  shadow_buffer *buffers; /* [buffer_count]; LIGHT_SECTORS buffers for each of the scene's lights */
  size_t buffer_count;
  shadow_memory shadow_memory[FRAME_LIGHTS]; /* memory of the lights of a sweep */
  surfaces surfaces;       /* the meshes of the last frame; kept while the meshes stay where they are */
  surface_tree contact;    /* the tree of these surfaces */
  scatter_field scattered; /* kept while the scene's matter and lights stay the same */
  sky_field sky;           /* the light of the scene's sky */
  phase_tables phases;     /* means of the media's phase functions over the scene's lights */
  hl_reserve reserve;      /* blocks of memory that frames and sweeps have returned, for later frames */
} frame_cache;

/* The device that makes a renderer's frames. */
typedef struct renderer_device {
  struct hl_gpu *gpu; /* owned; null: the processors make the frames */
  char wanted[128];   /* name of the wanted device; empty: the device that the context names */
  bool tried;         /* the device was looked for */
  char problem[400];  /* why the device makes no frames */
} renderer_device;

/* A renderer. renderer.c creates it and releases it. */
struct hl_renderer {
  hl_context *context;
  atomic_bool busy;      /* a call uses the renderer; another call is refused meanwhile */
  atomic_bool abandoned; /* the renderer was destroyed during a frame; the end of the frame releases it */
  hl_pool *pool;
  int threads;             /* number of threads, as the scene says: 0 means one per processor */
  int part, parts;         /* the part of each picture that this renderer makes, and the number of parts */
  light_exchange exchange; /* how light is exchanged with the other parts; gather is null where there is no
                            * exchange */
  frame_cache cache;
  renderer_device device;
  uint64_t estimate; /* bytes; see render/estimate.h */
};

/* A caller's request for a frame: a picture of a scene, and its layers. */
typedef struct frame_request {
  const hl_scene *scene;   /* borrowed until the frame ends */
  const hl_layers *layers; /* null: none */
  float *pixels;           /* the caller's memory */
  size_t row_stride;       /* counted in floats */
} frame_request;

/* Lets the renderer make one part of each picture, as hl_renderer_share() does, for renderers that exchange
 * light among the parts. The renderers of all parts must render the same scenes in the same order. */
void hl_renderer_exchange(hl_renderer *renderer, const light_exchange *exchange);

/* Refuses a frame that does not fit. Before that, it releases blocks kept for later frames if they are in the
 * way, and then pages of volumes. */
hl_status hl_renderer_check_room(hl_renderer *renderer, uint64_t bytes, hl_error *error);

/* Releases the shadow buffers and everything that shadow methods keep beside them. */
void hl_renderer_release_buffers(hl_renderer *renderer);

#endif
