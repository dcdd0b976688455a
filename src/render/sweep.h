/* render/sweep.h - one pass over the sheets: its state, and the stages that the sheet loop calls.
 *
 * Threads own tiles: an image tile is filled, shaded and composited by one task, a light tile filled and
 * composited by one task, always in the same order, so that the picture does not depend on threads. */
#ifndef HL_RENDER_SWEEP_H
#define HL_RENDER_SWEEP_H

#include <halflight/render.h>

#include "core/memory.h"
#include "render/frame.h"
#include "render/hot.h"
#include "render/layers.h"
#include "shadow/shadow_method.h"

/* A volume made ready: kept between frames while its voxels and transfer function stay. */
typedef struct prepared_volume {
  const hl_scene_volume *scene; /* the frame's scene */
  hl_volume *volume;            /* retained */
  grid grid;
  classifier classifier;
  double empty;                  /* data value */
  hl_kernel kernel;              /* that the grid's cells are bounded for */
  hl_transfer_function function; /* points owned; what the classifier was made of */
  double clip[6];
  int clipped;
} prepared_volume;

#define NO_ENTRY UINT32_MAX

/* A patch of one sheet, kept for the next slab. */
typedef struct kept_patch {
  int32_t sheet;         /* -1: none */
  uint16_t need, blocks; /* blocks that were filled; those of them with density */
} kept_patch;

/* What some slabs in a row show of a patch. */
typedef struct patch_run {
  int32_t first;             /* the sheet before them; -1: none */
  int32_t end;               /* of the bundle among them that was asked for last */
  uint16_t asked;            /* the blocks that were looked at */
  uint16_t filled;           /* the blocks that the bundle was filled for */
  relevant_blocks relevant;  /* where something may be, of those that were looked at */
  uint16_t shows[RUN_SLABS]; /* where something may be seen, of those that were filled for; of the bundle's
                                slabs */
} patch_run;

/* What one view, the eye's or a light's, sees of the last sheets. */
typedef struct view_sheets {
  occupancy occupancy;
  voxel_lists *lists;    /* owned; [grids]; splat only */
  int bundle;            /* sheets that are filled in one go; a divisor of RUN_SLABS */
  int ring;              /* bundle + 1: sheets that are kept; sheet k at k % ring */
  fill_source *sources;  /* owned; [ring][grids] */
  slab_run *runs;        /* owned; [grids]; the slabs that the last one is among */
  patch_run *patch_runs; /* owned; [patches] */
  float *entries; /* lent; [entry_count][2][256]; where rays enter a box and leave it; room for all patches;
                     null where no box cuts anything visible */
  uint32_t *entry_of;   /* owned; [patches]; NO_ENTRY where none was asked for */
  uint32_t entry_count; /* atomic */
  box_rays *box_rays;   /* owned; [grids] */
  float *density;       /* lent; [patches][ring][256], block-major */
  kept_patch *kept;     /* owned; [patches][ring]; what is in density */
} view_sheets;

/* One light of a sweep with its buffer. */
typedef struct sweep_light {
  const light_source *source;
  light_shadow shadow;
  view_sheets sheets;  /* of the shadow buffer's view */
  light_screen screen; /* the image that the light projects */
  light_image *image;  /* owned; the image on the light itself; null: none */
} sweep_light;

/* One thread's, on lines of the cache of its own. */
typedef struct sweep_counts {
  _Alignas(64) uint64_t samples, filled_image, filled_light, skipped_image,
      skipped_light; /* pixels shaded; tiles */
  uint64_t pixels_image, pixels_light, pixels_skipped_image, pixels_skipped_light;
  uint64_t pixels_seen, pixels_covered;    /* by a sweep that finds what is hidden */
  double seconds_fill, seconds_shade;      /* of the image stage */
  double seconds_light, seconds_composite; /* of the light stage; the composite is part of it */
} sweep_counts;

typedef struct sweep {
  hl_context *context;
  hl_pool *pool;
  hl_reserve *reserve; /* the renderer's */
  const hot_functions *hot;
  const hl_scene_description *scene;
  const frame *frame;
  const frame_sweep *geometry;
  prepared_volume *volumes; /* [volume_count] */
  const grid *grids;        /* [volume_count], copies of the volumes' grids */
  int volume_count;
  double longest_way; /* of shadowed light through a slab, at most; frame units */
  const kernel *kernel;
  bool splat;                       /* else gather */
  bool first;                       /* the sweep that carries ambient light and opacity */
  const layer_pixels *layer_pixels; /* where the layers go; null: none */
  const maximum_values *maximum;    /* what a maximum projection keeps; without values: matter is lit */
  bool measures;                    /* the sweep that carries depth and normals */
  int channels;                     /* of light attenuation */
  /* the image */
  view_sheets image;
  size_t tiles;
  int tiles_x, tiles_y;
  uint16_t *open; /* [tiles]; blocks not yet opaque */
  float *pixels;  /* [tiles][16][4][16] */
  int32_t *
      shown_from; /* the caller's; [tiles][16]; slabs of a block before that one are hidden; null: none are */
  int32_t *covering; /* [tiles][16]; shown_from of another sweep, which this one finds instead of a picture;
                        or null */
  bool trying;       /* covering: blocks stay open when they are opaque */
  sweep_light lights[FRAME_LIGHTS];
  /* the stage now running */
  int sheet;
  uint32_t *tasks; /* tiles of the stage: the image's, or each light's */
  size_t task_capacity;
  int task_start[FRAME_LIGHTS + 1]; /* where each light's start, and the end */
  shade_volume *shade_volumes;      /* [grids] */
  shade_patch *shade_patches;       /* [threads][grids] */
  shade_light shade_lights[FRAME_LIGHTS];
  shade_job shade;
  sweep_layers layers;
  attenuate_job attenuate[FRAME_LIGHTS];
  unsigned char *scratch;            /* [threads][grids][SHADE_SCRATCH_BYTES] */
  attenuate_volume *scratch_volumes; /* [threads][grids] */
  sweep_counts *counts;              /* [threads] */
  double seconds_sort, seconds_image, seconds_light, seconds_soften;
} sweep;

