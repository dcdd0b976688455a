/* render/sky.c - the sky of a frame: brings a scene's volumes to the field of its light, and keeps the field
 * while volumes and sky stay as they are.
 *
 * A field's key is the bytes of all that it depends on. */
#include "render/sky.h"

#include <string.h>

#include "core/memory.h"
#include "mesh/mesh.h"

/* A field has at most so many cells. */
static const double MOST_CELLS = 1200000;

/* ---- the key ---- */

typedef struct key_writer {
  unsigned char *bytes; /* null: counts only */
  size_t count;
} key_writer;

static void add_bytes(key_writer *key, const void *bytes, size_t count) {
  if (key->bytes != NULL && count > 0) memcpy(key->bytes + key->count, bytes, count);
  key->count += count;
}

static void add_numbers(key_writer *key, const double *numbers, size_t count) {
  add_bytes(key, numbers, count * sizeof *numbers);
}

static void add_whole(key_writer *key, int64_t number) { add_bytes(key, &number, sizeof number); }

/* A number for an image's pixels: FNV-1a over words of 32 bits, in 64 bits. */
static uint64_t mark_of_pixels(const hl_sky *sky) {
  uint64_t mark = 0xcbf29ce484222325u;
  size_t count = 3 * (size_t)sky->width * (size_t)sky->height;
  for (size_t i = 0; i < count; i++) {
    uint32_t word;
    memcpy(&word, &sky->pixels[i], sizeof word);
    mark = (mark ^ word) * 0x100000001b3u;
  }
  return mark;
}

static void add_sky(key_writer *key, const hl_sky *sky, uint64_t mark) {
  add_whole(key, (int64_t)sky->type);
  add_whole(key, sky->hemisphere);
  add_numbers(key, sky->color, 3);
  add_numbers(key, sky->zenith, 3);
  add_numbers(key, sky->horizon, 3);
  add_numbers(key, sky->ground, 3);
  add_numbers(key, sky->up, 3);
  add_numbers(key, &sky->rotation_deg, 1);
  add_numbers(key, &sky->strength, 1);
  if (sky->type != HL_SKY_IMAGE) return;
  add_whole(key, sky->width);
  add_whole(key, sky->height);
  add_bytes(key, &mark, sizeof mark);
}

static void add_volume(key_writer *key, const prepared_volume *prepared, const grid *grid) {
  const hl_scene_volume *volume = prepared->scene;
  const hl_transfer_function *function = &volume->transfer_function;
  uintptr_t voxels = (uintptr_t)volume->volume; /* kept by the prepared volume while the field is */
  add_bytes(key, &voxels, sizeof voxels);
  for (int row = 0; row < 3; row++) add_numbers(key, &grid->index_to_frame.linear.row[row].x, 3);
  add_numbers(key, &grid->index_to_frame.offset.x, 3);
  add_numbers(key, grid->box_low, 3);
  add_numbers(key, grid->box_high, 3);
  add_numbers(key, &function->unit_distance, 1);
  for (size_t p = 0; p < function->opacity_count; p++)
    add_numbers(key, (double[2]){function->opacity[p].value, function->opacity[p].opacity}, 2);
  add_numbers(key, volume->attenuation_color, 3);
  add_whole(key, 4 * (int64_t)prepared->kernel + 2 * (volume->visible != 0) + (volume->casts_shadow != 0));
}

/* The triangles are those of the frame, and stand for meshes and isosurfaces alike. */
static void add_surfaces(key_writer *key, const surfaces *all) {
  for (size_t m = 0; m < all->mesh_count; m++) {
    const surface_mesh *mesh = &all->meshes[m];
    add_numbers(key, &mesh->scene->opacity, 1);
    add_whole(key, 2 * (mesh->scene->visible != 0) + (mesh->scene->casts_shadow != 0));
    add_whole(key, mesh->triangle_count);
    if (mesh->colors != NULL)
      add_bytes(key, mesh->colors, mesh->scene->mesh->description.vertex_count * sizeof *mesh->colors);
    if (mesh->face_colors != NULL)
      add_bytes(key, mesh->face_colors, mesh->triangle_count * sizeof *mesh->face_colors);
    if (mesh->sphere_colors != NULL)
      add_bytes(key, mesh->sphere_colors, mesh->sphere_count * sizeof *mesh->sphere_colors);
    add_whole(key, mesh->sphere_count);
  }
  add_bytes(key, all->positions, all->vertex_count * sizeof *all->positions);
  add_bytes(key, all->triangles, all->triangle_count * sizeof *all->triangles);
  add_bytes(key, all->spheres, all->sphere_count * sizeof *all->spheres);
}

static void write_key(const frame_sky *of, uint64_t mark, key_writer *key) {
  key->count = 0;
  add_sky(key, &of->scene->sky, mark);
  for (size_t v = 0; v < of->scene->volume_count; v++) add_volume(key, &of->volumes[v], &of->grids[v]);
  if (of->frame->surfaces != NULL) add_surfaces(key, of->frame->surfaces);
}

