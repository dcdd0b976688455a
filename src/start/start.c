/* start/start.c - writes the text that a page loads first: the scene, its volumes, and lists of presets and
 * colormaps. */
#define _GNU_SOURCE
#include "start.h"

#include <halflight/compose.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "plane_histogram.h"
#include "text/json_value.h"
#include "text/units.h"

void put_json_text(FILE *out, const char *text) {
  char piece[HL_JSON_PIECE_BYTES];
  fputc('"', out);
  for (size_t length; (length = hl_json_piece(&text, piece)) > 0;) fwrite(piece, 1, length, out);
  fputc('"', out);
}

static void put_numbers(FILE *out, const double *numbers, size_t count) {
  fputc('[', out);
  for (size_t n = 0; n < count; n++) {
    char text[HL_JSON_NUMBER_BYTES];
    hl_json_number_text(numbers[n], text);
    fprintf(out, "%s%s", n > 0 ? "," : "", text);
  }
  fputc(']', out);
}

/* Writes the grid of voxels. `axes` are the steps from a voxel to its neighbours, in the world, from which
 * the page finds the box of the voxels. unit: the factor that converts the grid's lengths to the volume's
 * unit. */
static void put_grid(FILE *out, const hl_volume_info *info, double unit) {
  const double origin[3] = {unit * info->origin[0], unit * info->origin[1], unit * info->origin[2]};
  fprintf(out, "\"dimensions\":[%zu,%zu,%zu],\"origin\":", info->dimensions[0], info->dimensions[1],
          info->dimensions[2]);
  put_numbers(out, origin, 3);
  fputs(",\"axes\":[", out);
  for (int axis = 0; axis < 3; axis++) {
    double step[3];
    for (int row = 0; row < 3; row++) step[row] = info->direction[row][axis] * info->spacing[axis] * unit;
    if (axis > 0) fputc(',', out);
    put_numbers(out, step, 3);
  }
  fputc(']', out);
}

/* Writes the grid of the label map that masks a volume, or null if the volume has no mask. */
static void put_mask(FILE *out, const hl_scene_volume *volume) {
  const hl_volume *mask = volume->mask.volume;
  hl_volume_info info = {.struct_size = sizeof info};
  if (mask == NULL || hl_volume_get_info(mask, &info) != HL_OK) {
    fputs("null", out);
    return;
  }
  fputc('{', out);
  put_grid(out, &info, hl_unit_ratio(hl_volume_unit(mask), hl_volume_unit(volume->volume)));
  fputc('}', out);
}

static void put_histogram(FILE *out, const hl_volume_info *info) {
  fputs("\"range\":", out);
  put_numbers(out, info->range, 2);
  fputs(",\"histogram\":[", out);
  for (int bin = 0; bin < HL_HISTOGRAM_BINS; bin++)
    fprintf(out, "%s%llu", bin > 0 ? "," : "", (unsigned long long)info->histogram[bin]);
  fputc(']', out);
}

/* Writes the type, the range and the histogram of the values before smoothing, which slices show. Writes null
 * if the volume was not smoothed. */
static void put_unsmoothed(FILE *out, const hl_volume *volume) {
  hl_volume_info info = {.struct_size = sizeof info};
  fputs(",\"unsmoothed\":", out);
  if (hl_volume_get_info(hl_volume_unsmoothed(volume), &info) != HL_OK) {
    fputs("null", out);
    return;
  }
  fprintf(out, "{\"type\":\"%s\",", hl_voxel_type_name(info.type));
  put_histogram(out, &info);
  fputc('}', out);
}

/* Writes two numbers about the chunks of the volume and of its mask: the number of chunks that the server
 * lacks, and the number of all chunks. */
static void put_absence(FILE *out, const hl_scene_volume *volume) {
  size_t chunks = 0, of_mask = 0;
  size_t absent = hl_volume_absent_chunks(volume->volume, &chunks);
  absent += hl_volume_absent_chunks(volume->mask.volume, &of_mask);
  fprintf(out, ",\"absent_chunks\":[%zu,%zu]", absent, chunks + of_mask);
}

/* Writes the DICOM series of the input from which the volume was read; [] if it has no series. `choice` is
 * the text by which a series is chosen. */
static void put_series(FILE *out, const hl_volume *volume) {
  hl_volume_series series = {.struct_size = sizeof series};
  fputs(",\"series\":[", out);
  for (size_t n = 0; hl_volume_get_series(volume, n, &series) == HL_OK; n++) {
    fprintf(out, "%s{\"choice\":", n > 0 ? "," : "");
    put_json_text(out, series.uid[0] != '\0' ? series.uid : series.description);
    fputs(",\"modality\":", out);
    put_json_text(out, series.modality);
    fputs(",\"description\":", out);
    put_json_text(out, series.description);
    fprintf(out, ",\"dimensions\":[%zu,%zu,%zu],\"chosen\":%s}", series.dimensions[0], series.dimensions[1],
            series.dimensions[2], series.chosen ? "true" : "false");
  }
  fputc(']', out);
}

/* Returns whether the volume's cuts are the automatic cuts, which remove the table or another holder. */
static bool has_chosen_cuts(hl_context *context, const hl_scene_volume *volume) {
  hl_scene *chosen = NULL;
  if (volume->cut_count == 0 ||
      hl_scene_for_volume(context, volume->volume, volume->file, &chosen, NULL) != HL_OK)
    return false;
  const hl_scene_volume *other = &hl_scene_describe(chosen)->volumes[0];
  bool same = other->cut_count == volume->cut_count;
  for (size_t c = 0; same && c < volume->cut_count; c++) {
    const hl_cut *a = &volume->cuts[c], *b = &other->cuts[c];
    same = a->type == b->type && memcmp(a->point, b->point, sizeof a->point) == 0 &&
           memcmp(a->normal, b->normal, sizeof a->normal) == 0;
  }
  hl_scene_release(chosen);
  return same;
}

