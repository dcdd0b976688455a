/* render/view_sheets.c - see view_sheets.h. */
#include "render/view_sheets.h"

#include <math.h>

#include "core/memory.h"
#include "core/sheet_constants.h"

enum { INTERVAL_FLOATS = 2 * TILE_PIXELS };

#define NO_ENTRY UINT32_MAX

/* Returns whether the box of some volume cuts visible matter. If so, the places where rays enter and leave
 * boxes are needed. */
static bool any_cut(const sheet_content *content) {
  bool any = false;
  for (int g = 0; g < content->volume_count; g++) any = any || content->grids[g].cut;
  return any;
}

/* ---- cuts ---- */

/* The number of a grid's cuts that count in a view. */
static size_t cuts_of(const view_sheets *sheets, int grid) {
  const struct grid *of = &sheets->content->grids[grid];
  return sheets->of_light && of->cut_casts_shadow ? 0 : of->cut_count;
}

/* The number of the cuts that count, of all grids before this grid. For grid = volume_count: of all grids. */
static size_t cuts_before(const view_sheets *sheets, int grid) {
  size_t count = 0;
  for (int g = 0; g < grid; g++) count += cuts_of(sheets, g);
  return count;
}

/* The number of a grid's cuts that keep their outside. */
static size_t removed_of(const view_sheets *sheets, int grid) {
  size_t count = 0;
  for (size_t i = 0; i < cuts_of(sheets, grid); i++)
    count += !sheets->content->grids[grid].cuts[i].keep_inside;
  return count;
}

/* The greatest of these numbers, of any grid. */
static size_t most_removed(const view_sheets *sheets) {
  size_t most = 0;
  for (int g = 0; g < sheets->content->volume_count; g++) {
    size_t here = removed_of(sheets, g);
    most = here > most ? here : most;
  }
  return most;
}

void hl_view_cut(const view *view, const sheet_stack *stack, const grid *grid, const cut_shape *shape,
                 run_cut *cut, box_rays *rays) {
  /* the inside of a plane's shape counts as a box; its other faces are very far away */
  const double edge = 1e15, plane_low[3] = {0, -edge, -edge}, plane_high[3] = {edge, edge, edge};
  const double box_low[3] = {-1, -1, -1}, box_high[3] = {1, 1, 1};
  bool plane = shape->type == HL_CUT_PLANE;
  affine3 from_frame = affine3_multiply(shape->to_shape, grid->frame_to_index);
  hl_box_rays(view, stack->normal, stack->first, from_frame, plane ? plane_low : box_low,
              plane ? plane_high : box_high, rays);
  rays->sphere = shape->type == HL_CUT_SPHERE;
  cut->shape = shape;
  affine3_store(cut->rows, &shape->to_shape);
  for (int r = 0; r < 3; r++) cut->size[r] = (float)vec3_length(from_frame.linear.row[r]);
}

static void set_up_cuts(view_sheets *sheets) {
  size_t at = 0;
  for (int g = 0; g < sheets->content->volume_count && sheets->cuts != NULL; g++) {
    const grid *grid = &sheets->content->grids[g];
    for (size_t i = 0; i < cuts_of(sheets, g); i++, at++)
      hl_view_cut(sheets->view, sheets->content->sheets, grid, &grid->cuts[i], &sheets->cuts[at],
                  &sheets->cut_rays[at]);
  }
}

/* The heights between which a cut removes something of any ray of a patch. The inner loop compares one pixel
 * of each block, without branches, so that the compiler makes vectors of it. */
static removed_range range_of(const float *from, const float *to) {
  float low[BLOCK_PIXELS], high[BLOCK_PIXELS];
  for (int p = 0; p < BLOCK_PIXELS; p++) {
    low[p] = INFINITY;
    high[p] = -INFINITY;
  }
  for (int at = 0; at < TILE_PIXELS; at += BLOCK_PIXELS)
    for (int p = 0; p < BLOCK_PIXELS; p++) {
      float begin = from[at + p], end = to[at + p];
      int lower = (begin < end) & (begin < low[p]), higher = (begin < end) & (end > high[p]);
      low[p] = lower ? begin : low[p];
      high[p] = higher ? end : high[p];
    }
  removed_range range = {low[0], high[0]};
  for (int p = 1; p < BLOCK_PIXELS; p++) {
    range.low = low[p] < range.low ? low[p] : range.low;
    range.high = high[p] > range.high ? high[p] : range.high;
  }
  return range;
}

