/* render/frame_work.h - sets the work of one frame up: brings what the renderer has prepared into the frame's
 * space, plans its sweeps and chooses the memory for its pixels.
 *
 * In: a renderer whose volumes are prepared (renderer.c), a scene, what the caller wants. Out: a frame_work,
 * of which renderer.c runs the sweeps and writes the pixels. */
#ifndef HL_RENDER_FRAME_WORK_H
#define HL_RENDER_FRAME_WORK_H

#include <halflight/render.h>
#include <stdatomic.h>

#include "render/frame.h"
#include "render/layers.h"
#include "render/maximum.h"
#include "render/phase_table.h"
#include "render/prepare.h"
#include "render/share.h"
#include "render/sky.h"
#include "scatter/scatter.h"

/* renderer.c creates it, changes its parts between frames, and releases it. */
struct hl_renderer {
  hl_context *context;
  atomic_bool busy;      /* a call uses it; another one is refused */
  atomic_bool abandoned; /* destroyed during a frame, whose end releases it */
  hl_pool *pool;
  int part, parts;           /* of each picture */
  light_exchange exchange;   /* with the other parts; gather null: there is none */
  int threads;               /* as the scene says: 0 means one per processor */
  prepared_volume *prepared; /* owned; [prepared_count] */
  size_t prepared_count;
  shadow_buffer *buffers; /* owned; [buffer_count]; LIGHT_SECTORS for each of the scene's lights */
  size_t buffer_count;
  shadow_memory shadow_memory[FRAME_LIGHTS]; /* owned; of a sweep's lights */
  surfaces surfaces;        /* owned; of the last frame's meshes, kept while they stay where they are */
  surface_tree contact;     /* owned; of these */
  scatter_field scattered;  /* owned; kept while the scene's matter and lights stay the same */
  sky_field sky;            /* owned; the light of the scene's sky */
  phase_tables phases;      /* owned; of the scene's media and lights */
  struct hl_gpu *gpu;       /* owned; the device that makes frames; null: the processors do */
  char device[128];         /* what makes its frames; empty: what the context names */
  bool device_tried;        /* the device was looked for */
  char device_problem[400]; /* why it makes no frames */
  hl_reserve reserve;       /* owned; blocks that frames and sweeps have returned */
  uint64_t estimate;        /* bytes; see render/estimate.h */
};

/* The data of one frame; released when it ends. */
typedef struct frame_work {
  framed_scene framed;
  frame frame;
  grid *grids;         /* [volumes] */
  frame_sweep *sweeps; /* [LIGHT_SECTORS * lights + 1] */
  int sweep_count;
  float *pixels; /* [sweeps][tiles][16][4][16]; owned, or the caller's if in_place */
  bool in_place;
  float *tile_rows; /* in_place: [threads][tiles_x][16][4][16] */
  size_t tiles_x, tiles;
  layer_pixels layers;
  maximum_values maximum;
  picture_share share;
  int measuring_sweep; /* the one that carries depth and normals */
} frame_work;

/* What the caller wants: a picture of a scene, and its layers. */
typedef struct frame_request {
  const hl_scene_description *world;
  const scene_order *order; /* in which the frame takes its lists */
  uint64_t sky_mark;        /* of the pixels of its sky's image */
  const hl_layers *layers;  /* null: none */
  float *pixels;            /* the caller's */
  size_t row_stride;        /* floats */
} frame_request;

/* Refuses a frame that does not fit; first releases blocks kept for later frames if they are in the way, and
 * then pages of volumes. */
hl_status hl_renderer_check_room(hl_renderer *renderer, uint64_t bytes, hl_error *error);

/* Fills a frame's work but for `framed`, which it reads: the scene's volumes and meshes in the frame's space,
 * its eye, lights and sweeps, the pixels, the renderer's part of the picture. After an error, too, it is to
 * be released. */
hl_status hl_frame_work_set_up(hl_renderer *renderer, const hl_scene_description *scene,
                               const frame_request *request, frame_work *work, hl_error *error);

void hl_frame_work_release(hl_renderer *renderer, frame_work *work);

#endif
