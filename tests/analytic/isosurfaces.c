/* analytic/isosurfaces.c - the surfaces of one value of a volume: their places, the light that they take, and
 * their shadows, against closed forms. The B-spline of voxels x^2 is x^2 + 1/3, because its variance along an
 * axis is 1/3. So voxels |p - c|^2 have the field |p - c|^2 + 1, and a surface of one value is exactly a
 * sphere. */
#include <stdlib.h>
#include <string.h>

#include "../asserts.h"
#include "core/context.h"
#include "grid/make_grid.h"
#include "grid/relevant.h"
#include "isosurface/cubes.h"
#include "isosurface/isosurface.h"
#include "reference_stage.h"
#include "render/hot.h"
#include "scene/geometry/placement.h"

enum { SIDE = 64, PIXELS = SIDE * SIDE, VOXELS = 44 };

/* Adds voxels whose value is minus the squared distance from `centre`, so that values are greater inside a
 * ball. Distances count in voxels from the grid's middle. Voxels are one unit wide, and the grid's middle is
 * the origin. */
static hl_scene_volume *add_ball(stage *set, vec3 centre) {
  static float voxels[VOXELS * VOXELS * VOXELS];
  const size_t dimensions[3] = {VOXELS, VOXELS, VOXELS};
  const double middle = VOXELS / 2.0 - 0.5, spacing[3] = {1, 1, 1};
  for (int i = 0; i < VOXELS * VOXELS * VOXELS; i++) {
    vec3 p = {i % VOXELS - middle, i / VOXELS % VOXELS - middle, i / VOXELS / VOXELS - middle};
    vec3 off = vec3_subtract(p, centre);
    voxels[i] = (float)-vec3_dot(off, off);
  }
  hl_scene_volume *ball = stage_add_grid(set, dimensions, spacing,
                                         (vec3){-VOXELS / 2.0, -VOXELS / 2.0, -VOXELS / 2.0}, voxels);
  stage_set_opacity(set, ball, 0, 1);
  ball->material = (hl_material){.diffuse = 1};
  ball->shading = HL_SHADING_PHONG;
  return ball;
}

static hl_isosurface surface_of(double radius, double opacity) {
  return (hl_isosurface){.value = -radius * radius - 1, .color = {1, 1, 1}, .opacity = opacity};
}

static void open_stage(stage *set) {
  stage_open(set);
  set->scene.width = set->scene.height = SIDE;
  set->scene.camera.height = 40;
  stage_look(set, (vec3){0, 0, 100}, (vec3){0, 0, 0}, (vec3){0, 1, 0});
}

/* ---- where the surface lies ---- */

/* Extracts the mesh of the scene's only isosurface, in world space. goes_on: whether another volume touches
 * the box's face at the greatest x. */
static hl_mesh *mesh_beside(const stage *set, double value, bool goes_on) {
  hl_mesh *mesh = NULL;
  hl_pool *pool = NULL;
  hl_error error = {0};
  grid grid;
  const hl_scene_volume *volume = &set->volumes[0];
  const kernel *kernel = hl_kernel_get(set->scene.render.kernel);
  const grid_source source = {volume, kernel, volume->volume->index_to_world,
                              hl_scene_volume_empty_value(volume)};
  const grid_functions *functions = hl_hot_functions(HL_INSTRUCTION_SET_SCALAR)->grid;
  hl_status status = hl_pool_create(set->context, 1, &pool, &error);
  if (status == HL_OK) status = hl_grid_create(set->context, pool, functions, &source, &grid, &error);
  if (status == HL_OK && goes_on) grid.face_high[0] = FACE_FAR_OUT;
  if (status == HL_OK) status = hl_isosurface_create(pool, volume, &grid, kernel, value, NULL, &mesh, &error);
  if (status != HL_OK) fail_msg("%s", error.message);
  hl_grid_release(set->context, &grid);
  hl_pool_destroy(pool);
  return mesh;
}

