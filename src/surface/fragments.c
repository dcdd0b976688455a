/* surface/fragments.c - rasterises the triangles and spheres of each tile into fragments. */
#include "surface/fragments.h"

#include <string.h>

#include "core/memory.h"
#include "mesh/mesh.h"
#include "scene/limits.h"
#include "surface/fragment_order.h"
#include "surface/primitive_bins.h"
#include "surface/sphere_coverage.h"
#include "surface/surface_cuts.h"
#include "surface/surface_plane.h"

_Static_assert(HL_LIMIT_MESHES + HL_LIMIT_VOLUMES * HL_LIMIT_ISO <= 65536, "a fragment's mesh has 16 bits");

/* The least delay, in distances of sheets: a surface along the sheets must not come to lie in an earlier slab
 * in the light's view than in the eye's, for rounding. */
static const double LEAST_DELAY = 0.02;

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
  uint32_t *places; /* owned; [sheets + 2]; for sorting */
  fragment *out;    /* owned; [out_count]; of the tiles that the thread has made */
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
  const seen_vertices *seen;
  const primitive_bins *bins;
  fragment_worker *workers; /* [threads] */
  float *least;       /* [mesh_count]; the least fraction of their opacity that meshes take of any colour */
  tile_record *tiles; /* [tiles] */
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
static uint8_t number_of_pixel(int column, int row) {
  return (uint8_t)((row / BLOCK * 4 + column / BLOCK) * BLOCK_PIXELS + row % BLOCK * BLOCK + column % BLOCK);
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

static double clamped(float opacity) { return fmin(fmax((double)opacity, 0), 1); }

/* The fraction of light that a mesh's surface stops, at the middle of a triangle. */
static float opacity_of(const surfaces *all, const surface_mesh *mesh, uint32_t primitive) {
  double opacity = mesh->scene->opacity, sum = 0;
  if (primitive >= all->triangle_count) {
    if (mesh->sphere_colors == NULL) return (float)opacity;
    return (float)(opacity *
                   clamped(mesh->sphere_colors[primitive - all->triangle_count - mesh->first_sphere][3]));
  }
  if (mesh->face_colors != NULL)
    return (float)(opacity * clamped(mesh->face_colors[primitive - mesh->first_triangle][3]));
  if (mesh->colors == NULL) return (float)opacity;
  for (int i = 0; i < 3; i++)
    sum += clamped(mesh->colors[all->triangles[primitive][i] - mesh->first_vertex][3]);
  return (float)(opacity * sum / 3);
}

/* Adds a fragment of a light's view: to the slab at its delayed height, and to those above it that the plane
 * crosses within the pixel. Where light leaves a closed mesh it lights nothing: there is no delay. Derived: n
 * slabs that take 1 - (1 - a)^(1/n) each take a together. */
static void add_of_light(const fragment_work *work, fragment_worker *worker, const surface_plane *plane,
                         fragment f, double slope) {
  const fragments_source *source = work->source;
  double spacing = source->sheets->spacing;
  double delay = plane->leaving ? 0 : source->delay * slope + LEAST_DELAY * spacing;
  double start = f.height + delay, end = fmin(f.height + source->rise * slope, plane->highest) + delay;
  int32_t first = slab_of(source, start), last = slab_of(source, end);
  if (work->least[f.mesh] < 1) last = first; /* opacities by colour cannot be shared out among slabs */
  if (last - first >= MOST_SLABS) last = first + MOST_SLABS - 1;
  if (last > first && f.opacity < 1) f.opacity = 1 - powf(1 - f.opacity, 1.0f / (float)(last - first + 1));
  for (int32_t slab = first; slab <= last; slab++) {
    f.slab = slab;
    f.height = (float)(start + (slab - first) * spacing);
    worker->scratch[worker->count++] = f;
  }
}

/* A pixel of a view, and the middle of the samples that a surface covers of it. */
typedef struct covered_pixel {
  int x, y;
  double u, v;
} covered_pixel;

static covered_pixel pixel_of(int x, int y, uint16_t samples) {
  covered_pixel pixel = {x, y, 0, 0};
  hl_fragment_middle(samples, &pixel.u, &pixel.v);
  pixel.u += x;
  pixel.v += y;
  return pixel;
}

static void add_pixel(const fragment_work *work, fragment_worker *worker, const surface_plane *plane,
                      fragment f, const covered_pixel *at) {
  const fragments_source *source = work->source;
  int column = at->x % TILE, row = at->y % TILE;
  double height = hl_plane_height(plane, at->u, at->v);
  height = fmin(fmax(height, plane->lowest), plane->highest); /* not a number: the lowest */
  f.slab = slab_of(source, height);
  f.height = (float)height;
  f.pixel = number_of_pixel(column, row);
  if (source->marks != NULL) mark(work, at->x / TILE, at->y / TILE, column, row, f.slab);
  if (f.opacity <= 0) return;
  size_t before = worker->count;
  if (source->of_light) add_of_light(work, worker, plane, f, hl_plane_slope(plane, at->u, at->v));
  else worker->scratch[worker->count++] = f;
  for (size_t i = before; source->marks != NULL && i < worker->count; i++)
    mark(work, at->x / TILE, at->y / TILE, column, row, worker->scratch[i].slab);
}

/* The part of a primitive in a tile: what its samples cover, and what cuts leave of that. */
typedef struct tile_part {
  int tile_x, tile_y;
  bool is_cut; /* cuts remove some of the primitive */
  pixel_span span;
  uint16_t covered[TILE_PIXELS];
} tile_part;

/* The next pixel of the view, after pixel number *at of the tile, of which samples are covered. */
static bool next_pixel(const view *view, const tile_part *part, const seen_part *seen, int *at, fragment *f,
                       covered_pixel *pixel) {
  const pixel_span *span = &part->span;
  int width = span->x1 - span->x0 + 1, count = width * (span->y1 - span->y0 + 1);
  for (; *at < count; ++*at) {
    int column = span->x0 + *at % width, row = span->y0 + *at / width;
    int x = part->tile_x * TILE + column, y = part->tile_y * TILE + row;
    f->samples = part->covered[row * TILE + column];
    if (f->samples == 0 || x >= view->width || y >= view->height) continue;
    f->samples = hl_left_samples(seen, x, y, f->samples);
    if (f->samples == 0) continue;
    *pixel = pixel_of(x, y, f->samples);
    ++*at;
    return true;
  }
  return false;
}

static void add_triangle(const fragment_work *work, fragment_worker *worker, tile_part *part, fragment f) {
  const fragments_source *source = work->source;
  const surface_mesh *mesh = &source->surfaces->meshes[f.mesh];
  seen_polygon polygon;
  surface_plane plane;
  covered_pixel pixel;
  int at = 0;
  hl_see_triangle(work->seen, f.primitive, &polygon);
  if (!hl_cover_tile(&polygon, part->tile_x, part->tile_y, &part->span, part->covered)) return;
  hl_plane_of_triangle(source->view, source->sheets, source->surfaces, f.primitive, &plane);
  plane.leaving = mesh->scene->mesh->closed && !mesh->is_cut &&
                  hl_plane_linear(plane.way, part->tile_x * TILE + TILE / 2, part->tile_y * TILE + TILE / 2) >
                      0;
  const seen_part seen = {part->is_cut ? source->surfaces : NULL, source->view, &plane, NULL, false};
  while (next_pixel(source->view, part, &seen, &at, &f, &pixel)) add_pixel(work, worker, &plane, f, &pixel);
}

/* The side of a sphere that rays enter or leave by. */
static void add_side(const fragment_work *work, fragment_worker *worker, const tile_part *part, fragment f,
                     bool leaving) {
  const fragments_source *source = work->source;
  const float *sphere = source->surfaces->spheres[f.primitive - source->surfaces->triangle_count];
  covered_pixel pixel;
  int at = 0;
  const seen_part seen = {part->is_cut ? source->surfaces : NULL, source->view, NULL, sphere, leaving};
  while (next_pixel(source->view, part, &seen, &at, &f, &pixel)) {
    surface_plane plane;
    vec3 point;
    if (!hl_meet_sphere(source->view, sphere, pixel.u, pixel.v, leaving, &point)) continue;
    hl_plane_of_sphere(source->view, source->sheets, sphere, point, &plane);
    plane.leaving = leaving && !part->is_cut;
    add_pixel(work, worker, &plane, f, &pixel);
  }
}

/* A view sees the far side of an opaque sphere only from within. */
static bool has_far_side(const fragment_work *work, const float sphere[4], float opacity) {
  const view *view = work->source->view;
  if (work->source->rise > 0 || opacity < 1) return true;
  vec3 away = vec3_subtract(view->origin, hl_surface_vector(sphere));
  return view->perspective && vec3_length(away) <= 1.01 * (double)sphere[3];
}

static void add_sphere(const fragment_work *work, fragment_worker *worker, tile_part *part, fragment f) {
  const fragments_source *source = work->source;
  const float *sphere = source->surfaces->spheres[f.primitive - source->surfaces->triangle_count];
  seen_bounds bounds;
  if (!hl_see_sphere(source->view, sphere, &bounds) ||
      !hl_cover_sphere(source->view, sphere, &bounds, part->tile_x, part->tile_y, &part->span, part->covered))
    return;
  add_side(work, worker, part, f, false);
  if (part->is_cut || has_far_side(work, sphere, f.opacity)) add_side(work, worker, part, f, true);
}

/* Adds a primitive's fragments in a tile. */
static void add_primitive(const fragment_work *work, fragment_worker *worker, tile_part *part,
                          size_t mesh_index, uint32_t primitive) {
  const fragments_source *source = work->source;
  const surface_mesh *mesh = &source->surfaces->meshes[mesh_index];
  if (!make_room(source->context, &worker->scratch, &worker->room,
                 worker->count + 2 * TILE_PIXELS * MOST_SLABS, 2)) {
    worker->failed = true;
    return;
  }
  cut_answer cut = hl_surface_cut(source->surfaces, mesh, primitive);
  if (cut == CUT_LEAVES_NOTHING) return;
  part->is_cut = cut == CUT_LEAVES_SOME;
  bool counts = source->of_light ? mesh->scene->casts_shadow : mesh->scene->visible;
  fragment f = {.primitive = primitive,
                .opacity = counts ? opacity_of(source->surfaces, mesh, primitive) : 0,
                .mesh = (uint16_t)mesh_index};
  if (primitive < source->surfaces->triangle_count) add_triangle(work, worker, part, f);
  else add_sphere(work, worker, part, f);
}

static void add_primitives(const fragment_work *work, fragment_worker *worker, size_t tile) {
  const surfaces *all = work->source->surfaces;
  tile_part part = {.tile_x = (int)(tile % (size_t)work->tiles_x),
                    .tile_y = (int)(tile / (size_t)work->tiles_x)};
  size_t mesh = 0;
  uint32_t end = 0; /* of the mesh's triangles, or spheres */
  for (uint32_t i = work->bins->first[tile]; i < work->bins->first[tile + 1] && !worker->failed; i++) {
    uint32_t primitive = work->bins->primitives[i];
    if (primitive >= end) {
      mesh = hl_surface_mesh_of(all, primitive);
      end = hl_surface_mesh_end(all, mesh, primitive);
    }
    add_primitive(work, worker, &part, mesh, primitive);
  }
}

static void make_tile(void *data, size_t tile, int worker_index) {
  const fragment_work *work = data;
  const fragments_source *source = work->source;
  fragment_worker *worker = &work->workers[worker_index];
  work->tiles[tile] = (tile_record){.worker = worker_index};
  worker->count = 0;
  add_primitives(work, worker, tile);
  if (worker->failed || worker->count == 0) return;
  hl_sort_by_pixel(worker->scratch, worker->scratch + worker->room, worker->count, source->falling);
  size_t kept = hl_resolve_fragments(worker->scratch, worker->count, work->least, source->rise > 0);
  hl_sort_by_slab(worker->scratch, worker->scratch + worker->room, kept, worker->places,
                  source->sheets->count);
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

uint64_t hl_fragments_bytes(const surfaces *all, const view *view, int threads, uint64_t *making) {
  uint64_t primitives = hl_surfaces_count(all),
           pixels = (uint64_t)hl_tiles(view->width) * (uint64_t)hl_tiles(view->height) * TILE_PIXELS;
  uint64_t list = (primitives + 2 * pixels) * sizeof(fragment);
  /* a thread's list grows by copies, each twice as long as the one before */
  *making = 2 * list + all->vertex_count * 2 * sizeof(int32_t) + hl_primitive_bins_bytes(all, view) +
            (uint64_t)threads * 2 * 2 * TILE_PIXELS * MOST_SLABS * sizeof(fragment);
  return list;
}

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
  for (size_t w = 0; w < threads; w++) {
    fragment_worker *worker = &work->workers[w];
    worker->places = hl_allocate(context, (size_t)work->source->sheets->count + 2, sizeof *worker->places);
    worker->failed = worker->places == NULL;
  }
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
    hl_release(context, work->workers[w].places);
    hl_release(context, work->workers[w].out);
  }
  return status;
}