/* Fills the part of a row of entries that belongs to cuts: shortens the ray's sections in the box to the
 * insides that cuts keep, and stores the sections that cuts remove, and their ranges. */
static void enter_cuts(const view_sheets *sheets, slab_place place, float *enter) {
  int grid = (int)sheets->occupancy.patch_grid[place.patch];
  size_t tiles_x = (size_t)sheets->occupancy.tiles_x, first = cuts_before(sheets, grid);
  int x = (int)(place.tile % tiles_x), y = (int)(place.tile / tiles_x);
  float *leave = enter + TILE_PIXELS, *removed = enter + (ptrdiff_t)2 * INTERVAL_FLOATS;
  removed_range *range = sheets->removed_ranges + sheets->entry_of[place.patch] * sheets->most_removed;
  for (size_t i = first; i < first + cuts_of(sheets, grid); i++) {
    if (!sheets->cuts[i].shape->keep_inside) {
      sheets->content->hot->view->coverage(&sheets->cut_rays[i], x, y, removed, removed + TILE_PIXELS);
      *range++ = range_of(removed, removed + TILE_PIXELS);
      removed += INTERVAL_FLOATS;
      continue;
    }
    float kept[INTERVAL_FLOATS];
    sheets->content->hot->view->coverage(&sheets->cut_rays[i], x, y, kept, kept + TILE_PIXELS);
    for (int p = 0; p < TILE_PIXELS; p++) {
      enter[p] = kept[p] > enter[p] ? kept[p] : enter[p];
      leave[p] = kept[TILE_PIXELS + p] < leave[p] ? kept[TILE_PIXELS + p] : leave[p];
    }
  }
}

/* The row of a patch's entries, which say where the patch's rays enter and leave the box. Only one task at a
 * time uses a patch. Rows are handed out in order, so that memory beyond the rows that were requested is
 * never touched. */
static float *entries_of(view_sheets *sheets, slab_place place) {
  uint32_t *entry = &sheets->entry_of[place.patch];
  if (*entry != NO_ENTRY) return sheets->entries + *entry * sheets->entry_floats;
  *entry = __atomic_fetch_add(&sheets->entry_count, 1, __ATOMIC_RELAXED);
  float *enter = sheets->entries + *entry * sheets->entry_floats;
  size_t tiles_x = (size_t)sheets->occupancy.tiles_x;
  sheets->content->hot->view->coverage(&sheets->box_rays[sheets->occupancy.patch_grid[place.patch]],
                                       (int)(place.tile % tiles_x), (int)(place.tile / tiles_x), enter,
                                       enter + TILE_PIXELS);
  if (sheets->cuts != NULL) enter_cuts(sheets, place, enter);
  return enter;
}

/* Subtracts sections that a cut removes from the sections of rays in a slab, for the pixels of a block. The
 * result is one section for each ray: if a cut removes the middle of the slab, the second part is moved so
 * that it follows the first. Sections that are empty stay as they are. from, to: where the removed sections
 * begin and end. The loop has no branches, so that the compiler makes vectors of it. */
static void remove_sections(const float *restrict from, const float *restrict to, float *restrict enter,
                            float *restrict leave) {
  for (int p = 0; p < BLOCK_PIXELS; p++) {
    float begin = enter[p], end = leave[p], low = from[p], high = to[p];
    int crosses = (begin < end) & (low < high) & (high > begin) & (low < end);
    int first = low > begin,
        last = high < end; /* whether the ray's first part stays; whether its last does */
    float kept = first ? low : begin;
    float moved = last ? (first ? end - (high - low) : end) : kept;
    enter[p] = (crosses & !first & last) ? high : begin;
    leave[p] = crosses ? moved : end;
  }
}

/* The places where a patch's rays enter and leave the part of a slab that no cut removes, in these blocks. A
 * ray that goes on leaves just beyond the slab's end; see BEYOND_SLAB. Null in the same cases as for
 * entries_of(). */
