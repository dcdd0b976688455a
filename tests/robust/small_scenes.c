/* tests/robust/small_scenes.c - see small_scenes.h. */
#include "small_scenes.h"

#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#define HEAD "{\"halflight\": 1, \"image\": {\"width\": 24, \"height\": 20}, "
#define BLOB "\"volumes\": [{\"voxel_size\": 1, " BLOB_SHAPES
#define BLOB_SHAPES                                     \
  "\"shapes\": [{\"type\": \"sphere\", \"radius\": 5}," \
  " {\"type\": \"box\", \"size\": [16, 16, 3], \"position\": [0, 0, -8]}]"
#define SUN \
  "\"lights\": [{\"type\": \"directional\", \"direction\": [0.5, 0.3, -1], \"angular_diameter_deg\": 12}]"

const small_scene small_scenes[] = {
    {"cascade", HEAD SUN ", " BLOB "}], \"render\": {\"threads\": 1, \"shadow_resolution\": 32}}"},
    {"paper", HEAD SUN
     ", " BLOB "}], \"render\": {\"threads\": 1, \"shadow_resolution\": 32, \"soft_method\": \"paper\"}}"},
    {"sublights", HEAD SUN ", " BLOB "}], \"render\": {\"threads\": 1, \"shadow_resolution\": 32, "
                           "\"soft_method\": \"sublights\", \"light_samples\": 2}}"},
    {"splat",
     HEAD "\"camera\": {\"type\": \"orthographic\"}, \"lights\": [{\"type\": \"point\", \"position\": [20, "
          "-20, 30]}], \"volumes\": [{\"voxel_size\": 2, " BLOB_SHAPES
          ", \"clip\": {\"min\": [-4, -9, -9], \"max\": [9, 9, 9]}}],"
          " \"render\": {\"threads\": 1, \"shadow_resolution\": 16, \"shadows\": \"hard\", "
          "\"reconstruction\": \"splat\", \"kernel\": \"gaussian\", \"sheet_spacing\": 1}}"},
    {"lamp",
     HEAD "\"lights\": [{\"type\": \"point\", \"position\": [0, 0, 0], \"radius\": 1}],"
          " \"volumes\": [{\"voxel_size\": 2, \"shapes\": [{\"type\": \"sphere\", \"radius\": 8},"
          " {\"type\": \"sphere\", \"radius\": 4, \"operation\": \"subtract\"}],"
          " \"transfer_function\": {\"color\": [0.8, 0.6, 0.4], \"opacity\": 0.1}, \"shading\": "
          "\"none\"}], \"render\": {\"threads\": 1, \"shadow_resolution\": 16, \"sheet_spacing\": 1}}"},
    {"colors", HEAD "\"lights\": [{\"type\": \"rect\", \"position\": [0, 0, 30], \"edge1\": [6, 0, 0], "
                    "\"edge2\": [0, 8, 0]},"
                    " {\"type\": \"disk\", \"position\": [25, 0, 10], \"normal\": [-1, 0, 0], \"radius\": 4, "
                    "\"shadows\": \"off\"},"
                    " {\"type\": \"polygon\", \"vertices\": [[-30, 0, 9], [-30, 6, 9], [-30, 3, 15]], "
                    "\"falloff\": \"inverse_square\"}],"
                    " \"ambient\": [0.1, 0.2, 0.3], " BLOB ", \"attenuation_color\": [1, 0.5, 0.2]},"
                    " {\"voxel_size\": 1, \"shapes\": [{\"type\": \"torus\", \"radius\": 6, \"tube_radius\": "
                    "2}], \"visible\": false},"
                    " {\"voxel_size\": 1, \"shapes\": [{\"type\": \"orbital\", \"n\": 2, \"l\": 1, \"m\": 0, "
                    "\"radius\": 6}],"
                    " \"transform\": {\"translate\": [3, 0, 4], \"rotate\": {\"axis\": [1, 2, 3], "
                    "\"angle_deg\": 30}}}], \"render\": {\"threads\": 1, \"shadow_resolution\": 32}}"},
    {"surfaces", HEAD SUN
     ", \"meshes\": [{\"spheres\": [[0, 0, 6, 2], [3, 0, 6, 1.5]], \"opacity\": 0.6}, {\"floor\": true}], "
     "\"cuts\": [{\"type\": \"plane\", \"point\": [1, 0, 0], \"normal\": [1, 0, 0.2]}], " BLOB
     ", \"iso\": [{\"value\": 0.6, \"color\": [1, 0.7, 0]}, {\"value\": 0.3, \"opacity\": 0.4}]}], "
     "\"render\": "
     "{\"threads\": 1, \"shadow_resolution\": 32, \"sheet_spacing\": 1}}"},
    {"sky", HEAD "\"sky\": {\"type\": \"gradient\", \"zenith\": [0.8, 0.9, 1], \"ground\": [0.3, 0.2, 0.2]}, "
                 "\"lights\": [], \"meshes\": [{\"spheres\": [[0, 0, 6, 2]]}], \"volumes\": "
                 "[{\"voxel_size\": 2, " BLOB_SHAPES
                 "}], \"render\": {\"threads\": 1, \"shadow_resolution\": 8, \"sheet_spacing\": 4}}"},
    {"glow", HEAD "\"lights\": [{\"type\": \"directional\", \"direction\": [0.5, 0.3, -1]}], \"volumes\": "
                  "[{\"voxel_size\": 3, "
                  "\"shapes\": [{\"type\": \"sphere\", \"radius\": 6}], \"shading\": \"none\", "
                  "\"scattering\": {\"multiple\": "
                  "true}, \"transfer_function\": {\"opacity\": 0.2}}], \"render\": {\"threads\": 1, "
                  "\"shadow_resolution\": 8, "
                  "\"sheet_spacing\": 4}}"},
    {"maximum", HEAD BLOB "}], \"render\": {\"threads\": 2, \"compositing\": \"maximum\"}}"},
    {"slide", HEAD
     "\"lights\": [{\"type\": \"spot\", \"position\": [0, -40, 40], \"direction\": [0, 1, -1], \"radius\": 2,"
     " \"texture\": {\"file\": \"slide.png\", \"screen\": {\"center\": [0, -30, 30], \"right\": [5, 0, 0],"
     " \"up\": [0, 3, 3]}}}], " BLOB ", \"transfer_function\": {\"preset\": \"smoke\"}}], \"render\": "
     "{\"threads\": 1, \"shadow_resolution\": 32}}"},
    {"fur",
     HEAD "\"groups\": {\"ball\": [{\"type\": \"sphere\", \"radius\": 6, \"hypertexture\": {\"amplitude\": "
          "3, \"soft\": 1}}]}, " SUN
          ", \"volumes\": [{\"voxel_size\": 1, \"shapes\": [{\"type\": \"group\", \"name\": \"ball\"}],"
          " \"transfer_function\": {\"opacity\": [[0.2, 0], [0.6, 0.8]], \"colormap\": \"viridis\", "
          "\"range\": [0, 1]}}],"
          " \"render\": {\"threads\": 1, \"shadow_resolution\": 32, \"slicing\": \"image-aligned\", "
          "\"kernel\": \"linear\", \"sheet_spacing\": 1}}"},
    {"labels", HEAD SUN ", \"sky\": {\"type\": \"gradient\"}, \"volumes\": [{\"file\": \"labels.nrrd\", "
                        "\"labels\": [{\"value\": 1, \"color\": "
                        "[1, 0, 0]}, {\"value\": 2, \"opacity\": 0.4}]}], \"render\": {\"threads\": 1, "
                        "\"shadow_resolution\": 32, \"sheet_spacing\": 1}}"},
    {"mask",
     HEAD SUN ", \"volumes\": [{\"voxel_size\": 1, " BLOB_SHAPES
              ", \"mask\": {\"file\": \"labels.nrrd\", \"rest\": 0.3, \"labels\": [{\"value\": 1, "
              "\"visible\": false}, {\"value\": 2, \"color\": [0, 1, 0]}]}}], \"render\": {\"threads\": 1, "
              "\"shadow_resolution\": 32, \"sheet_spacing\": 1}}"},
    {"plane", HEAD SUN
     ", \"volumes\": [{\"name\": \"a\", \"voxel_size\": 1, " BLOB_SHAPES
     ", \"transfer_function\": {\"second\": \"gradient\", \"boxes\": [{\"value\": [0.2, 1], "
     "\"second\": [0, 1], \"edge\": [0.1, 0.1], \"color\": [0.2, 0.4, 0.7]}]}}, {\"voxel_size\": 2, "
     "\"shapes\": [{\"type\": \"sphere\", \"radius\": 7}], \"transfer_function\": {\"second\": "
     "{\"volume\": \"a\"}, \"polygons\": [{\"vertices\": [[0, 0], [1, 0], [0.5, 1]]}]}}], \"render\": "
     "{\"threads\": 1, \"shadow_resolution\": 16, \"sheet_spacing\": 2}}"},
    {NULL, NULL}};

