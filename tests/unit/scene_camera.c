/* tests/unit/scene_camera.c - the camera's axes, framing, and lights placed as seen by the camera. */
#include "scene_parts.h"

/* Where a world point appears: x and y from -1 to 1 inside the picture. */
static void project(const hl_camera *camera, double aspect, vec3 point, double *x, double *y) {
  vec3 right, up, forward;
  assert_true(hl_camera_basis(camera, &right, &up, &forward));
  vec3 p = vec3_subtract(point, vec3_of(camera->position));
  double depth = vec3_dot(p, forward), half;
  assert_true(depth > 0);
  half = camera->type == HL_CAMERA_PERSPECTIVE ? depth * tan(camera->fovy_deg * HL_PI / 360)
                                               : camera->height / 2;
  *x = vec3_dot(p, right) / (half * aspect);
  *y = vec3_dot(p, up) / half;
}

static void basis_is_right_handed_and_falls_back(void **state) {
  (void)state;
  hl_camera camera = {.position = {0, -5, 0}, .up = {0, 0.3, 2}};
  vec3 r, u, f;
  assert_true(hl_camera_basis(&camera, &r, &u, &f));
  assert_true(r.x == 1 && fabs(u.z - 1) < 1e-12 && f.y == 1);
  const double sights[][3] = {{0, 0, -3}, {0, 0, 3}, {0, 4, 0}, {1, 0, 0}, {1, 1, 1}};
  for (size_t n = 0; n < 5; n++) { /* up along the sight: something perpendicular and unit stands in */
    hl_camera bad = {.target = {sights[n][0], sights[n][1], sights[n][2]},
                     .up = {sights[n][0], sights[n][1], sights[n][2]}};
    assert_false(hl_camera_basis(&bad, &r, &u, &f));
    assert_near(vec3_length(r), 1, 1e-12);
    assert_near(vec3_length(u), 1, 1e-12);
    assert_near(vec3_dot(u, f), 0, 1e-12);
    assert_near(vec3_dot(vec3_cross(r, u), f), -1, 1e-12);
  }
}

/* The scene's own camera then has an up that works. */
static void scene_mends_up(void **state) {
  (void)state;
  parts p;
  parts_make(&p);
  p.description.camera = (hl_camera){.position = {0, 0, 9}, .up = {0, 0, 1}, .fovy_deg = 30};
  hl_scene *scene = NULL;
  assert_int_equal(hl_scene_create(p.context, &p.description, &scene, NULL), HL_OK);
  vec3 r, u, f;
  assert_true(hl_camera_basis(&hl_scene_describe(scene)->camera, &r, &u, &f));
  assert_true(u.y == 1);
  hl_scene_release(scene);
  parts_release(&p);
}

/* One visible ball in a large empty grid, seen from everywhere: all of it is in the picture, it touches the
 * margin on at least one side, and it is centred. */
static void frames_what_is_visible(void **state) {
  (void)state;
  enum { N = 24 };
  static float values[N * N * N];
  const double centre[3] = {6, 15, 17}, radius = 4;
  for (int k = 0, v = 0; k < N; k++)
    for (int j = 0; j < N; j++)
      for (int i = 0; i < N; i++, v++)
        values[v] = hypot(hypot(i - centre[0], j - centre[1]), k - centre[2]) <= radius ? 1.0f : 0.0f;
  parts p;
  parts_make(&p);
  hl_volume_release(p.volume);
  p.volume = p.scene_volume.volume = make_volume(p.context, N, values);
  hl_opacity_point points[] = {{0.5, 0}, {0.6, 1}};
  p.scene_volume.transfer_function = (hl_transfer_function){1, points, 2, NULL, 0};
  for (int n = 0; n < 24; n++) {
    p.description.width = n % 3 == 0 ? 900 : 300;
    p.description.height = n % 3 == 1 ? 900 : 300;
    double aspect = (double)p.description.width / p.description.height, most_x = 0, most_y = 0, sum_x = 0,
           sum_y = 0;
    hl_camera camera = {.type = n % 2 ? HL_CAMERA_ORTHOGRAPHIC : HL_CAMERA_PERSPECTIVE,
                        .fovy_deg = n % 4 ? 30 : 80};
    assert_int_equal(hl_camera_frame(&p.description, n * 17, n * 7.5 - 90, 1, &camera), HL_OK);
    int count = 0;
    for (int v = 0; v < N * N * N; v++) {
      if (values[v] == 0) continue;
      double x, y;
      project(&camera, aspect, (vec3){v % N, v / N % N, v / N / N}, &x, &y);
      most_x = fmax(most_x, fabs(x));
      most_y = fmax(most_y, fabs(y));
      sum_x += x, sum_y += y, count++;
    }
    double most = fmax(most_x, most_y);
    assert_true(most < 0.92 && most > 0.62);
    assert_near(sum_x / count, 0, 0.05);
    assert_near(sum_y / count, 0, 0.05);
  }
  parts_release(&p);
}

