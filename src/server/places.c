/* server/places.c - answers requests about places in a scene: planes of voxels, and the depth of the surface
 * that the middle pixel shows. */
#define _GNU_SOURCE
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "parts.h"
#include "text/plain.h"

void answer_slice(server *s, const slice_request *request, server_answer *answer) {
  server_opened *opened = opened_enter(s, request->opened);
  if (opened == NULL) {
    refuse_line(answer, 410, closed_line);
    return;
  }
  const opened_state *now = opened_now(opened);
  const hl_volume *volume = sliced_volume(now->scene, request->volume, request->source);
  hl_error error = {0};
  if (request->refined >= 0 && request->refined != now->refined)
    refuse_line(answer, 409, "the plane is given in voxels of a resolution that a finer one has replaced");
  else if (volume == NULL) refuse_line(answer, 400, "the scene has no such volume or mask");
  else if (slice_values(volume, &request->plane, &answer->from_malloc, &answer->length, &error) == HL_OK) {
    answer->status = 200;
    answer->type = "application/octet-stream";
  } else if (error.code == HL_ERROR_CANCELLED) answer->status = 204;
  else refuse_line(answer, error.code == HL_ERROR_MEMORY ? 500 : 400, error.message);
  opened_leave(s, opened);
}

/* Reads three numbers, as "1,2.5,-3", from a query. If the text is absent (null), the numbers are not
 * changed. Returns false if the text is something else. */
bool read_triple(const char *text, double numbers[3]) {
  if (text == NULL) return true;
  char copy[128];
  if (strlen(text) >= sizeof copy) return false;
  snprintf(copy, sizeof copy, "%s", text);
  char *rest = copy;
  for (int axis = 0; axis < 3; axis++) {
    const char *word = strsep(&rest, ",");
    if (word == NULL || strspn(word, "+-.0123456789eE") != strlen(word)) return false;
    char *end = NULL;
    numbers[axis] = hl_plain_number(word, &end);
    if (end == word || *end != '\0' || !isfinite(numbers[axis])) return false;
  }
  return rest == NULL;
}

hl_status render_depth(server_page *page, const hl_scene *scene, server_answer *answer, hl_error *error) {
  char *text = NULL;
  hl_status status = middle_depth(page->renderer, scene, &text, error);
  if (status != HL_OK) return status;
  answer->from_malloc = (unsigned char *)text;
  answer->length = strlen(text);
  answer->type = "application/json";
  return HL_OK;
}
