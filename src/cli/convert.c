/* cli/convert.c - implements `halflight convert IN OUT`, which writes a volume, or a box of it, in another
 * format, type or resolution, a volume's surface as a mesh, and pictures and meshes in another format. */
#define _GNU_SOURCE
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "commands.h"
#include "host.h"
#include "input.h"
#include "output.h"

enum convert_option {
  CONVERT_CROP,
  CONVERT_SHRINK,
  CONVERT_TYPE,
  CONVERT_UNIT,
  CONVERT_ISO,
  CONVERT_SHOW,
  CONVERT_LABEL_TABLE,
  CONVERT_OUTPUT,
  CONVERT_ARRAY,
  CONVERT_COMPONENT,
  CONVERT_SERIES,
  CONVERT_TIME,
  CONVERT_CHANNEL,
  CONVERT_LEVEL,
  CONVERT_SPACING,
  CONVERT_SPACE,
  CONVERT_BACKGROUND,
  CONVERT_EXPOSURE,
  CONVERT_TONE,
  CONVERT_MAX_MEMORY,
  CONVERT_QUIET,
  CONVERT_OPTION_COUNT
};

static const cli_choice types[] = {
    {"uint8", HL_VOXEL_U8},    {"int8", HL_VOXEL_I8},     {"uint16", HL_VOXEL_U16},  {"int16", HL_VOXEL_I16},
    {"uint32", HL_VOXEL_U32},  {"int32", HL_VOXEL_I32},   {"uint64", HL_VOXEL_U64},  {"int64", HL_VOXEL_I64},
    {"float16", HL_VOXEL_F16}, {"float32", HL_VOXEL_F32}, {"float64", HL_VOXEL_F64}, {NULL, 0}};

static const cli_choice backgrounds[] = {{"transparent", 1}, {NULL, 0}};

static const cli_option convert_options[CONVERT_OPTION_COUNT] = {
    [CONVERT_CROP] = {.name = "crop",
                      .kind = OPTION_TEXT,
                      .argument = "AXIS=A:B",
                      .group = "Options",
                      .help = "keep the voxels A to B - 1 along an axis i, j or k,\n"
                              "counted from 0 (i=10:200, k=:50, j=20:); may be given\nagain for another axis",
                      .repeatable = true},
    [CONVERT_SHRINK] = {.name = "shrink",
                        .kind = OPTION_NUMBERS,
                        .argument = "N",
                        .help = "make one voxel of each box of N x N x N voxels: their\nmean, or in a label "
                                "map their commonest label",
                        .count = 1,
                        .whole = true,
                        .low = 1,
                        .high = 65536},
    [CONVERT_TYPE] =
        {.name = "type",
         .kind = OPTION_CHOICE,
         .argument = "TYPE",
         .help =
             "type of the voxels: uint8, int8, ... uint64, int64,\nfloat16, float32 or float64; values are "
             "rounded to whole\nnumbers (default: the volume's own, or the next larger\none that "
             "holds its values)",
         .choices = types},
    [CONVERT_UNIT] = {.name = "unit",
                      .kind = OPTION_TEXT,
                      .argument = "UNIT",
                      .help = "unit of lengths, where IN does not tell it: m, cm, mm,\num, nm or angstrom"},
    [CONVERT_ISO] = {.name = "iso",
                     .also = "isosurface",
                     .kind = OPTION_NUMBERS,
                     .argument = "VALUE",
                     .help = "the value on the surface that becomes the mesh OUT: .ply,\n.stl or .obj",
                     .count = 1,
                     .low = -INFINITY,
                     .high = INFINITY},
    [CONVERT_SHOW] = {.name = "show",
                      .also = "label",
                      .kind = OPTION_TEXT,
                      .argument = "LABEL,...",
                      .help = "labels of the label map IN, by name or number, or all, whose\nsmooth surface "
                              "becomes the mesh OUT"},
    [CONVERT_LABEL_TABLE] = {.name = "label-table",
                             .kind = OPTION_TEXT,
                             .argument = "FILE",
                             .help = "names of labels: FreeSurfer's, Slicer's or ITK-SNAP's table,\nor CSV"},
    [CONVERT_OUTPUT] = {.name = "output",
                        .letter = 'o',
                        .kind = OPTION_TEXT,
                        .argument = "OUT",
                        .help = "the file, in place of the second operand"},
    INPUT_OPTIONS(CONVERT_ARRAY, "What to read of IN"),
    [CONVERT_CHANNEL] = INPUT_OPTION_CHANNEL,
    [CONVERT_SPACING] = INPUT_OPTION_SPACING,
    [CONVERT_SPACE] = INPUT_OPTION_SPACE,
    [CONVERT_BACKGROUND] = {.name = "background",
                            .kind = OPTION_COLOR,
                            .argument = "COLOR|transparent",
                            .group = "Pictures: OUT is .png or .tif",
                            .help = "colour under the picture (default transparent)",
                            .choices = backgrounds,
                            .setting_kind = HL_SETTINGS_IMAGE,
                            .setting = "background"},
    [CONVERT_EXPOSURE] = {.name = "exposure",
                          .kind = OPTION_NUMBERS,
                          .argument = "STOPS",
                          .help = "brightness: each stop doubles the light (default 0)",
                          .count = 1,
                          .setting_kind = HL_SETTINGS_IMAGE,
                          .setting = "exposure"},
    [CONVERT_TONE] = {.name = "tone",
                      .kind = OPTION_CHOICE,
                      .help = "how light brighter than white is shown (default clip)",
                      .setting_kind = HL_SETTINGS_IMAGE,
                      .setting = "tone"},
    [CONVERT_MAX_MEMORY] = HOST_OPTION_MAX_MEMORY("How it runs"),
    [CONVERT_QUIET] = HOST_OPTION_QUIET,
};

