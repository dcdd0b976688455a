/* tests/robust/patience.c - how much work is done after somebody asked a call to stop; patience.py runs it
 * under callgrind, which counts the instructions.
 *
 * usage: patience SCENE
 *
 * The question of the cancel callback is answered with "go on" until the last one that is counted, then with
 * "stop". Callgrind writes one count for each question in a choice of them: of the instructions from this
 * question to the next, named "between", and at the end of those from the last question to the end of the
 * call and of all that it held, named "end". Somebody who asks to stop just after a question waits for both.
 */
#define _POSIX_C_SOURCE 200809L
#include <halflight/halflight.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <valgrind/callgrind.h>

#define BALL                                                                                             \
  "\"volumes\": [{\"voxel_size\": 0.25, \"shapes\": [{\"type\": \"sphere\", \"radius\": 6}, {\"type\": " \
  "\"box\", \"size\": [3, 3, 3], \"position\": [5, 5, 5]}]}]"
#define SUN \
  "\"lights\": [{\"type\": \"directional\", \"direction\": [0.5, 0.3, -1], \"angular_diameter_deg\": 12}]"
#define SCENE(size, settings)                                                                 \
  "{\"halflight\": 1, \"image\": {\"width\": " size ", \"height\": " size "}, " SUN ", " BALL \
  ", \"render\": {\"threads\": 1, \"sheet_spacing\": 0.02" settings "}}"

typedef struct case_of {
  const char *name, *json;
  bool layers, reference;
} case_of;

static const case_of cases[] = {
    {"cascade", SCENE("900", ""), false, false},
    {"paper", SCENE("900", ", \"soft_method\": \"paper\""), false, false},
    {"sublights", SCENE("600", ", \"soft_method\": \"sublights\", \"light_samples\": 3"), false, false},
    {"layers", SCENE("900", ", \"shadows\": \"hard\""), true, false},
    {"reference", SCENE("1500", ""), false, true},
    {"shape", NULL, false, false}};

/* The clock that the library reads. Each reading is half a millisecond after the one before. The library asks
 * whether to stop after an interval of the clock. By this clock it asks after the same work on every machine,
 * busy or not. */
__attribute__((visibility("default"))) int clock_gettime(clockid_t clock, struct timespec *now) {
  static atomic_long readings;
  long reading = atomic_fetch_add(&readings, 1);
  (void)clock;
  *now = (struct timespec){.tv_sec = reading / 2000, .tv_nsec = reading % 2000 * 500000};
  return 0;
}

/* Questions are counted if their number is a power of two, and the last one is. */
enum { LAST_QUESTION = 1024 };

static bool at_work; /* whether the call that is tested has begun */
static int questions;
static char stage[32]; /* the last fraction that the call reported */

static void on_progress(void *user_data, const char *name, double fraction) {
  (void)user_data, (void)fraction;
  snprintf(stage, sizeof stage, "%s", name);
}

static bool is_counted(int number) { return number > 0 && (number & (number - 1)) == 0; }

static int on_question(void *user_data) {
  (void)user_data;
  if (!at_work) return 0;
  int number = ++questions;
  if (is_counted(number - 1)) CALLGRIND_DUMP_STATS_AT("between");
  if (is_counted(number)) CALLGRIND_ZERO_STATS;
  return number >= LAST_QUESTION;
}

static hl_status run_scene(hl_context *context, const case_of *one, hl_error *error) {
  hl_scene *scene = NULL;
  hl_renderer *renderer = NULL;
  hl_image *image = NULL;
  hl_status status = hl_scene_from_json(context, one->json, strlen(one->json), NULL, one->name, &scene,
                                        error);
  if (status == HL_OK) {
    const hl_scene_description *d = hl_scene_describe(scene);
    status = hl_image_create(context, d->width, d->height, &image, error);
    size_t stride = 4 * (size_t)d->width;
    hl_layers layers = {.struct_size = sizeof layers};
    at_work = true;
    layers.ambient = one->layers && status == HL_OK ? calloc(stride * (size_t)d->height, sizeof(float))
                                                    : NULL;
    if (status == HL_OK && one->reference) {
      hl_reference_options options;
      hl_reference_options_defaults(&options);
      options.threads = 1;
      status = hl_reference_render(context, scene, &options, hl_image_pixels(image), stride, error);
    } else if (status == HL_OK) {
      status = hl_renderer_create(context, &renderer, error);
      if (status == HL_OK)
        status = hl_renderer_render_layers(renderer, scene, hl_image_pixels(image), stride,
                                           one->layers ? &layers : NULL, NULL, error);
    }
    free(layers.ambient);
  }
  hl_renderer_destroy(renderer);
  hl_image_destroy(image);
  hl_scene_release(scene);
  return status;
}

static hl_status run_shape(hl_context *context, hl_error *error) {
  hl_volume *volume = NULL;
  const char *text = hl_shape_preset_text("fire-ball");
  hl_shapes_options options;
  hl_shapes_options_defaults(&options);
  options.size = 700;
  options.threads = 1;
  at_work = true;
  hl_status status = hl_volume_from_shapes(context, text, strlen(text), "fire-ball", &options, &volume,
                                           error);
  hl_volume_release(volume);
  return status;
}

int main(int count, char **arguments) {
  hl_context_options options;
  hl_context *context = NULL;
  hl_error error = {0};
  const case_of *one = NULL;
  for (size_t n = 0; n < sizeof cases / sizeof *cases; n++)
    if (count == 2 && strcmp(arguments[1], cases[n].name) == 0) one = &cases[n];
  if (one == NULL) {
    for (size_t n = 0; n < sizeof cases / sizeof *cases; n++) puts(cases[n].name);
    return count == 1 ? 0 : 2;
  }
  hl_context_options_defaults(&options);
  options.cancelled = on_question;
  options.progress = on_progress;
  if (hl_context_create(&options, &context, &error) != HL_OK) return 2;
  hl_status status = one->json != NULL ? run_scene(context, one, &error) : run_shape(context, &error);
  hl_context_destroy(context);
  CALLGRIND_DUMP_STATS_AT("end");
  /* whether the call has come beyond its preparation */
  bool far = strcmp(stage, one->json != NULL ? "render" : "load") == 0;
  if (status == HL_ERROR_CANCELLED && questions == LAST_QUESTION && far) return 0;
  fprintf(stderr, "%s: status %d after %d questions, in stage \"%s\": %s\n", one->name, (int)status,
          questions, stage, error.message);
  return 1;
}
