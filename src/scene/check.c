/* scene/check.c - is a description possible?
 *
 * In: a description that nobody has looked at yet. Out: HL_OK, or the first fault as one line: the JSON
 * pointer of the field, the bad value and the mend. hl_scene_create() asks before it copies anything, so
 * the renderers downstream never meet a NaN, a zero direction or an unknown enumerator.
 */
#include "scene/check.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "core/error.h"
#include "core/vector.h"
#include "scene/light_shape.h"
#include "scene/scene.h"

/* Where we are: "/lights/3". */
typedef struct checker {
  hl_error *error;
  char place[80];
} checker;

static hl_status refuse(const checker *check, const char *key, const char *problem) {
  return hl_fail(check->error, HL_ERROR_INPUT, "%s/%s: %s", check->place, key, problem);
}

static hl_status check_range(const checker *check, const char *key, double value, double low, double high,
                             const char *mend) {
  if (value >= low && value <= high) return HL_OK; /* a NaN fails */
  const char *problem = isnan(value)            ? "is not a number"
                        : value < 0 && low == 0 ? "is negative"
                                                : "is out of range";
  return hl_fail(check->error, HL_ERROR_INPUT, "%s/%s: %.9g %s: %s", check->place, key, value, problem, mend);
}

/* low < value: for lengths and angles that must not vanish. */
static hl_status check_positive(const checker *check, const char *key, double value, double high,
                                const char *mend) {
  if (value > 0 && value <= high) return HL_OK;
  const char *problem = isnan(value) ? "is not a number" : value <= 0 ? "is not above 0" : "is out of range";
  return hl_fail(check->error, HL_ERROR_INPUT, "%s/%s: %.9g %s: %s", check->place, key, value, problem, mend);
}

static hl_status check_choice(const checker *check, const char *key, int value, int low, int high) {
  if (value >= low && value <= high) return HL_OK;
  return hl_fail(check->error, HL_ERROR_INPUT, "%s/%s: %d is no known choice: use the enumerators of scene.h",
                 check->place, key, value);
}

static hl_status check_vector(const checker *check, const char *key, const double v[3], double low,
                              double high, const char *mend) {
  for (int a = 0; a < 3; a++) {
    char element[48];
    snprintf(element, sizeof element, "%s/%d", key, a);
    hl_status status = check_range(check, element, v[a], low, high, mend);
    if (status != HL_OK) return status;
  }
  return HL_OK;
}

static hl_status check_point(const checker *check, const char *key, const double v[3]) {
  return check_vector(check, key, v, -HL_LIMIT_LENGTH, HL_LIMIT_LENGTH,
                      "give a coordinate between -1e15 and 1e15");
}

static hl_status check_direction(const checker *check, const char *key, const double v[3]) {
  hl_status status = check_point(check, key, v);
  if (status != HL_OK) return status;
  double length = vec3_length(vec3_of(v));
  if (length >= 1e-100) return HL_OK;
  return refuse(check, key,
                length > 0 ? "is too short to have a direction: give a vector of about unit length"
                           : "has no length: give the direction as three numbers, not all 0");
}

static hl_status check_image(const hl_scene_description *d, hl_error *error) {
  checker check = {error, "/image"};
  hl_status status;
  const char *mend = "give a number of pixels from 1 to 32768";
  if ((status = check_range(&check, "width", d->width, 1, HL_LIMIT_PIXELS, mend)) != HL_OK) return status;
  if ((status = check_range(&check, "height", d->height, 1, HL_LIMIT_PIXELS, mend)) != HL_OK) return status;
  if ((status = check_vector(&check, "background", d->background, 0, 1,
                             "give linear RGB, each from 0 to 1")) != HL_OK)
    return status;
  return check_range(&check, "exposure", d->exposure, -HL_LIMIT_EXPOSURE, HL_LIMIT_EXPOSURE,
                     "give stops from -32 to 32: each doubles the light");
}

