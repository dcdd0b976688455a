/* analytic/moved_stage.c - see moved_stage.h. */
#include "moved_stage.h"

#include <setjmp.h>
#include <stdarg.h>
#include <string.h>

#include <cmocka.h>

#include "scene/function/function_plane.h"
#include "scene/scene.h"
#include "volume/volume.h"

static const mat3 NO_TURN = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};

motion motion_of_scale(double scale) { return (motion){NO_TURN, scale, {0, 0, 0}}; }
motion motion_of_shift(double x, double y, double z) { return (motion){NO_TURN, 1, {x, y, z}}; }
motion motion_of_turn(vec3 axis, double angle_deg) {
  return (motion){mat3_rotation(vec3_normalise(axis), angle_deg * HL_PI / 180), 1, {0, 0, 0}};
}
/* Returns the motion of a reflection, whose matrix is I - 2 n n'. */
motion motion_of_mirror(vec3 n) {
  motion mirror = motion_of_scale(1);
  const double c[3] = {n.x, n.y, n.z};
  for (int row = 0; row < 3; row++)
    mirror.turn.row[row] = vec3_subtract(NO_TURN.row[row], vec3_scale(n, 2 * c[row]));
  return mirror;
}

static double determinant(mat3 m) { return vec3_dot(m.row[0], vec3_cross(m.row[1], m.row[2])); }

static void store(double to[3], vec3 v) {
  to[0] = v.x;
  to[1] = v.y;
  to[2] = v.z;
}
static void move_direction(const motion *by, double v[3]) { store(v, mat3_apply(by->turn, vec3_of(v))); }
static void move_length(const motion *by, double v[3]) {
  store(v, vec3_scale(mat3_apply(by->turn, vec3_of(v)), by->scale));
}
static void move_point(const motion *by, double p[3]) {
  move_length(by, p);
  store(p, vec3_add(vec3_of(p), by->shift));
}

static void move_light(const motion *by, hl_light *light, double (*vertices)[3]) {
  move_direction(by, light->direction);
  move_direction(by, light->normal);
  move_direction(by, light->emission.up);
  move_point(by, light->position);
  move_length(by, light->edge1);
  move_length(by, light->edge2);
  light->radius *= by->scale;
  if (light->falloff == HL_FALLOFF_INVERSE_SQUARE) light->intensity *= by->scale * by->scale;
  for (size_t v = 0; v < light->vertex_count; v++) {
    memcpy(vertices[v], light->vertices[v], sizeof vertices[v]);
    move_point(by, vertices[v]);
  }
  if (light->vertex_count > 0) light->vertices = (const double(*)[3])vertices;
  move_point(by, light->texture.screen_center);
  move_length(by, light->texture.screen_right);
  move_length(by, light->texture.screen_up);
}

/* Finds the axis and the angle of a rotation R (derived from Rodrigues's formula). The axis is the longest
 * column of R + R' + (1 - trace) I. The component of R - R' along the axis gives the sine of the angle. */
static void axis_of_rotation(mat3 r, double axis[3], double *angle_deg) {
  double trace = r.row[0].x + r.row[1].y + r.row[2].z;
  vec3 rest = {r.row[2].y - r.row[1].z, r.row[0].z - r.row[2].x, r.row[1].x - r.row[0].y},
       longest = {0, 0, 0};
  for (int column = 0; column < 3; column++) {
    vec3 unit = {column == 0, column == 1, column == 2};
    vec3 along = vec3_add(mat3_column(r, column), r.row[column]);
    along = vec3_add(along, vec3_scale(unit, 1 - trace));
    if (vec3_length(along) > vec3_length(longest)) longest = along;
  }
  if (!(vec3_length(longest) > 0)) longest = (vec3){0, 0, 1};
  longest = vec3_normalise(longest);
  store(axis, longest);
  *angle_deg = atan2(vec3_dot(rest, longest), trace - 1) * 180 / HL_PI;
}

/* The composed transform: by * (scale R p + t) = (by.scale scale) (by.turn R) p + (by.scale by.turn t +
 * by.shift). */
static void move_transform(const motion *by, hl_scene_volume *volume) {
  mat3 turn = NO_TURN;
  if (volume->rotate_angle_deg != 0)
    turn = mat3_rotation(vec3_normalise(vec3_of(volume->rotate_axis)),
                         volume->rotate_angle_deg * HL_PI / 180);
  axis_of_rotation(mat3_multiply(by->turn, turn), volume->rotate_axis, &volume->rotate_angle_deg);
  volume->scale *= by->scale;
  move_point(by, volume->translate);
}

static void move_axes(hl_context *context, const motion *by, hl_scene_volume *volume) {
  static const hl_voxel_type types[] = {HL_VOXEL_U8, HL_VOXEL_U16, HL_VOXEL_F32};
  const hl_volume *old = volume->volume;
  hl_volume_description description;
  hl_volume *moved = NULL;
  hl_error error = {0};
  affine3 place = affine3_multiply((affine3){by->turn, {0, 0, 0}}, hl_scene_volume_index_to_world(volume));
  hl_volume_description_defaults(&description);
  memcpy(description.dimensions, old->dimension, sizeof description.dimensions);
  description.type = types[old->storage];
  description.voxels = old->voxels;
  description.value_scale = old->value_scale;
  description.value_offset = old->value_offset;
  for (int a = 0; a < 3; a++) store(description.axis[a], vec3_scale(mat3_column(place.linear, a), by->scale));
  store(description.origin, vec3_add(vec3_scale(place.offset, by->scale), by->shift));
  if (hl_volume_create(context, &description, &moved, &error) != HL_OK) fail_msg("%s", error.message);
  hl_volume_release(volume->volume);
  volume->volume = moved;
  volume->scale = 1;
  volume->rotate_angle_deg = 0;
  memset(volume->translate, 0, sizeof volume->translate);
}

/* Adapts gradients, which are data units per world unit. points: memory for the volume's gradient opacity.
 * This memory must last until the scene is created, because the scene copies the points. */
static void move_gradients(const motion *by, hl_transfer_function *function, hl_opacity_point points[4]) {
  if (function->plane.second == HL_SECOND_GRADIENT)
    function->plane.second_scale = by->scale * hl_plane_second_scale(&function->plane);
  assert_true(function->gradient_opacity_count <= 4);
  if (function->gradient_opacity_count == 0) return;
  for (size_t p = 0; p < function->gradient_opacity_count; p++) {
    points[p] = function->gradient_opacity[p];
    points[p].value /= by->scale;
  }
  function->gradient_opacity = points;
}

void stage_move(stage *set, const motion *by, int by_transform, double (*vertices)[3]) {
  static hl_opacity_point gradients[sizeof set->volumes / sizeof *set->volumes][4];
  move_point(by, set->scene.camera.position);
  move_point(by, set->scene.camera.target);
  move_direction(by, set->scene.camera.up);
  set->scene.camera.height *= by->scale;
  for (size_t l = 0; l < set->scene.light_count; l++) {
    move_light(by, &set->lights[l], vertices);
    vertices += set->lights[l].vertex_count;
  }
  for (size_t v = 0; v < set->scene.volume_count; v++) {
    hl_scene_volume *volume = &set->volumes[v];
    volume->transfer_function.unit_distance *= by->scale;
    move_gradients(by, &volume->transfer_function, gradients[v]);
    /* clip boxes and cuts follow a volume's transform, and not its axes */
    bool cut = volume->clipped || volume->cut_count > 0;
    if (cut || (by_transform && determinant(by->turn) > 0)) move_transform(by, volume);
    else move_axes(set->context, by, volume);
  }
}