/* Of a sweep from back to front, before its steps: makes shown_from, which the caller releases (hidden.c).
 * Pixels are zeros before and after. */
hl_status hl_sweep_find_hidden(sweep *sweep, hl_render_statistics *statistics, hl_error *error);
/* Of a tile's blocks, those that are shown in a slab. */
uint32_t hl_shown_blocks(const int32_t shown_from[TILE_BLOCKS], int slab);
/* Instead of steps 12 to 16 then, for one tile. Returns the blocks that stay open. */
uint32_t hl_sweep_cover(const sweep *sweep, const shade_patch *patches, int patch_count, size_t tile,
                        uint32_t blocks, int worker, void *scratch);

/* Steps 1 and 2, and memory. buffers: one per light of the sweep, kept by the caller between frames; so is
 * memory, [FRAME_LIGHTS], which sweeps share in turn. */
hl_status hl_sweep_begin(sweep *sweep, shadow_buffer *buffers, shadow_memory *memory, hl_error *error);
/* All blocks of the picture are open. */
void hl_sweep_open(sweep *sweep);
/* Raises statistics by what the steps took. */
void hl_sweep_count(const sweep *sweep, hl_render_statistics *statistics);
void hl_sweep_end(sweep *sweep);

/* What hl_sweep_begin would hold, bytes. */
typedef struct sweep_bytes {
  uint64_t buffers;              /* of the lights; they stay */
  uint64_t memory[FRAME_LIGHTS]; /* of methods of shadows; sweeps share it in turn */
  uint64_t passing; /* what the sweep gives back; slides and the lists of splatted voxels apart */
} sweep_bytes;

/* The sweep's context, scene, frame, geometry, grids and channels must be set. points: room for the corners
 * that hl_frame_visible_points() gives. threads: of the pool. */
hl_status hl_sweep_bytes(const sweep *sweep, vec3 *points, int threads, sweep_bytes *bytes, hl_error *error);

/* The sheet loop: steps 3 to 18. */
hl_status hl_sweep_run(sweep *sweep, hl_error *error);

/* Stages (sweep_stages.c), each for the slab before the sheet. */
void hl_sweep_shade(sweep *sweep, int sheet);     /* steps 6, 8 to 16: the image */
void hl_sweep_attenuate(sweep *sweep, int sheet); /* steps 7 to 11 and 17: the lights */
void hl_sweep_soften(sweep *sweep, int sheet);    /* section 5 */

/* Layers (layers.c): the passes of the sweep's lights, after hl_sweep_begin; their sheet, as the sweep's own
 * shading has it; and one tile of all of them. */
hl_status hl_sweep_layers_begin(sweep *sweep, hl_error *error);
void hl_sweep_layers_end(sweep *sweep);
void hl_sweep_layers_sheet(sweep *sweep);
void hl_sweep_layers_tile(const sweep *sweep, const shade_patch *patches, int patch_count, size_t tile,
                          uint32_t blocks, int worker, void *scratch);

/* A view's sheets (view_sheets.c). spare: as hl_occupancy_build has it. What fails half-way is released by
 * hl_view_sheets_end. */
hl_status hl_view_sheets_begin(const sweep *sweep, const view *view, double spare, view_sheets *sheets,
                               hl_error *error);
void hl_view_sheets_end(const sweep *sweep, view_sheets *sheets);
/* The bytes that they hold, lists of splatted voxels apart. */
uint64_t hl_view_sheets_bytes(const sweep *sweep, const view *view, double spare);
/* Before patches of a sheet are asked for. */
void hl_view_sheets_reach(const sweep *sweep, const view *view, int sheet, view_sheets *sheets);
/* Of the needed blocks, those in which a patch's slab may hold anything, as far as is known. */
uint32_t hl_patch_relevant(const sweep *sweep, const view_sheets *sheets, size_t tile, size_t patch,
                           int sheet, uint32_t need);
/* Of those, one at least, the patch's densities on the sheet and the one before, [256] block-major, in the
 * blocks in which any may show: kept from a slab before, or filled now. */
typedef struct patch_slab {
  const float *before, *current; /* valid in blocks */
  const float *enter,
      *leave; /* of the box, [256] block-major; null where it cuts nothing visible, unset where uncut */
  int uncut;  /* the box cuts nothing in this slab, and no light on its way through it to the eye's pixels */
  uint32_t blocks;
} patch_slab;
/* need: what the bundle's next slabs may ask for. pixels: is raised by the pixels filled. */
patch_slab hl_patch_slab(const sweep *sweep, view_sheets *sheets, size_t tile, size_t patch, int sheet,
                         uint32_t need, uint64_t *pixels);

#endif