/* Reads a number of voxels, if there is one, and moves *text past it. */
static bool read_index(const char **text, size_t *index) {
  size_t length = strspn(*text, "0123456789");
  if (length > 9) return false;
  if (length > 0) *index = strtoul(*text, NULL, 10);
  *text += length;
  return true;
}

/* Reads --crop's boxes into the options; indices are checked with the volume. */
static int read_crop(const cli_value *crop, hl_volume_save_options *options) {
  for (int n = 0; n < crop->count; n++) {
    const char *text = crop->texts[n], *at = text + 2;
    int axis = text[0] >= 'i' && text[0] <= 'k' && text[1] == '=' ? text[0] - 'i' : -1;
    bool good = axis >= 0 && read_index(&at, &options->begin[axis]) && *at++ == ':' &&
                read_index(&at, &options->end[axis]) && *at == '\0';
    if (!good)
      return fail(EXIT_CODE_USAGE,
                  "--crop: '%s' is not AXIS=A:B: write i=10:200 for the voxels 10 to 199 along i", text);
  }
  return EXIT_CODE_OK;
}

static int read_options(const cli_value *values, hl_volume_save_options *options) {
  hl_volume_save_options_defaults(options);
  if (values[CONVERT_SHRINK].given) options->shrink = (size_t)values[CONVERT_SHRINK].number[0];
  if (values[CONVERT_TYPE].given) options->type = (hl_voxel_type)values[CONVERT_TYPE].choice;
  if (values[CONVERT_UNIT].given) options->unit = values[CONVERT_UNIT].text;
  return read_crop(&values[CONVERT_CROP], options);
}

/* Checks that the box is inside the volume. The check is made here, so that the error names the option. */
static int check_crop(const cli_value *crop, const hl_volume_save_options *options, const hl_volume *volume) {
  hl_volume_info info = {.struct_size = sizeof info};
  if (hl_volume_get_info(volume, &info) != HL_OK) return EXIT_CODE_OK;
  for (int n = 0; n < crop->count; n++) {
    int axis = crop->texts[n][0] - 'i';
    size_t size = info.dimensions[axis], end = options->end[axis] > 0 ? options->end[axis] : size;
    if (options->begin[axis] >= end || end > size)
      return fail(EXIT_CODE_USAGE, "--crop: '%s': the volume has %zu voxels along %c, 0 to %zu",
                  crop->texts[n], size, "ijk"[axis], size - 1);
  }
  return EXIT_CODE_OK;
}

static void report(const char *output, double seconds) { say("%s: written in %.2f s", output, seconds); }

