/* guess/analysis.h - finds the kind of data in a volume, and the values that divide objects from their
 * background. */
#ifndef HL_GUESS_ANALYSIS_H
#define HL_GUESS_ANALYSIS_H

#include <halflight/scene.h>
#include "core/error.h"
#include "guess/sample.h"
#include "volume/volume.h"

typedef enum hl_data_kind {
  HL_DATA_SURFACES = 0, /* objects with boundaries: CT, MR, masks */
  HL_DATA_FIELD = 1,    /* a smooth quantity that falls off: densities of simulations */
  HL_DATA_SIGNED = 2,   /* a quantity whose values lie on both sides of a background in the middle: wave
                         * functions */
  HL_DATA_MEDIUM = 3,   /* smoke and clouds */
  HL_DATA_CONSTANT = 4, /* one value everywhere */
  HL_DATA_LABELS = 5,   /* few whole numbers, in blocks: the values are names of regions, not amounts */
  HL_DATA_FLOW = 6,     /* a smooth quantity that fills its grid: turbulence, speed, temperature */
  HL_DATA_PARTICLES = 7 /* the logarithm of the density of particles, over decades */
} hl_data_kind;

/* The greatest number of labels of a map that is recognised by its values alone. */
#define HL_FEW_LABELS     255
#define HL_MOST_MATERIALS 4

/* "Objects" are the voxels that differ from the background. "Distances" are differences of values from the
 * background, positive towards the objects. */
typedef struct hl_data_analysis {
  hl_data_kind kind;
  double background;
  double direction;   /* +1: objects have values above the background; -1: below */
  double faint;       /* distance at which objects may begin */
  double solid;       /* distance beyond which voxels surely belong to objects */
  double dense;       /* distance that divides the objects into two materials */
  double dense_share; /* fraction of the voxels beyond solid that lie beyond dense */
  double light_mean;  /* the mean distance of the voxels between solid and dense; equal to dense if no voxels
                       * lie between */
  double dense_mean;  /* the mean distance of the voxels beyond dense; equal to dense if no voxels lie
                       * beyond */
  double top;         /* distance that almost no voxel exceeds */
  double mean;        /* mean distance of the voxels beyond faint */
  double vessels;     /* distance beyond which matter is vessels within other matter; 0 if the volume shows no
                       * vessels */
  double depth;       /* voxel edges across the objects: cube root of their number of voxels */
  double common;      /* fraction of the voxels whose value lies within two fifths of lower and upper around
                       * the middle */
  double zeroed;      /* fraction of the voxels that have exactly the background's value */
  double cliffs;      /* fraction of the steps between the background's exact value and other values that are
                       * cliffs: at least half as high as matter */
  double cut_off;   /* fraction of the grid's border that lies beyond solid: matter that the grid cuts off */
  double sharpness; /* the sharpness of the surface of scanned objects: the fraction of a step over three
                     * voxel edges that lies in the middle edge, as a mean over all steps */
  double grain;     /* the standard deviation, in voxel edges, by which noise moves the surface of scanned
                     * objects */
  double filled;    /* fraction of the voxels beyond solid */
  double middle;    /* the commonest data value */
  double lower, upper; /* the greatest distances of values below and above the middle, apart from a few
                        * voxels */
  double labels[HL_FEW_LABELS]; /* ascending data values, without the background of labels */
  size_t label_count;
  bool is_mask; /* one value lies in blocks beside the background: the volume is also a map of one label */
  double valleys[HL_MOST_MATERIALS - 1]; /* distances that divide materials, rising; [material_count - 1] */
  int material_count; /* number of materials of scanned objects; 0 if the analysis did not look for
                       * materials */
} hl_data_analysis;

/* Analyses a volume's voxels. The first call analyses them, and the volume keeps the result for later calls.
 * Fails for lack of memory, and when cancelled. */
hl_status hl_data_analyse(const hl_volume *volume, hl_data_analysis *analysis, hl_error *error);

/* Gives a volume the analysis of another volume, which shows the same objects. */
hl_status hl_data_keep(const hl_volume *volume, const hl_data_analysis *analysis, hl_error *error);

/* Finds the materials of scanned objects: sets valleys and material_count. */
void hl_data_find_materials(const hl_volume *volume, hl_data_analysis *analysis);

