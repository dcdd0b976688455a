/* surface/fragments.c - rasterises the triangles of each tile, sorts their fragments, and finds what each
 * takes of the light that reaches it. */
#include "surface/fragments.h"

#include <string.h>

#include "core/memory.h"
#include "mesh/mesh.h"
#include "surface/coverage.h"

/* What is left of a pixel's light below which fragments behind are left out: as matter behind opaque pixels.
 */
static const float NOTHING_LEFT = 1.0f / 2048;

/* ---- heights ---- */

/* The height at which a view's rays meet a triangle's plane n.X = d, linear functions of the pixel (derived:
 * the ray A + s B meets it at s = (d - n.A) / (n.B), at the height h.A + s h.B). In a perspective view A is
 * the eye and B depends on the pixel, else the other way round. */
typedef struct triangle_plane {
  double rise[3], way[3], above[3], climb[3]; /* d - n.A, n.B, h.A, h.B: for pixel (0, 0), and by u and v */
  double lowest, highest;                     /* of the triangle; above the first sheet */
  bool leaving;                               /* the view's rays leave a closed mesh here */
} triangle_plane;

static double linear(const double f[3], double u, double v) { return f[0] + f[1] * u + f[2] * v; }

static void set_linear(double f[3], vec3 normal, vec3 at, vec3 by_u, vec3 by_v) {
  f[0] = vec3_dot(normal, at), f[1] = vec3_dot(normal, by_u), f[2] = vec3_dot(normal, by_v);
}

static void plane_of_triangle(const fragments_source *source, uint32_t triangle, triangle_plane *plane) {
  const view *view = source->view;
  const uint32_t *corner = source->surfaces->triangles[triangle];
  vec3 zero = {0, 0, 0}, h = source->sheets->normal, point[3];
  for (int i = 0; i < 3; i++) point[i] = hl_surface_vector(source->surfaces->positions[corner[i]]);
  vec3 n = vec3_normalise(vec3_cross(vec3_subtract(point[1], point[0]), vec3_subtract(point[2], point[0])));
  vec3 a = view->perspective ? view->origin : view->corner,
       b = view->perspective ? view->corner : view->direction;
  vec3 au = view->perspective ? zero : view->du, av = view->perspective ? zero : view->dv;
  vec3 bu = view->perspective ? view->du : zero, bv = view->perspective ? view->dv : zero;
  set_linear(plane->rise, vec3_scale(n, -1), vec3_subtract(a, point[0]), au, av);
  set_linear(plane->way, n, b, bu, bv);
  set_linear(plane->above, h, a, au, av);
  set_linear(plane->climb, h, b, bu, bv);
  plane->above[0] -= source->sheets->first;
  plane->lowest = INFINITY, plane->highest = -INFINITY;
  for (int i = 0; i < 3; i++) {
    double height = vec3_dot(h, point[i]) - source->sheets->first;
    plane->lowest = fmin(plane->lowest, height);
    plane->highest = fmax(plane->highest, height);
  }
}

static double height_at(const triangle_plane *plane, double u, double v) {
  return linear(plane->above, u, v) +
         linear(plane->rise, u, v) / linear(plane->way, u, v) * linear(plane->climb, u, v);
}

/* How steep a surface may be, in frame units for each pixel: one that light almost grazes would be delayed
 * without end, and it is hardly lit. */
static const double STEEPEST = 12;

/* The least delay, in distances of sheets: a surface along the sheets must not come to lie in an earlier slab
 * in the light's view than in the eye's, for rounding. */
static const double LEAST_DELAY = 0.02;

/* How much a plane's height changes from pixel to pixel. */
static double slope_of(const triangle_plane *plane, double u, double v) {
  double height = height_at(plane, u, v);
  double slope = fabs(height_at(plane, u + 1, v) - height) + fabs(height_at(plane, u, v + 1) - height);
  return slope < STEEPEST ? slope : STEEPEST; /* not a number: the steepest */
}

void hl_fragment_middle(uint16_t samples, double *u, double *v) {
  int count = 0, x = 0, y = 0;
  for (uint32_t left = samples; left != 0; left &= left - 1) {
    int s = __builtin_ctz(left);
    count++;
    x += s;
    y += hl_sample_row[s];
  }
  *u = ((double)x / count + 0.5) / FRAGMENT_SAMPLES;
  *v = ((double)y / count + 0.5) / FRAGMENT_SAMPLES;
}

