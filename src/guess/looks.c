/* guess/looks.c - defines the table of looks, chooses a look by a volume's analysis, and defines presets of
 * transfer functions.
 *
 * Scans that may be of a body are coloured like skin, all other scans like ivory. */
#include "guess/looks.h"

#include <math.h>
#include <string.h>

#include "core/door.h"
#include "core/error.h"
#include "guess/function_writer.h"
#include "guess/styles.h"
#include "scene/function/transfer_function.h"
#include "scene/scene.h"
#include "text/edit_distance.h"
#include "text/plain.h"

typedef enum subject {
  BODY,
  BRAIN,
  MATTER,
  LABELS,
  FIELD,
  FLOW,
  SIGNED,
  MEDIUM,
  CONSTANT,
  PARTICLES
} subject;

/* The columns: name, writer, shading, kernel, light, left, on_black, next, glossy, style. */
static const hl_look looks[] = {
    [BODY] = {"scanned body", hl_write_body, HL_SHADING_PHONG, HL_KERNEL_BSPLINE, HL_LIGHT_OF_SURFACES, 0.75,
              false, "translucent", false, NULL},
    [BRAIN] = {"scanned brain", hl_write_brain, HL_SHADING_PHONG, HL_KERNEL_BSPLINE, HL_LIGHT_OF_SURFACES,
               0.7, false, "translucent", false, NULL},
    [MATTER] = {"scanned matter", hl_write_matter, HL_SHADING_PHONG, HL_KERNEL_BSPLINE, HL_LIGHT_OF_SURFACES,
                0.76, false, "translucent", false, NULL},
    [LABELS] = {"labels",
                hl_write_labels,
                HL_SHADING_PHONG,
                HL_KERNEL_LINEAR,
                {0.90, 0.12, 0.44, false},
                0,
                false,
                "surface",
                false,
                NULL},
    [FIELD] = {"field", hl_write_field, HL_SHADING_PHONG, HL_KERNEL_BSPLINE, HL_LIGHT_OF_SHELLS, 0.65, false,
               "surface", true, NULL},
    [FLOW] = {"flow", hl_write_flow, HL_SHADING_PHONG, HL_KERNEL_BSPLINE, HL_LIGHT_OF_SHELLS, 0.9, false,
              "translucent", false, NULL},
    [SIGNED] = {"signed field", hl_write_signed, HL_SHADING_PHONG, HL_KERNEL_BSPLINE, HL_LIGHT_OF_SHELLS, 0.8,
                false, "translucent", true, NULL},
    [MEDIUM] = {"smoke or cloud", hl_write_medium, HL_SHADING_NONE, HL_KERNEL_BSPLINE, HL_LIGHT_OF_MEDIA, 0,
                false, "surface", false, "smoke"},
    [CONSTANT] = {"one value",
                  hl_write_constant,
                  HL_SHADING_PHONG,
                  HL_KERNEL_BSPLINE,
                  {1.20, 0.10, 0.44, false},
                  0,
                  false,
                  "surface",
                  false,
                  NULL},
    [PARTICLES] = {"particles",
                   hl_write_particles,
                   HL_SHADING_NONE,
                   HL_KERNEL_BSPLINE,
                   {1.15, 0.35, 0.45, false},
                   0.85,
                   true,
                   "xray",
                   false,
                   NULL},
};

static bool ends_with(const char *text, const char *end) {
  size_t length = text != NULL ? strlen(text) : 0, tail = strlen(end);
  return length >= tail && hl_plain_equal(text + length - tail, end);
}

/* Returns true if the file's format (NIfTI) tells the left and right of a patient. */
static bool is_anatomical(const char *file) { return ends_with(file, ".nii") || ends_with(file, ".nii.gz"); }

/* Returns true if more than two fifths of the voxels denser than air are tissue: from -200 to 200 Hounsfield
 * units. Few voxels of metal, stone and wood have values of tissue. */
static bool is_mostly_tissue(const hl_volume *volume) {
  double width = (volume->maximum - volume->minimum) / HL_HISTOGRAM_BINS, tissue = 0, matter = 0;
  for (int bin = 0; bin < HL_HISTOGRAM_BINS; bin++) {
    double hounsfield = volume->minimum + (bin + 0.5) * width;
    if (hounsfield > -400) matter += (double)volume->histogram[bin];
    if (fabs(hounsfield) < 200) tissue += (double)volume->histogram[bin];
  }
  return tissue > 0.4 * matter;
}

