/* json/writable.c - see writable.h. */
#include "json/writable.h"

#include <stdio.h>

#include <jansson.h>

#include "core/error.h"
#include "mesh/mesh.h"
#include "text/plain_json.h"

static bool is_utf8(const char *text) {
  if (text == NULL) return true;
  json_t *string = json_string(text); /* null if the text is not UTF-8 */
  bool good = string != NULL;
  json_decref(string);
  return good;
}

static bool is_text_of_shapes(const char *text) {
  json_t *root = hl_plain_json_load_text(text);
  bool good = json_is_array(json_object_get(root, "shapes"));
  json_decref(root);
  return good;
}

static hl_status check_volume(const hl_scene_volume *volume, size_t index, hl_error *error) {
  if (volume->file == NULL && volume->shapes == NULL)
    return hl_fail(
        error, HL_ERROR_ARGUMENT,
        "/volumes/%zu/file: the volume came from memory: write it to a file and name that in the scene",
        index);
  if (volume->mask.volume != NULL && volume->mask.file == NULL)
    return hl_fail(
        error, HL_ERROR_ARGUMENT,
        "/volumes/%zu/mask/file: the mask came from memory: write it to a file and name that in the "
        "scene",
        index);
  if (volume->shapes != NULL && !is_text_of_shapes(volume->shapes))
    return hl_fail(error, HL_ERROR_ARGUMENT,
                   "/volumes/%zu/shapes: is no text that hl_volume_from_shapes() reads: give that, or null",
                   index);
  if (is_utf8(volume->file) && is_utf8(volume->name) && is_utf8(volume->array) && is_utf8(volume->series) &&
      is_utf8(volume->file_space))
    return HL_OK;
  return hl_fail(
      error, HL_ERROR_ARGUMENT,
      "/volumes/%zu: name, file, array, series or file_space is not UTF-8, as JSON texts must be: rename it",
      index);
}

/* The number of numbers in the arrays of a mesh. */
static size_t numbers_of(const hl_mesh *mesh) {
  const hl_mesh_description *d = &mesh->description;
  return 3 * mesh->given_vertices + 3 * mesh->given_triangles + 4 * d->sphere_count + 4 * d->line_point_count;
}

static hl_status check_mesh(const hl_scene_mesh *mesh, size_t index, hl_error *error) {
  /* the greatest number of numbers; more numbers would take several megabytes in a scene's text */
  enum { MOST_NUMBERS = 300000 };
  if (mesh->file == NULL && numbers_of(mesh->mesh) > MOST_NUMBERS)
    return hl_fail(
        error, HL_ERROR_ARGUMENT,
        "/meshes/%zu/file: the mesh came from memory and has %zu numbers, of which a scene holds %d: "
        "write it to a file and name that in the scene",
        index, numbers_of(mesh->mesh), MOST_NUMBERS);
  if (is_utf8(mesh->file) && is_utf8(mesh->name)) return HL_OK;
  return hl_fail(error, HL_ERROR_ARGUMENT,
                 "/meshes/%zu: name or file is not UTF-8, as JSON texts must be: rename it", index);
}

/* Checks that an image has a file. place: the JSON pointer of the object that names the image, such as
 * "/lights/0/texture". */
static hl_status check_image(const float *pixels, const char *file, const char *place, hl_error *error) {
  if (pixels == NULL) return HL_OK;
  if (file == NULL)
    return hl_fail(error, HL_ERROR_ARGUMENT,
                   "%s/file: the image came from memory: write it to a file and name that in the scene",
                   place);
  if (is_utf8(file)) return HL_OK;
  return hl_fail(error, HL_ERROR_ARGUMENT, "%s/file: is not UTF-8, as JSON texts must be: rename it", place);
}

static hl_status check_light_images(const hl_light *light, size_t index, hl_error *error) {
  char place[64];
  snprintf(place, sizeof place, "/lights/%zu/texture", index);
  hl_status status = check_image(light->texture.pixels, light->texture.file, place, error);
  snprintf(place, sizeof place, "/lights/%zu/emission", index);
  return status == HL_OK ? check_image(light->emission.pixels, light->emission.file, place, error) : status;
}

hl_status hl_json_check_writable(const hl_scene_description *d, hl_error *error) {
  hl_status sky = check_image(d->sky.pixels, d->sky.file, "/sky", error);
  if (sky != HL_OK) return sky;
  for (size_t l = 0; l < d->light_count; l++) {
    hl_status status = check_light_images(&d->lights[l], l, error);
    if (status != HL_OK) return status;
  }
  for (size_t v = 0; v < d->volume_count; v++) {
    const hl_function_image *image = &d->volumes[v].transfer_function.plane.image;
    char place[64];
    snprintf(place, sizeof place, "/volumes/%zu/transfer_function/image", v);
    hl_status status = check_image(image->pixels, image->file, place, error);
    if (status == HL_OK) status = check_volume(&d->volumes[v], v, error);
    if (status != HL_OK) return status;
  }
  for (size_t m = 0; m < d->mesh_count; m++) {
    hl_status status = check_mesh(&d->meshes[m], m, error);
    if (status != HL_OK) return status;
  }
  if (is_utf8(d->description)) return HL_OK;
  return hl_fail(error, HL_ERROR_ARGUMENT, "/description: is not UTF-8, as JSON texts must be");
}
