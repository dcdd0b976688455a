/* render/sweep.h - describes one pass over the sheets on the processors: its state, and the stages that the
 * sheet loop calls. The plan says what the pass does (plan/frame_plan.h), and the pass never changes it.
 *
 * Each tile is worked on by one task at a time. A task fills, shades and composites a tile of the picture, or
 * fills and composites a tile of a light's buffer. The order of the work on a tile is always the same, so
 * that the picture does not depend on threads. */
#ifndef HL_RENDER_SWEEP_H
#define HL_RENDER_SWEEP_H

#include <halflight/render.h>

#include "plan/frame_plan.h"
#include "render/layers.h"
#include "render/surface_samples.h"
#include "render/sweep_constants.h"
#include "render/view_sheets.h"
#include "shadow/shadow_method.h"
#include "surface/fragments.h"

/* One light of a sweep with its buffer. */
typedef struct sweep_light {
  const light_source *source;
  light_shadow shadow;
  view_sheets sheets;       /* the sheets of the shadow buffer's view */
  light_texture texture;    /* the picture that the light projects */
  void *reads;              /* owned; holds the next three arrays (light_reads.h) */
  int32_t *needed_until;    /* [tiles of the buffer]; the last slab that needs each tile; 0 if no slab needs
                             * it. If null, all slabs need all tiles */
  int32_t *sublights_until; /* the same numbers as in needed_until, for the tiles of the sub-lights' buffers;
                             * see light_shadow.sublights_until */
  unsigned char *owned; /* [tiles of the buffer]; 1 for tiles whose light this part of a shared picture sends
                         * to the other parts; if null, this part sends no light */
} sweep_light;

static inline bool hl_light_needs(const sweep_light *light, size_t tile, int slab) {
  return light->needed_until == NULL || light->needed_until[tile] >= slab;
}

/* The sweep advances in stretches of slabs. One thread does the work on all slabs of a stretch in one tile.
 * The lights are a stretch ahead of the picture, and both share the threads (sweep_loop.c). */
typedef struct slab_stretch {
  int first, end; /* the stretch has the slabs that end at the sheets `first` to `end` - 1; it is empty if the
                   * two numbers are equal */
} slab_stretch;

/* One thread's counts and times, on cache lines of its own. */
typedef struct sweep_counts {
  _Alignas(64) uint64_t samples, filled_image, filled_light, skipped_image,
      skipped_light; /* samples: number of shaded pixels; the other members: numbers of tiles */
  uint64_t pixels_image, pixels_light, pixels_skipped_image, pixels_skipped_light;
  uint64_t pixels_seen, pixels_covered; /* pixels_seen: number of seen pixels; pixels_covered: number of
                                         * pixels that opaque matter covers; counted only by the sweep of
                                         * hidden.c */
  double seconds_fill, seconds_shade;   /* the times of the image stage, in seconds: for filling tiles, and
                                         * for shading */
  double seconds_light;                 /* the time of the light stage, in seconds */
  double seconds_composite;             /* seconds for compositing in the stage of light */
} sweep_counts;

/* The matter that a pass shades. MATTER_OWN: the scene's own matter. MATTER_EVEN: white matter whose surfaces
 * send on the same light whatever the angle at which it comes. MATTER_WHITE: white matter. MATTER_OPEN: white
 * matter that receives no shadow. */
typedef enum layer_matter { MATTER_OWN, MATTER_EVEN, MATTER_WHITE, MATTER_OPEN } layer_matter;

/* A pass over the tiles of a sweep, which shades them once more for one of the picture's layers
 * (hl_layers). */
typedef struct layer_pass {
  shade_tile_function *shade;
  const shade_light *lights; /* [light_count] */
  int light_count;
  float ambient[3], emission;
  const scatter_field *scattered; /* null if there is none */
  const sky_light *sky;           /* null if there is none */
  layer_matter matter;
  float *pixels;
  size_t tile_floats;
} layer_pass;

typedef struct sweep_layers {
  layer_pass *passes; /* owned, together with all arrays below; [pass_count] */
  int pass_count;
  shade_light *white_lights;                  /* [light_count of the sweep] */
  shade_volume *even_volumes;                 /* [volume_count]; white volumes whose surfaces send on all
                                               * light that arrives */
  shade_volume *white_volumes, *open_volumes; /* [volume_count]; two lists of white copies of the volumes; the
                                               * copies in open_volumes receive no shadow */
  shade_patch *patches;                       /* [threads][volume_count]; patches that refer to the volumes of
                                               * a pass */
  classifier *white;   /* [volume_count]; the volumes' tables with white colours; the tables are borrowed */
  sky_light white_sky; /* the sky without its colour */
  float (*ones)[4];    /* a colour table */
} sweep_layers;

