/* cli/info/info.c - implements `halflight info FILE`, which prints the properties of a volume, a scene or a
 * mesh. */
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/commands.h"
#include "cli/frames.h"
#include "cli/host.h"
#include "cli/input.h"
#include "cli/json_writer.h"
#include "formats.h"
#include "picture.h"
#include "volume.h"

enum info_option {
  INFO_JSON,
  INFO_FORMATS,
  INFO_ARRAY,
  INFO_COMPONENT,
  INFO_SERIES,
  INFO_TIME,
  INFO_CHANNEL,
  INFO_LEVEL,
  INFO_SPACING,
  INFO_SPACE,
  INFO_UNIT,
  INFO_LABEL_TABLE,
  INFO_MAX_MEMORY,
  INFO_OPTION_COUNT
};

static const cli_option info_options[INFO_OPTION_COUNT] = {
    [INFO_JSON] = {.name = "json",
                   .kind = OPTION_SWITCH,
                   .group = "Options",
                   .help = "print JSON, with 256 bins of the histogram"},
    [INFO_FORMATS] = {.name = "formats",
                      .kind = OPTION_SWITCH,
                      .help = "without FILE: list the formats that this program reads\nand writes"},
    INPUT_OPTIONS(INFO_ARRAY, NULL),
    [INFO_CHANNEL] = INPUT_OPTION_CHANNEL,
    [INFO_SPACING] = INPUT_OPTION_SPACING,
    [INFO_SPACE] = INPUT_OPTION_SPACE,
    [INFO_UNIT] = {.name = "unit",
                   .kind = OPTION_TEXT,
                   .argument = "UNIT",
                   .help = "unit of lengths, where FILE does not tell it: m, cm, mm,\num, nm or angstrom"},
    [INFO_LABEL_TABLE] =
        {.name = "label-table",
         .kind = OPTION_TEXT,
         .argument = "FILE",
         .help = "names of a label map's labels: FreeSurfer's, Slicer's or\nITK-SNAP's table, or CSV"},
    [INFO_MAX_MEMORY] = HOST_OPTION_MAX_MEMORY(NULL),
};

static int info_of_volume(cli_host *host, const cli_value *values, const cli_input *input) {
  hl_volume *volume = NULL;
  hl_volume_load_options load;
  hl_error error = {0};
  json_writer json = {0};
  if (input_check_place(&values[INFO_SPACING]) != EXIT_CODE_OK) return EXIT_CODE_USAGE;
  input_load_options(&values[INFO_ARRAY], &values[INFO_SPACING], &load);
  load.pixels = input_picture_side(); /* the properties are printed for the resolution that a picture shows */
  hl_status status = input_load_volume(host->context, input, &load, &volume, &error);
  int exit_code = status == HL_OK ? input_check_unit(&values[INFO_UNIT], volume)
                                  : host_fail(host, PHASE_READ, status, &error);
  if (exit_code == EXIT_CODE_OK)
    exit_code = info_tell_volume(host, values[INFO_JSON].given ? &json : NULL, input->title, volume,
                                 values[INFO_UNIT].text, true, values[INFO_LABEL_TABLE].text);
  hl_volume_release(volume);
  return exit_code == EXIT_CODE_OK ? finish_stdout() : exit_code;
}

/* Prints the properties of a scene: its picture, the numbers of its volumes, lights and so on, and each
 * volume as for a volume file. picture: the picture that holds the scene; null if the scene is a file. */
