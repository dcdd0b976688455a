/* surface/surface_tree.c - makes a tree of boxes around primitives, and finds where rays meet the primitives
 * (surface_tree.h). */
#include "surface/surface_tree.h"

#include "core/memory.h"
#include "mesh/mesh.h"
#include "surface/late/surface_rims.h"
#include "surface/surface_cuts.h"
#include "surface/triangle.h"

/* The limits of making the tree. A range of primitives is divided at the mean of the primitives' middles.
 * From depth DEEP on, it is divided into halves with equal numbers of primitives, so that the tree does not
 * become too deep. */
enum { LEAF_PRIMITIVES = 4, DEEP = 32, DEEPEST = DEEP + 40 };

static float lower(float a, float b) { return a < b ? a : b; }
static float higher(float a, float b) { return a > b ? a : b; }

static double lesser(double a, double b) { return a < b ? a : b; }
static double greater(double a, double b) { return a > b ? a : b; }

static size_t most_boxes(size_t primitives) { return 2 * primitives; }

/* A primitive with its box; used while the tree is made. */
typedef struct boxed_primitive {
  float low[3], high[3];
  uint32_t primitive;
} boxed_primitive;

static float middle_of(const boxed_primitive *p, int axis) {
  return p->low[axis] + (p->high[axis] - p->low[axis]) / 2;
}

/* ---- the tree ---- */

/* Moves the primitives whose middle lies below the coordinate `at` to the front of the list. Returns the
 * number of these primitives. */
static uint32_t part(boxed_primitive *list, uint32_t count, int axis, float at) {
  uint32_t below = 0;
  for (uint32_t i = 0; i < count; i++) {
    boxed_primitive moved = list[i];
    if (middle_of(&moved, axis) >= at) continue;
    list[i] = list[below];
    list[below++] = moved;
  }
  return below;
}

/* Makes the tree of a range of primitives, and sorts the range. list: the list of all primitives. first:
 * where the range begins. */
static void make(surface_tree *tree, boxed_primitive *list, uint32_t first, uint32_t count, int depth) {
  surface_box *made = &tree->boxes[tree->box_count++];
  float low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
  *made = (surface_box){{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}, first, count};
  for (uint32_t i = first; i < first + count; i++)
    for (int a = 0; a < 3; a++) {
      float middle = middle_of(&list[i], a);
      made->low[a] = lower(made->low[a], list[i].low[a]),
      made->high[a] = higher(made->high[a], list[i].high[a]);
      low[a] = lower(low[a], middle), high[a] = higher(high[a], middle);
    }
  if (count <= LEAF_PRIMITIVES) return;
  int axis = 0;
  for (int other = 1; other < 3; other++)
    if (high[other] - low[other] > high[axis] - low[axis]) axis = other;
  uint32_t below = part(list + first, count, axis, low[axis] + (high[axis] - low[axis]) / 2);
  if (below == 0 || below == count || depth >= DEEP) below = count / 2;
  made->count = 0;
  make(tree, list, first, below, depth + 1);
  made->first = tree->box_count;
  make(tree, list, first + below, count - below, depth + 1);
}

/* Finds which primitives of a mesh a tree holds that is created for a given distance. */
static mesh_held held_of(const surface_mesh *mesh, double distance) {
  if (!hl_mesh_takes_light(mesh)) return HELD_NOT;
  if (mesh->is_cut) return HELD_CUT;
  return isinf(distance) || !mesh->mesh->closed ? HELD_WHOLE : HELD_NOT;
}

/* Returns whether a tree holds primitive number i of a kind, counted from the mesh's first primitive of this
 * kind. near: for each primitive with corners, whether the tree holds it. A primitive without corners is held
 * if a cut cuts it. If near is null, the tree holds all primitives. */
static bool takes(const surfaces *all, const surface_mesh *mesh, int kind, uint32_t i, const bool *near) {
  if (near == NULL) return true;
  if (hl_primitive_kinds[kind]->has_corners) return near[i];
  return mesh->is_cut && hl_surface_cut(all, mesh, mesh->primitives[kind].first + i) == CUT_LEAVES_SOME;
}

static void take_primitives(surface_tree *tree, const surface_mesh *mesh, const bool *near) {
  for (int k = 0; k < PRIMITIVE_KINDS; k++) {
    const primitive_range own = mesh->primitives[k];
    for (uint32_t i = 0; i < own.count; i++)
      if (takes(tree->all, mesh, k, i, near)) tree->primitives[tree->count++] = own.first + i;
  }
}

/* ---- memory ---- */

/* The greatest numbers of primitives that a tree may hold. */
typedef struct tree_size {
  size_t primitives;
  uint32_t triangles; /* the number of triangles of the largest mesh */
} tree_size;