static hl_mesh *mesh_of(const stage *set, double value) { return mesh_beside(set, value, false); }

static vec3 point_of(const hl_mesh_description *d, const uint32_t corner[3], const double weight[3]) {
  vec3 sum = {0, 0, 0};
  for (int i = 0; i < 3; i++) {
    const float *p = d->positions[corner[i]];
    sum = vec3_add(sum, vec3_scale((vec3){p[0], p[1], p[2]}, weight[i]));
  }
  return sum;
}

/* Vertices lie on the sphere to a ten-thousandth of a voxel, and all points of triangles to 0.02 voxels.
 * Normals are the sphere's. The surface is closed, and encloses the ball's volume. */
static void test_ball(void **state) {
  (void)state;
  static const double weights[7][3] = {{1, 0, 0},
                                       {0, 1, 0},
                                       {0, 0, 1},
                                       {0.5, 0.5, 0},
                                       {0, 0.5, 0.5},
                                       {0.5, 0, 0.5},
                                       {1.0 / 3, 1.0 / 3, 1.0 / 3}};
  static const double radii[] = {5, 7, 12.4, 18.6};
  for (size_t r = 0; r < sizeof radii / sizeof *radii; r++) {
    stage set;
    open_stage(&set);
    vec3 centre = {0.31, -0.22, 0.17 * (double)r};
    (void)add_ball(&set, centre);
    hl_mesh *mesh = mesh_of(&set, -radii[r] * radii[r] - 1);
    const hl_mesh_description *d = hl_mesh_describe(mesh);
    double volume = 0;
    for (size_t t = 0; t < d->triangle_count; t++) {
      vec3 corner[3];
      for (int w = 0; w < 7; w++) {
        vec3 off = vec3_subtract(point_of(d, d->triangles[t], weights[w]), centre);
        assert_near(vec3_length(off), radii[r], w < 3 ? 1e-4 : 0.02);
        if (w < 3) corner[w] = off;
      }
      volume += vec3_dot(corner[0], vec3_cross(corner[1], corner[2])) / 6;
    }
    for (size_t v = 0; v < d->vertex_count; v++) {
      vec3 off = vec3_subtract((vec3){d->positions[v][0], d->positions[v][1], d->positions[v][2]}, centre);
      vec3 normal = {d->normals[v][0], d->normals[v][1], d->normals[v][2]};
      assert_near(vec3_dot(vec3_normalise(off), normal), 1, 1e-5);
    }
    double exact = 4 * HL_PI / 3 * radii[r] * radii[r] * radii[r];
    assert_near(volume / exact, 1, 0.05 / radii[r]);
    assert_true(mesh->closed);
    hl_mesh_release(mesh);
    stage_close(&set);
  }
}

/* Voxels are twenty times as long along z as across. The B-spline reconstructs an ellipsoid exactly, except
 * for a constant. Every point of a triangle lies within 0.02 of the smallest edge from the ellipsoid, along
 * its normal. across, along: the ellipsoid's radii. */
