/* scene/looks.c - from what is measured of a volume to what it is taken for, and the table of looks.
 *
 * In: a volume's analysis (analysis.c, labels.c). Out: a row of the table: transfer function, shading and
 * lights. The colour of skin is for what can be a body; all other scanned things are ivory.
 */
#define _GNU_SOURCE /* strcasecmp */
#include "scene/looks.h"

#include <math.h>
#include <string.h>
#include <strings.h>

typedef enum subject { BODY, BRAIN, MATTER, LABELS, FIELD, FLOW, SIGNED, MEDIUM, CONSTANT } subject;

/* Lights are so strong that the brightest hundredth of the picture is about 235 of 255 in sRGB, and shadows
 * stay readable. */
static const hl_look looks[] = {
    [BODY] = {"scanned body", hl_write_body, HL_SHADING_PHONG, HL_KERNEL_BSPLINE, 1.80, 0.40, 0.18, 0.75},
    [BRAIN] = {"scanned brain", hl_write_brain, HL_SHADING_PHONG, HL_KERNEL_BSPLINE, 1.80, 0.40, 0.18, 0.7},
    [MATTER] = {"scanned matter", hl_write_matter, HL_SHADING_PHONG, HL_KERNEL_BSPLINE, 1.65, 0.35, 0.15,
                0.7},
    [LABELS] = {"labels", hl_write_labels, HL_SHADING_PHONG, HL_KERNEL_LINEAR, 0.90, 0.30, 0.22, 0},
    [FIELD] = {"field", hl_write_field, HL_SHADING_PHONG, HL_KERNEL_BSPLINE, 1.70, 0.45, 0.35, 0.65},
    [FLOW] = {"flow", hl_write_flow, HL_SHADING_PHONG, HL_KERNEL_BSPLINE, 1.50, 0.45, 0.40, 0.9},
    [SIGNED] = {"signed field", hl_write_signed, HL_SHADING_PHONG, HL_KERNEL_BSPLINE, 1.30, 0.35, 0.25, 0.8},
    [MEDIUM] = {"smoke or cloud", hl_write_medium, HL_SHADING_NONE, HL_KERNEL_BSPLINE, 1.20, 0, 0.20, 0},
    [CONSTANT] = {"one value", hl_write_constant, HL_SHADING_PHONG, HL_KERNEL_BSPLINE, 1.50, 0.35, 0.20, 0},
};

bool hl_is_hounsfield(const hl_volume *volume) {
  return volume->minimum <= -500 && volume->minimum >= -10000 && volume->maximum >= 300;
}

static bool ends_with(const char *text, const char *end) {
  size_t length = text != NULL ? strlen(text) : 0, tail = strlen(end);
  return length >= tail && strcasecmp(text + length - tail, end) == 0;
}

/* The file tells where a patient's left and right are. */
static bool is_anatomical(const char *file) { return ends_with(file, ".nii") || ends_with(file, ".nii.gz"); }

/* What is denser than air is mostly tissue: -200 to 200 Hounsfield units, where metal, stone and wood have
 * hardly anything. */
static bool is_mostly_tissue(const hl_volume *volume) {
  double width = (volume->maximum - volume->minimum) / HL_HISTOGRAM_BINS, tissue = 0, matter = 0;
  for (int bin = 0; bin < HL_HISTOGRAM_BINS; bin++) {
    double hounsfield = volume->minimum + (bin + 0.5) * width;
    if (hounsfield > -400) matter += (double)volume->histogram[bin];
    if (fabs(hounsfield) < 200) tissue += (double)volume->histogram[bin];
  }
  return tissue > 0.4 * matter;
}

/* A body fills its picture: trees, vessels and machine parts leave most of it empty. */
static bool is_body(const hl_volume *volume, const char *file, const hl_data_analysis *a) {
  if (a->kind != HL_DATA_SURFACES || a->direction < 0) return false;
  if (hl_is_hounsfield(volume)) return is_mostly_tissue(volume);
  return is_anatomical(file) && a->filled > 0.15;
}

const hl_look *hl_look_for(const hl_volume *volume, const char *file, const hl_data_analysis *analysis) {
  subject is = MATTER;
  switch (analysis->kind) {
    case HL_DATA_SURFACES:
      if (is_body(volume, file, analysis))
        is = analysis->zeroed > 0.4 ? BRAIN : BODY; /* cut out by a program */
      break;
    case HL_DATA_FIELD: is = FIELD; break;
    case HL_DATA_SIGNED: is = SIGNED; break;
    case HL_DATA_MEDIUM: is = MEDIUM; break;
    case HL_DATA_CONSTANT: is = CONSTANT; break;
    case HL_DATA_LABELS: is = LABELS; break;
    case HL_DATA_FLOW: is = FLOW; break;
  }
  return &looks[is];
}

hl_status hl_look_write(const hl_look *look, hl_context *context, const hl_volume *volume,
                        const hl_data_analysis *analysis, hl_transfer_function *function, hl_error *error) {
  hl_function_writer w;
  hl_begin_function(&w, analysis);
  look->write(&w);
  return hl_finish_function(&w, context, volume, function, error);
}

hl_status hl_transfer_function_automatic(hl_context *context, const hl_volume *volume,
                                         hl_transfer_function *function, hl_error *error) {
  if (context == NULL || volume == NULL || function == NULL)
    return hl_fail(error, HL_ERROR_ARGUMENT,
                   "hl_transfer_function_automatic: null context, volume or function");
  hl_data_analysis analysis;
  hl_status status = hl_data_analyse(volume, &analysis, error);
  if (status != HL_OK) return status;
  return hl_look_write(hl_look_for(volume, NULL, &analysis), context, volume, &analysis, function, error);
}

hl_status hl_volume_guess(const hl_volume *volume, const char *file, const char **kind, hl_error *error) {
  if (volume == NULL || kind == NULL)
    return hl_fail(error, HL_ERROR_ARGUMENT, "hl_volume_guess: null volume or kind");
  hl_data_analysis analysis;
  hl_status status = hl_data_analyse(volume, &analysis, error);
  *kind = status == HL_OK ? hl_look_for(volume, file, &analysis)->name : NULL;
  return status;
}
