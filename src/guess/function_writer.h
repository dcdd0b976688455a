/* guess/function_writer.h - writes transfer functions in distances from a volume's background
 * (hl_data_analysis). */
#ifndef HL_GUESS_FUNCTION_WRITER_H
#define HL_GUESS_FUNCTION_WRITER_H

#include "guess/analysis.h"

typedef struct hl_function_writer {
  const hl_data_analysis *analysis;
  bool hounsfield;  /* whether values are Hounsfield units */
  double direction; /* data values at rising distances from the background rise (+1) or fall (-1) */
  hl_opacity_point opacity[4 * HL_FEW_LABELS];
  hl_color_point color[4 * HL_FEW_LABELS];
  size_t opacity_count, color_count;
} hl_function_writer;

/* Begins the function of a volume. The analysis must outlive the writer. */
void hl_begin_function(hl_function_writer *w, const hl_volume *volume, const hl_data_analysis *analysis);

/* hl_add_opacity() and hl_add_color() add a point to the function. Distances must rise from point to point;
 * points for which the arrays have no room are left out. */
void hl_add_opacity(hl_function_writer *w, double distance, double opacity);
void hl_add_color(hl_function_writer *w, double distance, const double color[3]); /* linear RGB */
/* Adds a part of a named colormap, from start to end (0 to 1), over the distances from..to. */
void hl_add_colormap(hl_function_writer *w, const char *name, double from, double to, double start,
                     double end);

/* Returns whether the dense matter of scanned objects is metal: it is far brighter than all other matter. */
bool hl_data_holds_metal(const hl_data_analysis *analysis);

/* The opacity per voxel edge that adds up to an optical depth across the objects. */
double hl_opacity_for(const hl_data_analysis *analysis, double optical_depth);

/* Makes the function. Its opacities are per smallest voxel edge of the volume. *function gets memory of its
 * own. */
hl_status hl_finish_function(hl_function_writer *w, hl_context *context, const hl_volume *volume,
                             hl_transfer_function *function, hl_error *error);

/* Each of these functions writes the transfer function of one look (looks.h). */
void hl_write_matter(hl_function_writer *w);
void hl_write_body(hl_function_writer *w);
void hl_write_brain(hl_function_writer *w);
void hl_write_field(hl_function_writer *w);
void hl_write_flow(hl_function_writer *w);
void hl_write_particles(hl_function_writer *w);
void hl_write_signed(hl_function_writer *w);
void hl_write_medium(hl_function_writer *w);
void hl_write_labels(hl_function_writer *w);
void hl_write_constant(hl_function_writer *w);

#endif
