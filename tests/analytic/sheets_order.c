/* analytic/sheets_order.c - the order in which a scene lists its lights, volumes and meshes does not change
 * the picture, to the byte and by every method. Layers follow the objects to which they belong. */
#include <setjmp.h>
#include <stdarg.h>
#include <string.h>

#include <cmocka.h>

#include "mesh_stage.h"

enum {
  SIDE = 24,
  PIXELS = SIDE * SIDE,
  LIGHTS = 3,
  VOLUMES = 2,
  MESHES = 2,
  LIGHT_ORDERS = 6,
  ORDERS = LIGHT_ORDERS * 4
};

static const int LIGHTS_IN_ORDER[LIGHT_ORDERS][LIGHTS] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2},
                                                          {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};

static const hl_opacity_point EDGE[] = {{0.3, 0}, {0.7, 0.9}};

/* Builds a scene of two overlapping blobs, a floor and a board of triangles, and three lights, two of which
 * may share sheets. alike: whether the blobs have the same place and the same colour. */
static void build(mesh_stage *all, bool alike) {
  stage *set = &all->set;
  float voxels[2][10 * 10 * 10];
  mesh_stage_open(all, SIDE, 26);
  stage_look(set, (vec3){30, -25, 20}, (vec3){0, 0, 0}, (vec3){0, 0, 1});
  hl_volume_release(set->volumes[0].volume);
  set->scene.volume_count = 0;
  for (int i = 0; i < 1000; i++) {
    const double x = i % 10 - 4.5, y = i / 10 % 10 - 4.5, z = i / 100 - 4.5;
    voxels[0][i] = (float)fmax(0, 1.2 - (x * x + y * y + z * z) / 20) * stage_noise(x, y, z);
    voxels[1][999 - i] = voxels[0][i];
  }
  for (int v = 0; v < VOLUMES; v++) {
    hl_scene_volume *volume = stage_add_grid(set, (size_t[3]){10, 10, 10}, (double[3]){1, 1, 1},
                                             (vec3){alike ? -5 : 3 * v - 6, -5, -4}, voxels[v]);
    volume->transfer_function.opacity = EDGE;
    volume->transfer_function.opacity_count = 2;
    volume->shading = HL_SHADING_PHONG;
    if (!alike) stage_set_color(set, volume, v == 0 ? 1 : 0.3, 0.6, v == 0 ? 0.2 : 0.9);
  }
  mesh_stage_add(all, stage_make_quad(set, (vec3){0, 0, -5}, (vec3){9, 0, 0}, (vec3){0, 9, 0}));
  mesh_stage_add(all, stage_make_quad(set, (vec3){0, 0, 3}, (vec3){3, 1, 2}, (vec3){-1, 3, 2}))->opacity =
      0.5;
  stage_add_directional(set, (vec3){-1, 0.5, -1})->angular_diameter_deg = 12;
  stage_add_directional(set, (vec3){-0.2, 0.9, -1})->angular_diameter_deg = 5;
  stage_add_point(set, (vec3){-15, 5, 20})->radius = 2;
  for (int l = 0; l < LIGHTS; l++) set->lights[l].color[l] = 0.37;
}

/* The order of a scene's lists: the index in the built scene of each object that the ordered scene lists. */
typedef struct order {
  int lights[LIGHTS], volumes[VOLUMES], meshes[MESHES];
} order;

static order order_of(int number) {
  order made;
  memcpy(made.lights, LIGHTS_IN_ORDER[number % LIGHT_ORDERS], sizeof made.lights);
  for (int i = 0; i < 2; i++) {
    made.volumes[i] = (number / LIGHT_ORDERS % 2) ^ i;
    made.meshes[i] = (number / LIGHT_ORDERS / 2) ^ i;
  }
  return made;
}

static void put_in_order(mesh_stage *all, const order *by) {
  const mesh_stage from = *all;
  for (int i = 0; i < LIGHTS; i++) all->set.lights[i] = from.set.lights[by->lights[i]];
  for (int i = 0; i < VOLUMES; i++) all->set.volumes[i] = from.set.volumes[by->volumes[i]];
  for (int i = 0; i < MESHES; i++) all->meshes[i] = from.meshes[by->meshes[i]];
}