static hl_status check_camera(const hl_camera *camera, hl_error *error) {
  checker check = {error, "/camera"};
  hl_status status;
  if ((status = check_choice(&check, "type", (int)camera->type, 0, HL_CAMERA_ORTHOGRAPHIC)) != HL_OK)
    return status;
  if ((status = check_point(&check, "position", camera->position)) != HL_OK) return status;
  if ((status = check_point(&check, "target", camera->target)) != HL_OK) return status;
  if ((status = check_direction(&check, "up", camera->up)) != HL_OK) return status;
  vec3 position = vec3_of(camera->position), target = vec3_of(camera->target);
  double distance = vec3_length(vec3_subtract(target, position));
  double size = fmax(vec3_length(position), vec3_length(target));
  if (!(distance > 1e-12 * size) || distance < 1e-100)
    return refuse(&check, "target",
                  "is where the eye is: move the target or the position, so that there is a line of sight");
  if (camera->type == HL_CAMERA_PERSPECTIVE)
    return check_range(&check, "fovy_deg", camera->fovy_deg, 1e-6, 179.999,
                       "give an angle in degrees, above 0 and below 180");
  return check_positive(&check, "height", camera->height, HL_LIMIT_LENGTH,
                        "give the picture's height in world units, above 0");
}

static hl_status check_count(const checker *check, const char *key, const void *points, size_t count,
                             size_t limit) {
  if (count > 0 && points == NULL)
    return hl_fail(check->error, HL_ERROR_ARGUMENT, "%s/%s: is null but its count is %zu", check->place, key,
                   count);
  if (count > limit)
    return hl_fail(check->error, HL_ERROR_INPUT, "%s/%s: has %zu entries: at most %zu are allowed",
                   check->place, key, count, limit);
  return HL_OK;
}

static hl_status check_radius(const checker *check, const hl_light *light) {
  return check_range(check, "radius", light->radius, 0, HL_LIMIT_LENGTH,
                     "give a length in world units, 0 for a point");
}

static hl_status check_directional(const checker *check, const hl_light *light) {
  hl_status status = check_direction(check, "direction", light->direction);
  if (status != HL_OK) return status;
  if (light->falloff != HL_FALLOFF_NONE)
    return refuse(
        check, "falloff",
        "inverse_square on a directional light, which is infinitely far: use none, or a point light");
  return check_range(check, "angular_diameter_deg", light->angular_diameter_deg, 0, 120,
                     "give an angle in degrees from 0 (a sharp light) to 120");
}

/* Edges of no length are allowed: a line of light, or a point. */
static hl_status check_rect(const checker *check, const hl_light *light) {
  hl_status status = check_point(check, "position", light->position);
  if (status == HL_OK) status = check_point(check, "edge1", light->edge1);
  return status == HL_OK ? check_point(check, "edge2", light->edge2) : status;
}

static hl_status check_disk(const checker *check, const hl_light *light) {
  hl_status status = check_point(check, "position", light->position);
  if (status == HL_OK) status = check_direction(check, "normal", light->normal);
  return status == HL_OK ? check_radius(check, light) : status;
}

/* Parts of the polygon's diameter: how far its vertices may leave its plane, and the least width. */
static const double FLAT = 1e-3, THIN = 1e-6;

static hl_status check_polygon(const checker *check, const hl_light *light) {
  hl_status status = check_count(check, "vertices", light->vertices, light->vertex_count, HL_LIMIT_VERTICES);
  if (status != HL_OK) return status;
  if (light->vertex_count < 3)
    return hl_fail(check->error, HL_ERROR_INPUT, "%s/vertices: has %zu entries: give three points or more",
                   check->place, light->vertex_count);
  for (size_t v = 0; v < light->vertex_count; v++) {
    char element[32];
    snprintf(element, sizeof element, "vertices/%zu", v);
    if ((status = check_point(check, element, light->vertices[v])) != HL_OK) return status;
  }
  polygon_shape shape = hl_polygon_shape(light->vertices, light->vertex_count);
  if (!(shape.area > THIN * shape.diameter * shape.diameter))
    return refuse(check, "vertices",
                  "span no area: move one off the line, or use a rect light with an edge of no length");
  if (hl_polygon_unevenness(&shape, light->vertices, light->vertex_count) > FLAT * shape.diameter)
    return refuse(check, "vertices", "do not lie in one plane: move them, or use several lights");
  if (hl_polygon_crosses_itself(&shape, light->vertices, light->vertex_count))
    return refuse(check, "vertices",
                  "go around an outline that crosses itself: give them in order around it");
  return HL_OK;
}

