/* isosurface/cubes.c - derives the patterns in which a surface cuts a cube (cubes.h).
 *
 * Walk around a face of the cube, counter-clockwise as seen from outside. On the face, the surface runs from
 * the edge where the walk enters the inside of the surface to the edge where the walk leaves it again. An
 * edge belongs to two faces. If the walk around one face enters the inside at this edge, the walk around the
 * second face leaves the inside at the edge. The pairs of edges therefore link the crossed edges to loops,
 * and the loops are cut into triangles. The two cubes that share a face find the same pairs of edges on the
 * face, so that the surface has no holes. If exactly two opposite corners of a face are inside, the surface
 * cuts off each of them separately. */
#include "isosurface/cubes.h"

int hl_cube_edge_corner(int edge) {
  int axis = edge / 4, across = edge % 4, low = axis == 0 ? 1 : 0, high = axis == 2 ? 1 : 2;
  return (across & 1) << low | (across >> 1) << high;
}

/* The number of the edge between two corners of a cube. */
static int edge_between(int a, int b) {
  int axis = (a ^ b) >> 1, from = a & b; /* the difference 1, 2 or 4 becomes the axis 0, 1 or 2 */
  int low = axis == 0 ? 1 : 0, high = axis == 2 ? 1 : 2;
  return 4 * axis + (from >> low & 1) + 2 * (from >> high & 1);
}

/* Finds the four corners of a face of a cube, in order around the face. Faces 2 a and 2 a + 1 are the low and
 * the high face across axis a. */
static void corners_of_face(int face, int corner[4]) {
  int axis = face / 2, u = 1 << (axis + 1) % 3, v = 1 << (axis + 2) % 3;
  const int low[4] = {0, v, u | v, u}, high[4] = {0, u, u | v, v};
  for (int i = 0; i < 4; i++) corner[i] = face % 2 ? high[i] | 1 << axis : low[i];
}

/* For each edge of a cube at which a walk around the face enters the inside, sets next[edge] to the edge at
 * which the walk leaves the inside again. */
static void link_face(int pattern, int face, int next[CUBE_EDGES]) {
  int corner[4];
  corners_of_face(face, corner);
  for (int i = 0; i < 4; i++) {
    int at = (i + 1) % 4;
    if ((pattern >> corner[i] & 1) != 0 || (pattern >> corner[at] & 1) == 0) continue;
    while ((pattern >> corner[(at + 1) % 4] & 1) != 0) at = (at + 1) % 4;
    next[edge_between(corner[i], corner[(i + 1) % 4])] = edge_between(corner[at], corner[(at + 1) % 4]);
  }
}

static void cut_loop(const int loop[CUBE_EDGES], int length, cube_triangles *triangles) {
  for (int i = 1; i + 1 < length; i++) {
    uint8_t *edge = triangles->edge[triangles->count++];
    edge[0] = (uint8_t)loop[0], edge[1] = (uint8_t)loop[i], edge[2] = (uint8_t)loop[i + 1];
  }
}

void hl_cube_patterns(cube_triangles *patterns) {
  for (int pattern = 0; pattern < CUBE_PATTERNS; pattern++) {
    int next[CUBE_EDGES];
    patterns[pattern] = (cube_triangles){0};
    for (int edge = 0; edge < CUBE_EDGES; edge++) next[edge] = -1;
    for (int face = 0; face < 6; face++) link_face(pattern, face, next);
    for (int edge = 0; edge < CUBE_EDGES; edge++) {
      int loop[CUBE_EDGES], length = 0;
      for (int at = edge, after; next[at] >= 0; at = after) {
        loop[length++] = at;
        after = next[at];
        next[at] = -1;
      }
      cut_loop(loop, length, &patterns[pattern]);
    }
  }
}
