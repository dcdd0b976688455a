/* scene/marks.h - describes the marks of a scene: measures and texts that stand in the scene. */
#ifndef HL_SCENE_MARKS_H
#define HL_SCENE_MARKS_H

#include <halflight/scene.h>

#include "core/error.h"

enum {
  HL_LIMIT_MARKS = 1000,
  HL_LIMIT_MARK_POINTS = 500, /* greatest number of points of a line */
  HL_LIMIT_MARK_TEXT = 2000   /* greatest number of bytes of a text */
};

/* The rule of a kind of mark: its name in scene files, and its number of points. */
typedef struct hl_mark_rule {
  const char *name;
  size_t least, most; /* the least and the greatest number of points */
} hl_mark_rule;

/* The rule of a kind of mark; null if the kind does not exist. */
const hl_mark_rule *hl_mark_rule_of(int kind);

/* Checks the marks of a description. Errors name the field ("/marks/0/points"). */
hl_status hl_marks_check(const hl_mark *marks, size_t count, hl_error *error);

/* Copies marks with their texts and points. *copy: owned by the caller (hl_marks_release); null if `count` is
 * 0. */
hl_status hl_marks_copy(hl_context *context, const hl_mark *marks, size_t count, hl_mark **copy,
                        hl_error *error);
/* Releases an array of marks with their points and texts. marks: may be null. */
void hl_marks_release(hl_context *context, const hl_mark *marks, size_t count);

#endif
