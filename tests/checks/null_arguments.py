#!/usr/bin/env python3
"""Every public function survives null for every pointer it takes, and says so where null is not allowed.

usage: null_arguments.py INCLUDE_FOLDER LIBRARY CC [FLAG ...]

Writes and runs a program that calls each declared function once for each of its pointers, null there and good values
elsewhere, and once with nothing but null, each call in a process of its own. A function that returns hl_status answers
HL_ERROR_ARGUMENT (with a line that names what is wrong, where it takes an hl_error), but for the pointers below, which its
header allows to be null.
"""
import pathlib
import re
import subprocess
import sys
import tempfile

# "function argument": the header says what null means there
ALLOWED = """
hl_context_create options
hl_devices_find missing
hl_devices_find error
hl_context_confine folder
hl_context_limit_memory scratch_folder
hl_image_write options
hl_figure_write options
hl_figure_encode options
hl_figure_of_picture scene
hl_image_encode options
hl_volume_save_with options
hl_image_to_srgb8 options
hl_renderer_render statistics
hl_renderer_share_over_ranks ranks
hl_renderer_use_device device
hl_renderer_render_layers layers
hl_renderer_render_layers statistics
hl_reference_render options
hl_reference_render_layers options
hl_reference_render_layers layers
hl_scene_from_json base_folder
hl_scene_to_json_beside folder
hl_scene_for_volume_look file
hl_scene_from_json name
hl_scene_from_json_like base_folder
hl_scene_from_json_like like
hl_scene_from_json_like name
hl_scene_from_json_coarse name
hl_scene_from_json_coarse base_folder
hl_scene_for_volume file
hl_volume_guess file
hl_volume_next_look file
hl_labels_of_volume table
hl_view_choose up
hl_scene_make_floor up
hl_volume_from_shapes name
hl_volume_load_with options
hl_transfer_function_load_for volume
hl_volume_read_finer path
hl_volume_read_finer cameras
hl_scene_read_finer cameras
hl_scene_for_channels options
hl_scene_for_channels channels
hl_scene_for_channels smooth
hl_ranks_join communicator
hl_option_kind_of name
hl_option_choices name
hl_scene_for_label_map reading
hl_volume_from_shapes options
"""

# Good values: by "type name" first, then by type.
VALUES = {
    "hl_context *": "context", "const hl_context *": "context", "hl_context **": "&any",
    "hl_volume *": "volume", "const hl_volume *": "volume", "hl_volume **": "&any",
    "hl_scene *": "scene", "const hl_scene *": "scene", "hl_scene **": "&any",
    "hl_preview *": "preview", "const hl_preview *": "preview", "hl_preview **": "&any",
    "hl_renderer *": "renderer", "hl_renderer **": "&any",
    "hl_image *": "image", "const hl_image *": "image", "hl_image **": "&any",
    "hl_error *": "&error", "float *": "floats", "float **": "&any", "double *": "doubles", "char **": "&any",
    "unsigned char **": "&any", "size_t *": "&count", "unsigned char *": "bytes", "uint8_t *": "bytes",
    "const char * text": "\"{}\"", "const char * channels": "\"RGB\"", "const char * path": "\"nothing.nrrd\"",
    "const char * format_name": "\"png\"", "const char * rig": "\"rim\"", "const char *": "\"name\"", "const char **": "&any", "char *": "NULL",
    "const hl_transfer_function *": "&function",
    "const hl_volume_description *": "&description", "const hl_scene_description *": "hl_scene_describe(scene)",
    "const hl_option *": "&option", "hl_file_format *": "&file_format", "unsigned": "0",
    "const hl_volume_info *": "&info",
    "const hl_image_write_options *": "&write_options", "const hl_reference_options *": "&reference_options",
    "const hl_shapes_options *": "&shapes_options", "const hl_reslice_options *": "&reslice_options",
    "const hl_figure *": "&figure", "hl_figure *": "&other_figure", "hl_figure_panel *": "&panel", "hl_overlay *": "&overlay",
    "const hl_scene_mesh *": "&scene_mesh",
    "hl_mesh *": "mesh", "const hl_mesh *": "mesh", "hl_mesh **": "&any",
    "const hl_mesh_description *": "&mesh_description",
    "const hl_cells_description *": "&cells_description", "const hl_amr_description *": "&amr_description",
    "hl_label **": "&any", "hl_label *": "NULL",
    "hl_ranks **": "&any", "hl_ranks *": "NULL", "const hl_ranks *": "NULL", "void * communicator": "bytes",
    "hl_view *": "&view", "const hl_view *": "&view",
    "int part": "2", "size_t length": "2", "size_t row_stride": "16", "int": "4", "size_t": "0", "size_t count": "1", "size_t option_count": "1",
    "hl_scene const **": "&scene", "const int *": "&zero", "double": "0.5",
}

