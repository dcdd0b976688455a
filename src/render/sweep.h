/* render/sweep.h - one pass over the sheets: its state, and the stages that the sheet loop calls.
 *
 * Threads own tiles: an image tile is filled, shaded and composited by one task, a light tile filled and
 * composited by one task, always in the same order, so that the picture does not depend on threads. */
#ifndef HL_RENDER_SWEEP_H
#define HL_RENDER_SWEEP_H

#include "light/soft_cascade.h"
#include "light/soft_paper.h"
#include "render/frame.h"
#include "simd/hot.h"

/* A volume made ready: kept between frames while its voxels and transfer function stay. */
typedef struct prepared_volume {
  const hl_scene_volume *scene;   /* the frame's scene */
  hl_volume *volume;              /* retained */
  grid grid;
  classifier classifier;
  double empty;                   /* data value */
  hl_transfer_function function;  /* points owned; what the classifier was made of */
  double clip[6];
  int clipped;
} prepared_volume;

enum { RING = 2 }; /* sheets k-1 and k */

/* The image's sheets of one volume, as far as its rectangle of tiles goes. */
typedef struct image_sheets {
  float *density[RING];           /* the rectangle's first pixel of each; rows stride apart; in memory */
  size_t stride;                  /* floats; a tile of margin on either side, a row above and below */
} image_sheets;

/* A light's tile of one sheet, kept for the next slab. */
typedef struct kept_tile {
  int32_t sheet;                  /* -1: none */
  uint16_t need, blocks;          /* blocks that were filled; those of them with density */
} kept_tile;

/* One light of a sweep with its buffer. */
typedef struct sweep_light {
  const light_source *source;
  shadow_buffer *buffer;          /* null: no shadows */
  occupancy occupancy;
  voxel_lists *lists;             /* owned; [grids]; splat only */
  light_screen screen;            /* the image that the light projects */
  float *screen_pixels;           /* owned; the image averaged; null where it is used as it is */
  float *enter, *leave;           /* owned; [patches][256]; null where no box cuts */
  float *density;                 /* owned; [patches][RING][256]; the last sheets, block-major */
  kept_tile *kept;                /* owned; [patches][RING]; what is in density */
  soft_paper paper;               /* by the source's soft method */
  soft_cascade cascade;
} sweep_light;

typedef struct sweep_counts {
  uint64_t samples, filled_image, filled_light, skipped_image, skipped_light; /* pixels shaded; tiles */
  uint64_t pixels_image, pixels_light, pixels_skipped_image, pixels_skipped_light;
  double seconds_image, seconds_light, seconds_composite; /* spent filling; the composite is part of the light's */
} sweep_counts;

typedef struct sweep {
  hl_context *context;
  hl_pool *pool;
  const hot_functions *hot;
  const hl_scene_description *scene;
  const frame *frame;
  const frame_sweep *geometry;
  prepared_volume *volumes;       /* [volume_count] */
  const grid *grids;              /* [volume_count], copies of the volumes' grids */
  int volume_count;
  const kernel *kernel;
  bool splat;                     /* else gather */
  bool first;                     /* the sweep that carries ambient light and opacity */
  int channels;                   /* of light attenuation */
  /* the image */
  occupancy occupancy;
  voxel_lists *lists;             /* [grids]; splat only */
  image_sheets *sheets;           /* [grids] */
  float *sheet_memory;
  uint16_t *filled[RING];         /* [patches]; blocks that hold density; 0: the patch is all zero */
  float *enter, *leave;           /* [patches][256]; null where no box cuts anything visible */
  size_t tiles;
  int tiles_x, tiles_y;
  uint16_t *open;                 /* [tiles]; blocks not yet opaque */
  float *pixels;                  /* [tiles][16][4][16] */
  sweep_light lights[FRAME_LIGHTS];
  /* the stage now running */
  int fill_sheet, light_sheet;
  uint32_t *tasks;                /* tiles of the stage: the image's, then each light's */
  size_t task_capacity;
  int task_start[FRAME_LIGHTS + 2]; /* where each kind starts */
  fill_source *image_sources;     /* [grids]; of fill_sheet */
  fill_source *light_sources;     /* [lights][RING][grids]; of light_sheet and the one before */
  shade_volume *shade_volumes;    /* [grids] */
  shade_patch *shade_patches;     /* [threads][grids] */
  shade_light shade_lights[FRAME_LIGHTS];
  shade_job shade;
  attenuate_job attenuate[FRAME_LIGHTS];
  float *scratch;                 /* [threads][grids][256] */
  attenuate_volume *scratch_volumes; /* [threads][grids] */
  sweep_counts *counts;           /* [threads] */
  double seconds_sort, seconds_fill, seconds_shade, seconds_soften;
} sweep;

/* Steps 1 and 2, and memory. buffers: one per light of the sweep, kept by the caller between frames. */
hl_status hl_sweep_begin(sweep *sweep, shadow_buffer *buffers, hl_error *error);
void hl_sweep_end(sweep *sweep);

/* The sheet loop: steps 3 to 18. */
hl_status hl_sweep_run(sweep *sweep, hl_error *error);

/* Stages (sweep_stages.c). */
void hl_sweep_fill(sweep *sweep, int image_sheet, int light_sheet); /* steps 6 to 11, and 17 for the slab before light_sheet */
void hl_sweep_shade(sweep *sweep, int sheet);                      /* steps 12 to 16 for the slab before sheet */
void hl_sweep_soften(sweep *sweep, int sheet);                     /* section 5 */

#endif