static const float *entries_of_slab(view_sheets *sheets, slab_place place, uint32_t blocks) {
  float *enter = entries_of(sheets, place), *here = enter + INTERVAL_FLOATS,
        *removed = here + INTERVAL_FLOATS;
  if (sheets->most_removed == 0) return enter;
  int grid = (int)sheets->occupancy.patch_grid[place.patch];
  const removed_range *ranges = sheets->removed_ranges + sheets->entry_of[place.patch] * sheets->most_removed;
  size_t count = removed_of(sheets, grid);
  if (count == 0) return enter;
  const sheet_stack *stack = sheets->content->sheets;
  /* The ends of the slab are rounded as in covered(). So rays that nothing cuts get the same sums as in a
   * slab that nothing cuts. */
  float top = (float)(place.sheet * stack->spacing), bottom = top - (float)stack->spacing,
        beyond = top * BEYOND_SLAB;
  for (uint32_t left = blocks; left != 0; left &= left - 1) {
    size_t at = (size_t)__builtin_ctz(left) * BLOCK_PIXELS;
    for (size_t p = at; p < at + BLOCK_PIXELS; p++) {
      here[p] = enter[p] > bottom ? enter[p] : bottom;
      here[TILE_PIXELS + p] = enter[TILE_PIXELS + p] < beyond ? enter[TILE_PIXELS + p] : beyond;
    }
    for (size_t i = 0; i < count; i++) {
      const float *from = removed + i * INTERVAL_FLOATS + at;
      if (ranges[i].low < beyond && ranges[i].high > bottom)
        remove_sections(from, from + TILE_PIXELS, here + at, here + TILE_PIXELS + at);
    }
  }
  return here;
}

static hl_status sort_voxels(view_sheets *sheets, hl_error *error) {
  const sheet_content *content = sheets->content;
  if (!content->splat) return HL_OK;
  sheets->lists = hl_allocate_zeroed(content->context, (size_t)content->volume_count, sizeof *sheets->lists);
  if (sheets->lists == NULL) return hl_fail_memory(error, sizeof *sheets->lists, "the sorted voxels");
  hl_status status = HL_OK;
  for (int g = 0; g < content->volume_count && status == HL_OK; g++) {
    const voxel_sort sort = {&content->grids[g], content->kernel, sheets->view, content->sheets};
    status = hl_voxel_lists_build(content->context, content->pool, &sort, &sheets->lists[g], error);
  }
  return status;
}

/* Several sheets of a tile are filled one after the other, while the tile's voxels are in the cache. Such a
 * bundle has one sheet for each slab of a run; or two sheets, where the sheets of a run would take more than
 * BUNDLE_BYTES. */
enum { BUNDLE_BYTES = 1 << 24, LARGE_BUNDLE = RUN_SLABS, SMALL_BUNDLE = 2 };
_Static_assert(RUN_SLABS % SMALL_BUNDLE == 0, "a bundle lies within a run");

static int bundle_of_patches(size_t patches) {
  return patches * (LARGE_BUNDLE + 1) * TILE_PIXELS * sizeof(float) <= BUNDLE_BYTES ? LARGE_BUNDLE
                                                                                    : SMALL_BUNDLE;
}

/* Lays out the arrays, after the patches have been counted. The entries lie at the end of the block, because
 * memory of entries that no patch requests is never touched. */
static void lay_out(view_sheets *sheets, hl_layout *layout) {
  size_t patches = sheets->occupancy.patch_count, grids = (size_t)sheets->content->volume_count;
  sheets->bundle = bundle_of_patches(patches);
  sheets->ring = sheets->bundle + 1;
  sheets->reached = sheets->content->stretch + 2 * sheets->bundle;
  sheets->run_count = sheets->content->stretch / RUN_SLABS + 2;
  size_t ring = (size_t)sheets->ring;
  sheets->kept = hl_layout_take(layout, patches * ring, sizeof *sheets->kept);
  sheets->sources = hl_layout_take(layout, (size_t)sheets->reached * grids, sizeof *sheets->sources);
  sheets->runs = hl_layout_take(layout, (size_t)sheets->run_count * grids, sizeof *sheets->runs);
  sheets->patch_runs = hl_layout_take(layout, patches, sizeof *sheets->patch_runs);
  sheets->rows = hl_layout_take(layout, patches, sizeof *sheets->rows);
  sheets->density = hl_layout_take(layout, patches * ring, TILE_PIXELS * sizeof *sheets->density);
  if (!any_cut(sheets->content)) return;
  sheets->entry_of = hl_layout_take(layout, patches, sizeof *sheets->entry_of);
  sheets->box_rays = hl_layout_take(layout, grids, sizeof *sheets->box_rays);
  size_t cuts = cuts_before(sheets, sheets->content->volume_count), removed = most_removed(sheets);
  sheets->most_removed = removed;
  if (cuts > 0) sheets->cuts = hl_layout_take(layout, cuts, sizeof *sheets->cuts);
  if (cuts > 0) sheets->cut_rays = hl_layout_take(layout, cuts, sizeof *sheets->cut_rays);
  sheets->entry_floats = (removed == 0 ? 1 : 2 + removed) * INTERVAL_FLOATS;
  if (removed > 0)
    sheets->removed_ranges = hl_layout_take(layout, patches, removed * sizeof *sheets->removed_ranges);
  sheets->entries = hl_layout_take(layout, patches, sheets->entry_floats * sizeof *sheets->entries);
}

