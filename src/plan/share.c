/* plan/share.c - divides a picture among parts: into bands along the lines of the brightest light, or by
 * giving rows to the parts in turn. */
#include "plan/share.h"

#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "grid/relevant.h"
#include "shadow/shadow_method.h"

/* A cell of the picture, by which the picture is divided (share.h), with the key by which cells are
 * sorted. */
typedef struct share_cell {
  double key;    /* the key by which cells are sorted; it rises from band to band */
  double weight; /* a measure of the amount of matter under the cell */
  int32_t index;
} share_cell;

/* MOST_BANDS: the greatest number of bands of a part. DEPTHS: the number of depth intervals into which the
 * content is divided. */
enum { MOST_BANDS = 3, DEPTHS = 32 };

/* The arrays that are used while a picture is divided into parts. */
typedef struct share_arrays {
  share_cell *cells;        /* [cells]; the cells in the order of their keys */
  double *each;             /* owned; [cells], by the cell's index; the weight of each single brick under a
                             * cell */
  int32_t *cut[MOST_BANDS]; /* [cells], by the cell's index; the part to which the cell belongs. Array b is
                             * for parts of b + 1 bands */
  double (*depths[MOST_BANDS])[DEPTHS]; /* array b is for parts of b + 1 bands: [parts][DEPTHS]; the weight of
                                         * each part at each depth */
} share_arrays;

static size_t cells_of(const picture_share *share) { return (size_t)share->cells_x * (size_t)share->cells_y; }

static void lay_out(picture_share *share, share_arrays *arrays, hl_layout *layout) {
  share->part_of = hl_layout_take(layout, cells_of(share), sizeof *share->part_of);
  arrays->cells = hl_layout_take(layout, cells_of(share), sizeof *arrays->cells);
  arrays->each = hl_layout_take(layout, cells_of(share), sizeof *arrays->each);
  for (int i = 0; i < MOST_BANDS; i++) {
    arrays->cut[i] = hl_layout_take(layout, cells_of(share), sizeof *arrays->cut[i]);
    arrays->depths[i] = hl_layout_take(layout, (size_t)share->parts, sizeof *arrays->depths[i]);
  }
}

void hl_share_count(int width, int height, int parts, hl_layout *layout) {
  picture_share share = {.cells_x = hl_tiles(width), .cells_y = hl_tiles(height), .parts = parts};
  share_arrays arrays;
  if (parts > 1) lay_out(&share, &arrays, layout);
}

/* ---- along which lines ---- */

static double brightness(const share_content *content, const light_source *source) {
  const frame_light *light = &content->lights[source->row];
  double color = (light->color[0] + light->color[1] + light->color[2]) * light->intensity;
  if (!light->is_inverse_square) return color;
  vec3 way = vec3_subtract(source->position, content->frame->content.middle);
  return color / fmax(vec3_dot(way, way), 1e-12);
}

/* Returns whether each part computes only the shadows of a light that it needs. */
static bool is_divided(const picture_share *share, const light_source *source) {
  const shadow_method *method = hl_shadow_method(source);
  if (method == NULL) return false;
  return method->divides || (method->exchanges && share->exchange != NULL);
}

/* The brightest light whose shadows are divided among the parts; null if no light has such shadows. */
static const light_source *brightest(const share_content *content, const picture_share *share) {
  const frame *frame = content->frame;
  const light_source *found = NULL;
  for (int i = 0; i < frame->light_count; i++) {
    const light_source *source = &frame->lights[i];
    if (!is_divided(share, source)) continue;
    if (found == NULL || brightness(content, source) > brightness(content, found)) found = source;
  }
  return found;
}

/* The image of a light in the picture, in homogeneous coordinates (w, w u, w v). */
typedef struct light_image {
  double w, u, v;
} light_image;

static light_image image_of(const view *eye, const light_source *source) {
  double rows[3][4], at[3];
  if (source == NULL)
    return (light_image){0, 1, 0}; /* without a light, the lines that parts share are rows of pixels */
  vec3 p = source->parallel ? source->direction : source->position;
  hl_view_homogeneous(eye, affine3_identity(), rows);
  for (int i = 0; i < 3; i++)
    at[i] = rows[i][0] * p.x + rows[i][1] * p.y + rows[i][2] * p.z + (source->parallel ? 0 : rows[i][3]);
  return (light_image){at[0], at[1], at[2]};
}

