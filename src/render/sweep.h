/* render/sweep.h - one pass over the sheets: its state, and the stages that the sheet loop calls.
 *
 * Threads own tiles: an image tile is filled, shaded and composited by one task, a light tile filled and
 * composited by one task, always in the same order, so that the picture does not depend on threads. */
#ifndef HL_RENDER_SWEEP_H
#define HL_RENDER_SWEEP_H

#include <halflight/render.h>

#include "render/layers.h"
#include "render/share.h"
#include "render/surface_samples.h"
#include "render/view_sheets.h"
#include "shadow/shadow_method.h"
#include "surface/fragments.h"

/* One light of a sweep with its buffer. */
typedef struct sweep_light {
  const light_source *source;
  light_shadow shadow;
  view_sheets sheets;       /* what the shadow buffer's view sees */
  light_texture texture;    /* the picture that the light projects */
  light_emission *emission; /* owned; the picture on the light itself; null: none */
  void *reads;              /* owned; holds the arrays that follow (light_reads.h) */
  int32_t *needed_until; /* [tiles of the buffer]; the last slab that needs the tile, 0: none does; null: all
                            slabs need all tiles */
  int32_t *sublights_until; /* light_shadow's */
  unsigned char *owned; /* [tiles of the buffer]; 1 where this part of a shared picture tells the others of
                           the tile; null: it tells them nothing */
} sweep_light;

static inline bool hl_light_needs(const sweep_light *light, size_t tile, int slab) {
  return light->needed_until == NULL || light->needed_until[tile] >= slab;
}

/* The sweep advances in stretches of slabs: a tile is taken through all slabs of a stretch by one thread. The
 * lights are a stretch ahead of the picture, and both share the threads (sweep_loop.c). */
typedef struct slab_stretch {
  int first, end; /* the slabs before sheets first to end - 1; empty where they are equal */
} slab_stretch;

/* One thread's counts, on cache lines of its own. */
typedef struct sweep_counts {
  _Alignas(64) uint64_t samples, filled_image, filled_light, skipped_image,
      skipped_light; /* pixels shaded; tiles */
  uint64_t pixels_image, pixels_light, pixels_skipped_image, pixels_skipped_light;
  uint64_t pixels_seen, pixels_covered; /* counted only by the sweep of hidden.c */
  double seconds_fill, seconds_shade;   /* of the image stage */
  double seconds_light;                 /* the light stage */
  double seconds_composite;             /* the compositing in it */
} sweep_counts;

/* The matter that a pass shades: the scene's own; white, and sending on the light that arrives from any
 * angle; white; white, and receiving no shadow. */
typedef enum layer_matter { MATTER_OWN, MATTER_EVEN, MATTER_WHITE, MATTER_OPEN } layer_matter;

/* One more shading of the sweep's tiles. */
typedef struct layer_pass {
  shade_tile_function *shade;
  const shade_light *lights; /* [light_count] */
  int light_count;
  float ambient[3], emission;
  const scatter_field *scattered; /* null: none */
  const sky_light *sky;           /* null: none */
  layer_matter matter;
  float *pixels;
  size_t tile_floats;
} layer_pass;

typedef struct sweep_layers {
  layer_pass *passes; /* owned with all arrays that follow; [pass_count] */
  int pass_count;
  shade_light *white_lights;                  /* [light_count of the sweep] */
  shade_volume *even_volumes;                 /* [volume_count]; surfaces send on all light that arrives */
  shade_volume *white_volumes, *open_volumes; /* [volume_count]; with surfaces; and receiving no shadow */
  shade_patch *patches;                       /* [threads][volume_count]; of a pass's own volumes */
  classifier *white;   /* [volume_count]; the volumes' tables, borrowed, with white colours */
  sky_light white_sky; /* the sky without its colour */
  float (*ones)[4];    /* a colour table */
} sweep_layers;