/* ---- a tile ---- */

enum { MOST_SLABS = 16 }; /* that a fragment fills */

/* One thread's memory. */
typedef struct fragment_worker {
  _Alignas(64) fragment *scratch; /* owned; [2][room]; a tile's fragments, and room to sort them */
  size_t count, room;
  fragment *out; /* owned; [out_count]; of the tiles that the thread has made */
  size_t out_count, out_room;
  bool failed;
} fragment_worker;

typedef struct tile_record {
  int worker;
  uint32_t count;
  size_t at; /* in the worker's out */
} tile_record;

typedef struct fragment_work {
  const fragments_source *source;
  const triangle_bins *bins;
  fragment_worker *workers; /* [threads] */
  tile_record *tiles;       /* [tiles] */
  int tiles_x, tiles_y;
} fragment_work;

static bool make_room(hl_context *context, fragment **list, size_t *room, size_t wanted, int copies) {
  if (wanted <= *room) return true;
  size_t larger = wanted > 2 * *room ? wanted : 2 * *room;
  fragment *grown = hl_reallocate(context, *list, larger * (size_t)copies, sizeof **list);
  if (grown == NULL) return false;
  *list = grown;
  *room = larger;
  return true;
}

/* The pixel's number, block after block. */
static uint16_t number_of_pixel(int column, int row) {
  return (uint16_t)((row / BLOCK * 4 + column / BLOCK) * BLOCK_PIXELS + row % BLOCK * BLOCK + column % BLOCK);
}

static int32_t slab_of(const fragments_source *source, double height) {
  double sheet = ceil(height / source->sheets->spacing);
  return (int32_t)fmin(fmax(sheet, 1), source->sheets->count - 1);
}

/* Marks a slab of a tile, and of tiles that look-ups around the pixel may read. */
static void mark(const fragment_work *work, int tile_x, int tile_y, int column, int row, int32_t slab) {
  const fragments_source *source = work->source;
  int left = column < 3 ? -1 : 0, right = column >= TILE - 3 ? 1 : 0, up = row < 3 ? -1 : 0,
      down = row >= TILE - 3 ? 1 : 0;
  for (int y = tile_y + up; y <= tile_y + down; y++)
    for (int x = tile_x + left; x <= tile_x + right; x++) {
      if (x < 0 || y < 0 || x >= work->tiles_x || y >= work->tiles_y) continue;
      size_t tile = (size_t)y * (size_t)work->tiles_x + (size_t)x;
      uint64_t *word = source->marks + (size_t)slab * (size_t)source->tile_words + tile / 64;
      uint64_t bit = (uint64_t)1 << tile % 64;
      if ((__atomic_load_n(word, __ATOMIC_RELAXED) & bit) == 0)
        __atomic_fetch_or(word, bit, __ATOMIC_RELAXED);
    }
}

/* The fraction that a mesh's surface stops at the middle of a triangle. */
static float opacity_of(const surfaces *all, const surface_mesh *mesh, uint32_t triangle) {
  double opacity = mesh->scene->opacity;
  if (mesh->colors == NULL) return (float)opacity;
  double sum = 0;
  for (int i = 0; i < 3; i++)
    sum += fmin(fmax(mesh->colors[all->triangles[triangle][i] - mesh->first_vertex][3], 0), 1);
  return (float)(opacity * sum / 3);
}

/* Adds a fragment of a light's view: to the slab at its delayed height, and to those above it that the plane
 * crosses within the pixel. Where light leaves a closed mesh it lights nothing: there is no delay. Derived: n
 * slabs that take 1 - (1 - a)^(1/n) each take a together. */
static void add_of_light(const fragment_work *work, fragment_worker *worker, const triangle_plane *plane,
                         fragment f, double slope) {
  const fragments_source *source = work->source;
  double spacing = source->sheets->spacing;
  double delay = plane->leaving ? 0 : source->delay * slope + LEAST_DELAY * spacing;
  double start = f.height + delay, end = fmin(f.height + source->rise * slope, plane->highest) + delay;
  int32_t first = slab_of(source, start), last = slab_of(source, end);
  if (last - first >= MOST_SLABS) last = first + MOST_SLABS - 1;
  if (last > first && f.opacity < 1) f.opacity = 1 - powf(1 - f.opacity, 1.0f / (float)(last - first + 1));
  for (int32_t slab = first; slab <= last; slab++) {
    f.slab = slab;
    f.height = (float)(start + (slab - first) * spacing);
    worker->scratch[worker->count++] = f;
  }
}

