/* golden/golden.c - renders small scenes and compares them with stored pictures.
 *
 *     golden SOURCE_FOLDER [--update] [--keep FOLDER] [NAME ...]
 *
 * Each SOURCE_FOLDER/NAME.json is rendered over the volumes of volumes.h and compared with NAME.npy, by the
 * limits below; the names given, or all. Every scene must render: one that the renderer refuses is a
 * failure. --update stores what was rendered. --keep writes the picture of each failure, and its difference
 * from the stored one, into FOLDER. Speaks TAP.
 *
 * The limits must tell a wrong picture from a rounded one: each stored picture is also damaged in the ways
 * that a renderer goes wrong, and the damaged ones must be refused.
 */
#define _GNU_SOURCE
#include <halflight/halflight.h>

#include <dirent.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "volumes.h"

/* The limits of differences between linear premultiplied pixels; 1/255 is 0.0039. The limit of the mean finds
 * what no eye sees: that all pixels are a little brighter. */
static const double maximum_limit = 4e-3, rmse_limit = 1e-3, mean_limit = 1e-4;

typedef struct golden {
  const char *source_folder, *keep_folder;
  bool update;
  char volume_folder[64];
  hl_context *context;
  hl_renderer *renderer; /* one renderer for all scenes, since what it keeps between frames must not matter */
  hl_error error;
} golden;

static bool accepts(const hl_image *stored, const hl_image *image, hl_image_difference *d, hl_error *error) {
  *d = (hl_image_difference){.struct_size = sizeof *d};
  if (hl_image_compare(stored, image, d, error) != HL_OK) return false;
  bool within = d->maximum <= maximum_limit && d->rmse <= rmse_limit;
  for (int c = 0; c < 4; c++) within = within && fabs(d->mean_signed[c]) <= mean_limit;
  return within;
}

/* ---- damage ---- */

typedef void (*damage)(const float *from, float *to, int width, int height);

static void brighten(const float *from, float *to, int width, int height) {
  for (int i = 0; i < width * height * 4; i++) to[i] = i % 4 < 3 ? from[i] * 1.02f : from[i];
}

static void swap_red_and_blue(const float *from, float *to, int width, int height) {
  for (int i = 0; i < width * height * 4; i += 4) {
    to[i] = from[i + 2];
    to[i + 1] = from[i + 1];
    to[i + 2] = from[i];
    to[i + 3] = from[i + 3];
  }
}

static void shift_half_a_pixel(const float *from, float *to, int width, int height) {
  for (int i = 0; i < width * height * 4; i++) {
    bool first = i / 4 % width == 0;
    to[i] = first ? from[i] : (from[i - 4] + from[i]) / 2;
  }
}

/* Returns whether the limits refuse the damaged copies of the stored picture. */
static bool refuses_damage(golden *run, const hl_image *stored, const char *name) {
  static const struct {
    const char *what;
    damage apply;
  } ways[] = {{"2 % brighter", brighten},
              {"red and blue swapped", swap_red_and_blue},
              {"half a pixel aside", shift_half_a_pixel}};
  int width = hl_image_width(stored), height = hl_image_height(stored);
  hl_image *damaged = NULL;
  if (hl_image_create(run->context, width, height, &damaged, &run->error) != HL_OK) return false;
  bool refuses = true;
  for (size_t i = 0; i < sizeof ways / sizeof ways[0]; i++) {
    hl_image_difference d;
    ways[i].apply(hl_image_pixels_const(stored), hl_image_pixels(damaged), width, height);
    if (!accepts(stored, damaged, &d, &run->error)) continue;
    printf("# %s: a picture that is %s would pass: give the scene more structure\n", name, ways[i].what);
    refuses = false;
  }
  hl_image_destroy(damaged);
  return refuses;
}

/* ---- one scene ---- */

static char *read_text(const char *path, size_t *length) {
  FILE *file = fopen(path, "rb");
  char *text = malloc(1 << 16);
  *length = file == NULL || text == NULL ? 0 : fread(text, 1, (1 << 16) - 1, file);
  if (file != NULL) fclose(file);
  return text;
}

static bool render(golden *run, const char *name, hl_image **image) {
  char path[1000];
  size_t length = 0;
  hl_scene *scene = NULL;
  snprintf(path, sizeof path, "%s/%s.json", run->source_folder, name);
  char *text = read_text(path, &length);
  bool done = hl_scene_from_json(run->context, text, length, run->volume_folder, path, &scene, &run->error) ==
              HL_OK;
  free(text);
  if (!done) return false;
  const hl_scene_description *description = hl_scene_describe(scene);
  done = hl_image_create(run->context, description->width, description->height, image, &run->error) ==
             HL_OK &&
         hl_renderer_render(run->renderer, scene, hl_image_pixels(*image), 4 * (size_t)description->width,
                            NULL, &run->error) == HL_OK;
  hl_scene_release(scene);
  return done;
}

/* Writes NAME.png and NAME-difference.npy for a person to look at. A failure to write them does not fail the
 * test. */
