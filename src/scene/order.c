/* scene/order.c - finds the order in which frames use lights, volumes and meshes (order.h). Each light,
 * volume and mesh has a key, which contains its settings. Keys are compared byte by byte. */
#include "scene/order.h"

#include <string.h>

#include "core/key.h"
#include "core/memory.h"
#include "mesh/mesh.h"
#include "scene/function/function_plane.h"
#include "scene/geometry/placement.h"
#include "scene/settings.h"
#include "volume/store/gathered.h"
#include "volume/volume.h"

/* ---- lights ---- */

static void add_pixels(hl_key *key, const float *pixels, int width, int height) {
  const bool any = pixels != NULL;
  hl_key_add_whole(key, any ? width : 0);
  hl_key_add_whole(key, any ? height : 0);
  if (any)
    hl_key_add_whole(key, (int64_t)hl_key_mark(pixels, 3 * (size_t)width * (size_t)height * sizeof *pixels));
}

/* Writes the key by which a light is ordered. The key begins with the light's type and place. So the order
 * does not change when colours and intensities change. Among lights of one type, lights that shine from above
 * come first: sheets suit the first light best, and the main light of a scene mostly stands above. */
static void write_light(const void *data, hl_key *key) {
  const hl_light *light = data;
  hl_key_add_whole(key, light->type);
  hl_key_add_numbers(key, (double[]){light->direction[1], -light->position[1]}, 2);
  hl_key_add_numbers(key, light->direction, 3);
  hl_key_add_numbers(key, light->position, 3);
  hl_settings_key_add(HL_SETTINGS_LIGHT, light, light->type, key);
  hl_key_add_whole(key, (int64_t)light->vertex_count);
  if (light->vertex_count > 0) hl_key_add_numbers(key, &light->vertices[0][0], 3 * light->vertex_count);
  add_pixels(key, light->texture.pixels, light->texture.width, light->texture.height);
  hl_key_add_numbers(key, light->texture.screen_center, 3);
  hl_key_add_numbers(key, light->texture.screen_right, 3);
  hl_key_add_numbers(key, light->texture.screen_up, 3);
  add_pixels(key, light->emission.pixels, light->emission.width, light->emission.height);
  hl_key_add_numbers(key, light->emission.up, 3);
}

/* ---- volumes ---- */

/* Adds to a volume's key the properties of its voxels that are known without reading the voxels. */
static void add_voxels(hl_key *key, const hl_volume *volume) {
  for (int axis = 0; axis < 3; axis++) hl_key_add_whole(key, (int64_t)volume->dimension[axis]);
  hl_key_add_whole(key, volume->storage);
  hl_key_add_numbers(key, (double[]){volume->minimum, volume->maximum, volume->mean}, 3);
  hl_key_add(key, volume->histogram, sizeof volume->histogram);
}

static void add_points(hl_key *key, const hl_opacity_point *points, size_t count) {
  hl_key_add_whole(key, (int64_t)count);
  if (count > 0) hl_key_add(key, points, count * sizeof *points);
}

static void add_function(hl_key *key, const hl_transfer_function *function) {
  hl_settings_key_add(HL_SETTINGS_TRANSFER_FUNCTION, function, 0, key);
  add_points(key, function->opacity, function->opacity_count);
  add_points(key, function->gradient_opacity, function->gradient_opacity_count);
  hl_key_add_whole(key, (int64_t)function->color_count);
  if (function->color_count > 0)
    hl_key_add(key, function->color, function->color_count * sizeof *function->color);
  hl_key_add_whole(key, hl_has_plane(function) ? (int64_t)hl_plane_mark(&function->plane) : 0);
}

static void add_mask(hl_key *key, const hl_mask *mask) {
  hl_key_add_whole(key, mask->volume != NULL);
  if (mask->volume == NULL) return;
  hl_key_add_numbers(key, &mask->rest, 1);
  hl_key_add_affine(key, &mask->volume->index_to_world);
  add_voxels(key, mask->volume);
}

/* Writes the key by which a volume is ordered. The key begins with the volume's place and voxels, so that the
 * order does not change when the volume's look changes. */
static void write_volume(const void *data, hl_key *key) {
  const hl_scene_volume *volume = data;
  affine3 place = hl_scene_volume_index_to_world(volume);
  hl_key_add_affine(key, &place);
  add_voxels(key, volume->volume);
  hl_settings_key_add(HL_SETTINGS_VOLUME, volume, 0, key);
  hl_settings_key_add(HL_SETTINGS_MATERIAL, &volume->material, 0, key);
  hl_key_add_whole(key, volume->clipped != 0);
  add_function(key, &volume->transfer_function);
  hl_key_add_whole(key, (int64_t)volume->iso_count);
  for (size_t i = 0; i < volume->iso_count; i++)
    hl_settings_key_add(HL_SETTINGS_ISO, &volume->iso[i], 0, key);
  hl_key_add_whole(key, (int64_t)volume->cut_count);
  for (size_t i = 0; i < volume->cut_count; i++)
    hl_settings_key_add(HL_SETTINGS_CUT, &volume->cuts[i], volume->cuts[i].type, key);
  add_mask(key, &volume->mask);
}

static int compare_bytes(const void *a, const void *b, size_t count) {
  if (a == NULL || b == NULL) return (a != NULL) - (b != NULL);
  return memcmp(a, b, count);
}

/* Compares the voxels of volumes with equal size and storage. Voxels that are not in memory count as equal,
 * because their histograms have been found equal before. Voxels of sparse pages also count as equal if memory
 * for two rows is lacking. */