FILE = """#include <halflight/halflight.h>
#include <stdio.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

static hl_context *context;
static hl_volume *volume;
static hl_scene *scene;
static hl_preview *preview;
static hl_renderer *renderer;
static hl_image *image;
static hl_mesh *mesh;
static hl_scene_mesh scene_mesh;
static hl_mesh_description mesh_description;
static hl_cells_description cells_description;
static hl_amr_description amr_description;
static hl_volume_description description;
static hl_image_write_options write_options;
static hl_reference_options reference_options;
static hl_shapes_options shapes_options;
static hl_option option = {"zoom", "2"};
static hl_volume_info info;
static hl_file_format file_format = {.struct_size = sizeof file_format};
static hl_reslice_options reslice_options;
static hl_figure figure, other_figure;
static hl_figure_panel panel, other_panel;
static hl_overlay overlay;
static hl_transfer_function function;
static hl_view view = {{0, 0, 1}, {0, -1, 0}, 30, 20, 0};
static void *any;
static size_t count;
static const int zero = 0;
static hl_error error;
static float floats[1024];
static double doubles[64];
static unsigned char bytes[4096];

static int make(void) {
  hl_volume_description_defaults(&description);
  for (int axis = 0; axis < 3; axis++) description.dimensions[axis] = 4;
  for (int i = 0; i < 64; i++) bytes[i] = (unsigned char)(4 * i);
  description.voxels = bytes;
  hl_image_write_options_defaults(&write_options);
  hl_reference_options_defaults(&reference_options);
  hl_shapes_options_defaults(&shapes_options);
  hl_reslice_options_defaults(&reslice_options);
  hl_figure_defaults(&figure);
  hl_figure_defaults(&other_figure);
  hl_overlay_defaults(&other_panel.overlay);
  figure.width = figure.height = 10, figure.panels = &other_panel;
  if (hl_context_create(NULL, &context, &error) != HL_OK) return 0;
  static const uint32_t triangle[1][3] = {{0, 1, 2}};
  static const float corners[3][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  hl_mesh_description_defaults(&mesh_description);
  mesh_description.positions = corners, mesh_description.vertex_count = 3;
  mesh_description.triangles = triangle, mesh_description.triangle_count = 1;
  if (hl_mesh_create(context, &mesh_description, &mesh, &error) != HL_OK) return 0;
  hl_scene_mesh_defaults(&scene_mesh);
  scene_mesh.mesh = mesh;
  static const double points[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, values[4] = {0, 1, 2, 3};
  static const unsigned char tetrahedron[1] = {10};
  static const int64_t ends[1] = {4}, names[4] = {0, 1, 2, 3};
  hl_cells_description_defaults(&cells_description);
  cells_description.points = points[0], cells_description.point_count = 4, cells_description.values = values;
  cells_description.types = tetrahedron, cells_description.ends = ends, cells_description.cell_count = 1;
  cells_description.corners = names, cells_description.corner_count = 4;
  static const hl_patch patch = {.count = {2, 2, 2}, .values = floats};
  hl_amr_description_defaults(&amr_description);
  amr_description.patches = &patch, amr_description.patch_count = 1;
  for (int axis = 0; axis < 3; axis++) amr_description.count[axis] = 2;
  hl_scene *large;
  if (hl_volume_create(context, &description, &volume, &error) != HL_OK ||
      hl_scene_for_volume(context, volume, "ball.nrrd", &large, &error) != HL_OK ||
      hl_renderer_create(context, &renderer, &error) != HL_OK || hl_image_create(context, 4, 4, &image, &error) != HL_OK)
    return 0;
  hl_scene_description small = *hl_scene_describe(large);
  small.width = small.height = 4;
  return hl_scene_create(context, &small, &scene, &error) == HL_OK && hl_preview_create(context, scene, &preview, &error) == HL_OK;
}

%s
static int (*const calls[])(void) = {%s};

int main(void) {
  if (!make()) return puts(error.message), 1;
  for (size_t i = 0; i < sizeof calls / sizeof *calls; i++) {
    fflush(stdout);
    pid_t child = fork();
    if (child == 0) _exit(calls[i]());
    int status;
    if (child < 0 || waitpid(child, &status, 0) != child) return 1;
    printf("%%d\\n", WIFEXITED(status) ? WEXITSTATUS(status) : -1);
  }
  return 0;
}
"""
SILENT, UNSAID = 100, 101  # exit codes of a call: returns no status; fails without a line


