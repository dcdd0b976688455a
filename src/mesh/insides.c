/* mesh/insides.c - finds the parts of a mesh that are closed, and the side of each part that is its inside.
 *
 * In: a mesh's triangles. Out: for each triangle, the side on which the inside of its part lies. A part is a
 * set of triangles that are connected by shared vertices. Parts are examined one by one, because a mesh may
 * hold a room and the things in it, and the fronts of each may face inwards or outwards. */
#include "core/memory.h"
#include "mesh/mesh.h"

/* The search for the closed parts of a mesh. */
typedef struct part_search {
  const hl_mesh_description *mesh;
  /* owned; [vertex_count]; for each vertex, another vertex of the same part; each part has one root, a vertex
   * that is its own parent */
  uint32_t *parent;
  uint64_t *ways; /* owned; [vertex_count]; for roots: the sum of the hashes of the part's edges, which is 0
                   * if the part is closed */
  double *volume; /* owned; [vertex_count]; for roots: six times the volume that the part encloses, negative
                   * if its fronts face inwards */
} part_search;

static uint32_t root_of(uint32_t *parent, uint32_t vertex) {
  for (; parent[vertex] != vertex; vertex = parent[vertex]) parent[vertex] = parent[parent[vertex]];
  return vertex;
}

static void join(uint32_t *parent, uint32_t a, uint32_t b) {
  a = root_of(parent, a), b = root_of(parent, b);
  if (a < b) parent[b] = a;
  else parent[a] = b;
}

/* Six times the signed volume of the tetrahedron between a triangle and the origin. */
static double volume_of(const hl_mesh_description *d, const uint32_t corner[3]) {
  const float *a = d->positions[corner[0]], *b = d->positions[corner[1]], *c = d->positions[corner[2]];
  return a[0] * ((double)b[1] * c[2] - (double)b[2] * c[1]) +
         a[1] * ((double)b[2] * c[0] - (double)b[0] * c[2]) +
         a[2] * ((double)b[0] * c[1] - (double)b[1] * c[0]);
}

/* Finds the parts of a mesh, and adds up the hashes of their edges and their volumes. Returns whether the
 * whole mesh is closed: each edge runs as often one way as the other, and the triangles enclose a volume
 * above 0. Derived: the hashes of an edge's two directions add up to 0. The sum over a closed part is
 * therefore 0, and any other sum means that the part has a boundary edge. With a boundary edge, a sum of 0
 * has the probability 2^-64. */
static bool find_parts(part_search *search) {
  const hl_mesh_description *d = search->mesh;
  uint64_t sum = 0;
  double volume = 0;
  for (size_t v = 0; v < d->vertex_count; v++) search->parent[v] = (uint32_t)v;
  for (size_t t = 0; t < d->triangle_count; t++)
    for (int i = 1; i < 3; i++) join(search->parent, d->triangles[t][0], d->triangles[t][i]);
  for (size_t t = 0; t < d->triangle_count; t++) {
    const uint32_t *corner = d->triangles[t], root = root_of(search->parent, corner[0]);
    for (int i = 0; i < 3; i++) {
      uint64_t way = hl_hash_of_way(corner[i], corner[(i + 1) % 3]);
      search->ways[root] += way;
      sum += way;
    }
    double own = volume_of(d, corner);
    search->volume[root] += own;
    volume += own;
  }
  return sum == 0 && volume > 0;
}

static void set_insides(part_search *search, int8_t *insides) {
  const hl_mesh_description *d = search->mesh;
  for (size_t t = 0; t < d->triangle_count; t++) {
    uint32_t root = root_of(search->parent, d->triangles[t][0]);
    double volume = search->ways[root] == 0 ? search->volume[root] : 0;
    insides[t] = (int8_t)((volume < 0) - (volume > 0));
  }
}

hl_status hl_mesh_find_insides(hl_mesh *mesh, hl_error *error) {
  const hl_mesh_description *d = &mesh->description;
  hl_context *context = mesh->context;
  part_search search = {.mesh = d};
  search.parent = hl_allocate(context, d->vertex_count, sizeof *search.parent);
  search.ways = hl_allocate_zeroed(context, d->vertex_count, sizeof *search.ways);
  search.volume = hl_allocate_zeroed(context, d->vertex_count, sizeof *search.volume);
  mesh->insides = hl_allocate(context, d->triangle_count, sizeof *mesh->insides);
  bool room = search.parent != NULL && search.ways != NULL && search.volume != NULL && mesh->insides != NULL;
  if (room) {
    mesh->closed = find_parts(&search);
    set_insides(&search, mesh->insides);
  }
  hl_release(context, search.parent);
  hl_release(context, search.ways);
  hl_release(context, search.volume);
  return room ? HL_OK : hl_fail_memory(error, d->vertex_count * 20, "a mesh's closed parts");
}

void hl_mesh_take_as_closed(hl_mesh *mesh) {
  mesh->closed = true;
  for (size_t t = 0; t < mesh->description.triangle_count; t++)
    if (mesh->insides[t] == 0) mesh->insides[t] = -1;
}
