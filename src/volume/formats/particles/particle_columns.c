/* volume/formats/particles/particle_columns.c - collects particles that are rows of a text. */
#include "volume/formats/particles/particle_columns.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "core/context.h"
#include "core/memory.h"
#include "volume/formats/particles/particles.h"
#include "volume/io/text.h"

/* ---- names ---- */

/* The names that ParaView, OVITO, pandas, LAMMPS, yt and pynbody give to columns of particles. */
static const struct {
  const char *names;
  hl_particle_role role;
} roles[] = {
    {"x|xu|xs|xsu|pos_x|posx|position_x|position.x|positions_0|position_0|points:0|points_0|coordinates_0|"
     "coordinates_x",
     HL_COLUMN_X},
    {"y|yu|ys|ysu|pos_y|posy|position_y|position.y|positions_1|position_1|points:1|points_1|coordinates_1|"
     "coordinates_y",
     HL_COLUMN_Y},
    {"z|zu|zs|zsu|pos_z|posz|position_z|position.z|positions_2|position_2|points:2|points_2|coordinates_2|"
     "coordinates_z",
     HL_COLUMN_Z},
    {"mass|masses|m|particle_mass", HL_COLUMN_MASS},
    {"h|hsml|smoothing_length|smoothinglength|smoothing length|smooth", HL_COLUMN_LENGTH},
};

int hl_particle_words(char *line, char *words[HL_PARTICLE_COLUMNS_MOST]) {
  int count = 0;
  char *at = line;
  while (count < HL_PARTICLE_COLUMNS_MOST) {
    at += strspn(at, " \t\r\n,;");
    if (*at == 0) break;
    if (*at == '"') {
      words[count++] = ++at;
      at += strcspn(at, "\"");
    } else {
      words[count++] = at;
      at += strcspn(at, " \t\r\n,;");
    }
    if (*at != 0) *at++ = 0;
  }
  return count;
}

hl_particle_role hl_particle_role_of(const char *name) {
  for (size_t r = 0; r < sizeof roles / sizeof *roles; r++)
    if (hl_text_is_one_of(name, roles[r].names)) return roles[r].role;
  return HL_COLUMN_QUANTITY;
}

void hl_particle_columns_add(hl_particle_columns *columns, const char *name) {
  if (columns->column_count == HL_PARTICLE_COLUMNS_MOST) return;
  hl_particle_column *column = &columns->column[columns->column_count++];
  *column = (hl_particle_column){.role = hl_particle_role_of(name)};
  hl_text_printable(column->name, name);
  for (const hl_particle_column *before = columns->column; before < column; before++)
    if (column->role != HL_COLUMN_QUANTITY && before->role == column->role) column->role = HL_COLUMN_QUANTITY;
  column->is_scaled = column->role <= HL_COLUMN_Z && hl_text_is_one_of(name, "xs|ys|zs|xsu|ysu|zsu");
}

static const hl_particle_column *find_role(const hl_particle_columns *columns, hl_particle_role role) {
  for (int c = 0; c < columns->column_count; c++)
    if (columns->column[c].role == role) return &columns->column[c];
  return NULL;
}

bool hl_particle_columns_are_places(const hl_particle_columns *columns) {
  return find_role(columns, HL_COLUMN_X) != NULL && find_role(columns, HL_COLUMN_Y) != NULL &&
         find_role(columns, HL_COLUMN_Z) != NULL;
}

/* ---- rows ---- */

static hl_status make_room(hl_particle_columns *columns, hl_error *error) {
  if (columns->count < columns->room) return HL_OK;
  size_t room = columns->room == 0 ? 256 : 2 * columns->room;
  void *positions = hl_reallocate(columns->context, columns->positions, room, sizeof *columns->positions);
  if (positions == NULL) return hl_fail_memory(error, room * sizeof *columns->positions, "particles");
  columns->positions = positions;
  for (int c = 0; c < columns->column_count; c++) {
    hl_particle_column *column = &columns->column[c];
    if (column->role <= HL_COLUMN_Z || column->role == HL_COLUMN_UNREAD) continue;
    float *values = hl_reallocate(columns->context, column->values, room, sizeof *values);
    if (values == NULL) return hl_fail_memory(error, room * sizeof *values, "particles");
    column->values = values;
  }
  columns->room = room;
  return HL_OK;
}

static hl_status take_word(hl_particle_columns *columns, int c, const char *word, const hl_stream *stream,
                           int number, hl_error *error) {
  hl_particle_column *column = &columns->column[c];
  double value;
  if (!hl_text_number(word, strlen(word), &value)) {
    if (column->role == HL_COLUMN_QUANTITY && columns->count == 0) {
      column->role = HL_COLUMN_UNREAD;
      return HL_OK;
    }
    char shown[HL_PRINTABLE_BYTES];
    return HL_FAIL_LINE(error, HL_ERROR_INPUT, stream, number, "the column %s has \"%s\", which is no number",
                        column->name, hl_text_printable(shown, word));
  }
  if (column->role > HL_COLUMN_Z) column->values[columns->count] = (float)value;
  else
    columns->positions[columns->count][column->role] =
        column->is_scaled ? columns->box_low[column->role] + value * columns->box[column->role] : value;
  return HL_OK;
}

