/* scene/marks.c - see marks.h. */
#define _GNU_SOURCE
#include "scene/marks.h"

#include <stdio.h>
#include <string.h>

#include "core/memory.h"
#include "scene/check/checker.h"

const hl_mark_rule *hl_mark_rule_of(int kind) {
  static const hl_mark_rule rules[] = {[HL_MARK_RULER] = {"ruler", 2, 2},
                                       [HL_MARK_ANGLE] = {"angle", 3, 3},
                                       [HL_MARK_LINE] = {"line", 2, HL_LIMIT_MARK_POINTS},
                                       [HL_MARK_ARROW] = {"arrow", 2, 2},
                                       [HL_MARK_TEXT] = {"text", 1, 1}};
  return kind >= 0 && kind < (int)(sizeof rules / sizeof *rules) ? &rules[kind] : NULL;
}

static hl_status check_mark(const hl_mark *mark, size_t index, hl_error *error) {
  hl_checker check = {.error = error};
  const hl_mark_rule *rule = hl_mark_rule_of((int)mark->kind);
  snprintf(check.place, sizeof check.place, "/marks/%zu", index);
  if (rule == NULL) return hl_check_refuse(&check, "kind", "is no kind of mark");
  if (mark->text != NULL && strnlen(mark->text, HL_LIMIT_MARK_TEXT + 1) > HL_LIMIT_MARK_TEXT)
    return hl_check_refuse(&check, "text", "is too long: give at most 2000 bytes");
  if (mark->points == NULL || mark->point_count < rule->least || mark->point_count > rule->most)
    return hl_fail(error, HL_ERROR_INPUT, "%s/points: a mark of the kind %s has %zu to %zu points, not %zu",
                   check.place, rule->name, rule->least, rule->most, mark->point_count);
  hl_status status = HL_OK;
  for (size_t p = 0; p < mark->point_count && status == HL_OK; p++) {
    char key[40];
    snprintf(key, sizeof key, "points/%zu", p);
    status = hl_check_point(&check, key, mark->points[p]);
  }
  return status;
}

hl_status hl_marks_check(const hl_mark *marks, size_t count, hl_error *error) {
  const hl_checker root = {.error = error};
  hl_status status = hl_check_count(&root, "marks", marks, count, HL_LIMIT_MARKS);
  for (size_t m = 0; m < count && status == HL_OK; m++) status = check_mark(&marks[m], m, error);
  return status;
}

/* Copies the text and the points of a mark. After a failure, *to holds the parts that were copied before the
 * failure. */
static hl_status copy_mark(hl_context *context, const hl_mark *from, hl_mark *to, hl_error *error) {
  *to = (hl_mark){.kind = from->kind, .point_count = from->point_count};
  const size_t bytes = from->point_count * sizeof *from->points;
  void *points = hl_allocate(context, from->point_count, sizeof *from->points);
  if (points == NULL) return hl_fail_memory(error, bytes, "the points of a mark");
  to->points = memcpy(points, from->points, bytes);
  if (from->text == NULL) return HL_OK;
  to->text = hl_copy_text(context, from->text);
  return to->text != NULL ? HL_OK : hl_fail_memory(error, strlen(from->text) + 1, "the text of a mark");
}

hl_status hl_marks_copy(hl_context *context, const hl_mark *marks, size_t count, hl_mark **copy,
                        hl_error *error) {
  *copy = NULL;
  if (count == 0) return HL_OK;
  hl_mark *made = hl_allocate_zeroed(context, count, sizeof *made);
  if (made == NULL) return hl_fail_memory(error, count * sizeof *made, "a scene's marks");
  hl_status status = HL_OK;
  for (size_t m = 0; m < count && status == HL_OK; m++)
    status = copy_mark(context, &marks[m], &made[m], error);
  if (status == HL_OK) *copy = made;
  else hl_marks_release(context, made, count);
  return status;
}

void hl_marks_release(hl_context *context, const hl_mark *marks, size_t count) {
  for (size_t m = 0; marks != NULL && m < count; m++) {
    hl_release(context, (void *)marks[m].points);
    hl_release(context, (void *)marks[m].text);
  }
  hl_release(context, (void *)marks);
}