enum { LONG = 150, WIDE = 21, HIGH = 37 };

/* A long volume of each type, a few voxels of which are visible, most of those in one part of it. */
static hl_volume *scattered(hl_context *context, hl_voxel_type type, unsigned seed) {
  static unsigned char bytes[LONG * WIDE * HIGH];
  static uint16_t words[LONG * WIDE * HIGH];
  static float floats[LONG * WIDE * HIGH];
  for (int v = 0; v < LONG * WIDE * HIGH; v++) {
    seed = seed * 1664525u + 1013904223u;
    int near = v % LONG > 30 && v % LONG < 70 && v / LONG % WIDE < 12;
    bytes[v] = (unsigned char)(seed >> 8) % (near ? 8 : 400) == 0 ? (unsigned char)(seed >> 24) : 10;
    words[v] = (uint16_t)(256 * bytes[v]);
    floats[v] = bytes[v] == 77 ? NAN : (float)bytes[v];
  }
  hl_volume_description d;
  hl_volume_description_defaults(&d);
  d.dimensions[0] = LONG, d.dimensions[1] = WIDE, d.dimensions[2] = HIGH;
  d.type = type;
  d.voxels = type == HL_VOXEL_U8 ? (const void *)bytes : type == HL_VOXEL_U16 ? (const void *)words : floats;
  if (type == HL_VOXEL_U16) d.value_scale = -1.0 / 256, d.value_offset = 300;
  hl_volume *volume = NULL;
  assert_int_equal(hl_volume_create(context, &d, &volume, NULL), HL_OK);
  return volume;
}

/* How far visible voxels reach along a direction, less so many times their depth: of all of them. */
static double greatest_reach(const hl_scene_volume *scene, vec3 along, vec3 forward, double tangent) {
  const hl_volume *volume = scene->volume;
  affine3 placement = hl_scene_volume_index_to_world(scene);
  double low[3], high[3], greatest = -INFINITY, radius = scene->scale * sqrt(3) / 2;
  hl_scene_volume_box(scene, low, high);
  for (int v = 0; v < LONG * WIDE * HIGH; v++) {
    const size_t i = (size_t)(v % LONG), j = (size_t)(v / LONG % WIDE), k = (size_t)(v / LONG / WIDE);
    const double at[3] = {(double)i, (double)j, (double)k};
    bool inside = true;
    for (int a = 0; a < 3; a++) inside = inside && at[a] >= low[a] && at[a] <= high[a];
    double value = hl_volume_value(volume, i, j, k);
    if (!inside || !isfinite(value) || hl_transfer_function_opacity(&scene->transfer_function, value) < 0.02) continue;
    vec3 p = affine3_apply(placement, (vec3){at[0], at[1], at[2]});
    greatest = fmax(greatest, vec3_dot(p, along) - tangent * vec3_dot(p, forward) + radius * sqrt(1 + tangent * tangent));
  }
  return greatest;
}

