/* analytic/compare.c - the renderer against the reference on small scenes made in code.
 *
 *     compare [--size N] [--spacing S] [--only TEXT] [--soft] [--points N] [--write FOLDER]
 *
 * Prints one line per scene and shadow setting: the root mean square, greatest and mean signed differences
 * of renderer - reference over R, G, B, A, and the pixel of the greatest one. Without options the program is
 * a test: it ends with status 1 if a picture differs from the reference by more than the scene's bar. --only
 * picks scenes by part of their name, --soft adds the soft methods where they have no bars, --write keeps the
 * pictures as FOLDER/NAME-SHADOWS-renderer.npy and -reference.npy.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "compare_scenes.h"

typedef struct choices {
  int size;         /* pixels a side */
  double spacing;   /* the distance of the sheets, in voxels */
  const char *only; /* only scenes whose names contain this text are rendered; null: all scenes */
  int soft;
  int light_points;   /* the number of points of each light in the reference's pictures of soft shadows */
  const char *folder; /* the folder for the pictures; null: pictures are not kept */
} choices;

typedef struct shadow_setting {
  const char *name;
  hl_shadows shadows;
  hl_soft_method method;
} shadow_setting;

enum { FIRST_SOFT = 2, SETTINGS_COUNT = 5 };

static const shadow_setting SETTINGS[SETTINGS_COUNT] = {
    {"off", HL_SHADOWS_OFF, HL_SOFT_CASCADE},          {"hard", HL_SHADOWS_HARD, HL_SOFT_CASCADE},
    {"cascade", HL_SHADOWS_SOFT, HL_SOFT_CASCADE},     {"paper", HL_SHADOWS_SOFT, HL_SOFT_PAPER},
    {"sublights", HL_SHADOWS_SOFT, HL_SOFT_SUBLIGHTS},
};

static void render_sheets(stage *set, float *pixels) {
  hl_error error = {0};
  hl_scene *scene = NULL;
  hl_renderer *renderer = NULL;
  if (hl_scene_create(set->context, &set->scene, &scene, &error) != HL_OK ||
      hl_renderer_create(set->context, &renderer, &error) != HL_OK ||
      hl_renderer_render(renderer, scene, pixels, 4 * (size_t)set->scene.width, NULL, &error) != HL_OK)
    fail_msg("%s", error.message);
  hl_renderer_destroy(renderer);
  hl_scene_release(scene);
}

static void keep(hl_context *context, const choices *chosen, const char *scene, const char *setting,
                 const char *renderer, const hl_image *image) {
  char path[1000];
  hl_error error = {0};
  if (chosen->folder == NULL) return;
  snprintf(path, sizeof path, "%s/%s-%s-%s.npy", chosen->folder, scene, setting, renderer);
  if (hl_image_write(context, image, path, NULL, &error) != HL_OK) fail_msg("%s", error.message);
}

static void print_difference(const char *scene, const char *setting, const hl_image_difference *d,
                             const float *a, const float *b, int width) {
  const float *p = a + 4 * ((size_t)d->maximum_y * (size_t)width + (size_t)d->maximum_x);
  const float *q = b + 4 * ((size_t)d->maximum_y * (size_t)width + (size_t)d->maximum_x);
  printf(
      "%-20s %-9s %.5f  %.4f  %+.5f %+.5f %+.5f %+.5f  (%d,%d) reference %.3f %.3f %.3f %.3f renderer %.3f "
      "%.3f %.3f %.3f\n",
      scene, setting, d->rmse, d->maximum, d->mean_signed[0], d->mean_signed[1], d->mean_signed[2],
      d->mean_signed[3], d->maximum_x, d->maximum_y, (double)p[0], (double)p[1], (double)p[2], (double)p[3],
      (double)q[0], (double)q[1], (double)q[2], (double)q[3]);
  fflush(stdout);
}

static hl_image *new_image(const stage *set) {
  hl_image *image = NULL;
  hl_error error = {0};
  if (hl_image_create(set->context, set->scene.width, set->scene.height, &image, &error) != HL_OK)
    fail_msg("%s", error.message);
  return image;
}

