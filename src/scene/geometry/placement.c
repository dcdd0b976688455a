/* scene/geometry/placement.c - finds where a scene's volumes lie in the world, which parts of them remain
 * after clipping, and the value of the empty space around them. */
#include "scene/geometry/placement.h"

#include <string.h>

#include "core/door.h"
#include "core/memory.h"
#include "mesh/mesh.h"
#include "scene/function/transfer_function.h"
#include "scene/geometry/camera.h"
#include "text/units.h"

double hl_scene_volume_scale(const hl_scene_volume *volume, int axis) {
  return volume->scale * volume->axis_scale[axis];
}

static mat3 rotation(const double axis[3], double angle_deg) {
  if (angle_deg == 0) return (mat3){{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  return mat3_rotation(vec3_normalise(vec3_of(axis)), angle_deg * HL_PI / 180);
}

affine3 hl_scene_mesh_to_world(const hl_scene_mesh *mesh) {
  mat3 turn = rotation(mesh->rotate_axis, mesh->rotate_angle_deg);
  for (int r = 0; r < 3; r++) turn.row[r] = vec3_scale(turn.row[r], mesh->scale);
  return (affine3){turn, vec3_of(mesh->translate)};
}

affine3 hl_scene_volume_file_to_world(const hl_scene_volume *volume) {
  mat3 turn = rotation(volume->rotate_axis, volume->rotate_angle_deg);
  const double x = hl_scene_volume_scale(volume, 0), y = hl_scene_volume_scale(volume, 1),
               z = hl_scene_volume_scale(volume, 2);
  for (int r = 0; r < 3; r++) turn.row[r] = (vec3){turn.row[r].x * x, turn.row[r].y * y, turn.row[r].z * z};
  return (affine3){turn, vec3_of(volume->translate)};
}

affine3 hl_scene_volume_index_to_world(const hl_scene_volume *volume) {
  return affine3_multiply(hl_scene_volume_file_to_world(volume), volume->volume->index_to_world);
}

void hl_scene_volume_place_point(const hl_scene_volume *volume, double point[3]) {
  HL_DOOR;
  if (volume == NULL || point == NULL) return;
  vec3 placed = affine3_apply(hl_scene_volume_file_to_world(volume), vec3_of(point));
  memcpy(point, (const double[3]){placed.x, placed.y, placed.z}, sizeof(double[3]));
}

/* The lengths of the mask's file are converted to the unit of the volume's file. */
affine3 hl_scene_mask_index_to_world(const hl_scene_volume *volume) {
  const hl_volume *mask = volume->mask.volume;
  const double unit = hl_unit_ratio(mask->unit, volume->volume->unit);
  affine3 in_file = mask->index_to_world;
  if (unit != 1) {
    for (int r = 0; r < 3; r++) in_file.linear.row[r] = vec3_scale(in_file.linear.row[r], unit);
    in_file.offset = vec3_scale(in_file.offset, unit);
  }
  return affine3_multiply(hl_scene_volume_file_to_world(volume), in_file);
}

/* Finds the bounds, in index space, of a volume's clip box, whose corners are in the world of the volume's
 * file. */
static void clip_bounds(const hl_scene_volume *volume, affine3 world_to_index, double low[3],
                        double high[3]) {
  for (int a = 0; a < 3; a++) low[a] = INFINITY, high[a] = -INFINITY;
  for (int corner = 0; corner < 8; corner++) {
    vec3 world = {corner & 1 ? volume->clip_max[0] : volume->clip_min[0],
                  corner & 2 ? volume->clip_max[1] : volume->clip_min[1],
                  corner & 4 ? volume->clip_max[2] : volume->clip_min[2]};
    vec3 index = affine3_apply(world_to_index, world);
    double coordinate[3] = {index.x, index.y, index.z};
    for (int a = 0; a < 3; a++) {
      low[a] = fmin(low[a], coordinate[a]);
      high[a] = fmax(high[a], coordinate[a]);
    }
  }
}

void hl_scene_volume_box(const hl_scene_volume *volume, double low[3], double high[3]) {
  affine3 world_to_index;
  for (int a = 0; a < 3; a++) {
    low[a] = -0.5;
    high[a] = (double)volume->volume->dimension[a] - 0.5;
  }
  if (!volume->clipped || !affine3_invert(volume->volume->index_to_world, &world_to_index)) return;
  double clip_low[3], clip_high[3];
  clip_bounds(volume, world_to_index, clip_low, clip_high);
  for (int a = 0; a < 3; a++) {
    double full_high = high[a];
    low[a] = fmin(fmax(low[a], clip_low[a]), full_high);
    high[a] = fmax(fmin(full_high, clip_high[a]), low[a]);
  }
}

/* Finds a value that stands for a bin of the histogram, and that voxels can have. In volumes of integers, the
 * stored number of this value is whole. In the outermost bins, the value is the volume's least or greatest
 * value. */
static double typical_value(const hl_volume *volume, int bin) {
  double width = (volume->maximum - volume->minimum) / HL_HISTOGRAM_BINS;
  if (bin == 0) return volume->minimum;
  if (bin == HL_HISTOGRAM_BINS - 1) return volume->maximum;
  double value = volume->minimum + (bin + 0.5) * width;
  if (volume->storage == HL_STORAGE_F32) return value;
  double stored = round((value - volume->value_offset) / volume->value_scale);
  double whole = volume->value_scale * stored + volume->value_offset;
  return fabs(whole - value) <= 0.5 * width ? whole : value;
}

double hl_scene_volume_empty_value(const hl_scene_volume *volume) {
  const hl_volume *v = volume->volume;
  if (v->has_surroundings) return v->surroundings;
  double width = (v->maximum - v->minimum) / HL_HISTOGRAM_BINS, empty = 0;
  bool found = false;
  uint64_t most = 0;
  for (int bin = 0; bin < HL_HISTOGRAM_BINS; bin++) {
    if (found && v->histogram[bin] <= most) continue;
    double low = v->minimum + bin * width, high = bin == HL_HISTOGRAM_BINS - 1 ? v->maximum : low + width,
           value;
    if (!hl_transfer_function_transparent(&volume->transfer_function, low, high, typical_value(v, bin),
                                          &value))
      continue;
    found = true;
    most = v->histogram[bin];
    empty = value;
  }
  if (found) return empty;
  double range = v->maximum - v->minimum;
  return v->minimum - (range > 0 ? range : fmax(1, fabs(v->minimum)));
}

static void grow_box(vec3 *low, vec3 *high, vec3 p) {
  *low = (vec3){fmin(low->x, p.x), fmin(low->y, p.y), fmin(low->z, p.z)};
  *high = (vec3){fmax(high->x, p.x), fmax(high->y, p.y), fmax(high->z, p.z)};
}

/* Finds the box around all meshes of a scene. */
static void box_of_meshes(const hl_scene_description *scene, vec3 *low, vec3 *high) {
  *low = (vec3){INFINITY, INFINITY, INFINITY}, *high = vec3_scale(*low, -1);
  for (size_t i = 0; i < scene->mesh_count; i++) {
    const hl_mesh *mesh = scene->meshes[i].mesh;
    affine3 placement = hl_scene_mesh_to_world(&scene->meshes[i]);
    for (int corner = 0; corner < 8; corner++)
      grow_box(low, high,
               affine3_apply(placement, (vec3){corner & 1 ? mesh->high[0] : mesh->low[0],
                                               corner & 2 ? mesh->high[1] : mesh->low[1],
                                               corner & 4 ? mesh->high[2] : mesh->low[2]}));
  }
}

double hl_scene_smallest_edge(const hl_scene_description *scene) {
  enum { SHEETS_ACROSS_MESHES = 200 };
  double edge = INFINITY;
  for (size_t i = 0; i < scene->volume_count; i++)
    edge = fmin(edge, mat3_shortest_column(hl_scene_volume_index_to_world(&scene->volumes[i]).linear));
  if (scene->volume_count > 0) return edge;
  vec3 low, high;
  box_of_meshes(scene, &low, &high);
  double longest = fmax(high.x - low.x, fmax(high.y - low.y, high.z - low.z));
  return longest > 0 ? longest / SHEETS_ACROSS_MESHES : 1;
}

void hl_scene_content_box(const hl_scene_description *scene, vec3 *low, vec3 *high) {
  *low = (vec3){INFINITY, INFINITY, INFINITY}, *high = vec3_scale(*low, -1);
  if (scene->volume_count == 0) box_of_meshes(scene, low, high);
  for (size_t i = 0; i < scene->volume_count; i++) {
    affine3 placement = hl_scene_volume_index_to_world(&scene->volumes[i]);
    double box[2][3];
    hl_scene_volume_box(&scene->volumes[i], box[0], box[1]);
    for (int corner = 0; corner < 8; corner++) {
      vec3 p = affine3_apply(placement,
                             (vec3){box[corner & 1][0], box[corner >> 1 & 1][1], box[corner >> 2][2]});
      grow_box(low, high, p);
    }
  }
}

hl_frame_space hl_scene_frame_space(const hl_scene_description *scene) {
  int exponent;
  vec3 low, high;
  (void)frexp(hl_scene_smallest_edge(scene), &exponent);
  hl_scene_content_box(scene, &low, &high);
  return (hl_frame_space){vec3_scale(vec3_add(low, high), 0.5), ldexp(1, exponent - 1)};
}

/* ---- lights that move with the camera, converted to the world.
 *
 * The axes of such lights are right, up and towards the viewer, with the origin at the camera's target. */

typedef struct camera_axes {
  vec3 right, up, towards, origin;
} camera_axes;

static camera_axes axes_of(const hl_camera *camera) {
  camera_axes axes = {.origin = vec3_of(camera->target)};
  vec3 forward;
  hl_camera_basis(camera, &axes.right, &axes.up, &forward);
  axes.towards = vec3_scale(forward, -1);
  return axes;
}

static void turn(const camera_axes *axes, double v[3]) {
  vec3 world = vec3_add(vec3_add(vec3_scale(axes->right, v[0]), vec3_scale(axes->up, v[1])),
                        vec3_scale(axes->towards, v[2]));
  v[0] = world.x, v[1] = world.y, v[2] = world.z;
}

static void place(const camera_axes *axes, double point[3]) {
  turn(axes, point);
  point[0] += axes->origin.x, point[1] += axes->origin.y, point[2] += axes->origin.z;
}

vec3 hl_light_way(const hl_camera *camera, const hl_light *light) {
  double way[3];
  memcpy(way, light->direction, sizeof way);
  camera_axes axes = axes_of(camera);
  if (light->frame == HL_LIGHT_FRAME_CAMERA) turn(&axes, way);
  return vec3_of(way);
}

static void place_light(const camera_axes *axes, hl_light *light, double (*vertices)[3]) {
  turn(axes, light->direction);
  turn(axes, light->normal);
  turn(axes, light->edge1);
  turn(axes, light->edge2);
  place(axes, light->position);
  for (size_t v = 0; v < light->vertex_count; v++) place(axes, vertices[v]);
  place(axes, light->texture.screen_center);
  turn(axes, light->texture.screen_right);
  turn(axes, light->texture.screen_up);
  turn(axes, light->emission.up);
  light->frame = HL_LIGHT_FRAME_WORLD;
}

hl_status hl_lights_place(hl_context *context, const hl_scene_description *from, const sky_suns *suns,
                          hl_scene_description *to, hl_error *error) {
  size_t count = from->light_count + (size_t)suns->count;
  *to = *from;
  to->light_count = 0;
  to->lights = hl_allocate_zeroed(context, count, sizeof *to->lights);
  if (to->lights == NULL) return hl_fail_memory(error, count * sizeof *to->lights, "a scene's lights");
  camera_axes axes = axes_of(&from->camera);
  for (; to->light_count < from->light_count; to->light_count++) {
    const hl_light *given = &from->lights[to->light_count];
    hl_light *light = (hl_light *)&to->lights[to->light_count];
    double(*vertices)[3] = hl_allocate(context, given->vertex_count, sizeof *vertices);
    if (vertices == NULL)
      return hl_fail_memory(error, given->vertex_count * sizeof *vertices, "a light's vertices");
    if (given->vertex_count > 0) memcpy(vertices, given->vertices, given->vertex_count * sizeof *vertices);
    *light = *given;
    light->vertices = (const double(*)[3])vertices;
    if (light->frame == HL_LIGHT_FRAME_CAMERA) place_light(&axes, light, vertices);
  }
  for (int i = 0; i < suns->count; i++)
    *(hl_light *)&to->lights[to->light_count++] = hl_sun_light(&from->sky, &suns->suns[i]);
  to->sky.suns = suns->count > 0; /* if the sky has suns, the image without the suns' light is used */
  if (suns->count > 0) to->sky.pixels = suns->rest;
  return HL_OK;
}

void hl_placed_lights_release(hl_context *context, hl_scene_description *placed) {
  for (size_t l = 0; l < placed->light_count; l++) hl_release(context, (void *)placed->lights[l].vertices);
  hl_release(context, (void *)placed->lights);
}

const hl_scene_volume *hl_scene_volume_named(const hl_scene_description *scene, const char *name) {
  for (size_t v = 0; v < scene->volume_count; v++)
    if (scene->volumes[v].name != NULL && strcmp(scene->volumes[v].name, name) == 0)
      return &scene->volumes[v];
  return NULL;
}