static tree_size size_of(const surfaces *all, double distance) {
  tree_size size = {0, 0};
  for (size_t m = 0; all != NULL && m < all->mesh_count; m++) {
    const surface_mesh *mesh = &all->meshes[m];
    if (held_of(mesh, distance) == HELD_NOT) continue;
    for (int k = 0; k < PRIMITIVE_KINDS; k++) size.primitives += mesh->primitives[k].count;
    const uint32_t triangles = mesh->primitives[PRIMITIVE_triangle].count;
    size.triangles = triangles > size.triangles ? triangles : size.triangles;
  }
  return size;
}

/* Lays out the arrays of a tree in one block of memory. The first array begins the block. */
static void lay_out(surface_tree *tree, const tree_size *size, hl_layout *layout) {
  tree->primitives = hl_layout_take(layout, size->primitives, sizeof *tree->primitives);
  tree->holds = hl_layout_take(layout, tree->all->mesh_count, sizeof *tree->holds);
  tree->cuts = hl_layout_take(layout, tree->all->cut_count, sizeof *tree->cuts);
}

static void lay_out_boxes(surface_tree *tree, size_t primitives, hl_layout *layout) {
  tree->boxes = hl_layout_take(layout, most_boxes(primitives), sizeof *tree->boxes);
}

static boxed_primitive *lay_out_list(size_t primitives, hl_layout *layout) {
  return hl_layout_take(layout, primitives, sizeof(boxed_primitive));
}

static bool *lay_out_near(const surface_tree *tree, const tree_size *size, hl_layout *layout) {
  return isinf(tree->distance) ? NULL : hl_layout_take(layout, size->triangles, sizeof(bool));
}

bool hl_surface_tree_count(const surfaces *all, double distance, hl_layout *layout) {
  surface_tree tree = {.all = all, .distance = distance};
  const tree_size size = size_of(all, distance);
  if (size.primitives == 0) return false;
  lay_out(&tree, &size, layout);
  size_t kept = layout->bytes;
  lay_out_near(&tree, &size, layout);
  for (size_t m = 0; !isinf(distance) && m < all->mesh_count; m++)
    if (held_of(&all->meshes[m], distance) != HELD_NOT) hl_surface_rims_count(&all->meshes[m], layout);
  hl_layout_give_back(layout, kept);
  lay_out_boxes(&tree, size.primitives, layout);
  kept = layout->bytes;
  lay_out_list(size.primitives, layout);
  hl_layout_give_back(layout, kept);
  return true;
}

/* ---- making the tree ---- */

/* Stores the scene's cuts in the tree, because the tree's content depends on them. */
static void keep_cuts(surface_tree *tree) {
  const surfaces *all = tree->all;
  for (size_t i = 0; i < all->cut_count; i++) tree->cuts[i] = all->cuts[i];
  tree->cut_count = all->cut_count;
}

/* Makes the boxes of a tree from its list of primitives. */
static hl_status make_boxes(hl_context *context, surface_tree *tree, hl_error *error) {
  boxed_primitive *list = NULL;
  hl_layout boxes = {0}, passing = {0};
  while (hl_layout_pass(&boxes, context)) lay_out_boxes(tree, tree->count, &boxes);
  if (boxes.base == NULL) return hl_fail_memory(error, boxes.bytes, "the boxes of meshes");
  while (hl_layout_pass(&passing, context)) list = lay_out_list(tree->count, &passing);
  if (passing.base == NULL) return hl_fail_memory(error, passing.bytes, "the boxes of meshes");
  for (uint32_t i = 0; i < tree->count; i++) {
    list[i].primitive = tree->primitives[i];
    hl_primitive_kind(tree->all, list[i].primitive)
        ->bound(tree->all, list[i].primitive, list[i].low, list[i].high);
  }
  make(tree, list, 0, tree->count, 0);
  for (uint32_t i = 0; i < tree->count; i++) tree->primitives[i] = list[i].primitive;
  hl_release(context, passing.base);
  return HL_OK;
}

/* Fills a tree's list of primitives, for which there must be room. */
static hl_status choose_primitives(hl_context *context, surface_tree *tree, const tree_size *size,
                                   hl_error *error) {
  bool *near = NULL;
  hl_layout passing = {0};
  hl_status status = HL_OK;
  while (hl_layout_pass(&passing, context)) near = lay_out_near(tree, size, &passing);
  if (passing.base == NULL) return hl_fail_memory(error, passing.bytes, "the edges of meshes");
  for (size_t m = 0; m < tree->all->mesh_count && status == HL_OK; m++) {
    const surface_mesh *mesh = &tree->all->meshes[m];
    tree->holds[m] = held_of(mesh, tree->distance);
    if (tree->holds[m] == HELD_NOT) continue;
    if (near != NULL) status = hl_surface_rims(context, tree->all, mesh, tree->distance, near, error);
    if (status == HL_OK) take_primitives(tree, mesh, near);
  }
  hl_release(context, passing.base);
  return status;
}

