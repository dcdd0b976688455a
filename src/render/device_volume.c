/* render/device_volume.c - see device_volume.h. */
#include "render/device_volume.h"

#include <string.h>

#include "volume/colors.h"

_Static_assert(MASK_BRICK_SHIFT == HL_MASK_BRICK_SHIFT && MASK_EVEN == HL_MASK_EVEN &&
                   MASK_EVEN_COLOR == HL_MASK_EVEN_COLOR,
               "masks of plans are masks of labels");
_Static_assert(PLAN_PLANE_COLUMNS == PLANE_COLUMNS && PLAN_PLANE_ROWS == PLANE_ROWS,
               "planes of plans are planes of grids");
_Static_assert(sizeof(plan_brick) == sizeof(hl_brick_entry) &&
                   offsetof(plan_brick, level) == offsetof(hl_brick_entry, level) &&
                   offsetof(plan_brick, value) == offsetof(hl_brick_entry, constant),
               "bricks of plans are bricks of fields");

int hl_device_storage(const grid *grid) {
  if (grid->bricks != NULL) return 2;
  return grid->storage == HL_STORAGE_U8 ? 0 : grid->storage == HL_STORAGE_U16 ? 1 : 2;
}

/* Returns the grid's bits that tell which cells are visible. Returns null if all cells count as visible; the
 * processors do not read the bits then, either. */
static const uint64_t *bits_of_cells(const grid *grid) {
  return grid->cell_bits_tell ? grid->cell_bits : NULL;
}

static void load_row(const void *pages, size_t y, size_t z, void *row) {
  hl_pages_load_row(pages, y, z, row);
}

static gpu_mask mask_for_device(const mask_lattice *lattice) {
  if (lattice->factors == NULL) return (gpu_mask){0};
  size_t points = 1, bricks = 1;
  for (int axis = 0; axis < 3; axis++) {
    points *= (size_t)lattice->last[axis] + 1;
    bricks *= (size_t)(lattice->last[axis] >> HL_MASK_BRICK_SHIFT) + 1;
  }
  return (gpu_mask){.part = {[MASK_BRICKS] = lattice->bricks,
                             [MASK_FACTORS] = lattice->factors,
                             [MASK_SLOPES] = lattice->slopes,
                             [MASK_COLORS] = lattice->colors},
                    .bytes = {[MASK_BRICKS] = bricks * sizeof *lattice->bricks,
                              [MASK_FACTORS] = points * sizeof *lattice->factors,
                              [MASK_SLOPES] = lattice->slopes == NULL ? 0 : points * HL_COLOR_BYTES,
                              [MASK_COLORS] = lattice->colors == NULL ? 0 : points * HL_COLOR_BYTES}};
}

static gpu_volume volume_for_device(const frame_plan *plan, int number) {
  const frame_volume *volume = &plan->volumes.list[number];
  const grid *grid = &plan->volumes.grids[number];
  const classifier *classifier = volume->classifier;
  gpu_volume made = {.version = volume->version,
                     .tables_version = volume->tables_version,
                     .voxels = grid->voxels,
                     .storage = hl_device_storage(grid),
                     .dimension = grid->dimension,
                     .brick_count = grid->brick_count,
                     .relevant = grid->relevant,
                     .cell_bits = bits_of_cells(grid),
                     .sums = &classifier->sums[0][0],
                     .color = &classifier->color[0][0],
                     .shown = &classifier->shown[0][0],
                     .outside = classifier->outside,
                     .bent = classifier->bent,
                     .steepness = classifier->steepness,
                     .mask = mask_for_device(&classifier->mask)};
  if (classifier->plane.sums != NULL) {
    made.plane_sums = &classifier->plane.sums[0][0];
    made.plane_color = &classifier->plane.color[0][0];
  }
  if (grid->pages != NULL) {
    made.pages = grid->pages;
    made.load_row = load_row;
  }
  if (volume->volume->colors != NULL) {
    made.colors = volume->volume->colors;
    made.color_bytes = HL_COLOR_BYTES;
    for (int axis = 0; axis < 3; axis++) made.color_bytes *= volume->volume->dimension[axis];
  }
  if (grid->bricks != NULL) {
    made.voxels = grid->bricks->pool;
    made.directory = (const plan_brick *)(const void *)grid->bricks->directory;
    made.directory_size = grid->bricks->directory_size;
    made.slots = grid->bricks->slots;
    made.brick_width = ((size_t)1 << grid->bricks->shift) + BRICK_MARGIN;
  }
  return made;
}

