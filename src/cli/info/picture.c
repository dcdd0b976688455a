/* cli/info/picture.c - implements `halflight info PICTURE`, which prints the picture's size and bits, and the
 * facts about its scene that its metadata state. The files of the scene need not exist. */
#include "picture.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cli/output.h"
#include "text/plain_json.h"

static json_t *load(const char *text) { return text != NULL ? hl_plain_json_load_text(text) : NULL; }

int info_picture_read(cli_host *host, const char *title, const void *bytes, size_t length,
                      info_picture *picture) {
  char *scene = NULL, *errors = NULL;
  hl_error error = {0};
  *picture = (info_picture){.about = {.struct_size = sizeof picture->about}};
  hl_status status = hl_image_get_about(title, bytes, length, &picture->about, &error);
  if (status == HL_OK && picture->about.has_scene)
    status = hl_image_find_scene(host->context, title, bytes, length, &scene, &error);
  if (status == HL_OK)
    status = hl_image_find_field_errors(host->context, title, bytes, length, &errors, &error);
  picture->scene = load(scene);
  picture->panels = json_array_size(json_object_get(picture->scene, "panels"));
  if (picture->panels > 0) { /* a figure is no scene */
    json_decref(picture->scene);
    picture->scene = NULL;
  }
  picture->field_errors = load(errors);
  hl_text_release(host->context, scene);
  hl_text_release(host->context, errors);
  return status == HL_OK ? EXIT_CODE_OK : host_fail(host, PHASE_READ, status, &error);
}

void info_picture_release(info_picture *picture) {
  json_decref(picture->scene);
  json_decref(picture->field_errors);
}

void info_print_difference(const char *whose, double value, double of_range, const char *kind,
                           const char *source) {
  if (isnan(value)) printf("  field       %sits difference from %s is unknown\n", whose, source);
  else if (value == 0) printf("  field       %sequals %s\n", whose, source);
  else
    printf("  field       %sdiffers from %s by %.2g%s, %.2g of the range\n", whose, source, value,
           strcmp(kind, "bound") == 0     ? " at most"
           : strcmp(kind, "sampled") == 0 ? " or more"
                                          : "",
           of_range);
}

/* ---- the scene's main facts ---- */

static const char *text_of(const json_t *object, const char *key) {
  const char *text = json_string_value(json_object_get(object, key));
  return text != NULL ? text : "";
}

/* The name that is printed for a volume of the scene: the volume's own name, or the name of its file. */
static const char *name_of_volume(const info_picture *picture, size_t index) {
  const json_t *volume = json_array_get(json_object_get(picture->scene, "volumes"), index);
  const char *name = text_of(volume, "name"), *file = text_of(volume, "file");
  return name[0] != '\0' ? name : file[0] != '\0' ? file : "shapes";
}

static void print_camera(const json_t *camera) {
  const json_t *from = json_object_get(camera, "position"), *to = json_object_get(camera, "target");
  double p[3], t[3];
  if (camera == NULL) return;
  for (size_t n = 0; n < 3; n++) {
    p[n] = json_number_value(json_array_get(from, n));
    t[n] = json_number_value(json_array_get(to, n));
  }
  const bool orthographic = strcmp(text_of(camera, "type"), "orthographic") == 0;
  printf("  camera      %s, at %.6g, %.6g, %.6g, looks at %.6g, %.6g, %.6g, %s %.6g\n",
         orthographic ? "orthographic" : "perspective", p[0], p[1], p[2], t[0], t[1], t[2],
         orthographic ? "height" : "fovy",
         json_number_value(json_object_get(camera, orthographic ? "height" : "fovy_deg")));
}

static void print_volumes(const info_picture *picture) {
  const size_t count = json_array_size(json_object_get(picture->scene, "volumes"));
  for (size_t n = 0; n < count; n++)
    printf("%s%s%s", n == 0 ? "  volumes     " : ", ", name_of_volume(picture, n),
           n + 1 == count ? "\n" : "");
}