static void check_long_voxels(double across, double along) {
  static const double weights[4][3] = {
      {0.5, 0.5, 0}, {0, 0.5, 0.5}, {0.5, 0, 0.5}, {1.0 / 3, 1.0 / 3, 1.0 / 3}};
  static const double LONG = 20;
  static float voxels[VOXELS * VOXELS * VOXELS];
  const double middle = VOXELS / 2.0 - 0.5, spacing[3] = {1, 1, LONG}, half = VOXELS / 2.0;
  for (int i = 0; i < VOXELS * VOXELS * VOXELS; i++) {
    vec3 p = {i % VOXELS - middle, i / VOXELS % VOXELS - middle, LONG * (i / VOXELS / VOXELS - middle)};
    voxels[i] = (float)-((p.x * p.x + p.y * p.y) / (across * across) + p.z * p.z / (along * along));
  }
  stage set;
  open_stage(&set);
  hl_scene_volume *volume = stage_add_grid(&set, (size_t[3]){VOXELS, VOXELS, VOXELS}, spacing,
                                           (vec3){-half, -half, -half * LONG}, voxels);
  stage_set_opacity(&set, volume, 0, 1);
  const double blur = 2.0 / 3 / (across * across) + LONG * LONG / 3 / (along * along);
  hl_mesh *mesh = mesh_of(&set, -1 - blur);
  const hl_mesh_description *d = hl_mesh_describe(mesh);
  assert_true(mesh->closed);
  for (size_t t = 0; t < d->triangle_count; t++)
    for (int w = 0; w < 4; w++) {
      const vec3 p = point_of(d, d->triangles[t], weights[w]);
      const vec3 slope = {2 * p.x / (across * across), 2 * p.y / (across * across),
                          2 * p.z / (along * along)};
      const double over = (p.x * p.x + p.y * p.y) / (across * across) + p.z * p.z / (along * along) - 1;
      assert_near(over / vec3_length(slope), 0, 0.02);
    }
  hl_mesh_release(mesh);
  stage_close(&set);
}

/* Within a voxel's long edge, the ball bends by more than a voxel's short edge. */
static void test_long_voxels(void **state) {
  (void)state;
  check_long_voxels(20, 80);
  check_long_voxels(20, 20);
}

/* Every pattern of a cell's corners is tried. The pattern's triangles have all edges on which the value is
 * crossed, and the edges form closed loops. The pattern with inside and outside exchanged has the same
 * edges. */
static void test_patterns(void **state) {
  (void)state;
  static cube_triangles patterns[CUBE_PATTERNS];
  hl_cube_patterns(patterns);
  for (int p = 0; p < CUBE_PATTERNS; p++) {
    unsigned crossed = 0, used = 0;
    for (int edge = 0; edge < CUBE_EDGES; edge++) {
      int a = hl_cube_edge_corner(edge), b = a | 1 << edge / 4;
      if ((p >> a & 1) != (p >> b & 1)) crossed |= 1u << edge;
    }
    for (int t = 0; t < patterns[p].count; t++)
      for (int i = 0; i < 3; i++) used |= 1u << patterns[p].edge[t][i];
    assert_int_equal(used, crossed);
  }
  assert_int_equal(patterns[1].count, 1);
  assert_int_equal(patterns[0x0f].count, 2);
  assert_int_equal(patterns[0x69].count, 4);
}

/* Noise crosses the value everywhere, also on the box's faces. Within the box, the surface has no hole. */
static void test_noise_is_watertight(void **state) {
  (void)state;
  enum { N = 13 };
  static float voxels[N * N * N];
  const size_t dimensions[3] = {N, N, N};
  const double spacing[3] = {1, 1, 1};
  for (int i = 0; i < N * N * N; i++) {
    int x = i % N, y = i / N % N, z = i / N / N;
    bool border = x < 2 || y < 2 || z < 2 || x > N - 3 || y > N - 3 || z > N - 3;
    voxels[i] = border ? 0 : (float)((i * 2654435761u >> 8 & 255) / 100.0);
  }
  stage set;
  open_stage(&set);
  (void)stage_add_grid(&set, dimensions, spacing, (vec3){0, 0, 0}, voxels);
  hl_mesh *mesh = mesh_of(&set, 1.1);
  assert_true(mesh->closed);
  assert_true(hl_mesh_describe(mesh)->triangle_count > 500);
  hl_mesh_release(mesh);
  stage_close(&set);
}

static void clip_ball(hl_scene_volume *ball) {
  ball->clipped = 1;
  memcpy(ball->clip_min, (double[3]){-30, -30, -30}, sizeof ball->clip_min);
  memcpy(ball->clip_max, (double[3]){3.1, 30, 30}, sizeof ball->clip_max);
}

