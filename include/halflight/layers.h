/* halflight/layers.h - layers beside a picture: the share of each light and of the sky, shadows, depth,
 * normals, objects.
 *
 * The layers of all lights, the sky, the ambient light and the emission add up to the picture's RGB, up to
 * rounding. So a program can brighten, dim or colour lights afterwards, without rendering again. Most other
 * layers are means over the samples of each ray. A sample's weight is the alpha that it adds to the pixel:
 * its opacity times the transmittance from the eye to the sample. The means are divided by the pixel's alpha,
 * and so are not premultiplied. All layers have the top row first, like the picture. */
#ifndef HALFLIGHT_LAYERS_H
#define HALFLIGHT_LAYERS_H

#include "context.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The caller's buffers for the layers of one light. */
typedef struct hl_light_layers {
  float *picture; /* [height][width][3]; the part of the picture's linear premultiplied RGB that is this
                   * light's; or null */
  float *shadow;  /* [height][width][3]; the mean transmittance in R, G and B from the light to the visible
                   * samples. 1 is full light; lights without shadows and volumes that receive no shadows have
                   * 1. A pixel has 0 where alpha is 0; or null */
} hl_light_layers;

/* The caller's buffers for all layers. A null stands for a layer that the caller does not want. Buffers must
 * not overlap. */
typedef struct hl_layers {
  size_t struct_size; /* set by the caller to sizeof(hl_layers) */
  float *ambient;     /* [height][width][3]; the part of the picture's linear premultiplied RGB that comes
                       * from ambient light */
  float *depth_first; /* [height][width]; the depth at which the ray's alpha first reaches 0.01; infinite if
                       * alpha never reaches this value */
  float *depth_mean;  /* [height][width]; the mean depth of the samples; infinite where alpha is 0 */
  float *normal;      /* [height][width][3]; the mean, in the world, of the unit normals by which the samples
                       * were lit. A sample of a medium has no normal, and counts as 0. A pixel has 0 where
                       * alpha is 0 */
  const hl_light_layers *lights; /* [light_count], the layers of each light, in the order of the scene's
                                  * lights; or null */
  size_t light_count;            /* the scene's number of lights; or 0 */
  float *emission; /* [height][width][3]; the part of the picture's linear premultiplied RGB that volumes and
                    * meshes send without any light: because their material has emission, or because they are
                    * shaded flat */
  float *sky; /* [height][width][3]; the part of the picture's linear premultiplied RGB that comes from the
               * sky; 0 without a sky */
  float *sky_shadow; /* [height][width][3]; ambient occlusion: the sky's light in R, G and B on white matter,
                      * divided by the same light if nothing hid the sky. 1: nothing is hidden; 0: all is
                      * hidden, or the sky has no light */
  float *object;     /* [height][width]; the number of the volume or mesh that the ray meets at depth_first: v
                      * + 1 for volume v of the scene and for its isosurfaces, volume_count + m + 1 for mesh
                      * m; 0 if the ray meets nothing. If the rays of one pixel meet several objects, the
                      * pixel has the number of the object that most rays meet */
} hl_layers;

/* Depths are lengths along a pixel's ray, in world units. For a perspective camera, a depth begins at the
 * eye. For an orthographic camera, it begins at the plane through the camera's position, and is negative
 * behind this plane. */

#ifdef __cplusplus
}
#endif
#endif