/* Whether the field's key is the frame's; else the field has the frame's key afterwards. */
static hl_status renew_key(hl_context *context, const frame_sky *of, sky_field *field, bool *same,
                           hl_error *error) {
  const hl_sky *sky = &of->scene->sky;
  uint64_t mark = sky->type == HL_SKY_IMAGE ? mark_of_pixels(sky) : 0;
  key_writer key = {NULL, 0};
  write_key(of, mark, &key);
  key.bytes = hl_allocate(context, key.count, 1);
  if (key.bytes == NULL) return hl_fail_memory(error, key.count, "the sky");
  write_key(of, mark, &key);
  *same = field->key != NULL && field->key_bytes == key.count &&
          memcmp(field->key, key.bytes, key.count) == 0;
  hl_release(context, field->key);
  field->key = key.bytes;
  field->key_bytes = key.count;
  return HL_OK;
}

/* ---- the content ---- */

static field_matter matter_of(const prepared_volume *prepared, const grid *grid) {
  const hl_scene_volume *volume = prepared->scene;
  field_matter matter = {.grid = grid,
                         .classifier = &prepared->classifier,
                         .cast = volume->casts_shadow ? 1 : 0,
                         .visible = volume->visible,
                         .smooth = prepared->kernel == HL_KERNEL_INTERPOLATING};
  const double *offset = &grid->frame_to_index.offset.x;
  for (int a = 0; a < 3; a++) {
    vec3_store(matter.to_index[a], grid->frame_to_index.linear.row[a]);
    matter.to_index[a][3] = (float)offset[a];
    matter.low[a] = (float)grid->box_low[a];
    matter.high[a] = (float)grid->box_high[a];
  }
  return matter;
}

static field_surface surface_of(const surfaces *all, const surface_mesh *mesh) {
  return (field_surface){
      .positions = (const float(*)[3])all->positions,
      .colors = mesh->colors,
      .first_vertex = mesh->first_vertex,
      .triangles = (const uint32_t(*)[3])(all->triangles + mesh->first_triangle),
      .face_colors = mesh->face_colors,
      .spheres = mesh->sphere_count == 0 ? NULL : (const float(*)[4])(all->spheres + mesh->first_sphere),
      .sphere_colors = mesh->sphere_colors,
      .triangle_count = mesh->triangle_count,
      .sphere_count = mesh->sphere_count,
      .opacity = mesh->scene->opacity,
      .visible = mesh->scene->visible,
      .casts_shadow = mesh->scene->casts_shadow};
}

/* One channel will do where the sky has one colour and everything takes light of all colours alike. */
static int channels_of(const hl_scene_description *scene) {
  if (scene->sky.type != HL_SKY_UNIFORM) return 3;
  for (size_t v = 0; v < scene->volume_count; v++) {
    const double *color = scene->volumes[v].attenuation_color;
    if (scene->volumes[v].casts_shadow && (color[0] != color[1] || color[1] != color[2])) return 3;
  }
  return 1;
}

static hl_status make(hl_context *context, hl_pool *pool, const hot_functions *hot,
                      const sky_content *content, const sky_room *room, sky_field *field, hl_error *error) {
  uint64_t passing, kept = hl_sky_bytes(content, &passing);
  hl_status status = room->check(room->data, passing + (kept > field->bytes ? kept - field->bytes : 0),
                                 error);
  return status == HL_OK ? hl_sky_make(context, pool, content, &hot->field, field, error) : status;
}

hl_status hl_frame_sky_update(hl_context *context, hl_pool *pool, const hot_functions *hot,
                              const frame_sky *of, const sky_room *room, sky_field *field, hl_error *error) {
  const hl_scene_description *scene = of->scene;
  bool same = false;
  if (scene->sky.type == HL_SKY_NONE || hl_is_maximum(scene) || of->frame->point_count == 0) {
    hl_sky_release(context, field);
    return HL_OK;
  }
  hl_status status = renew_key(context, of, field, &same, error);
  if (status != HL_OK || same) return status;
  const surfaces *all = of->frame->surfaces;
  size_t surface_count = all == NULL ? 0 : all->mesh_count;
  field_matter *matter = hl_allocate(context, scene->volume_count, sizeof *matter);
  field_surface *surfaces = hl_allocate(context, surface_count, sizeof *surfaces);
  double(*colors)[3] = hl_allocate(context, scene->volume_count, sizeof *colors);
  if (matter == NULL || colors == NULL || surfaces == NULL)
    status = hl_fail_memory(error, sizeof *matter, "the sky");
  for (size_t v = 0; v < scene->volume_count && status == HL_OK; v++) {
    matter[v] = matter_of(&of->volumes[v], &of->grids[v]);
    memcpy(colors[v], scene->volumes[v].attenuation_color, sizeof colors[v]);
  }
  for (size_t m = 0; m < surface_count && status == HL_OK; m++)
    surfaces[m] = surface_of(all, &all->meshes[m]);
  sky_content content = {
      .sky = &scene->sky,
      .content = {matter, (int)scene->volume_count, surfaces, surface_count, of->frame->voxel},
      .colors = (const double(*)[3])colors,
      .lattice = hl_field_lattice(of->frame->points, of->frame->point_count, of->frame->voxel, MOST_CELLS),
      .channels = channels_of(scene)};
  if (status == HL_OK) status = make(context, pool, hot, &content, room, field, error);
  if (status != HL_OK) hl_sky_release(context, field);
  hl_release(context, matter);
  hl_release(context, surfaces);
  hl_release(context, colors);
  return status;
}