/* Points that stand for a light where surfaces look for what is close before them (contact.h). */
enum { LIGHT_POINTS_SIDE = 4 };
typedef struct light_points {
  vec3 offset[LIGHT_POINTS_SIDE * LIGHT_POINTS_SIDE]; /* [count]; from the light's centre (hl_light_point) */
  int count;                                          /* 1 where shadows are hard */
  double reach;                                       /* the greatest length of an offset */
} light_points;

/* The surfaces of the sweep's views; zeros where there are none. */
typedef struct surface_state {
  fragments image, lights[FRAME_LIGHTS];
  fragments unseen;              /* of the eye's view: meshes that are not visible and shade volumes */
  void *memory;                  /* owned; all arrays that follow */
  shade_patch *patches;          /* [threads][volumes] */
  float (*cuts)[TILE_PIXELS];    /* [threads][volumes][2]; where the pieces of slabs begin and end in boxes */
  float (*bounds)[TILE_PIXELS];  /* [threads][2]; where they begin and end */
  float (*passing)[TILE_PIXELS]; /* [threads][lights][channels]; of near_surfaces.h */
  float (*contact)[SURFACE_SAMPLES]; /* likewise; of contact.h */
  light_points *points;              /* [lights] */
} surface_state;

typedef struct sweep sweep;

/* A function that a sweep calls for each tile of a slab. Returns the blocks that stay open: in them, later
 * sheets may still change the picture. */
typedef uint32_t tile_action(const sweep *sweep, const tile_slab *slab);

/* The arrays that the sheet loop works in. */
typedef struct loop_arrays {
  void *memory;                      /* owned; holds the arrays that follow */
  uint16_t *open;                    /* [tiles]; blocks not yet opaque */
  uint32_t *tasks;                   /* [tiles of the image and of all lights]; the stretches' tiles */
  shade_job *slab_shades;            /* [stretch]; of the picture's slabs */
  attenuate_job *slab_attenuates;    /* [lights][stretch]; of the lights' slabs */
  shade_volume *shade_volumes;       /* [volumes] */
  shade_cut *shade_cuts;             /* of all volumes, one after the other */
  shade_patch *shade_patches;        /* [threads][volumes] */
  unsigned char *scratch;            /* [threads][volumes][SHADE_SCRATCH_BYTES] */
  attenuate_volume *scratch_volumes; /* [threads][volumes] */
  sweep_counts *counts;              /* [threads] */
  float *srgb_decode;                /* [256]: the linear values of sRGB's codes, for voxels with colours */
  float *tint_decode;                /* [256]: the linear values of a mask's codes, their squares */
} loop_arrays;

/* What a sweep took. */
typedef struct sweep_times {
  double seconds_sort, seconds_tiles, seconds_soften;
  uint64_t waits; /* how often all threads have waited for each other */
} sweep_times;

struct sweep {
  /* the frame; set by the caller */
  sheet_content content; /* sheets: of geometry */
  const hl_scene_description *scene;
  const frame *frame;
  const frame_sweep *geometry;
  int channels;               /* of light attenuation: 1 or 3 */
  tile_action *act;           /* steps 12 to 16, or what takes their place */
  void *action;               /* of act; the caller's */
  bool first;                 /* the sweep that carries ambient light and opacity */
  bool measures;              /* the sweep that carries depth and normals */
  const picture_share *share; /* the part of the picture that this sweep shades */
  bool preparatory; /* this sweep prepares another one: it reports no progress, and its sheets are not counted
                     */
  const layer_pixels *layer_pixels; /* pixels of the layers; null: none */
  const scatter_field *scattered;   /* null: none */
  const sky_light *sky;             /* null: none */
  const phase_tables *phases;
  const maximum_values *maximum; /* values of a maximum projection; values null: matter is lit */
  float *pixels;                 /* [tiles][16][4][16] */
  int32_t *shown_from;           /* [tiles][16]; first visible slab per block; null: nothing is hidden */
  /* the picture */
  view_sheets image;
  size_t tiles;
  int tiles_x, tiles_y;
  sweep_light lights[FRAME_LIGHTS];
  shade_light shade_lights[FRAME_LIGHTS];
  attenuate_job attenuate[FRAME_LIGHTS]; /* what is the same for all slabs is filled in */
  shade_job shade;                       /* likewise */
  sweep_layers layers;
  surface_state surfaces;
  /* the loop */
  int ring; /* sheets whose light is kept; 1: picture and lights take turns, slab by slab */
  slab_stretch picture_stretch, light_stretch;
  int task_start[FRAME_LIGHTS + 2]; /* the picture's first task, each light's, and one past the last task */
  loop_arrays arrays;
  sweep_times times;
};