/* A picture and its layers. Lights are in the order of the built scene. */
typedef struct frame_made {
  float pixels[PIXELS * 4], lights[LIGHTS][PIXELS * 3], shadows[LIGHTS][PIXELS * 3], depth[PIXELS],
      object[PIXELS];
} frame_made;

/* Returns the number that an object of the ordered scene has in the built scene. */
static float object_in_built(const order *by, float object) {
  const int number = (int)object;
  if (number == 0) return 0;
  if (number <= VOLUMES) return (float)(by->volumes[number - 1] + 1);
  return (float)(VOLUMES + by->meshes[number - VOLUMES - 1] + 1);
}

static void render(mesh_stage *all, const order *by, frame_made *made) {
  hl_light_layers lights[LIGHTS];
  hl_layers layers = {.struct_size = sizeof layers,
                      .lights = lights,
                      .light_count = LIGHTS,
                      .depth_first = made->depth,
                      .object = made->object};
  for (int l = 0; l < LIGHTS; l++) {
    const int built = by->lights[l];
    lights[l] = (hl_light_layers){made->lights[built], made->shadows[built]};
  }
  stage_render_layers(&all->set, NULL, made->pixels, &layers);
  for (int p = 0; p < PIXELS; p++) made->object[p] = object_in_built(by, made->object[p]);
}

/* Shadows are off, hard, and soft by each method. "sky" has hard shadows under a sky. */
static const char *const KINDS[] = {"off", "hard", "sky", "cascade", "paper", "sublights"};
enum { KIND_COUNT = sizeof KINDS / sizeof *KINDS };

static void choose(mesh_stage *all, int kind) {
  hl_render_settings *settings = &all->set.scene.render;
  settings->shadows = kind == 0 ? HL_SHADOWS_OFF : kind <= 2 ? HL_SHADOWS_HARD : HL_SHADOWS_SOFT;
  settings->soft_method = kind == 4 ? HL_SOFT_PAPER : kind == 5 ? HL_SOFT_SUBLIGHTS : HL_SOFT_CASCADE;
  settings->light_samples = 2;
  if (kind == 2) all->set.scene.sky.type = HL_SKY_UNIFORM;
}

static frame_made as_built, in_order;

static void assert_objects_seen(const float *object) {
  bool seen[VOLUMES + MESHES + 1] = {false};
  for (int p = 0; p < PIXELS; p++) seen[(int)object[p]] = true;
  for (int i = 1; i <= VOLUMES + MESHES; i++) assert_true(seen[i]);
}

static void test_orders(void **state) {
  (void)state;
  for (int kind = 0; kind < KIND_COUNT; kind++)
    for (int number = 0; number < ORDERS; number++) {
      mesh_stage all;
      const order by = order_of(number);
      build(&all, false);
      choose(&all, kind);
      put_in_order(&all, &by);
      render(&all, &by, number == 0 ? &as_built : &in_order);
      mesh_stage_close(&all);
      if (number == 0) assert_objects_seen(as_built.object);
      else if (memcmp(&as_built, &in_order, sizeof as_built) != 0)
        fail_msg("%s: order %d of %d gives other bytes", KINDS[kind], number, ORDERS);
    }
}

/* The order does not matter for volumes that differ in their voxels, but not in their histograms. */
static void test_alike(void **state) {
  (void)state;
  for (int number = 0; number < ORDERS; number += LIGHT_ORDERS) {
    mesh_stage all;
    const order by = order_of(number);
    build(&all, true);
    choose(&all, 1);
    put_in_order(&all, &by);
    render(&all, &by, number == 0 ? &as_built : &in_order);
    mesh_stage_close(&all);
    if (number > 0) assert_memory_equal(as_built.pixels, in_order.pixels, sizeof as_built.pixels);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_orders), cmocka_unit_test(test_alike)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