hl_status hl_particle_columns_row(hl_particle_columns *columns, char *line, const hl_stream *stream,
                                  int number, hl_error *error) {
  char *words[HL_PARTICLE_COLUMNS_MOST];
  int count = hl_particle_words(line, words);
  if (count == 0) return HL_OK;
  if (count < columns->column_count)
    return HL_FAIL_LINE(error, HL_ERROR_INPUT, stream, number, "%d numbers, where %d columns are named",
                        count, columns->column_count);
  hl_status status = make_room(columns, error);
  for (int c = 0; c < columns->column_count && status == HL_OK; c++)
    if (columns->column[c].role != HL_COLUMN_UNREAD)
      status = take_word(columns, c, words[c], stream, number, error);
  if (status == HL_OK) columns->count++;
  return status;
}

void hl_particle_columns_clear(hl_particle_columns *columns) { columns->count = 0; }

void hl_particle_columns_release(hl_particle_columns *columns) {
  hl_release(columns->context, columns->positions);
  for (int c = 0; c < columns->column_count; c++) hl_release(columns->context, columns->column[c].values);
  *columns = (hl_particle_columns){.context = columns->context};
}

/* ---- the volume ---- */

enum { LEAST_SIDE = 64, MOST_SIDE = 1024 };

static hl_status list_arrays(const hl_particle_columns *columns, hl_load_request *request, hl_error *error) {
  hl_status status = hl_arrays_add(request, "log density", 1, HL_VOXEL_F32, false, error);
  if (status == HL_OK) status = hl_arrays_add(request, "density", 1, HL_VOXEL_F32, false, error);
  for (int c = 0; c < columns->column_count && status == HL_OK; c++)
    if (columns->column[c].role == HL_COLUMN_QUANTITY)
      status = hl_arrays_add(request, columns->column[c].name, 1, HL_VOXEL_F32, false, error);
  return status;
}

/* The column of the quantity with the index `number` among the quantities. */
static const hl_particle_column *quantity(const hl_particle_columns *columns, size_t number) {
  for (int c = 0; c < columns->column_count; c++)
    if (columns->column[c].role == HL_COLUMN_QUANTITY && number-- == 0) return &columns->column[c];
  return NULL;
}

hl_status hl_particle_columns_volume(const hl_particle_columns *columns, hl_load_request *request,
                                     const char *path, hl_volume **volume, hl_error *error) {
  hl_particles_description d;
  hl_particles_description_defaults(&d);
  if (columns->count == 0)
    return hl_fail(error, HL_ERROR_INPUT, "%s: a table of particles without a row: give at least one", path);
  hl_status status = list_arrays(columns, request, error);
  if (status == HL_OK) status = hl_arrays_choose(request, path, 0, error);
  if (status != HL_OK) return status;
  if (request->component > 0)
    return hl_fail(error, HL_ERROR_INPUT, "%s: there is no component %d: particles have one", path,
                   request->component);
  const hl_particle_column *mass = find_role(columns, HL_COLUMN_MASS),
                           *length = find_role(columns, HL_COLUMN_LENGTH);
  d.count = columns->count;
  d.positions = columns->positions;
  d.masses = mass != NULL ? mass->values : NULL;
  d.lengths = length != NULL ? length->values : NULL;
  d.quantity = request->chosen == 0   ? HL_PARTICLES_LOG_DENSITY
               : request->chosen == 1 ? HL_PARTICLES_DENSITY
                                      : HL_PARTICLES_MEAN;
  if (request->chosen > 1) d.values = quantity(columns, request->chosen - 2)->values;
  memcpy(d.period_low, columns->box_low, sizeof d.period_low);
  memcpy(d.period, columns->period, sizeof d.period);
  d.spacing = request->spacing[0];
  if (request->pixels > 0)
    d.side = request->pixels < LEAST_SIDE  ? LEAST_SIDE
             : request->pixels > MOST_SIDE ? MOST_SIDE
                                           : (size_t)request->pixels;
  status = hl_particles_to_volume(request->context, &d, path, volume, error);
  if (status == HL_OK)
    hl_log(request->context, HL_LOG_INFO,
           "%s: %zu particles, spread by %s over %zu x %zu x %zu voxels: \"spacing\" (--spacing) sets "
           "another distance",
           path, columns->count,
           length != NULL ? "their smoothing lengths" : "the distances of their neighbours",
           (*volume)->dimension[0], (*volume)->dimension[1], (*volume)->dimension[2]);
  return status;
}