void hl_volumes_for_device(const frame_plan *plan, gpu_volume *volumes) {
  for (int v = 0; v < plan->volumes.count; v++) volumes[v] = volume_for_device(plan, v);
}

static void plan_mask_of(const shade_volume *shade, plan_mask *planned) {
  const mask_lattice *lattice = &shade->classifier->mask;
  const gpu_mask mask = mask_for_device(lattice);
  if (lattice->factors == NULL) return;
  memcpy(planned->last, lattice->last, sizeof planned->last);
  memcpy(planned->to_index, lattice->to_index, sizeof planned->to_index);
  planned->scale = lattice->scale;
  planned->offset = lattice->offset;
  planned->slope_scale = lattice->slope_scale;
  planned->rest = lattice->rest;
  planned->faces = shade->mask_faces;
  planned->tints = shade->tints.voxels != NULL;
  if (planned->tints) memcpy(planned->decode, shade->tints.decode, sizeof planned->decode);
  for (int part = 0; part < PLAN_MASK_PARTS; part++)
    planned->begin[part] = (unsigned)(hl_gpu_mask_begin(&mask, part) / 16);
}

static void plan_matter(const shade_volume *shade, plan_volume *volume) {
  const grid *grid = shade->grid;
  const classifier *classifier = shade->classifier;
  const kernel *kernel = shade->kernel;
  memcpy(volume->dimension, grid->dimension, sizeof volume->dimension);
  memcpy(volume->brick_count, grid->brick_count, sizeof volume->brick_count);
  volume->slice_rows = (unsigned)grid->dimension[1];
  if (grid->bricks != NULL) {
    volume->brick_shift = grid->bricks->shift;
    volume->slice_rows = (1u << grid->bricks->shift) + BRICK_MARGIN;
    for (int axis = 0; axis < 3; axis++)
      volume->directory_size[axis] = (int)grid->bricks->directory_size[axis];
  }
  volume->empty = grid->empty;
  volume->has_cell_bits = bits_of_cells(grid) != NULL;
  memcpy(volume->inner, kernel->inner, sizeof volume->inner);
  memcpy(volume->outer, kernel->outer, sizeof volume->outer);
  memcpy(volume->to_index, shade->to_index, sizeof volume->to_index);
  memcpy(volume->low, shade->low, sizeof volume->low);
  memcpy(volume->high, shade->high, sizeof volume->high);
  memcpy(volume->face_low, grid->face_low, sizeof volume->face_low);
  memcpy(volume->face_high, grid->face_high, sizeof volume->face_high);
  for (int axis = 0; axis < 3; axis++)
    volume->steps[axis] = (float)(1 / (vec3_length(grid->frame_to_index.linear.row[axis]) *
                                       hl_smallest_edge(grid)));
  volume->scale = classifier->scale;
  volume->offset = classifier->offset;
  volume->first_visible = classifier->first_visible;
  volume->last_visible = classifier->last_visible;
  volume->normal_edge = classifier->normal_edge;
  volume->bends = classifier->bent != NULL;
  volume->steepness_scale = classifier->steepness_scale;
  volume->column_scale = classifier->plane.column_scale;
  volume->column_offset = classifier->plane.column_offset;
  volume->row_scale = classifier->plane.row_scale;
  volume->row_offset = classifier->plane.row_offset;
  volume->several_surfaces = classifier->several_surfaces;
  volume->only_beginning = classifier->only_beginning;
  volume->cut_count = shade->cut_count;
  volume->light_cut_count = shade->light_cut_count;
  volume->any_face = shade->any_face ||
                     (shade->cut_count > 0 && shade->cut_shading != HL_CUT_SHADING_GRADIENT);
  volume->faces_take = shade->cut_shading == HL_CUT_SHADING_FACE &&
                       (shade->any_face || shade->light_cut_count > 0);
  volume->cut_shading = shade->cut_shading;
  for (int face = 0; face < 6; face++) volume->face_cuts[face] = shade->face_cuts[face / 2][face % 2];
}

