/* analytic/mesh_stage.c - see mesh_stage.h. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "mesh_stage.h"

void mesh_stage_open(mesh_stage *all, int side, double height) {
  stage_open(&all->set);
  all->set.scene.width = all->set.scene.height = side;
  all->set.scene.camera.height = height;
  stage_look(&all->set, (vec3){0, 0, 100}, (vec3){0, 0, 0}, (vec3){0, 1, 0});
  hl_scene_volume *clear = stage_add_box(&all->set, (vec3){-0.5, -0.5, -0.5}, (vec3){0.5, 0.5, 0.5});
  stage_set_opacity(&all->set, clear, 0, 1);
  all->set.scene.meshes = all->meshes;
  all->set.scene.mesh_count = 0;
}

void mesh_stage_close(mesh_stage *all) {
  for (size_t m = 0; m < all->set.scene.mesh_count; m++) hl_mesh_release(all->meshes[m].mesh);
  stage_close(&all->set);
}

hl_scene_mesh *mesh_stage_add(mesh_stage *all, hl_mesh *made) {
  assert_true(all->set.scene.mesh_count < STAGE_MESHES);
  hl_scene_mesh *mesh = &all->meshes[all->set.scene.mesh_count++];
  hl_scene_mesh_defaults(mesh);
  mesh->mesh = made;
  mesh->material = (hl_material){.diffuse = 1};
  for (int c = 0; c < 3; c++) mesh->color[c] = 1;
  return mesh;
}

hl_scene_mesh *mesh_stage_describe(mesh_stage *all, const hl_mesh_description *description) {
  hl_mesh *made = NULL;
  hl_error error = {0};
  if (hl_mesh_create(all->set.context, description, &made, &error) != HL_OK) fail_msg("%s", error.message);
  return mesh_stage_add(all, made);
}

void mesh_stage_choose_shadows(mesh_stage *all, hl_light *light, int kind, double diameter_deg) {
  static const hl_soft_method methods[] = {HL_SOFT_CASCADE, HL_SOFT_PAPER, HL_SOFT_SUBLIGHTS};
  hl_render_settings *render = &all->set.scene.render;
  render->shadows = kind == 0 ? HL_SHADOWS_HARD : HL_SHADOWS_SOFT;
  if (kind == 0) return;
  render->soft_method = methods[kind - 1];
  light->angular_diameter_deg = diameter_deg;
}
