/* surface/tile_fragments.c - see tile_fragments.h. */
#include "surface/tile_fragments.h"

#include <string.h>

#include "core/memory.h"
#include "mesh/mesh.h"
#include "surface/crossings.h"
#include "surface/sphere_coverage.h"
#include "surface/surface_cuts.h"
#include "surface/surface_plane.h"

/* Room for so many more fragments of a tile. */
static bool make_room(hl_context *context, fragment_worker *worker, size_t more) {
  size_t wanted = worker->count + more;
  if (wanted <= worker->room) return true;
  size_t larger = wanted > 2 * worker->room ? wanted : 2 * worker->room;
  fragment *scratch = hl_reallocate(context, worker->scratch, larger * 2, sizeof *scratch);
  if (scratch != NULL) worker->scratch = scratch;
  order_key *keys = scratch != NULL ? hl_reallocate(context, worker->keys, larger * 2, sizeof *keys) : NULL;
  worker->failed = keys == NULL;
  if (worker->failed) return false;
  worker->keys = keys;
  worker->room = larger;
  return true;
}

/* Fragments of a thread's first block, and the most of one whose tiles are smaller (6 MiB): each block is
 * twice as large as the one before. */
enum { FIRST_BLOCK = 1 << 12, GREATEST_BLOCK = 1 << 18 };

/* Room for a tile's fragments in one block. */
static bool make_room_for_tile(hl_context *context, fragment_worker *worker, size_t more) {
  fragment_block *before = worker->out;
  if (before != NULL && more <= before->room - before->count) return true;
  size_t room = before == NULL ? FIRST_BLOCK : 2 * before->room;
  room = room < GREATEST_BLOCK ? room : GREATEST_BLOCK;
  room = room > more ? room : more;
  fragment_block *block = hl_allocate(context, sizeof *block + room * sizeof *block->list, 1);
  worker->failed = block == NULL;
  if (worker->failed) return false;
  *block = (fragment_block){.before = before, .room = room};
  worker->out = block;
  return true;
}

void hl_fragment_blocks_release(hl_context *context, fragment_block *latest) {
  while (latest != NULL) {
    fragment_block *before = latest->before;
    hl_release(context, latest);
    latest = before;
  }
}

/* Marks a slab about a pixel, block after block. */
static void mark(const fragment_work *work, fragment_worker *worker, int pixel, int32_t slab) {
  worker->near[slab] |= work->near[pixel];
  worker->nearest = slab < worker->nearest ? slab : worker->nearest;
  worker->farthest = slab > worker->farthest ? slab : worker->farthest;
}

static void mark_tile(const fragment_work *work, int x, int y, int32_t slab) {
  const fragments_source *source = work->source;
  if (x < 0 || y < 0 || x >= work->tiles_x || y >= work->tiles_y) return;
  size_t tile = (size_t)y * (size_t)work->tiles_x + (size_t)x;
  uint64_t *word = source->marks + (size_t)slab * (size_t)source->tile_words + tile / 64;
  uint64_t bit = (uint64_t)1 << tile % 64;
  if ((__atomic_load_n(word, __ATOMIC_RELAXED) & bit) == 0) __atomic_fetch_or(word, bit, __ATOMIC_RELAXED);
}