static int tell_scene(cli_host *host, bool as_json, const char *title, const hl_scene_description *scene,
                      const info_picture *picture) {
  json_writer json = {0};
  int exit_code = EXIT_CODE_OK;
  if (as_json) {
    json_open_object(&json, NULL);
    json_text(&json, "file", title);
    json_whole_number(&json, "width", (uint64_t)scene->width);
    json_whole_number(&json, "height", (uint64_t)scene->height);
    json_whole_number(&json, "lights", scene->light_count);
    json_whole_number(&json, "meshes", scene->mesh_count);
    if (picture != NULL) info_picture_print_json(picture, &json);
    json_open_array(&json, "volumes");
  } else {
    printf("%s\n  scene       %d x %d pixels, lights %zu, volumes %zu, meshes %zu\n", title, scene->width,
           scene->height, scene->light_count, scene->volume_count, scene->mesh_count);
    if (picture != NULL) info_picture_print(picture);
  }
  for (size_t n = 0; n < scene->volume_count && exit_code == EXIT_CODE_OK; n++) {
    const hl_scene_volume *volume = &scene->volumes[n];
    const char *path = volume->file != NULL ? volume->file : title;
    exit_code = info_tell_volume(host, as_json ? &json : NULL, path, volume->volume, NULL, false, NULL);
    for (size_t label = 0; !as_json && label < volume->label_count; label++)
      printf("  %s  %" PRId64 ": %s%s\n", label == 0 ? "labels    " : "          ",
             volume->labels[label].value,
             volume->labels[label].name != NULL ? volume->labels[label].name : "",
             volume->labels[label].visible ? "" : " (hidden)");
  }
  if (as_json) {
    json_close(&json);
    json_close(&json);
  }
  return exit_code == EXIT_CODE_OK ? finish_stdout() : exit_code;
}

/* Refuses the options that choose a part of a volume file. */
static int refuse_reading(const cli_value *values, const char *title, const char *what) {
  for (int which = INFO_ARRAY; which <= INFO_LABEL_TABLE; which++)
    if (values[which].given)
      return fail(EXIT_CODE_USAGE, "--%s is for volume files, and '%s' is %s", info_options[which].name,
                  title, what);
  return EXIT_CODE_OK;
}

/* Prints the facts about a picture's scene that the picture's own metadata state, because the files of the
 * scene cannot be read. */
static int tell_without_files(const info_picture *picture, const char *title, bool as_json,
                              const hl_error *error) {
  if (as_json) return info_of_plain_picture(picture, title, true);
  printf("%s\n", title);
  info_picture_print(picture);
  printf("  scene       its files cannot be read: %s\n", error->message);
  return finish_stdout();
}

/* picture: as for tell_scene(). */
static int info_of_scene(cli_host *host, const cli_value *values, const cli_input *input,
                         const info_picture *picture) {
  hl_scene *scene = NULL;
  hl_error error = {0};
  hl_status status = input_load(host->context, input, NULL, &scene, &error);
  if (picture != NULL && status == HL_ERROR_IO)
    return tell_without_files(picture, input->title, values[INFO_JSON].given, &error);
  int exit_code = status == HL_OK ? tell_scene(host, values[INFO_JSON].given, input->title,
                                               hl_scene_describe(scene), picture)
                                  : host_fail(host, PHASE_READ, status, &error);
  hl_scene_release(scene);
  return exit_code;
}

static int info_of_picture(cli_host *host, const cli_value *values, const cli_input *input, const void *bytes,
                           size_t length) {
  info_picture picture;
  int exit_code = info_picture_read(host, input->title, bytes, length, &picture);
  if (exit_code == EXIT_CODE_OK)
    exit_code = picture.scene != NULL
                    ? info_of_scene(host, values, input, &picture)
                    : info_of_plain_picture(&picture, input->title, values[INFO_JSON].given);
  info_picture_release(&picture);
  return exit_code;
}

/* Prints the properties of an OpenEXR or Radiance HDR picture. */
static int info_of_light(cli_host *host, const cli_value *values, const char *path) {
  size_t length = 0;
  unsigned char *bytes = frames_read_picture(path, &length);
  const cli_input input = {.path = path, .title = path};
  int exit_code = bytes != NULL ? info_of_picture(host, values, &input, bytes, length)
                                : frames_fail_read(path);
  free(bytes);
  return exit_code;
}