static void keep(golden *run, const char *name, const hl_image *stored, hl_image *image) {
  if (run->keep_folder == NULL) return;
  char path[1000];
  hl_error ignored;
  snprintf(path, sizeof path, "%s/%s.png", run->keep_folder, name);
  if (hl_image_write(run->context, image, path, NULL, &ignored) == HL_OK) printf("# see %s\n", path);
  size_t count = 4 * (size_t)hl_image_width(image) * (size_t)hl_image_height(image);
  for (size_t i = 0; i < count; i++) hl_image_pixels(image)[i] -= hl_image_pixels_const(stored)[i];
  snprintf(path, sizeof path, "%s/%s-difference.npy", run->keep_folder, name);
  if (hl_image_write(run->context, image, path, NULL, &ignored) == HL_OK) printf("# see %s\n", path);
}

static void print_difference(const hl_image_difference *d) {
  if (d->differing_pixels == 0) return;
  printf(
      "# %d pixels differ: rmse %.3g (limit %g), greatest %.3g at %d,%d (limit %g), mean %.2g %.2g %.2g %.2g"
      " (limit %g)\n",
      (int)d->differing_pixels, d->rmse, rmse_limit, d->maximum, d->maximum_x, d->maximum_y, maximum_limit,
      d->mean_signed[0], d->mean_signed[1], d->mean_signed[2], d->mean_signed[3], mean_limit);
}

static bool compare(golden *run, const char *name, const char *stored_path, hl_image *image) {
  hl_image *stored = NULL;
  hl_image_difference d;
  if (hl_image_read(run->context, stored_path, &stored, &run->error) != HL_OK) return false;
  bool good = accepts(stored, image, &d, &run->error);
  print_difference(&d);
  if (!good && d.differing_pixels > 0) keep(run, name, stored, image);
  good = refuses_damage(run, stored, name) && good;
  hl_image_destroy(stored);
  return good;
}

/* Tests a scene and prints its line of TAP. Returns false on failure. */
static bool run_scene(golden *run, int number, const char *name) {
  char stored_path[1000];
  hl_image *image = NULL;
  run->error = (hl_error){.code = HL_OK};
  snprintf(stored_path, sizeof stored_path, "%s/%s.npy", run->source_folder, name);
  bool good = render(run, name, &image);
  if (good && run->update)
    good = hl_image_write(run->context, image, stored_path, NULL, &run->error) == HL_OK;
  if (good) good = compare(run, name, stored_path, image);
  hl_image_destroy(image);
  if (run->error.code != HL_OK) printf("# %s\n", run->error.message);
  printf("%s %d - %s\n", good ? "ok" : "not ok", number, name);
  return good;
}

/* ---- all scenes ---- */

static int is_scene(const struct dirent *entry) {
  const char *dot = strrchr(entry->d_name, '.');
  return dot != NULL && strcmp(dot, ".json") == 0;
}

static bool is_wanted(const char *name, char **names, int count) {
  for (int i = 0; i < count; i++)
    if (strcmp(name, names[i]) == 0) return true;
  return count == 0;
}

/* Returns the number of failures. */
static int run_scenes(golden *run, char **names, int name_count) {
  struct dirent **entries = NULL;
  int found = scandir(run->source_folder, &entries, is_scene, alphasort), tests = 0, failures = 0;
  for (int i = 0; i < found; i++) {
    entries[i]->d_name[strlen(entries[i]->d_name) - strlen(".json")] = 0;
    if (is_wanted(entries[i]->d_name, names, name_count))
      failures += !run_scene(run, ++tests, entries[i]->d_name);
    free(entries[i]);
  }
  free(entries);
  printf("1..%d\n", tests);
  return tests == 0 ? 1 : failures;
}

static void remove_volumes(const char *folder) {
  struct dirent **entries = NULL;
  int found = scandir(folder, &entries, NULL, NULL);
  for (int i = 0; i < found; i++) {
    char path[400];
    snprintf(path, sizeof path, "%s/%s", folder, entries[i]->d_name);
    if (entries[i]->d_name[0] != '.') unlink(path);
    free(entries[i]);
  }
  free(entries);
  rmdir(folder);
}

int main(int argc, char **argv) {
  golden run = {.source_folder = argc > 1 ? argv[1] : NULL, .volume_folder = "/tmp/halflight-golden-XXXXXX"};
  int first = 2;
  for (; first < argc && argv[first][0] == '-'; first++) {
    if (strcmp(argv[first], "--update") == 0) run.update = true;
    else if (strcmp(argv[first], "--keep") == 0 && first + 1 < argc) run.keep_folder = argv[++first];
    else run.source_folder = NULL;
  }
  if (run.source_folder == NULL) {
    fprintf(stderr, "usage: golden SOURCE_FOLDER [--update] [--keep FOLDER] [NAME ...]\n");
    return 2;
  }
  if (mkdtemp(run.volume_folder) == NULL || !volumes_write(run.volume_folder)) {
    printf("Bail out! cannot write volumes into %s\n", run.volume_folder);
    return 1;
  }
  int failures = 1;
  if (hl_context_create(NULL, &run.context, &run.error) != HL_OK ||
      hl_renderer_create(run.context, &run.renderer, &run.error) != HL_OK)
    printf("Bail out! %s\n", run.error.message);
  else failures = run_scenes(&run, argv + first, argc - first);
  hl_renderer_destroy(run.renderer);
  hl_context_destroy(run.context);
  remove_volumes(run.volume_folder);
  return failures > 0;
}