/* Writes the marks about a tile's pixels, and clears the worker's. */
static void write_marks(const fragment_work *work, fragment_worker *worker, int tile_x, int tile_y) {
  for (int32_t slab = worker->nearest; slab <= worker->farthest; slab++) {
    uint32_t near = work->source->marks != NULL ? worker->near[slab] : 0;
    for (; near != 0; near &= near - 1) {
      int beside = __builtin_ctz(near);
      mark_tile(work, tile_x + beside % 3 - 1, tile_y + beside / 3 - 1, slab);
    }
    worker->near[slab] = 0;
  }
  worker->nearest = INT32_MAX;
  worker->farthest = -1;
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

/* Adds the samples of an opaque fragment to those that its pixel got last, where both are of one mesh and
 * fill the same slabs: there they take what one surface takes. Returns whether it did. */
static bool join_latest(fragment_worker *worker, const fragment *f, int32_t first, int32_t last) {
  latest_fragments *latest = &worker->latest[f->pixel];
  fragment *own = worker->scratch + latest->end - 1;
  if (latest->end > 0 && own->mesh == f->mesh && own->slab == first && latest->last == last) {
    for (int32_t i = 0; i <= last - first; i++) own[i].samples |= f->samples;
    return true;
  }
  *latest = (latest_fragments){(uint32_t)worker->count + 1, last};
  return false;
}

/* Remembers what an opaque fragment covers of its pixel from a height on. */
static void cover_pixel(fragment_worker *worker, const fragment *f, double height) {
  covered_so_far *covered = &worker->covered[f->pixel];
  if (covered->samples == 0xffff) return;
  if (covered->samples == 0 || (double)covered->height < height) covered->height = (float)height;
  covered->samples |= f->samples;
}

/* Adds a fragment to the slabs first to last of a light's view, from its delayed height on. Derived: n slabs
 * that take 1 - (1 - a)^(1/n) each take a together. */
static void add_to_slabs(const fragment_work *work, fragment_worker *worker, fragment f, double start,
                         int32_t first, int32_t last) {
  if (work->least[f.mesh] < 1) last = first; /* opacities by colour cannot be shared out among slabs */
  if (last - first >= MOST_SLABS) last = first + MOST_SLABS - 1;
  if (f.opacity >= 1 && work->least[f.mesh] >= 1) {
    cover_pixel(worker, &f, start);
    if (join_latest(worker, &f, first, last)) return;
  }
  if (last > first && f.opacity < 1) f.opacity = 1 - powf(1 - f.opacity, 1.0f / (float)(last - first + 1));
  for (int32_t slab = first; slab <= last; slab++) {
    f.slab = slab;
    f.height = (float)(start + (slab - first) * work->source->sheets->spacing);
    worker->scratch[worker->count++] = f;
    mark(work, worker, f.pixel, slab);
  }
}

/* Adds a fragment of a light's view: to the slab at its delayed height, and to those above it that the plane
 * crosses within the pixel. Where the backs are dark there is no delay. */
static void add_of_light(const fragment_work *work, fragment_worker *worker, const surface_plane *plane,
                         fragment f, double slope) {
  const fragments_source *source = work->source;
  double delay = plane->leaving ? 0 : source->delay * slope + LEAST_DELAY * source->sheets->spacing;
  double start = f.height + delay, highest = plane->highest + SEAM * source->sheets->spacing,
         end = fmin(f.height + source->rise * slope, highest) + delay;
  add_to_slabs(work, worker, f, start, hl_slab_of(source->sheets, start), hl_slab_of(source->sheets, end));
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
  double height = hl_plane_height(plane, at->u, at->v);
  height = fmin(fmax(height, plane->lowest), plane->highest); /* not a number: the lowest */
  f.slab = hl_slab_of(source->sheets, height);
  f.height = (float)height;
  f.pixel = (uint8_t)hl_pixel_number(at->x % TILE, at->y % TILE);
  mark(work, worker, f.pixel, f.slab);
  if (f.opacity <= 0) return;
  double slope = hl_plane_slope(plane, at->u, at->v);
  if (source->of_light) {
    add_of_light(work, worker, plane, f, slope);
    return;
  }
  double range = plane->highest - plane->lowest,
         reach = slope < STEEPEST_SLOPE && slope < range ? slope : range;
  f.reach = hl_told_reach(reach / source->sheets->spacing);
  worker->scratch[worker->count++] = f;
}

/* The part of a primitive in a tile: what its samples cover, and what cuts leave of that. */
typedef struct tile_part {
  int tile_x, tile_y;
  bool is_cut; /* cuts remove some of the primitive */
  pixel_span span;
  uint16_t covered[TILE_PIXELS];
} tile_part;

/* The next pixel of the view, from the tile's column at[0] and row at[1] on, of which samples are covered. */
static bool next_pixel(const view *view, const tile_part *part, const seen_part *seen, int at[2], fragment *f,
                       covered_pixel *pixel) {
  const pixel_span *span = &part->span;
  for (; at[1] <= span->y1; at[0] = span->x0, at[1]++)
    for (; at[0] <= span->x1; at[0]++) {
      int x = part->tile_x * TILE + at[0], y = part->tile_y * TILE + at[1];
      f->samples = part->covered[at[1] * TILE + at[0]];
      if (f->samples == 0 || x >= view->width || y >= view->height) continue;
      f->samples = hl_left_samples(seen, x, y, f->samples);
      if (f->samples == 0) continue;
      *pixel = pixel_of(x, y, f->samples);
      at[0]++;
      return true;
    }
  return false;
}

static void add_triangle(const fragment_work *work, fragment_worker *worker, tile_part *part, fragment f) {
  const fragments_source *source = work->source;
  seen_polygon polygon;
  surface_plane plane;
  covered_pixel pixel;
  hl_see_triangle(work->seen, f.primitive, &polygon);
  if (!hl_cover_tile(&polygon, part->tile_x, part->tile_y, &part->span, part->covered)) return;
  int at[2] = {part->span.x0, part->span.y0};
  hl_plane_of_triangle(source->view, source->sheets, source->surfaces, f.primitive, &plane);
  plane.leaving = work->dark_backs[f.mesh] && hl_plane_linear(plane.way, part->tile_x * TILE + TILE / 2,
                                                              part->tile_y * TILE + TILE / 2) > 0;
  const seen_part seen = {part->is_cut ? source->surfaces : NULL, source->view, &plane, NULL, false};
  while (next_pixel(source->view, part, &seen, at, &f, &pixel)) add_pixel(work, worker, &plane, f, &pixel);
}

/* Whether a light lights nothing of a sphere from within: no light passes it, and the light is outside. */
static bool has_dark_inside(const fragment_work *work, const float sphere[4], const fragment *f) {
  const view *view = work->source->view;
  if (f->opacity < 1 || work->least[f->mesh] < 1) return false;
  vec3 away = vec3_subtract(view->origin, hl_surface_vector(sphere));
  return !view->perspective || vec3_length(away) > (double)sphere[3];
}

/* The side of a sphere that rays enter or leave by. */
static void add_side(const fragment_work *work, fragment_worker *worker, const tile_part *part, fragment f,
                     bool leaving) {
  const fragments_source *source = work->source;
  const float *sphere = source->surfaces->spheres[f.primitive - source->surfaces->triangle_count];
  covered_pixel pixel;
  int at[2] = {part->span.x0, part->span.y0};
  bool dark = leaving && !part->is_cut && has_dark_inside(work, sphere, &f);
  const seen_part seen = {part->is_cut ? source->surfaces : NULL, source->view, NULL, sphere, leaving};
  const sphere_rays rays = hl_sphere_rays(source->view, sphere);
  surface_plane plane;
  hl_plane_begin(source->view, source->sheets, &plane);
  plane.leaving = dark;
  while (next_pixel(source->view, part, &seen, at, &f, &pixel)) {
    vec3 point;
    if (!hl_meet_sphere(&rays, pixel.u, pixel.v, leaving, &point)) continue;
    hl_plane_touch_sphere(source->view, source->sheets, sphere, point, &plane);
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

static fragment fragment_of(const fragment_work *work, size_t mesh_index, uint32_t primitive) {
  const fragments_source *source = work->source;
  const surface_mesh *mesh = &source->surfaces->meshes[mesh_index];
  bool counts = source->of_light || source->unseen ? mesh->scene->casts_shadow : mesh->scene->visible;
  return (fragment){.primitive = primitive,
                    .opacity = counts ? opacity_of(source->surfaces, mesh, primitive) : 0,
                    .mesh = (uint16_t)mesh_index};
}

/* Adds a primitive's fragments in a tile. */
static void add_primitive(const fragment_work *work, fragment_worker *worker, tile_part *part,
                          size_t mesh_index, uint32_t primitive) {
  if (!make_room(work->source->context, worker, 2 * TILE_PIXELS * MOST_SLABS)) return;
  const surfaces *all = work->source->surfaces;
  cut_answer cut = hl_surface_cut(all, &all->meshes[mesh_index], primitive);
  if (cut == CUT_LEAVES_NOTHING) return;
  part->is_cut = cut == CUT_LEAVES_SOME;
  fragment f = fragment_of(work, mesh_index, primitive);
  if (primitive < work->source->surfaces->triangle_count) add_triangle(work, worker, part, f);
  else add_sphere(work, worker, part, f);
}

/* ---- small triangles ---- */

static int least(int a, int b) { return a < b ? a : b; }
static int greatest(int a, int b) { return a > b ? a : b; }

/* Up to sixteen triangles, or spheres, of one mesh. */
typedef struct small_batch {
  small_triangles triangles;
  small_spheres spheres;
  small_cover cover;
  small_view view;
  uint32_t primitives[SMALL_TRIANGLES];
  float opacity[SMALL_TRIANGLES];
  int count;
  bool of_spheres;
  size_t mesh;
  bool may_be_covered; /* of a light's view: clusters may lie behind what covers all of their pixels */
} small_batch;

/* Adds a triangle to a batch; false where the view or the scene's cuts cut it. */
static bool collect(const fragment_work *work, const tile_part *part, small_batch *batch,
                    uint32_t primitive) {
  const surfaces *all = work->source->surfaces;
  const uint32_t *vertex = all->triangles[primitive];
  int32_t left = part->tile_x * TILE * SUBPIXELS, top = part->tile_y * TILE * SUBPIXELS;
  int lane = batch->count;
  const float *n = batch->view.normal, *corner[3];
  float normal[3];
  if (hl_surface_cut(all, &all->meshes[batch->mesh], primitive) != CUT_LEAVES_ALL) return false;
  for (int i = 0; i < 3; i++) {
    int32_t at[2];
    if (!hl_see_vertex(work->seen, vertex[i], at)) return false;
    corner[i] = all->positions[vertex[i]];
    batch->triangles.x[i][lane] = at[0] - left;
    batch->triangles.y[i][lane] = at[1] - top;
    batch->triangles.height[i][lane] = n[0] * corner[i][0] + n[1] * corner[i][1] + n[2] * corner[i][2] -
                                       batch->view.first;
  }
  hl_corner_product(corner, normal);
  for (int axis = 0; axis < 3; axis++) {
    batch->triangles.normal[axis][lane] = normal[axis];
    batch->triangles.corner[axis][lane] = corner[0][axis];
  }
  batch->primitives[batch->count++] = primitive;
  return true;
}

/* Adds a sphere to a batch; false where the scene's cuts may cut it, where light passes it, or where its
 * fragments may fill several slabs. */
static bool collect_sphere(const fragment_work *work, small_batch *batch, uint32_t primitive) {
  const surfaces *all = work->source->surfaces;
  const surface_mesh *mesh = &all->meshes[batch->mesh];
  const float *sphere = all->spheres[primitive - all->triangle_count];
  if (mesh->is_cut || work->source->rise > 0 || opacity_of(all, mesh, primitive) < 1) return false;
  for (int axis = 0; axis < 3; axis++) batch->spheres.centre[axis][batch->count] = sphere[axis];
  batch->spheres.radius[batch->count] = sphere[3];
  batch->primitives[batch->count++] = primitive;
  return true;
}

/* Adds what triangle number `lane` of a batch covers of its pixel number k. */
static void add_small_pixel(const fragment_work *work, fragment_worker *worker, const small_batch *batch,
                            int lane, int k) {
  const small_cover *cover = &batch->cover;
  const fragment f = {.height = cover->height[k][lane],
                      .opacity = batch->opacity[lane],
                      .primitive = batch->primitives[lane],
                      .slab = cover->slab[k][lane],
                      .samples = cover->samples[k][lane],
                      .mesh = (uint16_t)batch->mesh,
                      .pixel = (uint8_t)cover->pixel[k][lane],
                      .reach = (uint8_t)cover->reach[k][lane]};
  mark(work, worker, f.pixel, f.slab);
  if (f.opacity <= 0) return;
  if (work->source->of_light) {
    add_to_slabs(work, worker, f, (double)cover->start[k][lane], cover->first_slab[k][lane],
                 cover->last_slab[k][lane]);
    return;
  }
  worker->scratch[worker->count++] = f;
}

/* The opacities of the triangles in `lanes`. */
static void find_opacities(const fragment_work *work, small_batch *batch, uint32_t lanes) {
  for (; lanes != 0; lanes &= lanes - 1) {
    int lane = __builtin_ctz(lanes);
    batch->opacity[lane] = fragment_of(work, batch->mesh, batch->primitives[lane]).opacity;
  }
}

/* Adds what small triangles of a batch cover, one bit each in `small`. */
static void add_small(const fragment_work *work, fragment_worker *worker, small_batch *batch,
                      uint32_t small) {
  if (small == 0) return;
  uint32_t any = 0;
  for (int k = 0; k < SMALL_PIXELS; k++) any |= batch->cover.covered[k] & small;
  find_opacities(work, batch, any);
  for (int k = 0; k < SMALL_PIXELS; k++)
    for (uint32_t left = batch->cover.covered[k] & small; left != 0; left &= left - 1)
      add_small_pixel(work, worker, batch, __builtin_ctz(left), k);
}

/* Adds a batch's primitives: the small ones together, the others one by one. */
static void add_batch(const fragment_work *work, fragment_worker *worker, tile_part *part,
                      small_batch *batch) {
  if (batch->count == 0 ||
      !make_room(work->source->context, worker, SMALL_TRIANGLES * SMALL_PIXELS * MOST_SLABS))
    return;
  const surface_functions *functions = work->source->functions;
  uint32_t all = (1u << batch->count) - 1;
  uint32_t small = batch->of_spheres ? functions->cover_spheres(&batch->view, &batch->spheres, &batch->cover)
                                     : functions->cover_small(&batch->view, &batch->triangles, &batch->cover);
  add_small(work, worker, batch, all & small);
  for (uint32_t left = all & batch->cover.large; left != 0 && !worker->failed; left &= left - 1)
    add_primitive(work, worker, part, batch->mesh, batch->primitives[__builtin_ctz(left)]);
  batch->count = 0;
}

/* Whether opaque fragments of a light's view cover all pixels of a tile that a cluster touches, before the
 * cluster: each of its fragments would be left out when they are sorted. */
static bool is_covered(const fragment_work *work, const fragment_worker *worker, const tile_part *part,
                       const cluster_shape *shape, const seen_cluster *seen) {
  const view *view = work->source->view;
  int32_t low[2] = {INT32_MAX, INT32_MAX}, high[2] = {INT32_MIN, INT32_MIN};
  float lowest = INFINITY;
  for (size_t v = 0; v < shape->vertices; v++) {
    lowest = seen->height[v] < lowest ? seen->height[v] : lowest;
    low[0] = least(low[0], seen->x[v]), high[0] = greatest(high[0], seen->x[v]);
    low[1] = least(low[1], seen->y[v]), high[1] = greatest(high[1], seen->y[v]);
  }
  int left = part->tile_x * TILE, top = part->tile_y * TILE,
      right = least(least(left + TILE, view->width) - 1, high[0] >> 8),
      bottom = least(least(top + TILE, view->height) - 1, high[1] >> 8);
  left = greatest(left, low[0] >> 8), top = greatest(top, low[1] >> 8);
  for (int y = top; y <= bottom; y++)
    for (int x = left; x <= right; x++) {
      const covered_so_far *covered = &worker->covered[hl_pixel_number(x % TILE, y % TILE)];
      if (covered->samples != 0xffff || covered->height >= lowest) return false;
    }
  return true;
}

/* Adds the triangles of a whole cluster, of which none is cut. */
static void add_cluster(const fragment_work *work, fragment_worker *worker, tile_part *part,
                        small_batch *batch, const surface_cluster *cluster) {
  const surfaces *all = work->source->surfaces;
  const surface_functions *functions = work->source->functions;
  const cluster_shape shape = hl_cluster_shape(all, cluster);
  const uint32_t *order = all->order + cluster->first;
  seen_cluster seen;
  functions->see_cluster(&batch->view, &shape, &seen);
  if (batch->may_be_covered && is_covered(work, worker, part, &shape, &seen)) return;
  for (int first = 0; first < cluster->count; first += SMALL_TRIANGLES) {
    int count = least(cluster->count - first, SMALL_TRIANGLES);
    if (!make_room(work->source->context, worker, SMALL_TRIANGLES * SMALL_PIXELS * MOST_SLABS)) return;
    memcpy(batch->primitives, order + first, (size_t)count * sizeof *order);
    uint32_t small = functions->cover_cluster(&batch->view, &shape, &seen, first, (1u << count) - 1,
                                              &batch->cover);
    add_small(work, worker, batch, small);
    for (uint32_t left = batch->cover.large; left != 0 && !worker->failed; left &= left - 1) {
      uint32_t primitive = batch->primitives[__builtin_ctz(left)];
      if (!batch->view.fronts || hl_faces_view(work->seen, primitive))
        add_primitive(work, worker, part, batch->mesh, primitive);
    }
  }
}

/* ---- all primitives of a tile ---- */

/* Begins with the mesh of a primitive; of_mesh: the first of the mesh's primitives of this kind, and the
 * first after them. */
static void begin_mesh(const fragment_work *work, small_batch *batch, uint32_t primitive,
                       uint32_t of_mesh[2]) {
  const surfaces *all = work->source->surfaces;
  batch->mesh = hl_surface_mesh_of(all, primitive);
  const surface_mesh *mesh = &all->meshes[batch->mesh];
  batch->of_spheres = primitive >= all->triangle_count;
  batch->view.dark_backs = work->dark_backs[batch->mesh];
  batch->view.fronts = work->wanted[batch->mesh] == BINNED_FRONTS;
  of_mesh[0] = primitive < all->triangle_count ? mesh->first_triangle
                                               : all->triangle_count + mesh->first_sphere;
  of_mesh[1] = hl_surface_mesh_end(all, batch->mesh, primitive);
}

/* Adds the primitives of a cluster, of which cuts may leave a part. */
static void add_run(const fragment_work *work, fragment_worker *worker, tile_part *part, small_batch *batch,
                    primitive_run run) {
  const surfaces *all = work->source->surfaces;
  const surface_cluster *cluster = run.cluster != NO_CLUSTER ? &all->clusters[run.cluster] : NULL;
  bool triangle = run.primitive < all->triangle_count;
  if (cluster != NULL && triangle && !all->meshes[batch->mesh].is_cut) {
    add_batch(work, worker, part, batch);
    if (!worker->failed) add_cluster(work, worker, part, batch, cluster);
    return;
  }
  uint32_t count = cluster != NULL ? cluster->count : 1;
  for (uint32_t i = 0; i < count && !worker->failed; i++) {
    uint32_t p = cluster != NULL ? all->order[cluster->first + i] : run.primitive;
    if (cluster != NULL && batch->view.fronts && triangle && !hl_faces_view(work->seen, p)) continue;
    bool collected = triangle ? collect(work, part, batch, p) : collect_sphere(work, batch, p);
    if (!collected) add_primitive(work, worker, part, batch->mesh, p);
    if (batch->count == SMALL_TRIANGLES) add_batch(work, worker, part, batch);
  }
}

static void add_next_run(const fragment_work *work, fragment_worker *worker, tile_part *part,
                         small_batch *batch, primitive_run run, uint32_t of_mesh[2]) {
  if (run.primitive < of_mesh[0] || run.primitive >= of_mesh[1]) {
    add_batch(work, worker, part, batch);
    begin_mesh(work, batch, run.primitive, of_mesh);
  }
  if (!worker->failed) add_run(work, worker, part, batch, run);
}

/* The least height that a run has, or less. */
static float lowest_of(const fragment_work *work, primitive_run run) {
  const surfaces *all = work->source->surfaces;
  const sheet_stack *sheets = work->source->sheets;
  if (run.cluster != NO_CLUSTER) return (float)hl_lowest_height(sheets, &all->clusters[run.cluster]);
  if (run.primitive >= all->triangle_count) return (float)-INFINITY;
  double height = INFINITY;
  for (int i = 0; i < 3; i++)
    height = fmin(height, vec3_dot(sheets->normal,
                                   hl_surface_vector(all->positions[all->triangles[run.primitive][i]])));
  return (float)(height - sheets->first);
}

static bool make_room_for_runs(hl_context *context, fragment_worker *worker, size_t count) {
  if (count <= worker->run_room) return true;
  order_key *runs = hl_reallocate(context, worker->runs, 4 * count, sizeof *runs);
  worker->failed = runs == NULL;
  if (worker->failed) return false;
  worker->runs = runs;
  worker->run_room = 2 * count;
  return true;
}

/* Adds a tile's runs; the lowest first where the higher ones may be covered. */
static void add_runs(const fragment_work *work, fragment_worker *worker, tile_part *part, size_t tile,
                     small_batch *batch) {
  const primitive_run *runs = work->bins->runs + work->bins->first[tile];
  uint32_t count = work->bins->first[tile + 1] - work->bins->first[tile];
  uint32_t of_mesh[2] = {0, 0};
  if (batch->may_be_covered && !make_room_for_runs(work->source->context, worker, count)) return;
  order_key *order = worker->runs;
  for (uint32_t i = 0; batch->may_be_covered && i < count; i++)
    order[i] = (order_key){hl_ordered_bits(lowest_of(work, runs[i]), false), i};
  if (batch->may_be_covered) hl_sort_keys(order, order + count, count);
  for (uint32_t i = 0; i < count && !worker->failed; i++)
    add_next_run(work, worker, part, batch, runs[batch->may_be_covered ? order[i].index : i], of_mesh);
  if (!worker->failed) add_batch(work, worker, part, batch);
}

static void add_primitives(const fragment_work *work, fragment_worker *worker, tile_part *part, size_t tile) {
  small_batch batch;
  memset(&batch.triangles, 0, sizeof batch.triangles); /* lanes that stay empty */
  memset(&batch.spheres, 0, sizeof batch.spheres);
  batch.of_spheres = false;
  batch.view = work->small;
  batch.view.left = part->tile_x * TILE * SUBPIXELS;
  batch.view.top = part->tile_y * TILE * SUBPIXELS;
  batch.view.columns = least(work->source->view->width - part->tile_x * TILE, TILE);
  batch.view.rows = least(work->source->view->height - part->tile_y * TILE, TILE);
  batch.count = 0;
  batch.mesh = 0;
  batch.may_be_covered = work->source->of_light && work->source->rise <= 0;
  add_runs(work, worker, part, tile, &batch);
}

/* Sorts a tile's fragments, and parts those of the eye's view that cross. Returns how many are left in
 * *sorted, which the worker owns. */
static size_t order_fragments(const fragment_work *work, fragment_worker *worker, const fragment_order *order,
                              const tile_part *part, fragment **sorted) {
  const fragments_source *source = work->source;
  fragment *list = worker->scratch, *other = list + worker->room;
  size_t kept = hl_sort_by_pixel(list, worker->count, order, worker->keys, other);
  const crossing_tile crossing = {source->surfaces,    source->view,       work->seen, source->sheets, order,
                                  part->tile_x * TILE, part->tile_y * TILE};
  bool parted;
  *sorted = source->of_light || source->unseen ? other : list;
  if (*sorted == other) return kept;
  kept = hl_part_crossings(&crossing, other, kept, list, &parted);
  for (size_t i = 0; parted && i < kept; i++) mark(work, worker, list[i].pixel, list[i].slab);
  return kept;
}

void hl_make_tile_fragments(void *data, size_t tile, int worker_index) {
  const fragment_work *work = data;
  const fragments_source *source = work->source;
  fragment_worker *worker = &work->workers[worker_index];
  const fragment_order order = {work->least, source->falling, source->rise > 0, source->unseen,
                                source->sheets->spacing};
  tile_part part = {.tile_x = (int)(tile % (size_t)work->tiles_x),
                    .tile_y = (int)(tile / (size_t)work->tiles_x)};
  fragment *sorted = NULL;
  size_t kept = 0;
  work->tiles[tile] = (tile_list){0};
  worker->count = 0;
  memset(worker->latest, 0, sizeof worker->latest);
  memset(worker->covered, 0, sizeof worker->covered);
  if (worker->failed || (source->needed != NULL && source->needed[tile] == 0)) return;
  add_primitives(work, worker, &part, tile);
  if (!worker->failed && make_room(source->context, worker, worker->count)) /* for parts */
    kept = order_fragments(work, worker, &order, &part, &sorted);
  write_marks(work, worker, part.tile_x, part.tile_y);
  kept = hl_resolve_fragments(sorted, kept, &order);
  if (kept == 0 || !make_room_for_tile(source->context, worker, kept)) return;
  fragment *list = worker->out->list + worker->out->count;
  hl_sort_by_slab(sorted, kept, &order, worker->places, source->sheets->count, list);
  work->tiles[tile] = (tile_list){.list = list, .count = (uint32_t)kept};
  worker->out->count += kept;
}

/* ---- begin and end ---- */

static void set_small_view(const fragments_source *source, small_view *small) {
  const view *view = source->view;
  const sheet_stack *sheets = source->sheets;
  *small = (small_view){.first = (float)sheets->first,
                        .spacing = (float)sheets->spacing,
                        .last_slab = (float)(sheets->count - 1),
                        .of_light = source->of_light,
                        .perspective = view->perspective,
                        .delay = (float)source->delay,
                        .rise = (float)source->rise,
                        .view = view,
                        .sheets = sheets};
  vec3_store(small->normal, sheets->normal);
  vec3_store(small->from, view->perspective ? view->origin : view->direction);
  vec3_store(small->du, view->du);
  vec3_store(small->dv, view->dv);
  vec3_store(small->depth, view->inverse.row[0]);
  const vec3 *rows = view->inverse.row, origin = view->perspective ? view->origin : view->corner;
  for (int i = 0; i < 3; i++)
    small->inverse[i][0] = rows[i].x, small->inverse[i][1] = rows[i].y, small->inverse[i][2] = rows[i].z;
  small->origin[0] = origin.x, small->origin[1] = origin.y, small->origin[2] = origin.z;
}

/* The tiles that look-ups about a pixel may read: its own, and those beside it by less than three pixels. */
static uint16_t tiles_near(int column, int row) {
  uint32_t across = 2u | (column < 3) | (uint32_t)(column >= TILE - 3) << 2;
  return (uint16_t)((row < 3 ? across : 0) | across << 3 | (row >= TILE - 3 ? across << 6 : 0));
}

void hl_fragment_work_begin(fragment_work *work) {
  set_small_view(work->source, &work->small);
  for (int row = 0; row < TILE; row++)
    for (int column = 0; column < TILE; column++)
      work->near[hl_pixel_number(column, row)] = tiles_near(column, row);
}

bool hl_fragment_worker_begin(hl_context *context, fragment_worker *worker, int sheets) {
  worker->places = hl_allocate(context, (size_t)sheets + 2, sizeof *worker->places);
  worker->near = hl_allocate_zeroed(context, (size_t)sheets + 1, sizeof *worker->near);
  worker->nearest = INT32_MAX;
  worker->farthest = -1;
  return worker->places != NULL && worker->near != NULL;
}

void hl_fragment_worker_end(hl_context *context, fragment_worker *worker) {
  void *owned[] = {worker->scratch, worker->keys, worker->runs, worker->places, worker->near};
  for (size_t i = 0; i < sizeof owned / sizeof *owned; i++) hl_release(context, owned[i]);
}
