/* surface/late/surface_seams.c - see surface_seams.h. */
#include "surface/late/surface_seams.h"

#include "core/memory.h"
#include "mesh/mesh.h"
#include "surface/clusters.h"
#include "surface/fragment_order.h"
#include "surface/primitive.h"

/* An edge of a large triangle. */
typedef struct large_edge {
  uint32_t triangle, ends[2];
  double key; /* the coordinate by which edges are sorted; edges in the same place have nearly the same key */
} large_edge;

typedef struct seam_search {
  surfaces *all;
  /* large: the least length of a large edge; same: the greatest distance between ends of edges that count as
   * one place; frame units */
  double large, same;
  large_edge *edges; /* [edge_room]; the edges of large triangles */
  size_t edge_count, edge_room;
  order_key *order;       /* [2][edge_count]; the edges' keys, and memory for sorting them */
  surface_seam *found;    /* [found_count]; the seams in the order in which the search found them */
  order_key *found_order; /* [2][found_count]; the keys by which the found seams are sorted, and memory for
                           * sorting them */
  size_t found_count;
} seam_search;

static vec3 position_of(const surfaces *all, uint32_t vertex) {
  return hl_surface_vector(all->positions[vertex]);
}

static void set_scale(seam_search *search) {
  const surfaces *all = search->all;
  double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
  for (size_t c = 0; c < all->cluster_count; c++) {
    vec3_bound(hl_surface_vector(all->clusters[c].low), low, high);
    vec3_bound(hl_surface_vector(all->clusters[c].high), low, high);
  }
  double diagonal = vec3_length(vec3_subtract(vec3_of(high), vec3_of(low)));
  search->large = LARGE_EDGE * diagonal;
  search->same = SAME_PLACE * diagonal;
}

/* The key by which edges are sorted: the coordinate of the edge's middle along a direction in which edges of
 * walls seldom run. */
static double key_of(const surfaces *all, const uint32_t ends[2]) {
  const vec3 direction = {0.57735, 0.70711, 0.40825};
  return vec3_dot(direction, vec3_add(position_of(all, ends[0]), position_of(all, ends[1]))) / 2;
}

static bool is_large(const seam_search *search, const uint32_t corner[3]) {
  double longest = 0;
  for (int i = 0; i < 3; i++)
    longest = fmax(longest, vec3_length(vec3_subtract(position_of(search->all, corner[i]),
                                                      position_of(search->all, corner[(i + 1) % 3]))));
  return longest > search->large;
}

static void add_edges(seam_search *search, uint32_t triangle) {
  const uint32_t *corner = search->all->triangles[triangle];
  if (!is_large(search, corner)) return;
  for (int i = 0; i < 3; i++) {
    large_edge edge = {.triangle = triangle, .ends = {corner[i], corner[(i + 1) % 3]}};
    edge.key = key_of(search->all, edge.ends);
    if (isfinite(edge.key)) search->edges[search->edge_count++] = edge;
  }
}

/* Returns whether a cluster may hold a large triangle. */
static bool may_hold_large(const seam_search *search, const surface_cluster *cluster) {
  return hl_has_corners(search->all, cluster->first) &&
         vec3_length(vec3_subtract(hl_surface_vector(cluster->high), hl_surface_vector(cluster->low))) >
             search->large;
}

/* Lists the edges of large triangles that do not belong to a closed part of their mesh. */
static void list_edges(seam_search *search) {
  const surfaces *all = search->all;
  for (size_t c = 0; c < all->cluster_count; c++) {
    const surface_cluster *cluster = &all->clusters[c];
    const surface_mesh *mesh = &all->meshes[cluster->mesh];
    if (!may_hold_large(search, cluster) || mesh->mesh->closed) continue;
    for (uint32_t i = 0; i < cluster->count && search->edge_count + 3 <= search->edge_room; i++) {
      uint32_t triangle = all->order[cluster->first + i];
      if (mesh->mesh->insides[triangle - mesh->primitives[PRIMITIVE_triangle].first] == 0)
        add_edges(search, triangle);
    }
  }
}

static bool is_near(const seam_search *search, uint32_t a, uint32_t b) {
  vec3 apart = vec3_subtract(position_of(search->all, a), position_of(search->all, b));
  return vec3_length(apart) <= search->same;
}

/* Returns whether two edges lie in one place, and the normals of their triangles differ by a large angle. */
static bool is_corner(const seam_search *search, const large_edge *a, const large_edge *b) {
  if (a->triangle == b->triangle) return false;
  if (!(is_near(search, a->ends[0], b->ends[0]) && is_near(search, a->ends[1], b->ends[1])) &&
      !(is_near(search, a->ends[0], b->ends[1]) && is_near(search, a->ends[1], b->ends[0])))
    return false;
  return fabs(vec3_dot(hl_surface_normal(search->all, a->triangle),
                       hl_surface_normal(search->all, b->triangle))) < HL_MESH_ROUNDED;
}

static void add_seam(seam_search *search, const large_edge *edge, const large_edge *other) {
  search->found[search->found_count++] = (surface_seam){
      edge->triangle, other->triangle, {edge->ends[0], edge->ends[1]}};
}

/* Finds the seams between an edge and other edges on one side of it in the order of keys. i: the edge's index
 * in this order. way: 1 for the edges after edge i, -1 for the edges before edge i. */