void hl_view_sheets_count(const sheet_content *content, const view *view, double spare, hl_layout *layout) {
  view_sheets planned = {.content = content, .view = view};
  const occupancy_source source = {content->grids, content->volume_count, view, content->sheets, spare};
  hl_occupancy_count(&source, &planned.occupancy, layout);
  lay_out(&planned, layout);
}

static hl_status keep_patches(view_sheets *sheets, hl_error *error) {
  hl_layout counted = {0};
  lay_out(sheets, &counted);
  sheets->memory = hl_reserve_take(sheets->content->reserve, counted.bytes, 1);
  if (sheets->memory == NULL) return hl_fail_memory(error, counted.bytes, "the last sheets");
  hl_layout handed = {.base = sheets->memory};
  lay_out(sheets, &handed);
  size_t patches = sheets->occupancy.patch_count, kept = patches * (size_t)sheets->ring;
  for (size_t i = 0; i < kept; i++) sheets->kept[i] = (kept_patch){.sheet = -1};
  for (size_t i = 0; i < patches; i++) sheets->patch_runs[i] = (patch_run){.first = -1};
  for (size_t i = 0; i < patches; i++) sheets->rows[i] = (slab_row){1, 0};
  for (size_t i = 0; i < patches && sheets->entry_of != NULL; i++) sheets->entry_of[i] = NO_ENTRY;
  for (int g = 0; g < sheets->content->volume_count && sheets->box_rays != NULL; g++) {
    const grid *grid = &sheets->content->grids[g];
    const sheet_stack *stack = sheets->content->sheets;
    hl_box_rays(sheets->view, stack->normal, stack->first, grid->frame_to_index, grid->box_low,
                grid->box_high, &sheets->box_rays[g]);
  }
  set_up_cuts(sheets);
  return HL_OK;
}

/* The sheet at which a run begins: the run that holds the slab before `sheet`. Runs are RUN_SLABS slabs
 * long. */
static int first_of_run(int sheet) { return (sheet - 1) / RUN_SLABS * RUN_SLABS; }

static slab_run *run_of_grid(const view_sheets *sheets, int first, int grid) {
  int run = first / RUN_SLABS % sheets->run_count;
  return &sheets->runs[run * sheets->content->volume_count + grid];
}

/* Returns whether a grid touches a slab that begins or ends at one of the sheets from `first` to `last`. */
static bool reaches_sheets(const view_sheets *sheets, int grid, int first, int last) {
  const sheet_range *range = &sheets->occupancy.sheets_of[grid];
  return last >= range->first - 1 && first <= range->last + 1;
}

/* Finds the slabs of a run that a box cuts. A face of the box may cross the slab. Or it may cross the way of
 * light to a sample in the slab; such a way begins at a distance of up to `beside` from the slab. */
