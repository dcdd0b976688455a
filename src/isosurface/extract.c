/* isosurface/extract.c - cuts the cells of a lattice into triangles. The triangles' vertices lie where edges
 * between points of the lattice cross the surface. */
#include "core/memory.h"
#include "isosurface/cubes.h"
#include "isosurface/triangles.h"
#include "mesh/mesh.h"

enum { SIDE = HL_BRICK_CELLS, POINTS = SIDE * SIDE * SIDE };

typedef struct extraction {
  lattice *lattice;
  iso_triangles *made;
  cube_triangles patterns[CUBE_PATTERNS];
} extraction;

void hl_iso_triangles_release(hl_context *context, iso_triangles *triangles) {
  hl_release(context, triangles->positions);
  hl_release(context, triangles->normals);
  hl_release(context, triangles->triangles);
  *triangles = (iso_triangles){0};
}

/* ---- vertices ---- */

enum { EDGE_VOXELS = FIELD_TAPS + 2 };

/* The field along an edge, as sums of voxels at places that are a voxel apart along the edge. The sum at a
 * place is the weighted sum of the voxels across the edge. */
typedef struct edge_field {
  const kernel *kernel;
  double start;  /* coordinate of the edge's beginning along the edge's axis */
  int32_t first; /* index, along the edge's axis, of the first voxels in `sums` */
  double sums[EDGE_VOXELS];
} edge_field;

static edge_field field_of_edge(const lattice *lattice, int axis, const double from[3]) {
  int low = axis == 0 ? 1 : 0, high = axis == 2 ? 1 : 2; /* the two axes across the edge */
  field_taps taps[3];
  int32_t first[3], size[3];
  double voxels[EDGE_VOXELS * FIELD_TAPS * FIELD_TAPS];
  for (int a = 0; a < 3; a++) {
    taps[a] = hl_field_taps(lattice->kernel, from[a]);
    first[a] = taps[a].first;
    size[a] = a == axis ? EDGE_VOXELS : FIELD_TAPS;
  }
  hl_field_window(lattice->grid, first, size, voxels);
  const int step[3] = {1, size[0], size[0] * size[1]};
  edge_field field = {lattice->kernel, from[axis], first[axis], {0}};
  for (int n = 0; n < EDGE_VOXELS; n++)
    for (int b = 0; b < FIELD_TAPS; b++)
      for (int a = 0; a < FIELD_TAPS; a++)
        field.sums[n] += taps[low].weight[a] * taps[high].weight[b] *
                         voxels[n * step[axis] + a * step[low] + b * step[high]];
  return field;
}

static double value_on_edge(const edge_field *field, double way) {
  field_taps taps = hl_field_taps(field->kernel, field->start + way);
  double sum = 0;
  for (int tap = 0; tap < 4; tap++) {
    int n = taps.first + tap - field->first;
    if (n >= 0 && n < EDGE_VOXELS) sum += taps.weight[tap] * field->sums[n];
  }
  return sum;
}

/* The least distance of a vertex from the ends of its edge, in voxels, so that every triangle has an area. */
static const double LEAST_WAY = 1.0 / 16384;

/* Returns where on an edge the field has the surface's value, as a distance from the beginning of the edge.
 * It is found by false position (the Illinois method; Dowell and Jarratt 1971). length: the edge's length. */
static double find_crossing(const lattice *lattice, int axis, const double from[3], double length) {
  enum { MOST_STEPS = 24 };
  const edge_field field = field_of_edge(lattice, axis, from);
  double a = 0, b = length, fa = value_on_edge(&field, a) - lattice->value,
         fb = value_on_edge(&field, b) - lattice->value, way = length / 2;
  for (int step = 0; step < MOST_STEPS && b - a > 1e-5 && fa != fb; step++) {
    way = a - fa * (b - a) / (fb - fa);
    if (!(way > a && way < b)) way = (a + b) / 2;
    double f = value_on_edge(&field, way) - lattice->value;
    if (fabs(f) <= 1e-6 * fabs(fb - fa)) break;
    if ((f > 0) == (fb > 0)) b = way, fb = f, fa /= 2;
    else a = way, fa = f, fb /= 2;
  }
  return fmin(fmax(way, LEAST_WAY), length - LEAST_WAY);
}