/* hidden.c. Called before the steps of a sweep that goes from back to front. Allocates and fills shown_from,
 * which the caller releases. The sweep's pixels must be zeros, and are zeros afterwards. */
hl_status hl_sweep_find_hidden(sweep *sweep, hl_render_statistics *statistics, hl_error *error);

/* The tile action of a lit picture: steps 12 to 16, and the layers (sweep_stages.c). */
uint32_t hl_light_tile(const sweep *sweep, const tile_slab *slab);

/* Steps 1 to 4, and memory. The caller keeps both arrays from frame to frame: buffers holds one buffer per
 * light of the frame, memory [FRAME_LIGHTS] blocks that the frame's sweeps use in turn. */
hl_status hl_sweep_begin(sweep *sweep, shadow_buffer *buffers, shadow_memory *memory, hl_error *error);
/* Plans the sweep's lights and sets its shading up, as hl_sweep_begin() does, but takes no memory for light
 * and densities: for a device that has its own. hl_sweep_end() ends it. */
hl_status hl_sweep_describe(sweep *sweep, hl_error *error);
/* The first slab that a light's shadows reach. */
int hl_sweep_first_reached(const sweep *sweep, const light_shadow *shadow);
/* Seconds of a clock that never runs backwards. */
double hl_clock_seconds(void);

/* Opens all blocks of the sweep's part of the picture. */
void hl_sweep_open(sweep *sweep);
/* Adds the sweep's counts and seconds to the statistics. */
void hl_sweep_count(const sweep *sweep, hl_render_statistics *statistics);
void hl_sweep_end(sweep *sweep);

/* What hl_sweep_begin() takes for the sweeps of a frame that were counted. */
typedef struct sweeps_memory {
  hl_layout buffers;         /* the lights' shadow buffers, which the renderer keeps between frames */
  size_t kept[FRAME_LIGHTS]; /* bytes that shadow methods keep between frames; the sweeps use them in turn */
  hl_layout passing; /* ends with each sweep; without light textures and the lists of splatted voxels */
} sweeps_memory;

/* Adds what hl_sweep_begin() takes for a sweep as the caller sets it. points: room for the corners that
 * hl_frame_visible_points() gives. The sweep then has served: another one is begun. */
hl_status hl_sweep_count_memory(sweep *sweep, vec3 *points, sweeps_memory *memory, hl_error *error);

/* The sheet loop: steps 3 to 18 (sweep_loop.c). */
hl_status hl_sweep_run(sweep *sweep, hl_error *error);

/* One tile in one slab (sweep_stages.c). */
void hl_sweep_shade(sweep *sweep, const shade_job *job, size_t tile, int worker); /* steps 6, 8 to 16 */
void hl_sweep_attenuate(sweep *sweep, int light, const attenuate_job *job, size_t tile,
                        int worker); /* steps 7 to 11 and 17 */

/* A tile's column and row. */
static inline int hl_tile_x(const sweep *sweep, size_t tile) { return (int)(tile % (size_t)sweep->tiles_x); }
static inline int hl_tile_y(const sweep *sweep, size_t tile) { return (int)(tile / (size_t)sweep->tiles_x); }

#endif