static void print_differences(const info_picture *picture) {
  size_t n;
  json_t *one;
  json_array_foreach(picture->field_errors, n, one) {
    const json_t *value = json_object_get(one, "value");
    char whose[200];
    snprintf(whose, sizeof whose,
             "%.150s: ", name_of_volume(picture, (size_t)json_integer_value(json_object_get(one, "volume"))));
    info_print_difference(whose, json_is_number(value) ? json_number_value(value) : NAN,
                          json_number_value(json_object_get(one, "of_range")), text_of(one, "kind"),
                          text_of(one, "source"));
  }
}

void info_picture_print(const info_picture *picture) {
  const hl_image_about *about = &picture->about;
  printf("  picture     %" PRIu64 " x %" PRIu64 " pixels, %s, %d channel%s of %d bits\n", about->width,
         about->height, about->format, about->channels, about->channels == 1 ? "" : "s", about->bits);
  if (about->layers[0] != '\0') printf("  layers      %s\n", about->layers);
  if (picture->scene == NULL) return;
  print_camera(json_object_get(picture->scene, "camera"));
  print_volumes(picture);
  print_differences(picture);
}

static void print_json_value(json_writer *json, const char *key, const json_t *value) {
  char *text = value != NULL ? hl_plain_json_dump(value, JSON_ENCODE_ANY) : NULL;
  json_written(json, key, text != NULL ? text : "null");
  free(text);
}

void info_picture_print_json(const info_picture *picture, json_writer *json) {
  const hl_image_about *about = &picture->about;
  json_open_object(json, "picture");
  json_text(json, "format", about->format);
  json_whole_number(json, "width", about->width);
  json_whole_number(json, "height", about->height);
  json_whole_number(json, "channels", (uint64_t)about->channels);
  json_whole_number(json, "bits", (uint64_t)about->bits);
  if (about->layers[0] != '\0') json_text(json, "layers", about->layers);
  json_bool(json, "has_scene", picture->scene != NULL);
  if (picture->scene != NULL) {
    print_json_value(json, "camera", json_object_get(picture->scene, "camera"));
    json_open_array(json, "volumes");
    for (size_t n = 0; n < json_array_size(json_object_get(picture->scene, "volumes")); n++)
      json_text(json, NULL, name_of_volume(picture, n));
    json_close(json);
    print_json_value(json, "field_errors", picture->field_errors);
  }
  json_close(json);
}

/* ---- pictures without a scene ---- */

int info_of_plain_picture(const info_picture *picture, const char *title, bool as_json) {
  json_writer json = {0};
  if (as_json) {
    json_open_object(&json, NULL);
    json_text(&json, "file", title);
    info_picture_print_json(picture, &json);
    json_close(&json);
    return finish_stdout();
  }
  printf("%s\n", title);
  info_picture_print(picture);
  if (picture->panels > 0) {
    printf("  figure      of %zu panel%s: halflight figure %s repeats it\n", picture->panels,
           picture->panels == 1 ? "" : "s", title);
    return finish_stdout();
  }
  printf("  scene       none: %s\n", strcmp(picture->about.format, "PNG") == 0
                                         ? "the .png pictures of halflight render have one, without "
                                           "--no-metadata"
                                         : "of all formats .png alone holds one");
  return finish_stdout();
}

int info_of_page(const char *path, bool as_json) {
  const char *format = has_extension(path, ".pdf") ? "PDF" : "SVG";
  json_writer json = {0};
  if (access(path, R_OK) != 0)
    return fail(EXIT_CODE_INPUT, "%s: cannot open: no such file that can be read", path);
  if (as_json) {
    json_open_object(&json, NULL);
    json_text(&json, "file", path);
    json_open_object(&json, "picture");
    json_text(&json, "format", format);
    json_bool(&json, "has_scene", false);
    json_close(&json);
    json_close(&json);
  } else {
    printf(
        "%s\n  picture     %s, of which nothing is read\n"
        "  scene       none: of all formats .png alone holds one\n",
        path, format);
  }
  return finish_stdout();
}