/* The direction of the line through the pixel (u, v) and the light's image. The sign of the direction is
 * arbitrary. */
static void line_through(const light_image *image, double u, double v, double way[2]) {
  way[0] = image->w * u - image->u;
  way[1] = image->w * v - image->v;
}

static double cross2(const double a[2], const double b[2]) { return a[0] * b[1] - a[1] * b[0]; }
static double dot2(const double a[2], const double b[2]) { return a[0] * b[0] + a[1] * b[1]; }

/* A number from -1 to 3 that rises with a direction's angle. The number is computed without trigonometric
 * functions, because the last digits of their results differ between machines. */
static double turn_of(const double way[2]) {
  double sum = fabs(way[0]) + fabs(way[1]), part = sum > 0 ? way[1] / sum : 0;
  return way[0] >= 0 ? part : 2 - part;
}

/* Sets the cells' keys. Let m be the direction of the line through the picture's middle c, and m' = (-m_y,
 * m_x) the direction across it. Derived: the line through p along d crosses the line through c along m' at c
 * + t m', where t = cross(p - c, d) / cross(m', d). The key is t. If the light's image lies in the picture or
 * near it, some lines do not run along m. The key is then the angle of the line through p. */
static void set_keys(const share_content *content, const picture_share *share, share_cell *cells) {
  const frame *frame = content->frame;
  const light_image image = image_of(&frame->eye, brightest(content, share));
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

/* About SHARE_BRICKS bricks of the volumes are sampled. A cell's weight is the square root of the number of
 * its bricks, because most bricks of a cell with many bricks are hidden (measured: docs/laboratory/ranks.md).
 * A cell without bricks has LEAST_WEIGHT times the mean weight. */
enum { SHARE_BRICKS = 1 << 18 };
static const double LEAST_WEIGHT = 0.1;

/* A function that is called for each visible brick, with the cell of the picture over which the brick lies.
 * height: the height of the brick's centre along the sheets' normal. bricks: the number of bricks for which
 * this sampled brick stands. */
typedef void brick_action(const share_content *content, const picture_share *share, share_arrays *arrays,
                          size_t cell, double height, double bricks);

/* Finds the cell over which a point of the frame lies. Returns false if the point lies beside the picture. */
static bool cell_of(const frame *frame, const picture_share *share, vec3 point, size_t *cell) {
  double uv[2], side = (double)TILE * share->oversampling;
  if (!hl_view_project(&frame->eye, point, uv)) return false;
  if (!(uv[0] >= 0 && uv[1] >= 0 && uv[0] < share->cells_x * side && uv[1] < share->cells_y * side))
    return false;
  *cell = (size_t)(uv[1] / side) * (size_t)share->cells_x + (size_t)(uv[0] / side);
  return true;
}

/* Calls `act` for visible bricks of a grid. Of `step` bricks, the function samples one, which stands for all
 * of them. The grid's list of relevant bricks is not used, because for voxels in pages the list depends on
 * the memory of a process. */
static void visit_grid(const share_content *content, const picture_share *share, const grid *grid,
                       size_t step, brick_action *act, share_arrays *arrays) {
  size_t bricks = grid->relevant_count > 0 ? hl_grid_bricks(grid) : 0, cell;
  for (size_t at = step / 2; at < bricks; at += step) {
    int32_t b[3];
    double centre[3], half[3];
    if (!grid->relevant[at]) continue;
    hl_brick_coordinates(grid, (uint32_t)at, b);
    hl_brick_bounds(grid, b, 0, centre, half);
    vec3 point = affine3_apply(grid->index_to_frame, vec3_of(centre));
    if (cell_of(content->frame, share, point, &cell))
      act(content, share, arrays, cell, vec3_dot(content->sheets->normal, point), (double)step);
  }
}

static void visit_bricks(const share_content *content, const picture_share *share, brick_action *act,
                         share_arrays *arrays) {
  size_t bricks = 0;
  for (int g = 0; g < content->grid_count; g++) bricks += hl_grid_bricks(&content->grids[g]);
  /* `step` is made odd, so that the sampled bricks lie in several columns of bricks */
  for (int g = 0; g < content->grid_count; g++)
    visit_grid(content, share, &content->grids[g], bricks / SHARE_BRICKS | 1, act, arrays);
}

static void count_brick(const share_content *content, const picture_share *share, share_arrays *arrays,
                        size_t cell, double height, double bricks) {
  (void)content, (void)share, (void)height;
  arrays->cells[cell].weight += bricks;
}

/* Finds the weights of the cells. Call this function before the cells are put in order, while each cell is
 * still stored at its index. */
static void weigh_cells(const share_content *content, const picture_share *share, share_arrays *arrays) {
  share_cell *cells = arrays->cells;
  double sum = 0;
  visit_bricks(content, share, count_brick, arrays);
  for (size_t i = 0; i < cells_of(share); i++) {
    double bricks = cells[i].weight;
    cells[i].weight = sqrt(bricks);
    arrays->each[i] = bricks > 0 ? cells[i].weight / bricks : 0;
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

/* Divides the ordered cells into bands of equal weight: a cell belongs to the band in which the middle of the
 * cell's weight lies. The function then gives the bands to the parts: first in forward order, then in
 * backward order, and so on by turns. By this order, the last part gets two neighbouring bands. With three
 * bands for each part, the first part gets two neighbouring bands, too. */
static void cut_bands(const picture_share *share, const share_cell *cells, int bands, int32_t *part_of) {
  double sum = 0, before = 0;
  const int parts = share->parts;
  for (size_t i = 0; i < cells_of(share); i++) sum += cells[i].weight;
  for (size_t i = 0; i < cells_of(share); before += cells[i++].weight) {
    int band = (int)((before + cells[i].weight / 2) / sum * parts * bands);
    if (band >= parts * bands) band = parts * bands - 1;
    part_of[cells[i].index] = band / parts % 2 == 0 ? band % parts : parts - 1 - band % parts;
  }
}

/* ---- how many bands ---- */

/* Adds a brick's weight, at the brick's depth, to the part over which the brick lies, for each number of
 * bands. */
static void place_brick(const share_content *content, const picture_share *share, share_arrays *arrays,
                        size_t cell, double height, double bricks) {
  (void)share;
  const sheet_stack *sheets = content->sheets;
  double depth = (height - sheets->first) / (sheets->spacing * sheets->count) * DEPTHS;
  int at = depth > 0 ? depth < DEPTHS ? (int)depth : DEPTHS - 1 : 0;
  for (int i = 0; i < MOST_BANDS; i++)
    arrays->depths[i][arrays->cut[i][cell]][at] += bricks * arrays->each[cell];
}

/* Returns whether a cell lies beside a cell of another part. */
static bool is_at_border(const picture_share *share, const int32_t *part_of, int32_t index) {
  int x = index % share->cells_x, y = index / share->cells_x;
  int32_t own = part_of[index];
  return (x > 0 && part_of[index - 1] != own) || (y > 0 && part_of[index - share->cells_x] != own) ||
         (x + 1 < share->cells_x && part_of[index + 1] != own) ||
         (y + 1 < share->cells_y && part_of[index + share->cells_x] != own);
}

/* The cost of a division into bands, in units of the mean cost of a part. At each depth the slowest part
 * counts, because the other parts wait for it. Half of the cells at borders between parts are added, for
 * light that several parts work through (measured: docs/laboratory/ranks.md). */
static double cost_of(const picture_share *share, const share_arrays *arrays, int bands) {
  const int32_t *part_of = arrays->cut[bands - 1];
  double(*depths)[DEPTHS] = arrays->depths[bands - 1], all = 0, slowest = 0, cells = 0, border = 0;
  for (int depth = 0; depth < DEPTHS; depth++) {
    double most = 0;
    for (int part = 0; part < share->parts; part++) {
      most = fmax(most, depths[part][depth]);
      all += depths[part][depth];
    }
    slowest += most;
  }
  for (size_t i = 0; i < cells_of(share); i++) {
    cells += arrays->cells[i].weight;
    if (is_at_border(share, part_of, arrays->cells[i].index)) border += arrays->cells[i].weight;
  }
  return (all > 0 ? slowest * share->parts / all : 1) + border / (2 * cells);
}

/* More bands are chosen only for a gain of at least this fraction, because the estimate of the cost is
 * rough. */
static const double LEAST_GAIN = 0.1;

static int choose_bands(const share_content *content, const picture_share *share, share_arrays *arrays) {
  int chosen = 1;
  for (int i = 0; i < MOST_BANDS; i++) {
    cut_bands(share, arrays->cells, i + 1, arrays->cut[i]);
    memset(arrays->depths[i], 0, (size_t)share->parts * sizeof *arrays->depths[i]);
  }
  visit_bricks(content, share, place_brick, arrays);
  double least = cost_of(share, arrays, 1);
  for (int bands = 2; bands <= MOST_BANDS; bands++) {
    double cost = cost_of(share, arrays, bands);
    if (cost < least * (1 - LEAST_GAIN)) least = cost, chosen = bands;
  }
  return chosen;
}

/* Returns whether any volume lies in pages that are fetched from several ranks. */
static bool lies_over_ranks(const share_content *content) {
  for (int g = 0; g < content->grid_count; g++)
    if (content->grids[g].pages != NULL && content->grids[g].pages->version != NULL) return true;
  return false;
}

/* Returns whether parts wait for each other at each depth, and should therefore have several bands. If
 * several ranks share the volumes, parts of one band are better, because they need the fewest pages. */
static bool waits_at_depths(const share_content *content, const picture_share *share) {
  const light_source *light = brightest(content, share);
  const shadow_method *method = light != NULL ? hl_shadow_method(light) : NULL;
  return method != NULL && method->exchanges && share->exchange != NULL && !lies_over_ranks(content);
}

/* Returns whether parts are bands, and not rows of cells in turn. Rows in turn divide the work more equally.
 * But if shadows are divided among the parts, a band needs less light. If no shadows are cast, a band needs
 * fewer voxels, which matters if several ranks share the voxels. The result must not depend on whether voxels
 * lie in a scratch file, because each process decides for itself whether they do. */
static bool is_cut_in_bands(const share_content *content, const picture_share *share) {
  const frame *frame = content->frame;
  bool soft = false;
  if (brightest(content, share) != NULL) return true;
  for (int i = 0; i < frame->light_count; i++) soft = soft || frame->lights[i].shadows == HL_SHADOWS_SOFT;
  return lies_over_ranks(content) && !soft;
}

static void take_turns(picture_share *share) {
  for (size_t i = 0; i < cells_of(share); i++)
    share->part_of[i] = (int32_t)(i / (size_t)share->cells_x) % share->parts;
}

hl_status hl_share_create(hl_context *context, const share_content *content, picture_share *share,
                          hl_error *error) {
  const frame *frame = content->frame;
  share_arrays arrays;
  hl_layout layout = {0};
  if (share->parts == 1) return HL_OK;
  share->oversampling = frame->oversampling;
  share->cells_x = hl_tiles(frame->width / frame->oversampling);
  share->cells_y = hl_tiles(frame->height / frame->oversampling);
  while (hl_layout_pass(&layout, context)) lay_out(share, &arrays, &layout);
  share->memory = layout.base;
  if (share->memory == NULL) return hl_fail_memory(error, layout.bytes, "a picture's parts");
  if (!is_cut_in_bands(content, share)) {
    take_turns(share);
    return HL_OK;
  }
  set_keys(content, share, arrays.cells);
  weigh_cells(content, share, &arrays);
  qsort(arrays.cells, cells_of(share), sizeof *arrays.cells, compare_cells);
  int bands = waits_at_depths(content, share) ? choose_bands(content, share, &arrays) : 1;
  cut_bands(share, arrays.cells, bands, share->part_of);
  return HL_OK;
}

void hl_share_release(hl_context *context, picture_share *share) {
  hl_release(context, share->memory);
  *share = (picture_share){.part = share->part, .parts = share->parts, .exchange = share->exchange};
}