/* What is found by looking at a few voxels is what all of them say. */
static void frames_by_the_farthest_voxels(void **state) {
  (void)state;
  parts p;
  parts_make(&p);
  hl_opacity_point points[] = {{20, 0}, {20, 1}, {120, 1}, {121, 0}, {215, 0}, {216, 0.5}, {218, 0.001}};
  for (int n = 0; n < 36; n++) {
    hl_scene_volume *scene = &p.scene_volume;
    hl_volume_release(p.volume);
    p.volume = scene->volume = scattered(p.context, n % 3 == 0 ? HL_VOXEL_U8 : n % 3 == 1 ? HL_VOXEL_U16 : HL_VOXEL_F32, (unsigned)n);
    scene->transfer_function = (hl_transfer_function){1, points, n % 4 ? 4 : 7, NULL, 0};
    scene->scale = 1 + 0.1 * n;
    scene->rotate_angle_deg = 23 * n;
    memcpy(scene->rotate_axis, (double[3]){0.3, 1, 0.2 * n}, sizeof scene->rotate_axis);
    scene->clipped = n % 5 == 4;
    memcpy(scene->clip_min, (double[3]){33, 2, -9}, sizeof scene->clip_min);
    memcpy(scene->clip_max, (double[3]){141, 99, 30}, sizeof scene->clip_max);
    p.description.width = p.description.height = 100;
    hl_camera c = {.type = n % 2 ? HL_CAMERA_ORTHOGRAPHIC : HL_CAMERA_PERSPECTIVE, .fovy_deg = n % 4 ? 30 : 140};
    assert_int_equal(hl_camera_frame(&p.description, n * 31, n * 5 - 90, 1, &c), HL_OK);
    vec3 right, up, forward;
    assert_true(hl_camera_basis(&c, &right, &up, &forward));
    double tangent = n % 2 ? 0 : 0.92 * tan(c.fovy_deg * HL_PI / 360);
    double reach[4];
    const vec3 along[4] = {right, vec3_scale(right, -1), up, vec3_scale(up, -1)};
    for (int side = 0; side < 4; side++) reach[side] = greatest_reach(scene, along[side], forward, tangent);
    double half = fmax(reach[0] + reach[1], reach[2] + reach[3]) / 2;
    double near = -greatest_reach(scene, vec3_scale(forward, -1), forward, 0), far = greatest_reach(scene, forward, forward, 0);
    assert_near(vec3_dot(vec3_of(c.target), right), (reach[0] - reach[1]) / 2, 1e-8);
    assert_near(vec3_dot(vec3_of(c.target), up), (reach[2] - reach[3]) / 2, 1e-8);
    assert_near(vec3_dot(vec3_of(c.target), forward), (near + far) / 2, 1e-8);
    if (n % 2) assert_near(c.height, 2 * half / 0.92, 1e-8);
    else assert_near(vec3_dot(vec3_of(c.position), forward), -half / tangent, 1e-8);
  }
  parts_release(&p);
}

static void angles_mean_what_they_say(void **state) {
  (void)state;
  parts p;
  parts_make(&p);
  hl_camera c = {.fovy_deg = 30};
  assert_int_equal(hl_camera_frame(&p.description, 0, 0, 1, &c), HL_OK);
  assert_true(c.position[1] < c.target[1] - 3 && fabs(c.position[0] - c.target[0]) < 1e-9 && c.up[2] == 1);
  assert_int_equal(hl_camera_frame(&p.description, 90, 0, 1, &c), HL_OK);
  assert_true(c.position[0] > c.target[0] + 3 && fabs(c.position[1] - c.target[1]) < 1e-9);
  assert_int_equal(hl_camera_frame(&p.description, 0, 90, 1, &c), HL_OK);
  assert_true(c.position[2] > c.target[2] + 3 && fabs(c.up[1] - 1) < 1e-12);
  hl_camera near = c;
  assert_int_equal(hl_camera_frame(&p.description, 0, 90, 2, &near), HL_OK);
  assert_near((near.position[2] - near.target[2]) * 2, c.position[2] - c.target[2], 1e-9);
  hl_camera flat = {.type = HL_CAMERA_ORTHOGRAPHIC}, flat_near = flat;
  assert_int_equal(hl_camera_frame(&p.description, 0, 0, 1, &flat), HL_OK);
  assert_int_equal(hl_camera_frame(&p.description, 0, 0, 4, &flat_near), HL_OK);
  assert_near(flat.height, 4 * flat_near.height, 1e-9);
  assert_int_equal(hl_camera_frame(&p.description, NAN, 0, 1, &c), HL_ERROR_ARGUMENT);
  assert_int_equal(hl_camera_frame(&p.description, 0, 0, 0, &c), HL_ERROR_ARGUMENT);
  c.fovy_deg = 0;
  assert_int_equal(hl_camera_frame(&p.description, 0, 0, 1, &c), HL_ERROR_ARGUMENT);
  parts_release(&p);
}

