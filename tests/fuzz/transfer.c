/* tests/fuzz/transfer.c - fuzz target: transfer-function files: Halflight's own, ParaView's and Slicer's,
 * each with and without a volume that it is for. */
#include <stdio.h>
#include <string.h>

#include "target.h"

const uint64_t fuzz_memory_limit = 16 << 20;

static void check_function(const hl_transfer_function *function) {
  REQUIRE(function->unit_distance > 0);
  REQUIRE(function->opacity != NULL || function->opacity_count == 0);
  REQUIRE(function->color != NULL || function->color_count == 0);
  for (size_t n = 0; n < function->opacity_count; n++) {
    REQUIRE(function->opacity[n].opacity >= 0 && function->opacity[n].opacity <= 1);
    REQUIRE(n == 0 || function->opacity[n].value >= function->opacity[n - 1].value);
  }
  for (size_t n = 0; n < function->gradient_opacity_count; n++)
    REQUIRE(function->gradient_opacity[n].opacity >= 0 && function->gradient_opacity[n].opacity <= 1);
  for (size_t n = 0; n < function->plane.box_count; n++)
    REQUIRE(function->plane.boxes[n].opacity >= 0 && function->plane.boxes[n].opacity <= 1);
  for (size_t n = 0; n < function->color_count; n++)
    for (int c = 0; c < 3; c++) REQUIRE(function->color[n].color[c] >= 0 && function->color[n].color[c] <= 1);
}

/* Finds the name that shows an input's format. `path` also tells what is asked for: "B", if there are several
 * presets. */
static void write_input(const uint8_t *data, size_t size, char path[512]) {
  static const struct {
    const char *mark, *name, *preset;
  } kinds[] = {{"{", "f.json", ""},      {"[", "f.json", ""}, {"<ParaView", "f.pvsm", ""},
               {"<MRML", "f.xml", ":B"}, {"<", "f.xml", ""},  {"", "f.vp", ""}};
  size_t first = 0, kind = 0;
  while (first < size && strchr(" \n\r\t", data[first]) != NULL) first++;
  for (;; kind++) {
    size_t length = strlen(kinds[kind].mark);
    if (size - first >= length && memcmp(data + first, kinds[kind].mark, length) == 0) break;
  }
  snprintf(path, 512, "%s%s", fuzz_write_file(0, kinds[kind].name, data, size), kinds[kind].preset);
}

static void check_load(const char *path, const hl_volume *volume) {
  hl_transfer_function function = {0};
  hl_error error = {0};
  hl_status status = hl_transfer_function_load_for(fuzz_context(), path, volume, &function, &error);
  bool made = function.opacity != NULL || function.color != NULL || function.plane.box_count > 0;
  if (!fuzz_check_answer(status, &error, made || status == HL_OK)) return;
  check_function(&function);
  hl_transfer_function_release(fuzz_context(), &function);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  static const float voxels[8] = {0, 40, -3, 7};
  char path[512];
  hl_volume_description description;
  hl_volume *volume = NULL;
  hl_volume_description_defaults(&description);
  for (int a = 0; a < 3; a++) description.dimensions[a] = 2;
  description.type = HL_VOXEL_F32;
  description.voxels = voxels;
  REQUIRE(hl_volume_create(fuzz_context(), &description, &volume, NULL) == HL_OK);
  write_input(data, size, path);
  check_load(path, NULL);
  check_load(path, volume);
  hl_volume_release(volume);
  fuzz_check_nothing_held();
  return 0;
}