static int compare_voxels(const hl_volume *a, const hl_volume *b) {
  if (a == b || a == NULL || b == NULL || !hl_volume_is_in_memory(a) || !hl_volume_is_in_memory(b)) return 0;
  const size_t row = a->dimension[0] * hl_storage_bytes(a->storage);
  unsigned char *buffer = hl_allocate(a->context, 2, row);
  int compared = 0;
  for (size_t k = 0; buffer != NULL && compared == 0 && k < a->dimension[2]; k++)
    for (size_t j = 0; compared == 0 && j < a->dimension[1]; j++)
      compared = memcmp(hl_volume_row_in(a, j, k, buffer), hl_volume_row_in(b, j, k, buffer + row), row);
  hl_release(a->context, buffer);
  return compared != 0 ? compared : compare_bytes(a->colors, b->colors, 4 * hl_volume_voxel_count(a));
}

static int compare_volumes(const void *a, const void *b) {
  const hl_scene_volume *first = a, *second = b;
  int voxels = compare_voxels(first->volume, second->volume);
  return voxels != 0 ? voxels : compare_voxels(first->mask.volume, second->mask.volume);
}

/* ---- meshes ---- */

static void write_mesh(const void *data, hl_key *key) {
  const hl_scene_mesh *mesh = data;
  hl_settings_key_add(HL_SETTINGS_MESH, mesh, 0, key);
  hl_settings_key_add(HL_SETTINGS_MATERIAL, &mesh->material, 0, key);
  hl_key_add_whole(key, (int64_t)mesh->mesh->description.vertex_count);
  hl_key_add_numbers(key, mesh->mesh->low, 3);
  hl_key_add_numbers(key, mesh->mesh->high, 3);
  hl_key_add_whole(key, (int64_t)mesh->mesh->mark);
}

/* Compares the normals of meshes with equal keys. Such meshes have the same triangles and spheres. */
static int compare_meshes(const void *a, const void *b) {
  const hl_mesh_description *first = &((const hl_scene_mesh *)a)->mesh->description,
                            *second = &((const hl_scene_mesh *)b)->mesh->description;
  return compare_bytes(first->normals, second->normals, first->vertex_count * sizeof *first->normals);
}

/* ---- the order ---- */

typedef struct sort_kind {
  const void *items;
  size_t count, size;
  hl_key_write *write;
  /* a function that compares two objects whose keys are equal; if null, the keys contain everything that
   * matters */
  int (*compare)(const void *a, const void *b);
} sort_kind;

static int compare(const sort_kind *kind, const hl_key *keys, int a, int b) {
  const size_t least = keys[a].count < keys[b].count ? keys[a].count : keys[b].count;
  const int bytes = memcmp(keys[a].bytes, keys[b].bytes, least);
  if (bytes != 0) return bytes;
  if (keys[a].count != keys[b].count) return keys[a].count < keys[b].count ? -1 : 1;
  if (kind->compare == NULL) return 0;
  const char *items = kind->items;
  return kind->compare(items + (size_t)a * kind->size, items + (size_t)b * kind->size);
}

/* Sorts the first `kind->count` numbers of an order by the keys of the objects to which the numbers
 * belong. */
static hl_status sort(hl_context *context, const sort_kind *kind, int *order, hl_error *error) {
  if (kind->count < 2) return HL_OK;
  hl_key *keys = hl_allocate_zeroed(context, kind->count, sizeof *keys);
  if (keys == NULL) return hl_fail_memory(error, kind->count * sizeof *keys, "the order of a scene");
  hl_status status = HL_OK;
  for (size_t i = 0; i < kind->count && status == HL_OK; i++) {
    bool same;
    status = hl_key_renew(context, kind->write, (const char *)kind->items + i * kind->size, &keys[i], &same,
                          error);
  }
  for (size_t i = 1; i < kind->count && status == HL_OK; i++) {
    const int inserted = order[i];
    size_t at = i;
    for (; at > 0 && compare(kind, keys, order[at - 1], inserted) > 0; at--) order[at] = order[at - 1];
    order[at] = inserted;
  }
  for (size_t i = 0; i < kind->count; i++) hl_key_release(context, &keys[i]);
  hl_release(context, keys);
  return status;
}

static int *as_listed(hl_context *context, size_t count) {
  int *order = hl_allocate(context, count, sizeof *order);
  for (size_t i = 0; order != NULL && i < count; i++) order[i] = (int)i;
  return order;
}

hl_status hl_scene_order_find(hl_context *context, const hl_scene_description *given,
                              const hl_scene_description *placed, scene_order *order, hl_error *error) {
  *order = (scene_order){.lights = as_listed(context, placed->light_count),
                         .volumes = as_listed(context, placed->volume_count),
                         .meshes = as_listed(context, placed->mesh_count)};
  if (order->lights == NULL || order->volumes == NULL || order->meshes == NULL)
    return hl_fail_memory(error, placed->volume_count * sizeof(int), "the order of a scene");
  const sort_kind lights = {given->lights, given->light_count, sizeof(hl_light), write_light, NULL},
                  volumes = {placed->volumes, placed->volume_count, sizeof(hl_scene_volume), write_volume,
                             compare_volumes},
                  meshes = {placed->meshes, placed->mesh_count, sizeof(hl_scene_mesh), write_mesh,
                            compare_meshes};
  hl_status status = sort(context, &lights, order->lights, error);
  if (status == HL_OK) status = sort(context, &volumes, order->volumes, error);
  return status == HL_OK ? sort(context, &meshes, order->meshes, error) : status;
}

void hl_scene_order_release(hl_context *context, scene_order *order) {
  hl_release(context, order->lights);
  hl_release(context, order->volumes);
  hl_release(context, order->meshes);
}
