/* render/light_reads.c - finds which tiles of a light's shadow buffer the picture reads, and for how long
 * (light_reads.h).
 *
 * The samples of a picture's tile in a run of slabs lie between rays through the tile's corners and between
 * two sheets. So the samples lie in the convex hull of eight points. If all eight points lie ahead of the
 * light, the light sees the samples in the convex hull of the points' images. Derived: a projection takes
 * lines to lines. The tiles of the buffer around the images are needed until the run's last slab. For a light
 * of many sub-lights, the picture reads the sub-lights' buffers, each of which has tiles of its own. */
#include "render/light_reads.h"

#include <string.h>

#include "core/memory.h"
#include "render/surface_point.h"
#include "surface/late/lateness.h"

/* Allowances for rounding. SHEET_SPARE: the number of sheets by which a sample may lie outside of its slab.
 * PIXEL_SPARE: the number of pixels by which it may lie outside of its tile. */
static const double SHEET_SPARE = 0.5, PIXEL_SPARE = 1;

/* Slabs of a run. */
enum { READ_RUN = 8 };

/* The distance, in pixels of a buffer, up to which a look-up reads around its position. Cubic convolution
 * reads two pixels to each side, and one more allows for rounding. */
enum { READ_TAPS = 3 };

/* The difference of cosines by which a sector's edge is moved outwards, to allow for rounding. */
static const double SECTOR_SPARE = 1e-3;

/* A buffer that the picture reads: the buffer of a light or of a sub-light. */
typedef struct read_buffer {
  const light_source *source;
  double rows[3][4]; /* maps frame space to (w, w u, w v), where (u, v) is the position in the buffer */
  double length[3];  /* the length of each row of the map as a vector, without its constant */
  int32_t *until;    /* [tiles_y][tiles_x] */
  int tiles_x, tiles_y;
  const struct read_buffer *moves; /* the buffer whose pixels are the unit in which look-ups at surfaces are
                                    * moved away from the surfaces: the light's first buffer. Null if there
                                    * are no surfaces. */
} read_buffer;

/* The position of a point in a buffer, as homogeneous coordinates (w, w u, w v). */
static vec3 place_in(const read_buffer *buffer, vec3 point) {
  double place[3];
  for (int i = 0; i < 3; i++)
    place[i] = buffer->rows[i][0] * point.x + buffer->rows[i][1] * point.y + buffer->rows[i][2] * point.z +
               buffer->rows[i][3];
  return vec3_of(place);
}

/* A rectangle of pixels around the images of some points. */
typedef struct read_bounds {
  double low[2], high[2];
  double nearest; /* the least w */
} read_bounds;

/* Finds the rectangle of a buffer's pixels that holds the images of some points. Returns false if a point
 * does not lie ahead of the light. */
static bool bound_points(const read_buffer *buffer, const vec3 *points, int count, read_bounds *bounds) {
  *bounds = (read_bounds){{INFINITY, INFINITY}, {-INFINITY, -INFINITY}, INFINITY};
  for (int i = 0; i < count; i++) {
    vec3 place = place_in(buffer, points[i]);
    if (!(place.x > 0)) return false;
    const double uv[2] = {place.y / place.x, place.z / place.x};
    for (int a = 0; a < 2; a++) {
      bounds->low[a] = fmin(bounds->low[a], uv[a]);
      bounds->high[a] = fmax(bounds->high[a], uv[a]);
    }
    bounds->nearest = fmin(bounds->nearest, place.x);
  }
  return count > 0;
}

/* Widens the bounds by the pixels that look-ups read beside a sample. Returns false if samples may be moved
 * to places that do not lie ahead of the light. Derived: look-ups at surfaces are moved by at most d = 1.25
 * w' / |r1'|, where w' and r1' belong to the buffer `moves`. The column u = (r1.p) / w moves by (r1.d - u
 * r0.d) / (w + r0.d), which is at most d (|r1| + |u| |r0|) / (w - d |r0|). For the row v, take r2 in place of
 * r1. */
