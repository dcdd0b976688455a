/* render/light_reads.c - see light_reads.h.
 *
 * Samples of a picture's tile in a run of slabs lie between rays through the tile's corners and between two
 * sheets: in the convex hull of eight points. Seen from the light, all of it ahead, they lie in the convex
 * hull of the points' images (derived: a projection takes lines to lines). The tiles of the buffer around the
 * images are needed until the run's last slab. */
#include "render/light_reads.h"

#include "core/memory.h"
#include "render/surface_point.h"

/* Sheets by which a sample may lie outside of its slab, and pixels by which it may lie outside of its tile:
 * for rounding. */
static const double SHEET_SPARE = 0.5, PIXEL_SPARE = 1;

/* Slabs of a run. */
enum { READ_RUN = 8 };

/* Pixels of a buffer around a look-up's position that are read: the farthest of cubic convolution's, and one
 * for rounding. */
enum { READ_TAPS = 3 };

/* The greatest distance, in pixels, by which look-ups at surfaces move away from them (LOOKUP_OFFSET in
 * surface_lanes.h, by the first row of the map), along u or v. Derived: u = (r1.p) / (r0.p) has the gradient
 * (r1 - u r0) / (r0.p), so a way of 1.25 (r0.p) / |r1| moves it by at most 1.25 (|r1| + |u| |r0|) / |r1|; v
 * likewise. */
static double moved_away(const view *view, int axis) {
  double rows[3][4], length[3];
  hl_view_homogeneous(view, affine3_identity(), rows);
  for (int i = 0; i < 3; i++)
    length[i] = sqrt(rows[i][0] * rows[i][0] + rows[i][1] * rows[i][1] + rows[i][2] * rows[i][2]);
  int side = axis == 0 ? view->width : view->height;
  return 1 + 1.25 * (length[1 + axis] + side * length[0]) / length[1];
}

/* Cosine by which the edge of a sector is looked for outside of it: for rounding. */
static const double SECTOR_SPARE = 1e-3;

/* One light while its reads are found. */
typedef struct reads_of_light {
  const light_source *source;
  const view *view;
  int32_t *until; /* [tiles_y][tiles_x] */
  int tiles_x, tiles_y;
  double around[2]; /* pixels beside a sample that may be read */
} reads_of_light;

static int tile_at(double pixel, int tiles) {
  if (!(pixel >= 0)) return 0;
  return pixel >= (double)tiles * TILE ? tiles - 1 : (int)(pixel / TILE);
}

/* Raises `until` in the tiles of the buffer that the hull of some points may read: in all tiles where a point
 * does not lie ahead of the light, or where there are no points. */
static void read_hull(const reads_of_light *light, const vec3 *points, int count, int32_t slab) {
  int first[2] = {0, 0}, last[2] = {light->tiles_x - 1, light->tiles_y - 1};
  double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY}, uv[2];
  bool ahead = count > 0;
  for (int i = 0; i < count && ahead; i++) {
    ahead = hl_view_project(light->view, points[i], uv);
    for (int a = 0; a < 2 && ahead; a++) {
      low[a] = fmin(low[a], uv[a]);
      high[a] = fmax(high[a], uv[a]);
    }
  }
  const int tiles[2] = {light->tiles_x, light->tiles_y};
  for (int a = 0; a < 2 && ahead; a++) {
    first[a] = tile_at(low[a] - light->around[a], tiles[a]);
    last[a] = tile_at(high[a] + light->around[a], tiles[a]);
  }
  for (int y = first[1]; y <= last[1]; y++)
    for (int x = first[0]; x <= last[0]; x++) {
      int32_t *until = &light->until[(size_t)y * (size_t)light->tiles_x + (size_t)x];
      if (*until < slab) *until = slab;
    }
}

/* Points around the samples of a tile between two heights: eight, or fewer and the eye, where that lies
 * between them or beyond. None where a ray beside the picture does not cross the sheets as those within do.
 */
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
  reads_of_light lights[FRAME_LIGHTS];
  int light_count;
} reads_task;

/* The reads of the slabs from first to last, both included, in a tile. */
static void read_slabs(const reads_task *task, size_t tile, int first, int last) {
  const sheet_stack *sheets = &task->sweep->geometry->sheets;
  vec3 points[9];
  int count = hull_of(task->sweep, tile, hl_sheet_height(sheets, first - 1) - SHEET_SPARE * sheets->spacing,
                      hl_sheet_height(sheets, last) + SHEET_SPARE * sheets->spacing, points);
  for (int i = 0; i < task->light_count; i++) read_hull(&task->lights[i], points, count, last);
}

/* The reads of a tile of the picture, run by run. */
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

/* The reads of the surfaces that the eye sees in a tile, in the sectors that light them. */
static void read_surfaces(const reads_task *task, size_t tile) {
  const sweep *sweep = task->sweep;
  const fragments *all = &sweep->surfaces.image;
  const tile_slab place = {.x = hl_tile_x(sweep, tile), .y = hl_tile_y(sweep, tile)};
  for (uint32_t n = 0; n < all->of[tile].count; n++) {
    const fragment *f = &all->of[tile].list[n];
    vec3 point = hl_surface_place(sweep, &place, f, (double)f->height);
    for (int i = 0; i < task->light_count; i++) {
      const light_source *source = task->lights[i].source;
      vec3 way = vec3_subtract(point, source->position);
      double ahead = vec3_dot(way, source->direction), least = source->sectors->least - SECTOR_SPARE;
      if (ahead >= least * vec3_length(way)) read_hull(&task->lights[i], &point, 1, f->slab);
    }
  }
}

