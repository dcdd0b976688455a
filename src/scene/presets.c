/* scene/presets.c - named transfer functions that adapt to the volume.
 *
 * CT presets are written in Hounsfield units. They hold as they are for volumes in Hounsfield units; for
 * others (8 bit, 0 to 1) a piecewise linear map through four landmarks stands in: air is the background, half
 * way from air to tissue is where things surely are, bone begins where the denser of two materials does, and
 * dense bone is the top. Where much of the things is dense there is no tissue about the bone, which then
 * begins where things do. The other presets are written in the landmarks themselves.
 */
#include <math.h>
#include <string.h>

#include "core/error.h"
#include "scene/colormap.h"
#include "scene/function_writer.h"
#include "scene/looks.h"
#include "scene/nearest.h"
#include "scene/scene.h"

/* A row of a CT preset: Hounsfield units, opacity per voxel edge, sRGB colour. */
typedef struct hounsfield_row {
  double hounsfield, opacity, srgb[3];
} hounsfield_row;

static const hounsfield_row bone[] = {{150, 0, {0.60, 0.33, 0.22}},
                                      {220, 0.10, {0.80, 0.56, 0.40}},
                                      {350, 0.65, {0.92, 0.80, 0.64}},
                                      {700, 0.92, {0.97, 0.92, 0.82}},
                                      {2000, 0.97, {1.00, 0.98, 0.94}}};
static const hounsfield_row skin[] = {{-650, 0, {0.72, 0.45, 0.35}},
                                      {-500, 0.10, {0.82, 0.56, 0.44}},
                                      {-350, 0.60, {0.88, 0.64, 0.52}},
                                      {-150, 0.92, {0.90, 0.68, 0.56}},
                                      {300, 0.95, {0.94, 0.84, 0.74}}};
static const hounsfield_row soft_tissue[] = {
    {-180, 0, {0.90, 0.76, 0.50}},   {-100, 0.006, {0.90, 0.74, 0.48}}, {-10, 0.012, {0.84, 0.48, 0.36}},
    {60, 0.07, {0.78, 0.30, 0.24}},  {150, 0.12, {0.82, 0.36, 0.26}},   {250, 0.35, {0.92, 0.76, 0.60}},
    {500, 0.90, {0.97, 0.92, 0.84}}, {2000, 0.97, {1.00, 0.98, 0.95}}};

/* The distance from the background of a value given in Hounsfield units. */
static double distance_of(const hl_function_writer *w, bool hounsfield, double value) {
  const hl_data_analysis *a = w->analysis;
  if (hounsfield) return value - a->background;
  const double landmark[4] = {-1000, -400, 350, 2000};
  bool bare = a->dense_share > 0.35;
  double tissue = bare ? 0.5 * a->solid : a->solid,
         dense = bare ? 1.2 * a->solid : fmax(a->dense, 1.001 * a->solid);
  const double distance[4] = {0, tissue, dense, fmax(a->top, 1.001 * dense)};
  int n = value < landmark[1] ? 0 : value < landmark[2] ? 1 : 2;
  double t = (value - landmark[n]) / (landmark[n + 1] - landmark[n]);
  return distance[n] + t * (distance[n + 1] - distance[n]);
}

static void write_rows(hl_function_writer *w, const hl_volume *volume, const hounsfield_row *rows,
                       size_t count) {
  bool hounsfield = hl_is_hounsfield(volume);
  if (hounsfield) w->direction = 1;
  for (size_t r = 0; r < count; r++) {
    double distance = distance_of(w, hounsfield, rows[r].hounsfield), color[3];
    for (int c = 0; c < 3; c++) color[c] = hl_srgb_to_linear(rows[r].srgb[c]);
    hl_add_opacity(w, distance, rows[r].opacity);
    hl_add_color(w, distance, color);
  }
}

static void write_bone(hl_function_writer *w, const hl_volume *volume) {
  write_rows(w, volume, bone, sizeof bone / sizeof *bone);
}

static void write_skin(hl_function_writer *w, const hl_volume *volume) {
  write_rows(w, volume, skin, sizeof skin / sizeof *skin);
}

static void write_soft_tissue(hl_function_writer *w, const hl_volume *volume) {
  write_rows(w, volume, soft_tissue, sizeof soft_tissue / sizeof *soft_tissue);
}

/* A bare brain: a soft ramp, grey matter darker and pinker than white. */
static void write_brain(hl_function_writer *w, const hl_volume *volume) {
  (void)volume;
  const hl_data_analysis *a = w->analysis;
  static const double outer[3] = {0.58, 0.31, 0.26}, grey[3] = {0.76, 0.54, 0.47},
                      white[3] = {0.90, 0.82, 0.75};
  double ramp = a->solid - a->faint, dense = fmax(a->dense, 1.001 * a->solid);
  hl_add_opacity(w, a->faint, 0);
  hl_add_opacity(w, a->faint + 0.6 * ramp, 0.05);
  hl_add_opacity(w, a->solid, 0.35);
  hl_add_opacity(w, a->solid + 0.5 * ramp, 0.85);
  hl_add_opacity(w, a->solid + 1.5 * ramp, 0.95);
  hl_add_color(w, a->faint, outer);
  hl_add_color(w, 0.5 * (a->solid + dense), grey);
  hl_add_color(w, dense + 0.3 * fmax(a->top - dense, 0.001 * dense), white);
}