static void place_vertex(const lattice *lattice, const lattice_brick *brick, int axis, int point,
                         float position[3], float normal[3]) {
  double at[3], length = 0;
  vec3 slope;
  for (int a = 0; a < 3; a++) {
    int32_t p = SIDE * brick->at[a] + (a == 0   ? point % SIDE
                                       : a == 1 ? point / SIDE % SIDE
                                                : point / SIDE / SIDE);
    at[a] = hl_lattice_position(lattice, a, p);
    if (a == axis) length = hl_lattice_position(lattice, a, p + 1) - at[a];
  }
  at[axis] += find_crossing(lattice, axis, at, length);
  (void)hl_field_value_and_slope(lattice->grid, lattice->kernel, vec3_of(at), &slope);
  vec3_store(position, vec3_of(at));
  vec3_store(normal, hl_iso_normal(lattice, slope));
}

static void place_vertices(void *data, size_t index, int worker) {
  (void)worker;
  const extraction *job = data;
  const lattice_brick *brick = &job->lattice->bricks[index];
  size_t vertex = brick->vertex;
  for (int axis = 0; axis < 3; axis++)
    for (uint64_t cross = brick->cross[axis]; cross != 0; cross &= cross - 1, vertex++)
      place_vertex(job->lattice, brick, axis, __builtin_ctzll(cross), job->made->positions[vertex],
                   job->made->normals[vertex]);
}

/* ---- cells ---- */

/* A point of the lattice, given by one of the eight bricks around a cell and the point's bit in it. */
typedef struct near_point {
  const lattice_brick *brick;
  int bit;
} near_point;

/* Finds a point of a brick or of its next neighbours. around: the brick and its neighbours, in the order of a
 * cube's corners. p: coordinates counted from the brick's first point, from 0 to SIDE; a coordinate of SIDE
 * lies in the next brick. */
static near_point find_point(const lattice_brick *const around[8], const int p[3]) {
  int corner = (p[0] == SIDE) + 2 * (p[1] == SIDE) + 4 * (p[2] == SIDE);
  return (near_point){around[corner], p[0] % SIDE + SIDE * (p[1] % SIDE + SIDE * (p[2] % SIDE))};
}

static void find_bricks(const lattice *lattice, const lattice_brick *brick, const lattice_brick *around[8]) {
  for (int corner = 0; corner < 8; corner++) {
    const int32_t at[3] = {brick->at[0] + (corner & 1), brick->at[1] + (corner >> 1 & 1),
                           brick->at[2] + (corner >> 2)};
    around[corner] = hl_lattice_brick(lattice, at);
  }
}

static bool is_cell(const lattice *lattice, const lattice_brick *brick, const int p[3]) {
  for (int axis = 0; axis < 3; axis++)
    if (SIDE * brick->at[axis] + p[axis] >= lattice->points[axis] - 1) return false;
  return true;
}

/* The pattern of a cell: which of its corners lie inside the surface, one bit each. It is 0 if the lattice
 * has no such cell. */
static int pattern_of_cell(const lattice *lattice, const lattice_brick *const around[8], const int cell[3]) {
  int pattern = 0;
  if (!is_cell(lattice, around[0], cell)) return 0;
  for (int corner = 0; corner < 8; corner++) {
    const int p[3] = {cell[0] + (corner & 1), cell[1] + (corner >> 1 & 1), cell[2] + (corner >> 2)};
    near_point point = find_point(around, p);
    pattern |= (int)(point.brick->inside >> point.bit & 1) << corner;
  }
  return pattern;
}

/* The number of the vertex on an edge of a cell. */
static uint32_t vertex_of_edge(const lattice_brick *const around[8], const int cell[3], int edge) {
  int corner = hl_cube_edge_corner(edge), axis = edge / 4;
  const int p[3] = {cell[0] + (corner & 1), cell[1] + (corner >> 1 & 1), cell[2] + (corner >> 2)};
  near_point point = find_point(around, p);
  uint32_t vertex = point.brick->vertex;
  for (int a = 0; a < axis; a++) vertex += (uint32_t)__builtin_popcountll(point.brick->cross[a]);
  uint64_t before = point.brick->cross[axis] & (((uint64_t)1 << point.bit) - 1);
  return vertex + (uint32_t)__builtin_popcountll(before);
}

