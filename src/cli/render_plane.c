/* cli/render_plane.c - copies of transfer functions of two numbers, which outlive the file that they came
 * from. */
#include <stdlib.h>
#include <string.h>

#include "render.h"

void render_release_plane(hl_function_plane *plane) {
  for (size_t p = 0; p < plane->polygon_count && plane->polygons != NULL; p++)
    free((void *)plane->polygons[p].vertices);
  free((void *)plane->polygons);
  free((void *)plane->boxes);
  free((void *)plane->volume);
  free((void *)plane->image.file);
  free((void *)plane->image.pixels);
}

/* Null for nothing; clears *whole without memory. */
static void *copy_of(const void *items, size_t bytes, bool *whole) {
  if (items == NULL) return NULL;
  void *copy = malloc(bytes + 1);
  if (copy != NULL) memcpy(copy, items, bytes);
  *whole = *whole && copy != NULL;
  return copy;
}

static const char *copy_text(const char *text, bool *whole) {
  return copy_of(text, text == NULL ? 0 : strlen(text) + 1, whole);
}

bool render_copy_plane(const hl_function_plane *from, hl_function_plane *to) {
  const hl_function_image *image = &from->image;
  bool whole = true;
  *to = *from;
  to->volume = copy_text(from->volume, &whole);
  to->boxes = copy_of(from->boxes, from->box_count * sizeof *from->boxes, &whole);
  to->image.file = copy_text(image->file, &whole);
  to->image.pixels = copy_of(image->pixels, 4 * sizeof(float) * (size_t)image->width * (size_t)image->height,
                             &whole);
  hl_function_polygon *polygons = copy_of(from->polygons, from->polygon_count * sizeof *polygons, &whole);
  to->polygons = polygons;
  for (size_t p = 0; p < from->polygon_count && polygons != NULL; p++)
    polygons[p].vertices = copy_of(from->polygons[p].vertices,
                                   from->polygons[p].vertex_count * sizeof *from->polygons[p].vertices,
                                   &whole);
  return whole;
}