static hl_status check_spot(const checker *check, const hl_light *light) {
  hl_status status = check_point(check, "position", light->position);
  if (status == HL_OK) status = check_direction(check, "direction", light->direction);
  if (status == HL_OK)
    status = check_range(check, "opening_angle_deg", light->opening_angle_deg, 0.01, 179,
                         "give the cone's full angle in degrees, from 0.01 to 179");
  if (status == HL_OK)
    status = check_range(
        check, "falloff_angle_deg", light->falloff_angle_deg, 0, light->opening_angle_deg / 2,
        "give the width of the cone's smooth edge in degrees, from 0 to half the opening angle");
  return status == HL_OK ? check_radius(check, light) : status;
}

static hl_status check_light_place(const checker *check, const hl_light *light) {
  switch (light->type) {
    case HL_LIGHT_DIRECTIONAL: return check_directional(check, light);
    case HL_LIGHT_RECT: return check_rect(check, light);
    case HL_LIGHT_DISK: return check_disk(check, light);
    case HL_LIGHT_POLYGON: return check_polygon(check, light);
    case HL_LIGHT_SPOT: return check_spot(check, light);
    case HL_LIGHT_POINT: break;
  }
  hl_status status = check_point(check, "position", light->position);
  return status == HL_OK ? check_radius(check, light) : status;
}

/* [height][width][3] */
static hl_status check_pixels(const checker *check, const float *pixels, int width, int height) {
  const char *size = "give an image of at most 32768 pixels a side, 67108864 in all";
  hl_status status;
  if ((status = check_range(check, "width", width, 1, HL_LIMIT_TEXTURE_SIDE, size)) != HL_OK) return status;
  if ((status = check_range(check, "height", height, 1, HL_LIMIT_TEXTURE_SIDE, size)) != HL_OK) return status;
  size_t count = (size_t)width * (size_t)height;
  if (count > HL_LIMIT_TEXTURE_PIXELS)
    return hl_fail(check->error, HL_ERROR_INPUT, "%s: has %d x %d pixels: %s", check->place, width, height,
                   size);
  for (size_t i = 0; i < 3 * count; i++)
    if (!(pixels[i] >= 0 && (double)pixels[i] <= HL_LIMIT_TEXTURE_VALUE))
      return hl_fail(check->error, HL_ERROR_INPUT,
                     "%s/file: pixel (%zu, %zu) has %.9g in channel %zu: give linear RGB from 0 to 1e6",
                     check->place, i / 3 % (size_t)width, i / 3 / (size_t)width, (double)pixels[i], i % 3);
  return HL_OK;
}

/* The light's rays must cross the screen. */
static hl_status check_texture(const checker *parent, const hl_light *light) {
  const hl_light_texture *texture = &light->texture;
  checker check = {parent->error, ""};
  hl_status status;
  if (texture->pixels == NULL) return HL_OK;
  snprintf(check.place, sizeof check.place, "%s/texture", parent->place);
  if ((status = check_pixels(&check, texture->pixels, texture->width, texture->height)) != HL_OK)
    return status;
  if ((status = check_point(&check, "screen/center", texture->screen_center)) != HL_OK) return status;
  if ((status = check_direction(&check, "screen/right", texture->screen_right)) != HL_OK) return status;
  if ((status = check_direction(&check, "screen/up", texture->screen_up)) != HL_OK) return status;
  vec3 right = vec3_normalise(vec3_of(texture->screen_right)),
       up = vec3_normalise(vec3_of(texture->screen_up));
  vec3 normal = vec3_cross(right, up), center = vec3_of(texture->screen_center);
  if (!(vec3_length(normal) > 1e-4))
    return refuse(&check, "screen/up", "lies along right: give two directions that span the screen");
  vec3 way = light->type == HL_LIGHT_DIRECTIONAL ? vec3_of(light->direction)
                                                 : vec3_subtract(center, hl_light_centre(light));
  if (!(fabs(vec3_dot(vec3_normalise(normal), vec3_normalise(way))) > 1e-4))
    return refuse(&check, "screen/center",
                  "the light's rays run along the screen, not through it: turn or move the screen");
  return HL_OK;
}