/* Loads the volume IN. The caller closes the input and releases the volume, also after a failure. */
static int load_volume(cli_host *host, const cli_value *values, const char *in, cli_input *input,
                       hl_volume **volume) {
  hl_error error = {0};
  hl_volume_load_options load;
  input_load_options(&values[CONVERT_ARRAY], &values[CONVERT_SPACING], &load);
  int exit_code = input_check_place(&values[CONVERT_SPACING]);
  if (exit_code == EXIT_CODE_OK) exit_code = input_open(in, values[CONVERT_MAX_MEMORY].bytes, input);
  if (exit_code == EXIT_CODE_OK) {
    hl_status status = input_load_volume(host->context, input, &load, volume, &error);
    if (status != HL_OK) exit_code = host_fail(host, PHASE_READ, status, &error);
  }
  host_clear_bar(host);
  return exit_code;
}

static int convert(cli_host *host, const cli_value *values, const char *in, const char *out,
                   hl_volume_save_options *options) {
  double started = hl_clock_seconds();
  cli_input input = {0};
  hl_volume *volume = NULL;
  hl_error error = {0};
  int exit_code = load_volume(host, values, in, &input, &volume);
  if (exit_code == EXIT_CODE_OK) exit_code = check_crop(&values[CONVERT_CROP], options, volume);
  if (exit_code == EXIT_CODE_OK) exit_code = input_check_unit(&values[CONVERT_UNIT], volume);
  if (exit_code == EXIT_CODE_OK) exit_code = read_files_protect(&host->read, out, in);
  if (exit_code == EXIT_CODE_OK) {
    hl_status status = HL_OK;
    if (options->shrink > 1) status = hl_volume_is_label_map(host->context, volume, &options->labels, &error);
    if (status == HL_OK) status = hl_volume_save_with(host->context, volume, out, options, &error);
    host_clear_bar(host);
    if (status != HL_OK) exit_code = host_fail(host, PHASE_CHANGE, status, &error);
    else if (!host->quiet) report(out, hl_clock_seconds() - started);
  }
  input_close(&input);
  hl_volume_release(volume);
  return exit_code;
}

/* ---- meshes ---- */

/* Makes the mesh of the surface of labels. */
static int make_label_surface(cli_host *host, const cli_value *values, hl_volume *map, hl_mesh **mesh) {
  hl_label *labels = NULL;
  size_t count = 0;
  hl_error error = {0};
  hl_status status = hl_labels_of_volume(host->context, map, values[CONVERT_LABEL_TABLE].text, &labels,
                                         &count, &error);
  if (status != HL_OK) return host_fail(host, PHASE_READ, status, &error);
  status = hl_labels_show(host->context, values[CONVERT_SHOW].text, labels, count, &error);
  if (status == HL_OK) status = hl_mesh_of_labels(host->context, map, labels, count, mesh, &error);
  hl_labels_release(host->context, labels);
  return status == HL_OK ? EXIT_CODE_OK : host_fail(host, PHASE_CHANGE, status, &error);
}

/* Makes the mesh of the surface of the volume IN. */
static int make_surface(cli_host *host, const cli_value *values, const char *in, const char *out,
                        hl_mesh **mesh) {
  const cli_value *iso = &values[CONVERT_ISO];
  cli_input input = {0};
  hl_volume *volume = NULL;
  hl_error error = {0};
  if (iso->given == values[CONVERT_SHOW].given)
    return fail(EXIT_CODE_USAGE,
                "OUT is a mesh, '%s': give --iso VALUE, the value on the surface of '%s', or --show LABEL, a "
                "label of a label map",
                out, in);
  int exit_code = load_volume(host, values, in, &input, &volume);
  if (exit_code == EXIT_CODE_OK) exit_code = input_check_unit(&values[CONVERT_UNIT], volume);
  if (exit_code == EXIT_CODE_OK && !iso->given) exit_code = make_label_surface(host, values, volume, mesh);
  else if (exit_code == EXIT_CODE_OK) {
    hl_status status = hl_mesh_of_isosurface(host->context, volume, iso->number[0], mesh, &error);
    if (status != HL_OK) exit_code = host_fail(host, PHASE_CHANGE, status, &error);
  }
  input_close(&input);
  hl_volume_release(volume);
  return exit_code;
}

