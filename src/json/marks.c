/* json/marks.c - reads the marks of a scene from JSON, and writes them as JSON. */
#include "scene/marks.h"

#include <stdio.h>
#include <string.h>

#include "core/memory.h"
#include "json/parts.h"

enum { MOST_KINDS = 8 };

/* Fills a list of the kinds' names, in the order of hl_mark_kind. Null ends the list. */
static void list_kinds(const char *names[MOST_KINDS]) {
  int kind = 0;
  for (; hl_mark_rule_of(kind) != NULL; kind++) names[kind] = hl_mark_rule_of(kind)->name;
  names[kind] = NULL;
}

/* Reads the array "points" of a mark. *mark owns the points, also after a failure. */
static hl_status read_points(hl_json_reader *reader, const json_t *value, hl_mark *mark) {
  const hl_mark_rule *rule = hl_mark_rule_of((int)mark->kind);
  size_t place = hl_json_enter(reader, "points"), count = json_array_size(value);
  if (value == NULL)
    return hl_json_fail(reader, HL_ERROR_INPUT, NULL, "is missing: give a list of points, [x, y, z]");
  hl_status status = hl_json_array(reader, value, rule->least, rule->most);
  if (status != HL_OK) return status;
  double(*points)[3] = hl_allocate_zeroed(reader->context, count, sizeof *points);
  if (points == NULL) return hl_fail_memory(reader->error, count * sizeof *points, "the points of a mark");
  mark->points = (const double(*)[3])points;
  mark->point_count = count;
  for (size_t p = 0; p < count && status == HL_OK; p++) {
    char index[24];
    snprintf(index, sizeof index, "%zu", p);
    status = hl_json_row(reader, json_array_get(value, p), index, 3, points[p]);
  }
  if (status == HL_OK) hl_json_leave(reader, place);
  return status;
}

/* Reads one mark. *mark owns its points and its text, also after a failure. */
static hl_status read_mark(hl_json_reader *reader, const json_t *value, hl_mark *mark) {
  static const char *const keys[] = {"kind", "points", "text", NULL};
  const char *names[MOST_KINDS], *text = NULL;
  int kind = -1;
  list_kinds(names);
  hl_status status = hl_json_object(reader, value, keys);
  if (status == HL_OK) status = hl_json_choice(reader, value, "kind", names, 0, &kind);
  if (status == HL_OK && kind < 0)
    status = hl_json_fail(reader, HL_ERROR_INPUT, "kind",
                          "is missing: give \"ruler\", \"angle\", \"line\", \"arrow\" or \"text\"");
  if (status != HL_OK) return status;
  mark->kind = (hl_mark_kind)kind;
  status = hl_json_text(reader, value, "text", &text);
  if (status == HL_OK && text != NULL) {
    mark->text = hl_copy_text(reader->context, text);
    if (mark->text == NULL) return hl_fail_memory(reader->error, strlen(text) + 1, "the text of a mark");
  }
  return status == HL_OK ? read_points(reader, json_object_get(value, "points"), mark) : status;
}

hl_status hl_json_read_marks(hl_json_reader *reader, const json_t *value, const hl_mark **made,
                             size_t *made_count) {
  if (value == NULL) return HL_OK;
  size_t place = hl_json_enter(reader, "marks"), count = json_array_size(value);
  hl_status status = hl_json_array(reader, value, 0, HL_LIMIT_MARKS);
  if (status != HL_OK) return status;
  if (count == 0) return hl_json_leave(reader, place), HL_OK;
  hl_mark *marks = hl_allocate_zeroed(reader->context, count, sizeof *marks);
  if (marks == NULL) return hl_fail_memory(reader->error, count * sizeof *marks, "a scene's marks");
  *made = marks;
  *made_count = count;
  for (size_t m = 0; m < count; m++) {
    size_t inner = hl_json_enter_index(reader, m);
    if ((status = read_mark(reader, json_array_get(value, m), &marks[m])) != HL_OK) return status;
    hl_json_leave(reader, inner);
  }
  hl_json_leave(reader, place);
  return HL_OK;
}

void hl_json_write_marks(hl_json_writer *w, const hl_mark *marks, size_t count) {
  if (count > 0) hl_json_open(w, "marks", "[");
  for (size_t m = 0; m < count; m++) {
    hl_json_open(w, NULL, "{");
    hl_json_write_name(w, "kind", hl_mark_rule_of((int)marks[m].kind)->name);
    hl_json_open(w, "points", "[");
    for (size_t p = 0; p < marks[m].point_count; p++) hl_json_write_row(w, NULL, marks[m].points[p], 3);
    hl_json_close(w, "]");
    if (marks[m].text != NULL) hl_json_write_name(w, "text", marks[m].text);
    hl_json_close(w, "}");
  }
  if (count > 0) hl_json_close(w, "]");
}
