/* guess/analysis.h - what kind of data a volume is, and where its things begin. */
#ifndef HL_GUESS_ANALYSIS_H
#define HL_GUESS_ANALYSIS_H

#include <halflight/scene.h>
#include "core/error.h"
#include "guess/analysis.h"
#include "volume/volume.h"

typedef enum hl_data_kind {
  HL_DATA_SURFACES = 0, /* things with boundaries: CT, MR, masks */
  HL_DATA_FIELD = 1,    /* a smooth quantity that falls off: densities of simulations */
  HL_DATA_SIGNED = 2,   /* the same to both sides of a background in the middle: wave functions */
  HL_DATA_MEDIUM = 3,   /* smoke and clouds */
  HL_DATA_CONSTANT = 4, /* one value everywhere */
  HL_DATA_LABELS = 5,   /* few whole numbers, in blocks: names of regions, not amounts */
  HL_DATA_FLOW = 6      /* a smooth quantity that fills its grid: turbulence, speed, temperature */
} hl_data_kind;

#define HL_MOST_LABELS 255 /* that are told apart */

/* Data values, except distances, which are from the background in the direction of the things. */
typedef struct hl_data_analysis {
  hl_data_kind kind;
  double background;
  double direction;    /* +1: things are above the background; -1: below */
  double faint;        /* distance at which things begin */
  double solid;        /* distance at which things surely are */
  double dense;        /* distance that parts the things into two materials */
  double dense_share;  /* part of the sure things that is beyond dense, 0 to 1 */
  double top;          /* distance that almost nothing exceeds */
  double mean;         /* mean distance of things beyond faint */
  double depth;        /* voxel edges across the things: cube root of their number */
  double common;       /* part of the voxels within two fifths of the way from the middle to those, 0 to 1 */
  double zeroed;       /* part of the voxels that have exactly the background's value, 0 to 1 */
  double filled;       /* part of the voxels that surely are things, 0 to 1 */
  double middle;       /* the commonest data value of all */
  double lower, upper; /* distances from the middle down and up that hardly any voxel exceeds */
  double labels[HL_MOST_LABELS]; /* ascending data values, without the background */
  size_t label_count;
} hl_data_analysis;

hl_status hl_data_analyse(const hl_volume *volume, hl_data_analysis *analysis, hl_error *error);

/* ---- are a volume's values names of regions? */

/* Where the volume is a label map, its kind becomes HL_DATA_LABELS and its labels are listed; else nothing
 * changes. A label map has whole numbers, at most HL_MOST_LABELS beside the background and at least two, and
 * most of them lie in blocks: a voxel's neighbours mostly have its own value. Fails for lack of memory. */
hl_status hl_data_find_labels(const hl_volume *volume, hl_data_analysis *analysis, hl_error *error);

#endif