static int load_mesh(cli_host *host, const cli_value *values, const char *in, hl_mesh **mesh) {
  hl_error error = {0};
  for (int row = CONVERT_CROP; row < CONVERT_BACKGROUND; row++)
    if (values[row].given && row != CONVERT_OUTPUT)
      return fail(EXIT_CODE_USAGE, "--%s is for volumes, and IN is a mesh, '%s'", convert_options[row].name,
                  in);
  hl_status status = hl_mesh_load(host->context, in, mesh, &error);
  return status == HL_OK ? EXIT_CODE_OK : host_fail(host, PHASE_READ, status, &error);
}

/* Writes a mesh: IN itself, or the surface of the volume IN. */
static int convert_mesh(cli_host *host, const cli_value *values, const char *in, const char *out) {
  double started = hl_clock_seconds();
  hl_mesh *mesh = NULL;
  hl_error error = {0};
  int exit_code = is_mesh_file(host->context, in) ? load_mesh(host, values, in, &mesh)
                                                  : make_surface(host, values, in, out, &mesh);
  if (exit_code == EXIT_CODE_OK) exit_code = read_files_protect(&host->read, out, in);
  if (exit_code == EXIT_CODE_OK) {
    hl_status status = hl_mesh_save(host->context, mesh, out, &error);
    host_clear_bar(host);
    if (status != HL_OK) exit_code = host_fail(host, PHASE_RUN, status, &error);
    else if (!host->quiet) report(out, hl_clock_seconds() - started);
    if (exit_code == EXIT_CODE_OK && values[CONVERT_UNIT].given && !host->quiet)
      say("%s: meshes state no unit: the lengths in it are in %s", out, values[CONVERT_UNIT].text);
  }
  hl_mesh_release(mesh);
  return exit_code;
}

/* ---- pictures ---- */

static bool is_picture_name(const char *path) { return has_extension_among(path, picture_extensions); }

/* Returns whether IN and OUT are pictures. NumPy's arrays and TIFFs may be pictures or volumes, so that IN
 * decides. */
static bool are_pictures(const char *in, const char *out) {
  const bool tiff = has_extension(out, ".tif") || has_extension(out, ".tiff");
  if (!tiff && !has_extension(out, ".npy")) return is_picture_name(out);
  return has_extension(in, ".png") || has_extension(in, ".exr") || (tiff && has_extension(in, ".npy"));
}

/* Refuses options that do not suit OUT: options of volumes if OUT is a picture or a mesh, options of meshes
 * if OUT is no mesh, and options of pictures if OUT is no picture, or if OUT keeps light as numbers. */
static int check_kind_of_options(const cli_value *values, bool picture, bool mesh, const char *out) {
  const bool coded = picture && !output_is_linear(out);
  for (int row = 0; row < CONVERT_OPTION_COUNT; row++) {
    const bool of_picture = row >= CONVERT_BACKGROUND && row <= CONVERT_TONE,
               of_mesh = row >= CONVERT_ISO && row <= CONVERT_LABEL_TABLE,
               of_voxels = row < CONVERT_ISO && !(mesh && row == CONVERT_UNIT),
               of_reading = row > CONVERT_OUTPUT && row < CONVERT_BACKGROUND;
    if (values[row].given && of_picture && !coded)
      return fail(EXIT_CODE_USAGE, "--%s is for a .png or .tif, and OUT is '%s'", convert_options[row].name,
                  out);
    if (values[row].given && of_mesh && !mesh)
      return fail(EXIT_CODE_USAGE, "--%s is for a .ply, .stl or .obj, and OUT is '%s'",
                  convert_options[row].name, out);
    if (values[row].given && ((of_voxels && (picture || mesh)) || (of_reading && picture)))
      return fail(EXIT_CODE_USAGE, "--%s is for volumes, and OUT is a %s, '%s'%s", convert_options[row].name,
                  picture ? "picture" : "mesh", out,
                  picture ? ": a volume is written as .nrrd or .nii.gz" : "");
  }
  return EXIT_CODE_OK;
}

static void read_picture_options(const cli_value *values, hl_image_write_options *options) {
  const cli_value *background = &values[CONVERT_BACKGROUND];
  hl_image_write_options_defaults(options);
  options->background_transparent = !background->given || background->chosen;
  if (background->given && !background->chosen)
    memcpy(options->background, background->number, sizeof options->background);
  if (values[CONVERT_EXPOSURE].given) options->exposure = values[CONVERT_EXPOSURE].number[0];
  if (values[CONVERT_TONE].given) options->tone = (hl_tone)values[CONVERT_TONE].choice;
}

