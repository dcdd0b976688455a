/* halflight/layers.h - layers beside a picture: the share of each light and of the sky, shadows, depth,
 * normals, objects.
 *
 * The layers of all lights, the sky, the ambient light and the emission add up to the picture's RGB, up to
 * rounding. So a program can brighten, dim or colour lights afterwards, without rendering again. Most other
 * layers are means along each ray, weighted by what each sample adds to the picture's alpha (the sample's
 * opacity times the transmittance from the eye to the sample). These means are divided by alpha, and so are
 * not premultiplied. All layers have the top row first, like the picture. */
#ifndef HALFLIGHT_LAYERS_H
#define HALFLIGHT_LAYERS_H

#include "context.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The caller's buffers for the layers of one light. */
typedef struct hl_light_layers {
  float *picture; /* [height][width][3]; what the light adds to the linear premultiplied RGB; or null */
  float *shadow;  /* [height][width][3]; mean transmittance in R, G and B from the light to the visible
                   * samples: 1 is full light, as for lights without shadows and volumes that receive none; 0
                   * where alpha is 0; or null */
} hl_light_layers;

/* The caller's buffers for all layers. A buffer is null where its layer is not wanted. Buffers must not
 * overlap. */
typedef struct hl_layers {
  size_t struct_size; /* set by the caller to sizeof(hl_layers) */
  float *ambient;     /* [height][width][3]; what ambient light adds to the linear premultiplied RGB */
  float *depth_first; /* [height][width]; the depth at which the ray's alpha first reaches 0.01; infinite
                       * where it never does */
  float *depth_mean;  /* [height][width]; the mean depth of the samples; infinite where alpha is 0 */
  float *normal;      /* [height][width][3]; the mean, in the world, of the unit normals by which the samples
                       * were lit; a sample of a medium has no normal and counts as 0; 0 where alpha is 0 */
  const hl_light_layers *lights; /* [light_count], in the order of the scene's lights; or null */
  size_t light_count;            /* the scene's; or 0 */
  float *emission; /* [height][width][3]; what volumes and meshes add to the linear premultiplied RGB without
                      any light: by their material's emission, or because they are shaded flat */
  float *sky; /* [height][width][3]; what the sky adds to the linear premultiplied RGB; 0 without a sky */
  float *sky_shadow; /* [height][width][3]; ambient occlusion: the sky's light in R, G and B if all matter
                      * were white, divided by the same light if nothing hid the sky; 1 where nothing is
                      * hidden; 0 where the sky would add nothing */
  float *object;     /* [height][width]; the number of what the ray meets at depth_first: v + 1 for volume v
                      * of the scene and for its isosurfaces, volume_count + m + 1 for mesh m; 0 where the ray
                      * meets nothing. Where the rays of one pixel meet several things, the pixel has the
                      * number that most rays meet */
} hl_layers;

/* A depth is a length along the pixel's ray, in world units. It begins at the eye, or for an orthographic
 * camera at the plane through the camera's position (negative behind this plane). */

#ifdef __cplusplus
}
#endif
#endif
