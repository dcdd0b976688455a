/* analytic/compare_scenes.c - see compare_scenes.h. */
#include "compare_scenes.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

/* ---- voxels: value of a unit cube's point, each coordinate in [-1, 1] ---- */

typedef double field_function(double x, double y, double z);

static double ball(double x, double y, double z, double cx, double cy, double cz, double radius) {
  double dx = x - cx, dy = y - cy, dz = z - cz;
  return fmax(0, 1 - (dx * dx + dy * dy + dz * dz) / (radius * radius));
}
static double balls(double x, double y, double z) {
  double a = ball(x, y, z, -0.35, -0.3, -0.25, 0.5), b = ball(x, y, z, 0.4, 0.35, 0.1, 0.45);
  return fmax(fmax(a, b), ball(x, y, z, 0.1, -0.35, 0.55, 0.35));
}
/* A slab, about three of 28 voxels thick, and a ball below it. */
static double plate(double x, double y, double z) {
  double inside = fabs(x) < 0.6 && fabs(y) < 0.5 ? fmax(0, 1 - fabs(z - 0.5) / 0.15) : 0;
  return fmax(inside, ball(x, y, z, 0, 0, -0.4, 0.5));
}
/* A wall with a slit stands on a floor. The edges are as sharp as the grid allows. */
static double wall(double x, double y, double z) {
  if (fabs(x) > 0.9 || fabs(y) > 0.9 || z < -0.9) return 0;
  if (z < -0.65) return 1;
  return x > -0.2 && x < 0.25 && z < 0.5 && fabs(y) < 0.8 && !(fabs(y) < 0.15 && z < 0.1) ? 1 : 0;
}
static double smoke(double x, double y, double z) {
  double fade = fmax(0, 1 - (x * x + y * y + z * z));
  return fade * (double)stage_noise(4 * x, 4 * y, 4 * z);
}
static double full(double x, double y, double z) {
  return 0.2 + 0.8 * (double)stage_noise(3 * x, 3 * y, 3 * z);
}

/* ---- scenes ---- */

static const hl_opacity_point SURFACE[] = {{0, 0}, {0.2, 0}, {0.45, 0.7}, {1, 0.9}};
static const hl_opacity_point SHARP[] = {{0, 0}, {0.45, 0}, {0.55, 0.95}, {1, 0.95}};
static const hl_opacity_point THIN[] = {{0, 0}, {0.1, 0}, {0.6, 0.12}, {1, 0.2}};
static const hl_opacity_point HAZE[] = {{0, 0}, {0.03, 0}, {0.5, 0.3}, {1, 0.4}};
static const hl_color_point WARM[] = {{0, {0.2, 0.3, 0.9}}, {0.5, {0.9, 0.4, 0.2}}, {1, {1, 0.9, 0.6}}};

#define OPACITY(volume, points)                    \
  ((volume)->transfer_function.opacity = (points), \
   (volume)->transfer_function.opacity_count = sizeof(points) / sizeof *(points))

/* Gives the scene a grid of about N^3 voxels with a field around the origin. edge: the length of the box
 * along x. */
static hl_scene_volume *add_field(stage *set, field_function *field, const size_t n[3],
                                  const double spacing[3]) {
  float *voxels = malloc(n[0] * n[1] * n[2] * sizeof *voxels), *out = voxels;
  assert_non_null(voxels);
  for (size_t k = 0; k < n[2]; k++)
    for (size_t j = 0; j < n[1]; j++)
      for (size_t i = 0; i < n[0]; i++)
        *out++ = (float)field((2.0 * (double)i + 1) / (double)n[0] - 1,
                              (2.0 * (double)j + 1) / (double)n[1] - 1,
                              (2.0 * (double)k + 1) / (double)n[2] - 1);
  vec3 corner = {-0.5 * (double)n[0] * spacing[0], -0.5 * (double)n[1] * spacing[1],
                 -0.5 * (double)n[2] * spacing[2]};
  hl_scene_volume *volume = stage_add_grid(set, n, spacing, corner, voxels);
  free(voxels);
  volume->shading = HL_SHADING_PHONG;
  OPACITY(volume, SURFACE);
  volume->transfer_function.color = WARM;
  volume->transfer_function.color_count = sizeof WARM / sizeof *WARM;
  return volume;
}