const size_t small_scene_count = sizeof small_scenes / sizeof small_scenes[0] - 1;

hl_status small_scene_make(hl_context *context, size_t index, const char *folder, hl_scene **scene,
                           hl_error *error) {
  const char *json = small_scenes[index].json;
  return hl_scene_from_json(context, json, strlen(json), folder, small_scenes[index].name, scene, error);
}

/* Writes a label map of 12 x 12 x 12 voxels: two boxes that touch. */
static bool write_labels(const char *folder) {
  enum { SIDE = 12 };
  char path[256];
  snprintf(path, sizeof path, "%s/labels.nrrd", folder);
  FILE *file = fopen(path, "wb");
  if (file == NULL) return false;
  fputs("NRRD0004\ntype: uint8\ndimension: 3\nsizes: 12 12 12\nencoding: raw\n\n", file);
  for (int k = 0; k < SIDE; k++)
    for (int j = 0; j < SIDE; j++)
      for (int i = 0; i < SIDE; i++) {
        const bool inside = i > 1 && i < 10 && j > 1 && j < 10 && k > 1 && k < 10;
        putc(!inside ? 0 : i < 6 ? 1 : 2, file);
      }
  return fclose(file) == 0;
}

static hl_status write_slide(hl_context *context, const char *folder, hl_error *error) {
  char path[256];
  hl_image *image = NULL;
  snprintf(path, sizeof path, "%s/slide.png", folder);
  hl_status status = hl_image_create(context, 6, 4, &image, error);
  for (int i = 0; status == HL_OK && i < 6 * 4; i++)
    for (int c = 0; c < 4; c++) hl_image_pixels(image)[4 * i + c] = c == 3 || (i + c) % 3 == 0 ? 1 : 0.25f;
  if (status == HL_OK) status = hl_image_write(context, image, path, NULL, error);
  hl_image_destroy(image);
  return status;
}

hl_status small_files_write(hl_context *context, const char *folder, hl_error *error) {
  return write_labels(folder) ? write_slide(context, folder, error) : HL_ERROR_INPUT;
}

size_t small_scene_floats(const hl_scene *scene) {
  const hl_scene_description *d = hl_scene_describe(scene);
  return 4 * (size_t)d->width * (size_t)d->height;
}
