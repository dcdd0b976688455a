/* surface/triangle_lattice.c - defines the table of functions by which lines through a lattice meet triangles
 * (primitive_lattice.h).
 *
 * The points of a triangle are sheared, so that the lines become upright and have whole numbers as columns
 * and rows. Derived: a line that goes through column c at the height 0 goes through column c - slope h at the
 * height h. So the column plus slope h is c at every height. */
#include "surface/primitive_lattice.h"

static double lesser(double a, double b) { return a < b ? a : b; }
static double greater(double a, double b) { return a > b ? a : b; }

static whole_numbers whole_between_corners(const double at[3], double most) {
  return hl_whole_between(lesser(at[0], lesser(at[1], at[2])), greater(at[0], greater(at[1], at[2])), most);
}

/* A triangle, sheared so that the lattice's lines are upright. */
typedef struct seen_triangle {
  double across[3], down[3], height[3];
  double area; /* twice the triangle's area, with a sign */
  whole_numbers columns, rows;
} seen_triangle;

/* Transforms a triangle to the space in which the lines are upright. Returns false if no line meets the
 * triangle. For most small triangles the test of rows alone shows this. */
static bool see(const surfaces *all, uint32_t triangle, const lattice_lines *lines, seen_triangle *t) {
  const uint32_t *corner = all->triangles[triangle];
  for (int i = 0; i < 3; i++) {
    const float *at = all->positions[corner[i]];
    t->height[i] = hl_lattice_place(lines, lines->axis, (double)at[lines->axis]);
    t->down[i] = hl_lattice_place(lines, lines->down, (double)at[lines->down]) +
                 lines->slope_down * t->height[i];
  }
  t->rows = whole_between_corners(t->down, lines->farthest);
  if (t->rows.first > t->rows.last) return false;
  for (int i = 0; i < 3; i++)
    t->across[i] = hl_lattice_place(lines, lines->across, (double)all->positions[corner[i]][lines->across]) +
                   lines->slope_across * t->height[i];
  t->columns = whole_between_corners(t->across, lines->farthest);
  t->area = (t->across[1] - t->across[0]) * (t->down[2] - t->down[0]) -
            (t->across[2] - t->across[0]) * (t->down[1] - t->down[0]);
  return t->columns.first <= t->columns.last && fabs(t->area) > 0;
}

/* Returns whether a line meets the triangle. For each corner, the area of the triangle between the opposite
 * edge and the line is compared with 0; the area has a sign. If a line goes through an edge, it meets only
 * the triangle on one side of the edge. */
static bool meets(const seen_triangle *t, double across, double down, double weight[3]) {
  for (int corner = 0; corner < 3; corner++) {
    int a = (corner + 1) % 3, b = (corner + 2) % 3;
    double along = t->across[b] - t->across[a], below = t->down[b] - t->down[a];
    double edge = along * (down - t->down[a]) - below * (across - t->across[a]);
    if (t->area < 0) edge = -edge, along = -along, below = -below;
    if (edge < 0 || (edge == 0 && !(below > 0 || (below == 0 && along < 0)))) return false;
    weight[corner] = edge / fabs(t->area);
  }
  return true;
}

static void meet(const surfaces *all, const surface_mesh *mesh, uint32_t primitive,
                 const lattice_lines *lines, lines_meet_function *met, const void *data) {
  seen_triangle t;
  if (!see(all, primitive, lines, &t)) return;
  const double opacity = hl_primitive_triangle.opacity(all, mesh, primitive);
  for (int32_t row = t.rows.first; row <= t.rows.last; row++)
    for (int32_t column = t.columns.first; column <= t.columns.last; column++) {
      double weight[3], height = 0;
      if (!meets(&t, column, row, weight)) continue;
      for (int corner = 0; corner < 3; corner++) height += weight[corner] * t.height[corner];
      met(data, column, row, height, opacity);
    }
}

static void visit(const surfaces *all, uint32_t primitive, double apart, point_function *point, void *data) {
  vec3 at[3];
  for (int i = 0; i < 3; i++) at[i] = hl_surface_vector(all->positions[all->triangles[primitive][i]]);
  const vec3 u = vec3_subtract(at[1], at[0]), v = vec3_subtract(at[2], at[0]);
  const double longest = fmax(fmax(vec3_length(u), vec3_length(v)), vec3_length(vec3_subtract(u, v)));
  const double steps = fmin(ceil(longest / apart), 4096);
  for (double i = 0; i <= steps; i++)
    for (double j = 0; i + j <= steps; j++) {
      const double part[2] = {steps > 0 ? i / steps : 0, steps > 0 ? j / steps : 0};
      const vec3 on = vec3_add(at[0], vec3_add(vec3_scale(u, part[0]), vec3_scale(v, part[1])));
      point(data, (double[3]){on.x, on.y, on.z});
    }
}

const primitive_lattice hl_lattice_triangle = {.meet = meet, .visit = visit};
