/* bricks/cell_walls.c - see cell_walls.h. */
#include "bricks/cell_walls.h"

#include <math.h>
#include <string.h>

#include "core/context.h"
#include "core/memory.h"

enum { FACES = 6, FACE_CORNERS = 4 };

/* The corners of the faces of a hexahedron and of a tetrahedron. */
static const int hexahedron_faces[FACES][FACE_CORNERS] = {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4},
                                                          {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};
static const int tetrahedron_faces[4][3] = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};

/* A point is looked up in front of a face at this distance, as a fraction of the face's first edge. */
static const double FRONT = 1e-3;
/* Cells that are left out have boxes beyond this coordinate. */
static const float FARTHEST = 2e30f;
/* Four corners count as flat if they span at most this part of the cube of their greatest distance. */
static const double FLAT = 1e-3;

/* ---- faces that no other cell names ---- */

/* A face's corners, as places in the cell: each point of the mesh once. */
typedef struct cell_face {
  int count; /* 3 or 4; below 3: the face has collapsed */
  int corner[FACE_CORNERS];
} cell_face;

static int face_count(const hl_cell *cell) { return hl_cell_corner_count(cell) == 4 ? 4 : FACES; }

static cell_face face_of(const hl_cell *cell, int face) {
  const bool is_tetrahedron = hl_cell_corner_count(cell) == 4;
  cell_face found = {0};
  for (int n = 0; n < (is_tetrahedron ? 3 : FACE_CORNERS); n++) {
    int corner = is_tetrahedron ? tetrahedron_faces[face][n] : hexahedron_faces[face][n];
    bool known = false;
    for (int m = 0; m < found.count; m++)
      known = known || cell->corner[found.corner[m]] == cell->corner[corner];
    if (!known) found.corner[found.count++] = corner;
  }
  return found;
}

/* The points of a face in rising order, UINT32_MAX behind the last one. */
static void points_of_face(const hl_cell *cell, int face, uint32_t points[FACE_CORNERS]) {
  const cell_face corners = face_of(cell, face);
  for (int n = 0; n < FACE_CORNERS; n++) {
    uint32_t point = n < corners.count ? cell->corner[corners.corner[n]] : UINT32_MAX;
    int place = n;
    for (; place > 0 && points[place - 1] > point; place--) points[place] = points[place - 1];
    points[place] = point;
  }
}

/* The faces of all cells, sorted by their least point. */
typedef struct face_lists {
  size_t *ends;         /* owned; [point_count + 1]; ends[p]: the place behind the last face of point p */
  uint64_t *faces;      /* owned; cell * 8 + face */
  unsigned char *alone; /* owned; [cell_count]; the faces of a cell that no other cell names, one bit each */
} face_lists;

/* Returns whether a cell is a part of the mesh. Cells that are left out have their boxes far away. */
static bool is_used(const hl_cell_tree *tree, size_t n) { return tree->boxes[n].low[0] > -FARTHEST; }

static hl_status sort_faces(hl_context *context, const hl_cells *cells, const hl_cell_tree *tree,
                            const char *subject, face_lists *lists, hl_error *error) {
  size_t count = 0;
  lists->ends = hl_allocate_zeroed(context, cells->point_count + 1, sizeof *lists->ends);
  lists->alone = hl_allocate_zeroed(context, cells->cell_count, 1);
  for (size_t n = 0; n < cells->cell_count; n++) count += (size_t)face_count(&cells->cells[n]);
  lists->faces = hl_allocate(context, count, sizeof *lists->faces);
  if (lists->ends == NULL || lists->alone == NULL || lists->faces == NULL)
    return hl_fail_memory(error, count * sizeof *lists->faces, subject);
  uint32_t points[FACE_CORNERS];
  for (size_t n = 0; n < cells->cell_count; n++)
    for (int face = 0; is_used(tree, n) && face < face_count(&cells->cells[n]); face++) {
      points_of_face(&cells->cells[n], face, points);
      lists->ends[points[0] + 1]++;
    }
  for (size_t p = 0; p < cells->point_count; p++) lists->ends[p + 1] += lists->ends[p];
  for (size_t n = 0; n < cells->cell_count; n++)
    for (int face = 0; is_used(tree, n) && face < face_count(&cells->cells[n]); face++) {
      points_of_face(&cells->cells[n], face, points);
      lists->faces[lists->ends[points[0]]++] = (uint64_t)n * 8 + (uint64_t)face;
    }
  return HL_OK;
}

static bool is_same_face(const hl_cells *cells, uint64_t one, uint64_t other) {
  uint32_t points[2][FACE_CORNERS];
  points_of_face(&cells->cells[one / 8], (int)(one % 8), points[0]);
  points_of_face(&cells->cells[other / 8], (int)(other % 8), points[1]);
  return memcmp(points[0], points[1], sizeof points[0]) == 0;
}

