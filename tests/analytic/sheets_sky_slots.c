/* analytic/sheets_sky_slots.c - the light of an even sky on the floor of a slot. Another program traced rays
 * through the same field. */
#include <stdlib.h>

#include "../asserts.h"
#include "reference_stage.h"

enum { WIDTH = 32, HEIGHT = 16, ACROSS = 68, ALONG = 100, FLOOR = 6 };

/* A block with a slot from above down to the slot's floor. Below a roof the slot widens to a room. half: half
 * of the slot's width, in voxels. */
typedef struct slot {
  int half, depth, roof; /* roof: the thickness of the roof; 0: there is no room */
  double light;          /* the mean light over the middle four fifths of the floor's width */
} slot;

/* The expected light, traced by another program through the B-spline's field with 12,100 rays at each of 16
 * places. Matter weakens a ray by its opacity. */
static const slot SLOTS[] = {{8, 8, 0, 0.682},   {8, 16, 0, 0.437},  {4, 8, 0, 0.466},
                             {4, 16, 0, 0.249},  {4, 24, 0, 0.161},  {12, 24, 4, 0.415},
                             {16, 32, 4, 0.391}, {10, 20, 4, 0.427}, {8, 24, 4, 0.303}};

static bool is_solid(const slot *of, int x, int y, int z) {
  if (x < 2 || y < 2 || x >= ACROSS - 2 || y >= ALONG - 2 || z < 2 || z >= FLOOR + of->depth) return false;
  if (z < FLOOR || y < 6 || y >= ALONG - 6) return true;
  if (x >= ACROSS / 2 - of->half && x < ACROSS / 2 + of->half) return false;
  return of->roof == 0 || z >= FLOOR + of->depth - of->roof || x < 6 || x >= ACROSS - 6;
}

static void add_block(stage *set, const slot *of) {
  const size_t slices = (size_t)of->depth + 8, count = slices * ALONG * ACROSS;
  float *voxels = malloc(count * sizeof *voxels);
  assert_non_null(voxels);
  for (size_t i = 0; i < count; i++)
    voxels[i] = is_solid(of, (int)(i % ACROSS), (int)(i / ACROSS % ALONG), (int)(i / ACROSS / ALONG));
  hl_scene_volume *block = stage_add_grid(set, (size_t[3]){ACROSS, ALONG, slices}, (double[3]){1, 1, 1},
                                          (vec3){-ACROSS / 2.0, -ALONG / 2.0, 0}, voxels);
  free(voxels);
  static const hl_opacity_point edge[] = {{0.3, 0}, {0.7, 0.99}};
  block->transfer_function.opacity = edge;
  block->transfer_function.opacity_count = 2;
  block->shading = HL_SHADING_PHONG;
  block->material = (hl_material){.diffuse = 1};
}

static void test_floors_of_slots(void **state) {
  (void)state;
  static float pixels[WIDTH * HEIGHT * 4];
  for (size_t k = 0; k < sizeof SLOTS / sizeof *SLOTS; k++) {
    const slot *of = &SLOTS[k];
    stage set;
    stage_open(&set);
    set.scene.width = WIDTH;
    set.scene.height = HEIGHT;
    set.scene.camera.height = 0.8 * of->half;
    set.scene.sky.type = HL_SKY_UNIFORM;
    stage_look(&set, (vec3){0, 0, 200}, (vec3){0, 0, 0}, (vec3){0, 1, 0});
    add_block(&set, of);
    stage_render_sheets(&set, pixels);
    double mean = 0;
    for (int i = 0; i < WIDTH * HEIGHT; i++) mean += (double)pixels[4 * i] / (WIDTH * HEIGHT);
    print_message("# slot of half %d, depth %d, roof %d: %+.4f of its light\n", of->half, of->depth, of->roof,
                  mean / of->light - 1);
    assert_near(mean, of->light, 0.045 * of->light);
    stage_close(&set);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_floors_of_slots)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
