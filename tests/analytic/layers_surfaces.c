/* analytic/layers_surfaces.c - the layers of meshes and isosurfaces (depth, normal, object, shadow), against
 * closed forms, and the sum of all layers. Each closed form is tested on the sheets and on the reference. */
#include <stdlib.h>
#include <string.h>

#include "../asserts.h"
#include "mesh_stage.h"

enum { SIDE = 32, PIXELS = SIDE * SIDE, LIGHTS = 3 };

/* The buffers of all layers. */
typedef struct layer_set {
  float pixels[PIXELS * 4], ambient[PIXELS * 3], emission[PIXELS * 3], sky[PIXELS * 3],
      sky_shadow[PIXELS * 3], first[PIXELS], mean[PIXELS], normal[PIXELS * 3], object[PIXELS];
  float pictures[LIGHTS][PIXELS * 3], shadows[LIGHTS][PIXELS * 3];
} layer_set;

static void open_meshes(mesh_stage *all) {
  mesh_stage_open(all, SIDE, 16);
  stage_look(&all->set, (vec3){0, 0, 60}, (vec3){0, 0, 0}, (vec3){0, 1, 0});
}

static hl_scene_mesh *add_quad(mesh_stage *all, vec3 centre, vec3 u, vec3 v) {
  return mesh_stage_add(all, stage_make_quad(&all->set, centre, u, v));
}

static hl_scene_mesh *add_sphere(mesh_stage *all, vec3 centre, double radius) {
  const float sphere[1][4] = {{(float)centre.x, (float)centre.y, (float)centre.z, (float)radius}};
  hl_mesh_description d;
  hl_mesh *made = NULL;
  hl_mesh_description_defaults(&d);
  d.spheres = sphere, d.sphere_count = 1;
  assert_int_equal(hl_mesh_create(all->set.context, &d, &made, NULL), HL_OK);
  return mesh_stage_add(all, made);
}

static void render(stage *set, bool reference, layer_set *made) {
  hl_reference_options options;
  hl_light_layers lights[LIGHTS];
  memset(made, 0xff, sizeof *made); /* NaN shows which values were not written */
  for (size_t l = 0; l < LIGHTS; l++) lights[l] = (hl_light_layers){made->pictures[l], made->shadows[l]};
  const hl_layers wanted = {.struct_size = sizeof wanted,
                            .ambient = made->ambient,
                            .depth_first = made->first,
                            .depth_mean = made->mean,
                            .normal = made->normal,
                            .emission = made->emission,
                            .sky = made->sky,
                            .sky_shadow = made->sky_shadow,
                            .object = made->object,
                            .lights = lights,
                            .light_count = set->scene.light_count};
  hl_reference_options_defaults(&options);
  options.light_points = 12;
  options.step = 0.5;
  stage_render_layers(set, reference ? &options : NULL, made->pixels, &wanted);
}

/* ---- depth, normal and object ---- */

/* A slanted board fills the picture. Light travels with the eye's rays or against them. If light travels
 * against the eye's rays, another sweep measures depth. Sheets and reference are tested. */
static void test_plane(void **state) {
  (void)state;
  static layer_set made;
  const vec3 normal = vec3_normalise((vec3){0.4, -0.3, 1}), centre = {1, 2, -3};
  const vec3 u = vec3_normalise(vec3_cross((vec3){0, 1, 0}, normal)), v = vec3_cross(normal, u);
  for (int k = 0; k < 8; k++) {
    mesh_stage all;
    open_meshes(&all);
    /* the middle of the picture does not lie on the line where the board's two triangles meet */
    add_quad(&all, vec3_add(centre, vec3_scale(u, 50)), vec3_scale(u, 90), vec3_scale(v, 90));
    stage_add_directional(&all.set, k % 2 ? (vec3){0.1, 0.2, 1} : (vec3){0.1, 0.2, -1});
    if (k / 2 % 2 == 1) {
      all.set.scene.camera.type = HL_CAMERA_PERSPECTIVE;
      all.set.scene.camera.fovy_deg = 30;
      stage_look(&all.set, (vec3){-6, 4, 30}, (vec3){0, 0, 0}, (vec3){0, 1, 0});
    }
    render(&all.set, k >= 4, &made);
    for (int i = 0; i < PIXELS; i++) {
      vec3 origin, direction;
      stage_eye_ray(&all.set, i % SIDE, i / SIDE, &origin, &direction);
      double depth = vec3_dot(normal, vec3_subtract(centre, origin)) / vec3_dot(normal, direction);
      assert_near(made.first[i], depth, 1e-3);
      assert_near(made.mean[i], depth, 1e-3);
      assert_near(made.object[i], 2, 0);
      assert_near(made.normal[3 * i], normal.x, 1e-5);
      assert_near(made.normal[3 * i + 1], normal.y, 1e-5);
      assert_near(made.normal[3 * i + 2], normal.z, 1e-5);
    }
    mesh_stage_close(&all);
  }
}

