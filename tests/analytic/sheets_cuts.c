/* analytic/sheets_cuts.c - planes, boxes and spheres that cut a volume, by the sheets and by the reference.
 * The alpha of even matter follows from the length that cuts leave of each ray. Other tests are about cut
 * faces under light, and about shadows of matter that is cut away. */
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "reference_stage.h"

enum { SIDE = 40, FLOATS = SIDE * SIDE * 4, VOXELS = 20, FACE_SIDE = 96 };

static const double HALF = VOXELS / 2.0, OPACITY = 0.08;

static void open_stage(stage *set, const hl_context_options *options) {
  stage_open_with(set, options);
  set->scene.width = set->scene.height = SIDE;
  set->scene.camera.height = 38;
  stage_look(set, (vec3){23, 41, 60}, (vec3){0, 0, 0}, (vec3){0, 1, 0});
}

/* Adds a cube of even matter around the origin. */
static hl_scene_volume *add_cube(stage *set, double opacity) {
  hl_scene_volume *cube = stage_add_grid(set, (size_t[3]){VOXELS, VOXELS, VOXELS}, (double[3]){1, 1, 1},
                                         (vec3){-HALF, -HALF, -HALF}, NULL);
  stage_set_opacity(set, cube, opacity, 1);
  return cube;
}

static void cut(hl_scene_volume *volume, const hl_cut *cuts, size_t count) {
  volume->cuts = cuts;
  volume->cut_count = count;
}

/* ---- lengths: found by many points along a ray, independent of any formula for crossings ---- */