static void plan_colors(const shade_volume *shade, plan_volume *volume) {
  if (shade->colors.voxels == NULL) return;
  memcpy(volume->color_last, shade->colors.last, sizeof volume->color_last);
  memcpy(volume->color_decode, shade->colors.decode, sizeof volume->color_decode);
}

static void plan_material(const shade_volume *shade, const frame_volume *of, plan_volume *volume) {
  volume->ambient = shade->ambient;
  volume->diffuse = shade->diffuse;
  volume->specular = shade->specular;
  volume->shininess = shade->shininess;
  volume->emission = shade->emission;
  volume->anisotropy = shade->anisotropy;
  if (shade->phase_once != NULL) volume->phase_rows = shade->phase_once->rows_per_log2;
  memcpy(volume->albedo, shade->albedo, sizeof volume->albedo);
  volume->absorbs = shade->absorbs;
  volume->receives_shadow = shade->receives_shadow;
  volume->voxel = shade->voxel;
  for (int c = 0; c < HL_CHANNELS; c++) {
    volume->cast[c] = shade->cast[c];
    volume->weight[c] = of->casts_shadow ? (float)of->look.attenuation_color[c] : 0;
  }
}

/* Sets the members that tell the volume's properties, which kernels for several volumes read. */
static void plan_properties(const shade_volume *shade, const frame_volume *of, plan_volume *volume) {
  volume->phong = shade->phong;
  volume->lit = shade->lit;
  volume->visible = shade->visible;
  volume->casts = of->casts_shadow;
  volume->boxed = shade->grid->cut;
  volume->bricks = shade->grid->bricks != NULL;
  volume->steep = shade->classifier->steepness != NULL;
  volume->masked = shade->classifier->mask.factors != NULL;
  volume->plane = shade->classifier->plane.sums != NULL;
  volume->colored = shade->colors.voxels != NULL;
}

static void plan_place(const gpu_place *place, plan_volume *volume) {
  volume->voxels_begin = (unsigned)(place->voxels / 16);
  volume->colors_begin = (unsigned)(place->colors / 16);
  volume->mask_begin = (unsigned)(place->mask / 16);
  volume->directory_begin = (unsigned)place->directory;
  volume->bricks_begin = (unsigned)place->bricks;
  volume->tables_begin = (unsigned)place->tables;
}

void hl_device_volumes_describe(const frame_plan *plan, const shade_volume *shades, plan_volume *volumes) {
  gpu_volume on_device[PLAN_VOLUMES];
  gpu_place places[PLAN_VOLUMES + 1];
  int cuts = 0;
  hl_volumes_for_device(plan, on_device);
  hl_gpu_find_places(on_device, plan->volumes.count, places);
  for (int v = 0; v < plan->volumes.count; v++) {
    plan_volume *volume = &volumes[v];
    plan_matter(&shades[v], volume);
    plan_colors(&shades[v], volume);
    plan_mask_of(&shades[v], &volume->mask);
    plan_material(&shades[v], &plan->volumes.list[v], volume);
    plan_properties(&shades[v], &plan->volumes.list[v], volume);
    plan_place(&places[v], volume);
    volume->row_bytes = (unsigned)hl_gpu_row_bytes(&on_device[v]);
    volume->first_cut = cuts;
    cuts += shades[v].cut_count;
  }
}