static void find_alone(const hl_cells *cells, const face_lists *lists) {
  for (size_t p = 0; p < cells->point_count; p++) {
    size_t begin = p == 0 ? 0 : lists->ends[p - 1], end = lists->ends[p];
    for (size_t n = begin; n < end; n++) {
      bool alone = true;
      for (size_t m = begin; m < end && alone; m++)
        alone = m == n || !is_same_face(cells, lists->faces[n], lists->faces[m]);
      if (alone) lists->alone[lists->faces[n] / 8] |= (unsigned char)(1 << lists->faces[n] % 8);
    }
  }
}

/* ---- which points lie in cells ---- */

/* The search for a cell that holds a point. */
typedef struct point_search {
  const hl_cells *cells;
  const hl_cells_place *place;
  const double *point;
  uint32_t besides; /* a cell that does not count */
  bool found;
} point_search;

static bool holds_point(void *data, uint32_t n) {
  point_search *search = data;
  hl_cell_shape shape;
  double weights[8];
  if (n == search->besides || !hl_cells_shape(search->cells, search->place, n, &shape)) return true;
  search->found = hl_cell_weights(&shape, search->point, weights);
  return !search->found;
}

bool hl_cells_hold(const hl_cells *cells, const hl_cell_tree *tree, const hl_cells_place *place,
                   const double point[3], uint32_t besides) {
  point_search search = {cells, place, point, besides, false};
  hl_cell_tree_visit(tree, point, point, holds_point, &search);
  return search.found;
}

/* ---- triangles ---- */

