/* field/surface_links.c - triangles and spheres met by the links of a lattice.
 *
 * Links of one kind join cells with the same neighbour of the slice before. They follow each other along
 * straight lines. The points of a surface are moved aside so that these lines become upright and stand at
 * whole numbers (derived: a line that goes from column c + across to column c has the same c + across h at
 * all heights h). Two triangles that share an edge never both meet a line on the edge. */
#include "field/surface_links.h"

#include "field/field_planes.h"

/* Links of one kind along an axis. */
typedef struct link_lines {
  field_slices slices;
  const surface_links *links;
  const link_places *places;         /* null: the links do not join neighbours along the axis */
  double low[3], cell, inverse_cell; /* low corner and cell of the lattice */
  double farthest;                   /* the farthest distance aside of a line, in cells, at which the line
                                      * still meets the lattice */
  int across, down;                  /* columns and rows from a cell to the neighbour in the slice before
                                      * with which the line joins it */
  int kind;
} link_lines;

/* The fraction of a cell by which the middles of the lattice's cells are moved along each axis. Without this,
 * a wall that stands upright in the middle of cells would cut the links on both of its sides, or on none. */
static const double ASIDE[3] = {1.17e-4, 1.43e-4, 1.61e-4};

/* A place along an axis, in cells; 0 is the middle of the first cell. */
static double place_along(const link_lines *lines, int axis, double at) {
  return (at - lines->low[axis]) * lines->inverse_cell - (0.5 + ASIDE[axis]);
}

/* ---- memory ---- */

static size_t bytes_of_links(const field_slices *s) {
  return ((size_t)s->slices + 1) * FIELD_LINKS * hl_field_planes(s).plane;
}

static size_t blocks_of(const field_slices *s) {
  return (size_t)s->slices * (size_t)s->rows * (size_t)(s->stride / FIELD_LANES);
}

void hl_surface_links_lay_out(const field_lattice *lattice, surface_links *links, hl_layout *layout) {
  size_t taken = 0, cut = 0;
  for (int axis = 0; axis < 3; axis++) {
    const field_slices s = hl_field_slices(lattice, axis);
    taken = bytes_of_links(&s) > taken ? bytes_of_links(&s) : taken;
    cut = blocks_of(&s) > cut ? blocks_of(&s) : cut;
  }
  links->taken = hl_layout_take(layout, taken, 1);
  links->cut = hl_layout_take(layout, cut, 1);
}

/* ---- a line meets a surface ---- */

/* Marks the block of a cell, which may lie beyond the lattice, with LINKS_BEFORE or LINKS_AFTER. The tasks of
 * several kinds of links mark the same blocks. */
static void mark_block(const link_lines *lines, int32_t slice, int32_t row, int32_t column,
                       unsigned char mark) {
  const field_slices *s = &lines->slices;
  if (slice < 0 || row < 0 || row >= s->rows || column < 0 || column >= s->columns) return;
  const size_t at = ((size_t)slice * (size_t)s->rows + (size_t)row) * (size_t)s->stride + (size_t)column;
  __atomic_fetch_or(&lines->links->cut[at / FIELD_LANES], mark, __ATOMIC_RELAXED);
}

/* Takes a part of the light of the link that lies at a given height of a line. */
static void cut_link(const link_lines *lines, int32_t across, int32_t down, double height, double opacity) {
  const field_slices *s = &lines->slices;
  if (!(height > -1 && height < s->slices)) return;
  const int32_t slice = (int32_t)floor(height) + 1, column = across - lines->across * slice,
                row = down - lines->down * slice;
  if (slice >= s->slices || column < 0 || column >= s->columns || row < 0 || row >= s->rows) return;
  const field_planes planes = hl_field_planes(s);
  unsigned char *taken = lines->links->taken +
                         ((size_t)slice * FIELD_LINKS + (size_t)lines->kind) * planes.plane +
                         hl_plane_place(&planes, row, column);
  *taken = (unsigned char)(255 - (int)((255 - *taken) * (1 - opacity) + 0.5));
  mark_block(lines, slice, row, column, LINKS_BEFORE);
  mark_block(lines, slice - 1, row + lines->down, column + lines->across, LINKS_AFTER);
  if (lines->places == NULL || slice == 0) return;
  const size_t *step = lines->places->step;
  float *place = lines->places->first + (size_t)(slice - 1) * step[s->axis] + (size_t)row * step[s->down] +
                 (size_t)column * step[s->across],
        way = (float)fmax(height - (slice - 1), 1e-3);
  if (*place == 0 || way < *place) *place = way;
}

/* Whether the mesh's cuts leave a point of a line. */
static bool is_left(const field_surface *surface, const link_lines *lines, double across, double down,
                    double height) {
  const field_slices *s = &lines->slices;
  double at[3];
  if (surface->cut_count == 0) return true;
  at[s->across] = across - lines->across * height;
  at[s->down] = down - lines->down * height;
  at[s->axis] = height;
  for (int a = 0; a < 3; a++) at[a] = lines->low[a] + (at[a] + 0.5 + ASIDE[a]) * lines->cell;
  return hl_cuts_leave(surface->cuts, surface->cut_count, vec3_of(at));
}