static void add_pixel(const fragment_work *work, fragment_worker *worker, const triangle_plane *plane,
                      fragment f, int x, int y) {
  const fragments_source *source = work->source;
  int column = x % TILE, row = y % TILE;
  double u, v;
  hl_fragment_middle(f.samples, &u, &v);
  double height = height_at(plane, x + u, y + v);
  height = fmin(fmax(height, plane->lowest), plane->highest); /* not a number: the lowest */
  f.slab = slab_of(source, height);
  f.height = (float)height;
  f.pixel = number_of_pixel(column, row);
  if (source->marks != NULL) mark(work, x / TILE, y / TILE, column, row, f.slab);
  if (f.opacity <= 0) return;
  size_t before = worker->count;
  if (source->of_light) add_of_light(work, worker, plane, f, slope_of(plane, x + u, y + v));
  else worker->scratch[worker->count++] = f;
  for (size_t i = before; source->marks != NULL && i < worker->count; i++)
    mark(work, x / TILE, y / TILE, column, row, worker->scratch[i].slab);
}

/* Adds a triangle's fragments in a tile. */
static void add_triangle(const fragment_work *work, fragment_worker *worker, int tile_x, int tile_y,
                         uint32_t triangle) {
  const fragments_source *source = work->source;
  const surface_mesh *mesh = hl_surface_of(source->surfaces, triangle);
  seen_polygon polygon;
  uint16_t covered[TILE_PIXELS];
  pixel_span span;
  triangle_plane plane;
  hl_see_triangle(source->view, source->surfaces, triangle, &polygon);
  if (!hl_cover_tile(&polygon, tile_x, tile_y, &span, covered)) return;
  if (!make_room(source->context, &worker->scratch, &worker->room, worker->count + TILE_PIXELS * MOST_SLABS,
                 2)) {
    worker->failed = true;
    return;
  }
  plane_of_triangle(source, triangle, &plane);
  plane.leaving = mesh->scene->mesh->closed &&
                  linear(plane.way, tile_x * TILE + TILE / 2, tile_y * TILE + TILE / 2) > 0;
  bool counts = source->of_light ? mesh->scene->casts_shadow : mesh->scene->visible;
  fragment f = {.triangle = triangle, .opacity = counts ? opacity_of(source->surfaces, mesh, triangle) : 0};
  for (int row = span.y0; row <= span.y1; row++)
    for (int column = span.x0; column <= span.x1; column++) {
      int x = tile_x * TILE + column, y = tile_y * TILE + row;
      f.samples = covered[row * TILE + column];
      if (f.samples != 0 && x < source->view->width && y < source->view->height)
        add_pixel(work, worker, &plane, f, x, y);
    }
}

/* ---- sorting ---- */

/* Which of two fragments comes first: below 0 for a. */
typedef int fragment_order(const fragment *a, const fragment *b);

static int by_pixel_rising(const fragment *a, const fragment *b) {
  if (a->pixel != b->pixel) return (int)a->pixel - (int)b->pixel;
  if (a->height != b->height) return a->height < b->height ? -1 : 1;
  return a->triangle < b->triangle ? -1 : a->triangle > b->triangle;
}

static int by_pixel_falling(const fragment *a, const fragment *b) {
  if (a->pixel != b->pixel) return (int)a->pixel - (int)b->pixel;
  if (a->height != b->height) return a->height > b->height ? -1 : 1;
  return a->triangle < b->triangle ? -1 : a->triangle > b->triangle;
}

static int by_slab(const fragment *a, const fragment *b) {
  return a->slab != b->slab ? (a->slab < b->slab ? -1 : 1) : by_pixel_rising(a, b);
}

/* Merges the sorted runs [0, middle) and [middle, count) of `from` into `to`. */
static void merge(const fragment *from, size_t middle, size_t count, fragment *to, fragment_order *order) {
  size_t a = 0, b = middle;
  for (size_t i = 0; i < count; i++) {
    bool first = b == count || (a < middle && order(&from[a], &from[b]) <= 0);
    to[i] = first ? from[a++] : from[b++];
  }
}