/* Returns true for the scan of a body. A body fills the grid; trees, vessels and machine parts leave most of
 * it empty. */
bool hl_is_body(const hl_volume *volume, const char *file, const hl_data_analysis *a) {
  if (a->kind != HL_DATA_SURFACES || a->direction < 0 || a->vessels > 0) return false;
  if (hl_is_hounsfield(volume)) return is_mostly_tissue(volume);
  return (volume->is_anatomical || is_anatomical(file)) && a->filled > 0.15;
}

const hl_look *hl_look_for(const hl_volume *volume, const char *file, const hl_data_analysis *analysis) {
  subject is = MATTER;
  switch (analysis->kind) {
    case HL_DATA_SURFACES:
      if (analysis->vessels > 0) return hl_style_find("vessels");
      if (hl_is_body(volume, file, analysis))
        is = analysis->cliffs >= HL_CUT_OUT && !hl_data_is_cut_off(analysis) ? BRAIN : BODY;
      break;
    case HL_DATA_FIELD: is = FIELD; break;
    case HL_DATA_SIGNED: is = SIGNED; break;
    case HL_DATA_MEDIUM: is = MEDIUM; break;
    case HL_DATA_CONSTANT: is = CONSTANT; break;
    case HL_DATA_LABELS: is = LABELS; break;
    case HL_DATA_FLOW: is = FLOW; break;
    case HL_DATA_PARTICLES: is = PARTICLES; break;
  }
  return &looks[is];
}

const hl_look *hl_look_automatic(const hl_volume *volume, const char *file,
                                 const hl_data_analysis *analysis) {
  return hl_data_is_label_map(volume, analysis) ? &looks[LABELS] : hl_look_for(volume, file, analysis);
}

void hl_look_material(const hl_look *look, hl_scene_volume *volume) {
  volume->shading = look->shading;
  volume->material = (hl_material){.ambient = 1,
                                   .diffuse = 0.85,
                                   .specular = look->glossy ? 0.35 : 0.15,
                                   .shininess = look->glossy ? 40 : 24};
}

/* Makes the function's colour white, so that the voxels of a volume with voxel colours keep their colours. A
 * voxel's alpha becomes its opacity, unless a style gives the opacities. */
static void keep_colors(hl_function_writer *w, const hl_volume *volume, const hl_look *style) {
  static const double white[3] = {1, 1, 1};
  const double background = w->analysis->background;
  w->color_count = 0;
  if (volume->component == HL_COMPONENT_COLOR && style == NULL) {
    w->opacity_count = 0;
    w->direction = 1;
    hl_add_opacity(w, volume->value_offset - background, 0);
    hl_add_opacity(w, volume->value_offset + 255 * volume->value_scale - background, 0.99);
  }
  hl_add_color(w, 0, white);
}

/* The window of values in which a file shows the channel that the volume was read from (omero, ImageJ). Null
 * if the file tells no window. */
static const double *channel_window(const hl_volume *volume) {
  const double *window = volume->channels != NULL ? volume->channels[volume->selection.channel].window : NULL;
  return window != NULL && window[0] < window[1] ? window : NULL;
}

/* Narrows the visible values of a function to the window of a channel. Values that the file shows black
 * become transparent, and values that it shows at full brightness become opaque. An end of the window beyond
 * the visible values changes nothing, because many files state the whole range of their voxel type. */
static hl_status narrow(hl_context *context, const hl_volume *volume, hl_transfer_function *function,
                        hl_error *error) {
  const double *window = channel_window(volume);
  double visible[2], range[2];
  hl_transfer_function narrowed = {0};
  if (window == NULL || function->plane.second != HL_SECOND_NONE) return HL_OK;
  hl_status status = hl_transfer_function_visible_range(volume, function, visible, error);
  if (status != HL_OK) return status;
  range[0] = fmax(window[0], visible[0]);
  range[1] = fmin(window[1], visible[1]);
  if (!(range[0] < range[1]) || memcmp(range, visible, sizeof range) == 0) return HL_OK;
  status = hl_transfer_function_spread(context, function, visible, range, HL_RANGE_LINEAR, &narrowed, error);
  if (status != HL_OK) return status;
  hl_transfer_function_release(context, function);
  *function = narrowed;
  return HL_OK;
}