/* ---- triangles ---- */

static double lesser(double a, double b) { return a < b ? a : b; }
static double greater(double a, double b) { return a > b ? a : b; }

/* The whole numbers between two places along an axis; lines stand at whole numbers. */
typedef struct whole_numbers {
  int32_t first, last; /* there are none where last < first */
} whole_numbers;

static int32_t round_down(double x) {
  const int32_t whole = (int32_t)x;
  return whole - (x < whole);
}

/* Finds the whole numbers from `low` to `high`, positions along an axis. most: lines at whole numbers beyond
 * -most and most do not meet the lattice, and are left out. */
static whole_numbers whole_between(double low, double high, double most) {
  if (!(low <= most && high >= -most)) return (whole_numbers){0, -1};
  return (whole_numbers){-round_down(-greater(low, -most)), round_down(lesser(high, most))};
}

static whole_numbers whole_between_corners(const double at[3], double most) {
  return whole_between(lesser(at[0], lesser(at[1], at[2])), greater(at[0], greater(at[1], at[2])), most);
}

/* A triangle, with the lines upright. */
typedef struct seen_triangle {
  double across[3], down[3], height[3];
  double area; /* twice the area, signed */
  whole_numbers columns, rows;
} seen_triangle;

/* Brings a triangle to the lines of the lattice. False: no line meets the triangle. For most small
 * triangles the test by rows alone tells this. */
static bool see(const field_surface *surface, uint32_t triangle, const link_lines *lines, seen_triangle *t) {
  const field_slices *s = &lines->slices;
  const uint32_t *corner = surface->triangles[triangle];
  for (int i = 0; i < 3; i++) {
    const float *at = surface->positions[corner[i]];
    t->height[i] = place_along(lines, s->axis, (double)at[s->axis]);
    t->down[i] = place_along(lines, s->down, (double)at[s->down]) + lines->down * t->height[i];
  }
  t->rows = whole_between_corners(t->down, lines->farthest);
  if (t->rows.first > t->rows.last) return false;
  for (int i = 0; i < 3; i++)
    t->across[i] = place_along(lines, s->across, (double)surface->positions[corner[i]][s->across]) +
                   lines->across * t->height[i];
  t->columns = whole_between_corners(t->across, lines->farthest);
  t->area = (t->across[1] - t->across[0]) * (t->down[2] - t->down[0]) -
            (t->across[2] - t->across[0]) * (t->down[1] - t->down[0]);
  return t->columns.first <= t->columns.last && fabs(t->area) > 0;
}

/* Whether a line meets the triangle. For each corner, twice the area between the opposite edge and the line
 * is compared with 0, with the triangle's sign. A line on an edge belongs to the triangle on one of the
 * edge's sides. */
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

static void cut_by_triangle(const field_surface *surface, uint32_t triangle, const link_lines *lines) {
  seen_triangle t;
  if (!see(surface, triangle, lines, &t)) return;
  const double opacity = opacity_of(surface, triangle);
  for (int32_t row = t.rows.first; row <= t.rows.last; row++)
    for (int32_t column = t.columns.first; column <= t.columns.last; column++) {
      double weight[3], height = 0;
      if (!meets(&t, column, row, weight)) continue;
      for (int corner = 0; corner < 3; corner++) height += weight[corner] * t.height[corner];
      if (is_left(surface, lines, column, row, height)) cut_link(lines, column, row, height, opacity);
    }
}

/* ---- spheres ---- */

/* Cuts the links of a line at a sphere. A line within the sphere's reach meets it twice. Derived: if a and
 * b are the slopes of the line (x, y), its point at height h is (x - a h, y - b h, h). The heights at which
 * the line meets the sphere solve a quadratic equation. */
static void cut_by_sphere(const field_surface *surface, uint32_t sphere, const link_lines *lines) {
  const field_slices *s = &lines->slices;
  const float *from = surface->spheres[sphere];
  const double a = lines->across, b = lines->down, radius = (double)from[3] * lines->inverse_cell,
               middle = place_along(lines, s->axis, (double)from[s->axis]),
               across = place_along(lines, s->across, (double)from[s->across]) + a * middle,
               down = place_along(lines, s->down, (double)from[s->down]) + b * middle;
  const double opacity = surface->opacity *
                         (surface->sphere_colors != NULL ? (double)surface->sphere_colors[sphere][3] : 1);
  const double reach[2] = {radius * sqrt(1 + a * a), radius * sqrt(1 + b * b)};
  const whole_numbers columns = whole_between(across - reach[0], across + reach[0], lines->farthest),
                      rows = whole_between(down - reach[1], down + reach[1], lines->farthest);
  for (int32_t row = rows.first; row <= rows.last; row++)
    for (int32_t column = columns.first; column <= columns.last; column++) {
      /* (x - a h)^2 + (y - b h)^2 + h^2 = r^2, from the sphere's middle */
      const double x = column - across, y = row - down, square = 1 + a * a + b * b, half = a * x + b * y,
                   left = half * half - square * (x * x + y * y - radius * radius);
      if (!(left > 0)) continue;
      for (int side = -1; side <= 1; side += 2) {
        const double height = middle + (half + side * sqrt(left)) / square;
        if (is_left(surface, lines, column, row, height)) cut_link(lines, column, row, height, opacity);
      }
    }
}