static void reach_run(view_sheets *sheets, int first) {
  const sheet_content *content = sheets->content;
  for (int g = 0; g < content->volume_count; g++) {
    if (!reaches_sheets(sheets, g, first, first + RUN_SLABS)) continue;
    const grid *grid = &content->grids[g];
    slab_run *run = run_of_grid(sheets, first, g);
    run->grid = grid;
    run->cuts = sheets->cuts == NULL ? NULL : sheets->cuts + cuts_before(sheets, g);
    run->cut_count = sheets->cuts == NULL ? 0 : (int)cuts_of(sheets, g);
    run->beside = (float)sheets->beside;
    const double voxel = hl_smallest_edge(grid);
    run->voxel = (float)voxel;
    for (int axis = 0; axis < 3; axis++) {
      double steps = vec3_length(grid->frame_to_index.linear.row[axis]), reach = sheets->beside * steps;
      run->steps[axis] = (float)(1 / (steps * voxel));
      run->low[axis] = (float)(grid->box_low[axis] + reach);
      run->high[axis] = (float)(grid->box_high[axis] - reach);
    }
    for (int i = 0; i <= RUN_SLABS; i++)
      hl_view_sheet_rays(sheets->view, content->sheets->normal, hl_sheet_height(content->sheets, first + i),
                         grid->frame_to_index, &run->rays[i]);
  }
}

/* Makes the sources of a sheet. Their rays are the rays of the run that holds the slab before the sheet.
 * reach_run() must have been called for this run. */
static void reach_sheet(view_sheets *sheets, int sheet) {
  const sheet_content *content = sheets->content;
  const int run = sheet == 0 ? 0 : first_of_run(sheet);
  for (int g = 0; g < content->volume_count; g++) {
    if (!reaches_sheets(sheets, g, sheet, sheet)) continue;
    fill_source *source = &sheets->sources[sheet % sheets->reached * content->volume_count + g];
    *source = (fill_source){.grid = &content->grids[g],
                            .kernel = content->kernel,
                            .sheet = sheet,
                            .classifier = content->volumes[g].classifier,
                            .lists = sheets->lists == NULL ? NULL : &sheets->lists[g]};
    source->rays = run_of_grid(sheets, run, g)->rays[sheet - run];
  }
}

/* One past the last sheet of the bundle to which a sheet belongs. */
static int end_of_bundle(const view_sheets *sheets, int sheet) {
  int end = (sheet - 1) / sheets->bundle * sheets->bundle + 1 + sheets->bundle;
  return end < sheets->occupancy.sheets ? end : sheets->occupancy.sheets;
}

void hl_view_sheets_reach(view_sheets *sheets, int sheet) {
  if (first_of_run(sheet) == sheet - 1) reach_run(sheets, sheet - 1);
  if (sheet == 1) reach_sheet(sheets, 0);
  if ((sheet - 1) % sheets->bundle != 0) return;
  for (int ahead = sheet; ahead < end_of_bundle(sheets, sheet); ahead++) reach_sheet(sheets, ahead);
}

hl_status hl_view_sheets_begin(const sheet_content *content, const view *view, bool of_light, double spare,
                               view_sheets *sheets, hl_error *error) {
  const occupancy_source source = {content->grids, content->volume_count, view, content->sheets, spare};
  *sheets = (view_sheets){.content = content, .view = view, .of_light = of_light};
  hl_status status = hl_occupancy_build(content->context, content->pool, content->hot->view->brick_ranges,
                                        &source, &sheets->occupancy, error);
  if (status == HL_OK) status = sort_voxels(sheets, error);
  if (status == HL_OK) status = keep_patches(sheets, error);
  if (status != HL_OK) return status;
  return hl_pool_check(content->pool, "preparing", error);
}

void hl_view_sheets_end(view_sheets *sheets) {
  const sheet_content *content = sheets->content;
  if (content == NULL) return;
  for (int g = 0; sheets->lists != NULL && g < content->volume_count; g++)
    hl_voxel_lists_release(content->context, &sheets->lists[g]);
  hl_release(content->context, sheets->lists);
  if (sheets->memory != NULL) hl_reserve_return(content->reserve, sheets->memory);
  hl_occupancy_release(content->context, &sheets->occupancy);
}

/* Returns the densities that are kept for a patch on a sheet. If their place in the ring holds densities of
 * another sheet, these are dropped. */
static kept_patch *patch_on_sheet(const view_sheets *sheets, size_t patch, int sheet) {
  kept_patch *kept = &sheets->kept[patch * (size_t)sheets->ring + (size_t)(sheet % sheets->ring)];
  if (kept->sheet != sheet) *kept = (kept_patch){.sheet = sheet};
  return kept;
}

static const fill_source *source_on_sheet(const view_sheets *sheets, size_t patch, int sheet) {
  return &sheets->sources[sheet % sheets->reached * sheets->content->volume_count +
                          (int)sheets->occupancy.patch_grid[patch]];
}

