/* volume/formats/particles/particle_columns.h - collects particles that are rows of a text. The readers of
 * tables, dumps of LAMMPS and XYZ files use these functions.
 *
 * The name of a column tells whether the column is a coordinate, the mass, the smoothing length, or a
 * quantity. Columns whose first entry is not a number are left out. The arrays that can be loaded are "log
 * density", "density", and for each quantity an array of the quantity's mean weighted by mass. */
#ifndef HL_VOLUME_PARTICLE_COLUMNS_H
#define HL_VOLUME_PARTICLE_COLUMNS_H

#include "volume/formats/format.h"

enum { HL_PARTICLE_COLUMNS_MOST = 64, HL_PARTICLE_NAME_BYTES = 64 };

typedef enum hl_particle_role {
  HL_COLUMN_X,
  HL_COLUMN_Y,
  HL_COLUMN_Z,
  HL_COLUMN_MASS,
  HL_COLUMN_LENGTH,
  HL_COLUMN_QUANTITY,
  HL_COLUMN_UNREAD
} hl_particle_role;

typedef struct hl_particle_column {
  char name[HL_PARTICLE_NAME_BYTES]; /* printable */
  hl_particle_role role;
  bool is_scaled; /* whether the column is a coordinate from 0 to 1 within the box (LAMMPS xs, ys, zs) */
  float *values;  /* owned; [room]; null for coordinates and columns that are not read */
} hl_particle_column;

typedef struct hl_particle_columns {
  hl_context *context;
  size_t count, room;     /* number of particles; room for particles */
  double (*positions)[3]; /* owned; [room] */
  hl_particle_column column[HL_PARTICLE_COLUMNS_MOST];
  int column_count;
  double box_low[3], box[3]; /* in the world: the lowest corner and the size of the box of scaled
                              * coordinates */
  double period[3];          /* in the world: period along each axis; 0 if the box is not periodic along the
                              * axis */
} hl_particle_columns;

/* Splits a line into words, in place, at commas, semicolons, tabs and spaces. Removes quotes around words.
 * Returns the number of words; words after the first HL_PARTICLE_COLUMNS_MOST are ignored. */
int hl_particle_words(char *line, char *words[HL_PARTICLE_COLUMNS_MOST]);

/* Returns the role of a column with this name, such as a coordinate or the mass. */
hl_particle_role hl_particle_role_of(const char *name);

/* Adds a column by its name, before the first row. Columns beyond HL_PARTICLE_COLUMNS_MOST are left out. */
void hl_particle_columns_add(hl_particle_columns *columns, const char *name);

/* Returns whether the columns include x, y and z. */
bool hl_particle_columns_are_places(const hl_particle_columns *columns);

/* Adds the particle of a line. The text of the line is changed. number: the line's number, for errors. */
hl_status hl_particle_columns_row(hl_particle_columns *columns, char *line, const hl_stream *stream,
                                  int number, hl_error *error);

/* Lists the file's arrays, and makes the volume of the chosen one. */
hl_status hl_particle_columns_volume(const hl_particle_columns *columns, hl_load_request *request,
                                     const char *path, hl_volume **volume, hl_error *error);

/* Removes all particles. Names of columns and memory are kept. */
void hl_particle_columns_clear(hl_particle_columns *columns);
void hl_particle_columns_release(hl_particle_columns *columns);

#endif
