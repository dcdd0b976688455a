/* guess/looks.h - how each kind of volume is shown where nobody says it. */
#ifndef HL_GUESS_LOOKS_H
#define HL_GUESS_LOOKS_H

#include "guess/analysis.h"
#include "guess/function_writer.h"

typedef struct hl_look {
  const char *name;                     /* of the kind of data, in words */
  void (*write)(hl_function_writer *w); /* the transfer function */
  hl_shading shading;
  hl_kernel kernel;
  double key, fill,
      ambient; /* intensities: the light with shadows, the one without, the light from everywhere */
  double left; /* for exposure.h; 0: the lights stay as they are */
} hl_look;

/* The look of a volume that was analysed; file as in hl_scene_volume. */
const hl_look *hl_look_for(const hl_volume *volume, const char *file, const hl_data_analysis *analysis);

/* The values can be Hounsfield units: air is there, and more than water. */
bool hl_is_hounsfield(const hl_volume *volume);

/* The transfer function of a look. */
hl_status hl_look_write(const hl_look *look, hl_context *context, const hl_volume *volume,
                        const hl_data_analysis *analysis, hl_transfer_function *function, hl_error *error);

#endif
