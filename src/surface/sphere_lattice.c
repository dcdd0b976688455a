/* surface/sphere_lattice.c - see primitive_lattice.h: the table of spheres. */
#include "surface/primitive_lattice.h"

/* Finds where lines meet a sphere. A line that meets the sphere meets it twice. Derived: let a and b be the
 * slopes of the line (x, y). Its point at the height h is (x - a h, y - b h, h). The heights at which the
 * line meets the sphere solve a quadratic equation. */
static void meet(const surfaces *all, const surface_mesh *mesh, uint32_t primitive,
                 const lattice_lines *lines, lines_meet_function *met, const void *data) {
  const float *from = hl_sphere_of(all, primitive);
  const double a = lines->slope_across, b = lines->slope_down, radius = (double)from[3] * lines->inverse_cell,
               middle = hl_lattice_place(lines, lines->axis, (double)from[lines->axis]),
               across = hl_lattice_place(lines, lines->across, (double)from[lines->across]) + a * middle,
               down = hl_lattice_place(lines, lines->down, (double)from[lines->down]) + b * middle,
               opacity = hl_primitive_sphere.opacity(all, mesh, primitive);
  const double reach[2] = {radius * sqrt(1 + a * a), radius * sqrt(1 + b * b)};
  const whole_numbers columns = hl_whole_between(across - reach[0], across + reach[0], lines->farthest),
                      rows = hl_whole_between(down - reach[1], down + reach[1], lines->farthest);
  for (int32_t row = rows.first; row <= rows.last; row++)
    for (int32_t column = columns.first; column <= columns.last; column++) {
      /* the ray's equation with the sphere's middle as origin: (x - a h)^2 + (y - b h)^2 + h^2 = r^2 */
      const double x = column - across, y = row - down, square = 1 + a * a + b * b, half = a * x + b * y,
                   left = half * half - square * (x * x + y * y - radius * radius);
      if (!(left > 0)) continue;
      for (int side = -1; side <= 1; side += 2)
        met(data, column, row, middle + (half + side * sqrt(left)) / square, opacity);
    }
}

static void visit(const surfaces *all, uint32_t primitive, double apart, point_function *point, void *data) {
  const float *from = hl_sphere_of(all, primitive);
  const double radius = (double)from[3], steps = fmin(ceil(radius / apart) + 1, 1024);
  for (double x = -steps; x <= steps; x++)
    for (double y = -steps; y <= steps; y++)
      for (double z = -steps; z <= steps; z++) {
        if (fabs(sqrt(x * x + y * y + z * z) * apart - radius) > 1.5 * apart) continue;
        point(data, (double[3]){(double)from[0] + x * apart, (double)from[1] + y * apart,
                                (double)from[2] + z * apart});
      }
}

const primitive_lattice hl_lattice_sphere = {.meet = meet, .visit = visit};