/* What has colours in a mesh; null if nothing has. */
static const char *colored_part(const hl_mesh_description *mesh) {
  return mesh->colors != NULL          ? "vertices"
         : mesh->face_colors != NULL   ? "faces"
         : mesh->sphere_colors != NULL ? "spheres"
         : mesh->line_colors != NULL   ? "lines"
                                       : NULL;
}

static void print_json_mesh(const char *path, const hl_mesh_description *mesh, const double low[3],
                            const double high[3], double area, double volume) {
  json_writer json = {0};
  json_open_object(&json, NULL);
  json_text(&json, "file", path);
  json_whole_number(&json, "vertices", mesh->vertex_count);
  json_whole_number(&json, "triangles", mesh->triangle_count);
  json_whole_number(&json, "spheres", mesh->sphere_count);
  json_whole_number(&json, "lines", mesh->line_count);
  json_bool(&json, "normals", mesh->normals != NULL);
  json_text(&json, "colors", colored_part(mesh));
  json_number(&json, "area", area);
  if (isfinite(volume)) json_number(&json, "volume", volume);
  json_open_object(&json, "box");
  json_numbers(&json, "min", low, 3);
  json_numbers(&json, "max", high, 3);
  json_close(&json);
  json_close(&json);
}

static void print_mesh(const char *path, const hl_mesh_description *mesh, const double low[3],
                       const double high[3], double area, double volume) {
  printf("%s\n  mesh        %zu triangles of %zu vertices", path, mesh->triangle_count, mesh->vertex_count);
  if (mesh->sphere_count > 0) printf(", %zu spheres", mesh->sphere_count);
  if (mesh->line_count > 0) printf(", %zu lines, whose tubes are among the triangles", mesh->line_count);
  printf("\n");
  if (mesh->triangle_count > 0)
    printf("  normals     %s\n", mesh->normals != NULL ? "of the file" : "none: faces and edges are found");
  if (mesh->triangle_count > 0) printf("  area        %.6g square units\n", area);
  if (mesh->triangle_count > 0 && isfinite(volume)) printf("  volume      %.6g cubic units\n", volume);
  else if (mesh->triangle_count > 0) printf("  volume      none: the triangles are not closed\n");
  const char *colored = colored_part(mesh);
  printf("  colours     %s%s\n", colored != NULL ? "of " : "none", colored != NULL ? colored : "");
  printf("  world box   x %.9g to %.9g, y %.9g to %.9g, z %.9g to %.9g\n", low[0], high[0], low[1], high[1],
         low[2], high[2]);
}

static int info_of_mesh(cli_host *host, const cli_value *values, const char *path) {
  hl_mesh *mesh = NULL;
  hl_error error = {0};
  double low[3], high[3], area, volume;
  int exit_code = refuse_reading(values, path, "a mesh");
  if (exit_code != EXIT_CODE_OK) return exit_code;
  hl_status status = hl_mesh_load(host->context, path, &mesh, &error);
  if (status == HL_OK) status = hl_mesh_measure(host->context, mesh, &area, &volume, &error);
  if (status != HL_OK) {
    hl_mesh_release(mesh);
    return host_fail(host, PHASE_READ, status, &error);
  }
  if (hl_mesh_get_box(mesh, low, high) != HL_OK)
    exit_code = fail(EXIT_CODE_FAILURE, "%s: the library does not tell what it read", path);
  else if (values[INFO_JSON].given) print_json_mesh(path, hl_mesh_describe(mesh), low, high, area, volume);
  else print_mesh(path, hl_mesh_describe(mesh), low, high, area, volume);
  hl_mesh_release(mesh);
  return exit_code == EXIT_CODE_OK ? finish_stdout() : exit_code;
}

/* Refuses --formats together with options other than --json. */
static int run_formats(const cli_value *values, char **operands) {
  for (int which = INFO_FORMATS + 1; which < INFO_OPTION_COUNT; which++)
    if (values[which].given)
      return fail(EXIT_CODE_USAGE, "--%s is for files, and --formats lists formats",
                  info_options[which].name);
  if (operands[0] != NULL)
    return fail(EXIT_CODE_USAGE, "--formats takes no file: leave '%s' or --formats out", operands[0]);
  return info_formats(values[INFO_JSON].given);
}

