/* cli/render/meshes.c - adds meshes among the operands of `halflight render` to the scene that the other
 * operands make. Each mesh gets a colour of its own. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/input.h"
#include "render.h"
#include "start/joined.h"

void render_part_meshes(hl_context *context, char **operands, char **meshes, char **others) {
  size_t count = 0, left = 0;
  for (size_t n = 0; operands[n] != NULL; n++) {
    if (is_mesh_file(context, operands[n])) meshes[count++] = operands[n];
    else others[left++] = operands[n];
  }
  meshes[count] = others[left] = NULL;
}

/* Loads the meshes; *count becomes the number of loaded meshes; the caller releases each of them. */
static hl_status load_meshes(hl_context *context, char *const *paths, size_t first, hl_scene_mesh *added,
                             size_t *count, hl_error *error) {
  hl_status status = HL_OK;
  for (*count = 0; paths[*count] != NULL && status == HL_OK; ++*count)
    status = load_mesh(context, paths[*count], first + *count, &added[*count], error);
  return status;
}

int render_add_meshes(cli_host *host, char *const *paths, size_t first, bool bare, hl_scene **scene) {
  hl_scene_mesh added[MAXIMUM_OPERANDS];
  size_t count = 0;
  hl_error error = {0};
  if (paths[0] == NULL) return EXIT_CODE_OK;
  hl_status status = load_meshes(host->context, paths, first, added, &count, &error);
  if (status == HL_OK) status = join_meshes(host->context, added, count, bare, scene, &error);
  for (size_t m = 0; m < count; m++) hl_mesh_release(added[m].mesh);
  return status == HL_OK ? EXIT_CODE_OK : host_fail(host, PHASE_READ, status, &error);
}