/* The isosurface of a linear field is a plane of many triangles. However many of them share a pixel, the
 * pixel's depth is that at which its own ray meets the plane. A second plane lies behind the first. Planes
 * are also tested with so low an opacity that the first triangle covers less than a hundredth of a pixel's
 * light. */
static void test_depth_of_isosurface(void **state) {
  (void)state;
  enum { N = 28 };
  static layer_set made;
  static float voxels[N * N * N];
  static const hl_opacity_point clear[] = {{0, 0}};
  const vec3 rise = {0.02, 0.013, 0.03}, middle = {0.3, -0.2, 0.1};
  for (int i = 0; i < N * N * N; i++) {
    const vec3 at = {i % N - N / 2 + 0.5, i / N % N - N / 2 + 0.5, i / N / N - N / 2 + 0.5};
    voxels[i] = (float)(0.5 - vec3_dot(rise, vec3_subtract(at, middle)));
  }
  hl_isosurface iso[2];
  for (int n = 0; n < 2; n++) hl_isosurface_defaults(&iso[n]);
  iso[0].value = 0.5;
  iso[1].value = 0.62;
  for (int k = 0; k < 8; k++) {
    mesh_stage all;
    open_meshes(&all);
    if (k % 2 == 1) stage_look(&all.set, (vec3){50, 10, 30}, (vec3){0, 0, 0}, (vec3){0, 1, 0});
    hl_scene_volume *volume = stage_add_grid(&all.set, (size_t[3]){N, N, N}, (double[3]){1, 1, 1},
                                             (vec3){-N / 2, -N / 2, -N / 2}, voxels);
    volume->transfer_function.opacity = clear;
    volume->transfer_function.opacity_count = 1;
    iso[0].opacity = iso[1].opacity = k < 4 ? 1 : 0.1;
    volume->iso = iso;
    volume->iso_count = 2;
    stage_add_directional(&all.set, (vec3){0.1, 0.2, -1});
    render(&all.set, k / 2 % 2 == 1, &made);
    int count = 0;
    for (int i = 0; i < PIXELS; i++) {
      vec3 origin, direction;
      stage_eye_ray(&all.set, i % SIDE, i / SIDE, &origin, &direction);
      const double depth = vec3_dot(rise, vec3_subtract(middle, origin)) / vec3_dot(rise, direction);
      const vec3 at = vec3_add(origin, vec3_scale(direction, depth));
      if (fmax(fabs(at.x), fmax(fabs(at.y), fabs(at.z))) > N / 2 - 3) continue;
      assert_near(made.first[i], depth, 0.01);
      count++;
    }
    assert_true(count > 200);
    mesh_stage_close(&all);
  }
}

/* Returns the distance at which a ray meets a sphere; infinite if the ray misses the sphere. */
static double meet_sphere(vec3 origin, vec3 direction, vec3 centre, double radius) {
  vec3 away = vec3_subtract(origin, centre);
  double along = vec3_dot(away, direction), square = radius * radius - vec3_dot(away, away) + along * along;
  return square < 0 ? INFINITY : -along - sqrt(square);
}

/* One sphere stands partly before another. Each pixel has the number, depth and normal of the nearer sphere.
 */