/* If the box cuts a ball, a cap closes the ball's surface, and the ball's inside lies behind all triangles.
 * If another volume touches the face, the ball stays open there. */
static void test_caps_close(void **state) {
  (void)state;
  stage set;
  open_stage(&set);
  clip_ball(add_ball(&set, (vec3){0, 0, 0}));
  hl_mesh *closed = mesh_beside(&set, -12 * 12 - 1, false), *open = mesh_beside(&set, -12 * 12 - 1, true);
  const size_t triangles = hl_mesh_describe(closed)->triangle_count;
  assert_true(triangles > hl_mesh_describe(open)->triangle_count);
  assert_true(closed->closed);
  for (size_t t = 0; t < triangles; t++) assert_int_equal(closed->insides[t], -1);
  assert_false(open->closed);
  hl_mesh_release(closed);
  hl_mesh_release(open);
  stage_close(&set);
}

/* The state of test_cancelled()'s cancel callback. The callback answers "stop" from question number stop_at
 * on. */
typedef struct questions {
  int asked, stop_at;
} questions;

static int answer(void *user_data) {
  questions *all = user_data;
  return all->asked++ >= all->stop_at;
}

/* An extraction that is cancelled at any step reports the cancellation and makes no surface. */
static void test_cancelled(void **state) {
  (void)state;
  stage set;
  hl_pool *pool = NULL;
  grid grid;
  open_stage(&set);
  const hl_scene_volume *volume = add_ball(&set, (vec3){0, 0, 0});
  const kernel *kernel = hl_kernel_get(set.scene.render.kernel);
  const grid_source source = {volume, kernel, volume->volume->index_to_world,
                              hl_scene_volume_empty_value(volume)};
  const grid_functions *functions = hl_hot_functions(HL_INSTRUCTION_SET_SCALAR)->grid;
  assert_int_equal(hl_pool_create(set.context, 1, &pool, NULL), HL_OK);
  assert_int_equal(hl_grid_create(set.context, pool, functions, &source, &grid, NULL), HL_OK);
  questions all = {0, 0};
  set.context->options.cancelled = answer;
  set.context->options.user_data = &all;
  hl_mesh *mesh = NULL;
  hl_status status = HL_ERROR_CANCELLED;
  while (status == HL_ERROR_CANCELLED) {
    all.asked = 0;
    hl_pool_resume(pool);
    status = hl_isosurface_create(pool, volume, &grid, kernel, -12 * 12 - 1, NULL, &mesh, NULL);
    assert_true(status == HL_OK || (status == HL_ERROR_CANCELLED && mesh == NULL));
    all.stop_at++;
  }
  /* the steps are: the inside, crossings, counts, vertices, triangles, refinement */
  assert_true(all.stop_at > 5);
  assert_int_equal(status, HL_OK);
  hl_mesh_release(mesh);
  hl_grid_release(set.context, &grid);
  hl_pool_destroy(pool);
  stage_close(&set);
}

/* ---- pictures ---- */

/* The silhouette of a spherical isosurface is an antialiased disk, which is the same at any distance between
 * sheets. */
static void test_silhouette(void **state) {
  (void)state;
  static float pixels[PIXELS * 4], coarse[PIXELS * 4];
  stage set;
  open_stage(&set);
  double radius = 14.3, pixel = 40.0 / SIDE, sum = 0;
  hl_isosurface surface = surface_of(radius, 1);
  hl_scene_volume *ball = add_ball(&set, (vec3){0, 0, 0});
  ball->iso = &surface, ball->iso_count = 1;
  (void)stage_add_directional(&set, (vec3){0.3, 0.2, -1});
  stage_render_sheets(&set, pixels);
  set.scene.render.sheet_spacing = 2;
  stage_render_sheets(&set, coarse);
  for (int i = 0; i < PIXELS; i++) {
    double x = (i % SIDE + 0.5 - SIDE / 2) * pixel, y = (i / SIDE + 0.5 - SIDE / 2) * pixel;
    double inside = (radius - sqrt(x * x + y * y)) / pixel, alpha = (double)pixels[4 * i + 3];
    if (fabs(inside) > 0.75) assert_near(alpha, inside > 0, 1e-6);
    else assert_near(alpha, fmin(fmax(inside + 0.5, 0), 1), 0.2);
    assert_near((double)coarse[4 * i + 3], alpha, 1e-6);
    sum += alpha;
  }
  assert_near(sqrt(sum * pixel * pixel / HL_PI), radius, 0.02);
  stage_close(&set);
}