/* Cuts the cells of a brick into triangles, and returns their number. triangles: receives the triangles; if
 * it is null, they are only counted. */
static size_t cut_cells(const extraction *job, size_t index, uint32_t (*triangles)[3]) {
  const lattice *lattice = job->lattice;
  const lattice_brick *around[8];
  size_t count = 0;
  if (!lattice->bricks[index].crossed) return 0;
  find_bricks(lattice, &lattice->bricks[index], around);
  for (int n = 0; n < POINTS; n++) {
    const int cell[3] = {n % SIDE, n / SIDE % SIDE, n / SIDE / SIDE};
    const cube_triangles *cut = &job->patterns[pattern_of_cell(lattice, around, cell)];
    for (int t = 0; triangles != NULL && t < cut->count; t++)
      for (int i = 0; i < 3; i++)
        triangles[count + (size_t)t][i] = vertex_of_edge(around, cell, cut->edge[t][i]);
    count += cut->count;
  }
  return count;
}

static void count_triangles(void *data, size_t index, int worker) {
  (void)worker;
  const extraction *job = data;
  job->lattice->bricks[index].triangle = (uint32_t)cut_cells(job, index, NULL);
}

static void write_triangles(void *data, size_t index, int worker) {
  (void)worker;
  const extraction *job = data;
  (void)cut_cells(job, index, job->made->triangles + job->lattice->bricks[index].triangle);
}

/* Gives each brick the numbers that its first vertex and its first triangle have in the mesh. */
static hl_status number_parts(extraction *job, hl_error *error) {
  size_t vertices = 0, triangles = 0;
  for (size_t b = 0; b < job->lattice->count; b++) {
    lattice_brick *brick = &job->lattice->bricks[b];
    size_t own = brick->triangle;
    brick->vertex = (uint32_t)vertices;
    brick->triangle = (uint32_t)triangles;
    for (int axis = 0; axis < 3; axis++) vertices += (size_t)__builtin_popcountll(brick->cross[axis]);
    triangles += own;
    if (vertices > UINT32_MAX || triangles > HL_LIMIT_TRIANGLES)
      return hl_fail(error, HL_ERROR_UNSUPPORTED,
                     "an isosurface of more than %d triangles: choose another value", HL_LIMIT_TRIANGLES);
  }
  job->made->vertex_count = vertices;
  job->made->triangle_count = triangles;
  return HL_OK;
}

hl_status hl_iso_extract(hl_pool *pool, lattice *lattice, iso_triangles *made, hl_error *error) {
  hl_context *context = lattice->context;
  extraction *job = hl_allocate(context, 1, sizeof *job);
  *made = (iso_triangles){0};
  if (job == NULL) return hl_fail_memory(error, sizeof *job, "an isosurface");
  job->lattice = lattice;
  job->made = made;
  hl_cube_patterns(job->patterns);
  hl_status status = hl_lattice_run(pool, lattice->count, count_triangles, job, error);
  if (status == HL_OK) status = number_parts(job, error);
  if (status == HL_OK) {
    made->positions = hl_allocate(context, made->vertex_count, sizeof *made->positions);
    made->normals = hl_allocate(context, made->vertex_count, sizeof *made->normals);
    made->triangles = hl_allocate(context, made->triangle_count, sizeof *made->triangles);
    if (made->positions == NULL || made->normals == NULL || made->triangles == NULL)
      status = hl_fail_memory(error, made->triangle_count * sizeof *made->triangles, "an isosurface");
  }
  if (status == HL_OK) status = hl_lattice_run(pool, lattice->count, place_vertices, job, error);
  if (status == HL_OK) status = hl_lattice_run(pool, lattice->count, write_triangles, job, error);
  hl_release(context, job);
  return status;
}
