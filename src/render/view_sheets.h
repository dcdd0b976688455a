/* render/view_sheets.h - keeps the densities of patches on the last sheets of one view, which is the eye's or
 * a light's. Densities are filled when they are requested, and are kept for the next slab. */
#ifndef HL_RENDER_VIEW_SHEETS_H
#define HL_RENDER_VIEW_SHEETS_H

#include "core/memory.h"
#include "fill/voxel_lists.h"
#include "plan/frame_plan.h"
#include "render/hot.h"

/* Data that all views of a sweep share; borrowed. */
typedef struct sheet_content {
  hl_context *context;
  hl_pool *pool;
  hl_reserve *reserve;
  const hot_functions *hot;
  const sheet_stack *sheets;
  const frame_volume *volumes; /* [volume_count] */
  const grid *grids;           /* [volume_count], the frame's */
  int volume_count;
  const kernel *kernel;
  bool splat;  /* whether densities are splatted; if not, they are gathered */
  int stretch; /* the greatest number of slabs of a stretch */
} sheet_content;

/* A patch's densities on one sheet, kept for the next slab. */
typedef struct kept_patch {
  int32_t sheet;   /* number of the sheet; -1: none */
  uint16_t need;   /* blocks that are filled */
  uint16_t blocks; /* filled blocks with density */
} kept_patch;

/* A run of RUN_SLABS slabs in one patch, and the blocks in which the run may show something. */
typedef struct patch_run {
  int32_t first;             /* the sheet before the run; -1: there is no run yet */
  int32_t end;               /* the number that follows the last sheet of the last requested bundle */
  uint16_t asked;            /* blocks whose relevance is known */
  uint16_t filled;           /* blocks for which the bundle's densities are filled */
  relevant_blocks relevant;  /* for each slab, the blocks among `asked` in which matter may be visible */
  uint16_t shows[RUN_SLABS]; /* for each slab of the bundle: the filled blocks in which matter is visible */
} patch_run;

/* A row of consecutive slabs that all touch a patch: the first and the last slab. */
typedef struct slab_row {
  int32_t first, last;
} slab_row;

/* The heights between which a cut removes something of any ray of a patch; high <= low: nothing. */
typedef struct removed_range {
  float low, high;
} removed_range;

/* The last sheets of one view. */
typedef struct view_sheets {
  const sheet_content *content;
  const view *view;
  bool of_light; /* whether the view is a light's; if not, it is the eye's */
  double beside; /* in the eye's view: the length of the longest way of a light through a slab, frame units;
                  * in a light's view: FACE_VOXELS if the light lights surfaces, else 0 */
  occupancy occupancy;
  voxel_lists *lists; /* owned; [grids]; splat only */
  int bundle;         /* number of sheets in a bundle, which are filled one after the other; a divisor of
                       * RUN_SLABS */
  int ring;       /* number of sheets whose densities are kept: bundle + 1; sheet k has the place k % ring */
  void *memory;   /* borrowed from the reserve; holds all arrays below */
  float *density; /* [patches][ring][256], block-major */
  kept_patch *kept; /* [patches][ring]; describes the densities in `density` */
  int reached; /* number of sheets for which `sources` are kept: the sheets of a stretch and of its bundles */
  fill_source *sources; /* [reached][grids]; the source of sheet k lies in row k % reached */
  slab_run
      *runs; /* [run_count][grids]; the runs of slabs that a stretch touches; run k is in row k % run_count */
  int run_count;
  patch_run *patch_runs; /* [patches] */
  slab_row *rows; /* [patches]; the next row of slabs that touch the patch. No slab between the last requested
                   * slab and this row touches the patch */
  /* the next two arrays exist only if a box cuts visible matter; else they are null */
  uint32_t *entry_of; /* [patches]; the number of the patch's row of entries; NO_ENTRY if no row was
                       * requested */
  box_rays *box_rays; /* [grids] */
  float *entries; /* [patches][entry_floats]; rows of entries, of which entry_count are used: the heights at
                   * which rays enter a box and leave it */
  uint32_t entry_count; /* atomic */
  /* The number of floats in a row of entries. [2][256] are for the box and the cuts that keep their inside.
   * If some cuts keep their outside, there are [2][256] more for the current slab, and [2][256] for each of
   * these cuts. */
  size_t entry_floats;
  removed_range *removed_ranges; /* [patches][most_removed]; a row for each row of entries, with the ranges of
                                  * the cuts that keep their outside; null if there are none */
  size_t most_removed;           /* the greatest number of such cuts, of any grid */
  /* the next two arrays hold the cuts of all grids, one grid after the other; null if no cut counts in this
   * view */
  run_cut *cuts;
  box_rays *cut_rays;
} view_sheets;

