/* guess/exposure.h - estimates how bright a picture of one volume will be, before the picture is made. */
#ifndef HL_GUESS_EXPOSURE_H
#define HL_GUESS_EXPOSURE_H

#include <halflight/scene.h>

typedef struct hl_exposure {
  double factor; /* the factor for the strengths of all lights. With this factor, a hundredth of the picture's
                  * pixels have a code from 240 to 255 in their brightest channel. The factor lies between 0.5
                  * (0.15 for a medium that scatters light again and again) and 2; the factor is 1 if nothing
                  * is seen */
  /* A surface's thickness, in smallest voxel edges: the depth, from where the surface begins, at which it
   * hides matter behind it. A seventh of the visible surfaces are thinner than this depth. The depth is
   * infinite if no surface hides anything. */
  double thickness;
} hl_exposure;

/* Estimates how bright a picture of the first volume is. left: the light of the sky, and of lights with
 * shadows, that reaches bright media in spite of shadows, as a fraction; surfaces get all of the light.
 * empty: the data value of the invisible surroundings; a surface faces the side on which values are closer to
 * this value. Fails for lack of memory. */
hl_status hl_scene_exposure(const hl_scene_description *scene, double empty, double left, hl_exposure *result,
                            hl_error *error);

#endif
