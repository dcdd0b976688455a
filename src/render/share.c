/* render/share.c - cuts a picture into bands along the brightest light's lines, or into rows in turn. */
#include "render/share.h"

#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "grid/relevant.h"
#include "shadow/shadow_method.h"

/* One cell while cells are put in order. */
typedef struct share_cell {
  double key;    /* rises from band to band */
  double weight; /* how much matter lies under it */
  int32_t index;
} share_cell;

static size_t cells_of(const picture_share *share) { return (size_t)share->cells_x * (size_t)share->cells_y; }

static void lay_out(picture_share *share, share_cell **cells, hl_layout *layout) {
  share->part_of = hl_layout_take(layout, cells_of(share), sizeof *share->part_of);
  *cells = hl_layout_take(layout, cells_of(share), sizeof **cells);
}

uint64_t hl_share_bytes(int width, int height) {
  picture_share share = {.cells_x = hl_tiles(width), .cells_y = hl_tiles(height)};
  share_cell *cells;
  hl_layout counted = {0};
  lay_out(&share, &cells, &counted);
  return counted.bytes;
}

/* ---- along which lines ---- */

static double brightness(const light_source *source, vec3 middle) {
  const hl_light *light = source->light;
  double color = (light->color[0] + light->color[1] + light->color[2]) * light->intensity;
  if (light->falloff != HL_FALLOFF_INVERSE_SQUARE) return color;
  vec3 way = vec3_subtract(source->position, middle);
  return color / fmax(vec3_dot(way, way), 1e-12);
}

/* Whether parts work through a light's shadows each for itself. */
static bool is_divided(const picture_share *share, const light_source *source) {
  const shadow_method *method = hl_shadow_method(source);
  if (method == NULL) return false;
  return method->divides || (method->exchanges && share->exchange != NULL);
}

/* The brightest light whose shadows are divided; null: none is. */
static const light_source *brightest(const frame *frame, const picture_share *share) {
  const light_source *found = NULL;
  for (int i = 0; i < frame->light_count; i++) {
    const light_source *source = &frame->lights[i];
    if (!is_divided(share, source)) continue;
    if (found == NULL || brightness(source, frame->middle) > brightness(found, frame->middle)) found = source;
  }
  return found;
}

/* The light's image, homogeneous: (w, w u, w v). */
typedef struct light_image {
  double w, u, v;
} light_image;

static light_image image_of(const view *eye, const light_source *source) {
  double rows[3][4], at[3];
  if (source == NULL) return (light_image){0, 1, 0}; /* bands of rows */
  vec3 p = source->parallel ? source->direction : source->position;
  hl_view_homogeneous(eye, affine3_identity(), rows);
  for (int i = 0; i < 3; i++)
    at[i] = rows[i][0] * p.x + rows[i][1] * p.y + rows[i][2] * p.z + (source->parallel ? 0 : rows[i][3]);
  return (light_image){at[0], at[1], at[2]};
}

/* The direction of the line through a pixel and the light's image, to either side. */
static void line_through(const light_image *image, double u, double v, double way[2]) {
  way[0] = image->w * u - image->u;
  way[1] = image->w * v - image->v;
}

static double cross2(const double a[2], const double b[2]) { return a[0] * b[1] - a[1] * b[0]; }
static double dot2(const double a[2], const double b[2]) { return a[0] * b[0] + a[1] * b[1]; }

/* Rises with a direction's angle, from -1 to 3: without trigonometric functions, whose last digits differ
 * between machines. */
static double turn_of(const double way[2]) {
  double sum = fabs(way[0]) + fabs(way[1]), part = sum > 0 ? way[1] / sum : 0;
  return way[0] >= 0 ? part : 2 - part;
}

/* Sets the cells' keys. Derived: the line through p along d meets the line through the picture's middle c
 * across m, at c + t m', where t = cross(p - c, d) / cross(m', d); m is the direction of the line through c,
 * and m' = (-m_y, m_x). Where the light's image lies within the picture or near it, so that not all lines run
 * along m, the key is their angle instead. */
static void set_keys(const frame *frame, const picture_share *share, share_cell *cells) {
  const light_image image = image_of(&frame->eye, brightest(frame, share));
  const double middle[2] = {frame->width / 2.0, frame->height / 2.0};
  double m[2], way[2];
  bool along = true;
  line_through(&image, middle[0], middle[1], m);
  for (int corner = 0; corner < 4; corner++) {
    line_through(&image, corner & 1 ? frame->width : 0, corner & 2 ? frame->height : 0, way);
    along = along && dot2(m, way) > 0.1 * sqrt(dot2(m, m) * dot2(way, way));
  }
  const double across[2] = {-m[1], m[0]};
  double side = (double)TILE * share->oversampling;
  for (size_t i = 0; i < cells_of(share); i++) {
    const double p[2] = {((double)(i % (size_t)share->cells_x) + 0.5) * side,
                         ((double)(i / (size_t)share->cells_x) + 0.5) * side};
    const double off[2] = {p[0] - middle[0], p[1] - middle[1]};
    line_through(&image, p[0], p[1], way);
    cells[i] = (share_cell){.key = along ? cross2(off, way) / cross2(across, way) : turn_of(way),
                            .index = (int32_t)i};
  }
}

/* ---- how much lies under a cell ---- */

/* Of all bricks about so many are looked at. A cell weighs as much as the root of their number: where there
 * are many, most of them are hidden (measured: docs/performance.md). A cell without any weighs as much as a
 * fraction of the mean. */