/* Whether the eye sees none of a mesh's backs: it is closed, opaque, and the eye is outside. */
static bool has_hidden_backs(const fragments_source *source, const surface_mesh *mesh) {
  const hl_scene_mesh *scene = mesh->scene;
  if (source->of_light || !scene->mesh->closed || mesh->is_cut || scene->opacity < 1 ||
      mesh->colors != NULL || mesh->face_colors != NULL)
    return false;
  vec3 corner[8], eye = source->view->origin;
  if (!source->view->perspective) return true;
  hl_surface_corners(scene, 0, corner);
  for (int axis = 0; axis < 3; axis++) {
    vec3 edge = vec3_subtract(corner[1 << axis], corner[0]);
    double at = vec3_dot(vec3_subtract(eye, corner[0]), edge), length = vec3_dot(edge, edge);
    if (at < -0.01 * length || at > 1.01 * length) return true;
  }
  return false;
}

static hl_status bin_primitives(const fragments_source *source, const seen_vertices *seen,
                                primitive_bins *bins, hl_error *error) {
  const surfaces *all = source->surfaces;
  binned *wanted = hl_allocate(source->context, all->mesh_count, sizeof *wanted);
  if (wanted == NULL) return hl_fail_memory(error, all->mesh_count * sizeof *wanted, "the meshes");
  for (size_t m = 0; m < all->mesh_count; m++) {
    const surface_mesh *mesh = &all->meshes[m];
    bool seen_here = mesh->scene->visible || (source->of_light && mesh->scene->casts_shadow);
    wanted[m] = !seen_here ? BINNED_NOTHING : has_hidden_backs(source, mesh) ? BINNED_FRONTS : BINNED_ALL;
  }
  hl_status status = hl_primitive_bins_create(source->context, source->pool, seen, wanted, bins, error);
  hl_release(source->context, wanted);
  return status;
}