static bool widen(const read_buffer *buffer, const vec3 *points, int count, read_bounds *bounds) {
  double farthest = 0, way = 0;
  for (int i = 0; i < count && buffer->moves != NULL; i++)
    farthest = fmax(farthest, place_in(buffer->moves, points[i]).x);
  if (buffer->moves != NULL) way = (double)LOOKUP_OFFSET * farthest / buffer->moves->length[1];
  double nearest = bounds->nearest - way * buffer->length[0];
  if (!(nearest > 0)) return false;
  for (int a = 0; a < 2; a++) {
    double at = fmax(fabs(bounds->low[a]), fabs(bounds->high[a])),
           around = READ_TAPS + way * (buffer->length[1 + a] + at * buffer->length[0]) / nearest;
    bounds->low[a] -= around;
    bounds->high[a] += around;
  }
  return true;
}

static int tile_at(double pixel, int tiles) {
  if (!(pixel >= 0)) return 0;
  return pixel >= (double)tiles * TILE ? tiles - 1 : (int)(pixel / TILE);
}

/* Raises `until` in the tiles of the buffer that samples in the convex hull of some points may read. These
 * are all tiles if a point does not lie ahead of the light, or if there are no points. */
static void read_hull(const read_buffer *buffer, const vec3 *points, int count, int32_t slab) {
  const int tiles[2] = {buffer->tiles_x, buffer->tiles_y};
  int first[2] = {0, 0}, last[2] = {tiles[0] - 1, tiles[1] - 1};
  read_bounds bounds;
  if (bound_points(buffer, points, count, &bounds) && widen(buffer, points, count, &bounds))
    for (int a = 0; a < 2; a++) {
      first[a] = tile_at(bounds.low[a], tiles[a]);
      last[a] = tile_at(bounds.high[a], tiles[a]);
    }
  for (int y = first[1]; y <= last[1]; y++)
    for (int x = first[0]; x <= last[0]; x++) {
      int32_t *until = &buffer->until[(size_t)y * (size_t)buffer->tiles_x + (size_t)x];
      if (*until < slab) *until = slab;
    }
}

/* Finds points whose convex hull holds the samples of a tile between two heights. Usually there are eight
 * points. If the eye lies between the heights or beyond them, there are fewer points, and the eye is one of
 * them. There are no points if a ray at the tile's corners, which may lie beside the picture, crosses the
 * sheets in another direction than the picture's rays. */
static int hull_of(const sweep *sweep, size_t tile, double low, double high, vec3 points[9]) {
  const view *eye = &sweep->frame->eye;
  vec3 normal = sweep->geometry->sheets.normal;
  double sense = sweep->geometry->back_to_front ? -1 : 1;
  int count = 0;
  bool behind = false;
  for (int corner = 0; corner < 4; corner++) {
    double u = hl_tile_x(sweep, tile) * TILE + (corner & 1 ? TILE + PIXEL_SPARE : -PIXEL_SPARE),
           v = hl_tile_y(sweep, tile) * TILE + (corner & 2 ? TILE + PIXEL_SPARE : -PIXEL_SPARE);
    u = fmin(u, eye->width + PIXEL_SPARE);
    v = fmin(v, eye->height + PIXEL_SPARE);
    vec3 start, way;
    hl_view_ray(eye, u, v, &start, &way);
    double climb = vec3_dot(normal, way), height = vec3_dot(normal, start);
    if (!(climb * sense > 0)) return 0;
    for (int end = 0; end < 2; end++) {
      double far = ((end == 0 ? low : high) - height) / climb;
      if (eye->perspective && !(far > 0)) behind = true;
      else points[count++] = vec3_add(start, vec3_scale(way, far));
    }
  }
  if (behind) points[count++] = eye->origin;
  return count;
}

typedef struct reads_task {
  const sweep *sweep;
  read_buffer *buffers; /* owned; [buffer_count] */
  int buffer_count;
} reads_task;

/* Marks the tiles that a tile of the picture reads in the slabs from first to last, both included. */
static void read_slabs(const reads_task *task, size_t tile, int first, int last) {
  const sheet_stack *sheets = &task->sweep->geometry->sheets;
  vec3 points[9];
  int count = hull_of(task->sweep, tile, hl_sheet_height(sheets, first - 1) - SHEET_SPARE * sheets->spacing,
                      hl_sheet_height(sheets, last) + SHEET_SPARE * sheets->spacing, points);
  for (int i = 0; i < task->buffer_count; i++) read_hull(&task->buffers[i], points, count, last);
}