static hl_scene_volume *add_cube(stage *set, field_function *field, size_t n) {
  return add_field(set, field, (size_t[3]){n, n, n}, (double[3]){1, 1, 1});
}

static void look_from_corner(stage *set) {
  stage_look(set, (vec3){46, -70, 52}, (vec3){0, 0, 0}, (vec3){0, 0, 1});
  set->scene.camera.height = 44;
}
static void perspective(stage *set, double fovy_deg) {
  set->scene.camera.type = HL_CAMERA_PERSPECTIVE;
  set->scene.camera.fovy_deg = fovy_deg;
}

static void make_balls(stage *set) {
  add_cube(set, balls, 28);
  look_from_corner(set);
  stage_add_directional(set, (vec3){-0.5, 0.3, -1});
}
static void make_balls_medium(stage *set) {
  make_balls(set);
  set->volumes[0].shading = HL_SHADING_NONE;
}
static void make_balls_shining(stage *set) {
  make_balls(set);
  set->volumes[0].material.emission = 0.6;
}
static void make_balls_flat(stage *set) {
  make_balls(set);
  set->volumes[0].shading = HL_SHADING_FLAT;
}
static void make_balls_bytes(stage *set) {
  set->type = HL_VOXEL_U8;
  make_balls_medium(set);
}
static void make_balls_words(stage *set) {
  set->type = HL_VOXEL_U16;
  make_balls_medium(set);
}
static void make_balls_gaussian(stage *set) {
  make_balls_medium(set);
  set->scene.render.kernel = HL_KERNEL_GAUSSIAN;
}
static void make_balls_linear(stage *set) {
  make_balls_medium(set);
  set->scene.render.kernel = HL_KERNEL_LINEAR;
}
static void make_balls_interpolating(stage *set) {
  make_balls(set);
  set->type = HL_VOXEL_U8;
  set->scene.render.kernel = HL_KERNEL_INTERPOLATING;
}
/* The opacity is high where the balls' density rises, and 0 in their middles. */
static const hl_opacity_point STEEP[] = {{0.02, 0}, {0.08, 1}};
static void make_gradient(stage *set) {
  make_balls(set);
  set->volumes[0].transfer_function.gradient_opacity = STEEP;
  set->volumes[0].transfer_function.gradient_opacity_count = 2;
  set->lights[0].angular_diameter_deg = 4;
}
static void make_gradient_medium(stage *set) {
  make_gradient(set);
  OPACITY(&set->volumes[0], HAZE);
  set->volumes[0].shading = HL_SHADING_NONE;
}
static void make_gradient_backlit(stage *set) {
  make_gradient(set);
  memcpy(set->lights[0].direction, (double[3]){-0.5, 1, -0.4}, sizeof set->lights[0].direction);
}
/* The transfer function has boxes of value and gradient for the skins and the middles of the balls, and a
 * cone over both. */
static const hl_function_box SKINS[] = {
    {.low = {0.05, 0.04}, .high = {1, 0.2}, .color = {0.9, 0.5, 0.2}, .opacity = 0.5, .edge = {0.1, 0.04}},
    {.low = {0.5, 0}, .high = {1, 0.07}, .color = {0.2, 0.4, 0.9}, .opacity = 0.2, .edge = {0.2, 0.03}}};
static const double CONE_BORDER[3][2] = {{0.1, 0}, {0.9, 0.02}, {0.5, 0.2}};
static const hl_function_polygon CONE = {.vertices = CONE_BORDER,
                                         .vertex_count = 3,
                                         .apex = {0.5, 0.07},
                                         .color = {0.3, 0.9, 0.3},
                                         .opacity = 0.4,
                                         .falloff = 1};