/* Returns whether the renderer's picture differs from the reference by no more than the scene's bar. */
static int compare_one(stage *set, const scenario *scene, const shadow_setting *setting,
                       const choices *chosen, const hl_image *reference) {
  hl_image *rendered = new_image(set);
  hl_error error = {0};
  render_sheets(set, hl_image_pixels(rendered));
  hl_image_difference difference = {.struct_size = sizeof difference};
  if (hl_image_compare(reference, rendered, &difference, &error) != HL_OK) fail_msg("%s", error.message);
  print_difference(scene->name, setting->name, &difference, hl_image_pixels_const(reference),
                   hl_image_pixels(rendered), chosen->size);
  keep(set->context, chosen, scene->name, setting->name, "reference", reference);
  keep(set->context, chosen, scene->name, setting->name, "renderer", rendered);
  hl_image_destroy(rendered);
  int soft = setting->shadows == HL_SHADOWS_SOFT;
  double bar = soft ? scene->soft_bars[setting - &SETTINGS[FIRST_SOFT]] : scene->bar;
  int barred = bar > 0 && chosen->spacing <= 0.5 && chosen->size >= 64 &&
               (!soft || chosen->light_points >= 16);
  return !barred || difference.rmse <= bar;
}

/* Compares every setting of one scene. The reference's picture is rendered again only if a setting of shadows
 * changes that picture. Returns the number of pictures that differ by more than their bars. */
static int compare_all(const scenario *scene, const choices *chosen) {
  stage set;
  int failures = 0;
  stage_open(&set);
  scene->make(&set);
  set.scene.width = set.scene.height = chosen->size;
  set.scene.render.sheet_spacing = chosen->spacing;
  set.scene.render.light_samples = 4;
  for (int c = 0; c < 3; c++) set.scene.ambient[c] = 0.15;
  hl_image *reference = new_image(&set);
  hl_reference_options options;
  hl_reference_options_defaults(&options);
  options.light_points = chosen->light_points;
  set.scene.render.shadows = HL_SHADOWS_DEFAULT;
  size_t count = chosen->soft || scene->soft_bars[0] > 0 ? SETTINGS_COUNT : FIRST_SOFT;
  for (size_t s = 0; s < count; s++) {
    int same = set.scene.render.shadows == SETTINGS[s].shadows;
    set.scene.render.shadows = SETTINGS[s].shadows;
    set.scene.render.soft_method = SETTINGS[s].method;
    if (!same) stage_render(&set, &options, hl_image_pixels(reference));
    failures += !compare_one(&set, scene, &SETTINGS[s], chosen, reference);
  }
  hl_image_destroy(reference);
  stage_close(&set);
  return failures;
}

static int read_choices(int argc, char **argv, choices *chosen) {
  *chosen = (choices){.size = 64, .spacing = 0.5, .light_points = 16};
  for (int i = 1; i < argc; i++) {
    const char *value = i + 1 < argc ? argv[i + 1] : NULL;
    if (strcmp(argv[i], "--soft") == 0) {
      chosen->soft = 1;
      continue;
    }
    if (value == NULL) return 0;
    if (strcmp(argv[i], "--size") == 0) chosen->size = atoi(value);
    else if (strcmp(argv[i], "--spacing") == 0) chosen->spacing = atof(value);
    else if (strcmp(argv[i], "--only") == 0) chosen->only = value;
    else if (strcmp(argv[i], "--points") == 0) chosen->light_points = atoi(value);
    else if (strcmp(argv[i], "--write") == 0) chosen->folder = value;
    else return 0;
    i++;
  }
  return 1;
}

int main(int argc, char **argv) {
  choices chosen;
  if (!read_choices(argc, argv, &chosen)) {
    fprintf(stderr,
            "usage: compare [--size N] [--spacing S] [--only TEXT] [--soft] [--points N] [--write FOLDER]\n");
    return 2;
  }
  int failures = 0, compared = 0;
  printf("%-20s %-9s %-7s  %-6s  mean signed R G B A; where the greatest is\n", "scene", "shadows", "rmse",
         "max");
  size_t count;
  const scenario *scenes = compare_scenarios(&count);
  for (size_t i = 0; i < count; i++) {
    if (chosen.only != NULL && strstr(scenes[i].name, chosen.only) == NULL) continue;
    failures += compare_all(&scenes[i], &chosen);
    compared++;
  }
  if (compared == 0) {
    fprintf(stderr, "compare: no scene has \"%s\" in its name\n", chosen.only);
    return 2;
  }
  if (failures > 0) printf("%d pictures are further from the reference than their bars\n", failures);
  return failures > 0;
}