static double dot(const double a[3], const double b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

static void subtract(const double a[3], const double b[3], double difference[3]) {
  for (int axis = 0; axis < 3; axis++) difference[axis] = a[axis] - b[axis];
}

/* Sets a triangle's normal. Returns its doubled area. middle: a point behind the triangle. */
static double set_normal(hl_cell_wall *wall, const double middle[3]) {
  double a[3], b[3], inwards[3];
  subtract(wall->corner[1], wall->corner[0], a);
  subtract(wall->corner[2], wall->corner[0], b);
  subtract(middle, wall->corner[0], inwards);
  for (int axis = 0; axis < 3; axis++) {
    int u = (axis + 1) % 3, v = (axis + 2) % 3;
    wall->normal[axis] = a[u] * b[v] - a[v] * b[u];
  }
  double size = sqrt(dot(wall->normal, wall->normal)), sign = dot(wall->normal, inwards) > 0 ? -1 : 1;
  for (int axis = 0; axis < 3 && size > 0; axis++) wall->normal[axis] *= sign / size;
  return size;
}

/* Returns whether the four corners of a face lie in a plane. */
static bool is_flat(const hl_cell_shape *shape, const cell_face *face) {
  double edges[3][3], volume = 0, longest = 0;
  for (int n = 0; n < 3; n++) {
    subtract(shape->corner[face->corner[n + 1]], shape->corner[face->corner[0]], edges[n]);
    longest = fmax(longest, dot(edges[n], edges[n]));
  }
  for (int axis = 0; axis < 3; axis++) {
    int u = (axis + 1) % 3, v = (axis + 2) % 3;
    volume += edges[1][axis] * (edges[0][u] * edges[2][v] - edges[0][v] * edges[2][u]);
  }
  return fabs(volume) <= FLAT * longest * sqrt(longest);
}

/* Makes the triangles of a face: one, two if four corners lie in a plane, else four around the middle.
 * Returns their number. */
static int triangles_of(const hl_cell_shape *shape, const hl_cell *cell, int face, hl_cell_wall *out,
                        double middle[3]) {
  const cell_face corners = face_of(cell, face);
  double behind[3] = {0, 0, 0};
  int count = 0, all = shape->is_tetrahedron ? 4 : 8;
  memset(middle, 0, 3 * sizeof *middle);
  if (corners.count < 3) return 0;
  for (int axis = 0; axis < 3; axis++) {
    for (int c = 0; c < all; c++) behind[axis] += shape->corner[c][axis] / all;
    for (int n = 0; n < corners.count; n++)
      middle[axis] += shape->corner[corners.corner[n]][axis] / corners.count;
  }
  const int parts = corners.count == 3 ? 1 : is_flat(shape, &corners) ? 2 : 4;
  for (int n = 0; n < parts; n++) {
    hl_cell_wall *wall = &out[count];
    const int first = parts == 2 ? 2 * n : n;
    const double *last = parts == 4 ? middle : shape->corner[corners.corner[(first + 2) % corners.count]];
    memcpy(wall->corner[0], shape->corner[corners.corner[first]], sizeof wall->corner[0]);
    memcpy(wall->corner[1], shape->corner[corners.corner[(first + 1) % corners.count]],
           sizeof wall->corner[0]);
    memcpy(wall->corner[2], last, sizeof wall->corner[0]);
    if (set_normal(wall, behind) > 0) count++;
  }
  return count;
}

/* Makes the triangles of a face if it is a wall. Returns their number. */
static int wall_of_face(const hl_cells *cells, const hl_cell_tree *tree, const hl_cells_place *place,
                        size_t n, int face, const hl_cell_shape *shape, hl_cell_wall out[4]) {
  double middle[3], front[3], edge[3];
  int count = triangles_of(shape, &cells->cells[n], face, out, middle);
  if (count == 0) return 0;
  subtract(out[0].corner[1], out[0].corner[0], edge);
  double step = FRONT * sqrt(dot(edge, edge));
  for (int axis = 0; axis < 3; axis++) front[axis] = middle[axis] + step * out[0].normal[axis];
  for (int t = 0; t < count; t++) out[t].cell = (uint32_t)n;
  return hl_cells_hold(cells, tree, place, front, (uint32_t)n) ? 0 : count;
}

static hl_status make_walls(hl_context *context, const hl_cells *cells, const hl_cell_tree *tree,
                            const hl_cells_place *place, const unsigned char *alone, const char *subject,
                            hl_cell_walls *found, hl_error *error) {
  size_t room = 0;
  for (size_t n = 0; n < cells->cell_count; n++)
    for (int face = 0; face < FACES; face++) room += alone[n] >> face & 1 ? 4 : 0;
  found->walls = hl_allocate(context, room, sizeof *found->walls);
  if (found->walls == NULL) return hl_fail_memory(error, room * sizeof *found->walls, subject);
  for (size_t n = 0; n < cells->cell_count; n++) {
    hl_cell_shape shape;
    if (alone[n] == 0 || !hl_cells_shape(cells, place, n, &shape)) continue;
    for (int face = 0; face < face_count(&cells->cells[n]); face++)
      if (alone[n] >> face & 1)
        found->count += (size_t)wall_of_face(cells, tree, place, n, face, &shape,
                                             found->walls + found->count);
  }
  return HL_OK;
}

static hl_status make_tree(hl_context *context, const char *subject, hl_cell_walls *found, hl_error *error) {
  hl_cell_box *boxes = hl_allocate(context, found->count, sizeof *boxes);
  if (boxes == NULL) return hl_fail_memory(error, found->count * sizeof *boxes, subject);
  for (size_t n = 0; n < found->count; n++)
    for (int axis = 0; axis < 3; axis++) {
      const double(*c)[3] = (const double(*)[3])found->walls[n].corner;
      double low = fmin(c[0][axis], fmin(c[1][axis], c[2][axis])),
             high = fmax(c[0][axis], fmax(c[1][axis], c[2][axis]));
      boxes[n].low[axis] = (float)(low - 1e-6 * (1 + fabs(low)));
      boxes[n].high[axis] = (float)(high + 1e-6 * (1 + fabs(high)));
    }
  return hl_cell_tree_make(context, boxes, found->count, subject, &found->tree, error);
}

hl_status hl_cell_walls_find(hl_context *context, const hl_cells *cells, const hl_cell_tree *tree,
                             const hl_cells_place *place, const char *subject, hl_cell_walls *found,
                             hl_error *error) {
  face_lists lists = {0};
  *found = (hl_cell_walls){.count = 0};
  hl_status status = sort_faces(context, cells, tree, subject, &lists, error);
  if (status == HL_OK) {
    find_alone(cells, &lists);
    status = make_walls(context, cells, tree, place, lists.alone, subject, found, error);
  }
  hl_release(context, lists.ends);
  hl_release(context, lists.faces);
  hl_release(context, lists.alone);
  return status == HL_OK ? make_tree(context, subject, found, error) : status;
}

void hl_cell_walls_release(hl_context *context, hl_cell_walls *walls) {
  hl_release(context, walls->walls);
  hl_cell_tree_release(context, &walls->tree);
  *walls = (hl_cell_walls){.count = 0};
}

/* ---- distances ---- */

/* The edges of a triangle, each from a corner to the next. */
typedef struct wall_edges {
  double along[3][3];  /* unit length; the direction of the edge */
  double across[3][3]; /* unit length; the direction outwards in the triangle's plane */
  double length[3];
} wall_edges;

static wall_edges edges_of(const hl_cell_wall *wall) {
  wall_edges edges;
  for (int n = 0; n < 3; n++) {
    double *along = edges.along[n], *across = edges.across[n], inwards[3];
    subtract(wall->corner[(n + 1) % 3], wall->corner[n], along);
    subtract(wall->corner[(n + 2) % 3], wall->corner[n], inwards);
    edges.length[n] = sqrt(dot(along, along));
    for (int axis = 0; axis < 3; axis++) along[axis] /= edges.length[n];
    for (int axis = 0; axis < 3; axis++) {
      int u = (axis + 1) % 3, v = (axis + 2) % 3;
      across[axis] = along[u] * wall->normal[v] - along[v] * wall->normal[u];
    }
    if (dot(across, inwards) > 0)
      for (int axis = 0; axis < 3; axis++) across[axis] = -across[axis];
  }
  return edges;
}

/* The square of the distance from a point to a triangle, or a lower bound that exceeds `most`. above: the
 * point's distance to the plane. A point that is outside of some edges is nearest to a place on one of
 * these. */
static double distance_to(const hl_cell_wall *wall, const wall_edges *edges, const double point[3],
                          double above, double most) {
  double from[3][3], outside[3], least = INFINITY, farthest = 0;
  for (int n = 0; n < 3; n++) {
    subtract(point, wall->corner[n], from[n]);
    outside[n] = dot(from[n], edges->across[n]);
    farthest = outside[n] > farthest ? outside[n] : farthest;
  }
  const double bound = above * above + farthest * farthest;
  if (farthest == 0 || bound > most) return bound;
  for (int n = 0; n < 3; n++) {
    if (!(outside[n] > 0)) continue;
    double along = dot(from[n], edges->along[n]), beyond = 0;
    if (along < 0) beyond = along;
    if (along > edges->length[n]) beyond = along - edges->length[n];
    double distance = above * above + outside[n] * outside[n] + beyond * beyond;
    least = distance < least ? distance : least;
  }
  return least;
}

/* A box of lattice points whose nearest walls are searched. */
typedef struct near_job {
  const hl_cell_walls *walls;
  double scale, reach;
  const ptrdiff_t *first;
  const size_t *count;
  hl_wall_near *near;
} near_job;

/* Nearest places of two triangles count as the same place if the squares of their distances differ by less.
 */
static const double SAME = 1e-9;

static bool note_wall(void *data, uint32_t n) {
  const near_job *job = data;
  const hl_cell_wall *wall = &job->walls->walls[n];
  const hl_cell_box *box = &job->walls->tree.boxes[n];
  const wall_edges edges = edges_of(wall);
  ptrdiff_t low[3], high[3], at[3];
  for (int axis = 0; axis < 3; axis++) {
    low[axis] = (ptrdiff_t)fmax(ceil(((double)box->low[axis] - job->reach) / job->scale),
                                (double)job->first[axis]);
    high[axis] = (ptrdiff_t)fmin(floor(((double)box->high[axis] + job->reach) / job->scale),
                                 (double)job->first[axis] + (double)job->count[axis] - 1);
  }
  for (at[2] = low[2]; at[2] <= high[2]; at[2]++)
    for (at[1] = low[1]; at[1] <= high[1]; at[1]++)
      for (at[0] = low[0]; at[0] <= high[0]; at[0]++) {
        const double point[3] = {(double)at[0] * job->scale, (double)at[1] * job->scale,
                                 (double)at[2] * job->scale};
        hl_wall_near *near =
            &job->near[((size_t)(at[2] - job->first[2]) * job->count[1] + (size_t)(at[1] - job->first[1])) *
                           job->count[0] +
                       (size_t)(at[0] - job->first[0])];
        double from[3];
        subtract(point, wall->corner[0], from);
        double above = dot(from, wall->normal);
        if (above * above > near->squared + SAME) continue;
        double squared = distance_to(wall, &edges, point, above, near->squared + SAME);
        if (squared < near->squared - SAME ||
            (squared < near->squared + SAME && fabs(above) > fabs(near->above)))
          *near = (hl_wall_near){n, fmin(squared, near->squared), above};
      }
  return true;
}

void hl_cell_walls_near(const hl_cell_walls *walls, int level, const ptrdiff_t first[3],
                        const size_t count[3], double reach, hl_wall_near *near) {
  near_job job = {walls, (double)(1 << level), reach, first, count, near};
  double low[3], high[3];
  for (int axis = 0; axis < 3; axis++) {
    low[axis] = (double)first[axis] * job.scale - reach;
    high[axis] = ((double)first[axis] + (double)count[axis] - 1) * job.scale + reach;
  }
  hl_cell_tree_visit(&walls->tree, low, high, note_wall, &job);
}
