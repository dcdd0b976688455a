/* tests/analytic/ways_in_bricks.h - scenes of one volume, and the ways to draw them by which a field in
 * bricks is compared with other forms of the same field. */
#ifndef WAYS_IN_BRICKS_H
#define WAYS_IN_BRICKS_H

#include <math.h>

#include "core/memory.h"
#include "volume/volume.h"
#include "ways_to_draw.h"

enum { SIDE = 24, FLOATS = SIDE * SIDE * 4 };

static inline void draw_hard(stage *set) { set_method(set, HL_SHADOWS_HARD, HL_SOFT_CASCADE); }
/* A lattice of voxels leaves out cells in which nothing shows, and the sky's light is not sampled there. */
static inline void draw_sky(stage *set) {
  set->scene.sky.type = HL_SKY_UNIFORM;
  for (int c = 0; c < 3; c++) set->scene.sky.color[c] = 0.7;
}
static inline void draw_scattering(stage *set) {
  set->volumes[0].shading = HL_SHADING_NONE;
  set->volumes[0].multiple_scattering = 1;
}
static inline void draw_clipped(stage *set) {
  set->volumes[0].clipped = 1;
  for (int a = 0; a < 3; a++) {
    set->volumes[0].clip_min[a] = -7.3;
    set->volumes[0].clip_max[a] = 6.1;
  }
}
static inline void draw_cut(stage *set) {
  static hl_cut ball;
  hl_cut_defaults(&ball);
  ball.type = HL_CUT_SPHERE;
  ball.radius = 6;
  ball.center[0] = 6;
  set->volumes[0].cuts = &ball;
  set->volumes[0].cut_count = 1;
}

/* Sets a label map of 12^3 voxels, coarser than the volume and askew to its voxels. The map has two labels,
 * and a corner without a label. */
static inline void draw_mask(stage *set) {
  static const hl_label labels[] = {
      {.value = 1, .color = {0.81, 0.09, 0.25}, .opacity = 0.4, .visible = 1, .tint = 1},
      {.value = 2, .color = {0.04, 0.64, 0.16}, .opacity = 1, .visible = 1, .tint = 0.5}};
  enum { MAP = 12 };
  static unsigned char voxels[MAP * MAP * MAP];
  hl_volume_description d;
  hl_volume_description_defaults(&d);
  for (int n = 0; n < MAP * MAP * MAP; n++) {
    int i = n % MAP, j = n / MAP % MAP, k = n / MAP / MAP;
    voxels[n] = i + j + k < MAP ? 0 : i < j ? 1 : 2;
  }
  for (int a = 0; a < 3; a++) {
    d.dimensions[a] = MAP;
    d.axis[a][a] = 1.7;
    d.origin[a] = -9.3;
  }
  d.type = HL_VOXEL_U8;
  d.voxels = voxels;
  set->volumes[0].mask = (hl_mask){.labels = labels, .label_count = 2, .rest = 0.1};
  assert_int_equal(hl_volume_create(set->context, &d, &set->volumes[0].mask.volume, NULL), HL_OK);
}

static inline void set_function(stage *set, hl_second_axis second, const hl_function_box *boxes) {
  set->volumes[0].transfer_function.plane.second = second;
  set->volumes[0].transfer_function.plane.boxes = boxes;
  set->volumes[0].transfer_function.plane.box_count = 2;
}
static inline void draw_function_of_gradients(stage *set) {
  static const hl_function_box boxes[] = {
      {.low = {0.2, 0.05}, .high = {0.9, 0.3}, .color = {0.9, 0.2, 0.1}, .opacity = 0.5, .edge = {0.2, 0.1}},
      {.low = {0.4, 0.2}, .high = {1, 2}, .color = {0.1, 0.3, 0.8}, .opacity = 0.8, .edge = {0.2, 0.4}}};
  set_function(set, HL_SECOND_GRADIENT, boxes);
}
/* Sets a transfer function of the values of two volumes. The second volume is a copy of the first volume,
 * moved to the side and invisible. */
