/* tests/fuzz/labels.c - fuzz target: label maps, and the tables that name their labels. The input is a
 * .seg.nrrd file or, cut at the line "%%%%", that and a table; the first byte chooses the table's ending. */
#include <math.h>
#include <string.h>

#include "target.h"

const uint64_t fuzz_memory_limit = 4 << 20;

/* The place in the input where the table begins; null: there is no table. */
static const uint8_t *find_table(const uint8_t *data, size_t size) {
  static const char mark[] = "%%%%\n";
  for (size_t at = 0; at + sizeof mark - 1 <= size; at++)
    if (memcmp(data + at, mark, sizeof mark - 1) == 0) return data + at + sizeof mark - 1;
  return NULL;
}

static void check_labels(const hl_label *labels, size_t count) {
  for (size_t n = 0; n < count; n++) {
    REQUIRE(labels[n].value != 0);
    REQUIRE(n == 0 || labels[n].value > labels[n - 1].value);
    for (int c = 0; c < 3; c++) REQUIRE(labels[n].color[c] >= 0 && labels[n].color[c] <= 1);
    REQUIRE(labels[n].name == NULL || memchr(labels[n].name, 0, 4096) != NULL);
  }
}

/* Draws the labels as surfaces, a few pixels wide. */
static void draw(hl_volume *map, const hl_label *labels, size_t count) {
  static float pixels[4 * 4 * 4];
  hl_scene_description description;
  hl_scene_volume volume;
  hl_scene *scene = NULL;
  hl_renderer *renderer = NULL;
  hl_error error = {0};
  hl_scene_description_defaults(&description);
  hl_scene_volume_defaults(&volume);
  volume.volume = map;
  volume.labels = labels;
  volume.label_count = count;
  description.volumes = &volume;
  description.volume_count = 1;
  description.width = description.height = 4;
  description.render.threads = 1;
  description.render.shadow_resolution = 8;
  if (hl_camera_frame(&description, 30, 20, 1, &description.camera) != HL_OK) return;
  hl_status status = hl_scene_create(fuzz_context(), &description, &scene, &error);
  if (!fuzz_check_answer(status, &error, scene != NULL)) return;
  status = hl_renderer_create(fuzz_context(), &renderer, &error);
  if (fuzz_check_answer(status, &error, renderer != NULL)) {
    status = hl_renderer_render(renderer, scene, pixels, 16, NULL, &error);
    if (fuzz_check_answer(status, &error, status == HL_OK))
      for (size_t n = 0; n < sizeof pixels / sizeof *pixels; n++) REQUIRE(isfinite(pixels[n]));
  }
  hl_renderer_destroy(renderer);
  hl_scene_release(scene);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  static const char *const tables[] = {"t.csv", "t.txt", "t.ctbl", "t.label"};
  if (size == 0) return 0;
  const char *name = tables[data[0] % 4], *table = NULL;
  const uint8_t *second = find_table(data + 1, size - 1);
  size_t length = second != NULL ? (size_t)(second - data) - 6 : size - 1;
  const char *path = fuzz_write_file(0, "m.seg.nrrd", data + 1, length);
  if (second != NULL) table = fuzz_write_file(1, name, second, size - (size_t)(second - data));
  hl_volume *map = NULL;
  hl_label *labels = NULL;
  size_t count = 0;
  hl_error error = {0};
  hl_status status = hl_volume_load(fuzz_context(), path, &map, &error);
  if (fuzz_check_answer(status, &error, map != NULL)) {
    hl_volume_info info = {.struct_size = sizeof info};
    status = hl_labels_of_volume(fuzz_context(), map, table, &labels, &count, &error);
    if (fuzz_check_answer(status, &error, status == HL_OK)) check_labels(labels, count);
    REQUIRE(hl_volume_get_info(map, &info) == HL_OK);
    size_t voxels = info.dimensions[0] * info.dimensions[1] * info.dimensions[2];
    if (status == HL_OK && count > 0 && count < 9 && voxels < 1000) draw(map, labels, count);
    hl_labels_release(fuzz_context(), labels);
  }
  hl_volume_release(map);
  fuzz_remove_file(0);
  fuzz_remove_file(1);
  fuzz_check_nothing_held();
  return 0;
}
