/* tests/fuzz/keys.c - fuzz target: the keys of films, "PATH=FRAME:VALUE,...", one a line, and the scenes of
 * the frames. */
#include <math.h>
#include <string.h>

#include "film/film.h"
#include "target.h"

const uint64_t fuzz_memory_limit = 16 << 20;

enum { MOST_KEYS = 4, MOST_TEXT = 2048 };

static const char scene_text[] =
    "{\"halflight\": 1, \"image\": {\"width\": 4, \"height\": 4}, \"camera\": {\"position\": [0, -9, 0], "
    "\"target\": "
    "[0, 0, 0], \"up\": [0, 0, 1]}, \"lights\": [{\"type\": \"directional\", \"intensity\": 1}], "
    "\"volumes\": "
    "[{\"voxel_size\": 1, \"shapes\": [{\"type\": \"sphere\", \"radius\": 2}], \"transfer_function\": "
    "{\"opacity\": "
    "[[0, 0], [1, 0.5]]}}], \"render\": {\"threads\": 1}}";

/* Cuts a text into lines; returns how many there are. */
static size_t lines_of(char *text, const char *lines[MOST_KEYS]) {
  size_t count = 0;
  for (char *at = text; at != NULL && count < MOST_KEYS; count++) {
    lines[count] = at;
    at = strchr(at, '\n');
    if (at != NULL) *at++ = 0;
  }
  return count;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  char text[MOST_TEXT + 1];
  const char *keys[MOST_KEYS];
  hl_scene *scene = NULL;
  film *made = NULL;
  hl_error error = {0};
  if (size < 2 || size > MOST_TEXT) return 0;
  memcpy(text, data + 2, size - 2);
  text[size - 2] = 0;
  film_options options = {.context = fuzz_context(),
                          .keys = keys,
                          .frames_per_second = 24,
                          .turntable = data[0] % 4,
                          .frames = data[1]};
  options.key_count = lines_of(text, keys);
  hl_status status = hl_scene_from_json(fuzz_context(), scene_text, sizeof scene_text - 1, NULL, "scene",
                                        &scene, &error);
  REQUIRE(status == HL_OK);
  options.scene = scene;
  status = film_create(&options, &made, &error);
  REQUIRE((status == HL_OK) == (made != NULL));
  REQUIRE(status == HL_OK || error.message[0] != 0);
  for (int f = 0; made != NULL && f < 3; f++) {
    hl_scene *frame = NULL;
    int number = f == 0 ? 0 : f == 1 ? film_frames(made) / 2 : film_frames(made) - 1;
    status = film_scene(made, number, &frame, &error);
    REQUIRE((status == HL_OK) == (frame != NULL));
    hl_scene_release(frame);
  }
  film_destroy(made);
  hl_scene_release(scene);
  fuzz_check_nothing_held();
  return 0;
}