/* Marks the tiles that a tile of the picture reads, for one run of slabs after the other. */
static void read_tile(const reads_task *task, size_t tile) {
  const occupancy *occupancy = &task->sweep->image.occupancy;
  int sheets = task->sweep->geometry->sheets.count, first = 0, last = 0;
  for (int slab = 1; slab < sheets; slab++) {
    if (first > 0 && slab - first == READ_RUN) {
      read_slabs(task, tile, first, last);
      first = 0;
    }
    if (!hl_occupancy_touches(occupancy, tile, slab)) continue;
    if (first == 0) first = slab;
    last = slab;
  }
  if (first > 0) read_slabs(task, tile, first, last);
}

/* For the lights that are sectors: marks the tiles of the lights' buffers that are read at surfaces which the
 * eye sees in a tile of the picture. */
static void read_surfaces(const reads_task *task, size_t tile) {
  const sweep *sweep = task->sweep;
  const fragments *all = &sweep->surfaces.image;
  const tile_slab place = {.x = hl_tile_x(sweep, tile), .y = hl_tile_y(sweep, tile)};
  for (uint32_t n = 0; n < all->of[tile].count; n++) {
    const fragment *f = &all->of[tile].list[n];
    vec3 point = hl_surface_place(sweep, &place, f, (double)f->height);
    for (int i = 0; i < task->buffer_count; i++) {
      const light_source *source = task->buffers[i].source;
      vec3 way = vec3_subtract(point, source->position);
      double ahead = vec3_dot(way, source->direction), least = source->sectors->least - SECTOR_SPARE;
      if (ahead >= least * vec3_length(way)) read_hull(&task->buffers[i], &point, 1, f->slab);
    }
  }
}

static bool is_exchanged(const sweep *sweep, const light_shadow *shadow) {
  return sweep->share->part_of != NULL && shadow->method != NULL && shadow->method->exchanges &&
         shadow->setup.exchange != NULL;
}

/* Returns whether a light is a sector of a light within the content, and the scene holds only meshes. Such a
 * light is read only at points of meshes that the eye sees. */
static bool is_sector_of_meshes(const sweep *sweep, const light_shadow *shadow) {
  return shadow->setup.source->sectors != NULL && sweep->content.volume_count == 0;
}

static bool is_limited(const sweep *sweep, const light_shadow *shadow) {
  if (shadow->method == NULL) return false;
  if (sweep->share->part_of != NULL && shadow->method->divides) return true;
  return is_exchanged(sweep, shadow) ||
         (is_sector_of_meshes(sweep, shadow) && shadow->method->advance == NULL);
}

static size_t sublight_tiles(const light_shadow *shadow) {
  return (size_t)shadow->sublight_count * (size_t)shadow->sublight_tiles_x * (size_t)shadow->sublight_tiles_y;
}

/* The buffers of a light that the picture reads. */
static int read_buffers(const light_shadow *shadow) {
  return shadow->sublight_count > 0 ? shadow->sublight_count : 1;
}

/* ---- memory ---- */

static size_t tiles_of(const light_shadow *shadow) {
  return shadow->sublight_count > 0 ? sublight_tiles(shadow) : hl_view_tiles(&shadow->plan.view);
}

/* Lays out the arrays of a light whose reads are limited. needed_until, or for sub-lights sublights_until, is
 * the first array in the block. */
static void lay_out_light(const sweep *sweep, sweep_light *light, hl_layout *layout) {
  const size_t tiles = tiles_of(&light->shadow);
  int32_t *until = hl_layout_take(layout, tiles, sizeof *until);
  if (light->shadow.sublight_count > 0) light->sublights_until = until;
  else light->needed_until = until;
  if (is_exchanged(sweep, &light->shadow)) light->owned = hl_layout_take(layout, tiles, sizeof *light->owned);
}

/* Lays out and fills the list of the buffers of lights whose pixels are made only where samples may read
 * them. */
static read_buffer *lay_out_buffers(const sweep *sweep, hl_layout *layout) {
  size_t count = 0;
  for (int i = 0; i < sweep->geometry->light_count; i++)
    if (is_limited(sweep, &sweep->lights[i].shadow)) count += (size_t)read_buffers(&sweep->lights[i].shadow);
  return hl_layout_take(layout, count, sizeof(read_buffer));
}

/* Lays out an array [parts][tiles]. It tells, for each part and each tile of a light's buffer, the last slab
 * at which the part needs the tile. */