static void make_plane(stage *set) {
  make_balls(set);
  hl_function_plane *plane = &set->volumes[0].transfer_function.plane;
  plane->second = HL_SECOND_GRADIENT;
  plane->boxes = SKINS, plane->box_count = 2;
  set->lights[0].angular_diameter_deg = 4;
}
static void make_plane_medium(stage *set) {
  make_plane(set);
  set->volumes[0].shading = HL_SHADING_NONE;
  set->volumes[0].transfer_function.unit_distance = 3;
  set->volumes[0].transfer_function.plane.polygons = &CONE;
  set->volumes[0].transfer_function.plane.polygon_count = 1;
}
/* Draws the balls. The smoke of another grid is solid where the balls are thin. */
static void make_plane_volume(stage *set) {
  static const hl_function_box boxes[] = {
      {.low = {0.1, 0.2}, .high = {1, 1}, .color = {0.9, 0.5, 0.2}, .opacity = 0.6, .edge = {0.2, 0.15}},
      {.low = {0.2, 0}, .high = {1, 0.4}, .color = {0.2, 0.4, 0.9}, .opacity = 0.2, .edge = {0.2, 0.2}}};
  make_balls(set);
  hl_scene_volume *other = add_cube(set, full, 20);
  other->name = "other";
  other->scale = 1.4;
  other->visible = other->casts_shadow = 0;
  hl_function_plane *plane = &set->volumes[0].transfer_function.plane;
  plane->second = HL_SECOND_VOLUME;
  plane->volume = "other";
  plane->boxes = boxes, plane->box_count = 2;
  set->lights[0].angular_diameter_deg = 4;
}
static void make_balls_splat(stage *set) {
  make_balls_medium(set);
  set->scene.render.reconstruction = HL_RECONSTRUCTION_SPLAT;
}
static void make_balls_perspective(stage *set) {
  make_balls(set);
  stage_look(set, (vec3){24, -27, 21}, (vec3){0, 0, -1}, (vec3){0, 0, 1});
  perspective(set, 50);
}
static void make_balls_point_light(stage *set) {
  make_balls_medium(set);
  set->scene.light_count = 0;
  hl_light *light = stage_add_point(set, (vec3){17, -8, 32});
  light->radius = 6;
}
static void make_balls_two_lights(stage *set) {
  make_balls(set);
  set->lights[0].color[2] = 0.2;
  set->lights[0].intensity = 0.6;
  stage_add_directional(set, (vec3){1, 0.2, -0.4})->color[0] = 0.1;
}
static void make_plate(stage *set) {
  OPACITY(add_cube(set, plate, 28), SHARP);
  set->volumes[0].shading = HL_SHADING_NONE;
  look_from_corner(set);
  stage_add_directional(set, (vec3){0.2, 0.1, -1})->angular_diameter_deg = 20;
}
static void make_wall(stage *set) {
  add_cube(set, wall, 28);
  look_from_corner(set);
  stage_add_directional(set, (vec3){-1, 0.2, -0.7})->angular_diameter_deg = 20;
}
static void make_wall_medium(stage *set) {
  make_wall(set);
  set->volumes[0].shading = HL_SHADING_NONE;
}
static void make_wall_sharp(stage *set) {
  make_wall_medium(set);
  OPACITY(&set->volumes[0], SHARP);
}
static void make_smoke_lit(stage *set, vec3 direction) {
  hl_scene_volume *volume = add_cube(set, smoke, 28);
  OPACITY(volume, HAZE);
  volume->shading = HL_SHADING_NONE;
  volume->attenuation_color[0] = 0.3;
  volume->attenuation_color[1] = 0.7;
  look_from_corner(set);
  stage_add_directional(set, direction)->angular_diameter_deg = 20;
}
static void make_smoke(stage *set) { make_smoke_lit(set, (vec3){-0.5, 0.3, -1}); }
static void make_smoke_backlit(stage *set) { make_smoke_lit(set, (vec3){46, -60, 40}); }
static void make_smoke_silhouette(stage *set) {
  make_smoke_lit(set, (vec3){46, -70, 52});
} /* the direction to the eye is opposite to the direction to the light */
static void make_smoke_headlight(stage *set) {
  make_smoke_lit(set, (vec3){-46, 70, -52});
} /* the direction to the eye is the direction to the light */
static void make_smoke_across(stage *set) {
  make_smoke_lit(set, (vec3){70, 46, 0});
} /* the directions to the eye and to the light are perpendicular */
static void make_oblique(stage *set) {
  hl_scene_volume *volume = add_field(set, balls, (size_t[3]){26, 22, 12}, (double[3]){1, 1.2, 2.2});
  volume->rotate_axis[0] = 1;
  volume->rotate_axis[1] = -0.5;
  volume->rotate_angle_deg = 35;
  volume->shading = HL_SHADING_NONE;
  look_from_corner(set);
  stage_add_directional(set, (vec3){-0.5, 0.3, -1});
}
static void make_oblique_phong(stage *set) {
  make_oblique(set);
  set->volumes[0].shading = HL_SHADING_PHONG;
}
static void make_two_volumes(stage *set) {
  hl_scene_volume *haze = add_cube(set, full, 17);
  OPACITY(haze, THIN);
  haze->shading = HL_SHADING_NONE;
  haze->scale = 1.3;
  haze->rotate_axis[1] = 1;
  haze->rotate_angle_deg = 25;
  haze->translate[0] = 3.5;
  haze->attenuation_color[2] = 0.4;
  add_cube(set, balls, 22);
  look_from_corner(set);
  stage_add_directional(set, (vec3){-0.5, 0.3, -1});
}
/* The faces of the box cut through dense matter. The picture must show these faces in their places and at
 * full strength. */
