/* plan/plan_text.c - see plan_text.h. All numbers of the text are read from the plan. */
#include "plan/plan_text.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "surface/primitive.h"
#include "text/plain_json.h"

static json_t *pair(int first, int second) { return json_pack("[i, i]", first, second); }

static json_t *picture_of(const frame_plan *plan) {
  return json_pack("{s: o, s: i, s: o, s: I, s: i, s: i}", "size",
                   pair(plan->picture.width, plan->picture.height), "oversampling", plan->frame.oversampling,
                   "frame_size", pair(plan->frame.width, plan->frame.height), "tiles",
                   (json_int_t)plan->picture.tiles, "part", plan->picture.share.part, "parts",
                   plan->picture.share.parts);
}

static void add_name(json_t *to, const char *name) {
  if (name != NULL) json_object_set_new(to, "name", json_string(name));
}

static json_t *volume_of(const frame_plan *plan, int index) {
  const grid *grid = &plan->volumes.grids[index];
  const frame_volume *from = &plan->volumes.list[index];
  json_t *volume = json_pack("{s: [i, i, i], s: I, s: I, s: b, s: b, s: b}", "dimensions",
                             (int)grid->dimension[0], (int)grid->dimension[1], (int)grid->dimension[2],
                             "bricks", (json_int_t)hl_grid_bricks(grid), "visible_bricks",
                             (json_int_t)grid->relevant_count, "in_pages", grid->pages != NULL, "visible",
                             from->visible, "casts_shadow", from->casts_shadow);
  add_name(volume, from->name);
  return volume;
}

static json_t *whole_light_of(const frame_light *light) {
  return json_pack("{s: i, s: b, s: b, s: b}", "light", light->index, "sun", light->sun_part > 0, "wide",
                   light->is_wide, "image", light->projects_image || light->shows_image);
}

/* Makes the JSON text of a mesh. placed: the same mesh among the frame's surfaces. */
static json_t *mesh_of(const frame_mesh *mesh, const surface_mesh *placed) {
  json_t *made = json_pack("{s: i, s: f, s: b, s: b}", "object", mesh->object, "opacity", mesh->look.opacity,
                           "visible", mesh->look.visible, "casts_shadow", mesh->look.casts_shadow);
  for (int k = 0; k < PRIMITIVE_KINDS; k++)
    json_object_set_new(made, hl_primitive_kinds[k]->noun,
                        json_integer((json_int_t)placed->primitives[k].count));
  add_name(made, mesh->name);
  return made;
}

/* Adds the JSON of the buffer of a light's shadows, and of the memory that the shadow method takes beside
 * it. */
static void add_shadow(const light_plan *light, json_t *to) {
  const light_shadow *shadow = &light->shadow;
  if (shadow->method == NULL) return;
  const shadow_buffer_size size = hl_light_shadow_buffer_size(shadow, 1);
  json_object_set_new(to, "method", json_string(shadow->method->name));
  json_object_set_new(to, "buffer", pair(shadow->plan.view.width, shadow->plan.view.height));
  json_object_set_new(to, "sheet_bytes", json_integer((json_int_t)hl_shadow_sheet_bytes(&size)));
  json_object_set_new(to, "method_bytes",
                      json_integer((json_int_t)(light->memory.kept.bytes + light->memory.passing.bytes)));
  if (shadow->sublight_count > 0) json_object_set_new(to, "sublights", json_integer(shadow->sublight_count));
}

static json_t *light_of(const light_plan *light) {
  const light_source *source = light->source;
  json_t *made = json_pack("{s: i, s: b}", "light", source->light_index, "sun", source->of_sky > 0);
  if (source->sectors != NULL) json_object_set_new(made, "sector", json_integer(source->sector));
  add_shadow(light, made);
  return made;
}

static json_t *sweep_of(const frame_plan *plan, const sweep_plan *sweep) {
  const sheet_stack *sheets = &sweep->geometry->sheets;
  json_t *lights = json_array();
  for (int i = 0; i < sweep->geometry->light_count; i++)
    json_array_append_new(lights, light_of(&sweep->lights[i]));
  return json_pack("{s: i, s: f, s: [f, f, f], s: b, s: b, s: o}", "sheets", sheets->count, "spacing",
                   sheets->spacing * plan->unit, "normal", sheets->normal.x, sheets->normal.y,
                   sheets->normal.z, "back_to_front", sweep->geometry->back_to_front, "adds_even_light",
                   sweep->adds_even_light, "lights", lights);
}

static json_t *root_of(const frame_plan *plan) {
  json_t *volumes = json_array(), *lights = json_array(), *meshes = json_array(), *sweeps = json_array();
  for (int v = 0; v < plan->volumes.count; v++) json_array_append_new(volumes, volume_of(plan, v));
  for (int i = 0; i < plan->light_count; i++) json_array_append_new(lights, whole_light_of(&plan->lights[i]));
  for (int m = 0; m < plan->mesh_count; m++)
    json_array_append_new(meshes, mesh_of(&plan->meshes[m], &plan->frame.surfaces->meshes[m]));
  for (int s = 0; s < plan->sweeps.count; s++)
    json_array_append_new(sweeps, sweep_of(plan, &plan->sweeps.list[s]));
  return json_pack("{s: o, s: o, s: o, s: o, s: o, s: i, s: b, s: b}", "picture", picture_of(plan), "volumes",
                   volumes, "lights", lights, "meshes", meshes, "sweeps", sweeps, "channels", plan->channels,
                   "sky", plan->fields.sky != NULL, "multiple_scattering", plan->fields.scattered != NULL);
}

hl_status hl_plan_text(hl_context *context, const frame_plan *plan, char **text, hl_error *error) {
  json_t *root = root_of(plan);
  char *dumped = root == NULL ? NULL : hl_plain_json_dump(root, JSON_INDENT(2) | JSON_REAL_PRECISION(6));
  const size_t bytes = dumped == NULL ? 0 : strlen(dumped) + 2;
  *text = dumped == NULL ? NULL : hl_allocate(context, bytes, 1);
  if (*text != NULL) snprintf(*text, bytes, "%s\n", dumped);
  free(dumped);
  json_decref(root);
  return *text != NULL ? HL_OK : hl_fail_memory(error, bytes, "a plan's text");
}
