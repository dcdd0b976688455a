/* cli/info/formats.c - implements `halflight info --formats`, which lists the formats that this program reads
 * and writes. */
#include "formats.h"

#include <halflight/halflight.h>
#include <stdio.h>
#include <string.h>

#include "cli/json_writer.h"
#include "cli/message.h"
#include "cli/openvdb.h"

/* A kind of formats: volumes, pictures and so on. get: hl_volume_get_format() or a function like it. */
typedef struct format_kind {
  const char *key, *title;
  hl_status (*get)(size_t index, hl_file_format *format);
} format_kind;

static const format_kind kinds[] = {
    {"volumes", "volumes", hl_volume_get_format},
    {"packings", "packed bytes and pictures in volume files", hl_volume_get_packing},
    {"meshes", "meshes", hl_mesh_get_format},
    {"pictures", "pictures", hl_image_get_format},
    {"figures", "figures", hl_figure_get_format}};
enum { KIND_COUNT = sizeof kinds / sizeof *kinds };

/* Gets format number `index` of a kind. Returns false if the kind has no more formats. */
static bool get_format(const format_kind *kind, size_t index, hl_file_format *format) {
  *format = (hl_file_format){.struct_size = sizeof *format};
  if (kind->get(index, format) != HL_OK) return false;
  if (strcmp(format->read_endings, ".vdb") == 0 && format->reads && !openvdb_is_there()) {
    format->reads = 0;
    format->missing = "halflight-openvdb or nanovdb_convert";
  }
  return true;
}

static void print_endings(json_writer *json, const char *key, const char *endings) {
  json_open_array(json, key);
  for (const char *at = endings; *at != '\0';) {
    char ending[sizeof(hl_file_format)];
    size_t length = strcspn(at, " ");
    snprintf(ending, sizeof ending, "%.*s", (int)length, at);
    json_text(json, NULL, ending);
    at += length + strspn(at + length, " ");
  }
  json_close(json);
}

static void print_json(void) {
  json_writer json = {0};
  json_open_object(&json, NULL);
  for (int kind = 0; kind < KIND_COUNT; kind++) {
    hl_file_format format;
    json_open_array(&json, kinds[kind].key);
    for (size_t n = 0; get_format(&kinds[kind], n, &format); n++) {
      json_open_object(&json, NULL);
      json_text(&json, "name", format.name);
      json_bool(&json, "reads", format.reads != 0);
      json_bool(&json, "writes", format.writes != 0);
      print_endings(&json, "read_endings", format.read_endings);
      print_endings(&json, "written_endings", format.written_endings);
      json_text(&json, "missing", format.missing);
      json_close(&json);
    }
    json_close(&json);
  }
  json_close(&json);
}

static void print_line(const hl_file_format *format) {
  printf("  %-28s", format->name);
  const char *between = "";
  if (format->missing != NULL) printf("is missing: this build lacks %s", format->missing);
  if (format->reads) {
    printf("reads%s%s", format->read_endings[0] != '\0' ? " " : "", format->read_endings);
    between = "; ";
  }
  if (format->writes)
    printf("%swrites%s%s", between, format->written_endings[0] != '\0' ? " " : "", format->written_endings);
  printf("\n");
}

static void print_text(void) {
  for (int kind = 0; kind < KIND_COUNT; kind++) {
    hl_file_format format;
    printf("%s\n", kinds[kind].title);
    for (size_t n = 0; get_format(&kinds[kind], n, &format); n++) print_line(&format);
  }
}

int info_formats(bool as_json) {
  if (as_json) print_json();
  else print_text();
  return finish_stdout();
}
