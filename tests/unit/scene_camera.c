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
      cmocka_unit_test(angles_mean_what_they_say),
      cmocka_unit_test(fits_along_its_own_direction),
      cmocka_unit_test(frames_boxes_and_several_volumes),
      cmocka_unit_test(lights_stand_where_the_camera_sees_them),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