/* There must be a surface for the image to be on. */
static hl_status check_emission(const checker *parent, const hl_light *light) {
  const hl_light_emission *emission = &light->emission;
  checker check = {parent->error, ""};
  hl_status status;
  if (emission->pixels == NULL) return HL_OK;
  snprintf(check.place, sizeof check.place, "%s/emission", parent->place);
  if ((status = check_pixels(&check, emission->pixels, emission->width, emission->height)) != HL_OK)
    return status;
  if ((status = check_direction(&check, "up", emission->up)) != HL_OK) return status;
  if (light->texture.pixels != NULL)
    return refuse(parent, "emission",
                  "is beside a texture: a light has an image of its own or projects one, use two lights");
  bool flat = light->type == HL_LIGHT_DIRECTIONAL ? !(light->angular_diameter_deg > 0) : !(light->radius > 0);
  if (light->type == HL_LIGHT_POLYGON) flat = false;
  if (light->type == HL_LIGHT_RECT) {
    vec3 edge1 = vec3_of(light->edge1), edge2 = vec3_of(light->edge2);
    flat = !(vec3_length(vec3_cross(edge1, edge2)) > THIN * vec3_length(edge1) * vec3_length(edge2));
  }
  if (flat)
    return refuse(parent, "emission",
                  "is on a light without a surface: give it a radius, an angle or two edges");
  return HL_OK;
}

static hl_status check_light(const hl_light *light, size_t index, hl_error *error) {
  checker check = {error, ""};
  snprintf(check.place, sizeof check.place, "/lights/%zu", index);
  hl_status status;
  if ((status = check_choice(&check, "type", (int)light->type, 0, HL_LIGHT_POLYGON)) != HL_OK) return status;
  if ((status = check_choice(&check, "frame", (int)light->frame, 0, HL_LIGHT_FRAME_CAMERA)) != HL_OK)
    return status;
  if ((status = check_choice(&check, "falloff", (int)light->falloff, 0, HL_FALLOFF_INVERSE_SQUARE)) != HL_OK)
    return status;
  if ((status = check_choice(&check, "shadows", (int)light->shadows, 0, HL_SHADOWS_SOFT)) != HL_OK)
    return status;
  if ((status = check_light_place(&check, light)) != HL_OK) return status;
  if ((status = check_vector(&check, "color", light->color, 0, HL_LIMIT_LENGTH,
                             "give linear RGB, none below 0")) != HL_OK)
    return status;
  if ((status = check_texture(&check, light)) != HL_OK) return status;
  if ((status = check_emission(&check, light)) != HL_OK) return status;
  return check_range(&check, "intensity", light->intensity, 0, HL_LIMIT_INTENSITY,
                     "give a factor, 0 or more");
}

/* Sorted, and at most two points at one value: two make a step. */
static hl_status check_order(const checker *check, const char *key, size_t index, double before2,
                             double before, double value) {
  if (value < before)
    return hl_fail(check->error, HL_ERROR_INPUT,
                   "%s/%s/%zu/0: %.9g comes after %.9g: sort the points by value", check->place, key, index,
                   value, before);
  if (index >= 2 && value == before && before == before2)
    return hl_fail(
        check->error, HL_ERROR_INPUT,
        "%s/%s/%zu/0: %.9g is there a third time: two points at one value make a step, remove the others",
        check->place, key, index, value);
  return HL_OK;
}

static hl_status check_value(const checker *check, const char *key, size_t index, double value) {
  char element[48];
  snprintf(element, sizeof element, "%s/%zu/0", key, index);
  return check_range(check, element, value, -1e30, 1e30, "give a data value between -1e30 and 1e30");
}

static hl_status check_opacity_points(const checker *check, const hl_transfer_function *function) {
  hl_status status = check_count(check, "opacity", function->opacity, function->opacity_count,
                                 HL_LIMIT_POINTS);
  for (size_t p = 0; status == HL_OK && p < function->opacity_count; p++) {
    const hl_opacity_point *point = &function->opacity[p];
    char element[48];
    snprintf(element, sizeof element, "opacity/%zu/1", p);
    if ((status = check_value(check, "opacity", p, point->value)) != HL_OK) return status;
    if (p > 0)
      status = check_order(check, "opacity", p, p > 1 ? point[-2].value : 0, point[-1].value, point->value);
    if (status == HL_OK)
      status = check_range(check, element, point->opacity, 0, 1, "give an opacity from 0 to 1");
  }
  return status;
}

static hl_status check_color_points(const checker *check, const hl_transfer_function *function) {
  hl_status status = check_count(check, "color", function->color, function->color_count, HL_LIMIT_POINTS);
  for (size_t p = 0; status == HL_OK && p < function->color_count; p++) {
    const hl_color_point *point = &function->color[p];
    if ((status = check_value(check, "color", p, point->value)) != HL_OK) return status;
    if (p > 0)
      status = check_order(check, "color", p, p > 1 ? point[-2].value : 0, point[-1].value, point->value);
    for (int channel = 0; status == HL_OK && channel < 3; channel++) {
      char element[48];
      snprintf(element, sizeof element, "color/%zu/%d", p, channel + 1);
      status = check_range(check, element, point->color[channel], 0, 1, "give linear RGB, each from 0 to 1");
    }
  }
  return status;
}

