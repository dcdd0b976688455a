/* analytic/reference_stage.h - small scenes that are built in code, and functions that render them by the
 * reference and by the sheets. */
#ifndef REFERENCE_STAGE_H
#define REFERENCE_STAGE_H

#include <halflight/halflight.h>

#include "core/vector.h"

enum { STAGE_VOLUMES = 8, STAGE_LIGHTS = 4 };

typedef struct stage {
  hl_context *context;
  /* the arrays of the scene are the members below; tests may change camera, size and settings */
  hl_scene_description scene;
  hl_scene_volume volumes[STAGE_VOLUMES]; /* each volume holds a reference to its hl_volume */
  hl_light lights[STAGE_LIGHTS];
  /* the type of the voxels of grids that are added from now on: f32, or u8 and u16, which hold scaled values
   * from 0 to 1 */
  hl_voxel_type type;
  /* the opacity of a volume that has the same opacity for all values */
  hl_opacity_point constant_opacity[STAGE_VOLUMES];
  hl_color_point constant_color[STAGE_VOLUMES];
} stage;

/* Opens a stage without volumes, lights and ambient light, with hard shadows. The picture has 16 x 16 pixels,
 * seen orthographically along -z, and y is up. */
void stage_open(stage *set);
/* options: of the context; may be null */
void stage_open_with(stage *set, const hl_context_options *options);
void stage_close(stage *set);

/* Adds a grid along the world's axes, whose box begins at `corner`. voxels: [k][j][i]; null: all voxels are
 * 1. Every value is white, with an opacity of 0.5 per unit of length. The shading is "none". */
hl_scene_volume *stage_add_grid(stage *set, const size_t dimensions[3], const double spacing[3], vec3 corner,
                                const float *voxels);
/* Adds a grid of one voxel that fills the box. */
hl_scene_volume *stage_add_box(stage *set, vec3 low, vec3 high);
/* Adds a grid of 24^3 voxels around the origin: a ball above a plate. Values are smooth, from 0 to 1, and are
 * 0.5 at the surfaces. opacity: [2], borrowed. */
hl_scene_volume *stage_add_ball_and_plate(stage *set, const hl_opacity_point opacity[2]);
/* Describes a volume's grid, without its voxels. */
hl_volume_description stage_describe_volume(const hl_volume *volume);
/* Replaces every seventh voxel and the last voxel of the first volume, which must have floats, by numbers
 * that are not finite. */
void stage_spoil(stage *set);
void stage_set_opacity(stage *set, hl_scene_volume *volume, double opacity, double unit_distance);
void stage_set_color(stage *set, hl_scene_volume *volume, double r, double g, double b);
hl_light *stage_add_directional(stage *set, vec3 direction);
hl_light *stage_add_point(stage *set, vec3 position);
hl_light *stage_add_spot(stage *set, vec3 position, vec3 direction, double opening_deg, double falloff_deg);

/* Makes a rectangle of two triangles around a centre. u, v: half of the rectangle's sides. The caller owns
 * the mesh. */
hl_mesh *stage_make_quad(stage *set, vec3 centre, vec3 u, vec3 v);

/* pixels: [height][width][3], borrowed until all pictures are made. */
void stage_set_texture(hl_light *light, int width, int height, const float *pixels, vec3 center, vec3 right,
                       vec3 up);

void stage_look(stage *set, vec3 position, vec3 target, vec3 up);
/* Computes the ray through the centre of the pixel (x, y), as the scene format defines rays. */
void stage_eye_ray(const stage *set, int x, int y, vec3 *origin, vec3 *direction);
/* Returns the length of the ray within the box. */
double stage_chord(vec3 low, vec3 high, vec3 origin, vec3 direction);

/* Renders by the reference. pixels: [height][width][4]. options: may be null. The test fails if rendering
 * fails. */
void stage_render(stage *set, const hl_reference_options *options, float *pixels);
/* Renders by the reference, with 4 x 4 points on each light, or by the sheets. */
void stage_render_by(stage *set, bool reference, float *pixels);
/* Three functions render by the sheets. stage_render_sheets() and stage_render_counted() make a renderer for
 * the picture, and stage_render_counted() returns the work that was counted. stage_render_with() uses the
 * caller's renderer. */
void stage_render_sheets(stage *set, float *pixels);
hl_render_statistics stage_render_counted(stage *set, float *pixels);
void stage_render_with(stage *set, hl_renderer *renderer, float *pixels);

/* Renders a picture with layers: by the reference with these options, or by the sheets if the options are
 * null. pixels: [height][width][4]. */
void stage_render_layers(stage *set, const hl_reference_options *options, float *pixels,
                         const hl_layers *wanted);

/* The test fails unless the scene is refused with exactly this message. */
void stage_refused(stage *set, const char *message);

/* Smooth noise in [0, 1]: a sum of sines with a fixed pattern, the same on every machine. */
float stage_noise(double x, double y, double z);
/* stage_random() returns a repeatable random number from 0 to 1, and stage_random_direction() a random unit
 * vector. seed: may begin with any number. */
double stage_random(uint32_t *seed);
vec3 stage_random_direction(uint32_t *seed);

#endif