static bool is_exchanged(const sweep *sweep, const light_shadow *shadow) {
  return sweep->share->part_of != NULL && shadow->method != NULL && shadow->method->exchanges &&
         shadow->setup.exchange != NULL;
}

/* Whether a light is a sector of one within the content, and there are meshes alone: it is then read at their
 * points that the eye sees. */
static bool is_sector_of_meshes(const sweep *sweep, const light_shadow *shadow) {
  return shadow->setup.source->sectors != NULL && sweep->content.volume_count == 0;
}

static bool is_limited(const sweep *sweep, const light_shadow *shadow) {
  bool part = sweep->share->part_of != NULL || is_sector_of_meshes(sweep, shadow);
  return is_exchanged(sweep, shadow) || (part && shadow->method != NULL && shadow->method->advance == NULL);
}

uint64_t hl_light_reads_bytes(const sweep *sweep, const light_shadow *shadow) {
  uint64_t tiles = hl_view_tiles(&shadow->plan.view), each = is_limited(sweep, shadow) ? sizeof(int32_t) : 0;
  if (is_exchanged(sweep, shadow)) each += 1 + sizeof(int32_t) * (uint64_t)sweep->share->parts;
  return tiles * each;
}

/* ---- owners ---- */

/* The last slab in which bricks or surfaces touch a tile; 0: none do. */
static int32_t last_touched(const occupancy *occupancy, size_t tile) {
  for (int slab = occupancy->sheets - 1; slab > 0; slab--)
    if (hl_occupancy_touches(occupancy, tile, slab)) return slab;
  return 0;
}

/* The owner of a tile: of the parts that need it longest the first; of a tile that nobody needs, by its
 * place. all: [parts][tiles] */
static int owner_of(const int32_t *all, size_t tile, size_t tiles, int parts) {
  int owner = 0;
  for (int part = 1; part < parts; part++)
    if (all[(size_t)part * tiles + tile] > all[(size_t)owner * tiles + tile]) owner = part;
  if (all[(size_t)owner * tiles + tile] > 0) return owner;
  return (int)(tile * (size_t)parts / tiles);
}

/* Whether this part owns a tile, or one at most `around` tiles beside it. */
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

/* Finds the tiles that this part owns: needs them as long as anything touches them, though the picture may
 * need them no more, so that together the parts know of all light. Where there are surfaces it needs the
 * tiles beside them, too: what surfaces hide in a tile depends on pixels up to a tile beside it
 * (shadow_cascade/cascade_field.h). */
static hl_status find_owned(sweep *sweep, sweep_light *light, size_t tiles, hl_error *error) {
  hl_context *context = sweep->content.context;
  const light_exchange *with = light->shadow.setup.exchange;
  light->owned = hl_allocate_zeroed(context, tiles, sizeof *light->owned);
  int32_t *all = hl_allocate(context, (size_t)with->parts * tiles, sizeof *all);
  if (light->owned == NULL || all == NULL) {
    hl_release(context, all);
    return hl_fail_memory(error, (size_t)with->parts * tiles * sizeof *all, "a light's tiles");
  }
  with->gather(with->data, light->needed_until, tiles * sizeof *all, all);
  for (size_t tile = 0; tile < tiles; tile++)
    light->owned[tile] = owner_of(all, tile, tiles, with->parts) == with->part;
  hl_release(context, all);
  for (size_t tile = 0; tile < tiles; tile++) {
    if (!is_owned_around(light, (int)tile, sweep->frame->surfaces != NULL ? 1 : 0)) continue;
    int32_t last = last_touched(&light->sheets.occupancy, tile);
    if (light->needed_until[tile] < last) light->needed_until[tile] = last;
  }
  light->shadow.needed_until = light->needed_until;
  light->shadow.owned = light->owned;
  return HL_OK;
}

hl_status hl_light_reads_find(sweep *sweep, hl_error *error) {
  reads_task task = {.sweep = sweep};
  for (int i = 0; i < sweep->geometry->light_count; i++) {
    sweep_light *light = &sweep->lights[i];
    if (!is_limited(sweep, &light->shadow)) continue;
    const view *view = &light->shadow.buffer->view;
    size_t tiles = hl_view_tiles(view);
    light->needed_until = hl_allocate_zeroed(sweep->content.context, tiles, sizeof *light->needed_until);
    if (light->needed_until == NULL)
      return hl_fail_memory(error, tiles * sizeof *light->needed_until, "a light's tiles");
    reads_of_light *reads = &task.lights[task.light_count++];
    *reads = (reads_of_light){.source = light->source,
                              .view = view,
                              .until = light->needed_until,
                              .tiles_x = hl_tiles(view->width),
                              .tiles_y = hl_tiles(view->height),
                              .around = {READ_TAPS, READ_TAPS}};
    for (int a = 0; a < 2 && sweep->frame->surfaces != NULL; a++) reads->around[a] += moved_away(view, a);
  }
  const bool surfaces_alone = task.light_count > 0 && task.lights[0].source->sectors != NULL &&
                              sweep->content.volume_count == 0 && sweep->surfaces.image.of != NULL;
  for (size_t tile = 0; tile < sweep->tiles && task.light_count > 0; tile++) {
    if (sweep->arrays.open[tile] == 0) continue;
    if (surfaces_alone) read_surfaces(&task, tile);
    else read_tile(&task, tile);
  }
  return HL_OK;
}

hl_status hl_light_reads_find_owned(sweep *sweep, hl_error *error) {
  hl_status status = HL_OK;
  for (int i = 0; i < sweep->geometry->light_count && status == HL_OK; i++) {
    sweep_light *light = &sweep->lights[i];
    if (is_exchanged(sweep, &light->shadow))
      status = find_owned(sweep, light, hl_view_tiles(&light->shadow.buffer->view), error);
  }
  return status;
}