hl_status hl_transfer_function_check(const hl_transfer_function *function, const char *place,
                                     hl_error *error) {
  checker check = {error, ""};
  snprintf(check.place, sizeof check.place, "%s", place);
  hl_status status = check_positive(&check, "unit_distance", function->unit_distance, HL_LIMIT_LENGTH,
                                    "give the length in world units that the opacities are for, above 0");
  if (status == HL_OK) status = check_opacity_points(&check, function);
  return status == HL_OK ? check_color_points(&check, function) : status;
}

/* One factor, or three of which each is told. */
static hl_status check_scale(const checker *check, const hl_scene_volume *volume) {
  const double *axis = volume->axis_scale;
  const char *mend = "give a factor above 0";
  hl_status status = check_positive(check, "scale", volume->scale, HL_LIMIT_LENGTH, mend);
  for (int a = 0; a < 3 && status == HL_OK && (axis[0] != 1 || axis[1] != 1 || axis[2] != 1); a++) {
    char element[16];
    snprintf(element, sizeof element, "scale/%d", a);
    status = check_positive(check, element, hl_scene_volume_scale(volume, a), HL_LIMIT_LENGTH, mend);
  }
  return status;
}

static hl_status check_transform(const hl_scene_volume *volume, const char *parent, hl_error *error) {
  checker check = {error, ""};
  snprintf(check.place, sizeof check.place, "%s/transform", parent);
  hl_status status = check_scale(&check, volume);
  if (status != HL_OK) return status;
  if (volume->rotate_angle_deg != 0 &&
      (status = check_direction(&check, "rotate/axis", volume->rotate_axis)) != HL_OK)
    return status;
  if ((status = check_range(&check, "rotate/angle_deg", volume->rotate_angle_deg, -1e6, 1e6,
                            "give an angle in degrees")) != HL_OK)
    return status;
  return check_point(&check, "translate", volume->translate);
}

static hl_status check_material(const hl_material *material, const char *parent, hl_error *error) {
  checker check = {error, ""};
  snprintf(check.place, sizeof check.place, "%s/material", parent);
  const char *mend = "give a factor from 0 to 1000";
  hl_status status;
  if ((status = check_range(&check, "ambient", material->ambient, 0, 1000, mend)) != HL_OK) return status;
  if ((status = check_range(&check, "diffuse", material->diffuse, 0, 1000, mend)) != HL_OK) return status;
  if ((status = check_range(&check, "specular", material->specular, 0, 1000, mend)) != HL_OK) return status;
  if ((status = check_range(&check, "shininess", material->shininess, 0, HL_LIMIT_SHININESS,
                            "give an exponent from 0 to 10000")) != HL_OK)
    return status;
  return check_range(&check, "emission", material->emission, 0, HL_LIMIT_EMISSION,
                     "give the part of the colour that shines by itself, from 0 to 1e6");
}

static hl_status check_clip(const hl_scene_volume *volume, const char *parent, hl_error *error) {
  checker check = {error, ""};
  snprintf(check.place, sizeof check.place, "%s/clip", parent);
  hl_status status;
  if (!volume->clipped) return HL_OK;
  if ((status = check_point(&check, "min", volume->clip_min)) != HL_OK) return status;
  if ((status = check_point(&check, "max", volume->clip_max)) != HL_OK) return status;
  for (int a = 0; a < 3; a++)
    if (volume->clip_min[a] >= volume->clip_max[a])
      return hl_fail(error, HL_ERROR_INPUT,
                     "%s/max/%d: %.9g is not above min, %.9g: nothing would be left, enlarge the box",
                     check.place, a, volume->clip_max[a], volume->clip_min[a]);
  return HL_OK;
}

static double farthest_corner(const hl_scene_volume *volume, affine3 placement) {
  double farthest = 0;
  for (int corner = 0; corner < 8; corner++) {
    vec3 index;
    index.x = corner & 1 ? (double)volume->volume->dimension[0] : 0;
    index.y = corner & 2 ? (double)volume->volume->dimension[1] : 0;
    index.z = corner & 4 ? (double)volume->volume->dimension[2] : 0;
    farthest = fmax(farthest, vec3_length(affine3_apply(placement, index)));
  }
  return farthest;
}

