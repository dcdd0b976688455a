/* guess/look.h - a look: a transfer function, and what light and shading go with it. */
#ifndef HL_GUESS_LOOK_H
#define HL_GUESS_LOOK_H

#include "guess/function_writer.h"

typedef struct hl_look {
  const char *name;                     /* the kind of data, in words */
  void (*write)(hl_function_writer *w); /* the transfer function */
  hl_shading shading;
  hl_kernel kernel;
  double key, fill, sky; /* intensities: the light with shadows, the one without, the sky */
  double left;           /* fraction of lights with shadows, for hl_scene_exposure(); 0: no exposure */
  bool on_black;         /* the background of a bare volume */
  const char *next;      /* the style that shows such data next best */
} hl_look;

#endif
