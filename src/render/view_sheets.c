/* render/view_sheets.c - what one view, the eye's or a light's, sees of the last sheets: where, in what order, and the
 * densities of patches, filled when they are asked for and kept for the next slab. */
#include "core/memory.h"
#include "render/sweep.h"
#include "splat/voxel_sort.h"

enum { ENTRY_FLOATS = 2 * TILE_PIXELS };

/* Rays against the boxes that cut something visible: where they enter and leave is found when it is asked for. */
static hl_status set_up_entries(const sweep *sweep, const view *view, view_sheets *sheets, hl_error *error) {
  const sheet_stack *stack = &sweep->geometry->sheets;
  size_t patches = sheets->occupancy.patch_count;
  bool any = false;
  for (int g = 0; g < sweep->volume_count; g++) any = any || sweep->grids[g].cut;
  if (!any) return HL_OK;
  sheets->entries = hl_reserve_take(sweep->reserve, patches * ENTRY_FLOATS, sizeof(float));
  sheets->entry_of = hl_allocate(sweep->context, patches, sizeof *sheets->entry_of);
  sheets->box_rays = hl_allocate(sweep->context, (size_t)sweep->volume_count, sizeof *sheets->box_rays);
  if (sheets->entries == NULL || sheets->entry_of == NULL || sheets->box_rays == NULL)
    return hl_fail_memory(error, patches * ENTRY_FLOATS * sizeof(float), "the rays' entries");
  for (size_t i = 0; i < patches; i++) sheets->entry_of[i] = NO_ENTRY;
  for (int g = 0; g < sweep->volume_count; g++) {
    const grid *grid = &sweep->grids[g];
    hl_box_rays(view, stack->normal, stack->first, grid->frame_to_index, grid->box_low, grid->box_high, &sheets->box_rays[g]);
  }
  return HL_OK;
}

/* Entries of a patch, which one task has at a time; they fill as much memory as patches need them. */
static const float *entries_of(const sweep *sweep, view_sheets *sheets, size_t tile, size_t patch) {
  uint32_t *entry = &sheets->entry_of[patch];
  if (*entry != NO_ENTRY) return sheets->entries + *entry * (size_t)ENTRY_FLOATS;
  *entry = __atomic_fetch_add(&sheets->entry_count, 1, __ATOMIC_RELAXED);
  float *enter = sheets->entries + *entry * (size_t)ENTRY_FLOATS;
  size_t tiles_x = (size_t)sheets->occupancy.tiles_x;
  sweep->hot->coverage_tile(&sheets->box_rays[sheets->occupancy.patch_grid[patch]], (int)(tile % tiles_x), (int)(tile / tiles_x),
                            enter, enter + TILE_PIXELS);
  return enter;
}

static hl_status sort_voxels(const sweep *sweep, const view *view, view_sheets *sheets, hl_error *error) {
  if (!sweep->splat) return HL_OK;
  sheets->lists = hl_allocate_zeroed(sweep->context, (size_t)sweep->volume_count, sizeof *sheets->lists);
  if (sheets->lists == NULL) return hl_fail_memory(error, sizeof *sheets->lists, "the sorted voxels");
  hl_status status = HL_OK;
  for (int g = 0; g < sweep->volume_count && status == HL_OK; g++)
    status = hl_voxel_lists_build(sweep->context, sweep->pool, &sweep->grids[g], sweep->kernel, view,
                                  &sweep->geometry->sheets, &sheets->lists[g], error);
  return status;
}

/* Sheets are filled a few in one go, tile by tile, while their voxels are at hand: as many as a run has slabs, fewer where they
 * would take more memory than this. */
enum { BUNDLE_BYTES = 1 << 24, LARGE_BUNDLE = RUN_SLABS, SMALL_BUNDLE = 2 };
_Static_assert(RUN_SLABS % SMALL_BUNDLE == 0, "a bundle lies within a run");

static int bundle_of_patches(size_t patches) {
  return patches * (LARGE_BUNDLE + 1) * TILE_PIXELS * sizeof(float) <= BUNDLE_BYTES ? LARGE_BUNDLE : SMALL_BUNDLE;
}