static double part(vec3 v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

static bool is_left(const hl_cut *cut, vec3 p) {
  bool inside = true;
  if (cut->type == HL_CUT_PLANE)
    inside = vec3_dot(vec3_of(cut->normal), vec3_subtract(p, vec3_of(cut->point))) > 0;
  if (cut->type == HL_CUT_SPHERE) inside = vec3_length(vec3_subtract(p, vec3_of(cut->center))) < cut->radius;
  for (int a = 0; a < 3 && cut->type == HL_CUT_BOX; a++)
    inside = inside && part(p, a) > cut->min[a] && part(p, a) < cut->max[a];
  return inside == (cut->keep == HL_CUT_KEEP_INSIDE);
}

static double length_left(const hl_scene_volume *volume, vec3 origin, vec3 way) {
  enum { STEPS = 40000 };
  const double from = 20, to = 140;
  int left = 0;
  for (int i = 0; i < STEPS; i++) {
    vec3 p = vec3_add(origin, vec3_scale(way, from + (to - from) * (i + 0.5) / STEPS));
    bool here = fabs(p.x) < HALF && fabs(p.y) < HALF && fabs(p.z) < HALF;
    for (size_t c = 0; c < volume->cut_count && here; c++) here = is_left(&volume->cuts[c], p);
    left += here;
  }
  return left * (to - from) / STEPS;
}

static void assert_lengths(stage *set, bool reference, double tolerance) {
  static float pixels[FLOATS];
  stage_render_by(set, reference, pixels);
  for (int p = 0; p < SIDE * SIDE; p += 7) {
    vec3 origin, way;
    stage_eye_ray(set, p % SIDE, p / SIDE, &origin, &way);
    double alpha = 1 - pow(1 - OPACITY, length_left(&set->volumes[0], origin, way));
    if (!(fabs((double)pixels[4 * p + 3] - alpha) <= tolerance))
      fail_msg("pixel %d: alpha is %.6f, not %.6f", p, (double)pixels[4 * p + 3], alpha);
  }
}

static const hl_cut PLANE[] = {{.type = HL_CUT_PLANE, .point = {1, 2, -1.3}, .normal = {3, -1, 4}}};
static const hl_cut WEDGE[] = {{.type = HL_CUT_PLANE, .point = {1, 2, 0}, .normal = {3, -1, 4}},
                               {.type = HL_CUT_PLANE, .point = {0, -2, 0}, .normal = {0, -1, 0.2}},
                               {.type = HL_CUT_PLANE, .point = {-6, 0, 0}, .normal = {-2, 1, 1}}};
static const hl_cut OCTANT[] = {{.type = HL_CUT_BOX, .min = {0.3, -1.2, 0}, .max = {40, 40, 40}}};
static const hl_cut KEPT[] = {
    {.type = HL_CUT_BOX, .min = {-5.5, -7.1, -4}, .max = {6, 3, 20}, .keep = HL_CUT_KEEP_INSIDE}};
static const hl_cut BALL[] = {{.type = HL_CUT_SPHERE, .center = {2, 4, 7}, .radius = 8}};
static const hl_cut SHELL[] = {
    {.type = HL_CUT_SPHERE, .center = {0, 0, 0}, .radius = 9, .keep = HL_CUT_KEEP_INSIDE},
    {.type = HL_CUT_SPHERE, .center = {0, 0, 0}, .radius = 6},
    {.type = HL_CUT_PLANE, .point = {0, 0, 2}, .normal = {0, 0, 1}}};

static const struct {
  const hl_cut *cuts;
  size_t count;
} SHAPES[] = {{PLANE, 1}, {WEDGE, 3}, {OCTANT, 1}, {KEPT, 1}, {BALL, 1}, {SHELL, 3}};

static void test_lengths(void **state) {
  (void)state;
  for (size_t i = 0; i < sizeof SHAPES / sizeof *SHAPES; i++)
    for (int perspective = 0; perspective < 2; perspective++) {
      stage set;
      open_stage(&set, NULL);
      if (perspective) set.scene.camera.type = HL_CAMERA_PERSPECTIVE;
      cut(add_cube(&set, OPACITY), SHAPES[i].cuts, SHAPES[i].count);
      assert_lengths(&set, true, 0.0005);
      assert_lengths(&set, false, 0.0005);
      stage_close(&set);
    }
}

/* ---- the same box by a clip box and by cuts ---- */

/* Returns the root mean square difference of two pictures. If two scenes have other content, their sheets lie
 * elsewhere, and single pixels at edges differ by more. */
static double difference(const float *a, const float *b) {
  double sum = 0;
  for (int i = 0; i < FLOATS; i++) sum += ((double)a[i] - (double)b[i]) * ((double)a[i] - (double)b[i]);
  return sqrt(sum / FLOATS);
}

static const hl_cut SIX_PLANES[] = {{.type = HL_CUT_PLANE, .point = {-5.5, 0, 0}, .normal = {-1, 0, 0}},
                                    {.type = HL_CUT_PLANE, .point = {6, 0, 0}, .normal = {2, 0, 0}},
                                    {.type = HL_CUT_PLANE, .point = {0, -7.1, 0}, .normal = {0, -1, 0}},
                                    {.type = HL_CUT_PLANE, .point = {0, 3, 0}, .normal = {0, 1, 0}},
                                    {.type = HL_CUT_PLANE, .point = {0, 0, -4}, .normal = {0, 0, -1}},
                                    {.type = HL_CUT_PLANE, .point = {0, 0, 2.3}, .normal = {0, 0, 1}}};
static const hl_cut A_BOX[] = {
    {.type = HL_CUT_BOX, .min = {-5.5, -7.1, -4}, .max = {6, 3, 2.3}, .keep = HL_CUT_KEEP_INSIDE}};

static const hl_opacity_point SURFACE[] = {{0, 0}, {0.2, 0}, {0.45, 0.7}, {1, 0.9}};

static void open_noise(stage *set, hl_soft_method method, hl_instruction_set instructions) {
  static float voxels[VOXELS * VOXELS * VOXELS];
  for (int i = 0; i < VOXELS * VOXELS * VOXELS; i++)
    voxels[i] = stage_noise(0.4 * (i % VOXELS), 0.4 * (i / VOXELS % VOXELS), 0.4 * (i / VOXELS / VOXELS));
  hl_context_options options;
  hl_context_options_defaults(&options);
  options.instruction_set = instructions;
  open_stage(set, &options);
  hl_scene_volume *noise = stage_add_grid(set, (size_t[3]){VOXELS, VOXELS, VOXELS}, (double[3]){1, 1, 1},
                                          (vec3){-HALF, -HALF, -HALF}, voxels);
  noise->transfer_function.opacity = SURFACE;
  noise->transfer_function.opacity_count = 4;
  noise->shading = HL_SHADING_PHONG;
  noise->cut_shading = HL_CUT_SHADING_GRADIENT;
  stage_add_directional(set, (vec3){-0.5, -0.8, -0.6})->angular_diameter_deg = 5;
  set->scene.render.shadows = HL_SHADOWS_SOFT;
  set->scene.render.soft_method = method;
}

/* A clip box and planes leave the same faces, by each rule by which faces are lit. */
static void test_as_a_clip_box(void **state) {
  (void)state;
  static float clipped[FLOATS], planes[FLOATS], box[FLOATS];
  for (int n = 0; n < 9; n++) {
    int method = n % 3, shading = n / 3;
    stage set;
    open_noise(&set, (hl_soft_method)method, HL_INSTRUCTION_SET_AUTO);
    set.volumes[0].cut_shading = (hl_cut_shading)shading;
    memcpy(set.volumes[0].clip_min, A_BOX[0].min, sizeof A_BOX[0].min);
    memcpy(set.volumes[0].clip_max, A_BOX[0].max, sizeof A_BOX[0].max);
    set.volumes[0].clipped = 1;
    stage_render_sheets(&set, clipped);
    set.volumes[0].clipped = 0;
    cut(&set.volumes[0], SIX_PLANES, 6);
    stage_render_sheets(&set, planes);
    cut(&set.volumes[0], A_BOX, 1);
    stage_render_sheets(&set, box);
    stage_close(&set);
    print_message("# method %d, shading %d: planes differ from a clip box by %.5f, a box by %.5f\n", method,
                  shading, difference(planes, clipped), difference(box, clipped));
    /* normals of gradients change within a voxel */
    double most = shading == HL_CUT_SHADING_GRADIENT ? 0.003 : 0.004;
    assert_true(difference(planes, clipped) < most);
    assert_true(difference(box, clipped) < most);
  }
}

/* ---- cuts of a scene ---- */

static void turn(hl_scene_volume *volume) {
  static const double axis[3] = {1, -2, 0.7}, aside[3] = {3, -2, 1.5};
  volume->scale = 0.8;
  memcpy(volume->rotate_axis, axis, sizeof axis);
  volume->rotate_angle_deg = 35;
  memcpy(volume->translate, aside, sizeof aside);
}

/* Converts a point of the world to the file coordinates of a turned volume. */
static vec3 unturned(const hl_scene_volume *volume, vec3 p) {
  vec3 axis = vec3_normalise(vec3_of(volume->rotate_axis));
  mat3 back = mat3_rotation(axis, -volume->rotate_angle_deg * HL_PI / 180);
  return vec3_scale(mat3_apply(back, vec3_subtract(p, vec3_of(volume->translate))), 1 / volume->scale);
}

static const hl_cut IN_WORLD[] = {
    {.type = HL_CUT_PLANE, .point = {1, 2, -1.3}, .normal = {3, -1, 4}},
    {.type = HL_CUT_SPHERE, .center = {-3, 4, -5}, .radius = 4},
    {.type = HL_CUT_BOX, .min = {-9, -7, -11}, .max = {7, 11, 9}, .keep = HL_CUT_KEEP_INSIDE}};

/* Shapes that stand straight in the world, among them a box, cut a turned cube of even matter. The length of
 * matter along a ray is found by counting points. */
static void test_scene_cuts_in_the_world(void **state) {
  (void)state;
  enum { STEPS = 20000 };
  static float pixels[FLOATS];
  stage set;
  open_stage(&set, NULL);
  hl_scene_volume *cube = add_cube(&set, OPACITY);
  turn(cube);
  set.scene.cuts = IN_WORLD;
  set.scene.cut_count = 3;
  for (int by_reference = 0; by_reference < 2; by_reference++) {
    stage_render_by(&set, by_reference, pixels);
    for (int i = 0; i < SIDE * SIDE; i += 13) {
      vec3 origin, way;
      int inside = 0;
      stage_eye_ray(&set, i % SIDE, i / SIDE, &origin, &way);
      for (int n = 0; n < STEPS; n++) {
        vec3 p = vec3_add(origin, vec3_scale(way, 20 + 120 * (n + 0.5) / STEPS)), q = unturned(cube, p);
        bool here = fabs(q.x) < HALF && fabs(q.y) < HALF && fabs(q.z) < HALF;
        for (int c = 0; c < 3 && here; c++) here = is_left(&IN_WORLD[c], p);
        inside += here;
      }
      double alpha = 1 - pow(1 - OPACITY, inside * 120.0 / STEPS);
      if (!(fabs((double)pixels[4 * i + 3] - alpha) <= (by_reference ? 1e-3 : 2e-3)))
        fail_msg("pixel %d: alpha is %.6f, not %.6f", i, (double)pixels[4 * i + 3], alpha);
    }
  }
  stage_close(&set);
}

/* The scene has two volumes, one of them turned. The scene's cuts and the same cuts of each volume give the
 * same picture and shadows, except for rounding. */
static void test_scene_cuts_as_cuts_of_each_volume(void **state) {
  (void)state;
  static float by_scene[FLOATS], by_volumes[FLOATS];
  for (int by_reference = 0; by_reference < 2; by_reference++) {
    stage set;
    open_stage(&set, NULL);
    add_cube(&set, 0.5)->shading = HL_SHADING_PHONG;
    turn(add_cube(&set, 0.3));
    set.volumes[1].translate[0] = 14;
    stage_add_directional(&set, vec3_normalise((vec3){-0.9, -0.5, -0.8}));
    set.scene.render.shadows = HL_SHADOWS_HARD;
    set.scene.cuts = IN_WORLD;
    set.scene.cut_count = 2;
    stage_render_by(&set, by_reference, by_scene);
    set.scene.cut_count = 0;
    hl_cut turned[2] = {IN_WORLD[0], IN_WORLD[1]};
    const hl_scene_volume *other = &set.volumes[1];
    vec3 point = unturned(other, vec3_of(turned[0].point)),
         centre = unturned(other, vec3_of(turned[1].center));
    vec3 normal = vec3_subtract(
        unturned(other, vec3_add(vec3_of(turned[0].point), vec3_of(turned[0].normal))), point);
    memcpy(turned[0].point, &point, sizeof point);
    memcpy(turned[0].normal, &normal, sizeof normal);
    memcpy(turned[1].center, &centre, sizeof centre);
    turned[1].radius /= other->scale;
    cut(&set.volumes[0], IN_WORLD, 2);
    cut(&set.volumes[1], turned, 2);
    stage_render_by(&set, by_reference, by_volumes);
    assert_true(difference(by_scene, by_volumes) < 1e-5);
    cut(&set.volumes[1], NULL, 0);
    stage_render_by(&set, by_reference, by_volumes);
    assert_true(difference(by_scene, by_volumes) > 0.01); /* the scene's cuts cut both volumes */
    stage_close(&set);
  }
}

/* ---- light ---- */

/* Dense even matter has no gradient, so that only cut faces give it a normal. Matter without faces is a
 * medium, whose brightness is 1 / (1 + r), r = c / g, with the cosines c of the eye and g of the light
 * (derived as in sheets_faces.c). A face is a surface, which gets all of the light that arrives at its
 * outside. */
static void test_faces_by_their_own_normal(void **state) {
  (void)state;
  static float pixels[FLOATS];
  static const hl_cut planes[] = {{.type = HL_CUT_PLANE, .point = {0, 0, 0}, .normal = {1, 2, 2}}};
  const vec3 normal = {1.0 / 3, 2.0 / 3, 2.0 / 3}, light = vec3_normalise((vec3){-0.9, -0.5, -0.8});
  for (int by_reference = 0; by_reference < 2; by_reference++)
    for (int shading = 0; shading < 3; shading++) {
      stage set;
      open_stage(&set, NULL);
      hl_scene_volume *cube = add_cube(&set, 0.99);
      cube->shading = HL_SHADING_PHONG;
      cube->material = (hl_material){.diffuse = 1};
      cube->cut_shading = (hl_cut_shading)shading;
      cut(cube, planes, 1);
      stage_add_directional(&set, light);
      stage_render_by(&set, by_reference, pixels);
      vec3 origin, way;
      int p = SIDE / 2 * SIDE + SIDE / 2;
      stage_eye_ray(&set, p % SIDE, p / SIDE, &origin, &way);
      double g = -vec3_dot(normal, light), c = -vec3_dot(normal, way), left = 1 / (1 + c / g);
      double expected = shading == HL_CUT_SHADING_FACE ? g : left;
      if (!(fabs((double)pixels[4 * p] - expected) <= 0.02))
        fail_msg("shading %d, reference %d: %.4f is not %.4f", shading, by_reference, (double)pixels[4 * p],
                 expected);
      stage_close(&set);
    }
}

static int by_size(const void *a, const void *b) {
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

/* A face that cuts dense matter is evenly lit at any angle to the eye, down to 5 degrees. Without shadows,
 * the face's brightness is the cosine of its angle to the light. */
static void test_even_at_any_angle(void **state) {
  (void)state;
  enum { FINE = 96 };
  static float pixels[FINE * FINE * 4];
  static const double eyes[] = {70, 45, 20, 10, 5}, lights[] = {70, 30, 15};
  static const hl_cut planes[] = {{.type = HL_CUT_PLANE, .point = {0.3, 0.2, -0.4}, .normal = {1, 2, 2}}};
  const vec3 normal = {1.0 / 3, 2.0 / 3, 2.0 / 3}, along = vec3_normalise((vec3){2, 0.3, -1.3});
  const vec3 flat = vec3_normalise(vec3_subtract(along, vec3_scale(normal, vec3_dot(along, normal))));
  const vec3 beside = vec3_add(vec3_scale(flat, 0.6), vec3_scale(vec3_cross(normal, flat), 0.8));
  for (int n = 0; n < 15; n++) {
    const double eye = eyes[n % 5] * HL_PI / 180, light = lights[n / 5] * HL_PI / 180;
    stage set;
    open_stage(&set, NULL);
    set.scene.width = set.scene.height = FINE;
    set.scene.camera.height = 20;
    const vec3 from = vec3_add(vec3_scale(normal, sin(eye)), vec3_scale(flat, cos(eye)));
    stage_look(&set, vec3_scale(from, 60), (vec3){0, 0, 0}, normal);
    hl_scene_volume *cube = add_cube(&set, 0.99);
    cube->shading = HL_SHADING_PHONG;
    cube->material = (hl_material){.diffuse = 1};
    cut(cube, planes, 1);
    const vec3 towards = vec3_add(vec3_scale(normal, sin(light)), vec3_scale(beside, cos(light)));
    stage_add_directional(&set, vec3_scale(towards, -1))->shadows = HL_SHADOWS_OFF;
    stage_render_by(&set, false, pixels);
    int count = 0;
    for (int p = 0; p < FINE * FINE; p++) {
      vec3 origin, way;
      stage_eye_ray(&set, p % FINE, p / FINE, &origin, &way);
      const double t = vec3_dot(normal, vec3_subtract(vec3_of(planes[0].point), origin)) /
                       vec3_dot(normal, way);
      const vec3 at = vec3_add(origin, vec3_scale(way, t));
      if (fabs(at.x) > HALF - 2 || fabs(at.y) > HALF - 2 || fabs(at.z) > HALF - 2) continue;
      count++;
      if (!(fabs((double)pixels[4 * p] / sin(light) - 1) < 0.03))
        fail_msg("eye at %g, light at %g degrees: %.4f is not %.4f", eyes[n % 5], lights[n / 5],
                 (double)pixels[4 * p], sin(light));
    }
    assert_true(count > 600);
    stage_close(&set);
  }
}

/* Adds a cube of matter with noise (standard deviation 3 %), cut by a plane. opacity: [2]. */
static hl_scene_volume *add_noisy_cube(stage *set, const hl_opacity_point *opacity, const hl_cut *plane) {
  static float voxels[VOXELS * VOXELS * VOXELS];
  uint32_t seed = 7;
  for (int i = 0; i < VOXELS * VOXELS * VOXELS; i++)
    voxels[i] = (float)(1 + 0.03 * sqrt(12) * (stage_random(&seed) - 0.5));
  hl_scene_volume *cube = stage_add_grid(set, (size_t[3]){VOXELS, VOXELS, VOXELS}, (double[3]){1, 1, 1},
                                         (vec3){-HALF, -HALF, -HALF}, voxels);
  cube->transfer_function.opacity = opacity;
  cube->transfer_function.opacity_count = 2;
  cube->shading = HL_SHADING_PHONG;
  cube->material = (hl_material){.diffuse = 1};
  cut(cube, plane, 1);
  return cube;
}

/* A view of the plane's face, and a light with shadows. */
typedef struct lit_face {
  double eye, light; /* the light's elevation above the face, in degrees */
  int method;        /* an hl_soft_method, for a sun of 4 degrees; below 0: hard shadows */
} lit_face;

static void stage_face(stage *set, const lit_face *face, const hl_opacity_point *opacity,
                       const hl_cut *plane) {
  const double eye = face->eye * HL_PI / 180, light = face->light * HL_PI / 180;
  const vec3 normal = vec3_normalise(vec3_of(plane->normal)), along = vec3_normalise((vec3){2, 0.3, -1.3});
  const vec3 flat = vec3_normalise(vec3_subtract(along, vec3_scale(normal, vec3_dot(along, normal))));
  const vec3 beside = vec3_add(vec3_scale(flat, 0.6), vec3_scale(vec3_cross(normal, flat), 0.8));
  open_stage(set, NULL);
  set->scene.width = set->scene.height = FACE_SIDE;
  set->scene.camera.height = 20;
  stage_look(set, vec3_scale(vec3_add(vec3_scale(normal, sin(eye)), vec3_scale(flat, cos(eye))), 60),
             (vec3){0, 0, 0}, normal);
  add_noisy_cube(set, opacity, plane);
  hl_light *lamp = stage_add_directional(
      set, vec3_scale(vec3_add(vec3_scale(normal, sin(light)), vec3_scale(beside, cos(light))), -1));
  set->scene.render.shadows = face->method < 0 ? HL_SHADOWS_HARD : HL_SHADOWS_SOFT;
  if (face->method < 0) return;
  lamp->angular_diameter_deg = 4;
  set->scene.render.soft_method = (hl_soft_method)face->method;
}

/* Returns the greatest deviation of the face's pixels from the cosine of its angle to the light, as a
 * fraction of the cosine. The thousandth of the pixels that deviates most is left out. */
static double deviation_of_face(const lit_face *face, const hl_opacity_point *opacity, bool reference) {
  static float pixels[FACE_SIDE * FACE_SIDE * 4];
  static double errors[FACE_SIDE * FACE_SIDE];
  static const hl_cut plane = {.type = HL_CUT_PLANE, .point = {0.3, 0.2, -0.4}, .normal = {1, 2, 2}};
  const vec3 normal = vec3_normalise(vec3_of(plane.normal));
  stage set;
  stage_face(&set, face, opacity, &plane);
  stage_render_by(&set, reference, pixels);
  size_t count = 0;
  for (int p = 0; p < FACE_SIDE * FACE_SIDE; p++) {
    vec3 origin, way;
    stage_eye_ray(&set, p % FACE_SIDE, p / FACE_SIDE, &origin, &way);
    const double t = vec3_dot(normal, vec3_subtract(vec3_of(plane.point), origin)) / vec3_dot(normal, way);
    const vec3 at = vec3_add(origin, vec3_scale(way, t));
    if (fabs(at.x) > HALF - 2 || fabs(at.y) > HALF - 2 || fabs(at.z) > HALF - 2) continue;
    errors[count++] = fabs((double)pixels[4 * p] / sin(face->light * HL_PI / 180) - 1);
  }
  stage_close(&set);
  assert_true(count > 600);
  qsort(errors, count, sizeof *errors, by_size);
  return errors[(size_t)(0.999 * (double)(count - 1))];
}

/* A face is lit by the light at its outside, whatever values lie behind it. */
static void test_even_in_grazing_light(void **state) {
  (void)state;
  static const double eyes[] = {70, 20, 5}, lights[] = {70, 30, 15};
  static const hl_opacity_point functions[][2] = {{{0, 0}, {1, 0.99}}, {{0.4, 0}, {0.6, 0.99}}};
  for (int f = 0; f < 2; f++)
    for (int n = 0; n < 9; n++)
      for (int method = -1; method <= HL_SOFT_SUBLIGHTS; method++) {
        const lit_face face = {eyes[n % 3], lights[n / 3], method};
        const double most = deviation_of_face(&face, functions[f], false);
        if (!(most < 0.03))
          fail_msg("function %d, method %d, eye at %g, light at %g degrees: %.4f", f, method, face.eye,
                   face.light, most);
      }
  assert_true(deviation_of_face(&(lit_face){70, 15, -1}, functions[1], true) < 0.03);
}

/* A border of the grid counts as a face, too. Without shadows, the brightness of each side of a cube of even
 * matter is the cosine of its angle to the light. The same holds for each side of a cube that is cropped out
 * of a larger grid of noise.
 */
static void test_border_of_the_grid(void **state) {
  (void)state;
  static float pixels[FLOATS], voxels[VOXELS * VOXELS * VOXELS];
  const vec3 light = vec3_normalise((vec3){-0.5, -0.9, -0.7});
  for (int n = 0; n < VOXELS * VOXELS * VOXELS; n++)
    voxels[n] = 0.5f + 0.4f * (float)((n * 7919) % 101) / 101;
  for (int k = 0; k < 4; k++) {
    const bool by_reference = k % 2, noise = k / 2;
    stage set;
    open_stage(&set, NULL);
    hl_scene_volume *cube = stage_add_grid(&set, (size_t[3]){VOXELS, VOXELS, VOXELS}, (double[3]){1, 1, 1},
                                           (vec3){-HALF, -HALF, -HALF}, noise ? voxels : NULL);
    stage_set_opacity(&set, cube, 0.9999, 1);
    cube->shading = HL_SHADING_PHONG;
    cube->material = (hl_material){.diffuse = 1};
    stage_add_directional(&set, light)->shadows = HL_SHADOWS_OFF;
    stage_render_by(&set, by_reference, pixels);
    int checked = 0;
    for (int p = 0; p < SIDE * SIDE; p++) {
      vec3 origin, way;
      stage_eye_ray(&set, p % SIDE, p / SIDE, &origin, &way);
      for (int a = 0; a < 3; a++) { /* the eye sees the sides at HALF */
        const double t = (HALF - part(origin, a)) / part(way, a);
        const vec3 at = vec3_add(origin, vec3_scale(way, t));
        bool on_side = true;
        for (int b = 0; b < 3; b++) on_side = on_side && (b == a || fabs(part(at, b)) < HALF - 0.5);
        if (!on_side) continue;
        checked++;
        if (!(fabs((double)pixels[4 * p] + part(light, a)) < 0.01))
          fail_msg("side %d, reference %d: %.4f is not %.4f", a, by_reference, (double)pixels[4 * p],
                   -part(light, a));
      }
    }
    assert_true(checked > 400);
    stage_close(&set);
  }
}

/* Thin matter is seen along -z and lit along x, and its half at lower x is cut away. The light passes a
 * length x of matter before it arrives at a sample at x, or x + HALF if the cut matter casts its shadow. */
static void test_shadow_of_what_is_cut_away(void **state) {
  (void)state;
  static float pixels[FLOATS];
  static const hl_cut planes[] = {{.type = HL_CUT_PLANE, .point = {0, 0, 0}, .normal = {-1, 0, 0}}};
  for (int by_reference = 0; by_reference < 2; by_reference++)
    for (int casts = 0; casts < 2; casts++) {
      stage set;
      open_stage(&set, NULL);
      stage_look(&set, (vec3){0, 0, 60}, (vec3){0, 0, 0}, (vec3){0, 1, 0});
      hl_scene_volume *cube = add_cube(&set, OPACITY);
      cube->cut_casts_shadow = casts;
      cut(cube, planes, 1);
      stage_add_directional(&set, (vec3){1, 0, 0});
      stage_render_by(&set, by_reference, pixels);
      for (int x = SIDE / 2; x < SIDE; x++) {
        vec3 origin, way;
        stage_eye_ray(&set, x, SIDE / 2, &origin, &way);
        if (origin.x < 1 || origin.x > HALF - 1) continue;
        double path = origin.x + (casts ? HALF : 0), alpha = 1 - pow(1 - OPACITY, 2 * HALF);
        double expected = alpha * pow(1 - OPACITY, path), found = pixels[4 * (SIDE / 2 * SIDE + x)];
        if (!(fabs(found - expected) <= 0.004))
          fail_msg("casts %d, reference %d, x = %.3f: %.4f is not %.4f", casts, by_reference, origin.x, found,
                   expected);
      }
      stage_close(&set);
    }
}

/* ---- isosurfaces ---- */

/* The faces of cuts close a ball's surface. With an opacity of one half, the eye's ray crosses the closed
 * surface twice, so that alpha is 1 - 0.5^2 wherever the ball is cut. If the ball is opaque, a face is as
 * bright as the cosine of its own normal. */
static void test_isosurface(void **state) {
  (void)state;
  static float voxels[VOXELS * VOXELS * VOXELS], pixels[FLOATS];
  for (int i = 0; i < VOXELS * VOXELS * VOXELS; i++) {
    vec3 p = {i % VOXELS - HALF + 0.5, i / VOXELS % VOXELS - HALF + 0.5, i / VOXELS / VOXELS - HALF + 0.5};
    voxels[i] = (float)-vec3_dot(p, p);
  }
  static const hl_cut planes[] = {{.type = HL_CUT_PLANE, .point = {0, 0, 0}, .normal = {0, 0, 1}}};
  static const hl_cut boxes[] = {{.type = HL_CUT_BOX, .min = {-3, -3, 0}, .max = {3, 3, 20}}};
  static const hl_cut balls[] = {{.type = HL_CUT_SPHERE, .center = {0, 0, 7}, .radius = 3}};
  static const struct {
    const hl_cut *cut;
    double across; /* half of the width of the part that is cut away, seen along z: a square or a circle */
  } cases[] = {{planes, 100}, {boxes, 3}, {balls, 2.8}};
  for (int n = 0; n < 12; n++) {
    const bool by_reference = n % 2, opaque = n / 6;
    const size_t k = (size_t)(n / 2 % 3);
    const hl_isosurface surface = {.value = -7 * 7 - 1, .color = {1, 1, 1}, .opacity = opaque ? 1 : 0.5};
    stage set;
    open_stage(&set, NULL);
    stage_look(&set, (vec3){0, 0, 60}, (vec3){0, 0, 0}, (vec3){0, 1, 0});
    hl_scene_volume *ball = stage_add_grid(&set, (size_t[3]){VOXELS, VOXELS, VOXELS}, (double[3]){1, 1, 1},
                                           (vec3){-HALF, -HALF, -HALF}, voxels);
    stage_set_opacity(&set, ball, 0, 1);
    ball->material = (hl_material){.diffuse = 1};
    ball->iso = &surface;
    ball->iso_count = 1;
    cut(ball, cases[k].cut, 1);
    stage_add_directional(&set, (vec3){0, 0, -1})->shadows = HL_SHADOWS_OFF;
    stage_render_by(&set, by_reference, pixels);
    for (int p = 0; p < SIDE * SIDE; p++) {
      vec3 origin, way;
      stage_eye_ray(&set, p % SIDE, p / SIDE, &origin, &way);
      double r = hypot(origin.x, origin.y), most = fmax(fabs(origin.x), fabs(origin.y));
      double off = k == 2 ? r - cases[k].across : most - cases[k].across;
      if (r > 5.5 || fabs(off) < 1) continue;
      const double cosine = off > 0 ? sqrt(1 - r * r / 49) : k < 2 ? 1 : sqrt(1 - r * r / 9);
      const double expected = opaque ? cosine : 0.75, found = (double)pixels[4 * p + (opaque ? 0 : 3)];
      if (!(fabs(found - expected) <= (!opaque ? 0.002
                                       : k < 2 ? 0.01
                                               : 0.02))) /* a pixel, 0.95 wide, is the mean over its area */
        fail_msg("cut %zu, reference %d, (%.2f, %.2f): %.4f is not %.4f", k, by_reference, origin.x, origin.y,
                 found, expected);
    }
    stage_close(&set);
  }
}

/* ---- bytes ---- */

static void test_same_bytes(void **state) {
  (void)state;
  static float first[FLOATS], other[FLOATS];
  static const hl_cut cuts[] = {{.type = HL_CUT_BOX, .min = {0, 0.4, 0.2}, .max = {40, 40, 40}},
                                {.type = HL_CUT_SPHERE, .center = {-6, 5, 6}, .radius = 5.5},
                                {.type = HL_CUT_PLANE, .point = {0, -6, 0}, .normal = {0.2, -1, 0}}};
  static const hl_instruction_set sets[] = {HL_INSTRUCTION_SET_SCALAR, HL_INSTRUCTION_SET_AUTO};
  for (int method = 0; method < 3; method++) {
    for (int way = 0; way < 3; way++) {
      stage set;
      open_noise(&set, (hl_soft_method)method, sets[way > 0]);
      set.volumes[0].cut_shading = HL_CUT_SHADING_FACE;
      set.scene.render.threads = way == 2 ? 3 : 1;
      cut(&set.volumes[0], cuts, 3);
      stage_render_sheets(&set, way == 0 ? first : other);
      stage_close(&set);
      if (way > 0) assert_memory_equal(first, other, sizeof first);
    }
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_lengths),
      cmocka_unit_test(test_as_a_clip_box),
      cmocka_unit_test(test_scene_cuts_in_the_world),
      cmocka_unit_test(test_scene_cuts_as_cuts_of_each_volume),
      cmocka_unit_test(test_faces_by_their_own_normal),
      cmocka_unit_test(test_even_at_any_angle),
      cmocka_unit_test(test_even_in_grazing_light),
      cmocka_unit_test(test_border_of_the_grid),
      cmocka_unit_test(test_shadow_of_what_is_cut_away),
      cmocka_unit_test(test_isosurface),
      cmocka_unit_test(test_same_bytes),
  };
  return cmocka_run_group_tests_name("sheets_cuts", tests, NULL, NULL);
}
