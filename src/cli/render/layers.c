/* cli/render/layers.c - implements `halflight render --layers`: adds layers to the picture, and checks that
 * their files can be written. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/output.h"
#include "render.h"

static hl_status add_light(hl_image *image, size_t index, hl_light_layers *light, hl_error *error) {
  char name[40];
  snprintf(name, sizeof name, "light%zu", index);
  hl_status status = hl_image_add_layer(image, name, "RGB", &light->picture, error);
  snprintf(name, sizeof name, "light%zu_shadow", index);
  return status == HL_OK ? hl_image_add_layer(image, name, "RGB", &light->shadow, error) : status;
}

static bool shines(const hl_scene_volume *volume) {
  return volume->shading == HL_SHADING_FLAT || volume->material.emission > 0;
}

/* Adds the layer "emission" if a volume or a mesh shines by itself. */
static hl_status add_emission(hl_image *image, const hl_scene_description *description, hl_layers *layers,
                              hl_error *error) {
  bool any = false;
  for (size_t i = 0; i < description->volume_count; i++) any |= shines(&description->volumes[i]);
  for (size_t i = 0; i < description->mesh_count; i++) any |= description->meshes[i].material.emission > 0;
  return any ? hl_image_add_layer(image, "emission", "RGB", &layers->emission, error) : HL_OK;
}

/* Adds the layers "sky" and "sky_shadow" if there is a sky. */
static hl_status add_sky(hl_image *image, const hl_scene_description *description, hl_layers *layers,
                         hl_error *error) {
  if (description->sky.type == HL_SKY_NONE) return HL_OK;
  hl_status status = hl_image_add_layer(image, "sky", "RGB", &layers->sky, error);
  return status == HL_OK ? hl_image_add_layer(image, "sky_shadow", "RGB", &layers->sky_shadow, error)
                         : status;
}

hl_status render_layers_create(hl_image *image, const hl_scene_description *description,
                               render_layers *layers, hl_error *error) {
  size_t light_count = description->light_count;
  *layers = (render_layers){.all = {.struct_size = sizeof layers->all}};
  layers->lights = calloc(light_count + 1, sizeof *layers->lights);
  if (layers->lights == NULL) {
    snprintf(error->message, sizeof error->message, "out of memory");
    return HL_ERROR_MEMORY;
  }
  layers->all.lights = layers->lights;
  layers->all.light_count = light_count;
  hl_status status = hl_image_add_layer(image, "ambient", "RGB", &layers->all.ambient, error);
  if (status == HL_OK) status = add_emission(image, description, &layers->all, error);
  if (status == HL_OK) status = add_sky(image, description, &layers->all, error);
  for (size_t i = 0; i < light_count && status == HL_OK; i++)
    status = add_light(image, i, &layers->lights[i], error);
  if (status == HL_OK)
    status = hl_image_add_layer(image, "depth_first", "Z", &layers->all.depth_first, error);
  if (status == HL_OK) status = hl_image_add_layer(image, "depth_mean", "Z", &layers->all.depth_mean, error);
  if (status == HL_OK) status = hl_image_add_layer(image, "normal", "XYZ", &layers->all.normal, error);
  if (status == HL_OK) status = hl_image_add_layer(image, "object", "Z", &layers->all.object, error);
  return status;
}

void render_layers_release(render_layers *layers) { free(layers->lights); }

/* Refuses the output "picture.npy" if the file of one of its layers, "picture-NAME.npy", is a file that the
 * run has read. */
static int protect_from_layer(const cli_host *host, const char *output, const char *name, const char *input) {
  const char *dot = strrchr(output, '.');
  size_t size = strlen(output) + strlen(name) + 2;
  char *path = malloc(size);
  if (path == NULL) return fail(EXIT_CODE_FAILURE, "out of memory");
  snprintf(path, size, "%.*s-%s%s", (int)(dot - output), output, name, dot);
  int exit_code = read_files_protect(&host->read, path, input);
  free(path);
  return exit_code;
}

int render_layers_protect(const cli_host *host, const char *output, size_t light_count, const char *input) {
  static const char *const names[] = {"ambient",     "emission",   "sky",    "sky_shadow",
                                      "depth_first", "depth_mean", "normal", "object"};
  int exit_code = EXIT_CODE_OK;
  if (!has_extension(output, ".npy")) return EXIT_CODE_OK; /* an .exr file holds all layers itself */
  for (size_t i = 0; i < sizeof names / sizeof *names && exit_code == EXIT_CODE_OK; i++)
    exit_code = protect_from_layer(host, output, names[i], input);
  for (size_t i = 0; i < light_count && exit_code == EXIT_CODE_OK; i++) {
    char name[40];
    snprintf(name, sizeof name, "light%zu", i);
    exit_code = protect_from_layer(host, output, name, input);
    snprintf(name, sizeof name, "light%zu_shadow", i);
    if (exit_code == EXIT_CODE_OK) exit_code = protect_from_layer(host, output, name, input);
  }
  return exit_code;
}

int render_layers_check(const cli_value *values) {
  const cli_value *output = &values[RENDER_OUTPUT], *format = &values[RENDER_FORMAT];
  if (!values[RENDER_LAYERS].given) return EXIT_CODE_OK;
  bool to_stdout = output->given && strcmp(output->text, "-") == 0;
  bool exr = format->given && strcmp(format->text, "exr") == 0,
       npy = format->given && strcmp(format->text, "npy") == 0;
  if (to_stdout && exr) return EXIT_CODE_OK;
  if (to_stdout) return fail(EXIT_CODE_USAGE, "--layers: standard output takes one file: add --format exr");
  if (!output->given && (exr || npy)) return EXIT_CODE_OK;
  if (output->given && output_is_linear(output->text)) return EXIT_CODE_OK;
  if (output->given)
    return fail(EXIT_CODE_USAGE, "--layers: '%s' cannot hold layers: end OUT in .exr or .npy", output->text);
  return fail(EXIT_CODE_USAGE, "--layers needs a file that holds them: add -o NAME.exr or -o NAME.npy");
}