static hl_status keep_patches(const sweep *sweep, view_sheets *sheets, hl_error *error) {
  sheets->bundle = bundle_of_patches(sheets->occupancy.patch_count);
  sheets->ring = sheets->bundle + 1;
  size_t count = sheets->occupancy.patch_count * (size_t)sheets->ring;
  sheets->density = hl_reserve_take(sweep->reserve, count * TILE_PIXELS, sizeof(float));
  sheets->kept = hl_allocate(sweep->context, count, sizeof *sheets->kept);
  sheets->sources = hl_allocate(sweep->context, (size_t)sheets->ring * (size_t)sweep->volume_count, sizeof *sheets->sources);
  sheets->runs = hl_allocate(sweep->context, (size_t)sweep->volume_count, sizeof *sheets->runs);
  sheets->relevant = hl_allocate(sweep->context, sheets->occupancy.patch_count, sizeof *sheets->relevant);
  if (sheets->density == NULL || sheets->kept == NULL || sheets->sources == NULL || sheets->runs == NULL || sheets->relevant == NULL)
    return hl_fail_memory(error, count * TILE_PIXELS * sizeof(float), "the last sheets");
  for (size_t i = 0; i < count; i++) sheets->kept[i] = (kept_patch){.sheet = -1};
  for (size_t i = 0; i < sheets->occupancy.patch_count; i++) sheets->relevant[i] = (relevant_patch){.first = -1};
  return HL_OK;
}

uint64_t hl_view_sheets_bytes(const sweep *sweep, const view *view, double spare) {
  size_t patches;
  bool cut = false;
  for (int g = 0; g < sweep->volume_count; g++) cut = cut || sweep->grids[g].cut;
  uint64_t bytes = hl_occupancy_bytes(sweep->grids, sweep->volume_count, view, &sweep->geometry->sheets, spare, &patches);
  size_t ring = (size_t)bundle_of_patches(patches) + 1;
  uint64_t a_patch = ring * (TILE_PIXELS * sizeof(float) + sizeof(kept_patch)) + sizeof(relevant_patch) + (cut ? ENTRY_FLOATS * sizeof(float) + sizeof(uint32_t) : 0);
  return bytes + patches * a_patch;
}

/* The sheet before the run of slabs that has the slab before a sheet. */
static int first_of_run(int sheet) { return (sheet - 1) / RUN_SLABS * RUN_SLABS; }

/* Box faces cut the eye's part of a slab and the way of light to it, which comes from beside. */
static void reach_run(const sweep *sweep, const view *view, int first, view_sheets *sheets) {
  double beside = sheets == &sweep->image ? sweep->longest_way : 0;
  for (int g = 0; g < sweep->volume_count; g++) {
    const grid *grid = &sweep->grids[g];
    slab_run *run = &sheets->runs[g];
    run->grid = grid;
    for (int axis = 0; axis < 3; axis++) {
      double reach = beside * vec3_length(grid->frame_to_index.linear.row[axis]);
      run->low[axis] = (float)(grid->box_low[axis] + reach);
      run->high[axis] = (float)(grid->box_high[axis] - reach);
    }
    for (int i = 0; i <= RUN_SLABS; i++)
      hl_view_sheet_rays(view, sweep->geometry->sheets.normal, hl_sheet_height(&sweep->geometry->sheets, first + i),
                         grid->frame_to_index, &run->rays[i]);
  }
}

static void reach_sheet(const sweep *sweep, const view *view, int sheet, view_sheets *sheets) {
  for (int g = 0; g < sweep->volume_count; g++) {
    fill_source *source = &sheets->sources[sheet % sheets->ring * sweep->volume_count + g];
    *source = (fill_source){.grid = &sweep->grids[g], .kernel = sweep->kernel, .sheet = sheet,
                            .classifier = &sweep->volumes[g].classifier,
                            .lists = sheets->lists == NULL ? NULL : &sheets->lists[g]};
    hl_view_sheet_rays(view, sweep->geometry->sheets.normal, hl_sheet_height(&sweep->geometry->sheets, sheet),
                       sweep->grids[g].frame_to_index, &source->rays);
  }
}