static void test_two_spheres(void **state) {
  (void)state;
  static layer_set made;
  static const vec3 centre[2] = {{-2, 0.5, 0}, {2, -1, -4}};
  static const double radius[2] = {3.5, 4.5};
  for (int k = 0; k < 4; k++) {
    int seen[3] = {0, 0, 0};
    mesh_stage all;
    open_meshes(&all);
    for (int s = 0; s < 2; s++) add_sphere(&all, centre[s], radius[s]);
    stage_add_directional(&all.set, k % 2 ? (vec3){0.5, 0.2, 1} : (vec3){0.5, 0.2, -1});
    render(&all.set, k >= 2, &made);
    for (int i = 0; i < PIXELS; i++) {
      vec3 origin, direction;
      stage_eye_ray(&all.set, i % SIDE, i / SIDE, &origin, &direction);
      double depth[2], rim = INFINITY;
      for (int s = 0; s < 2; s++) {
        vec3 away = vec3_subtract(origin, centre[s]);
        away.z = 0;
        rim = fmin(rim, fabs(vec3_length(away) - radius[s]));
        depth[s] = meet_sphere(origin, direction, centre[s], radius[s]);
      }
      if (rim < 0.5) continue; /* silhouettes are antialiased */
      double nearest = fmin(depth[0], depth[1]);
      int object = isinf(nearest) ? 0 : nearest == depth[0] ? 1 : 2;
      seen[object]++;
      assert_near(made.object[i], object == 0 ? 0 : object + 1, 0);
      if (object == 0) {
        assert_true(isinf(made.first[i]) && isinf(made.mean[i]));
        continue;
      }
      vec3 at = vec3_add(origin, vec3_scale(direction, nearest)),
           normal = vec3_scale(vec3_subtract(at, centre[object - 1]), 1 / radius[object - 1]);
      assert_near(made.first[i], nearest, 0.02);
      assert_near(made.mean[i], nearest, 0.02);
      assert_near(made.normal[3 * i], normal.x, 0.01);
      assert_near(made.normal[3 * i + 1], normal.y, 0.01);
      assert_near(made.normal[3 * i + 2], normal.z, 0.01);
    }
    assert_true(seen[0] > 200 && seen[1] > 80 && seen[2] > 80);
    mesh_stage_close(&all);
  }
}

/* Returns the mean depth, times alpha, of matter with the extinction sigma. Depth counts from the place where
 * the ray enters the matter, which is `length` deep. The result is the integral of s sigma exp(-sigma s). */
static double depth_of_haze(double sigma, double length) {
  return 1 / sigma - exp(-sigma * length) * (length + 1 / sigma);
}

/* A pane of the opacity o stands in the middle of haze. The mean depth counts the haze before the pane, the
 * pane itself, and the haze that is seen through the pane. */
static void test_pane_in_haze(void **state) {
  (void)state;
  static layer_set made;
  for (int k = 0; k < 8; k++) {
    const double sigma = 0.1, opacity = k % 2 ? 0.4 : 1, half = exp(-4 * sigma);
    mesh_stage all;
    open_meshes(&all);
    hl_scene_volume *haze = stage_add_box(&all.set, (vec3){-12, -12, -4}, (vec3){12, 12, 4});
    stage_set_opacity(&all.set, haze, 1 - exp(-sigma), 1);
    add_quad(&all, (vec3){0, 0, 0}, (vec3){12, 0, 0}, (vec3){0, 12, 0})->opacity = opacity;
    stage_add_directional(&all.set, k / 2 % 2 ? (vec3){0.2, 0.1, 1} : (vec3){0.2, 0.1, -1});
    render(&all.set, k >= 4, &made);
    double behind = half * (1 - opacity), alpha = 1 - half + half * opacity + behind * (1 - half);
    double depth = depth_of_haze(sigma, 4) + half * opacity * 4 +
                   behind * (4 * (1 - half) + depth_of_haze(sigma, 4));
    for (int i = 0; i < PIXELS; i++) {
      assert_near(made.mean[i], 56 + depth / alpha, 0.004);
      assert_near(made.first[i], 56 - log(0.99) / sigma, 0.004);
      assert_near(made.object[i], 2, 0); /* the haze */
      assert_near(made.normal[3 * i + 2], half * opacity / alpha, 1e-3);
    }
    mesh_stage_close(&all);
  }
}

/* ---- shadow ---- */

/* A slanted floor lies below a coloured pane that the eye does not see. The angle between floor and light
 * shows in the light's layer, and not in its shadow's layer. The layer of the shadow is 1 under a light
 * without shadows, and on a floor that receives no shadows. */
static void test_shadow_of_pane(void **state) {
  (void)state;
  static layer_set made;
  for (int k = 0; k < 4; k++) {
    mesh_stage all;
    open_meshes(&all);
    hl_scene_mesh *floor = add_quad(&all, (vec3){0, 0, -4}, (vec3){20, 0, 10}, (vec3){0, 20, 0});
    hl_scene_mesh *pane = add_quad(&all, (vec3){0, 0, 16}, (vec3){40, 0, 0}, (vec3){0, 40, 0});
    floor->color[0] = 0.5;
    floor->receives_shadow = k < 2;
    pane->opacity = 0.6;
    pane->visible = 0;
    pane->attenuation_color[1] = 0.5;
    pane->attenuation_color[2] = 0;
    stage_add_directional(&all.set, (vec3){0, 0, -1})->intensity = 2;
    stage_add_directional(&all.set, (vec3){0, 0, -1})->shadows = HL_SHADOWS_OFF;
    render(&all.set, k % 2 == 1, &made);
    for (int i = 0; i < PIXELS; i++)
      for (int c = 0; c < 3; c++) {
        double shadow = k >= 2 ? 1 : 1 - 0.6 * (c == 0 ? 1 : c == 1 ? 0.5 : 0);
        assert_near(made.shadows[0][3 * i + c], shadow, 2e-3);
        assert_near(made.shadows[1][3 * i + c], 1, 1e-6);
        assert_near(made.pictures[0][3 * i + c], 2 * (c == 0 ? 0.5 : 1) / sqrt(1.25) * shadow, 5e-3);
      }
    mesh_stage_close(&all);
  }
}