enum { SHARE_BRICKS = 1 << 18 };
static const double LEAST_WEIGHT = 0.1;

static void weigh_point(const frame *frame, const picture_share *share, vec3 point, double weight,
                        share_cell *cells) {
  double uv[2], side = (double)TILE * share->oversampling;
  if (!hl_view_project(&frame->eye, point, uv)) return;
  if (!(uv[0] >= 0 && uv[1] >= 0 && uv[0] < share->cells_x * side && uv[1] < share->cells_y * side)) return;
  cells[(size_t)(uv[1] / side) * (size_t)share->cells_x + (size_t)(uv[0] / side)].weight += weight;
}

/* Adds the visible bricks of a grid; of all bricks, one in `step` is looked at. Their list would not do:
 * where voxels are in pages it has more of them, which depends on a process's memory. */
static void weigh_bricks(const frame *frame, const picture_share *share, const grid *grid, size_t step,
                         share_cell *cells) {
  size_t bricks = grid->relevant_count > 0 ? hl_grid_bricks(grid) : 0;
  for (size_t at = step / 2; at < bricks; at += step) {
    int32_t b[3];
    double centre[3], half[3];
    if (!grid->relevant[at]) continue;
    hl_brick_coordinates(grid, (uint32_t)at, b);
    hl_brick_bounds(grid, b, 0, centre, half);
    weigh_point(frame, share, affine3_apply(grid->index_to_frame, vec3_of(centre)), (double)step, cells);
  }
}

static void weigh_cells(const share_content *content, const picture_share *share, share_cell *cells) {
  size_t bricks = 0;
  double sum = 0;
  for (int g = 0; g < content->grid_count; g++) bricks += hl_grid_bricks(&content->grids[g]);
  for (int g = 0; g < content->grid_count; g++) /* an odd step does not stay in one column of bricks */
    weigh_bricks(content->frame, share, &content->grids[g], bricks / SHARE_BRICKS | 1, cells);
  for (size_t i = 0; i < cells_of(share); i++) {
    cells[i].weight = sqrt(cells[i].weight);
    sum += cells[i].weight;
  }
  double least = fmax(LEAST_WEIGHT * sum / (double)cells_of(share), 1e-9);
  for (size_t i = 0; i < cells_of(share); i++) cells[i].weight += least;
}

/* ---- bands ---- */

static int compare_cells(const void *a, const void *b) {
  const share_cell *first = a, *second = b;
  if (first->key != second->key) return first->key < second->key ? -1 : 1;
  return first->index < second->index ? -1 : 1;
}

/* Gives each cell, in their order, to the part in which the middle of its weight lies. */
static void cut_bands(picture_share *share, const share_cell *cells) {
  double sum = 0, before = 0;
  for (size_t i = 0; i < cells_of(share); i++) sum += cells[i].weight;
  for (size_t i = 0; i < cells_of(share); before += cells[i++].weight) {
    int part = (int)((before + cells[i].weight / 2) / sum * share->parts);
    share->part_of[cells[i].index] = part < share->parts ? part : share->parts - 1;
  }
}

/* Whether parts are bands. Rows of cells in turn have more equal shares of the work; but bands need less
 * light where shadows are divided, and less of the voxels where no shadows are cast, which counts where these
 * lie over ranks. Whether they lie in a scratch file must not matter: that is each process's own affair. */
static bool is_cut_in_bands(const share_content *content, const picture_share *share) {
  const frame *frame = content->frame;
  bool soft = false, pages = false;
  if (brightest(frame, share) != NULL) return true;
  for (int i = 0; i < frame->light_count; i++) soft = soft || frame->lights[i].shadows == HL_SHADOWS_SOFT;
  for (int g = 0; g < content->grid_count; g++)
    pages = pages || (content->grids[g].pages != NULL && content->grids[g].pages->version != NULL);
  return pages && !soft;
}

static void take_turns(picture_share *share) {
  for (size_t i = 0; i < cells_of(share); i++)
    share->part_of[i] = (int32_t)(i / (size_t)share->cells_x) % share->parts;
}

hl_status hl_share_create(hl_context *context, const share_content *content, picture_share *share,
                          hl_error *error) {
  const frame *frame = content->frame;
  share_cell *cells;
  hl_layout counted = {0};
  if (share->parts == 1) return HL_OK;
  share->oversampling = frame->oversampling;
  share->cells_x = hl_tiles(frame->width / frame->oversampling);
  share->cells_y = hl_tiles(frame->height / frame->oversampling);
  lay_out(share, &cells, &counted);
  share->part_of = NULL;
  share->memory = hl_allocate(context, counted.bytes, 1);
  if (share->memory == NULL) return hl_fail_memory(error, counted.bytes, "a picture's parts");
  lay_out(share, &cells, &(hl_layout){.base = share->memory});
  if (!is_cut_in_bands(content, share)) {
    take_turns(share);
    return HL_OK;
  }
  set_keys(frame, share, cells);
  weigh_cells(content, share, cells);
  qsort(cells, cells_of(share), sizeof *cells, compare_cells);
  cut_bands(share, cells);
  return HL_OK;
}

void hl_share_release(hl_context *context, picture_share *share) {
  hl_release(context, share->memory);
  *share = (picture_share){.part = share->part, .parts = share->parts, .exchange = share->exchange};
}