/* The sheet after the last one of its bundle. */
static int end_of_bundle(const view_sheets *sheets, int sheet) {
  int end = (sheet - 1) / sheets->bundle * sheets->bundle + 1 + sheets->bundle;
  return end < sheets->occupancy.sheets ? end : sheets->occupancy.sheets;
}

void hl_view_sheets_reach(const sweep *sweep, const view *view, int sheet, view_sheets *sheets) {
  if (first_of_run(sheet) == sheet - 1) reach_run(sweep, view, sheet - 1, sheets);
  if ((sheet - 1) % sheets->bundle != 0) return;
  for (int ahead = sheet; ahead < end_of_bundle(sheets, sheet); ahead++) reach_sheet(sweep, view, ahead, sheets);
}

hl_status hl_view_sheets_begin(const sweep *sweep, const view *view, double spare, view_sheets *sheets, hl_error *error) {
  hl_status status = hl_occupancy_build(sweep->context, sweep->pool, sweep->grids, sweep->volume_count, view,
                                        &sweep->geometry->sheets, spare, sweep->hot->brick_ranges, &sheets->occupancy,
                                        error);
  if (status == HL_OK) status = sort_voxels(sweep, view, sheets, error);
  if (status == HL_OK) status = set_up_entries(sweep, view, sheets, error);
  if (status == HL_OK) status = keep_patches(sweep, sheets, error);
  if (status != HL_OK) return status;
  reach_sheet(sweep, view, 0, sheets);
  return hl_pool_cancelled(sweep->pool) ? hl_fail(error, HL_ERROR_CANCELLED, "cancelled while preparing") : HL_OK;
}

void hl_view_sheets_end(const sweep *sweep, view_sheets *sheets) {
  for (int g = 0; sheets->lists != NULL && g < sweep->volume_count; g++)
    hl_voxel_lists_release(sweep->context, &sheets->lists[g]);
  hl_reserve_return(sweep->reserve, sheets->entries);
  hl_reserve_return(sweep->reserve, sheets->density);
  void *owned[] = {sheets->lists, sheets->sources, sheets->runs, sheets->relevant, sheets->entry_of, sheets->box_rays, sheets->kept};
  for (size_t i = 0; i < sizeof owned / sizeof owned[0]; i++) hl_release(sweep->context, owned[i]);
  hl_occupancy_release(sweep->context, &sheets->occupancy);
}

/* What is kept of a patch on a sheet. */
static kept_patch *patch_on_sheet(const view_sheets *sheets, size_t patch, int sheet) {
  kept_patch *kept = &sheets->kept[patch * (size_t)sheets->ring + (size_t)(sheet % sheets->ring)];
  if (kept->sheet != sheet) *kept = (kept_patch){.sheet = sheet};
  return kept;
}

static const fill_source *source_on_sheet(const sweep *sweep, const view_sheets *sheets, size_t patch, int sheet) {
  return &sheets->sources[sheet % sheets->ring * sweep->volume_count + (int)sheets->occupancy.patch_grid[patch]];
}

/* Where the slabs of a sheet's run may hold something of a patch in the needed blocks, found for all of them at once. Soft
 * light may ask for more blocks later. */
static const relevant_blocks *relevant_in_run(const sweep *sweep, const view_sheets *sheets, size_t tile, size_t patch, int sheet,
                                              uint32_t need) {
  const occupancy *o = &sheets->occupancy;
  relevant_patch *relevant = &sheets->relevant[patch];
  int first = first_of_run(sheet);
  if (relevant->first != first) *relevant = (relevant_patch){.first = first};
  uint32_t more = need & ~(uint32_t)relevant->asked, slabs = 0;
  if (more == 0) return &relevant->found;
  for (int i = 0; i < RUN_SLABS && first + i + 1 < o->sheets; i++)
    slabs |= (uint32_t)(hl_occupancy_has(o, patch, first + i) | hl_occupancy_has(o, patch, first + i + 1)) << i;
  relevant_blocks found = {0};
  sweep->hot->relevant_blocks_tile(&sheets->runs[o->patch_grid[patch]], (int)(tile % (size_t)o->tiles_x),
                                   (int)(tile / (size_t)o->tiles_x), slabs, more, &found);
  for (int i = 0; i < RUN_SLABS; i++) relevant->found.blocks[i] |= found.blocks[i];
  relevant->found.whole = found.whole;
  relevant->asked = (uint16_t)(relevant->asked | more);
  return &relevant->found;
}

