/* cli/render/report.c - prints the statistics of a finished rendering. */
#define _GNU_SOURCE
#include <stdio.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

#include "cli/json_writer.h"
#include "render.h"

static const char *shadows_name(hl_shadows shadows) {
  return shadows == HL_SHADOWS_OFF ? "off" : shadows == HL_SHADOWS_HARD ? "hard" : "soft";
}

static const char *soft_method_name(hl_soft_method method) {
  const hl_setting_choice *choice = hl_setting_find(HL_SETTINGS_RENDER, "soft_method")->choices;
  while (choice->name != NULL && choice->value != (int)method) choice++;
  return choice->name == NULL ? "unknown" : choice->name;
}

/* The greatest amount of memory that this program has had resident. On Linux, /proc has this number;
 * elsewhere ru_maxrss has it (KiB), which may include the memory of the program that started this one. */
static uint64_t peak_memory_bytes(void) {
  unsigned long long kibibytes = 0;
  FILE *status = fopen("/proc/self/status", "r");
  if (status != NULL) {
    char line[256];
    while (kibibytes == 0 && fgets(line, sizeof line, status) != NULL)
      (void)sscanf(line, "VmHWM: %llu kB", &kibibytes);
    fclose(status);
    if (kibibytes > 0) return 1024 * (uint64_t)kibibytes;
  }
  struct rusage usage;
  return getrusage(RUSAGE_SELF, &usage) == 0 ? 1024 * (uint64_t)usage.ru_maxrss : 0;
}

static void print_seconds(json_writer *json, const render_result *result) {
  const hl_render_statistics *statistics = &result->statistics;
  json_open_object(json, "seconds");
  json_number(json, "load", result->seconds.load);
  json_number(json, "prepare", result->seconds.prepare);
  json_number(json, "render", result->seconds.render);
  json_number(json, "write", result->seconds.write);
  json_number(json, "total", result->seconds.total);
  json_close(json);
  json_open_object(json, "render_seconds"); /* the stages of "render" above */
  json_number(json, "sort", statistics->seconds_sort);
  json_number(json, "fill_image", statistics->seconds_fill_image);
  json_number(json, "fill_light", statistics->seconds_fill_light);
  json_number(json, "shade", statistics->seconds_shade);
  json_number(json, "soften", statistics->seconds_soften);
  json_close(json);
}

static void print_tiles(json_writer *json, const char *key, uint64_t filled, uint64_t skipped) {
  json_open_object(json, key);
  json_whole_number(json, "filled", filled);
  json_whole_number(json, "skipped", skipped);
  json_close(json);
}

static void print_work(json_writer *json, const hl_render_statistics *statistics) {
  json_whole_number(json, "sheets", (uint64_t)statistics->sheets);
  json_whole_number(json, "sweeps", (uint64_t)statistics->sweeps);
  json_open_object(json, "voxels");
  json_whole_number(json, "total", statistics->voxels_total);
  json_whole_number(json, "kept", statistics->voxels_kept);
  json_whole_number(json, "culled", statistics->voxels_total - statistics->voxels_kept);
  json_close(json);
  json_whole_number(json, "samples_shaded", statistics->samples_shaded);
  json_open_object(json, "tiles");
  print_tiles(json, "image", statistics->tiles_filled_image, statistics->tiles_skipped_image);
  print_tiles(json, "light", statistics->tiles_filled_light, statistics->tiles_skipped_light);
  json_close(json);
}

static bool is_maximum(const hl_scene_description *description) {
  return description->render.compositing == HL_COMPOSITING_MAXIMUM;
}

/* Prints the number of voxels that this process has received from other ranks that share its volumes. */
static void print_traffic(json_writer *json, const hl_ranks *ranks) {
  uint64_t bytes, requests;
  double seconds;
  if (ranks == NULL) return;
  hl_ranks_traffic(ranks, &bytes, &requests, &seconds);
  json_open_object(json, "over_ranks");
  json_whole_number(json, "ranks", (uint64_t)hl_ranks_size(ranks));
  json_whole_number(json, "requests", requests);
  json_whole_number(json, "bytes", bytes);
  json_number(json, "seconds", seconds);
  json_close(json);
}

int render_print_json(const render_result *result) {
  const hl_scene_description *description = result->description;
  const hl_render_statistics *statistics = &result->statistics;
  json_writer json = {0};
  json_open_object(&json, NULL);
  json_text(&json, "version", hl_version());
  json_text(&json, "input", result->input);
  json_text(&json, "output", result->output);
  if (result->taken_for != NULL) json_text(&json, "taken_for", result->taken_for);
  if (result->next_look != NULL) json_text(&json, "next_look", result->next_look);
  json_whole_number(&json, "width", (uint64_t)description->width);
  json_whole_number(&json, "height", (uint64_t)description->height);
  json_text(&json, "method", result->reference ? "reference" : "sheets");
  json_text(&json, "shadows", shadows_name(description->render.shadows));
  json_text(&json, "compositing", is_maximum(description) ? "maximum" : "light");
  json_text(&json, "soft_method", soft_method_name(description->render.soft_method));
  if (result->field_errors != NULL) json_written(&json, "field_errors", result->field_errors);
  print_seconds(&json, result);
  print_work(&json, statistics);
  json_whole_number(&json, "peak_memory_bytes", peak_memory_bytes());
  print_traffic(&json, result->ranks);
  json_whole_number(&json, "threads", (uint64_t)statistics->threads);
  json_text(&json, "instruction_set", hl_instruction_set_name(statistics->instruction_set));
  json_text(&json, "device", statistics->device);
  if (statistics->device_reason[0] != '\0') json_text(&json, "device_reason", statistics->device_reason);
  json_close(&json);
  return finish_stdout();
}

void render_print_summary(const render_result *result) {
  const hl_scene_description *description = result->description;
  const render_seconds *seconds = &result->seconds;
  bool soft = description->render.shadows == HL_SHADOWS_SOFT && !result->reference;
  char light[80] = "maximum projection", sheets[40] = "ray-marched";
  if (!is_maximum(description))
    snprintf(light, sizeof light, "%s shadows%s%s%s", shadows_name(description->render.shadows),
             soft ? " (" : "", soft ? soft_method_name(description->render.soft_method) : "",
             soft ? ")" : "");
  if (!result->reference) snprintf(sheets, sizeof sheets, "%d sheets", result->statistics.sheets);
  say("%s: %dx%d, %s, %s, %.3g s (load %.3g, prepare %.3g, render %.3g, write %.3g)", result->output,
      description->width, description->height, light, sheets, seconds->total, seconds->load, seconds->prepare,
      seconds->render, seconds->write);
  if (result->taken_for == NULL || !isatty(STDERR_FILENO)) return;
  if (description->volumes[0].label_count > 0)
    say("%s: taken for labels, which are drawn in their colours: --show NAME,... draws some of them, and "
        "--look surface draws what the file shows as one body",
        result->input);
  else if (result->next_look != NULL)
    say("%s: taken for %s; the look was chosen from this file alone: --look %s is the next best, 'halflight "
        "looks' shows all, and --print-scene writes the choice down, for --tf",
        result->input, result->taken_for, result->next_look);
  else
    say("%s: taken for %s; the transfer function was chosen from this file alone: --print-scene writes it "
        "down, for --tf",
        result->input, result->taken_for);
}