static void find_least(const fragments_source *source, float *least) {
  for (size_t m = 0; m < source->surfaces->mesh_count; m++) {
    const double *color = source->surfaces->meshes[m].scene->attenuation_color;
    least[m] = source->of_light ? (float)fmin(color[0], fmin(color[1], color[2])) : 1;
  }
}

static hl_status make_tiles(fragment_work *work, fragments *made, hl_error *error) {
  const fragments_source *source = work->source;
  hl_context *context = source->context;
  work->least = hl_allocate(context, source->surfaces->mesh_count, sizeof *work->least);
  made->first = hl_allocate(context, made->tiles + 1, sizeof *made->first);
  made->cursor = hl_allocate(context, made->tiles, sizeof *made->cursor);
  work->workers = hl_allocate_zeroed(context, (size_t)hl_pool_threads(source->pool), sizeof *work->workers);
  work->tiles = hl_allocate_zeroed(context, made->tiles, sizeof *work->tiles);
  hl_status status;
  if (made->first == NULL || made->cursor == NULL || work->workers == NULL || work->tiles == NULL ||
      work->least == NULL) {
    status = hl_fail_memory(error, made->tiles * sizeof *work->tiles, "the surfaces' fragments");
  } else {
    find_least(source, work->least);
    status = rasterise(work, made, error);
  }
  hl_release(context, work->least);
  hl_release(context, work->workers);
  hl_release(context, work->tiles);
  return status;
}

hl_status hl_fragments_create(const fragments_source *source, fragments *made, hl_error *error) {
  hl_context *context = source->context;
  seen_vertices seen = {0};
  primitive_bins bins = {0};
  fragment_work work = {.source = source,
                        .seen = &seen,
                        .bins = &bins,
                        .tiles_x = hl_tiles(source->view->width),
                        .tiles_y = hl_tiles(source->view->height)};
  *made = (fragments){.tiles = (size_t)work.tiles_x * (size_t)work.tiles_y};
  hl_status status = hl_seen_vertices_create(context, source->pool, source->surfaces, source->view, &seen,
                                             error);
  if (status == HL_OK) status = bin_primitives(source, &seen, &bins, error);
  if (status == HL_OK) status = make_tiles(&work, made, error);
  hl_seen_vertices_release(context, &seen);
  hl_primitive_bins_release(context, &bins);
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
