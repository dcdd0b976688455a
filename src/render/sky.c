/* render/sky.c - the sky of a frame: brings a scene's volumes to the field of its light, and keeps the field
 * while volumes and sky stay as they are.
 *
 * A field's key is the bytes of all that it depends on. */
#include "render/sky.h"

#include <string.h>

#include "core/memory.h"
#include "grid/matter_key.h"
#include "mesh/mesh.h"

/* A field has at most so many cells. */
static const double MOST_CELLS = 1200000;

/* ---- the key ---- */

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

static void add_sky(hl_key *key, const hl_sky *sky, uint64_t mark) {
  hl_key_add_whole(key, (int64_t)sky->type);
  hl_key_add_whole(key, sky->hemisphere);
  hl_key_add_numbers(key, sky->color, 3);
  hl_key_add_numbers(key, sky->zenith, 3);
  hl_key_add_numbers(key, sky->horizon, 3);
  hl_key_add_numbers(key, sky->ground, 3);
  hl_key_add_numbers(key, sky->up, 3);
  hl_key_add_numbers(key, &sky->rotation_deg, 1);
  hl_key_add_numbers(key, &sky->strength, 1);
  if (sky->type != HL_SKY_IMAGE) return;
  hl_key_add_whole(key, sky->width);
  hl_key_add_whole(key, sky->height);
  hl_key_add(key, &mark, sizeof mark);
}

static void add_volume(hl_key *key, const prepared_volume *prepared, const grid *grid) {
  hl_matter_key_add(key, prepared->scene, grid); /* the prepared volume keeps the voxels */
  hl_key_add_whole(key, 2 * (int64_t)prepared->kernel + (prepared->scene->visible != 0));
}

/* The triangles are those of the frame, and stand for meshes and isosurfaces alike. */
static void add_surfaces(hl_key *key, const surfaces *all) {
  for (size_t m = 0; m < all->mesh_count; m++) {
    const surface_mesh *mesh = &all->meshes[m];
    hl_key_add_numbers(key, &mesh->scene->opacity, 1);
    hl_key_add_whole(key, 2 * (mesh->scene->visible != 0) + (mesh->scene->casts_shadow != 0));
    hl_key_add_whole(key, mesh->triangle_count);
    if (mesh->colors != NULL)
      hl_key_add(key, mesh->colors, mesh->scene->mesh->description.vertex_count * sizeof *mesh->colors);
    if (mesh->face_colors != NULL)
      hl_key_add(key, mesh->face_colors, mesh->triangle_count * sizeof *mesh->face_colors);
    if (mesh->sphere_colors != NULL)
      hl_key_add(key, mesh->sphere_colors, mesh->sphere_count * sizeof *mesh->sphere_colors);
    hl_key_add_whole(key, mesh->sphere_count);
  }
  hl_key_add(key, all->positions, all->vertex_count * sizeof *all->positions);
  hl_key_add(key, all->triangles, all->triangle_count * sizeof *all->triangles);
  hl_key_add(key, all->spheres, all->sphere_count * sizeof *all->spheres);
}

typedef struct sky_subject {
  const frame_sky *of;
  uint64_t mark; /* of the image's pixels; 0: there is none */
} sky_subject;

static void write_key(const void *data, hl_key *key) {
  const sky_subject *subject = data;
  const frame_sky *of = subject->of;
  add_sky(key, &of->scene->sky, subject->mark);
  for (size_t v = 0; v < of->scene->volume_count; v++) add_volume(key, &of->volumes[v], &of->grids[v]);
  if (of->frame->surfaces != NULL) add_surfaces(key, of->frame->surfaces);
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
  for (size_t v = 0; v < scene->volume_count; v++)
    if (scene->volumes[v].casts_shadow && !hl_is_grey(scene->volumes[v].attenuation_color)) return 3;
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
  const sky_subject subject = {of, scene->sky.type == HL_SKY_IMAGE ? mark_of_pixels(&scene->sky) : 0};
  hl_status status = hl_key_renew(context, write_key, &subject, &field->key, &same, error);
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