/* Returns whether a file is a picture of linear light. The headers of ANALYZE volumes also end in .hdr, so
 * that such a file is a picture only if it has the mark of Radiance HDR. */
static bool is_light(const char *path) {
  char mark[2] = {0};
  if (has_extension(path, ".exr")) return true;
  FILE *file = has_extension(path, ".hdr") ? fopen(path, "rb") : NULL;
  if (file == NULL) return false;
  const bool is_radiance = fread(mark, 1, sizeof mark, file) == sizeof mark &&
                           memcmp(mark, "#?", sizeof mark) == 0;
  fclose(file);
  return is_radiance;
}

static int info_of_input(cli_host *host, const cli_value *values, const char *path) {
  cli_input input = {0};
  const bool page = has_extension(path, ".pdf") || has_extension(path, ".svg"),
             light = !page && is_light(path);
  int exit_code = page || light ? refuse_reading(values, path, "a picture") : EXIT_CODE_OK;
  if (exit_code != EXIT_CODE_OK) return exit_code;
  if (page) return info_of_page(path, values[INFO_JSON].given);
  if (light) return info_of_light(host, values, path);
  exit_code = input_open(path, values[INFO_MAX_MEMORY].bytes, &input);
  if (exit_code == EXIT_CODE_OK && input.kind != INPUT_VOLUME)
    exit_code = refuse_reading(values, input.title,
                               input.kind == INPUT_PICTURE ? "a picture" : "a scene: give its volume's file");
  if (exit_code == EXIT_CODE_OK && input.kind == INPUT_PICTURE && input.bytes != NULL)
    exit_code = info_of_picture(host, values, &input, input.bytes, input.length);
  else if (exit_code == EXIT_CODE_OK)
    exit_code = input.kind == INPUT_VOLUME ? info_of_volume(host, values, &input)
                                           : info_of_scene(host, values, &input, NULL);
  input_close(&input);
  return exit_code;
}

static int run_info(const cli_value *values, char **operands) {
  if (values[INFO_FORMATS].given) return run_formats(values, operands);
  if (operands[0] == NULL)
    return fail(EXIT_CODE_USAGE, "info needs FILE or --formats: see 'halflight help info'");
  cli_host host;
  cli_host_options options = {
      .memory_limit = values[INFO_MAX_MEMORY].bytes, .subject = operands[0], .operands = operands};
  int exit_code = host_open(&options, &host);
  if (exit_code != EXIT_CODE_OK) return exit_code;
  if (is_mesh_file(host.context, operands[0])) {
    exit_code = info_of_mesh(&host, values, operands[0]);
    host_close(&host);
    return exit_code;
  }
  exit_code = info_of_input(&host, values, operands[0]);
  host_close(&host);
  return exit_code;
}

const cli_command info_command = {
    .name = "info",
    .operands = "[FILE]",
    .operand_most = 1,
    .summary = "show what a volume, a scene, a picture or a mesh holds",
    .description =
        "Shows what a volume file holds: size, type, spacing, orientation, world box, range and histogram.\n"
        "For a scene, or a picture that holds one, shows how many volumes, meshes and lights it has, and "
        "the\n"
        "same as above for each volume. For a picture, shows its size and bits, and the camera, the\n"
        "volumes and the stated differences of fields that it holds. For a mesh file, shows its numbers of "
        "triangles, spheres and lines,\n"
        "whether it has normals and colours, its area, the volume that it encloses, and its box. For a "
        "label\n"
        "map, lists its labels with their names, voxels and volumes, in ml, too, if the unit of lengths is "
        "known.",
    .options = info_options,
    .option_count = INFO_OPTION_COUNT,
    .run = run_info,
};