static void make_clipped(stage *set) {
  hl_scene_volume *volume = add_cube(set, full, 24);
  OPACITY(volume, THIN);
  volume->shading = HL_SHADING_NONE;
  volume->clipped = 1;
  const double low[3] = {-8.3, -20, -7.2}, high[3] = {20, 5.4, 6.6};
  memcpy(volume->clip_min, low, sizeof low);
  memcpy(volume->clip_max, high, sizeof high);
  look_from_corner(set);
  stage_add_directional(set, (vec3){-0.5, 0.3, -1});
}
static void make_stretched(stage *set) {
  make_clipped(set);
  memcpy(set->volumes[0].axis_scale, (double[3]){0.8, 1.3, 1.7}, sizeof set->volumes[0].axis_scale);
}
static void make_clipped_perspective(stage *set) {
  make_clipped(set);
  stage_look(set, (vec3){23, -26, 18}, (vec3){3, -3, 0}, (vec3){0, 0, 1});
  perspective(set, 60);
}
static void make_eye_inside(stage *set) {
  make_smoke(set);
  stage_look(set, (vec3){2, -4, 3}, (vec3){-7, 8, -3}, (vec3){0, 0, 1});
  perspective(set, 70);
}
static void make_lamp_inside(stage *set) {
  make_smoke(set);
  set->scene.light_count = 0;
  stage_add_point(set, (vec3){3, -2, 3.5});
}
static void make_hidden_occluder(stage *set) {
  make_plate(set);
  hl_scene_volume *screen = stage_add_box(set, (vec3){-4, -20, 17}, (vec3){20, 20, 18});
  stage_set_opacity(set, screen, 0.9, 1);
  screen->visible = 0;
}

/* The grid is one voxel thick, so that every voxel lies at the grid's border. */
static void make_single_layer(stage *set) {
  hl_scene_volume *volume = add_field(set, balls, (size_t[3]){28, 28, 1}, (double[3]){1, 1, 2});
  volume->shading = HL_SHADING_NONE;
  add_cube(set, smoke, 12);
  look_from_corner(set);
  stage_add_directional(set, (vec3){-0.5, 0.3, -1});
}
/* No value is transparent, and voxels that are not finite make holes. Values far from 0 test the precision of
 * floats. */
