/* guess/looks.h - how each kind of volume is shown by default. */
#ifndef HL_GUESS_LOOKS_H
#define HL_GUESS_LOOKS_H

#include "guess/analysis.h"
#include "guess/function_writer.h"

typedef struct hl_look {
  const char *name;                     /* the kind of data, in words */
  void (*write)(hl_function_writer *w); /* the transfer function */
  hl_shading shading;
  hl_kernel kernel;
  double key, fill, ambient; /* intensities: the light with shadows, the one without, the ambient light */
  double left;               /* fraction of the key light for hl_scene_exposure(); 0: no exposure */
} hl_look;

/* The look for a volume and its analysis; file: as in hl_scene_volume. */
const hl_look *hl_look_for(const hl_volume *volume, const char *file, const hl_data_analysis *analysis);

/* True if the values can be Hounsfield units: they reach from air to denser than water. */
bool hl_is_hounsfield(const hl_volume *volume);

/* Makes the transfer function of a look; its points are owned by *function. */
hl_status hl_look_write(const hl_look *look, hl_context *context, const hl_volume *volume,
                        const hl_data_analysis *analysis, hl_transfer_function *function, hl_error *error);

#endif