/* Writes the kind of data in the volume, and the choices that were made for it. */
static void put_chosen(FILE *out, hl_context *context, const hl_scene_volume *volume) {
  const char *kind = NULL;
  if (hl_volume_guess(volume->volume, volume->file, &kind, NULL) != HL_OK) kind = "";
  fprintf(out, ",\"kind\":\"%s\",\"chosen_cuts\":%s", kind,
          has_chosen_cuts(context, volume) ? "true" : "false");
}

/* Writes whether pictures at rest show the volume at the resolution that the view deserves. */
static void put_resolution(FILE *out, const hl_volume *volume) {
  hl_volume_selection read = {.struct_size = sizeof read};
  const bool follows = hl_volume_get_selection(volume, &read) == HL_OK && read.levels > 1 &&
                       !read.level_is_named;
  fprintf(out, ",\"level_follows_view\":%s", follows ? "true" : "false");
}

/* Writes a unit of lengths; null stands for an unknown one. */
static void put_unit(FILE *out, const char *unit) {
  fputs(",\"unit\":", out);
  if (unit != NULL) put_json_text(out, unit);
  else fputs("null", out);
}

static void put_volume(FILE *out, hl_context *context, const hl_scene_volume *volume) {
  hl_volume_info info = {.struct_size = sizeof info};
  if (hl_volume_get_info(volume->volume, &info) != HL_OK) {
    fputs("null", out);
    return;
  }
  fprintf(out, "{\"type\":\"%s\",", hl_voxel_type_name(info.type));
  put_grid(out, &info, 1);
  fputs(",\"mask\":", out);
  put_mask(out, volume);
  fputc(',', out);
  put_histogram(out, &info);
  put_unsmoothed(out, volume->volume);
  put_absence(out, volume);
  put_resolution(out, volume->volume);
  put_series(out, volume->volume);
  const char *space = hl_space_name(info.space);
  fputs(",\"space\":", out);
  if (space != NULL) put_json_text(out, space);
  else fputs("null", out);
  put_unit(out, hl_volume_unit(volume->volume));
  fputs(",\"plane\":", out);
  put_plane_histogram(out, volume->volume, &info);
  put_chosen(out, context, volume);
  fputs("}", out);
}

/* Writes the names of the choices of one of the options by which scenes are composed. Writes an empty list if
 * the option does not exist. */
static void put_choices(FILE *out, const char *name, const char *option) {
  const hl_setting_choice *choices = hl_option_choices(option);
  fprintf(out, ",\"%s\":[", name);
  for (size_t c = 0; choices != NULL && choices[c].name != NULL; c++) {
    if (c > 0) fputc(',', out);
    put_json_text(out, choices[c].name);
  }
  fputc(']', out);
}

/* Writes each colormap as rows of value, r, g, b over values from 0 to 1. */
static void put_colormaps(FILE *out, hl_context *context) {
  fputs("\"colormaps\":{", out);
  for (size_t c = 0; hl_colormap_name(c) != NULL; c++) {
    hl_transfer_function function = {0};
    if (c > 0) fputc(',', out);
    put_json_text(out, hl_colormap_name(c));
    fputs(":[", out);
    if (hl_transfer_function_colormap(context, hl_colormap_name(c), 0, 1, &function, NULL) == HL_OK)
      for (size_t p = 0; p < function.color_count; p++) {
        const hl_color_point *point = &function.color[p];
        if (p > 0) fputc(',', out);
        put_numbers(out, (double[4]){point->value, point->color[0], point->color[1], point->color[2]}, 4);
      }
    hl_transfer_function_release(context, &function);
    fputc(']', out);
  }
  fputc('}', out);
}

char *describe_start(hl_context *context, const hl_scene *opened, const start_about *about) {
  char *scene = NULL, *text = NULL;
  size_t length = 0;
  if (hl_scene_to_json(context, opened, &scene, NULL) != HL_OK) return NULL;
  FILE *out = open_memstream(&text, &length);
  if (out != NULL) {
    const hl_scene_description *d = hl_scene_describe(opened);
    fprintf(out, "{\"version\":\"%s\",\"title\":", hl_version());
    put_json_text(out, about->title);
    fprintf(out, ",\"opened\":%lld,\"folder\":%s,\"refined\":%d,\"refining\":%s", about->number,
            about->folder ? "true" : "false", about->refined, about->refining ? "true" : "false");
    put_unit(out, about->unit);
    fprintf(out, ",\"scene\":%s,\"volumes\":[", scene);
    for (size_t v = 0; v < d->volume_count; v++) {
      if (v > 0) fputc(',', out);
      put_volume(out, context, &d->volumes[v]);
    }
    fputs("],\"presets\":[", out);
    for (size_t p = 0; hl_preset_name(p) != NULL; p++) {
      if (p > 0) fputc(',', out);
      put_json_text(out, hl_preset_name(p));
    }
    fputs("],", out);
    put_colormaps(out, context);
    put_choices(out, "looks", "look");
    put_choices(out, "rigs", "light-rig");
    fputs("}", out);
    bool failed = ferror(out) != 0;
    if (fclose(out) != 0 || failed) {
      free(text);
      text = NULL;
    }
  }
  hl_text_release(context, scene);
  return text;
}
