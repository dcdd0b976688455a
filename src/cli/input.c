/* cli/input.c - what subcommands take as INPUT. */
#include "input.h"

#include <ctype.h>
#include <stdio.h>
#include <string.h>

#include "output.h"

const char *input_base_name(const char *path) {
  const char *slash = strrchr(path, '/');
  return slash != NULL ? slash + 1 : path;
}

bool input_is_scene(const char *path) {
  static const char *const volume_extensions[] = {".raw", ".gz",  ".nrrd", ".nhdr", ".mha",
                                                  ".mhd", ".nii", ".vti",  ".vtk"};
  if (has_extension(path, ".json")) return true;
  for (size_t i = 0; i < sizeof volume_extensions / sizeof volume_extensions[0]; i++)
    if (has_extension(path, volume_extensions[i])) return false;
  FILE *file = fopen(path, "rb");
  if (file == NULL) return false;
  int c;
  do c = getc(file);
  while (c != EOF && isspace(c));
  fclose(file);
  return c == '{';
}

static hl_status load_volume_scene(hl_context *context, const char *path, hl_scene **scene, hl_error *error) {
  hl_volume *volume = NULL;
  hl_status status = hl_volume_load(context, path, &volume, error);
  if (status == HL_OK) status = hl_scene_for_volume(context, volume, path, scene, error);
  hl_volume_release(volume);
  return status;
}

hl_status input_load(hl_context *context, const char *path, bool bare, hl_scene **scene, hl_error *error) {
  return bare ? load_volume_scene(context, path, scene, error) : hl_scene_load(context, path, scene, error);
}