static double holes(double x, double y, double z) {
  return x * x + y * y < 0.2 ? (double)NAN : 1000 + 0.3 * (double)stage_noise(3 * x, 3 * y, 3 * z);
}
static void make_holes(stage *set) {
  hl_scene_volume *volume = add_cube(set, holes, 20);
  volume->shading = HL_SHADING_NONE;
  stage_set_opacity(set, volume, 0.15, 1);
  look_from_corner(set);
  stage_add_directional(set, (vec3){-0.5, 0.3, -1});
}
static double thousand(double x, double y, double z) { return x + y + z > -9 ? 1000 : 0; }
static void make_constant(stage *set) {
  hl_scene_volume *volume = add_field(set, thousand, (size_t[3]){20, 14, 9}, (double[3]){1, 1, 1});
  volume->shading = HL_SHADING_NONE;
  stage_set_opacity(set, volume, 0.1, 1);
  look_from_corner(set);
  stage_add_directional(set, (vec3){-0.5, 0.3, -1});
}
static void make_wide_angle(stage *set) {
  make_smoke(set);
  stage_look(set, (vec3){9, -14, 9}, (vec3){0, 0, 0}, (vec3){0, 0, 1});
  perspective(set, 110);
}
static void make_lamp_near(stage *set) {
  /* The lamp stands outside of the box. The outermost of its rays run nearly along the box's face. */
  make_smoke(set);
  set->scene.light_count = 0;
  stage_add_point(set, (vec3){3, -2, 17});
}
static void make_three_lights(stage *set) {
  make_smoke(set);
  stage_add_directional(set, (vec3){1, 0.8, 0.2});
  stage_add_point(set, (vec3){-20, -30, 5})->falloff = HL_FALLOFF_INVERSE_SQUARE;
  set->lights[2].intensity = 600;
  set->lights[0].color[0] = set->lights[1].color[1] = set->lights[2].color[2] = 0.2;
}
static void make_flags(stage *set) {
  make_two_volumes(set);
  set->volumes[0].casts_shadow = 0;
  set->volumes[1].receives_shadow = 0;
}
static void make_balls_backlit(stage *set) {
  make_balls(set);
  set->scene.light_count = 0;
  stage_add_directional(set, (vec3){0.5, -0.9, -0.5});
}
static void make_eye_within_parallel(stage *set) {
  make_smoke(set);
  stage_look(set, (vec3){2, -4, 3}, (vec3){-7, 8, -3}, (vec3){0, 0, 1});
}

/* ---- textured lights ---- */

/* A pattern with bright and dark places in every colour. The pattern is so smooth that a reference without
 * prefiltering does not alias. */
static const float *slide(void) {
  static float pixels[12 * 9 * 3];
  for (int y = 0; y < 9; y++)
    for (int x = 0; x < 12; x++)
      for (int c = 0; c < 3; c++)
        pixels[3 * (12 * y + x) + c] = 1.4f * stage_noise(0.9 * x + c, 0.7 * y, 3 * c) *
                                       (float)((x + y) % 3 != 0);
  return pixels;
}
static void make_slide(stage *set) { /* The light is parallel, and the screen is slanted. */
  make_balls(set);
  set->volumes[0].shading = HL_SHADING_NONE;
  stage_set_texture(&set->lights[0], 12, 9, slide(), (vec3){12, -9, 30}, (vec3){14, 3, 4},
                    (vec3){-4, 15, -2});
}
static void make_projector(stage *set) {
  /* A point light shines through a slanted screen at its own side of the volume. */
  make_balls_medium(set);
  set->scene.light_count = 0;
  stage_set_texture(stage_add_point(set, (vec3){17, -8, 32}), 12, 9, slide(), (vec3){10, -6, 20},
                    (vec3){6, 2, 0}, (vec3){-2, 4, 2});
}
static void make_projector_behind(stage *set) {
  /* The screen is on the far side of the volume, and the light falls with the square of the distance. */
  make_projector(set);
  set->lights[0].falloff = HL_FALLOFF_INVERSE_SQUARE;
  set->lights[0].intensity = 1000;
  stage_set_texture(&set->lights[0], 12, 9, slide(), (vec3){-14, 8, -30}, (vec3){20, 3, -10},
                    (vec3){2, 20, 4});
}
static void make_projector_soft(stage *set) {
  make_projector(set);
  set->lights[0].radius = 3;
}
static void make_slide_soft(stage *set) {
  make_slide(set);
  set->lights[0].angular_diameter_deg = 16;
}
static void make_window_in_haze(stage *set) {
  /* Beams shine towards the eye through smoke; one part of the smoke receives no shadows. */
  make_smoke_backlit(set);
  set->volumes[0].attenuation_color[0] = set->volumes[0].attenuation_color[1] = 1;
  set->volumes[0].receives_shadow = 0;
  stage_set_texture(&set->lights[0], 12, 9, slide(), (vec3){-40, 50, -30}, (vec3){10, 8, 0},
                    (vec3){0, -2, 12});
}