/* Translucent surfaces take the same fraction of light at every angle, and each one covers what lies behind
 * it. For three balls within each other, the colours in the middle and at the rim of the outermost ball are
 * compared with products of the surfaces' opacities. */
static void test_translucent(void **state) {
  (void)state;
  static float pixels[PIXELS * 4];
  stage set;
  open_stage(&set);
  hl_isosurface surfaces[3] = {surface_of(6, 1), surface_of(16, 0.3), surface_of(11, 0.5)};
  hl_scene_volume *ball = add_ball(&set, (vec3){0, 0, 0});
  ball->iso = surfaces, ball->iso_count = 3;
  ball->material = (hl_material){.emission = 1};
  for (int s = 0; s < 3; s++)
    for (int c = 0; c < 3; c++) surfaces[s].color[c] = c == s;
  for (int k = 0; k < 2; k++) {
    set.scene.light_count = 0;
    (void)stage_add_directional(
        &set,
        k == 0 ? (vec3){0.2, 0.3, -1}
               : (vec3){0.2, 0.3, 1}); /* the light is on the eye's side of the balls, or behind the balls */
    stage_render_sheets(&set, pixels);
    const float *middle = pixels + 4 * (SIDE / 2 * SIDE + SIDE / 2), *rim = middle + 4 * 21;
    const float *outer = middle + 4 * 24;
    assert_near((double)middle[0], 0.7 * 0.5, 1e-5);
    assert_near((double)middle[1], 0.3, 1e-5);
    assert_near((double)middle[2], 0.7 * 0.5, 1e-5);
    assert_near((double)rim[3], 1 - 0.7 * 0.7, 1e-5);
    assert_near((double)outer[3], 1 - 0.7 * 0.7, 1e-5);
  }
  stage_close(&set);
}

static void choose_shadows(stage *set, int kind) {
  set->scene.render.shadows = kind == 0 ? HL_SHADOWS_HARD : HL_SHADOWS_SOFT;
  set->scene.render.soft_method = (hl_soft_method)(kind == 0 ? 0 : kind - 1);
  set->scene.render.light_samples = 4;
  set->lights[0].angular_diameter_deg = kind == 0 ? 0 : 8;
}

/* Behind the middle of a translucent ball, a wall gets the light that two crossings of the ball's surface
 * leave, by every method of shadows. The wall itself shades nothing. */
static void test_shadow(void **state) {
  (void)state;
  static float pixels[PIXELS * 4];
  for (int kind = 0; kind < 4; kind++) {
    stage set;
    open_stage(&set);
    hl_isosurface surface = surface_of(9, 0.4);
    hl_scene_volume *ball = add_ball(&set, (vec3){0, 0, 4});
    ball->iso = &surface, ball->iso_count = 1;
    ball->visible = 0;
    hl_scene_volume *wall = stage_add_box(&set, (vec3){-18, -18, -21}, (vec3){18, 18, -19});
    stage_set_opacity(&set, wall, 0.9999, 0.1);
    wall->shading = HL_SHADING_NONE;
    wall->material = (hl_material){.diffuse = 1};
    (void)stage_add_directional(&set, (vec3){0, 0, -1});
    choose_shadows(&set, kind);
    stage_render_sheets(&set, pixels);
    const float *middle = pixels + 4 * (SIDE / 2 * SIDE + SIDE / 2), *far = middle + 4 * 27;
    assert_near((double)middle[0] / (double)far[0], 0.6 * 0.6, kind == 1 ? 0.02 : 0.01);
    stage_close(&set);
  }
}