hl_status hl_look_write(const hl_look *look, const hl_look *style, hl_context *context,
                        const hl_volume *volume, const hl_data_analysis *analysis,
                        hl_transfer_function *function, hl_error *error) {
  hl_function_writer w;
  hl_begin_function(&w, volume, analysis);
  if (style != NULL) hl_style_write(style, look, &w);
  else look->write(&w);
  if (volume->colors != NULL) keep_colors(&w, volume, style);
  hl_status status = hl_finish_function(&w, context, volume, function, error);
  if (status != HL_OK || w.direction < 0) return status;
  status = narrow(context, volume, function, error);
  if (status != HL_OK) hl_transfer_function_release(context, function);
  return status;
}

hl_status hl_transfer_function_automatic(hl_context *context, const hl_volume *volume,
                                         hl_transfer_function *function, hl_error *error) {
  HL_DOOR;
  if (context == NULL || volume == NULL || function == NULL)
    return hl_fail(error, HL_ERROR_ARGUMENT,
                   "hl_transfer_function_automatic: null context, volume or function");
  hl_data_analysis analysis;
  hl_status status = hl_data_analyse(volume, &analysis, error);
  if (status != HL_OK) return status;
  return hl_look_write(hl_look_for(volume, NULL, &analysis), NULL, context, volume, &analysis, function,
                       error);
}

static hl_status find_look(const hl_volume *volume, const char *file, const hl_look **look, hl_error *error) {
  hl_data_analysis analysis;
  hl_status status = hl_data_analyse(volume, &analysis, error);
  if (status != HL_OK) return status;
  *look = hl_look_automatic(volume, file, &analysis);
  return HL_OK;
}

hl_status hl_volume_guess(const hl_volume *volume, const char *file, const char **kind, hl_error *error) {
  HL_DOOR;
  if (volume == NULL || kind == NULL)
    return hl_fail(error, HL_ERROR_ARGUMENT, "hl_volume_guess: null volume or kind");
  const hl_look *look = NULL;
  hl_status status = find_look(volume, file, &look, error);
  *kind = status == HL_OK ? look->name : NULL;
  return status;
}

hl_status hl_volume_next_look(const hl_volume *volume, const char *file, const char **name, hl_error *error) {
  HL_DOOR;
  if (volume == NULL || name == NULL)
    return hl_fail(error, HL_ERROR_ARGUMENT, "hl_volume_next_look: null volume or name");
  const hl_look *look = NULL;
  hl_status status = find_look(volume, file, &look, error);
  *name = status == HL_OK ? look->next : NULL;
  return status;
}

/* ---- looks by name ---- */

const char *hl_look_name(size_t index) {
  if (index == 0) return "auto";
  const hl_look *style = hl_style(index - 1);
  return style != NULL ? style->name : NULL;
}

hl_status hl_transfer_function_look(hl_context *context, const char *look, const hl_volume *volume,
                                    hl_transfer_function *function, hl_shading *shading, hl_error *error) {
  HL_DOOR;
  if (context == NULL || look == NULL || volume == NULL || function == NULL || shading == NULL)
    return hl_fail(error, HL_ERROR_ARGUMENT,
                   "hl_transfer_function_look: null context, look, volume, function or shading");
  const hl_look *style = NULL;
  hl_data_analysis analysis;
  hl_status status = hl_style_named(look, &style, error);
  if (status == HL_OK) status = hl_data_analyse(volume, &analysis, error);
  if (status != HL_OK) return status;
  const hl_look *base = hl_look_for(volume, NULL, &analysis);
  *shading = style != NULL ? style->shading : base->shading;
  return hl_look_write(base, style, context, volume, &analysis, function, error);
}

/* ---- presets: named transfer functions that adapt to the volume.
 *
 * CT presets are written in Hounsfield units. For volumes in other units (8 bit, 0 to 1) a piecewise linear
 * map through four landmarks gives the distances: -1000 (air) is the background, -400 (half way to tissue) is
 * the distance `solid`, 350 (where bone begins) is `dense`, and 2000 (dense bone) is `top`. If much of the
 * objects is dense, no tissue surrounds the bone, and bone begins at about the distance `solid`. The other
 * presets are written in distances from the background, such as `solid`. */

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

/* The distance of a value in Hounsfield units from the background. hounsfield: whether the volume's values
 * are Hounsfield units; if not, the thresholds of the volume's analysis give the distance. */
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
    for (int c = 0; c < 3; c++) color[c] = hl_srgb_decode(rows[r].srgb[c]);
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