def declarations(folder):
    """[(returned type, name, [(type, name)])]"""
    for header in sorted(folder.glob("halflight/*.h")):
        text = re.sub(r"/\*.*?\*/", " ", header.read_text(), flags=re.S)
        text = re.sub(r"^\s*#.*$", "", text, flags=re.M)
        for returned, name, arguments in re.findall(r"HL_API\s+(?:HL_WARN_UNUSED\s+)?([\w\s*]+?)(\w+)\(([^;]*)\);", text):
            yield " ".join(returned.split()), name, [argument(text) for text in arguments.split(",") if text.strip() != "void"]


def argument(text):
    """(type, name); an array is a pointer."""
    text = " ".join(text.split())
    kind, name, array = re.fullmatch(r"(.*?[\s*])(\w+)((?:\[\w*\])*)", text).groups()
    stars = kind.count("*") + (array != "")
    return (kind.replace("*", "").strip() + (" " + "*" * stars if stars else "")), name


def value(kind, name):
    if f"{kind} {name}" in VALUES:
        return VALUES[f"{kind} {name}"]
    if kind in VALUES:
        return VALUES[kind]
    if kind.endswith(" *"):  # an option or result struct: all zero but for its own size
        return "&(struct { %s it; }){{ .struct_size = sizeof(%s) }}.it" % ((kind.replace("const ", "")[:-2],) * 2)
    return f"({kind})0"


def has_size(folder, kind):
    text = "".join(header.read_text() for header in folder.glob("halflight/*.h"))
    found = re.search(r"typedef struct (\w+) \{([^}]*)\} " + re.escape(kind.replace("const ", "")[:-2]) + ";", text)
    return found is not None and "size_t struct_size" in found.group(2)


def body(folder, function, nulls):
    returned, name, arguments = function
    given = []
    for number, (kind, argument_name) in enumerate(arguments):
        good = value(kind, argument_name)
        if good.startswith("&(struct") and not has_size(folder, kind):
            good = "(void *)bytes"
        good = "(void *)&any" if good == "&any" else good
        given.append("NULL" if number in nulls else good)
    call = f"{name}({', '.join(given)})"
    if returned != "hl_status":
        return f"(void){call}; return {SILENT};" if returned != "void" else f"{call}; return {SILENT};"
    takes_error = any(kind == "hl_error *" and number not in nulls for number, (kind, _) in enumerate(arguments))
    said = f"if (status != HL_OK && error.message[0] == 0) return {UNSAID};" if takes_error else ""
    return f"memset(&error, 0, sizeof error); hl_status status = {call}; {said} return (int)status;"


def main():
    folder, library, compiler = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]), sys.argv[3:]
    allowed = {tuple(line.split()) for line in ALLOWED.strip().splitlines()}
    functions = list(declarations(folder))
    assert len(functions) > 60, f"only {len(functions)} functions were found"
    names = {(function[1], name) for function in functions for _, name in function[2]}
    problems = [f"{entry}: no such argument" for entry in allowed - names]
    cases = []
    for function in functions:
        pointers = [number for number, (kind, _) in enumerate(function[2]) if kind.endswith("*")]
        cases += [(function, {number}) for number in pointers] + ([(function, set(pointers))] if len(pointers) > 1 else [])
    bodies = "".join(f"static int call_{i}(void) {{ {body(folder, *case)} }}\n" for i, case in enumerate(cases))
    with tempfile.TemporaryDirectory() as work:
        source, program = f"{work}/calls.c", f"{work}/calls"
        pathlib.Path(source).write_text(FILE % (bodies, ", ".join(f"call_{i}" for i in range(len(cases)))))
        subprocess.run([*compiler, "-std=c11", "-D_GNU_SOURCE", "-w", f"-I{folder}", source, "-o", program, str(library),
                        f"-Wl,-rpath,{library.resolve().parent}"], check=True)
        done = subprocess.run([program], cwd=work, capture_output=True, text=True, timeout=60)
    answers = done.stdout.split()
    if len(answers) != len(cases):
        sys.exit(f"only {len(answers)} of {len(cases)} calls were made: {done.stdout[-300:]}")
    for (function, nulls), answer in zip(cases, map(int, answers)):
        what = f"{function[1]}(), null for {', '.join(function[2][number][1] for number in sorted(nulls))}"
        missing = {number for number, given in enumerate(function[2]) if value(*given) == "NULL"}  # there is no good one
        required = [number for number in nulls | missing
                    if function[2][number][1] != "error" and (function[1], function[2][number][1]) not in allowed]
        if answer == -1:
            problems.append(f"{what}: crashed")
        elif answer == UNSAID:
            problems.append(f"{what}: fails without a line")
        elif answer != SILENT and required and answer != 1:
            problems.append(f"{what}: status {answer} in place of HL_ERROR_ARGUMENT (if its header allows null, add it to ALLOWED)")
        elif answer == 1 and not required:
            problems.append(f"{what}: refused, though the header allows it")
    print(f"{len(cases)} calls of {len(functions)} functions")
    sys.exit("\n".join(problems) if problems else 0)


main()