/* Sorts by merging, which takes no other memory than `spare`, as large as the list. */
static void sort(fragment *list, fragment *spare, size_t count, fragment_order *order) {
  fragment *from = list, *to = spare;
  for (size_t run = 1; run < count; run *= 2) {
    for (size_t at = 0; at < count; at += 2 * run) {
      size_t left = count - at, both = left < 2 * run ? left : 2 * run;
      merge(from + at, run < both ? run : both, both, to + at, order);
    }
    fragment *swapped = from;
    from = to;
    to = swapped;
  }
  if (from != list) memcpy(list, from, count * sizeof *list);
}

/* Finds the opacities of one pixel's fragments, which are in the order that the light or the eye meets them.
 * Those that take nothing get opacity 0. */
static void resolve_pixel(fragment *list, size_t count) {
  float left[FRAGMENT_SAMPLES], sum = FRAGMENT_SAMPLES;
  for (int s = 0; s < FRAGMENT_SAMPLES; s++) left[s] = 1;
  for (size_t i = 0; i < count; i++) {
    float own = list[i].opacity, taken = 0, after = 0;
    for (int s = 0; s < FRAGMENT_SAMPLES; s++) {
      float part = list[i].samples >> s & 1 ? left[s] * own : 0;
      taken += part;
      left[s] -= part;
      after += left[s];
    }
    bool reached = sum > NOTHING_LEFT * FRAGMENT_SAMPLES;
    list[i].opacity = !reached ? 0 : after <= 0 ? 1 : taken / sum < 1 ? taken / sum : 1;
    sum = after;
  }
}

/* The same for a light's view whose buffer is also used for rays of other directions. A pixel that opaque
 * surfaces cover in a slab is opaque there, even where surfaces before it have taken all light of the view's
 * own ray: the other rays pass these by. Fragments of one slab become one; returns how many are left. */
static size_t resolve_slabs(fragment *list, size_t count) {
  size_t kept = 0;
  uint32_t covered = 0;
  for (size_t i = 0; i < count; i++) {
    bool begins = i == 0 || list[i].slab != list[i - 1].slab;
    covered = (begins ? 0 : covered) | (list[i].opacity >= 1 ? list[i].samples : 0u);
    list[i].triangle = covered == 0xffff; /* of a light's fragments the triangle is not asked for any more */
  }
  resolve_pixel(list, count);
  for (size_t i = 0; i < count; i++) {
    if (list[i].triangle) list[i].opacity = 1;
    if (kept > 0 && list[kept - 1].slab == list[i].slab)
      list[kept - 1].opacity = 1 - (1 - list[kept - 1].opacity) * (1 - list[i].opacity);
    else list[kept++] = list[i];
  }
  return kept;
}

static size_t resolve(fragment *list, size_t count, bool slabs) {
  size_t kept = 0;
  for (size_t i = 0, end; i < count; i = end) {
    for (end = i + 1; end < count && list[end].pixel == list[i].pixel;) end++;
    size_t left = end - i;
    if (slabs) left = resolve_slabs(list + i, left);
    else resolve_pixel(list + i, left);
    for (size_t k = i; k < i + left; k++)
      if (list[k].opacity > 0) list[kept++] = list[k];
  }
  return kept;
}

static void make_tile(void *data, size_t tile, int worker_index) {
  const fragment_work *work = data;
  const fragments_source *source = work->source;
  fragment_worker *worker = &work->workers[worker_index];
  int tile_x = (int)(tile % (size_t)work->tiles_x), tile_y = (int)(tile / (size_t)work->tiles_x);
  work->tiles[tile] = (tile_record){.worker = worker_index};
  worker->count = 0;
  for (uint32_t i = work->bins->first[tile]; i < work->bins->first[tile + 1] && !worker->failed; i++)
    add_triangle(work, worker, tile_x, tile_y, work->bins->triangles[i]);
  if (worker->failed || worker->count == 0) return;
  sort(worker->scratch, worker->scratch + worker->room, worker->count,
       source->falling ? by_pixel_falling : by_pixel_rising);
  size_t kept = resolve(worker->scratch, worker->count, source->rise > 0);
  sort(worker->scratch, worker->scratch + worker->room, kept, by_slab);
  if (!make_room(source->context, &worker->out, &worker->out_room, worker->out_count + kept, 1)) {
    worker->failed = true;
    return;
  }
  memcpy(worker->out + worker->out_count, worker->scratch, kept * sizeof *worker->out);
  work->tiles[tile].at = worker->out_count;
  work->tiles[tile].count = (uint32_t)kept;
  worker->out_count += kept;
}

/* ---- a view ---- */