static void write_smoke(hl_function_writer *w, const hl_volume *volume) {
  (void)volume;
  hl_write_medium(w);
}

/* Nested shells: a faint outer one, a firm inner one, a solid core. */
static void write_electron_density(hl_function_writer *w, const hl_volume *volume) {
  (void)volume;
  const hl_data_analysis *a = w->analysis;
  if (a->kind == HL_DATA_SIGNED) {
    hl_write_signed(w);
    return;
  }
  double top = fmax(a->top, 1.001 * a->solid), core = a->solid + 0.4 * (top - a->solid);
  hl_add_opacity(w, 0.6 * a->faint, 0);
  hl_add_opacity(w, a->faint, hl_opacity_for(a, 1.2));
  hl_add_opacity(w, a->faint + 0.3 * (a->solid - a->faint), hl_opacity_for(a, 0.4));
  hl_add_opacity(w, a->solid, hl_opacity_for(a, 4));
  hl_add_opacity(w, core, hl_opacity_for(a, 40));
  hl_add_opacity(w, top, hl_opacity_for(a, 100));
  hl_add_colormap(w, "plasma", 0.6 * a->faint, core, 0.25, 0.95);
}

/* The value that all but one voxel in a hundred thousand stay below: a single bright one does not darken the
 * rest. */
static double almost_greatest(const hl_volume *volume) {
  uint64_t voxels = 0, above = 0;
  for (int bin = 0; bin < HL_HISTOGRAM_BINS; bin++) voxels += volume->histogram[bin];
  int bin = HL_HISTOGRAM_BINS;
  while (bin > 1 && (above += volume->histogram[bin - 1]) <= voxels / 100000) bin--;
  return bin == HL_HISTOGRAM_BINS
             ? volume->maximum
             : volume->minimum + (volume->maximum - volume->minimum) * bin / HL_HISTOGRAM_BINS;
}

/* For maximum projections: greys from what surrounds the things, which is not shown, to the greatest value.
 * Where things lie below what surrounds them, or to both sides of it, from the least value. */
static void write_maximum(hl_function_writer *w, const hl_volume *volume) {
  const hl_data_analysis *a = w->analysis;
  bool above = a->direction > 0 && a->kind != HL_DATA_SIGNED;
  double low = above ? a->background : volume->minimum, high = almost_greatest(volume);
  if (!(high > low)) high = volume->maximum;
  w->direction = 1;
  hl_add_opacity(w, low - a->background, 0);
  hl_add_opacity(w, high - a->background, 1);
  hl_add_colormap(w, "grays", low - a->background, high - a->background, 0, 1);
}

static const struct {
  const char *name;
  void (*write)(hl_function_writer *w, const hl_volume *volume);
} presets[] = {
    {"ct-bone", write_bone},   {"ct-skin", write_skin}, {"ct-soft-tissue", write_soft_tissue},
    {"mr-brain", write_brain}, {"smoke", write_smoke},  {"electron-density", write_electron_density},
    {"mip", write_maximum},
};

#define PRESET_COUNT (sizeof presets / sizeof *presets)

const char *hl_preset_name(size_t index) { return index < PRESET_COUNT ? presets[index].name : NULL; }

hl_status hl_transfer_function_preset(hl_context *context, const char *name, const hl_volume *volume,
                                      hl_transfer_function *function, hl_error *error) {
  if (context == NULL || name == NULL || volume == NULL || function == NULL)
    return hl_fail(error, HL_ERROR_ARGUMENT,
                   "hl_transfer_function_preset: null context, name, volume or function");
  const char *names[PRESET_COUNT + 1] = {NULL};
  for (size_t p = 0; p < PRESET_COUNT; p++) names[p] = presets[p].name;
  for (size_t p = 0; p < PRESET_COUNT; p++) {
    if (strcmp(names[p], name) != 0) continue;
    hl_data_analysis analysis;
    hl_function_writer w;
    hl_status status = hl_data_analyse(volume, &analysis, error);
    if (status != HL_OK) return status;
    hl_begin_function(&w, &analysis);
    if (analysis.kind == HL_DATA_CONSTANT) hl_write_constant(&w);
    else presets[p].write(&w, volume);
    return hl_finish_function(&w, context, volume, function, error);
  }
  char mend[300];
  hl_suggest_name(name, names, mend, sizeof mend);
  return hl_fail(error, HL_ERROR_INPUT, "unknown preset \"%.80s\": %s", name, mend);
}