static void make_spot(stage *set) {
  make_balls_medium(set);
  set->scene.light_count = 0;
  stage_add_spot(set, (vec3){17, -8, 32}, (vec3){-16, 5, -30}, 32, 9)->radius = 3;
}
static void make_spot_inside(stage *set) {
  /* The lamp is within the smoke, so that several sectors share the lamp's cone. */
  make_smoke(set);
  set->scene.light_count = 0;
  stage_add_spot(set, (vec3){3, -2, 3.5}, (vec3){-0.6, 0.9, -0.5}, 70, 20);
}
static void make_spot_in_smoke(stage *set) {
  /* The cone of a lamp crosses the view, and the cone's edge is sharp. In the scene with an image, the lamp
   * also projects the image. */
  make_smoke(set);
  set->scene.light_count = 0;
  hl_light *light = stage_add_spot(set, (vec3){-30, -16, 12}, (vec3){30, 17, -12}, 24, 0);
  stage_set_texture(light, 12, 9, slide(), (vec3){-15, -8, 6}, (vec3){3, -3, 0}, (vec3){1, 0, 3});
}

/* ---- cuts ---- */

static const hl_cut TWO_PLANES[] = {{.type = HL_CUT_PLANE, .point = {1.3, -2, 1}, .normal = {0.3, -1, 0.5}},
                                    {.type = HL_CUT_PLANE, .point = {0, 0, 7.7}, .normal = {-0.2, 0.1, 1}}};
static const hl_cut OCTANT[] = {{.type = HL_CUT_BOX, .min = {-0.4, -30, 0.3}, .max = {30, 0.2, 30}}};
static const hl_cut BITE[] = {
    {.type = HL_CUT_SPHERE, .center = {3, -9, 6}, .radius = 9.5},
    {.type = HL_CUT_SPHERE, .center = {0, 0, 0}, .radius = 13, .keep = HL_CUT_KEEP_INSIDE}};
static void make_cut(stage *set, field_function *field, const hl_cut *cuts, size_t count) {
  hl_scene_volume *volume = add_cube(set, field, 28);
  volume->cuts = cuts;
  volume->cut_count = count;
  look_from_corner(set);
  stage_add_directional(set, (vec3){0.2, 0.7, -0.9})->angular_diameter_deg = 4;
}
static void make_cut_medium(stage *set, const hl_cut *cuts, size_t count) {
  make_cut(set, full, cuts, count);
  OPACITY(&set->volumes[0], THIN);
  set->volumes[0].shading = HL_SHADING_NONE;
}
static void make_planes(stage *set) { make_cut_medium(set, TWO_PLANES, 2); }
static void make_octant(stage *set) { make_cut_medium(set, OCTANT, 1); }
static void make_bite(stage *set) { make_cut_medium(set, BITE, 2); }
static void make_planes_dense(stage *set) { make_cut(set, full, TWO_PLANES, 2); }
static void make_octant_dense(stage *set) { make_cut(set, full, OCTANT, 1); }
static void make_bite_dense(stage *set) { make_cut(set, full, BITE, 2); }
static void make_octant_backlit(stage *set) {
  make_octant(set);
  memcpy(set->lights[0].direction, (double[3]){-0.5, 1, -0.4}, sizeof set->lights[0].direction);
}
static void make_octant_perspective(stage *set) {
  make_octant(set);
  stage_look(set, (vec3){23, -26, 18}, (vec3){3, -3, 0}, (vec3){0, 0, 1});
  perspective(set, 60);
}
static void make_cut_shadow(stage *set) {
  make_octant(set);
  set->volumes[0].cut_casts_shadow = 1;
}
static void make_cut_none(stage *set) {
  make_octant_dense(set);
  set->volumes[0].cut_shading = HL_CUT_SHADING_NONE;
}

/* Bars below 0.006, and the bars of soft shadows, are about 1.3 times the error that was measured when the
 * bars were set. Two scenes have larger errors. In one scene, light grazes a wall that has a step of opacity:
 * exact shadows would need shadow pixels well below a voxel, and the smallest shadow pixel is half a voxel
 * wide. In the scene of holes, the borders of holes lie half way between the empty value and the least value
 * in the reference, but nearer to the least value in the sheets. */