static float *density_on_sheet(const view_sheets *sheets, size_t patch, int sheet) {
  return sheets->density + (patch * (size_t)sheets->ring + (size_t)(sheet % sheets->ring)) * TILE_PIXELS;
}

/* Fills what is missing of the wanted blocks; returns the pixels filled. */
static uint64_t fill_patch(const sweep *sweep, const view_sheets *sheets, size_t tile, size_t patch, int sheet, uint32_t wanted) {
  const occupancy *o = &sheets->occupancy;
  kept_patch *kept = patch_on_sheet(sheets, patch, sheet);
  uint32_t missing = wanted & ~(uint32_t)kept->need;
  if (missing == 0) return 0;
  const fill_source *source = source_on_sheet(sweep, sheets, patch, sheet);
  fill_tile_function *fill = sweep->splat ? sweep->hot->splat_tile : sweep->hot->gather_tile;
  uint32_t filled = fill(source, (int)(tile % (size_t)o->tiles_x), (int)(tile / (size_t)o->tiles_x), missing,
                         density_on_sheet(sheets, patch, sheet));
  kept->need = (uint16_t)(kept->need | missing);
  kept->blocks = (uint16_t)(kept->blocks | filled);
  return (uint64_t)__builtin_popcount(missing) * BLOCK_PIXELS;
}

/* Fills a slab's sheets in its relevant blocks, and those that follow in the bundle in the blocks that may be asked for. */
static uint64_t fill_bundle(const sweep *sweep, const view_sheets *sheets, size_t tile, size_t patch, int sheet, uint32_t need) {
  relevant_patch *relevant = &sheets->relevant[patch];
  int end = end_of_bundle(sheets, sheet), first = first_of_run(sheet);
  uint32_t before = 0;
  uint64_t pixels = 0;
  if (relevant->end == end && (need & ~(uint32_t)relevant->need) == 0) return 0;
  for (int at = sheet - 1; at < end; at++) {
    uint32_t after = at + 1 < end ? need & relevant->found.blocks[at - first] : 0; /* of the slab that begins with this sheet */
    pixels += fill_patch(sweep, sheets, tile, patch, at, before | after);
    before = after;
  }
  relevant->need = (uint16_t)(need | (relevant->end == end ? relevant->need : 0));
  relevant->end = end;
  return pixels;
}

uint32_t hl_patch_relevant(const sweep *sweep, const view_sheets *sheets, size_t tile, size_t patch, int sheet, uint32_t need) {
  return need & relevant_in_run(sweep, sheets, tile, patch, sheet, need)->blocks[sheet - 1 - first_of_run(sheet)];
}

patch_slab hl_patch_slab(const sweep *sweep, view_sheets *sheets, size_t tile, size_t patch, int sheet, uint32_t need,
                         uint32_t relevant, uint64_t *pixels) {
  *pixels += fill_bundle(sweep, sheets, tile, patch, sheet, need);
  bool cut = sweep->grids[sheets->occupancy.patch_grid[patch]].cut;
  bool whole = sheets->relevant[patch].found.whole >> (sheet - 1 - first_of_run(sheet)) & 1;
  const float *enter = !cut ? NULL : whole ? sheets->entries : entries_of(sweep, sheets, tile, patch);
  uint32_t shown = (uint32_t)patch_on_sheet(sheets, patch, sheet - 1)->blocks | patch_on_sheet(sheets, patch, sheet)->blocks;
  return (patch_slab){.before = density_on_sheet(sheets, patch, sheet - 1), .current = density_on_sheet(sheets, patch, sheet),
                      .enter = enter, .leave = cut ? enter + TILE_PIXELS : NULL, .whole = whole, .blocks = relevant & shown};
}
