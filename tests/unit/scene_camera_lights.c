/* tests/unit/scene_camera_lights.c - lights that are placed as the camera sees them. */
#include "scene_parts.h"

static void lights_stand_where_the_camera_sees_them(void **state) {
  (void)state;
  hl_camera c = {.position = {0, -5, 0}, .up = {0, 0, 1}};
  double d[3];
  hl_light_direction(&c, 0, 0, d); /* a headlight shines along the line of sight */
  assert_true(d[0] == 0 && d[1] == 1 && d[2] == 0);
  hl_light_direction(&c, 90, 0, d); /* from the right: travels to -x */
  assert_near(d[0], -1, 1e-12);
  hl_light_direction(&c, 0, 90, d); /* from above */
  assert_near(d[2], -1, 1e-12);
  hl_light_direction(&c, -40, 45, d); /* from the upper left in front */
  assert_true(d[0] > 0 && d[1] > 0 && d[2] < 0);
  assert_near(vec3_length(vec3_of(d)), 1, 1e-12);
}

/* A light in camera axes is the same as one whose places in the world were found by hand, for every type of
 * light. */
static void lights_go_with_the_camera(void **state) {
  (void)state;
  parts p;
  parts_make(&p);
  p.description.camera = (hl_camera){
      .position = {10, -20, 7}, .target = {1, 2, 3}, .up = {0, 0.2, 1}, .fovy_deg = 30};
  vec3 right, up, forward;
  hl_camera_basis(&p.description.camera, &right, &up, &forward);
  const double vertices[3][3] = {{0, 0, 5}, {1, 0, 5}, {0, 1, 6}};
  hl_light lights[6];
  for (int type = 0; type < 6; type++) {
    hl_light_defaults(&lights[type]);
    lights[type].type = (hl_light_type)type;
    lights[type].frame = HL_LIGHT_FRAME_CAMERA;
    memcpy(lights[type].position, (double[3]){1, 2, 3}, sizeof lights[type].position);
    memcpy(lights[type].direction, (double[3]){0, 0, -1}, sizeof lights[type].direction);
    memcpy(lights[type].edge1, (double[3]){2, 0, 0}, sizeof lights[type].edge1);
    if (type == HL_LIGHT_POLYGON) lights[type].vertices = vertices, lights[type].vertex_count = 3;
  }
  p.description.lights = lights;
  p.description.light_count = 6;
  hl_scene *scene = NULL;
  assert_int_equal(hl_scene_create(p.context, &p.description, &scene, NULL), HL_OK);
  const hl_light *placed = scene->placed.lights, *kept = hl_scene_describe(scene)->lights;
  const vec3 target = vec3_of(p.description.camera.target);
  vec3 at = vec3_add(target, vec3_add(vec3_add(right, vec3_scale(up, 2)), vec3_scale(forward, -3)));
  for (int type = 0; type < 6; type++) {
    assert_true(placed[type].frame == HL_LIGHT_FRAME_WORLD && kept[type].frame == HL_LIGHT_FRAME_CAMERA);
    assert_near(vec3_length(vec3_subtract(vec3_of(placed[type].position), at)), 0, 1e-12);
    assert_near(vec3_length(vec3_subtract(vec3_of(placed[type].direction), forward)), 0, 1e-12);
    assert_near(vec3_length(vec3_subtract(vec3_of(placed[type].edge1), vec3_scale(right, 2))), 0, 1e-12);
    assert_near(kept[type].position[0], 1, 0);
  }
  vec3 vertex = vec3_add(vec3_add(target, up), vec3_scale(forward, -6));
  assert_near(vec3_length(vec3_subtract(vec3_of(placed[5].vertices[2]), vertex)), 0, 1e-12);
  double beside[3], world[3];
  hl_light_direction_beside(-40, 45, beside);
  hl_light_direction(&p.description.camera, -40, 45, world);
  vec3 by_hand = vec3_add(vec3_add(vec3_scale(right, beside[0]), vec3_scale(up, beside[1])),
                          vec3_scale(forward, -beside[2]));
  assert_near(vec3_length(vec3_subtract(by_hand, vec3_of(world))), 0, 1e-12);
  hl_scene_release(scene);
  lights[1].position[0] = 1e14; /* beyond reach of voxels a unit wide */
  hl_error error = {0};
  assert_int_equal(hl_scene_create(p.context, &p.description, &scene, &error), HL_ERROR_INPUT);
  assert_non_null(strstr(error.message, "/lights/1/position"));
  parts_release(&p);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(lights_stand_where_the_camera_sees_them),
                                     cmocka_unit_test(lights_go_with_the_camera)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
