/* guess/exposure.h - how bright a picture of one volume will be, before it is made. */
#ifndef HL_GUESS_EXPOSURE_H
#define HL_GUESS_EXPOSURE_H

#include <halflight/scene.h>

/* *factor: what to multiply all lights by, so that the brightest hundredth of a picture of the first volume
 * begins at 240 of 255 in its brightest channel; from 0.5 to 2, and 1 where nothing is seen. left: the
 * fraction of a light with shadows that reaches bright surfaces. empty: a value of the invisible
 * surroundings, to tell which way surfaces face. Fails for lack of memory. */
hl_status hl_scene_exposure(const hl_scene_description *scene, double empty, double left, double *factor,
                            hl_error *error);

#endif