static int32_t *lay_out_needs(const light_shadow *shadow, hl_layout *layout) {
  return hl_layout_take(layout, (size_t)shadow->setup.exchange->parts * tiles_of(shadow), sizeof(int32_t));
}

void hl_light_reads_count(sweep *sweep, hl_layout *layout) {
  for (int i = 0; i < sweep->geometry->light_count; i++)
    if (is_limited(sweep, &sweep->lights[i].shadow)) lay_out_light(sweep, &sweep->lights[i], layout);
  const size_t kept = layout->bytes;
  lay_out_buffers(sweep, layout);
  hl_layout_give_back(layout, kept);
  for (int i = 0; i < sweep->geometry->light_count; i++) {
    if (is_exchanged(sweep, &sweep->lights[i].shadow)) lay_out_needs(&sweep->lights[i].shadow, layout);
    hl_layout_give_back(layout, kept);
  }
}

/* ---- owners ---- */

/* The last slab in which bricks or surfaces touch a tile; 0 if nothing touches the tile. */
static int32_t last_touched(const occupancy *occupancy, size_t tile) {
  for (int slab = occupancy->sheets - 1; slab > 0; slab--)
    if (hl_occupancy_touches(occupancy, tile, slab)) return slab;
  return 0;
}

/* The part that owns a tile of a light's buffer. It is the part that needs the tile longest; if several do,
 * the one with the least number. A tile that no part needs gets an owner by its place. all: [parts][tiles] */
static int owner_of(const int32_t *all, size_t tile, size_t tiles, int parts) {
  int owner = 0;
  for (int part = 1; part < parts; part++)
    if (all[(size_t)part * tiles + tile] > all[(size_t)owner * tiles + tile]) owner = part;
  if (all[(size_t)owner * tiles + tile] > 0) return owner;
  return (int)(tile * (size_t)parts / tiles);
}

/* Returns whether this part owns a tile, or a tile that lies at most `around` tiles away. */
static bool is_owned_around(const sweep_light *light, int tile, int around) {
  const view *view = &light->shadow.buffer->view;
  const int across = hl_tiles(view->width), down = hl_tiles(view->height);
  for (int dy = -around; dy <= around; dy++)
    for (int dx = -around; dx <= around; dx++) {
      int x = tile % across + dx, y = tile / across + dy;
      if (x >= 0 && y >= 0 && x < across && y < down && light->owned[y * across + x]) return true;
    }
  return false;
}

/* Finds the tiles that this part owns. The part needs an owned tile as long as anything touches the tile,
 * even if the part's picture no longer needs it. So the parts together know all light. If the frame has
 * surfaces, the part needs the tiles beside an owned tile, too: the light that surfaces hide in a tile
 * depends on pixels up to a tile beside it (shadow_cascade/cascade_field.h). */
static hl_status find_owned(sweep *sweep, sweep_light *light, hl_error *error) {
  hl_context *context = sweep->content.context;
  const light_exchange *with = light->shadow.setup.exchange;
  const size_t tiles = tiles_of(&light->shadow);
  int32_t *all = NULL;
  hl_layout layout = {0};
  while (hl_layout_pass(&layout, context)) all = lay_out_needs(&light->shadow, &layout);
  if (layout.base == NULL) return hl_fail_memory(error, layout.bytes, "a light's tiles");
  with->gather(with->data, light->needed_until, tiles * sizeof *all, all);
  for (size_t tile = 0; tile < tiles; tile++)
    light->owned[tile] = owner_of(all, tile, tiles, with->parts) == with->part;
  hl_release(context, layout.base);
  for (size_t tile = 0; tile < tiles; tile++) {
    if (!is_owned_around(light, (int)tile, sweep->frame->surfaces != NULL ? 1 : 0)) continue;
    int32_t last = last_touched(&light->sheets.occupancy, tile);
    if (light->needed_until[tile] < last) light->needed_until[tile] = last;
  }
  light->shadow.needed_until = light->needed_until;
  light->shadow.owned = light->owned;
  return HL_OK;
}

/* ---- buffers ---- */

static void finish_buffer(read_buffer *buffer) {
  for (int i = 0; i < 3; i++) {
    const double *row = buffer->rows[i];
    buffer->length[i] = sqrt(row[0] * row[0] + row[1] * row[1] + row[2] * row[2]);
  }
}