/* Finds which of the needed blocks of a patch are relevant, for all slabs of a run at once. With soft
 * shadows, a later slab may need more blocks. */
static void find_relevant(const view_sheets *sheets, slab_place place, uint32_t need, patch_run *run) {
  size_t patch = place.patch;
  const occupancy *o = &sheets->occupancy;
  uint32_t more = need & ~(uint32_t)run->asked, slabs = 0;
  if (more == 0) return;
  for (int i = 0; i < RUN_SLABS && run->first + i + 1 < o->sheets; i++)
    slabs |= (uint32_t)(hl_occupancy_has(o, patch, run->first + i) |
                        hl_occupancy_has(o, patch, run->first + i + 1))
             << i;
  relevant_blocks relevant = {0};
  sheets->content->hot->fill->relevant_blocks(run_of_grid(sheets, run->first, (int)o->patch_grid[patch]),
                                              (int)(place.tile % (size_t)o->tiles_x),
                                              (int)(place.tile / (size_t)o->tiles_x), slabs, more, &relevant);
  for (int i = 0; i < RUN_SLABS; i++) run->relevant.blocks[i] |= relevant.blocks[i];
  run->relevant.uncut = relevant.uncut;
  run->asked = (uint16_t)(run->asked | more);
}

static float *density_on_sheet(const view_sheets *sheets, size_t patch, int sheet) {
  return sheets->density + (patch * (size_t)sheets->ring + (size_t)(sheet % sheets->ring)) * TILE_PIXELS;
}

/* A patch while its densities are filled on the sheets of a bundle. Functions number these sheets by i; the
 * sheet before the bundle has the number 0. */
typedef struct patch_bundle {
  const view_sheets *sheets;
  size_t tile, patch;
  int first, slabs;             /* first: the sheet before the bundle; slabs: number of slabs of the bundle */
  uint32_t relevant[RUN_SLABS]; /* blocks where each slab may show something */
  uint64_t pixels;              /* number of filled pixels */
} patch_bundle;

/* The blocks of sheet number i of the bundle that are filled and show something. */
static uint32_t visible_on(const patch_bundle *b, int i) {
  return i < 0 || i > b->slabs ? 0 : patch_on_sheet(b->sheets, b->patch, b->first + i)->blocks;
}

/* Relevant blocks of a bundle. relevant_in_slab(): the relevant blocks of a slab. relevant_beside(): the
 * relevant blocks of the two slabs beside a sheet. beside_visible(): the blocks of relevant_beside() in which
 * the slab's other sheet shows something. */
static uint32_t relevant_in_slab(const patch_bundle *b, int slab) {
  return slab < 0 || slab >= b->slabs ? 0 : b->relevant[slab];
}
static uint32_t relevant_beside(const patch_bundle *b, int i) {
  return relevant_in_slab(b, i - 1) | relevant_in_slab(b, i);
}
static uint32_t beside_visible(const patch_bundle *b, int i) {
  return (relevant_in_slab(b, i - 1) & visible_on(b, i - 1)) |
         (relevant_in_slab(b, i) & visible_on(b, i + 1));
}

/* Fills the blocks of a sheet that are not filled yet: all blocks in `wanted`, and the other blocks in which
 * the sheet's own cells may show something. */
static void fill_sheet(patch_bundle *b, int i, uint32_t wanted, uint32_t others) {
  const occupancy *o = &b->sheets->occupancy;
  kept_patch *kept = patch_on_sheet(b->sheets, b->patch, b->first + i);
  wanted &= ~(uint32_t)kept->need;
  others &= ~(wanted | kept->need);
  if ((wanted | others) == 0) return;
  const sheet_content *content = b->sheets->content;
  fill_tile_function *fill = content->splat ? content->hot->fill->splat : content->hot->fill->gather;
  filled_blocks blocks = fill(source_on_sheet(b->sheets, b->patch, b->first + i),
                              (int)(b->tile % (size_t)o->tiles_x), (int)(b->tile / (size_t)o->tiles_x),
                              wanted, others, density_on_sheet(b->sheets, b->patch, b->first + i));
  kept->need = (uint16_t)(kept->need | blocks.filled);
  kept->blocks = (uint16_t)(kept->blocks | blocks.showing);
  b->pixels += hl_pixels_of_blocks(blocks.filled);
}

