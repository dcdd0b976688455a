/* field/surface_links.c - finds the links between cells of a lattice that meshes cut (surface_links.h).
 *
 * Links of one kind join cells with the same neighbour of the slice before. They follow each other along
 * straight lines, whose slopes are the columns and rows from a cell to this neighbour. The kinds of
 * primitives find where they meet such lines (surface/primitive_lattice.h). */
#include "field/surface_links.h"

#include "field/field_planes.h"
#include "surface/primitive_lattice.h"

/* The links of one kind along an axis, as lines that may meet meshes. */
typedef struct link_lines {
  field_slices slices;
  const surface_links *links;
  /* receives the places where links are cut; null if the links do not join neighbours along the axis */
  const link_places *places;
  lattice_lines lines;
  double cell; /* the edge of a cell; frame units */
  const surfaces *all;
  const surface_mesh *mesh; /* the mesh that meets the lines */
  int kind;
} link_lines;

/* The fraction of a cell by which the middles of the lattice's cells are moved along each axis. Without this,
 * a wall that stands upright in the middle of cells would cut the links on both of its sides, or on none. */
static const double ASIDE[3] = {1.17e-4, 1.43e-4, 1.61e-4};

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

/* ---- a line meets a mesh ---- */

/* Marks the block of a cell with LINKS_BEFORE or LINKS_AFTER. The cell may lie beyond the lattice, and then
 * nothing is marked. The tasks of several kinds of links mark the same blocks. */
static void mark_block(const link_lines *lines, int32_t slice, int32_t row, int32_t column,
                       unsigned char mark) {
  const field_slices *s = &lines->slices;
  if (slice < 0 || row < 0 || row >= s->rows || column < 0 || column >= s->columns) return;
  const size_t at = ((size_t)slice * (size_t)s->rows + (size_t)row) * (size_t)s->stride + (size_t)column;
  __atomic_fetch_or(&lines->links->cut[at / FIELD_LANES], mark, __ATOMIC_RELAXED);
}

/* Cuts the link of a line in which a given height lies: the link loses the fraction `opacity` of its
 * light. */
static void cut_link(const link_lines *lines, int32_t across, int32_t down, double height, double opacity) {
  const field_slices *s = &lines->slices;
  if (!(height > -1 && height < s->slices)) return;
  const int32_t slice = (int32_t)floor(height) + 1, column = across - lines->lines.slope_across * slice,
                row = down - lines->lines.slope_down * slice;
  if (slice >= s->slices || column < 0 || column >= s->columns || row < 0 || row >= s->rows) return;
  const field_planes planes = hl_field_planes(s);
  unsigned char *taken = lines->links->taken +
                         ((size_t)slice * FIELD_LINKS + (size_t)lines->kind) * planes.plane +
                         hl_plane_place(&planes, row, column);
  *taken = (unsigned char)(255 - (int)((255 - *taken) * (1 - opacity) + 0.5));
  mark_block(lines, slice, row, column, LINKS_BEFORE);
  mark_block(lines, slice - 1, row + lines->lines.slope_down, column + lines->lines.slope_across,
             LINKS_AFTER);
  if (lines->places == NULL || slice == 0) return;
  const size_t *step = lines->places->step;
  float *place = lines->places->first + (size_t)(slice - 1) * step[s->axis] + (size_t)row * step[s->down] +
                 (size_t)column * step[s->across],
        way = (float)fmax(height - (slice - 1), 1e-3);
  if (*place == 0 || way < *place) *place = way;
}

/* Returns whether the cuts of a mesh leave the mesh at a point of a line. */
static bool is_left(const link_lines *of, int32_t column, int32_t row, double height) {
  const lattice_lines *lines = &of->lines;
  double at[3];
  if (!of->mesh->is_cut) return true;
  at[lines->across] = column - lines->slope_across * height;
  at[lines->down] = row - lines->slope_down * height;
  at[lines->axis] = height;
  for (int a = 0; a < 3; a++) at[a] = lines->low[a] + (at[a] + lines->middle[a]) * of->cell;
  return hl_surface_left(of->all, of->mesh, vec3_of(at));
}

static void meet_line(const void *data, int32_t column, int32_t row, double height, double opacity) {
  const link_lines *lines = data;
  if (is_left(lines, column, row, height)) cut_link(lines, column, row, height, opacity);
}

/* ---- all links along an axis ---- */

/* Cuts the links of one kind. Each of the FIELD_LINKS kinds is a task. */
static void find_kind(void *data, size_t kind, int worker) {
  link_lines lines = *(const link_lines *)data;
  (void)worker;
  lines.kind = (int)kind;
  lines.lines.slope_across = lines.kind % 3 - 1;
  lines.lines.slope_down = lines.kind / 3 - 1;
  if (lines.lines.slope_across != 0 || lines.lines.slope_down != 0) lines.places = NULL;
  for (size_t m = 0; m < lines.all->mesh_count; m++) {
    lines.mesh = &lines.all->meshes[m];
    if (!lines.mesh->look.casts_shadow) continue;
    for (int k = 0; k < PRIMITIVE_KINDS; k++) {
      const primitive_range range = lines.mesh->primitives[k];
      for (uint32_t i = 0; i < range.count; i++)
        hl_primitive_kinds[k]->lattice->meet(lines.all, lines.mesh, range.first + i, &lines.lines, meet_line,
                                             &lines);
    }
  }
}

void hl_surface_links_find(const surfaces *all, const field_lattice *lattice, int axis,
                           const surface_links *links, const link_places *places, hl_pool *pool) {
  const field_slices s = hl_field_slices(lattice, axis);
  link_lines lines = {.slices = s,
                      .links = links,
                      .places = places,
                      .lines = {.axis = s.axis,
                                .across = s.across,
                                .down = s.down,
                                .low = {lattice->low.x, lattice->low.y, lattice->low.z},
                                .inverse_cell = 1 / lattice->cell,
                                .farthest = s.slices + s.rows + s.columns},
                      .cell = lattice->cell,
                      .all = all};
  for (int a = 0; a < 3; a++) lines.lines.middle[a] = 0.5 + ASIDE[a];
  hl_pool_clear(pool, links->taken, bytes_of_links(&s));
  hl_pool_clear(pool, links->cut, blocks_of(&s));
  hl_pool_run(pool, FIELD_LINKS, find_kind, &lines);
}

/* ---- the part that is seen ---- */

static void mark_point(void *data, const double at[3]) {
  opacity_field *field = data;
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

void hl_surface_mark_seen(const surfaces *all, opacity_field *field) {
  for (size_t m = 0; m < all->mesh_count; m++)
    for (int k = 0; k < PRIMITIVE_KINDS && all->meshes[m].look.visible; k++) {
      const primitive_range range = all->meshes[m].primitives[k];
      for (uint32_t i = 0; i < range.count; i++)
        hl_primitive_kinds[k]->lattice->visit(all, range.first + i, field->lattice.cell, mark_point, field);
    }
}