/* The whole placement, since factors that are fine alone may vanish or overflow together. */
static hl_status check_placement(const checker *check, const hl_scene_volume *volume) {
  affine3 placement = hl_scene_volume_index_to_world(volume), inverse;
  for (int a = 0; a < 3; a++) {
    double edge = vec3_length(mat3_column(placement.linear, a));
    if (edge <= HL_LIMIT_LENGTH && edge >= 1 / HL_LIMIT_LENGTH) continue;
    const double *by_axis = volume->axis_scale;
    if (volume->scale != 1 || by_axis[0] != 1 || by_axis[1] != 1 || by_axis[2] != 1)
      return hl_fail(check->error, HL_ERROR_INPUT,
                     "%s/transform: makes the edges of voxels %.9g long: give a scale with which they are "
                     "from 1e-15 to 1e15",
                     check->place, edge);
    return hl_fail(check->error, HL_ERROR_INPUT,
                   "%s/file: its voxels are %.9g long, and can be from 1e-15 to 1e15: correct the "
                   "file's spacing, or give a transform.scale",
                   check->place, edge);
  }
  if (!(vec3_length(placement.offset) <= 1e3 * HL_LIMIT_LENGTH))
    return refuse(check, "transform",
                  "moves the volume too far away to compute with: use a shorter translate");
  double reach = farthest_corner(volume, placement);
  if (!(reach <= HL_LIMIT_CORNER))
    return hl_fail(check->error, HL_ERROR_INPUT,
                   "%s/file: reaches %.3g from the origin, and can reach as far as 1e14, so that a camera "
                   "may stand off: correct its "
                   "spacing and origin, or give a smaller transform.scale",
                   check->place, reach);
  if (!affine3_invert(placement, &inverse))
    return refuse(check, "file", "the volume's axes lie in one plane: mend its spacing or direction");
  return HL_OK;
}

/* Data values and, where they are kept as floats, stored ones. */
static hl_status check_values(const checker *check, const hl_volume *volume) {
  double greatest = fmax(fabs(volume->minimum), fabs(volume->maximum)), stored = 0;
  if (volume->storage == HL_STORAGE_F32)
    stored = (greatest + fabs(volume->value_offset)) / fabs(volume->value_scale);
  if (greatest <= HL_LIMIT_VOXEL_VALUE && stored <= HL_LIMIT_VOXEL_VALUE) return HL_OK;
  return hl_fail(check->error, HL_ERROR_INPUT,
                 "%s/file: its voxels reach %.3g, more than the 1e36 that pictures can be computed with: "
                 "scale them, and mark "
                 "missing ones by NaN",
                 check->place, fmax(greatest, stored));
}

hl_status hl_scene_volume_check(const hl_scene_volume *volume, size_t index, hl_error *error) {
  checker check = {error, ""};
  snprintf(check.place, sizeof check.place, "/volumes/%zu", index);
  hl_status status;
  if (volume->volume == NULL)
    return hl_fail(error, HL_ERROR_ARGUMENT, "%s/volume: is null: give a volume", check.place);
  if (volume->file != NULL && volume->shapes != NULL)
    return refuse(&check, "shapes", "and file exclude each other: the voxels came from one of them");
  if ((status = check_values(&check, volume->volume)) != HL_OK) return status;
  if ((status = check_transform(volume, check.place, error)) != HL_OK) return status;
  if ((status = check_placement(&check, volume)) != HL_OK) return status;
  char place[80];
  snprintf(place, sizeof place, "/volumes/%zu/transfer_function", index);
  if ((status = hl_transfer_function_check(&volume->transfer_function, place, error)) != HL_OK) return status;
  if ((status = check_choice(&check, "shading", (int)volume->shading, 0, HL_SHADING_FLAT)) != HL_OK)
    return status;
  if ((status = check_material(&volume->material, check.place, error)) != HL_OK) return status;
  if ((status = check_vector(
           &check, "attenuation_color", volume->attenuation_color, 0, 1000,
           "give relative extinctions from 0 to 1000, 1 for as much as the opacity says")) != HL_OK)
    return status;
  return check_clip(volume, check.place, error);
}

/* ---- what must fit together ---- */

