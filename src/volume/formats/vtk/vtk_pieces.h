/* volume/formats/vtk/vtk_pieces.h - reads the pieces of XML files of VTK that have points: unstructured
 * grids, curvilinear grids, and PolyData. A pass over the tags lists the pieces and their arrays. */
#ifndef HL_VOLUME_VTK_PIECES_H
#define HL_VOLUME_VTK_PIECES_H

#include "volume/formats/vtk/vtk_xml.h"

/* The elements of a piece that hold arrays. */
typedef enum hl_vtk_section {
  HL_VTK_POINTS,
  HL_VTK_CELLS,
  HL_VTK_POINT_DATA,
  HL_VTK_CELL_DATA,
  HL_VTK_NO_SECTION
} hl_vtk_section;

typedef struct hl_vtk_piece_array {
  hl_vtk_array array;
  hl_vtk_section section;
  char name[HL_VTK_NAME_BYTES];
  size_t components; /* at least 1 */
  bool is_active;    /* whether the section marks the array as its active scalars */
  bool is_id;        /* whether the array's values are the numbers of the section's points or cells */
} hl_vtk_piece_array;

typedef struct hl_vtk_piece {
  size_t point_count, cell_count;
  size_t size[3];       /* number of points along each axis of a curvilinear grid */
  size_t surface_count; /* number of lines, polygons and strips of PolyData */
  size_t first_array, array_count;
} hl_vtk_piece;

typedef struct hl_vtk_pieces {
  hl_context *context;
  const char *const *types;   /* [type_count]; the types of files that the reader takes */
  size_t type_count, type;    /* type: index of the file's type in `types` */
  hl_vtk_xml xml;             /* the caller sets xml.stream before reading */
  hl_vtk_piece *pieces;       /* owned; [piece_count]; the pieces that have points */
  hl_vtk_piece_array *arrays; /* owned; [array_count]; the arrays of the first piece, then of the second
                               * piece, and so on */
  size_t piece_count, piece_room, array_count, array_room;
  hl_vtk_section section;
  char active[HL_VTK_NAME_BYTES]; /* name of the section's active scalars */
  char ids[2][HL_VTK_NAME_BYTES]; /* names of the section's arrays of numbers of points or cells */
  bool in_piece;
} hl_vtk_pieces;

/* Reads all tags of a file. The members context, types, type_count and xml.stream must be set, and all others
 * must be zero. The caller must release the pieces also after a failure. */
hl_status hl_vtk_pieces_read(hl_vtk_pieces *pieces, hl_error *error);
void hl_vtk_pieces_release(hl_vtk_pieces *pieces);

/* The first array with this name in a piece's section; null if the section lacks the array. name: null stands
 * for any name. */
const hl_vtk_piece_array *hl_vtk_pieces_find(const hl_vtk_pieces *pieces, const hl_vtk_piece *piece,
                                             hl_vtk_section section, const char *name);

/* Reads `tuples` tuples of an array; *numbers is owned by the caller. *stream: the file's stream; the
 * function opens the file anew and replaces *stream. */
hl_status hl_vtk_pieces_numbers(hl_stream **stream, hl_vtk_pieces *pieces, const hl_vtk_piece_array *array,
                                size_t tuples, double **numbers, hl_error *error);

/* Fails with an error that says that a piece lacks the array `what`. */
hl_status hl_vtk_pieces_fail_missing(const hl_vtk_pieces *pieces, const char *what, hl_error *error);

#endif