static const scenario SCENARIOS[] = {
    {"balls", make_balls, 0.006, {0}},
    {"balls-medium", make_balls_medium, 0.006, {0}},
    {"balls-shining", make_balls_shining, 0.006, {0}},
    {"balls-flat", make_balls_flat, 0.006, {0}},
    {"balls-u8", make_balls_bytes, 0.006, {0}},
    {"balls-u16", make_balls_words, 0.006, {0}},
    {"balls-gaussian", make_balls_gaussian, 0.006, {0}},
    {"balls-linear", make_balls_linear, 0.006, {0}},
    {"balls-splat", make_balls_splat, 0.006, {0}},
    {"balls-perspective", make_balls_perspective, 0.006, {0}},
    {"balls-point-light", make_balls_point_light, 0.006, {0.0035, 0.007, 0.0015}},
    {"balls-two-lights", make_balls_two_lights, 0.006, {0}},
    {"plate", make_plate, 0.006, {0}},
    {"wall", make_wall, 0.006, {0}},
    {"wall-medium", make_wall_medium, 0.006, {0}},
    {"wall-sharp", make_wall_sharp, 0.017, {0}},
    {"smoke", make_smoke, 0.006, {0}},
    {"smoke-backlit", make_smoke_backlit, 0.006, {0.0006, 0.0009, 0.0007}},
    {"smoke-silhouette", make_smoke_silhouette, 0.006, {0}},
    {"smoke-headlight", make_smoke_headlight, 0.006, {0}},
    {"smoke-across", make_smoke_across, 0.006, {0}},
    {"oblique", make_oblique, 0.006, {0}},
    {"oblique-phong", make_oblique_phong, 0.006, {0}},
    {"two-volumes", make_two_volumes, 0.006, {0}},
    {"clipped", make_clipped, 0.006, {0}},
    {"stretched", make_stretched, 0.006, {0}},
    {"clipped-perspective", make_clipped_perspective, 0.006, {0}},
    {"eye-inside", make_eye_inside, 0.006, {0}},
    {"lamp-inside", make_lamp_inside, 0.006, {0}},
    {"single-layer", make_single_layer, 0.006, {0}},
    {"holes", make_holes, 0.009, {0}},
    {"constant", make_constant, 0.006, {0}},
    {"wide-angle", make_wide_angle, 0.006, {0}},
    {"lamp-near", make_lamp_near, 0.006, {0}},
    {"three-lights", make_three_lights, 0.006, {0}},
    {"flags", make_flags, 0.006, {0}},
    {"balls-backlit", make_balls_backlit, 0.006, {0}},
    {"eye-within-parallel", make_eye_within_parallel, 0.006, {0}},
    {"hidden-occluder", make_hidden_occluder, 0.006, {0}},
    {"slide", make_slide, 0.006, {0}},
    {"projector", make_projector, 0.006, {0}},
    {"projector-behind", make_projector_behind, 0.006, {0}},
    {"projector-soft", make_projector_soft, 0.006, {0}},
    {"slide-soft", make_slide_soft, 0.006, {0}},
    {"window-in-haze", make_window_in_haze, 0.006, {0}},
    {"spot", make_spot, 0.006, {0}},
    {"spot-inside", make_spot_inside, 0.006, {0}},
    {"spot-in-smoke", make_spot_in_smoke, 0.006, {0}},
    {"balls-interpolating", make_balls_interpolating, 0.006, {0}},
    {"gradient", make_gradient, 0.002, {0.0015, 0.002, 0.0015}},
    {"gradient-medium", make_gradient_medium, 0.002, {0.0015, 0.002, 0.0015}},
    {"gradient-backlit", make_gradient_backlit, 0.002, {0}},
    {"plane", make_plane, 0.0035, {0.0035, 0.0035, 0.0045}},
    {"plane-medium", make_plane_medium, 0.0035, {0.0035, 0.0035, 0.0035}},
    {"plane-volume", make_plane_volume, 0.0032, {0.0032, 0.0037, 0.0017}},
    {"cut-planes", make_planes, 0.0004, {0}},
    {"cut-octant", make_octant, 0.0005, {0}},
    {"cut-bite", make_bite, 0.0008, {0}},
    {"cut-planes-dense", make_planes_dense, 0.006, {0}},
    {"cut-octant-dense", make_octant_dense, 0.006, {0}},
    {"cut-bite-dense", make_bite_dense, 0.003, {0}},
    {"cut-octant-backlit", make_octant_backlit, 0.0006, {0}},
    {"cut-octant-perspective", make_octant_perspective, 0.0006, {0}},
    {"cut-shadow", make_cut_shadow, 0.0005, {0}},
    {"cut-none", make_cut_none, 0.005, {0}},
};

const scenario *compare_scenarios(size_t *count) {
  *count = sizeof SCENARIOS / sizeof *SCENARIOS;
  return SCENARIOS;
}