/* ---- all links along an axis ---- */

typedef struct links_job {
  const field_surface *surfaces; /* [count] */
  size_t count;
  link_lines lines; /* without the kind, which each task sets */
} links_job;

/* Finds the links of one kind; each kind is a task. */
static void find_kind(void *data, size_t kind, int worker) {
  const links_job *job = data;
  link_lines lines = job->lines;
  (void)worker;
  lines.kind = (int)kind;
  lines.across = lines.kind % 3 - 1;
  lines.down = lines.kind / 3 - 1;
  if (lines.across != 0 || lines.down != 0) lines.places = NULL;
  for (size_t i = 0; i < job->count; i++) {
    const field_surface *surface = &job->surfaces[i];
    if (!surface->casts_shadow) continue;
    for (uint32_t t = 0; t < surface->triangle_count; t++) cut_by_triangle(surface, t, &lines);
    for (uint32_t k = 0; k < surface->sphere_count; k++) cut_by_sphere(surface, k, &lines);
  }
}

void hl_surface_links_find(const field_surface *surfaces, size_t count, const field_lattice *lattice,
                           int axis, const surface_links *links, const link_places *places, hl_pool *pool) {
  const field_slices s = hl_field_slices(lattice, axis);
  links_job job = {surfaces,
                   count,
                   {.slices = s,
                    .links = links,
                    .places = places,
                    .low = {lattice->low.x, lattice->low.y, lattice->low.z},
                    .cell = lattice->cell,
                    .inverse_cell = 1 / lattice->cell,
                    .farthest = s.slices + s.rows + s.columns}};
  hl_pool_clear(pool, links->taken, bytes_of_links(&s));
  hl_pool_clear(pool, links->cut, blocks_of(&s));
  hl_pool_run(pool, FIELD_LINKS, find_kind, &job);
}

/* ---- what is seen ---- */

static void mark_point(opacity_field *field, const double at[3]) {
  const field_lattice *lattice = &field->lattice;
  const double low[3] = {lattice->low.x, lattice->low.y, lattice->low.z};
  size_t index = 0;
  for (int a = 2; a >= 0; a--) {
    const double cell = floor((at[a] - low[a]) / lattice->cell);
    if (!(cell >= 0 && cell < lattice->count[a])) return;
    index = index * (size_t)lattice->count[a] + (size_t)cell;
  }
  field->seen[index] = 1;
}

/* Marks the cells at points of a triangle that are at most a cell apart. */
static void mark_triangle(const field_surface *surface, uint32_t triangle, opacity_field *field) {
  vec3 at[3];
  for (int i = 0; i < 3; i++) {
    const float *corner = surface->positions[surface->triangles[triangle][i]];
    at[i] = (vec3){(double)corner[0], (double)corner[1], (double)corner[2]};
  }
  const vec3 u = vec3_subtract(at[1], at[0]), v = vec3_subtract(at[2], at[0]);
  const double longest = fmax(fmax(vec3_length(u), vec3_length(v)), vec3_length(vec3_subtract(u, v)));
  const double steps = fmin(ceil(longest / field->lattice.cell), 4096);
  for (double i = 0; i <= steps; i++)
    for (double j = 0; i + j <= steps; j++) {
      const double part[2] = {steps > 0 ? i / steps : 0, steps > 0 ? j / steps : 0};
      const vec3 point = vec3_add(at[0], vec3_add(vec3_scale(u, part[0]), vec3_scale(v, part[1])));
      mark_point(field, (double[3]){point.x, point.y, point.z});
    }
}

/* Marks the cells around a sphere's surface. */
static void mark_sphere(const field_surface *surface, uint32_t sphere, opacity_field *field) {
  const float *from = surface->spheres[sphere];
  const double cell = field->lattice.cell, radius = (double)from[3];
  const double steps = fmin(ceil(radius / cell) + 1, 1024);
  for (double x = -steps; x <= steps; x++)
    for (double y = -steps; y <= steps; y++)
      for (double z = -steps; z <= steps; z++) {
        if (fabs(sqrt(x * x + y * y + z * z) * cell - radius) > 1.5 * cell) continue;
        mark_point(field, (double[3]){(double)from[0] + x * cell, (double)from[1] + y * cell,
                                      (double)from[2] + z * cell});
      }
}

void hl_surface_mark_seen(const field_surface *surface, opacity_field *field) {
  for (uint32_t t = 0; t < surface->triangle_count; t++) mark_triangle(surface, t, field);
  for (uint32_t i = 0; i < surface->sphere_count; i++) mark_sphere(surface, i, field);
}