/* content and view are borrowed until hl_view_sheets_end(), which must be called after a failure, too.
 * of_light: whether the view is a light's. In a light's view, cuts whose removed matter casts shadows do not
 * count. spare: as for hl_occupancy_build(). */
hl_status hl_view_sheets_begin(const sheet_content *content, const view *view, bool of_light, double spare,
                               view_sheets *sheets, hl_error *error);
void hl_view_sheets_end(view_sheets *sheets);
/* Counts the memory that hl_view_sheets_begin() takes. It leaves out the lists of splatted voxels, because
 * their size is known only when they are made. */
void hl_view_sheets_count(const sheet_content *content, const view *view, double spare, hl_layout *layout);

/* Sets up a cut of a grid for a view: the cut's shape in the units of the view, and the view's rays in the
 * shape's own space. */
void hl_view_cut(const view *view, const sheet_stack *stack, const grid *grid, const cut_shape *shape,
                 run_cut *cut, box_rays *rays);

/* Announces the next slab: the slab that ends at a sheet. Call it for each slab in rising order, before any
 * patch of the slab is requested. sheet: from 1 on. */
void hl_view_sheets_reach(view_sheets *sheets, int sheet);

/* A patch of a tile, in the slab that ends at a sheet. */
typedef struct slab_place {
  size_t tile, patch;
  int sheet;
} slab_place;

bool hl_patch_reaches(view_sheets *sheets, size_t patch, int slab);
/* Returns whether a slab touches a patch. Ask for the slabs in rising order. The test saves time if many
 * volumes share a tile, because most of these volumes lie before or behind a slab. */
static inline bool hl_patch_is_touched(view_sheets *sheets, size_t patch, int slab) {
  const slab_row *row = &sheets->rows[patch];
  return slab >= row->first && (slab <= row->last || hl_patch_reaches(sheets, patch, slab));
}

/* The needed blocks of a patch in which a slab may show something. The slab must touch the patch.
 * hl_patch_slab() may then find fewer blocks. */
uint32_t hl_patch_relevant(const view_sheets *sheets, slab_place place, uint32_t need);

/* A patch's densities on a slab's two sheets. */
typedef struct patch_slab {
  const float *before, *current; /* [256] block-major; valid in blocks */
  const float *enter, *leave;    /* [256], block-major; the heights at which rays enter and leave the box;
                                  * null if the box cuts nothing visible; not set where `uncut` is set */
  int uncut; /* whether the box cuts nothing in this slab, and cuts none of the light's ways through the box
              * to the eye's pixels in this slab */
  const slab_run *run; /* run: the run to which the slab belongs; slab: the slab's number in the run */
  int slab;
  uint32_t blocks; /* the blocks in which some density may be visible */
} patch_slab;
/* Gives the densities of a patch. Call it after hl_patch_relevant() has found at least one block. need: all
 * blocks that this slab and the next slabs of the bundle may request. *pixels is raised by the number of
 * filled pixels. */
patch_slab hl_patch_slab(view_sheets *sheets, slab_place place, uint32_t need, uint64_t *pixels);

#endif