/* Writes a picture in another format. An .npy that is no picture is a volume. */
static int convert_picture(cli_host *host, const cli_value *values, const char *in, const char *out,
                           hl_volume_save_options *of_volume) {
  double started = hl_clock_seconds();
  hl_image *image = NULL;
  hl_error error = {0};
  hl_image_write_options options;
  read_picture_options(values, &options);
  hl_status status = hl_image_read(host->context, in, &image, &error);
  if (status == HL_ERROR_UNSUPPORTED && has_extension(in, ".npy") && !has_extension(out, ".png") &&
      !has_extension(out, ".exr"))
    return convert(host, values, in, out, of_volume);
  if (status == HL_ERROR_UNSUPPORTED && !is_picture_name(in))
    return fail(
        EXIT_CODE_INPUT,
        "'%s' is no picture, and OUT is one: halflight render makes a picture of a volume or a scene, and "
        "a volume is written as .nrrd or .nii.gz",
        in);
  if (status != HL_OK) return host_fail(host, PHASE_READ, status, &error);
  status = hl_image_write(host->context, image, out, &options, &error);
  host_clear_bar(host);
  hl_image_destroy(image);
  if (status != HL_OK) return host_fail(host, PHASE_RUN, status, &error);
  if (!host->quiet) report(out, hl_clock_seconds() - started);
  return EXIT_CODE_OK;
}

static int run_convert(const cli_value *values, char **operands) {
  hl_volume_save_options options;
  const char *out = operands[1] != NULL ? operands[1] : values[CONVERT_OUTPUT].text;
  if (operands[1] != NULL && values[CONVERT_OUTPUT].given)
    return fail(EXIT_CODE_USAGE, "--output: OUT is given twice, as '%s' and as '%s'", operands[1],
                values[CONVERT_OUTPUT].text);
  if (out == NULL) return fail(EXIT_CODE_USAGE, "convert needs IN and OUT: see 'halflight help convert'");
  const bool picture = are_pictures(operands[0], out), mesh = has_extension_among(out, mesh_extensions);
  int exit_code = check_kind_of_options(values, picture, mesh, out);
  if (exit_code == EXIT_CODE_OK) exit_code = read_options(values, &options);
  if (exit_code == EXIT_CODE_OK)
    exit_code = output_check(out,
                             picture ? picture_extensions
                             : mesh  ? mesh_extensions
                                     : volume_extensions,
                             operands, 1);
  if (exit_code != EXIT_CODE_OK) return exit_code;
  cli_host host = {0};
  cli_host_options host_options = {.quiet = values[CONVERT_QUIET].given,
                                   .progress = true,
                                   .subject = base_name(operands[0]),
                                   .memory_limit = values[CONVERT_MAX_MEMORY].bytes,
                                   .operands = operands};
  exit_code = host_open(&host_options, &host);
  if (exit_code == EXIT_CODE_OK)
    exit_code = picture ? convert_picture(&host, values, operands[0], out, &options)
                : mesh  ? convert_mesh(&host, values, operands[0], out)
                        : convert(&host, values, operands[0], out, &options);
  host_close(&host);
  return exit_code;
}

const cli_command convert_command = {
    .name = "convert",
    .operands = "IN OUT",
    .operand_count = 1,
    .operand_most = 2,
    .summary = "write a volume, its surface or a picture in another format",
    .description =
        "Writes the volume IN, of any format that render reads, to the file OUT: .nrrd, .nii, .nii.gz, "
        ".mha,\n"
        ".vti, .mrc, .mrc.gz, .tif (ImageJ's stack), NumPy's .npy, or .raw and .raw.gz, whose names state\n"
        "size and type (x_256x256x128_uint8.raw).\n"
        "Values and placement are kept. A warning names everything that OUT's format cannot store.\n"
        "Where OUT is a picture, .png or .exr, IN is a picture, too; the .npy or .tif of a .png or an\n"
        ".exr is a picture. Where OUT is a mesh, .ply, .stl or .obj, IN is a mesh, too, or a volume\n"
        "whose surface --iso names, or a label map whose labels --show names.",
    .options = convert_options,
    .option_count = CONVERT_OPTION_COUNT,
    .run = run_convert,
};