hl_status hl_surface_tree_create(hl_context *context, const surfaces *all, double distance,
                                 surface_tree *tree, hl_error *error) {
  *tree = (surface_tree){.all = all, .distance = distance};
  const tree_size size = size_of(all, distance);
  hl_layout layout = {0};
  if (size.primitives == 0) return HL_OK;
  while (hl_layout_pass(&layout, context)) lay_out(tree, &size, &layout);
  if (layout.base == NULL) return hl_fail_memory(error, layout.bytes, "the boxes of meshes");
  hl_status status = choose_primitives(context, tree, &size, error);
  keep_cuts(tree);
  if (status == HL_OK && tree->count > 0) status = make_boxes(context, tree, error);
  if (status != HL_OK) hl_surface_tree_release(context, tree);
  return status;
}

static bool has_same_cuts(const surface_tree *tree, const surfaces *all) {
  if (tree->cut_count != all->cut_count) return false;
  for (size_t i = 0; i < all->cut_count; i++)
    if (!hl_cut_same(&tree->cuts[i], &all->cuts[i])) return false;
  return true;
}

bool hl_surface_tree_current(const surface_tree *tree, const surfaces *all, double distance) {
  bool any_cut = false;
  if (tree->all != all || tree->distance < distance || tree->distance > distance) return false;
  for (size_t m = 0; m < all->mesh_count; m++) {
    const mesh_held held = held_of(&all->meshes[m], distance);
    if (held != (tree->holds != NULL ? tree->holds[m] : HELD_NOT)) return false;
    any_cut |= held == HELD_CUT;
  }
  return !any_cut || has_same_cuts(tree, all);
}

void hl_surface_tree_release(hl_context *context, surface_tree *tree) {
  hl_release(context, tree->primitives);
  hl_release(context, tree->boxes);
  *tree = (surface_tree){0};
}

/* ---- hulls ---- */

static bool overlap(const float low[3], const float high[3], const double from[3], const double to[3]) {
  for (int a = 0; a < 3; a++)
    if ((double)low[a] > to[a] || (double)high[a] < from[a]) return false;
  return true;
}

/* Returns whether a leaf has a primitive that reaches a box or the convex hull of balls. balls: if null, it
 * is enough that boxes overlap. */
static bool leaf_reaches(const surface_tree *tree, const surface_box *leaf, const double low[3],
                         const double high[3], const hull_ball *balls, int count, double least) {
  for (uint32_t i = leaf->first; i < leaf->first + leaf->count; i++) {
    float from[3], to[3];
    hl_primitive_kind(tree->all, tree->primitives[i])->bound(tree->all, tree->primitives[i], from, to);
    if (overlap(from, to, low, high) &&
        (balls == NULL || hl_primitive_kind(tree->all, tree->primitives[i])
                              ->parts(tree->all, tree->primitives[i], balls, count, least)))
      return true;
  }
  return false;
}

static bool reaches(const surface_tree *tree, const double low[3], const double high[3],
                    const hull_ball *balls, int count, double least) {
  uint32_t waiting[DEEPEST + 2], left = 0;
  if (tree->box_count > 0) waiting[left++] = 0;
  while (left > 0) {
    uint32_t index = waiting[--left];
    const surface_box *box = &tree->boxes[index];
    if (!overlap(box->low, box->high, low, high)) continue;
    if (box->count > 0) {
      if (leaf_reaches(tree, box, low, high, balls, count, least)) return true;
      continue;
    }
    waiting[left++] = box->first;
    waiting[left++] = index + 1;
  }
  return false;
}

bool hl_surface_tree_overlaps(const surface_tree *tree, const double low[3], const double high[3]) {
  return reaches(tree, low, high, NULL, 0, 0);
}

bool hl_surface_tree_reaches(const surface_tree *tree, const hull_ball *balls, int count, double least) {
  double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
  for (int i = 0; i < count; i++) vec3_bound_ball(balls[i].at, balls[i].radius, low, high);
  return reaches(tree, low, high, balls, count, least);
}

/* ---- rays ---- */

/* A ray, or a bundle of rays around a middle ray, prepared for tests against boxes. */
typedef struct box_ray {
  double origin[3], way[3], inverse[3];
  double first, last;
  double aside[3]; /* for a bundle: along each axis, the greatest distance of its rays from the middle ray;
                    * for a single ray 0 */
} box_ray;

static box_ray ray_of_boxes(const surface_ray *ray) {
  box_ray made = {.origin = {ray->origin.x, ray->origin.y, ray->origin.z},
                  .way = {ray->way.x, ray->way.y, ray->way.z},
                  .first = ray->first,
                  .last = ray->last};
  for (int a = 0; a < 3; a++) made.inverse[a] = 1 / made.way[a];
  return made;
}

