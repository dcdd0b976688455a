/* render/device_textures.c - see device_textures.h. */
#include "render/device_textures.h"

#include <string.h>

#include "core/memory.h"
#include "render/sweep_constants.h"

_Static_assert(PLAN_TEXTURE_LEVELS == (int)TEXTURE_LEVELS, "images of plans are images of lights");

bool hl_project_images(const sweep_plan *plan) {
  for (int i = 0; i < plan->geometry->light_count; i++)
    if (plan->lights[i].source->screen.picture.pixels != NULL) return true;
  return false;
}

/* Appends the pixels of an image to the sweep's parts, and describes the image. *floats: the number of floats
 * of the parts before; it is raised by the image's floats. */
static void add_part(const float *pixels, int width, int height, gpu_pixels *parts, gpu_textures *all,
                     size_t *floats, plan_texture_level *level) {
  const size_t count = (size_t)width * (size_t)height * 3;
  parts[all->part_count++] = (gpu_pixels){pixels, count};
  level->begin = (unsigned)*floats;
  level->width = width;
  level->height = height;
  *floats += count;
}

static void describe(const light_texture *made, gpu_pixels *parts, gpu_textures *all, size_t *floats,
                     plan_texture *texture) {
  if (made->pixels == NULL) return;
  add_part(made->pixels, made->width, made->height, parts, all, floats, &texture->image);
  memcpy(texture->map, made->map, sizeof texture->map);
  memcpy(texture->sharpness, made->sharpness, sizeof texture->sharpness);
  memcpy(texture->beyond, made->beyond, sizeof texture->beyond);
  memcpy(texture->edge, made->edge, sizeof texture->edge);
  texture->parallel = made->parallel;
  texture->first = made->first;
  texture->level_count = made->level_count;
  for (int l = 0; l < made->level_count; l++) {
    const texture_level *from = &made->level[l];
    plan_texture_level *to = &texture->level[l];
    add_part(from->pixels, from->width, from->height, parts, all, floats, to);
    memcpy(to->scale, from->scale, sizeof to->scale);
    memcpy(to->shift, from->shift, sizeof to->shift);
  }
}

static hl_status make_room(hl_context *context, size_t count, device_textures *textures, hl_error *error) {
  *textures = (device_textures){
      .made = hl_allocate_zeroed(context, count, sizeof *textures->made),
      .list = hl_allocate_zeroed(context, count, sizeof *textures->list),
      .parts = hl_allocate(context, count * (1 + TEXTURE_LEVELS), sizeof *textures->parts)};
  if (textures->made != NULL) textures->count = count;
  if (textures->made == NULL || textures->list == NULL || textures->parts == NULL)
    return hl_fail_memory(error, count * (sizeof *textures->made + sizeof *textures->list),
                          "the lights' images");
  return HL_OK;
}

hl_status hl_device_textures_begin(hl_context *context, const frame_plan *frame_plan, const sweep_plan *plan,
                                   device_textures *textures, gpu_sweep *sweep, hl_error *error) {
  const texture_use use = hl_texture_use(&frame_plan->frame);
  const size_t count = (size_t)plan->geometry->light_count;
  gpu_textures *all = &sweep->textures;
  size_t floats = 0;
  hl_status status = make_room(context, count, textures, error);
  for (size_t i = 0; i < count && status == HL_OK; i++) {
    status = hl_light_texture_create(context, plan->lights[i].source, &use, &textures->made[i], error);
    if (status == HL_OK) describe(&textures->made[i], textures->parts, all, &floats, &textures->list[i]);
  }
  all->list = textures->list;
  all->parts = textures->parts;
  return status;
}

void hl_device_textures_release(hl_context *context, device_textures *textures) {
  for (size_t i = 0; i < textures->count; i++) hl_light_texture_release(context, &textures->made[i]);
  hl_release(context, textures->made);
  hl_release(context, textures->list);
  hl_release(context, textures->parts);
  *textures = (device_textures){0};
}