/* A slab shows something where one of its two sheets shows something; there both sheets are needed. First the
 * odd sheets are filled where their cells may show something. Then the even sheets are filled where a
 * neighbouring odd sheet shows something, or where their own cells may show something. Last the remaining
 * blocks of odd sheets are filled where a neighbouring even sheet shows something. */
static void fill_sheets(patch_bundle *b) {
  for (int i = 1; i <= b->slabs; i += 2) fill_sheet(b, i, 0, relevant_beside(b, i));
  for (int i = 0; i <= b->slabs; i += 2) fill_sheet(b, i, beside_visible(b, i), relevant_beside(b, i));
  for (int i = 1; i <= b->slabs; i += 2) fill_sheet(b, i, beside_visible(b, i), 0);
}

/* Fills the densities of a patch in the slabs of a bundle, in the blocks `more`. Returns the number of filled
 * pixels. */
static uint64_t fill_bundle(const view_sheets *sheets, slab_place place, uint32_t more, patch_run *run) {
  int slab = place.sheet - 1 - run->first;
  patch_bundle b = {.sheets = sheets,
                    .tile = place.tile,
                    .patch = place.patch,
                    .first = place.sheet - 1,
                    .slabs = run->end - place.sheet};
  for (int i = 0; i < b.slabs; i++) b.relevant[i] = more & run->relevant.blocks[slab + i];
  fill_sheets(&b);
  for (int i = 0; i < b.slabs; i++)
    run->shows[slab + i] |= (uint16_t)(b.relevant[i] & (visible_on(&b, i) | visible_on(&b, i + 1)));
  run->filled = (uint16_t)(run->filled | more);
  return b.pixels;
}

/* The last slab of a row of consecutive slabs that touch a patch. The row begins with `slab`; it ends early
 * if it goes on beyond one word of bits. A slab touches the patch if its own sheet does, or the sheet before
 * it. */
static int32_t last_of_row(const occupancy *o, size_t patch, int slab) {
  uint64_t without = ~(o->by_patch[patch * (size_t)o->words + (size_t)(slab / 64)] >> slab % 64);
  return slab + (without == 0 ? 64 : __builtin_ctzll(without));
}

bool hl_patch_reaches(view_sheets *sheets, size_t patch, int slab) {
  const occupancy *o = &sheets->occupancy;
  int32_t next = hl_occupancy_next_slab(o, patch, slab);
  sheets->rows[patch] = (slab_row){next, next < o->sheets ? last_of_row(o, patch, next) : next};
  return next == slab;
}

uint32_t hl_patch_relevant(const view_sheets *sheets, slab_place place, uint32_t need) {
  patch_run *run = &sheets->patch_runs[place.patch];
  int first = first_of_run(place.sheet), slab = place.sheet - 1 - first;
  int end = end_of_bundle(sheets, place.sheet);
  if (run->first != first) *run = (patch_run){.first = first};
  if (run->end != end) run->filled = 0;
  run->end = end;
  find_relevant(sheets, place, need, run);
  bool filled = (need & ~(uint32_t)run->filled) == 0;
  return need & (filled ? run->shows[slab] : run->relevant.blocks[slab]);
}

patch_slab hl_patch_slab(view_sheets *sheets, slab_place place, uint32_t need, uint64_t *pixels) {
  size_t patch = place.patch;
  patch_run *run = &sheets->patch_runs[patch];
  int slab = place.sheet - 1 - run->first;
  uint32_t more = need & ~(uint32_t)run->filled;
  if (more != 0) *pixels += fill_bundle(sheets, place, more, run);
  bool cut = sheets->content->grids[sheets->occupancy.patch_grid[patch]].cut;
  bool uncut = run->relevant.uncut >> slab & 1;
  uint32_t blocks = run->shows[slab] & need;
  const float *enter = !cut ? NULL : uncut ? sheets->entries : entries_of_slab(sheets, place, blocks);
  return (patch_slab){.before = density_on_sheet(sheets, patch, place.sheet - 1),
                      .current = density_on_sheet(sheets, patch, place.sheet),
                      .enter = enter,
                      .leave = cut ? enter + TILE_PIXELS : NULL,
                      .uncut = uncut,
                      .run = run_of_grid(sheets, run->first, (int)sheets->occupancy.patch_grid[patch]),
                      .slab = slab,
                      .blocks = blocks};
}