/* Brings the tiles' fragments together, in the order of the tiles. */
static hl_status gather(const fragment_work *work, fragments *made, hl_error *error) {
  hl_context *context = work->source->context;
  uint64_t sum = 0;
  for (size_t tile = 0; tile < made->tiles; tile++) {
    made->first[tile] = made->cursor[tile] = (uint32_t)sum;
    sum += work->tiles[tile].count;
  }
  made->first[made->tiles] = (uint32_t)sum;
  if (sum <= UINT32_MAX) made->list = hl_allocate(context, sum, sizeof *made->list);
  if (made->list == NULL) return hl_fail_memory(error, sum * sizeof *made->list, "the surfaces' fragments");
  for (size_t tile = 0; tile < made->tiles; tile++) {
    const tile_record *record = &work->tiles[tile];
    if (record->count > 0)
      memcpy(made->list + made->first[tile], work->workers[record->worker].out + record->at,
             record->count * sizeof *made->list);
  }
  return HL_OK;
}

static hl_status rasterise(fragment_work *work, fragments *made, hl_error *error) {
  hl_context *context = work->source->context;
  size_t threads = (size_t)hl_pool_threads(work->source->pool);
  bool room = true;
  hl_pool_run(work->source->pool, made->tiles, make_tile, work);
  for (size_t w = 0; w < threads; w++) room = room && !work->workers[w].failed;
  hl_status status = HL_OK;
  if (hl_pool_cancelled(work->source->pool))
    status = hl_fail(error, HL_ERROR_CANCELLED, "cancelled while rendering");
  else
    status = room ? gather(work, made, error)
                  : hl_fail_memory(error, sizeof(fragment), "the surfaces' fragments");
  for (size_t w = 0; w < threads; w++) {
    hl_release(context, work->workers[w].scratch);
    hl_release(context, work->workers[w].out);
  }
  return status;
}

static hl_status bin_triangles(const fragments_source *source, triangle_bins *bins, hl_error *error) {
  const surfaces *all = source->surfaces;
  bool *wanted = hl_allocate(source->context, all->mesh_count, sizeof *wanted);
  if (wanted == NULL) return hl_fail_memory(error, all->mesh_count, "the meshes");
  for (size_t m = 0; m < all->mesh_count; m++)
    wanted[m] = all->meshes[m].scene->visible || (source->of_light && all->meshes[m].scene->casts_shadow);
  hl_status status = hl_triangle_bins_create(source->context, source->pool, all, source->view, wanted, bins,
                                             error);
  hl_release(source->context, wanted);
  return status;
}

hl_status hl_fragments_create(const fragments_source *source, fragments *made, hl_error *error) {
  hl_context *context = source->context;
  triangle_bins bins = {0};
  fragment_work work = {
      source, &bins, NULL, NULL, hl_tiles(source->view->width), hl_tiles(source->view->height)};
  *made = (fragments){.tiles = (size_t)work.tiles_x * (size_t)work.tiles_y};
  hl_status status = bin_triangles(source, &bins, error);
  if (status != HL_OK) return status;
  made->first = hl_allocate(context, made->tiles + 1, sizeof *made->first);
  made->cursor = hl_allocate(context, made->tiles, sizeof *made->cursor);
  work.workers = hl_allocate_zeroed(context, (size_t)hl_pool_threads(source->pool), sizeof *work.workers);
  work.tiles = hl_allocate_zeroed(context, made->tiles, sizeof *work.tiles);
  if (made->first == NULL || made->cursor == NULL || work.workers == NULL || work.tiles == NULL)
    status = hl_fail_memory(error, made->tiles * sizeof *work.tiles, "the surfaces' fragments");
  else status = rasterise(&work, made, error);
  hl_release(context, work.workers);
  hl_release(context, work.tiles);
  hl_triangle_bins_release(context, &bins);
  if (status != HL_OK) hl_fragments_release(context, made);
  return status;
}

void hl_fragments_release(hl_context *context, fragments *made) {
  hl_release(context, made->list);
  hl_release(context, made->first);
  hl_release(context, made->cursor);
  *made = (fragments){0};
}

fragment_range hl_fragments_reach(const fragments *all, size_t tile, int slab) {
  uint32_t end = all->first[tile + 1], at = all->cursor[tile];
  while (at < end && all->list[at].slab < slab) at++;
  fragment_range range = {all->list + at, 0};
  while (at < end && all->list[at].slab == slab) at++, range.count++;
  all->cursor[tile] = at;
  return range;
}
