/* server/places.c - what lies where: planes of voxels for the page's slices, and how deep what a pixel shows
 * lies.
 *
 * A plane is answered as its values alone, row after row in the machine's byte order: in four bytes each
 * where floats hold all of them exactly, or they are interpolated or means, else in eight. Their number of
 * bytes tells which. NaN: no voxel is there. */
#define _GNU_SOURCE
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "parts.h"
#include "text/json_value.h"
#include "text/plain.h"

/* ---- planes ---- */

static bool fits_floats(const double *values, size_t count) {
  for (size_t n = 0; n < count; n++)
    if (!isnan(values[n]) && (double)(float)values[n] != values[n]) return false;
  return true;
}

/* Moves the values together, in place. */
static void pack_floats(double *values, size_t count) {
  unsigned char *bytes = (unsigned char *)values;
  for (size_t n = 0; n < count; n++) {
    float value = (float)values[n];
    memcpy(bytes + n * sizeof value, &value, sizeof value);
  }
}

/* The volume that a plane is cut out of; null: the scene has none of this number. */
static const hl_volume *find_volume(const hl_scene *scene, const slice_request *request) {
  const hl_scene_description *d = hl_scene_describe(scene);
  if (request->volume < 0 || (size_t)request->volume >= d->volume_count) return NULL;
  const hl_scene_volume *volume = &d->volumes[request->volume];
  return request->of_mask ? volume->mask.volume : volume->volume;
}

void answer_slice(server *s, const slice_request *request, server_answer *answer) {
  server_opened *opened = opened_enter(s, request->opened);
  if (opened == NULL) {
    refuse_line(answer, 410, closed_line);
    return;
  }
  const hl_reslice_options *plane = &request->plane;
  const hl_volume *volume = find_volume(opened->scene, request);
  size_t count = plane->width * plane->height;
  double *values = volume != NULL ? malloc(count * sizeof *values) : NULL;
  hl_error error = {0};
  if (volume == NULL) refuse_line(answer, 400, "the scene has no such volume or mask");
  else if (values == NULL) refuse_line(answer, 500, "no memory for a plane of voxels");
  else if (hl_volume_reslice(volume, plane, values, &error) != HL_OK) {
    if (error.code == HL_ERROR_CANCELLED) answer->status = 204;
    else refuse_line(answer, error.code == HL_ERROR_MEMORY ? 500 : 400, error.message);
  } else {
    bool floats = plane->interpolate || (plane->depth > 1 && plane->blend == HL_BLEND_MEAN) ||
                  fits_floats(values, count);
    if (floats) pack_floats(values, count);
    answer->status = 200;
    answer->type = "application/octet-stream";
    answer->from_malloc = (unsigned char *)values;
    answer->length = count * (floats ? sizeof(float) : sizeof *values);
    values = NULL;
  }
  free(values);
  opened_leave(s, opened);
}

/* Reads "1,2.5,-3" of a query; absent: the numbers stay. False: it is anything else. */
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

/* ---- depths ---- */

hl_status render_depth(server_page *page, const hl_scene *scene, server_answer *answer, hl_error *error) {
  const hl_scene_description *d = hl_scene_describe(scene);
  int width = d->width, height = d->height;
  size_t pixels = (size_t)width * (size_t)height, middle = (size_t)(height / 2 * width + width / 2);
  if (width > MOST_DEPTH_SIDE || height > MOST_DEPTH_SIDE) {
    snprintf(error->message, sizeof error->message, "/image: a depth is asked for of %d x %d pixels at most",
             (int)MOST_DEPTH_SIDE, (int)MOST_DEPTH_SIDE);
    return HL_ERROR_INPUT;
  }
  float *rgba = malloc(6 * pixels * sizeof *rgba), *first = rgba + 4 * pixels, *object = first + pixels;
  if (rgba == NULL) {
    snprintf(error->message, sizeof error->message, "no memory for a depth");
    return HL_ERROR_MEMORY;
  }
  hl_layers layers = {.struct_size = sizeof layers, .depth_first = first, .object = object};
  hl_status status = hl_renderer_render_layers(page->renderer, scene, rgba, 4 * (size_t)width, &layers, NULL,
                                               error);
  if (status == HL_OK) {
    char depth[HL_JSON_NUMBER_BYTES] = "null", opacity[HL_JSON_NUMBER_BYTES], *text = NULL;
    if (isfinite(first[middle])) hl_json_number_text((double)first[middle], depth);
    hl_json_number_text((double)rgba[4 * middle + 3], opacity);
    int length = asprintf(&text, "{\"depth\":%s,\"opacity\":%s,\"object\":%d}", depth, opacity,
                          (int)object[middle]);
    answer->from_malloc = length >= 0 ? (unsigned char *)text : NULL;
    answer->length = length >= 0 ? (size_t)length : 0;
    answer->type = "application/json";
    if (length < 0) status = HL_ERROR_MEMORY;
  }
  free(rgba);
  return status;
}