static void add_sublights(sweep_light *light, read_buffer *buffers) {
  const light_shadow *shadow = &light->shadow;
  size_t tiles = (size_t)shadow->sublight_tiles_x * (size_t)shadow->sublight_tiles_y;
  for (int n = 0; n < shadow->sublight_count; n++) {
    buffers[n] = (read_buffer){.source = light->source,
                               .until = light->sublights_until + (size_t)n * tiles,
                               .tiles_x = shadow->sublight_tiles_x,
                               .tiles_y = shadow->sublight_tiles_y};
    for (int row = 0; row < 3; row++)
      for (int i = 0; i < 4; i++) buffers[n].rows[row][i] = (double)shadow->sublights[n].map.rows[row][i];
    finish_buffer(&buffers[n]);
  }
}

/* Adds the buffers of a light whose reads are limited. */
static hl_status add_buffers(sweep *sweep, sweep_light *light, reads_task *task, hl_error *error) {
  const view *view = &light->shadow.buffer->view;
  hl_layout layout = {0};
  while (hl_layout_pass(&layout, sweep->content.context)) lay_out_light(sweep, light, &layout);
  if (layout.base == NULL) return hl_fail_memory(error, layout.bytes, "a light's tiles");
  light->reads = layout.base;
  memset(light->reads, 0, layout.bytes);
  read_buffer *buffers = &task->buffers[task->buffer_count];
  task->buffer_count += read_buffers(&light->shadow);
  if (light->shadow.sublight_count > 0) {
    light->shadow.sublights_until = light->sublights_until;
    add_sublights(light, buffers);
  } else {
    buffers[0] = (read_buffer){.source = light->source,
                               .until = light->needed_until,
                               .tiles_x = hl_tiles(view->width),
                               .tiles_y = hl_tiles(view->height)};
    hl_view_homogeneous(view, affine3_identity(), buffers[0].rows);
    finish_buffer(&buffers[0]);
  }
  for (int n = 0; n < read_buffers(&light->shadow); n++)
    buffers[n].moves = sweep->frame->surfaces != NULL ? &buffers[0] : NULL;
  return HL_OK;
}

static void widen_needs(sweep_light *light) {
  const shadow_method *method = light->shadow.method;
  if (!method->divides || light->needed_until == NULL) return;
  light->shadow.needed_until = light->needed_until;
  if (method->widen_needs != NULL) method->widen_needs(&light->shadow, light->needed_until);
}

static void read_tiles(const reads_task *task) {
  const sweep *sweep = task->sweep;
  const bool surfaces_alone = task->buffers[0].source->sectors != NULL && sweep->content.volume_count == 0 &&
                              sweep->surfaces.image.of != NULL;
  for (size_t tile = 0; tile < sweep->frame_plan->picture.tiles; tile++) {
    if (sweep->arrays.open[tile] == 0) continue;
    if (surfaces_alone) read_surfaces(task, tile);
    else read_tile(task, tile);
  }
}

hl_status hl_light_reads_find(sweep *sweep, hl_error *error) {
  reads_task task = {.sweep = sweep};
  hl_layout layout = {0};
  hl_status status = HL_OK;
  bool any = false;
  for (int i = 0; i < sweep->geometry->light_count; i++) any |= is_limited(sweep, &sweep->lights[i].shadow);
  if (!any) return HL_OK;
  while (hl_layout_pass(&layout, sweep->content.context)) task.buffers = lay_out_buffers(sweep, &layout);
  if (layout.base == NULL) return hl_fail_memory(error, layout.bytes, "a light's tiles");
  for (int i = 0; i < sweep->geometry->light_count && status == HL_OK; i++)
    if (is_limited(sweep, &sweep->lights[i].shadow))
      status = add_buffers(sweep, &sweep->lights[i], &task, error);
  if (status == HL_OK) read_tiles(&task);
  for (int i = 0; i < sweep->geometry->light_count && status == HL_OK; i++)
    if (is_limited(sweep, &sweep->lights[i].shadow)) widen_needs(&sweep->lights[i]);
  hl_release(sweep->content.context, layout.base);
  return status;
}

hl_status hl_light_reads_find_owned(sweep *sweep, hl_error *error) {
  hl_status status = HL_OK;
  for (int i = 0; i < sweep->geometry->light_count && status == HL_OK; i++) {
    sweep_light *light = &sweep->lights[i];
    if (is_exchanged(sweep, &light->shadow)) status = find_owned(sweep, light, error);
  }
  return status;
}
