/* start/places.c - see places.h. */
#define _GNU_SOURCE
#include "places.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "text/json_value.h"

static hl_status fail_memory(hl_error *error, const char *what) {
  snprintf(error->message, sizeof error->message, "no memory for %s", what);
  return error->code = HL_ERROR_MEMORY;
}

/* ---- planes ---- */

static bool fits_floats(const double *values, size_t count) {
  for (size_t n = 0; n < count; n++)
    if (!isnan(values[n]) && (double)(float)values[n] != values[n]) return false;
  return true;
}

/* Converts doubles to floats, which are stored one after the other at the beginning of the same memory. */
static void pack_floats(double *values, size_t count) {
  unsigned char *bytes = (unsigned char *)values;
  for (size_t n = 0; n < count; n++) {
    float value = (float)values[n];
    memcpy(bytes + n * sizeof value, &value, sizeof value);
  }
}

const hl_volume *sliced_volume(const hl_scene *scene, long long number, slice_source source) {
  const hl_scene_description *d = hl_scene_describe(scene);
  if (number < 0 || (size_t)number >= d->volume_count) return NULL;
  const hl_scene_volume *volume = &d->volumes[number];
  const hl_volume *of_file = hl_volume_unsmoothed(volume->volume);
  if (source == SLICE_OF_MASK) return volume->mask.volume;
  return source == SLICE_OF_VOXELS && of_file != NULL ? of_file : volume->volume;
}

hl_status slice_values(const hl_volume *volume, const hl_reslice_options *plane, unsigned char **bytes,
                       size_t *count, hl_error *error) {
  size_t samples = plane->width * plane->height;
  double *values = malloc(samples * sizeof *values);
  if (values == NULL) return fail_memory(error, "a plane of voxels");
  hl_status status = hl_volume_reslice(volume, plane, values, error);
  if (status != HL_OK) {
    free(values);
    return status;
  }
  bool floats = plane->interpolate || (plane->depth > 1 && plane->blend == HL_BLEND_MEAN) ||
                fits_floats(values, samples);
  if (floats) pack_floats(values, samples);
  *bytes = (unsigned char *)values;
  *count = samples * (floats ? sizeof(float) : sizeof *values);
  return HL_OK;
}

/* ---- depths ---- */

static char *depth_text(float depth, float opacity, int object) {
  char deep[HL_JSON_NUMBER_BYTES] = "null", opaque[HL_JSON_NUMBER_BYTES], *text = NULL;
  if (isfinite(depth)) hl_json_number_text((double)depth, deep);
  hl_json_number_text((double)opacity, opaque);
  return asprintf(&text, "{\"depth\":%s,\"opacity\":%s,\"object\":%d}", deep, opaque, object) >= 0 ? text
                                                                                                   : NULL;
}

hl_status middle_depth(hl_renderer *renderer, const hl_scene *scene, char **text, hl_error *error) {
  const hl_scene_description *d = hl_scene_describe(scene);
  int width = d->width, height = d->height;
  size_t pixels = (size_t)width * (size_t)height, middle = (size_t)(height / 2 * width + width / 2);
  if (width > MOST_DEPTH_SIDE || height > MOST_DEPTH_SIDE) {
    snprintf(error->message, sizeof error->message, "/image: a depth is asked for of %d x %d pixels at most",
             (int)MOST_DEPTH_SIDE, (int)MOST_DEPTH_SIDE);
    return error->code = HL_ERROR_INPUT;
  }
  float *rgba = malloc(6 * pixels * sizeof *rgba);
  if (rgba == NULL) return fail_memory(error, "a depth");
  float *first = rgba + 4 * pixels, *object = first + pixels;
  hl_layers layers = {.struct_size = sizeof layers, .depth_first = first, .object = object};
  hl_status status = hl_renderer_render_layers(renderer, scene, rgba, 4 * (size_t)width, &layers, NULL,
                                               error);
  if (status == HL_OK) {
    *text = depth_text(first[middle], rgba[4 * middle + 3], (int)object[middle]);
    if (*text == NULL) status = fail_memory(error, "a depth");
  }
  free(rgba);
  return status;
}