static inline void draw_function_of_volume(stage *set) {
  static const hl_function_box boxes[] = {
      {.low = {0.2, 0.1}, .high = {1, 0.5}, .color = {0.9, 0.2, 0.1}, .opacity = 0.5, .edge = {0.2, 0.1}},
      {.low = {0.3, 0.4}, .high = {1, 1}, .color = {0.1, 0.3, 0.8}, .opacity = 0.8, .edge = {0.2, 0.2}}};
  hl_scene_volume *second = &set->volumes[set->scene.volume_count++];
  *second = set->volumes[0];
  hl_volume_retain(second->volume);
  second->name = "second";
  second->visible = 0;
  second->translate[0] = 1.3;
  set_function(set, HL_SECOND_VOLUME, boxes);
  set->volumes[0].transfer_function.plane.volume = "second";
}

/* Gives the volume's voxels colours that differ from voxel to voxel. The volume owns the colours. */
static inline void draw_voxel_colors(stage *set) {
  hl_volume *volume = set->volumes[0].volume;
  size_t bytes = 4 * hl_volume_voxel_count(volume);
  volume->colors = hl_allocate(set->context, bytes, 1);
  assert_non_null(volume->colors);
  for (size_t n = 0; n < bytes; n++) volume->colors[n] = (unsigned char)(n * 2654435761u >> 13 | 1);
}

/* Closes a scene of one of the ways. */
static inline void close_way(stage *set) {
  hl_volume_release(set->volumes[0].mask.volume);
  stage_close(set);
}

static const way ways[] = {{"hard", draw_hard},
                           {"paper", draw_paper},
                           {"cascade", draw_cascade},
                           {"sublights", draw_sublights},
                           {"maximum", draw_maximum},
                           {"gradient opacity", draw_gradient_opacity},
                           {"sky", draw_sky},
                           {"scattering", draw_scattering},
                           {"clipped", draw_clipped},
                           {"cut", draw_cut},
                           {"isosurface", draw_isosurface},
                           {"mask", draw_mask},
                           {"function of gradients", draw_function_of_gradients},
                           {"function of itself twice", draw_function_of_volume},
                           {"voxel colours", draw_voxel_colors}};
enum { WAYS = sizeof ways / sizeof *ways };

static inline void light_scene(stage *set, hl_scene_volume *volume) {
  volume->shading = HL_SHADING_PHONG;
  set_soft_edge(volume);
  set->scene.camera.type = HL_CAMERA_PERSPECTIVE;
  set->scene.camera.fovy_deg = 40;
  stage_add_directional(set, (vec3){-1, 0.5, -1})->angular_diameter_deg = 10;
  stage_add_point(set, (vec3){14, 25, 30})->radius = 3;
}

/* Returns the root mean square difference of two pictures. */
static inline double difference(const float *a, const float *b) {
  double sum = 0;
  for (int i = 0; i < FLOATS; i++) sum += pow((double)a[i] - (double)b[i], 2);
  return sqrt(sum / FLOATS);
}

/* ---- layers ---- */

/* The buffers of a picture of one volume under the lights of light_scene(), and of its layers. */
typedef struct layer_buffers {
  struct {
    float pixels[FLOATS], ambient[SIDE * SIDE * 3], emission[SIDE * SIDE * 3], normal[SIDE * SIDE * 3];
    float picture[2][SIDE * SIDE * 3], shadow[2][SIDE * SIDE * 3];
    float first[SIDE * SIDE], mean[SIDE * SIDE], object[SIDE * SIDE];
  } floats;
  hl_light_layers lights[2];
} layer_buffers;

static inline void render_layers(stage *set, layer_buffers *to) {
  for (int l = 0; l < 2; l++) to->lights[l] = (hl_light_layers){to->floats.picture[l], to->floats.shadow[l]};
  const hl_layers wanted = {.struct_size = sizeof wanted,
                            .ambient = to->floats.ambient,
                            .depth_first = to->floats.first,
                            .depth_mean = to->floats.mean,
                            .normal = to->floats.normal,
                            .lights = to->lights,
                            .light_count = 2,
                            .emission = to->floats.emission,
                            .object = to->floats.object};
  set->scene.width = set->scene.height = SIDE;
  stage_render_layers(set, NULL, to->floats.pixels, &wanted);
}

#endif
