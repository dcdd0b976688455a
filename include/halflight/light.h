/* halflight/light.h - lights and skies of a scene, as plain data.
 *
 * Lengths are in world units, angles in degrees, and colours in linear RGB. hl_light_defaults() and
 * hl_scene_description_defaults() (scene.h) fill the structs with values that suit most lights and skies. */
#ifndef HALFLIGHT_LIGHT_H
#define HALFLIGHT_LIGHT_H

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef enum hl_light_type {
  HL_LIGHT_DIRECTIONAL = 0,
  HL_LIGHT_POINT = 1,
  HL_LIGHT_SPOT = 2,
  HL_LIGHT_RECT = 3,
  HL_LIGHT_DISK = 4,
  HL_LIGHT_POLYGON = 5
} hl_light_type;

typedef enum hl_shadows {
  HL_SHADOWS_DEFAULT = 0, /* only as the setting of a light: the light has the shadows that
                           * hl_render_settings.shadows states */
  HL_SHADOWS_OFF = 1,
  HL_SHADOWS_HARD = 2,
  HL_SHADOWS_SOFT = 3
} hl_shadows;

/* The dependence of a light's brightness on the distance from the light. */
typedef enum hl_falloff { HL_FALLOFF_NONE = 0, HL_FALLOFF_INVERSE_SQUARE = 1 } hl_falloff;

/* An image that a light projects, like a slide (section 4 of the paper). The image stands on a screen, a
 * parallelogram in space. Each ray of the light has one colour over its whole length: the image's colour
 * where the ray crosses the screen. Rays that miss the screen are dark. The image is interpolated bilinearly
 * between the middles of its pixels. */
typedef struct hl_light_texture {
  const char *file;    /* the file that the pixels came from, which hl_scene_to_json writes; may be null */
  const float *pixels; /* [height][width][3]: linear RGB, top row first; null if the light has no texture */
  int width, height;
  double screen_center[3];
  double screen_right[3]; /* the vector from the screen's centre to the middle of the image's right edge */
  double screen_up[3];    /* the vector from the screen's centre to the middle of the image's top edge */
} hl_light_texture;

/* An image on the surface of an extended light. Each point of the surface sends the image's colour at this
 * point, times the light's color and intensity. Soft shadows have the image's shape and colours; a light
 * without soft shadows has the image's mean colour. On a rect, edge1 points to the image's right edge and
 * edge2 to its top. On a disk or polygon the image fills the square or rectangle around the disk or polygon,
 * with the image's top towards `up`. The image is not mirrored as seen from the side that the normal points
 * to. On a sphere or a directional light, every sample sees the image from its front. The image is
 * interpolated bilinearly between the middles of its pixels. */
typedef struct hl_light_emission {
  const char *file;    /* the file that the pixels came from, which hl_scene_to_json writes; may be null */
  const float *pixels; /* [height][width][3]: linear RGB, top row first; if null, all points of the light have
                        * the light's own colour */
  int width, height;
  double up[3]; /* the direction of the image's top, for all lights but rects; if it is parallel to the
                 * light's normal, [0, 1, 0] is used instead */
} hl_light_emission;

/* The axes in which a light's positions and directions are given. */
typedef enum hl_light_frame {
  HL_LIGHT_FRAME_WORLD = 0,
  HL_LIGHT_FRAME_CAMERA = 1 /* x points right, y up and z towards the viewer, and the origin is the camera's
                             * target. Such a light moves with the camera */
} hl_light_frame;

typedef struct hl_light {
  hl_light_type type;
  hl_light_frame frame;        /* the axes in which all vectors below are given; this includes the vectors in
                                * texture and emission */
  double direction[3];         /* directional and spot lights: the direction in which the light travels */
  double angular_diameter_deg; /* directional light: the angle under which samples see it; shadows can be soft
                                * only if it is above 0 */
  double position[3];          /* point, spot, rect and disk lights: the light's centre */
  double radius;               /* radius of a point or spot light, which are spheres, or of a disk */
  double normal[3];            /* disk: the direction of its normal */
  double edge1[3], edge2[3];   /* rect: two vectors along its edges, each as long as the edge */
  double opening_angle_deg;    /* spot light: the full angle of its cone of light; no light leaves the lamp
                                * outside the cone */
  double falloff_angle_deg;    /* spot light: the width, inside the cone, of the smooth edge over which the
                                * light fades */
  const double (*vertices)[3]; /* polygon; [vertex_count][3] */
  size_t vertex_count;
  double color[3];
  double intensity; /* A factor on the light's color. A sample receives color * intensity at any distance from
                     * the light, unless falloff makes the light weaker with distance */
  hl_falloff falloff;
  hl_shadows shadows;
  hl_light_texture texture;   /* the image that the light projects; hl_scene_create() copies it with its
                               * pixels */
  hl_light_emission emission; /* the image on the light's own surface; hl_scene_create() copies it with its
                               * pixels. A light must not have both an emission image and a texture */
} hl_light;

typedef enum hl_sky_type {
  HL_SKY_NONE = 0,
  HL_SKY_UNIFORM = 1,  /* one colour */
  HL_SKY_GRADIENT = 2, /* the radiance changes from the horizon to the zenith, and from the horizon to the
                        * ground. It is linear in the sine of the elevation */
  HL_SKY_IMAGE = 3     /* the radiance is an equirectangular image of an environment */
} hl_sky_type;

/* The sky of a scene: light from all directions. Everything that casts shadows attenuates this light. A
 * surface receives diffuse / pi times the integral of radiance x transmittance x cosine over all directions.
 * A medium receives the mean of radiance x transmittance x phase function over all directions. So if the sky
 * has radiance 1 in all directions and nothing hides it, a medium receives 1, and a surface receives its
 * diffuse reflectance. A sky makes no highlights.
 *
 * The image's top row is the zenith, and its bottom row the opposite point. The image's middle column lies in
 * the direction of the cross product up x right. The direction `right` is the world's x axis, made
 * perpendicular to up; where up is within 8 degrees of x, the y axis takes the place of x. So if up is along
 * z, the image's middle lies towards +y. Seen from within the sky, the image is not mirrored. The image is
 * interpolated bilinearly between the middles of its pixels. */
typedef struct hl_sky {
  hl_sky_type type;
  double color[3];                         /* uniform: radiance */
  double zenith[3], horizon[3], ground[3]; /* gradient: radiance */
  const char *file;    /* image: the file that the pixels came from, which hl_scene_to_json writes; may be
                        * null */
  const float *pixels; /* image: [height][width][3]: linear RGB, copied by hl_scene_create() */
  int width, height;
  double rotation_deg; /* image: the angle by which the image is turned about up; positive: counterclockwise
                        * as seen from above */
  double up[3];        /* the direction of the zenith, a vector of any length in the world */
  int hemisphere;      /* non-zero if the sky has no light below the horizon */
  double strength;     /* a factor by which the radiance of all colours is multiplied */
  int suns; /* image: non-zero (the default): in a scene with shadows, up to four compact bright spots of the
             * image shine as parallel lights, and are left out of the image's light. The sum of all light
             * stays the same */
} hl_sky;

#ifdef __cplusplus
}
#endif

#endif