/* Finds whether the brightest matter of scanned objects is vessels: tubes within other matter. Returns the
 * distance from the background beyond which matter is vessels; 0 if the brightest matter is not vessels. All
 * distances are relative, as the sample's values are. distances: [sample->count]; the distances of the
 * sample, ascending. */
double hl_data_find_vessels(const hl_volume *volume, const hl_sample *sample, const float *distances,
                            const hl_data_analysis *analysis);

/* Lowers the thresholds faint and solid of scanned objects to the rim of the objects' outer matter, if the
 * thresholds lie within the values of that matter. The thresholds lie too high if skin is much darker than
 * the matter under it. Returns whether the thresholds were lowered. All distances are relative. noise: a
 * distance that the noise around the objects hardly reaches. */
bool hl_data_find_rim(const hl_volume *volume, const hl_sample *sample, double noise,
                      hl_data_analysis *analysis);

/* Finds the properties of the surface of scanned objects: sets cliffs, sharpness and grain. The distances of
 * the analysis are relative, as the sample's values are. Fails only for lack of memory. */
hl_status hl_data_find_boundary(const hl_volume *volume, const hl_sample *sample, hl_data_analysis *analysis,
                                hl_error *error);

/* The least value of `cliffs` in objects that were cut out voxel by voxel, as a brain without its skull is.
 * Measured: in four objects that were cut out, `cliffs` is .21 to .96; in eleven objects with natural rims,
 * `cliffs` is at most .07. */
#define HL_CUT_OUT 0.15

/* Returns true if the grid cuts objects off, as it cuts a head off at the neck. A brain without its skull is
 * not cut off. */
static inline bool hl_data_is_cut_off(const hl_data_analysis *analysis) { return analysis->cut_off >= 0.02; }

/* Derived: Otsu's threshold divides the values of one material with noise into halves, whose means differ
 * by 1.6 standard deviations. So one material with noise of up to a sixth of its distance has at most this
 * ratio between the halves' means. Scans of two materials have greater ratios: 1.5 to 3.2 in eleven scans
 * (measured). */
#define HL_ONE_MATERIAL 1.25

/* Returns whether scanned objects are one material for the most part. */
static inline bool hl_data_is_one_material(const hl_data_analysis *analysis) {
  return analysis->dense_share > 0.5 || analysis->dense_mean < HL_ONE_MATERIAL * analysis->light_mean;
}

/* Returns true if the values can be Hounsfield units: they reach from air to matter denser than water. */
static inline bool hl_is_hounsfield(const hl_volume *volume) {
  return volume->minimum <= -500 && volume->minimum >= -10000 && volume->maximum >= 300;
}

/* ---- label maps: volumes whose values are names of regions ---- */

/* The value that is no label: 0 if any value is 0 or less. */
static inline double hl_data_no_label(const hl_volume *volume, const hl_data_analysis *analysis) {
  return volume->minimum <= 0 ? 0 : analysis->background;
}

/* If the volume is a map of several labels, sets the kind to HL_DATA_LABELS and lists labels. If the volume
 * is a mask, sets is_mask. Otherwise changes nothing. The values of a label map are whole numbers: the
 * background and 1 to HL_FEW_LABELS labels. Most labels lie in blocks, so that a voxel's neighbours mostly
 * have its value. If the file says that its values are labels, labels need not lie in blocks, and there may
 * be more labels than the list has room for. Fails for lack of memory. */
hl_status hl_data_find_labels(const hl_volume *volume, hl_data_analysis *analysis, hl_error *error);

/* Returns whether a volume's values are names, which have no mean, because its file names segments or because
 * the values look like labels. */
static inline bool hl_data_is_named(const hl_volume *volume, const hl_data_analysis *analysis) {
  return volume->segment_count > 0 || analysis->kind == HL_DATA_LABELS;
}

/* Returns whether a volume is drawn by its labels if nothing else is asked for. A mask is drawn by its label,
 * although its two values have a mean, which is the fraction of its object. */
static inline bool hl_data_is_label_map(const hl_volume *volume, const hl_data_analysis *analysis) {
  return hl_data_is_named(volume, analysis) || analysis->is_mask;
}

#endif
