/* volume/formats/particles/lammps.c - reads text dumps of LAMMPS, which hold particles at time steps.
 *
 * Source: the page "dump command" of LAMMPS' manual. A step is a sequence of items: "ITEM: TIMESTEP", "ITEM:
 * NUMBER OF ATOMS", "ITEM: BOX BOUNDS" with the kinds of the borders ("pp": periodic), and "ITEM: ATOMS" with
 * the names of the columns. The box of a triclinic cell, whose line has "xy xz yz", is taken as not
 * periodic. */
#include <stdio.h>
#include <string.h>

#include "core/context.h"
#include "volume/formats/particles/particle_columns.h"
#include "volume/io/text.h"

typedef struct lammps_dump {
  hl_stream *stream;
  int number; /* number of the current line */
  char line[HL_LINE_BYTES];
  bool ended;
  size_t atoms;   /* number of atoms of the step that is being read */
  bool has_atoms; /* whether the current step's atoms have been read */
  size_t steps;   /* number of steps that have begun so far */
  size_t wanted;  /* the index of the step to read */
  hl_particle_columns columns;
} lammps_dump;

static bool has_content(const unsigned char *bytes, size_t length) {
  static const char *const items[] = {"ITEM: TIMESTEP", "ITEM: UNITS", "ITEM: TIME"};
  for (size_t n = 0; n < sizeof items / sizeof *items; n++)
    if (length > strlen(items[n]) && memcmp(bytes, items[n], strlen(items[n])) == 0) return true;
  return false;
}

static hl_status next_line(lammps_dump *dump, hl_error *error) {
  dump->number++;
  return hl_stream_line(dump->stream, dump->line, &dump->ended, error);
}

static hl_status next_number(lammps_dump *dump, hl_error *error) {
  hl_status status = next_line(dump, error);
  if (status != HL_OK) return status;
  if (dump->ended || hl_text_sizes(dump->line, &dump->atoms, 1) != 1)
    return HL_FAIL_LINE(error, HL_ERROR_INPUT, dump->stream, dump->number, "%s",
                        "a number of atoms is expected after ITEM: NUMBER OF ATOMS");
  return HL_OK;
}

/* Reads the box of a step. kinds: the rest of the line "ITEM: BOX BOUNDS", which states the kind of each
 * border. */
static hl_status read_box(lammps_dump *dump, const char *kinds, hl_error *error) {
  hl_particle_columns *columns = &dump->columns;
  bool triclinic = strstr(kinds, "xy") != NULL || strstr(kinds, "abc") != NULL,
       periodic[3] = {false, false, false};
  char word[8];
  for (int axis = 0; axis < 3 && !triclinic && hl_text_word(&kinds, word, sizeof word); axis++)
    periodic[axis] = strcmp(word, "pp") == 0;
  for (int axis = 0; axis < 3; axis++) {
    double bounds[3];
    hl_status status = next_line(dump, error);
    if (status != HL_OK) return status;
    if (dump->ended || hl_text_numbers(dump->line, bounds, 3) < 2)
      return HL_FAIL_LINE(error, HL_ERROR_INPUT, dump->stream, dump->number,
                          "the bounds of axis %d are expected", axis);
    columns->box_low[axis] = bounds[0];
    columns->box[axis] = bounds[1] - bounds[0];
    columns->period[axis] = periodic[axis] && columns->box[axis] > 0 ? columns->box[axis] : 0;
  }
  return HL_OK;
}

/* Reads the names of the columns. names: the rest of the line "ITEM: ATOMS". */
static hl_status read_atoms(lammps_dump *dump, char *names, hl_error *error) {
  bool wanted = dump->steps == dump->wanted + 1;
  if (dump->has_atoms)
    return HL_FAIL_LINE(error, HL_ERROR_INPUT, dump->stream, dump->number, "%s",
                        "the step has atoms already: \"ITEM: TIMESTEP\" is expected");
  dump->has_atoms = true;
  char *words[HL_PARTICLE_COLUMNS_MOST];
  int count = hl_particle_words(names, words);
  for (int n = 0; n < count && wanted; n++) hl_particle_columns_add(&dump->columns, words[n]);
  if (wanted && !hl_particle_columns_are_places(&dump->columns))
    return HL_FAIL_LINE(error, HL_ERROR_INPUT, dump->stream, dump->number, "%s",
                        "the atoms have no x, y and z: dump them, too");
  for (size_t n = 0; n < dump->atoms; n++) {
    hl_status status = next_line(dump, error);
    if (status == HL_OK && dump->ended)
      return HL_FAIL_LINE(error, HL_ERROR_INPUT, dump->stream, dump->number,
                          "the file ends after %zu of %zu atoms", n, dump->atoms);
    if (status == HL_OK && wanted)
      status = hl_particle_columns_row(&dump->columns, dump->line, dump->stream, dump->number, error);
    if (status != HL_OK) return status;
  }
  return HL_OK;
}

static hl_status read_item(lammps_dump *dump, hl_error *error) {
  static const char bounds[] = "ITEM: BOX BOUNDS", atoms[] = "ITEM: ATOMS";
  if (hl_text_starts(dump->line, "ITEM: TIMESTEP")) {
    dump->steps++;
    dump->has_atoms = false;
    return next_line(dump, error);
  }
  if (hl_text_starts(dump->line, "ITEM: NUMBER OF ATOMS")) return next_number(dump, error);
  if (hl_text_starts(dump->line, bounds)) {
    char kinds[64];
    snprintf(kinds, sizeof kinds, "%.60s", dump->line + sizeof bounds - 1);
    return read_box(dump, kinds, error);
  }
  if (hl_text_starts(dump->line, atoms)) {
    char names[HL_LINE_BYTES];
    snprintf(names, sizeof names, "%s", dump->line + sizeof atoms - 1);
    return read_atoms(dump, names, error);
  }
  if (hl_text_starts(dump->line, "ITEM: ")) return next_line(dump, error); /* skips units, time */
  return dump->line[strspn(dump->line, " \t")] == 0
             ? HL_OK
             : HL_FAIL_LINE(error, HL_ERROR_INPUT, dump->stream, dump->number, "%s",
                            "\"ITEM: \" is expected");
}

static hl_status load(hl_stream **stream, hl_load_request *request, hl_volume **volume, hl_error *error) {
  lammps_dump dump = {.stream = *stream,
                      .wanted = request->time > 0 ? (size_t)request->time : 0,
                      .columns = {.context = request->context}};
  hl_status status = next_line(&dump, error);
  while (status == HL_OK && !dump.ended) {
    status = read_item(&dump, error);
    if (status == HL_OK) status = next_line(&dump, error);
  }
  if (status == HL_OK)
    status = hl_steps_choose(request, (*stream)->path, dump.steps > 0 ? dump.steps : 1, 1, error);
  if (status == HL_OK)
    status = hl_particle_columns_volume(&dump.columns, request, (*stream)->path, volume, error);
  hl_particle_columns_release(&dump.columns);
  return status;
}

const hl_format hl_format_lammps = {
    .name = "LAMMPS dumps",
    .endings = {".lammpstrj", ".lammpsdump"},
    .beginning = "\"ITEM: TIMESTEP\"",
    .has_content = has_content,
    .load = load,
};