/* Returns whether a ray meets a box (slab method); for a bundle, whether any of its rays may meet the box. */
static bool meets_box(const surface_box *box, const box_ray *ray) {
  double nearest = ray->first, farthest = ray->last;
  for (int a = 0; a < 3; a++) {
    double low = (double)box->low[a] - ray->aside[a] - ray->origin[a],
           high = (double)box->high[a] + ray->aside[a] - ray->origin[a];
    if (ray->way[a] == 0) {
      if (low > 0 || high < 0) return false;
      continue;
    }
    double from = low * ray->inverse[a], to = high * ray->inverse[a];
    nearest = greater(nearest, lesser(from, to)), farthest = lesser(farthest, greater(from, to));
  }
  /* The added term allows for rounding, because the box of a flat triangle has no thickness. */
  return nearest <= farthest + 1e-9 * fabs(farthest);
}

/* Finds where a ray meets the primitives of a leaf. number: number of the ray in its bundle. */
static void meet_leaf(const surface_tree *tree, const surface_box *leaf, const surface_ray *ray, int number,
                      surface_met *met, void *data) {
  const surfaces *all = tree->all;
  for (uint32_t i = leaf->first; i < leaf->first + leaf->count; i++) {
    uint32_t primitive = tree->primitives[i];
    double distance[2];
    const primitive_kind *kind = hl_primitive_kind(all, primitive);
    int count = kind == &hl_primitive_triangle /* the function for triangles is inlined, because most
                                                * primitives are triangles */
                    ? hl_meet_triangle(all, primitive, ray, distance)
                    : kind->intersect(all, primitive, ray, distance);
    if (count == 0) continue;
    const surface_mesh *mesh = &all->meshes[hl_surface_mesh_of(all, primitive)];
    double opacity = fmin(fmax(kind->opacity(all, mesh, primitive), 0), 1);
    for (int k = 0; k < count; k++) {
      const vec3 at = vec3_add(ray->origin, vec3_scale(ray->way, distance[k]));
      if (hl_surface_left(all, mesh, at))
        met(data, &(surface_hit){at, distance[k], opacity, primitive, mesh, number});
    }
  }
}

void hl_surface_tree_cast(const surface_tree *tree, const surface_ray *ray, surface_met *met, void *data) {
  uint32_t waiting[DEEPEST + 2], count = 0;
  const box_ray boxes = ray_of_boxes(ray);
  if (tree->box_count > 0) waiting[count++] = 0;
  while (count > 0) {
    uint32_t index = waiting[--count];
    const surface_box *box = &tree->boxes[index];
    if (!meets_box(box, &boxes)) continue;
    if (box->count > 0) {
      meet_leaf(tree, box, ray, 0, met, data);
      continue;
    }
    waiting[count++] = box->first;
    waiting[count++] = index + 1;
  }
}

/* Makes a bundle of rays from one point. The middle ray leads to the middle of the box around the rays' ends.
 * Along each axis, no point of a ray is farther from the middle ray than the rays' ends are. Derived: the
 * rays share their origin, and at the fraction t of its length, a ray's point is origin + t (end -
 * origin). */
static box_ray bundle_of_rays(const surface_ray *rays, int count) {
  double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY}, middle[3];
  for (int k = 0; k < count; k++) vec3_bound_ball(vec3_scale(rays[k].way, rays[k].last), 0, low, high);
  for (int a = 0; a < 3; a++) middle[a] = (low[a] + high[a]) / 2;
  box_ray bundle = ray_of_boxes(&(surface_ray){rays[0].origin, vec3_of(middle), 0, 1});
  for (int a = 0; a < 3; a++) /* the distance is enlarged a little, to allow for rounding */
    bundle.aside[a] = (high[a] - low[a]) / 2 + 1e-6 * greater(fabs(low[a]), fabs(high[a]));
  return bundle;
}

void hl_surface_tree_cast_bundle(const surface_tree *tree, const surface_ray *rays, int count,
                                 surface_met *met, void *data) {
  uint32_t waiting[DEEPEST + 2], left = 0;
  const box_ray bundle = bundle_of_rays(rays, count);
  box_ray boxes[MOST_BUNDLED];
  for (int k = 0; k < count; k++) boxes[k] = ray_of_boxes(&rays[k]);
  if (tree->box_count > 0) waiting[left++] = 0;
  while (left > 0) {
    uint32_t index = waiting[--left];
    const surface_box *box = &tree->boxes[index];
    if (!meets_box(box, &bundle)) continue;
    if (box->count > 0) {
      for (int k = 0; k < count; k++)
        if (meets_box(box, &boxes[k])) meet_leaf(tree, box, &rays[k], k, met, data);
      continue;
    }
    waiting[left++] = box->first;
    waiting[left++] = index + 1;
  }
}