/* The greatest number of points along each side of a light. Samples of surfaces cast rays to these points to
 * find the surfaces close before them (late/). */
enum { LIGHT_POINTS_SIDE = 4 };
typedef struct light_points {
  vec3 offset[LIGHT_POINTS_SIDE * LIGHT_POINTS_SIDE]; /* [count]; offsets from the light's centre
                                                       * (hl_light_point) */
  int count;                                          /* number of points; 1 where shadows are hard */
  double reach;                                       /* the greatest length of an offset */
} light_points;

/* Fragments and surfaces of the sweep's views; all zeros if the frame has no surfaces. */
typedef struct surface_state {
  fragments image, lights[FRAME_LIGHTS];
  fragments unseen;              /* fragments, in the eye's view, of the meshes that are not visible but cast
                                  * shadows on volumes */
  void *memory;                  /* owned; holds all arrays below */
  shade_patch *patches;          /* [threads][volumes] */
  float (*cuts)[TILE_PIXELS];    /* [threads][volumes][2]; for each pixel, the heights at which the ray enters
                                  * and leaves a volume's box within a piece of the slab */
  float (*bounds)[TILE_PIXELS];  /* [threads][2]; for each pixel, the heights at which a piece of the slab
                                  * begins and ends */
  float (*passing)[TILE_PIXELS]; /* [threads][lights][channels]; the result of hl_near_surfaces_find() */
  float (*contact)[SURFACE_SAMPLES]; /* [threads][lights][channels]; the result of hl_contact_find() */
  light_points *points;              /* [lights] */
} surface_state;

typedef struct sweep sweep;

/* The function that a sweep calls for each tile of a slab. Returns the blocks that stay open: the blocks in
 * which later sheets may still change the picture. */
typedef uint32_t tile_action(const sweep *sweep, const tile_slab *slab);

/* The arrays that the sheet loop works in. */
typedef struct loop_arrays {
  void *memory;                      /* owned; holds the arrays that follow */
  uint16_t *open;                    /* [tiles]; blocks not yet opaque */
  uint32_t *tasks;                   /* [tiles of the image and of all lights]; the tiles on which a stretch
                                      * has work */
  shade_job *slab_shades;            /* [stretch]; the jobs for the picture's slabs of a stretch */
  attenuate_job *slab_attenuates;    /* [lights][stretch]; the jobs for the lights' slabs of a stretch */
  shade_patch *shade_patches;        /* [threads][volumes] */
  unsigned char *scratch;            /* [threads][volumes][SHADE_SCRATCH_BYTES] */
  attenuate_volume *scratch_volumes; /* [threads][volumes] */
  sweep_counts *counts;              /* [threads] */
} loop_arrays;

/* The time and the waits of a sweep. */
typedef struct sweep_times {
  double seconds_sort, seconds_tiles, seconds_soften;
  uint64_t waits; /* number of times that all threads have waited for each other */
} sweep_times;

/* The loop over the sheets. */
typedef struct sweep_loop {
  int ring; /* number of sheets whose light a buffer keeps; 1: the work on the picture and on the lights
             * alternates, slab by slab */
  slab_stretch picture_stretch, light_stretch;
  int task_start[FRAME_LIGHTS + 2]; /* indices of tasks: of the picture's first task, of each light's first
                                     * task, and the index that follows the last task */
  sweep_times times;
} sweep_loop;

/* The pixels that a sweep makes. */
typedef struct sweep_target {
  float *pixels;                 /* [tiles][16][4][16]; the sweep's own */
  const int32_t *shown_from;     /* [tiles][16]; the first visible slab of each block; if null, opaque matter
                                  * hides nothing */
  const layer_pixels *layers;    /* the pixels of the layers; null if no layers are wanted */
  const maximum_values *maximum; /* values of a maximum projection. If `maximum` is null, or its member
                                  * `values` is null, the picture shows lit matter */
} sweep_target;

/* The purpose of a sweep: to make a picture, or to search for hidden matter before the picture is made. A
 * search lights nothing (hidden.c). */
typedef enum sweep_purpose { SWEEP_PICTURE, SWEEP_SEARCH } sweep_purpose;