/* The scene has two isosurfaces of noise in haze, one of them translucent, with hard shadows. The reference
 * finds the surfaces as roots of the field along its rays. */
static void test_against_the_reference(void **state) {
  (void)state;
  static float sheets[PIXELS * 4], exact[PIXELS * 4], voxels[16 * 16 * 16];
  const size_t dimensions[3] = {16, 16, 16};
  const double spacing[3] = {2, 2, 2};
  for (int i = 0; i < 16 * 16 * 16; i++)
    voxels[i] = stage_noise(i % 16 * 0.3, i / 16 % 16 * 0.3, i / 256 * 0.3);
  stage set;
  open_stage(&set);
  hl_isosurface surfaces[2] = {{.value = 0.62, .color = {1, 0.5, 0.2}, .opacity = 1},
                               {.value = 0.5, .color = {0.2, 0.5, 1}, .opacity = 0.3}};
  hl_scene_volume *noise = stage_add_grid(&set, dimensions, spacing, (vec3){-16, -16, -16}, voxels);
  stage_set_opacity(&set, noise, 0.01, 1);
  noise->iso = surfaces, noise->iso_count = 2;
  noise->material = (hl_material){.ambient = 1, .diffuse = 0.7, .specular = 0.3, .shininess = 20};
  for (int c = 0; c < 3; c++) set.scene.ambient[c] = 0.1;
  (void)stage_add_directional(&set, (vec3){0.4, 0.3, -1});
  set.scene.width = set.scene.height = SIDE / 2;
  set.scene.camera.height = 32; /* the edges of the box lie on the edges of the picture */
  set.scene.render.shadow_resolution = 400;
  hl_reference_options options;
  hl_reference_options_defaults(&options);
  options.rays = 4;
  options.step = 0.5;
  stage_render_sheets(&set, sheets);
  stage_render(&set, &options, exact);
  double squares = 0, sum = 0;
  for (int i = 0; i < PIXELS; i++) { /* these are a quarter of the picture's floats */
    double difference = (double)sheets[i] - (double)exact[i];
    squares += difference * difference;
    sum += difference;
  }
  assert_near(sqrt(squares / (PIXELS)), 0, 0.022);
  assert_near(sum / PIXELS, 0, 0.004);
  stage_close(&set);
}

/* The picture has the same bytes with any number of threads, and with surfaces that the renderer has kept. */
static void test_threads(void **state) {
  (void)state;
  static float first[PIXELS * 4], other[PIXELS * 4];
  stage set;
  open_stage(&set);
  hl_isosurface surfaces[2] = {surface_of(12, 0.5), surface_of(8, 1)};
  hl_scene_volume *ball = add_ball(&set, (vec3){0.3, 0.1, 0});
  ball->iso = surfaces, ball->iso_count = 2;
  (void)stage_add_directional(&set, (vec3){0.4, 0.3, -1});
  for (int run = 0; run < 3; run++) {
    set.scene.render.threads = (const int[]){1, 2, 5}[run];
    stage_render_sheets(&set, run == 0 ? first : other);
    if (run > 0) assert_memory_equal(first, other, sizeof first);
  }
  hl_renderer *renderer = NULL;
  hl_error error = {0};
  assert_int_equal(hl_renderer_create(set.context, &renderer, &error), HL_OK);
  for (int run = 0; run < 2; run++) {
    stage_render_with(&set, renderer, other);
    assert_memory_equal(first, other, sizeof first);
  }
  surfaces[0].value -= 5; /* the first surface is made anew, and the second one is kept */
  stage_render_with(&set, renderer, other);
  stage_render_sheets(&set, first);
  assert_memory_equal(first, other, sizeof first);
  hl_renderer_destroy(renderer);
  stage_close(&set);
}

