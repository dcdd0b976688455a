/* render/sky.c - makes the field of the sky's light for a frame, and keeps the field while volumes and sky do
 * not change.
 *
 * The key of a field holds the bytes of everything on which the field depends. */
#include "render/sky.h"

#include <string.h>

#include "core/memory.h"
#include "grid/matter_key.h"
#include "mesh/mesh.h"
#include "scene/light/sky.h"

/* The most cells that a field has. */
static const double MOST_CELLS = 1200000;

/* Returns whether a visible volume is a medium without surfaces. */
static bool has_media(const hl_scene_description *scene) {
  for (size_t v = 0; v < scene->volume_count; v++)
    if (scene->volumes[v].visible && scene->volumes[v].shading != HL_SHADING_PHONG) return true;
  return false;
}

/* ---- the key ---- */

static void add_volume(hl_key *key, const prepared_volume *prepared, const grid *grid) {
  /* the key may hold the address of the voxels, because the prepared volume keeps the voxels */
  hl_matter_key_add(key, prepared->scene, prepared->plane_mark, grid, &prepared->classifier);
  hl_key_add_whole(key, 2 * (int64_t)prepared->kernel + (prepared->scene->visible != 0));
}

static void write_key(const void *data, hl_key *key) {
  const frame_sky *of = data;
  hl_sky_key_add(key, &of->scene->sky, of->mark);
  for (size_t v = 0; v < of->scene->volume_count; v++) add_volume(key, &of->volumes[v], &of->grids[v]);
  hl_key_add_whole(key, has_media(of->scene));
  hl_surfaces_key_add(key, of->frame->surfaces);
}

/* ---- the content ---- */

static field_matter matter_of(const prepared_volume *prepared, const grid *grid) {
  const hl_scene_volume *volume = prepared->scene;
  field_matter matter = {.grid = grid,
                         .classifier = &prepared->classifier,
                         .cast = volume->casts_shadow ? 1 : 0,
                         .visible = volume->visible,
                         .smooth = prepared->kernel == HL_KERNEL_INTERPOLATING};
  affine3_store(matter.to_index, &grid->frame_to_index);
  for (int a = 0; a < 3; a++) {
    matter.low[a] = (float)grid->box_low[a];
    matter.high[a] = (float)grid->box_high[a];
  }
  return matter;
}

/* The number of channels of the sky's field. One channel is enough if the sky has one colour, and all matter
 * absorbs the same fraction of red, green and blue light. */
static int channels_of(const hl_scene_description *scene) {
  if (scene->sky.type != HL_SKY_UNIFORM) return 3;
  for (size_t v = 0; v < scene->volume_count; v++)
    if (scene->volumes[v].casts_shadow && !hl_is_grey(scene->volumes[v].attenuation_color)) return 3;
  return 1;
}

static hl_status make(hl_context *context, hl_pool *pool, const hot_functions *hot,
                      const sky_content *content, const sky_room *room, sky_field *field, hl_error *error) {
  hl_layout counted = {0};
  hl_sky_count(content, field, &counted);
  hl_status status = room->check(room->data, counted.most, error);
  return status == HL_OK ? hl_sky_make(context, pool, content, hot->field, field, error) : status;
}

hl_status hl_frame_sky_update(hl_context *context, hl_pool *pool, const hot_functions *hot,
                              const frame_sky *of, const sky_room *room, sky_field *field, hl_error *error) {
  const hl_scene_description *scene = of->scene;
  bool same = false;
  if (scene->sky.type == HL_SKY_NONE || hl_is_maximum(&scene->render) || !hl_is_lit(scene) ||
      of->frame->content.point_count == 0) {
    hl_sky_release(context, field);
    return HL_OK;
  }
  hl_status status = hl_key_renew(context, write_key, of, &field->key, &same, error);
  if (status != HL_OK || same) return status;
  const surfaces *all = of->frame->surfaces;
  field_matter *matter = hl_allocate(context, scene->volume_count, sizeof *matter);
  double(*colors)[3] = hl_allocate(context, scene->volume_count, sizeof *colors);
  if (matter == NULL || colors == NULL) status = hl_fail_memory(error, sizeof *matter, "the sky");
  for (size_t v = 0; v < scene->volume_count && status == HL_OK; v++) {
    matter[v] = matter_of(&of->volumes[v], &of->grids[v]);
    memcpy(colors[v], scene->volumes[v].attenuation_color, sizeof colors[v]);
  }
  sky_content content = {
      .sky = &scene->sky,
      .content = {matter, (int)scene->volume_count, all != NULL && all->mesh_count > 0 ? all : NULL,
                  of->frame->content.voxel},
      .colors = (const double(*)[3])colors,
      .lattice = hl_field_lattice(of->frame->content.points, of->frame->content.point_count,
                                  of->frame->content.voxel, MOST_CELLS),
      .media = has_media(scene),
      .channels = channels_of(scene),
      .exchange = of->exchange};
  if (status == HL_OK) status = make(context, pool, hot, &content, room, field, error);
  if (status != HL_OK) hl_sky_release(context, field);
  hl_release(context, matter);
  hl_release(context, colors);
  return status;
}
