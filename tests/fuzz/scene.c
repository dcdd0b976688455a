/* tests/fuzz/scene.c - fuzz target: scene files, read, written and read again.
 *
 * Scenes reach three files: v.nrrd, t.png and f.json, beside which they stand.
 */
#define _GNU_SOURCE
#include <stdlib.h>
#include <string.h>

#include "target.h"

const uint64_t fuzz_memory_limit = 600 << 10;
enum { MOST_BYTES = 1 << 16 };

static void write_companions(void) {
  static const char volume[] =
      "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 3 3 3\nencoding: ascii\n\n"
      "0 9 0 9 40 9 0 9 0 9 40 9 40 255 40 9 40 9 0 9 0 9 40 9 0 9 0\n";
  static const char function[] =
      "{\"opacity\": [[0, 0], [200, 1]], \"color\": [[0, 1, 0, 0], [200, 0, 1, 1]]}";
  static bool written;
  if (written) return;
  written = true;
  fuzz_write_file(0, "v.nrrd", (const uint8_t *)volume, sizeof volume - 1);
  fuzz_write_file(1, "f.json", (const uint8_t *)function, sizeof function - 1);
  const char *path = fuzz_write_file(2, "t.png", NULL, 0);
  hl_image *image = NULL;
  REQUIRE(hl_image_create(fuzz_context(), 3, 2, &image, NULL) == HL_OK);
  for (int n = 0; n < 24; n++) hl_image_pixels(image)[n] = n % 4 == 3 ? 1.0f : (float)n / 24;
  REQUIRE(hl_image_write(fuzz_context(), image, path, NULL, NULL) == HL_OK);
  hl_image_destroy(image);
}

/* a pool of hundreds of threads takes long to make, and scenes do not need it */
static bool asks_for_many_threads(const char *text) {
  for (const char *at = strstr(text, "threads"); at != NULL; at = strstr(at + 1, "threads")) {
    const char *digits = at + strcspn(at, "0123456789");
    if (strspn(digits, "0123456789.eE+") > 1) return true;
  }
  return false;
}

/* The scene that was read and written is read back, and must be the same. */
static void check_round_trip(const hl_scene *scene) {
  char *first = NULL, *second = NULL;
  hl_error error = {0};
  hl_status status = hl_scene_to_json(fuzz_context(), scene, &first, &error);
  if (!fuzz_check_answer(status, &error, first != NULL)) return;
  hl_scene *again = NULL;
  status = hl_scene_from_json(fuzz_confined(), first, strlen(first), NULL, "again", &again, &error);
  REQUIRE(status == HL_OK || status == HL_ERROR_MEMORY);
  if (status == HL_OK && hl_scene_to_json(fuzz_context(), again, &second, &error) == HL_OK)
    REQUIRE(strcmp(first, second) == 0);
  hl_text_release(fuzz_context(), second);
  hl_scene_release(again);
  hl_text_release(fuzz_context(), first);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  static char text[MOST_BYTES + 1];
  if (size > MOST_BYTES) return 0;
  write_companions();
  memcpy(text, data, size);
  text[size] = 0;
  if (asks_for_many_threads(text)) return 0;
  hl_scene *scene = NULL;
  hl_error error = {0};
  hl_status status = hl_scene_from_json(fuzz_confined(), text, size, NULL, "scene", &scene, &error);
  if (fuzz_check_answer(status, &error, scene != NULL)) check_round_trip(scene);
  hl_scene_release(scene);
  fuzz_check_nothing_held();
  return 0;
}