/* The purpose of a sweep, and the function that it calls for each tile. */
typedef struct sweep_act {
  sweep_purpose purpose;
  tile_action *run; /* the function for a tile: steps 12 to 16, or other steps in their place */
  void *data;       /* the caller's data for `run` */
} sweep_act;

struct sweep {
  /* hl_sweep_set_up() sets this member and the next ones, down to `act` */
  const frame_plan *frame_plan;
  const sweep_plan *plan;
  const sweep_sheets *geometry; /* the plan's */
  const frame *frame;           /* the frame plan's */
  const picture_share *share;   /* the part of the picture that this sweep shades */
  sheet_content content;
  sweep_target target;
  sweep_act act;
  /* the views */
  view_sheets image;
  sweep_light lights[FRAME_LIGHTS];
  sweep_constants constants;
  sweep_layers layers;
  surface_state surfaces;
  loop_arrays arrays;
  sweep_loop loop;
};

/* The context, the threads and the memory that a sweep uses. */
typedef struct sweep_means {
  hl_context *context;
  hl_pool *pool;
  hl_reserve *reserve;
  const hot_functions *hot;
} sweep_means;

/* Sets up a sweep of a plan, without memory. Call hl_sweep_begin() next, or hl_sweep_count_memory(). */
void hl_sweep_set_up(sweep *sweep, const sweep_means *means, const frame_plan *frame_plan,
                     const sweep_plan *plan, const sweep_target *target);

/* Finds, before a sweep that goes from back to front, which slabs opaque matter hides from the eye
 * (hidden.c). pixels: the sweep's pixels; they must be zeros, and are zeros again afterwards. *shown_from:
 * receives [tiles][16], which the caller releases; null if the sweep goes from front to back. */
hl_status hl_find_hidden(const sweep_means *means, const frame_plan *frame_plan, const sweep_plan *plan,
                         float *pixels, int32_t **shown_from, hl_render_statistics *statistics,
                         hl_error *error);

/* The function that a lit picture calls for each tile: steps 12 to 16, and the layers (sweep_stages.c). */
uint32_t hl_light_tile(const sweep *sweep, const tile_slab *slab);

/* Does steps 1 to 4, and allocates the memory. The caller keeps two arrays from frame to frame. buffers: one
 * for each light of the frame. memory: [FRAME_LIGHTS]; blocks that the frame's sweeps use one after the
 * other. */
hl_status hl_sweep_begin(sweep *sweep, shadow_buffer *buffers, shadow_memory *memory, hl_error *error);
/* Marks all blocks of the sweep's part of the picture as open. */
void hl_sweep_open(sweep *sweep);
/* Adds the sweep's counts and seconds to the statistics. */
void hl_sweep_count(const sweep *sweep, hl_render_statistics *statistics);
void hl_sweep_end(sweep *sweep);

/* The memory that hl_sweep_begin() takes, summed over the sweeps of a frame that were counted. */
typedef struct sweeps_memory {
  hl_layout buffers;         /* the lights' shadow buffers, which the renderer keeps between frames */
  size_t kept[FRAME_LIGHTS]; /* number of bytes that shadow methods keep between frames; the sweeps use these
                              * bytes one after the other */
  hl_layout passing;         /* memory that a sweep releases at its end, without light textures and lists of
                              * splatted voxels */
} sweeps_memory;

/* Adds the memory that hl_sweep_begin() takes for a sweep that is set up. The sweep cannot be used any more:
 * to run it, set it up again. */
void hl_sweep_count_memory(sweep *sweep, sweeps_memory *memory);

/* The sheet loop: steps 3 to 18 (sweep_loop.c). */
hl_status hl_sweep_run(sweep *sweep, hl_error *error);

/* The work on one tile in one slab. The comments beside the functions name the steps that they do
 * (sweep_stages.c). */
void hl_sweep_shade(sweep *sweep, const shade_job *job, size_t tile, int worker); /* does steps 6 and 8 to
                                                                                   * 16 */
void hl_sweep_attenuate(sweep *sweep, int light, const attenuate_job *job, size_t tile,
                        int worker); /* does steps 7 to 11 and 17 */

/* A tile's column and row. */
static inline int hl_tile_x(const sweep *sweep, size_t tile) {
  return (int)(tile % (size_t)sweep->frame_plan->picture.tiles_x);
}
static inline int hl_tile_y(const sweep *sweep, size_t tile) {
  return (int)(tile / (size_t)sweep->frame_plan->picture.tiles_x);
}

#endif
