/* compose/rulers.c - applies the option "ruler" X,Y,Z:X,Y,Z[:TEXT]. The coordinates of a point are fractions
 * of the box around the volumes, or lengths in the scene's world. */
#include "compose/rulers.h"

#include <string.h>

#include "compose/coordinates.h"
#include "core/memory.h"

/* A ruler as it was typed. */
typedef struct typed_ruler {
  hl_coordinate ends[2][3];
  const char *text; /* null if the ruler has no text */
} typed_ruler;

static bool read_ruler(const char *text, typed_ruler *ruler) {
  *ruler = (typed_ruler){0};
  for (int n = 0; n < 6; n++) {
    hl_coordinate *coordinate = &ruler->ends[n / 3][n % 3];
    if (!hl_read_coordinate(&text, coordinate) || !coordinate->given) return false;
    const char after = n == 2 ? ':' : n < 5 ? ',' : *text == '\0' ? '\0' : ':';
    if (*text != after) return false;
    if (after != '\0') text++;
    if (n == 5 && after != '\0') ruler->text = text;
  }
  return ruler->text == NULL || ruler->text[0] != '\0';
}

hl_status hl_check_rulers(const hl_asked *ruler, hl_error *error) {
  typed_ruler typed;
  for (int n = 0; n < ruler->count; n++)
    if (!read_ruler(ruler->texts[n], &typed))
      return hl_fail(
          error, HL_ERROR_ARGUMENT,
          "--ruler: '%.300s' is not X,Y,Z:X,Y,Z[:TEXT]: two points, in fractions of the volume's box "
          "or in lengths of its world (0.2,0.5,0.5:0.8,0.5,0.5 or 10mm,0mm,5mm:40mm,0mm,5mm:width)",
          ruler->texts[n]);
  return HL_OK;
}

hl_status hl_compose_rulers(const hl_composer *composer, hl_scene_description *description, hl_rulers *made) {
  const hl_asked *asked = &composer->asked[HL_ASK_RULER];
  const size_t before = description->mark_count, count = (size_t)asked->count;
  hl_world_box box;
  *made = (hl_rulers){0};
  if (!asked->given) return HL_OK;
  if (description->volume_count == 0)
    return hl_fail(composer->error, HL_ERROR_ARGUMENT,
                   "--ruler measures in the box of a volume: the picture has no volume");
  hl_status status = hl_scene_world_box(composer, description, &box);
  if (status != HL_OK) return status;
  made->marks = hl_allocate(composer->context, before + count, sizeof *made->marks);
  made->points = hl_allocate(composer->context, 2 * count, sizeof *made->points);
  if (made->marks == NULL || made->points == NULL)
    return hl_fail_memory(composer->error, (before + count) * sizeof *made->marks, "the scene's marks");
  if (before > 0) memcpy(made->marks, description->marks, before * sizeof *made->marks);
  const double metres = hl_metres_of_box(&box);
  for (size_t n = 0; n < count; n++) {
    typed_ruler typed;
    double(*points)[3] = made->points + 2 * n;
    (void)read_ruler(asked->texts[n], &typed); /* hl_check_rulers() has checked the text */
    for (int end = 0; end < 2; end++)
      for (int a = 0; a < 3; a++)
        points[end][a] = hl_coordinate_of(&typed.ends[end][a], 0, box.low[a], box.high[a], metres);
    made->marks[before + n] = (hl_mark){
        .kind = HL_MARK_RULER, .text = typed.text, .points = (const double(*)[3])points, .point_count = 2};
  }
  description->marks = made->marks;
  description->mark_count = before + count;
  return HL_OK;
}

void hl_rulers_release(hl_context *context, hl_rulers *made) {
  hl_release(context, made->marks);
  hl_release(context, made->points);
}