/* A renderer that keeps surfaces draws the same bytes as a new renderer after a neighbouring volume or a cut
 * has come, gone or moved. The neighbour touches the box where the surface meets it, so that the surface is
 * open there. The neighbour's matter is transparent. */
static void test_moved_neighbours(void **state) {
  (void)state;
  static const struct {
    double beside; /* the gap between the box's face and the neighbour */
    double cut;    /* the place at which a plane cuts the ball; 0: there is no plane */
  } steps[] = {{30, 0}, {0, 0}, {0, -2}, {30, -2}, {0, 3}, {0, 0}, {1, 0}};
  enum { STEPS = sizeof steps / sizeof *steps };
  static float kept[PIXELS * 4], fresh[STEPS][PIXELS * 4];
  stage set;
  open_stage(&set);
  hl_isosurface surface = surface_of(12, 1);
  hl_cut cut = {.type = HL_CUT_PLANE, .normal = {0, 1, 0}};
  hl_scene_volume *ball = add_ball(&set, (vec3){0, 0, 0});
  ball->iso = &surface, ball->iso_count = 1;
  clip_ball(ball);
  hl_scene_volume *neighbour = stage_add_box(&set, (vec3){3.1, -20, -20}, (vec3){20, 20, 20});
  stage_set_opacity(&set, neighbour, 0, 1);
  stage_look(&set, (vec3){80, 30, 100}, (vec3){0, 0, 0}, (vec3){0, 1, 0});
  (void)stage_add_directional(&set, (vec3){-0.4, -0.8, -1});
  hl_renderer *renderer = NULL;
  assert_int_equal(hl_renderer_create(set.context, &renderer, NULL), HL_OK);
  for (int i = 0; i < STEPS; i++) {
    neighbour->translate[0] = steps[i].beside;
    cut.point[1] = steps[i].cut;
    ball->cuts = &cut, ball->cut_count = steps[i].cut != 0;
    stage_render_with(&set, renderer, kept);
    stage_render_sheets(&set, fresh[i]);
    if (memcmp(kept, fresh[i], sizeof kept) != 0) fail_msg("step %d differs from a fresh renderer's", i);
    if (i > 0) assert_memory_not_equal(fresh[i - 1], fresh[i], sizeof kept);
  }
  hl_renderer_destroy(renderer);
  stage_close(&set);
}

/* A clip box cuts the surface off. */
static void test_clip(void **state) {
  (void)state;
  static float pixels[PIXELS * 4];
  stage set;
  open_stage(&set);
  hl_isosurface surface = surface_of(12, 1);
  hl_scene_volume *ball = add_ball(&set, (vec3){0, 0, 0});
  ball->iso = &surface, ball->iso_count = 1;
  clip_ball(ball);
  (void)stage_add_directional(&set, (vec3){0, 0, -1});
  stage_render_sheets(&set, pixels);
  double covered = 0;
  for (int x = 0; x < SIDE; x++) covered += (double)pixels[4 * (SIDE / 2 * SIDE + x) + 3];
  assert_near(covered * 40 / SIDE, 12 + 3.1, 0.05);
  stage_close(&set);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_ball),       cmocka_unit_test(test_long_voxels),
      cmocka_unit_test(test_patterns),   cmocka_unit_test(test_noise_is_watertight),
      cmocka_unit_test(test_caps_close), cmocka_unit_test(test_cancelled),
      cmocka_unit_test(test_silhouette), cmocka_unit_test(test_translucent),
      cmocka_unit_test(test_shadow),     cmocka_unit_test(test_against_the_reference),
      cmocka_unit_test(test_threads),    cmocka_unit_test(test_moved_neighbours),
      cmocka_unit_test(test_clip)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