/* A length or a distance that floats must hold beside voxels. */
static hl_status check_reach(const checker *check, const char *key, double length,
                             const hl_frame_space *space) {
  if (length <= HL_LIMIT_REACH * space->unit) return HL_OK;
  return hl_fail(check->error, HL_ERROR_INPUT,
                 "%s/%s: reaches %.3g from the volumes, whose smallest voxel edge is %.3g: "
                 "use at most 1e12 times that, or a directional light or orthographic camera",
                 check->place, key, length, space->unit);
}

static hl_status check_distance(const checker *check, const char *key, const double point[3],
                                const hl_frame_space *space) {
  return check_reach(check, key, vec3_length(vec3_subtract(vec3_of(point), space->centre)), space);
}

/* Derived: a light that falls with the square of the distance has intensity / d^2 at d. */
static hl_status check_brightness(const checker *check, const hl_light *light, const hl_frame_space *space) {
  double brightness = fmax(fmax(light->color[0], light->color[1]), light->color[2]) * light->intensity;
  if (light->falloff == HL_FALLOFF_INVERSE_SQUARE) brightness /= space->unit * space->unit;
  if (brightness <= HL_LIMIT_BRIGHTNESS) return HL_OK;
  return hl_fail(check->error, HL_ERROR_INPUT,
                 "%s/intensity: makes the light's color %.3g%s: use an intensity with which it is "
                 "at most 1e20",
                 check->place, brightness,
                 light->falloff == HL_FALLOFF_INVERSE_SQUARE ? " at the distance of a voxel's edge" : "");
}

/* In camera axes places are measured from the camera's target, which is within reach itself. */
static hl_status check_light_reach(const hl_light *light, size_t index, const hl_frame_space *world,
                                   hl_error *error) {
  const hl_frame_space beside = {{0, 0, 0}, world->unit},
                       *space = light->frame == HL_LIGHT_FRAME_CAMERA ? &beside : world;
  checker check = {error, ""};
  snprintf(check.place, sizeof check.place, "/lights/%zu", index);
  hl_status status = check_brightness(&check, light, space);
  bool placed = light->type != HL_LIGHT_DIRECTIONAL, rect = light->type == HL_LIGHT_RECT;
  if (status == HL_OK && placed && light->type != HL_LIGHT_POLYGON)
    status = check_distance(&check, "position", light->position, space);
  if (status == HL_OK && placed) status = check_reach(&check, "radius", light->radius, space);
  if (status == HL_OK && rect)
    status = check_reach(&check, "edge1", vec3_length(vec3_of(light->edge1)), space);
  if (status == HL_OK && rect)
    status = check_reach(&check, "edge2", vec3_length(vec3_of(light->edge2)), space);
  for (size_t v = 0; status == HL_OK && v < light->vertex_count && light->type == HL_LIGHT_POLYGON; v++)
    status = check_distance(&check, "vertices", light->vertices[v], space);
  if (status != HL_OK || light->texture.pixels == NULL) return status;
  status = check_distance(&check, "texture/screen/center", light->texture.screen_center, space);
  if (status == HL_OK)
    status = check_reach(&check, "texture/screen/right", vec3_length(vec3_of(light->texture.screen_right)),
                         space);
  if (status == HL_OK)
    status = check_reach(&check, "texture/screen/up", vec3_length(vec3_of(light->texture.screen_up)), space);
  return status;
}

static hl_status check_scales(const hl_scene_description *d, hl_error *error) {
  const hl_frame_space space = hl_scene_frame_space(d);
  checker camera = {error, "/camera"};
  hl_status status = check_distance(&camera, "position", d->camera.position, &space);
  for (size_t l = 0; status == HL_OK && l < d->light_count; l++)
    if (d->lights[l].frame == HL_LIGHT_FRAME_CAMERA)
      status = check_distance(&camera, "target", d->camera.target, &space);
  if (status == HL_OK && d->camera.type == HL_CAMERA_ORTHOGRAPHIC)
    status = check_reach(&camera, "height", d->camera.height, &space);
  for (size_t l = 0; status == HL_OK && l < d->light_count; l++)
    status = check_light_reach(&d->lights[l], l, &space, error);
  return status;
}

