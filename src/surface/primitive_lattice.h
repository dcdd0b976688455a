/* surface/primitive_lattice.h - finds where straight lines through a lattice of cells meet primitives of a
 * kind.
 *
 * Each kind of primitive (primitive.h) has one such table. The sky's light goes from cell to cell along such
 * lines (field/surface_links.h). */
#ifndef HL_SURFACE_PRIMITIVE_LATTICE_H
#define HL_SURFACE_PRIMITIVE_LATTICE_H

#include "surface/primitive.h"

/* Parallel lines, along an axis of a lattice or slanted against it. Line (c, r) goes through the column c and
 * the row r at the height 0. At the height h it goes through the column c - slope_across h and the row r -
 * slope_down h. Columns, rows and heights are measured in cells; 0 is the middle of the first cell. */
typedef struct lattice_lines {
  int axis, across, down;      /* the axes of heights, columns and rows */
  double low[3], inverse_cell; /* low: the lattice's low corner, in frame space; inverse_cell: 1 over the edge
                                * of a cell, in frame units */
  double middle[3];            /* the position of the middle of the first cell, in cells from the lattice's
                                * low corner */
  int slope_across, slope_down;
  double farthest; /* lines (c, r) in which |c| or |r| is greater than this are left out */
} lattice_lines;

/* The function that is called for each place at which a line meets a primitive. opacity: the fraction of
 * light that the primitive absorbs at this place. */
typedef void lines_meet_function(const void *data, int32_t column, int32_t row, double height,
                                 double opacity);

/* The function that is called for each point on a primitive; `at` is in frame space. */
typedef void point_function(void *data, const double at[3]);

struct primitive_lattice {
  /* Finds all places at which lines (c, r) with whole numbers c and r meet a primitive. Of two triangles that
   * share an edge, only one meets a line that goes through the edge. */
  void (*meet)(const surfaces *all, const surface_mesh *mesh, uint32_t primitive, const lattice_lines *lines,
               lines_meet_function *met, const void *data);
  /* Calls a function for points on a primitive, or near it. The points are at most `apart` away from each
   * other. */
  void (*visit)(const surfaces *all, uint32_t primitive, double apart, point_function *point, void *data);
};

/* The tables of the kinds of primitives; each table is in a file of its own (primitive_kinds.h). */
#define HL_PRIMITIVE(name) extern const primitive_lattice hl_lattice_##name;
HL_PRIMITIVES
#undef HL_PRIMITIVE

/* Converts a place along an axis to cells of the lattice; 0 is the middle of the first cell. */
static inline double hl_lattice_place(const lattice_lines *lines, int axis, double at) {
  return (at - lines->low[axis]) * lines->inverse_cell - lines->middle[axis];
}

/* All whole numbers from `first` to `last`, both included. */
typedef struct whole_numbers {
  int32_t first, last; /* there are no such whole numbers if last < first */
} whole_numbers;

static inline int32_t hl_round_down(double x) {
  const int32_t whole = (int32_t)x;
  return whole - (x < whole);
}

/* Finds the whole numbers between `low` and `high` whose magnitudes are at most `most`. */
static inline whole_numbers hl_whole_between(double low, double high, double most) {
  if (!(low <= most && high >= -most)) return (whole_numbers){0, -1};
  return (whole_numbers){-hl_round_down(-(low > -most ? low : -most)),
                         hl_round_down(high < most ? high : most)};
}

#endif
