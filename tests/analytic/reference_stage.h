/* analytic/reference_stage.h - small scenes built in code, and their pictures by the reference and by the
 * sheets. */
#ifndef REFERENCE_STAGE_H
#define REFERENCE_STAGE_H

#include <halflight/halflight.h>

#include "core/vector.h"

enum { STAGE_VOLUMES = 8, STAGE_LIGHTS = 4 };

typedef struct stage {
  hl_context *context;
  hl_scene_description scene; /* its arrays are the ones below; camera, size and settings may be changed */
  hl_scene_volume volumes[STAGE_VOLUMES]; /* each holds a reference to its hl_volume */
  hl_light lights[STAGE_LIGHTS];
  hl_voxel_type type; /* of grids added from now on: f32; or u8, u16 for values from 0 to 1, scaled */
  hl_opacity_point constant_opacity[STAGE_VOLUMES]; /* where a volume's opacity is one number */
  hl_color_point constant_color[STAGE_VOLUMES];
} stage;

/* No volumes, no lights, no ambient, hard shadows; 16 x 16 pixels seen orthographically along -z, up +y. */
void stage_open(stage *set);
void stage_open_with(stage *set, const hl_context_options *options); /* options of the context; may be null */
void stage_close(stage *set);

/* A grid with axes along the world's; its box starts at `corner`. voxels: [k][j][i] or null for all 1.
 * Opacity 0.5 per unit length and white for every value, shading "none". */
hl_scene_volume *stage_add_grid(stage *set, const size_t dimensions[3], const double spacing[3], vec3 corner,
                                const float *voxels);
/* A grid of one voxel that fills the box. */
hl_scene_volume *stage_add_box(stage *set, vec3 low, vec3 high);
/* A grid of 24^3 voxels about the origin: a ball above a plate, of smooth values from 0 to 1, 0.5 at their
 * surfaces. opacity: [2], borrowed. */
hl_scene_volume *stage_add_ball_and_plate(stage *set, const hl_opacity_point opacity[2]);
/* A volume's grid, without its voxels. */
hl_volume_description stage_describe_volume(const hl_volume *volume);
/* Makes every seventh voxel, and the last one, of the first volume one that is not finite; it must be of
 * floats. */
void stage_spoil(stage *set);
void stage_set_opacity(stage *set, hl_scene_volume *volume, double opacity, double unit_distance);
void stage_set_color(stage *set, hl_scene_volume *volume, double r, double g, double b);
hl_light *stage_add_directional(stage *set, vec3 direction);
hl_light *stage_add_point(stage *set, vec3 position);
hl_light *stage_add_spot(stage *set, vec3 position, vec3 direction, double opening_deg, double falloff_deg);

/* A rectangle of two triangles about a centre with two half edges; owned by the caller. */
hl_mesh *stage_make_quad(stage *set, vec3 centre, vec3 u, vec3 v);

/* pixels: [height][width][3], borrowed until the pictures are made. */
void stage_set_texture(hl_light *light, int width, int height, const float *pixels, vec3 center, vec3 right,
                       vec3 up);

void stage_look(stage *set, vec3 position, vec3 target, vec3 up);
/* The ray through the centre of pixel (x, y), as the scene format defines it. */
void stage_eye_ray(const stage *set, int x, int y, vec3 *origin, vec3 *direction);
/* How long the ray is inside the box. */
double stage_chord(vec3 low, vec3 high, vec3 origin, vec3 direction);

/* pixels: [height][width][4]. options may be null. The test fails where rendering does. */
void stage_render(stage *set, const hl_reference_options *options, float *pixels);
/* By the reference, with 4 x 4 points of each light, or by the sheets. */
void stage_render_by(stage *set, bool reference, float *pixels);
/* The same by the sheets: with a renderer of the moment, which may count its work, or with the caller's. */
void stage_render_sheets(stage *set, float *pixels);
hl_render_statistics stage_render_counted(stage *set, float *pixels);
void stage_render_with(stage *set, hl_renderer *renderer, float *pixels);

/* With layers: by the reference with these options, or by the sheets where they are null. pixels as above. */
void stage_render_layers(stage *set, const hl_reference_options *options, float *pixels,
                         const hl_layers *wanted);

/* The test fails unless the scene is refused with just this message. */
void stage_refused(stage *set, const char *message);

/* Smooth noise without a library: sums of sines with a fixed pattern, in [0, 1]. */
float stage_noise(double x, double y, double z);
/* A repeatable random number from 0 to 1, and a unit vector; seed: any start. */
double stage_random(uint32_t *seed);
vec3 stage_random_direction(uint32_t *seed);

#endif