/* A sphere hides half of its own surface from a light: the shadow's layer is 0 on that half, and 1 on the lit
 * half. On a pane that is lit from behind, the shadow's layer shows what the pane itself absorbs. */
static void test_own_shadow(void **state) {
  (void)state;
  static layer_set made;
  const vec3 towards = vec3_normalise((vec3){1, 0.2, 0.3});
  for (int k = 0; k < 2; k++) {
    mesh_stage all;
    open_meshes(&all);
    add_sphere(&all, (vec3){0, 0, 0}, 7);
    stage_add_directional(&all.set, vec3_scale(towards, -1));
    render(&all.set, k == 1, &made);
    int lit = 0, dark = 0;
    for (int i = 0; i < PIXELS; i++) {
      if (made.pixels[4 * i + 3] < 0.999f) continue;
      const float *n = made.normal + 3 * i;
      double cosine = vec3_dot((vec3){n[0], n[1], n[2]}, towards);
      /* near the terminator a shadow look-up gives a value between 0 and 1 */
      if (fabs(cosine) < 0.3) continue;
      assert_near(made.shadows[0][3 * i], cosine > 0 ? 1 : 0, 0.02);
      lit += cosine > 0;
      dark += cosine < 0;
    }
    assert_true(lit > 100 && dark > 100);
    all.meshes[0].visible = all.meshes[0].casts_shadow = 0;
    add_quad(&all, (vec3){0, 0, 0}, (vec3){9, 0, 2}, (vec3){0, 9, 0})->opacity = 0.3;
    all.set.lights[0].direction[0] = 0, all.set.lights[0].direction[1] = 0.1,
    all.set.lights[0].direction[2] = 1;
    render(&all.set, k == 1, &made);
    for (int i = 0; i < PIXELS; i++)
      if (fabs(i % SIDE - 15.5) < 10 && fabs(i / SIDE - 15.5) < 10)
        assert_near(made.shadows[0][3 * i], 0.7, 0.005);
    mesh_stage_close(&all);
  }
}

/* ---- the sum ---- */

static const hl_opacity_point CLEAR[] = {{0, 0}, {1, 0}};

/* Boards, a sphere and an isosurface stand in haze, under several lights and a sky. */
static void add_scenery(mesh_stage *all, const hl_isosurface *iso) {
  enum { N = 14 };
  static float voxels[N * N * N];
  for (int i = 0; i < N * N * N; i++) {
    double x = i % N - 6.5, y = i / N % N - 6.5, z = i / N / N - 6.5;
    voxels[i] = (float)fmin(fmax(0.5 + (3 - sqrt(x * x + y * y + z * z)) / 6, 0), 1);
  }
  hl_scene_volume *ball = stage_add_grid(&all->set, (size_t[3]){N, N, N}, (double[3]){1, 1, 1},
                                         (vec3){-7, -7, -5}, voxels);
  ball->transfer_function.opacity = CLEAR;
  ball->transfer_function.opacity_count = 2;
  ball->shading = HL_SHADING_PHONG;
  ball->material.emission = 0.1;
  ball->iso = iso;
  ball->iso_count = 1;
  stage_set_opacity(&all->set, stage_add_box(&all->set, (vec3){-8, -8, -6}, (vec3){8, 8, 5}), 0.03, 1);
  hl_scene_mesh *floor = add_quad(all, (vec3){0, 0, -6}, (vec3){9, 1, 1}, (vec3){-1, 9, 1});
  floor->material = (hl_material){.ambient = 1, .diffuse = 0.7, .specular = 0.4, .shininess = 9};
  floor->color[1] = 0.6;
  hl_scene_mesh *pane = add_quad(all, (vec3){3, 1, 3}, (vec3){3, 1, 2}, (vec3){-1, 4, -1});
  pane->opacity = 0.5;
  pane->material.emission = 0.3;
  pane->two_sided = 0;
  add_sphere(all, (vec3){-4, 2, 3}, 2)->color[2] = 0.2;
  all->set.scene.ambient[0] = all->set.scene.ambient[1] = 0.1;
  all->set.scene.sky.type = HL_SKY_UNIFORM;
  all->set.scene.sky.strength = 0.4;
  all->set.scene.render.shadows = HL_SHADOWS_SOFT;
  stage_add_directional(&all->set, (vec3){0.3, -0.4, -1})->angular_diameter_deg = 8;
  /* this light has sheets of its own */
  stage_add_directional(&all->set, (vec3){0.5, 0.3, 1})->color[1] = 0.3;
  hl_light *lamp = stage_add_point(&all->set, (vec3){20, 5, 25});
  lamp->falloff = HL_FALLOFF_INVERSE_SQUARE;
  lamp->intensity = 500;
  lamp->radius = 2;
  all->set.scene.camera.type = HL_CAMERA_PERSPECTIVE;
  all->set.scene.camera.fovy_deg = 30;
  stage_look(&all->set, (vec3){20, -25, 30}, (vec3){0, 0, -1}, (vec3){0, 0, 1});
}

