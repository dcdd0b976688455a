/* field/surface_cover.c - triangles met by rays along the axes, a few for each cell.
 *
 * A ray through a cell's face meets a triangle or not; the cell takes the triangle's opacity of the ray's
 * part of the light. Triangles that share an edge never meet the same ray at it. */
#include "field/surface_cover.h"

enum { RAYS = 3 /* through a cell, along each side */ };

/* A triangle as an axis's rays see it: `across` and `down` in rays, height in cells. */
typedef struct seen_triangle {
  double across[3], down[3], height[3];
  double area; /* twice, signed */
} seen_triangle;

static seen_triangle see(const field_surface *surface, uint32_t triangle, const field_lattice *lattice,
                         const field_slices *s) {
  seen_triangle seen;
  const double low[3] = {lattice->low.x, lattice->low.y, lattice->low.z};
  for (int corner = 0; corner < 3; corner++) {
    const float *at = surface->positions[surface->triangles[triangle][corner]];
    seen.across[corner] = ((double)at[s->across] - low[s->across]) / lattice->cell * RAYS - 0.5;
    seen.down[corner] = ((double)at[s->down] - low[s->down]) / lattice->cell * RAYS - 0.5;
    seen.height[corner] = ((double)at[s->axis] - low[s->axis]) / lattice->cell;
  }
  seen.area = (seen.across[1] - seen.across[0]) * (seen.down[2] - seen.down[0]) -
              (seen.across[2] - seen.across[0]) * (seen.down[1] - seen.down[0]);
  return seen;
}

/* Three times: the edge opposite to a corner, as twice the area between it and the ray; of the triangle's
 * sign. A ray on an edge belongs to the triangle on one of its sides. */
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

static double opacity_of(const field_surface *surface, uint32_t triangle) {
  double opacity = surface->opacity, sum = 0;
  if (surface->face_colors != NULL) opacity *= (double)surface->face_colors[triangle][3];
  if (surface->colors == NULL) return opacity;
  for (int corner = 0; corner < 3; corner++)
    sum += (double)surface->colors[surface->triangles[triangle][corner] - surface->first_vertex][3] / 3;
  return opacity * sum;
}

/* Whether the mesh's cuts leave a point at a ray and a height. */
static bool is_left(const field_surface *surface, const field_lattice *lattice, const field_slices *s,
                    const double at[3]) {
  double point[3] = {lattice->low.x, lattice->low.y, lattice->low.z};
  point[s->across] += (at[0] + 0.5) / RAYS * lattice->cell;
  point[s->down] += (at[1] + 0.5) / RAYS * lattice->cell;
  point[s->axis] += at[2] * lattice->cell;
  return hl_cuts_leave(surface->cuts, surface->cut_count, vec3_of(point));
}

static void cover_cell(opacity_field *field, const field_slices *s, const int32_t cell[3], float opacity,
                       bool visible, float *cover) {
  if (cell[0] < 0 || cell[0] >= s->columns || cell[1] < 0 || cell[1] >= s->rows || cell[2] < 0 ||
      cell[2] >= s->slices)
    return;
  const size_t step[3] = {1, (size_t)field->lattice.count[0],
                          (size_t)field->lattice.count[0] * (size_t)field->lattice.count[1]};
  size_t at = (size_t)cell[0] * step[s->across] + (size_t)cell[1] * step[s->down] +
              (size_t)cell[2] * step[s->axis];
  cover[at] += opacity;
  if (visible) field->seen[at] = 1;
}

static int32_t limited(double x, int32_t count) {
  return x < 0 ? 0 : x > (double)count - 1 ? count - 1 : (int32_t)x;
}

static void cover_triangle(const field_surface *surface, uint32_t triangle, opacity_field *field,
                           const field_slices *s, float *cover) {
  seen_triangle t = see(surface, triangle, &field->lattice, s);
  if (!(fabs(t.area) > 0)) return;
  float opacity = surface->casts_shadow ? (float)(opacity_of(surface, triangle) / (RAYS * RAYS)) : 0;
  double low[2] = {fmin(t.across[0], fmin(t.across[1], t.across[2])),
                   fmin(t.down[0], fmin(t.down[1], t.down[2]))},
         high[2] = {fmax(t.across[0], fmax(t.across[1], t.across[2])),
                    fmax(t.down[0], fmax(t.down[1], t.down[2]))};
  int32_t first_row = limited(ceil(low[1]), s->rows * RAYS),
          last_row = limited(floor(high[1]), s->rows * RAYS),
          first = limited(ceil(low[0]), s->columns * RAYS), last = limited(floor(high[0]), s->columns * RAYS);
  for (int32_t row = first_row; row <= last_row; row++)
    for (int32_t column = first; column <= last; column++) {
      double weight[3], height = 0;
      if (!meets(&t, column, row, weight)) continue;
      for (int corner = 0; corner < 3; corner++) height += weight[corner] * t.height[corner];
      if (!is_left(surface, &field->lattice, s, (double[3]){column, row, height})) continue;
      const int32_t cell[3] = {column / RAYS, row / RAYS, height < 0 ? -1 : (int32_t)fmin(height, s->slices)};
      cover_cell(field, s, cell, opacity, surface->visible, cover);
    }
}

/* A ray within the radius meets a sphere twice. */
static void cover_sphere(const field_surface *surface, uint32_t sphere, opacity_field *field,
                         const field_slices *s, float *cover) {
  const float *from = surface->spheres[sphere];
  const double low[3] = {field->lattice.low.x, field->lattice.low.y, field->lattice.low.z};
  double middle[3], cell = field->lattice.cell, radius = (double)from[3] / cell;
  double opacity = surface->casts_shadow ? surface->opacity / (RAYS * RAYS) : 0;
  if (surface->sphere_colors != NULL) opacity *= (double)surface->sphere_colors[sphere][3];
  for (int a = 0; a < 3; a++) middle[a] = ((double)from[a] - low[a]) / cell;
  double across = middle[s->across] * RAYS - 0.5, down = middle[s->down] * RAYS - 0.5, reach = radius * RAYS;
  int32_t first_row = limited(ceil(down - reach), s->rows * RAYS),
          last_row = limited(floor(down + reach), s->rows * RAYS),
          first = limited(ceil(across - reach), s->columns * RAYS),
          last = limited(floor(across + reach), s->columns * RAYS);
  for (int32_t row = first_row; row <= last_row; row++)
    for (int32_t column = first; column <= last; column++) {
      double x = (column - across) / RAYS, y = (row - down) / RAYS, left = radius * radius - x * x - y * y;
      if (!(left > 0)) continue;
      for (int side = -1; side <= 1; side += 2) {
        double height = middle[s->axis] + side * sqrt(left);
        if (!is_left(surface, &field->lattice, s, (double[3]){column, row, height})) continue;
        const int32_t at[3] = {column / RAYS, row / RAYS, height < 0 ? -1 : (int32_t)fmin(height, s->slices)};
        cover_cell(field, s, at, (float)opacity, surface->visible, cover);
      }
    }
}

void hl_surface_cover(const field_surface *surface, opacity_field *field, float *const cover[3]) {
  for (int axis = 0; axis < 3; axis++) {
    field_slices s = hl_field_slices(&field->lattice, axis);
    for (uint32_t t = 0; t < surface->triangle_count; t++) cover_triangle(surface, t, field, &s, cover[axis]);
    for (uint32_t i = 0; i < surface->sphere_count; i++) cover_sphere(surface, i, field, &s, cover[axis]);
  }
}