/* Fitting keeps the direction, whatever it is, and is what framing does along its own. */
static void fits_along_its_own_direction(void **state) {
  (void)state;
  parts p;
  parts_make(&p);
  hl_camera framed = {.fovy_deg = 30}, fitted;
  assert_int_equal(hl_camera_frame(&p.description, 25, 35, 1.5, &framed), HL_OK);
  fitted = framed;
  for (int a = 0; a < 3; a++) fitted.position[a] += 40 * (framed.position[a] - framed.target[a]);
  assert_int_equal(hl_camera_fit(&p.description, 1.5, &fitted), HL_OK);
  for (int a = 0; a < 3; a++) assert_near(fitted.position[a], framed.position[a], 1e-9);
  hl_camera lying = {.fovy_deg = 30, .position = {3, 50, 2}, .up = {1, 0, 0.2}}, before = lying;
  vec3 r, u, f, r2, u2, f2;
  assert_int_equal(hl_camera_fit(&p.description, 1, &lying), HL_OK);
  assert_true(hl_camera_basis(&before, &r, &u, &f));
  assert_true(hl_camera_basis(&lying, &r2, &u2, &f2));
  assert_near(vec3_dot(f, f2), 1, 1e-12);
  assert_near(vec3_dot(u, u2), 1, 1e-12);
  double x, y;
  project(&lying, 1, (vec3){1, 1, 1}, &x, &y);
  assert_true(fabs(x) < 0.2 && fabs(y) < 0.2);
  lying.position[0] = NAN;
  assert_int_equal(hl_camera_fit(&p.description, 1, &lying), HL_ERROR_ARGUMENT);
  parts_release(&p);
}

/* With nothing visible the whole grid is framed, and several volumes are framed together. */
static void frames_boxes_and_several_volumes(void **state) {
  (void)state;
  parts p;
  parts_make(&p);
  hl_scene_volume two[2] = {p.scene_volume, p.scene_volume};
  two[0].transfer_function.opacity_count = two[1].transfer_function.opacity_count = 0;
  two[1].translate[0] = 40;
  p.description.volumes = two;
  p.description.volume_count = 2;
  hl_camera c = {.fovy_deg = 30};
  assert_int_equal(hl_camera_frame(&p.description, 0, 0, 1, &c), HL_OK);
  double x, y;
  project(&c, 1, (vec3){42.5, -0.5, 1}, &x, &y);
  assert_near(x, 0.92, 1e-9);
  project(&c, 1, (vec3){-0.5, -0.5, 1}, &x, &y);
  assert_near(x, -0.92, 1e-9);
  parts_release(&p);
}

static void lights_stand_where_the_camera_sees_them(void **state) {
  (void)state;
  hl_camera c = {.position = {0, -5, 0}, .up = {0, 0, 1}};
  double d[3];
  hl_light_direction(&c, 0, 0, d); /* a headlight shines along the sight */
  assert_true(d[0] == 0 && d[1] == 1 && d[2] == 0);
  hl_light_direction(&c, 90, 0, d); /* from the right: travels to -x */
  assert_near(d[0], -1, 1e-12);
  hl_light_direction(&c, 0, 90, d); /* from above */
  assert_near(d[2], -1, 1e-12);
  hl_light_direction(&c, -40, 45, d); /* from the upper left in front */
  assert_true(d[0] > 0 && d[1] > 0 && d[2] < 0);
  assert_near(vec3_length(vec3_of(d)), 1, 1e-12);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(basis_is_right_handed_and_falls_back),
      cmocka_unit_test(scene_mends_up),
      cmocka_unit_test(frames_what_is_visible),
      cmocka_unit_test(frames_by_the_farthest_voxels),
      cmocka_unit_test(angles_mean_what_they_say),
      cmocka_unit_test(fits_along_its_own_direction),
      cmocka_unit_test(frames_boxes_and_several_volumes),
      cmocka_unit_test(lights_stand_where_the_camera_sees_them),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