/* Writes a brain without its skull: a soft ramp, in which grey matter is darker and pinker than white
 * matter. */
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

/* Writes nested shells: a faint outer shell, a firm inner shell, and a solid core. */
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

/* A value that at most one voxel in a hundred thousand exceeds. A projection uses this value in place of the
 * greatest value, so that a single bright voxel does not darken all others. */
static double almost_greatest(const hl_volume *volume) {
  uint64_t voxels = 0, above = 0;
  for (int bin = 0; bin < HL_HISTOGRAM_BINS; bin++) voxels += volume->histogram[bin];
  int bin = HL_HISTOGRAM_BINS;
  while (bin > 1 && (above += volume->histogram[bin - 1]) <= voxels / 100000) bin--;
  return bin == HL_HISTOGRAM_BINS
             ? volume->maximum
             : volume->minimum + (volume->maximum - volume->minimum) * bin / HL_HISTOGRAM_BINS;
}

/* The fraction of the voxels that lie above a value, by whole bins of the histogram. */
static double share_above(const hl_volume *volume, double value) {
  double width = (volume->maximum - volume->minimum) / HL_HISTOGRAM_BINS, above = 0, voxels = 0;
  for (int bin = 0; bin < HL_HISTOGRAM_BINS; bin++) {
    voxels += (double)volume->histogram[bin];
    if (volume->minimum + bin * width >= value) above += (double)volume->histogram[bin];
  }
  return voxels > 0 ? above / voxels : 0;
}

/* The value that a maximum projection shows in white: almost the greatest value. In Hounsfield units with a
 * little metal, the value is that of dense bone, so that the metal does not darken the bones. */
static double projected_white(const hl_volume *volume) {
  enum { DENSE_BONE = 2000 };
  double white = almost_greatest(volume);
  bool metal = hl_is_hounsfield(volume) && white > DENSE_BONE && share_above(volume, DENSE_BONE) < 0.001;
  return metal ? DENSE_BONE : white;
}

/* Returns whether the window of values that a file asks for ends where a projection can end. Windows of
 * channels are meant for pictures of any kind. Other windows (DICOM) are meant for slices. A pixel of a
 * projection has the greatest of some hundred values. If more than about one value in 200 lies above the
 * window, as bone lies above a window of soft tissue, most of the pixels would be white. */
static bool is_window_for_projections(const hl_volume *volume) {
  return channel_window(volume) != NULL ||
         (isfinite(volume->window[1]) && share_above(volume, volume->window[1]) < 0.005);
}

/* The distance above the background that noise reaches. A pixel of a projection has the greatest of some
 * hundred values, so that noise around the objects would be seen as a grey box. Derived: noise lies on both
 * sides of the background alike, so that noise reaches as far above the background as the least value lies
 * below the background. The distance is at most `faint`, at which objects begin. */
static double noise_above(const hl_volume *volume, const hl_data_analysis *a) {
  return fmin(fmax(a->background - volume->minimum, 0), a->faint);
}

/* Writes the greys of a maximum projection: from the noise of the background, which is not shown, to almost
 * the greatest value. If objects have values below the background, or on both sides of it, the greys begin at
 * the least value. If the file asks for a window of values that suits projections, the greys cover only this
 * window. */
static void write_maximum(hl_function_writer *w, const hl_volume *volume) {
  const hl_data_analysis *a = w->analysis;
  bool above = a->direction > 0 && a->kind != HL_DATA_SIGNED;
  double low = above ? a->background + noise_above(volume, a) : volume->minimum,
         high = projected_white(volume);
  if (is_window_for_projections(volume)) {
    if (volume->window[1] > low && volume->window[1] < volume->maximum) high = volume->window[1];
    if (volume->window[0] > low && volume->window[0] < high) low = volume->window[0];
  }
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
  HL_DOOR;
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
    hl_begin_function(&w, volume, &analysis);
    if (analysis.kind == HL_DATA_CONSTANT) hl_write_constant(&w);
    else presets[p].write(&w, volume);
    return hl_finish_function(&w, context, volume, function, error);
  }
  char mend[300];
  hl_suggest_name(name, names, mend, sizeof mend);
  return hl_fail(error, HL_ERROR_INPUT, "unknown preset \"%.80s\": %s", name, mend);
}