static void test_sum_is_the_picture(void **state) {
  (void)state;
  static layer_set made[2];
  hl_isosurface iso;
  hl_isosurface_defaults(&iso);
  iso.value = 0.5;
  mesh_stage all;
  open_meshes(&all);
  add_scenery(&all, &iso);
  double shadows = 0, sky = 0;
  int same = 0, seen = 0;
  for (int reference = 0; reference < 2; reference++) {
    layer_set *m = &made[reference];
    render(&all.set, reference == 1, m);
    for (int i = 0; i < PIXELS * 3; i++) {
      double sum = (double)m->ambient[i] + (double)m->emission[i] + (double)m->sky[i];
      for (int l = 0; l < LIGHTS; l++) sum += (double)m->pictures[l][i];
      assert_near(sum, m->pixels[i / 3 * 4 + i % 3], 3e-6);
    }
  }
  for (int i = 0; i < PIXELS; i++) {
    if (made[0].pixels[4 * i + 3] < 0.5f || made[1].pixels[4 * i + 3] < 0.5f) continue;
    seen++;
    same += made[0].object[i] == made[1].object[i];
    for (int l = 0; l < LIGHTS; l++)
      shadows += fabs((double)made[0].shadows[l][3 * i] - (double)made[1].shadows[l][3 * i]);
    sky += fabs((double)made[0].sky_shadow[3 * i] - (double)made[1].sky_shadow[3 * i]);
  }
  assert_true(seen > 400 && same >= seen * 0.97);
  assert_near(shadows / (LIGHTS * seen), 0, 0.04);
  assert_near(sky / seen, 0, 0.06);
  mesh_stage_close(&all);
}

/* The picture is the same with layers and without. Layers do not depend on the number of threads. In the
 * layer of objects, an isosurface has the number of its volume. */
static void test_same_bytes(void **state) {
  (void)state;
  static layer_set one, three;
  static float alone[PIXELS * 4];
  hl_isosurface iso;
  hl_isosurface_defaults(&iso);
  iso.value = 0.5;
  mesh_stage all;
  open_meshes(&all);
  add_scenery(&all, &iso);
  all.set.scene.render.threads = 1;
  render(&all.set, false, &one);
  stage_render_sheets(&all.set, alone);
  all.set.scene.render.threads = 3;
  render(&all.set, false, &three);
  assert_memory_equal(one.pixels, alone, sizeof alone);
  assert_memory_equal(&one, &three, sizeof one);
  all.set.volumes[2].visible = 0; /* the haze */
  render(&all.set, false, &one);
  int objects[7] = {0};
  for (int i = 0; i < PIXELS; i++) {
    assert_true(one.object[i] >= 0 && one.object[i] <= 6);
    objects[(int)one.object[i]]++;
  }
  assert_true(objects[1] == 0 && objects[2] > 10 && objects[3] == 0 && objects[4] > 100 && objects[5] > 20 &&
              objects[6] > 10);
  mesh_stage_close(&all);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_depth_of_isosurface), cmocka_unit_test(test_plane),
      cmocka_unit_test(test_two_spheres),         cmocka_unit_test(test_pane_in_haze),
      cmocka_unit_test(test_shadow_of_pane),      cmocka_unit_test(test_own_shadow),
      cmocka_unit_test(test_sum_is_the_picture),  cmocka_unit_test(test_same_bytes)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