static void find_at(seam_search *search, size_t i, int way) {
  const large_edge *own = &search->edges[search->order[i].index];
  int found = 0;
  size_t at = i;
  for (int asked = 0; asked < MOST_SEAMS_ASKED && found < MOST_AT_EDGE / 2; asked++) {
    if (way > 0 ? at + 1 == search->edge_count : at == 0) return;
    at = way > 0 ? at + 1 : at - 1;
    const large_edge *other = &search->edges[search->order[at].index];
    if (fabs(other->key - own->key) > 2 * search->same) return;
    if (!is_corner(search, own, other)) continue;
    add_seam(search, own, other);
    found++;
  }
}

/* Sorts the edges by their keys, which are rounded to floats. */
static void sort_edges(seam_search *search) {
  for (size_t i = 0; i < search->edge_count; i++)
    search->order[i] = (order_key){(uint64_t)hl_ordered_bits((float)search->edges[i].key, false) << 32,
                                   (uint32_t)i};
  hl_sort_keys(search->order, search->order + search->edge_count, search->edge_count);
}

/* ---- memory ---- */

static void lay_out_edges(seam_search *search, hl_layout *layout) {
  search->edges = hl_layout_take(layout, search->edge_room, sizeof *search->edges);
}

/* Lays out the arrays for the search among a number of edges. */
static void lay_out_found(seam_search *search, size_t edges, hl_layout *layout) {
  search->order = hl_layout_take(layout, 2 * edges, sizeof *search->order);
  search->found = hl_layout_take(layout, MOST_AT_EDGE * edges, sizeof *search->found);
  search->found_order = hl_layout_take(layout, MOST_AT_EDGE * edges, 2 * sizeof *search->found_order);
}

static surface_seam *lay_out_seams(size_t seams, hl_layout *layout) {
  return hl_layout_take(layout, seams, sizeof(surface_seam));
}

/* Sets up a search with room for the edges of a number of triangles. */
static seam_search search_of(surfaces *all, uint64_t triangles) {
  return (seam_search){.all = all, .edge_room = 3 * (triangles < MOST_SEAMED ? triangles : MOST_SEAMED)};
}

void hl_surface_seams_count(uint64_t triangles, hl_layout *layout) {
  seam_search search = search_of(NULL, triangles);
  lay_out_seams(MOST_AT_EDGE * search.edge_room, layout);
  const size_t kept = layout->bytes;
  lay_out_edges(&search, layout);
  lay_out_found(&search, search.edge_room, layout);
  hl_layout_give_back(layout, kept);
}

/* ---- all seams ---- */

/* Copies the seams that were found, and sorts them by their triangles. The seams of one triangle keep their
 * order. */
static hl_status sort_seams(hl_context *context, const seam_search *search, hl_error *error) {
  surfaces *all = search->all;
  const size_t count = search->found_count;
  hl_layout layout = {0};
  while (hl_layout_pass(&layout, context)) all->seams = lay_out_seams(count, &layout);
  if (layout.base == NULL) return hl_fail_memory(error, layout.bytes, "the corners of meshes");
  for (size_t i = 0; i < count; i++)
    search->found_order[i] = (order_key){(uint64_t)search->found[i].triangle << 32, (uint32_t)i};
  hl_sort_keys(search->found_order, search->found_order + count, count);
  for (size_t i = 0; i < count; i++) all->seams[i] = search->found[search->found_order[i].index];
  all->seam_count = count;
  return HL_OK;
}

static hl_status find_seams(hl_context *context, seam_search *search, hl_error *error) {
  hl_layout layout = {0};
  if (search->edge_count == 0) return HL_OK;
  while (hl_layout_pass(&layout, context)) lay_out_found(search, search->edge_count, &layout);
  if (layout.base == NULL) return hl_fail_memory(error, layout.bytes, "the corners of meshes");
  sort_edges(search);
  for (size_t i = 0; i < search->edge_count; i++) find_at(search, i, -1), find_at(search, i, 1);
  hl_status status = sort_seams(context, search, error);
  hl_release(context, layout.base);
  return status;
}

hl_status hl_surface_seams_create(hl_context *context, surfaces *all, hl_error *error) {
  seam_search search = search_of(all, all->first[PRIMITIVE_triangle + 1]);
  hl_layout layout = {0};
  if (all->first[PRIMITIVE_triangle + 1] == 0) return HL_OK;
  while (hl_layout_pass(&layout, context)) lay_out_edges(&search, &layout);
  if (layout.base == NULL) return hl_fail_memory(error, layout.bytes, "the corners of meshes");
  set_scale(&search);
  list_edges(&search);
  hl_status status = find_seams(context, &search, error);
  hl_release(context, layout.base);
  return status;
}

void hl_surface_seams_release(hl_context *context, surfaces *all) {
  hl_release(context, all->seams);
  all->seams = NULL;
  all->seam_count = 0;
}

const surface_seam *hl_surface_seams_of(const surfaces *all, uint32_t triangle, size_t *count) {
  size_t first = 0, end = all->seam_count;
  while (first < end) {
    size_t middle = first + (end - first) / 2;
    if (all->seams[middle].triangle < triangle) first = middle + 1;
    else end = middle;
  }
  for (*count = 0; first + *count < all->seam_count && all->seams[first + *count].triangle == triangle;)
    ++*count;
  return all->seams + first;
}
