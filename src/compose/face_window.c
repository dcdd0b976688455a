/* compose/face_window.c - makes "range" the window of the faces that cuts open in a scanned body.
 *
 * Radiologists look at the inside of a body through a window of values: the window's low end is black, and
 * its high end is white. The values of the body's surface lie below most windows. So the surface keeps its
 * opacity and its colours, and values beyond the surface's values are grey. */
#include <math.h>
#include <string.h>

#include "compose/composer.h"
#include "compose/looks.h"
#include "core/memory.h"
#include "guess/analysis.h"
#include "guess/looks.h"
#include "scene/function/transfer_function.h"

hl_status hl_windows_faces(const hl_composer *composer, const hl_scene_description *description, size_t index,
                           bool *windows) {
  static const hl_ask others[] = {HL_ASK_TF, HL_ASK_COLORMAP, HL_ASK_THRESHOLD, HL_ASK_ISO, HL_ASK_SLICE};
  const hl_scene_volume *volume = &description->volumes[index];
  const char *look = hl_asked_look(composer);
  *windows = false;
  if (!hl_cuts_bare_volume(composer, description) || hl_is_maximum(composer, description)) return HL_OK;
  if (look != NULL && strcmp(look, "surface") != 0) return HL_OK;
  for (size_t n = 0; n < sizeof others / sizeof *others; n++)
    if (composer->asked[others[n]].given) return HL_OK;
  hl_data_analysis analysis;
  hl_status status = hl_data_analyse(volume->volume, &analysis, composer->error);
  if (status == HL_OK) *windows = hl_is_body(volume->volume, volume->file, &analysis);
  return status;
}

/* The greatest value of a body's surface: the value from which on the function has half of its greatest
 * opacity, but in CT at least the value at which fat begins. Hounsfield units below the value of fat are
 * mixtures of tissue and air. */
static double value_of_surface(const hl_volume *volume, const hl_transfer_function *function) {
  static const double fat = -150;
  const hl_opacity_point *points = function->opacity;
  double most = 0;
  for (size_t n = 0; n < function->opacity_count; n++)
    most = points[n].opacity > most ? points[n].opacity : most;
  size_t n = 0;
  while (n + 1 < function->opacity_count && points[n].opacity < most / 2) n++;
  return hl_is_hounsfield(volume) ? fmax(points[n].value, fat) : points[n].value;
}

hl_status hl_window_faces(const hl_composer *composer, const hl_volume *volume, const double window[2],
                          hl_transfer_function *function) {
  hl_transfer_function grays = {0};
  hl_status status = hl_transfer_function_colormap(composer->context, "grays", window[0], window[1], &grays,
                                                   composer->error);
  if (status != HL_OK) return hl_blame_options(status);
  const double surface = value_of_surface(volume, function), behind = nextafter(surface, INFINITY);
  const size_t most = function->color_count + grays.color_count + 2;
  hl_color_point *points = hl_allocate(composer->context, most, sizeof *points);
  size_t count = 0;
  if (points != NULL) {
    for (size_t n = 0; n < function->color_count && function->color[n].value < surface; n++)
      points[count++] = function->color[n];
    points[count].value = surface;
    hl_transfer_function_color(function, surface, points[count++].color);
    points[count].value = behind;
    hl_transfer_function_color(&grays, behind, points[count++].color);
    for (size_t n = 0; n < grays.color_count; n++)
      if (grays.color[n].value > behind) points[count++] = grays.color[n];
    hl_release(composer->context, (void *)function->color);
    function->color = points;
    function->color_count = count;
  }
  hl_transfer_function_release(composer->context, &grays);
  return points != NULL ? HL_OK
                        : hl_fail_memory(composer->error, most * sizeof *points, "a transfer function");
}