static hl_status check_render(const hl_render_settings *render, hl_error *error) {
  checker check = {error, "/render"};
  hl_status status;
  if ((status = check_choice(&check, "shadows", (int)render->shadows, HL_SHADOWS_OFF, HL_SHADOWS_SOFT)) !=
      HL_OK)
    return status;
  if ((status = check_choice(&check, "soft_method", (int)render->soft_method, 0, HL_SOFT_SUBLIGHTS)) != HL_OK)
    return status;
  if ((status = check_range(&check, "light_samples", render->light_samples, 1, HL_LIMIT_LIGHT_SAMPLES,
                            "give M from 1 to 64, for M x M parts of the light")) != HL_OK)
    return status;
  if ((status = check_range(&check, "sheet_spacing", render->sheet_spacing, HL_LIMIT_SHEET_SPACING_LOW,
                            HL_LIMIT_SHEET_SPACING_HIGH, "give voxels between sheets, from 0.01 to 100")) !=
      HL_OK)
    return status;
  if ((status = check_choice(&check, "kernel", (int)render->kernel, 0, HL_KERNEL_LINEAR)) != HL_OK)
    return status;
  if ((status = check_choice(&check, "reconstruction", (int)render->reconstruction, 0,
                             HL_RECONSTRUCTION_GATHER)) != HL_OK)
    return status;
  if ((status = check_choice(&check, "slicing", (int)render->slicing, 0, HL_SLICING_IMAGE_ALIGNED)) != HL_OK)
    return status;
  if ((status = check_choice(&check, "shadow_lookup", (int)render->shadow_lookup, 0, HL_LOOKUP_AUTO)) !=
      HL_OK)
    return status;
  if ((status = check_choice(&check, "compositing", (int)render->compositing, 0, HL_COMPOSITING_MAXIMUM)) !=
      HL_OK)
    return status;
  if ((status = check_range(&check, "shadow_resolution", render->shadow_resolution, 0,
                            HL_LIMIT_SHADOW_RESOLUTION, "give pixels from 1 to 16384, or auto")) != HL_OK)
    return status;
  return check_range(&check, "threads", render->threads, 0, HL_LIMIT_THREADS,
                     "give a number of threads up to 1024, 0 for one per processor");
}

hl_status hl_description_check(const hl_scene_description *d, hl_error *error) {
  checker root = {error, ""};
  hl_status status;
  if ((status = check_image(d, error)) != HL_OK) return status;
  if ((status = check_camera(&d->camera, error)) != HL_OK) return status;
  if ((status = check_vector(&root, "ambient", d->ambient, 0, HL_LIMIT_LENGTH,
                             "give linear RGB, none below 0")) != HL_OK)
    return status;
  if ((status = check_count(&root, "lights", d->lights, d->light_count, HL_LIMIT_LIGHTS)) != HL_OK)
    return status;
  if ((status = check_count(&root, "volumes", d->volumes, d->volume_count, HL_LIMIT_VOLUMES)) != HL_OK)
    return status;
  if (d->volume_count == 0) return refuse(&root, "volumes", "is empty: name at least one volume");
  for (size_t l = 0; l < d->light_count; l++)
    if ((status = check_light(&d->lights[l], l, error)) != HL_OK) return status;
  for (size_t v = 0; v < d->volume_count; v++)
    if ((status = hl_scene_volume_check(&d->volumes[v], v, error)) != HL_OK) return status;
  if ((status = check_scales(d, error)) != HL_OK) return status;
  return check_render(&d->render, error);
}

hl_status hl_layers_check(const hl_layers *layers, const hl_scene_description *scene, hl_error *error) {
  size_t light_count = scene->light_count;
  if (layers == NULL) return HL_OK;
  if (scene->render.compositing == HL_COMPOSITING_MAXIMUM)
    return hl_fail(
        error, HL_ERROR_UNSUPPORTED,
        "/render/compositing: a maximum projection has no layers: use \"light\", or ask for no layers");
  if (layers->struct_size != sizeof *layers)
    return hl_fail(error, HL_ERROR_ARGUMENT, "layers->struct_size is %zu, expected %zu", layers->struct_size,
                   sizeof *layers);
  if (layers->light_count != 0 && layers->light_count != light_count)
    return hl_fail(error, HL_ERROR_ARGUMENT,
                   "layers->light_count is %zu: the scene has %zu lights: give buffers for all "
                   "of them, null where none is wanted, or 0",
                   layers->light_count, light_count);
  if (layers->light_count != 0 && layers->lights == NULL)
    return hl_fail(error, HL_ERROR_ARGUMENT, "layers->lights is null, and light_count is %zu",
                   layers->light_count);
  return HL_OK;
}
