/* analytic/compare_scenes.h - the scenes on which the renderer is compared with the reference. */
#ifndef COMPARE_SCENES_H
#define COMPARE_SCENES_H

#include "reference_stage.h"

typedef struct scenario {
  const char *name;
  void (*make)(stage *set);
  double
      bar; /* the greatest allowed RMSE at sheet spacing 0.5 and 64 pixels or more; 0: there is no bar yet */
  /* the greatest allowed RMSE of the cascade, the paper's method and sub-lights, against a reference with at
   * least 16 points for each light; 0: there is no bar */
  double soft_bars[3];
} scenario;

const scenario *compare_scenarios(size_t *count);

#endif
