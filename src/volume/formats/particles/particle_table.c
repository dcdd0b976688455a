/* volume/formats/particles/particle_table.c - reads tables of particles as text: .csv, .tsv, .txt.
 *
 * The first line names the columns, which must include x, y and z, separated by commas, semicolons, tabs or
 * spaces. The first line may begin with '#'. Each further line is a particle; lines that begin with '#' are
 * left out. */
#include <string.h>

#include "volume/formats/particles/particle_columns.h"
#include "volume/io/text.h"

/* Adds the columns that a line names. line: the text of the line, which the function changes. */
static void name_columns(char *line, hl_particle_columns *columns) {
  char *words[HL_PARTICLE_COLUMNS_MOST];
  int count = hl_particle_words(line + strspn(line, "# \t"), words);
  for (int n = 0; n < count; n++) hl_particle_columns_add(columns, words[n]);
}

static bool has_content(const unsigned char *bytes, size_t length) {
  char line[HL_FORMAT_SNIFFED_BYTES + 1];
  size_t end = 0;
  for (; end < length && bytes[end] != '\n' && bytes[end] != '\r'; end++) {
    if (bytes[end] == 0) return false;
    line[end] = (char)bytes[end];
  }
  line[end] = 0;
  hl_particle_columns columns = {.column_count = 0};
  name_columns(line, &columns);
  return hl_particle_columns_are_places(&columns);
}

static hl_status load(hl_stream **stream, hl_load_request *request, hl_volume **volume, hl_error *error) {
  hl_particle_columns columns = {.context = request->context};
  char line[HL_LINE_BYTES];
  bool ended = false;
  hl_status status = HL_OK;
  for (int number = 1; status == HL_OK && !ended; number++) {
    status = hl_stream_line(*stream, line, &ended, error);
    if (status != HL_OK || ended) break;
    if (number == 1) name_columns(line, &columns);
    else if (line[strspn(line, " \t")] != '#')
      status = hl_particle_columns_row(&columns, line, *stream, number, error);
  }
  if (status == HL_OK) status = hl_particle_columns_volume(&columns, request, (*stream)->path, volume, error);
  hl_particle_columns_release(&columns);
  return status;
}

const hl_format hl_format_particle_table = {
    .name = "tables of particles",
    .endings = {".csv", ".tsv"},
    .beginning = "the names of its columns, x, y and z among them",
    .has_content = has_content,
    .load = load,
};
