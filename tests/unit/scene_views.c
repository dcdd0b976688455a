/* tests/unit/scene_views.c - the directions from which bare volumes are seen. */
#include "scene_parts.h"

enum { N = 40 };

static float noise(unsigned *state) { /* 0..1 */
  *state = *state * 1664525u + 1013904223u;
  return (float)(*state >> 8) / 16777216.0f;
}

/* Writes a pot on a plate at the lower y face. plate: the plate's value; the pot has 1. */
static void write_pot(float values[N * N * N], float plate) {
  for (int k = 0, v = 0; k < N; k++)
    for (int j = 0; j < N; j++)
      for (int i = 0; i < N; i++, v++) {
        const bool stem = j < 30 && hypot(i - 20, k - 20) < 5,
                   knob = hypot(hypot(i - 20, j - 20), k - 13) < 4;
        values[v] = j < 4 ? plate : stem || knob ? 1.0f : 0.0f;
      }
}

/* The volume's automatic camera, and the camera's way up. */
static hl_camera camera_of(hl_context *context, hl_volume *volume, vec3 *up) {
  hl_scene *scene = NULL;
  assert_int_equal(hl_scene_for_volume(context, volume, NULL, &scene, NULL), HL_OK);
  const hl_camera camera = hl_scene_describe(scene)->camera;
  vec3 right, forward;
  hl_camera_basis(&camera, &right, up, &forward);
  hl_scene_release(scene);
  return camera;
}

/* y is up, and the eye is on the side with relief. The pot and its plate are a mask, two labels, or matter of
 * two densities. */
static void things_stand_upright(void **state) {
  (void)state;
  static float values[N * N * N];
  hl_context *context = make_context();
  vec3 up;
  for (int kind = 0; kind < 3; kind++) {
    write_pot(values, (float[3]){1, 2, 1.5f}[kind]);
    hl_volume *volume = make_volume(context, N, values);
    int is_map = 0;
    assert_int_equal(hl_volume_is_label_map(context, volume, &is_map, NULL), HL_OK);
    assert_int_equal(is_map, kind < 2);
    const hl_camera camera = camera_of(context, volume, &up);
    assert_true(up.y > 0.9);                            /* elevation 20 */
    assert_true(camera.position[2] < camera.target[2]); /* the knob is on this side */
    hl_volume_release(volume);
  }
  /* A NIfTI file tells its directions: z is up, and y points to the front. */
  hl_volume_description d = describe_voxels(N, N, N, HL_VOXEL_F32, values);
  d.space = HL_SPACE_RAS;
  hl_volume *volume = create_volume(context, &d);
  const hl_camera camera = camera_of(context, volume, &up);
  assert_true(up.z > 0.9 && camera.position[1] > camera.target[1] + 10);
  hl_volume_release(volume);
  hl_context_destroy(context);
}

/* Four lobes with alternating signs lie in one plane. The eye looks straight at the plane, in which they are
 * widest. From the plane's end, the near lobes would hide the others. across: the axis perpendicular to the
 * plane. */
static void fields_are_seen_from_their_wide_side(void **state) {
  (void)state;
  static float values[N * N * N];
  hl_context *context = make_context();
  for (int across = 0; across < 2; across++) {
    for (int v = 0; v < N * N * N; v++) {
      const double p[3] = {v % N - 20, v / N % N - 20, v / N / N - 20}, along = p[1 - across];
      values[v] = (float)(along * p[2] * exp(-hypot(hypot(p[0], p[1]), p[2]) / 3));
    }
    hl_volume *volume = make_volume(context, N, values);
    hl_scene *scene = NULL;
    assert_int_equal(hl_scene_for_volume(context, volume, NULL, &scene, NULL), HL_OK);
    const hl_camera *camera = &hl_scene_describe(scene)->camera;
    double away[2];
    for (int a = 0; a < 2; a++) away[a] = fabs(camera->position[a] - camera->target[a]);
    assert_true(away[across] > 1.5 * away[1 - across]);
    hl_scene_release(scene);
    hl_volume_release(volume);
  }
  hl_context_destroy(context);
}

/* Writes a head with a smooth vault, a ragged jaw, and nothing under its back. over: whether it is upside
 * down in the grid. */
static void write_head(float values[N * N * N], bool over) {
  for (int k = 0, v = 0; k < N; k++)
    for (int j = 0; j < N; j++)
      for (int i = 0; i < N; i++, v++) {
        const int x = abs(i - 20), y = j - 20, z = over ? 19 - k : k - 20;
        bool inside = pow(x / 9.0, 2) + pow(y / 14.0, 2) + pow(z / 13.0, 2) < 1, behind = z < -2 && y < -3,
             groove = z < -6 && (x / 2 + j / 2) % 2 == 0;
        values[v] = inside && !behind && !groove ? 1.0f : 0.0f;
      }
}

/* The z of the up direction of a head's picture. over: whether the head is upside down in the grid. */
static double up_of_head(hl_context *context, bool over) {
  static float values[N * N * N];
  write_head(values, over);
  hl_volume *volume = make_volume(context, N, values);
  vec3 up;
  camera_of(context, volume, &up);
  hl_volume_release(volume);
  return up.z;
}

/* The elevation, in degrees, of the eye above a ball in noisy air of a NIfTI file. middle: the height of the
 * ball's middle, in voxels. */
static double elevation_of_body(hl_context *context, double middle) {
  static float values[N * N * N];
  unsigned state = 7;
  for (int k = 0, v = 0; k < N; k++)
    for (int j = 0; j < N; j++)
      for (int i = 0; i < N; i++, v++) {
        const double r = hypot(hypot(i - 20, j - 20), k - middle);
        values[v] = (float)(1 / (1 + exp((r - 16) / 0.7))) + 0.05f * noise(&state);
      }
  hl_volume_description d = describe_voxels(N, N, N, HL_VOXEL_F32, values);
  d.space = HL_SPACE_RAS;
  hl_volume *volume = create_volume(context, &d);
  hl_scene *scene = NULL;
  assert_int_equal(hl_scene_for_volume(context, volume, "body.nii", &scene, NULL), HL_OK);
  const hl_camera *camera = &hl_scene_describe(scene)->camera;
  const vec3 eye = vec3_subtract(vec3_of(camera->position), vec3_of(camera->target));
  const double elevation = asin(eye.z / vec3_length(eye)) * 180 / HL_PI;
  hl_scene_release(scene);
  hl_volume_release(volume);
  return elevation;
}

/* A body that the grid cuts, as a head at the neck, is seen from the height of its eyes. */
static void bodies_that_are_cut_off_are_seen_from_lower(void **state) {
  (void)state;
  hl_context *context = make_context();
  assert_true(fabs(elevation_of_body(context, 20) - 20) < 1e-3);
  assert_true(fabs(elevation_of_body(context, 9) - 5) < 1e-3);
  assert_int_equal(hl_context_memory_held(context), 0);
  hl_context_destroy(context);
}

static void heads_do_not_hang(void **state) {
  (void)state;
  hl_context *context = make_context();
  assert_true(up_of_head(context, false) > 0.9);
  assert_true(up_of_head(context, true) < -0.9);
  assert_int_equal(hl_context_memory_held(context), 0);
  hl_context_destroy(context);
}

/* Cuts grooves into a head at one side of y. The head's face is on that side. */
static void cut_face(float values[N * N * N], bool at_upper_y) {
  for (int v = 0; v < N * N * N; v++) {
    const int x = abs(v % N - 20), j = v / N % N, depth = at_upper_y ? 33 - j : j - 7;
    if (depth < 4 && (x / 3 + v / (N * N) / 3) % 2 == 0) values[v] = 0;
  }
}

/* Turns a head's values to Hounsfield units, as in the scan of a body: noisy tissue with some bone, in air.
 */
static void make_tissue(float values[N * N * N]) {
  unsigned state = 5;
  for (int v = 0; v < N * N * N; v++)
    values[v] = (values[v] > 0 && v % 9 == 0 ? 500 : 1040 * values[v] - 1000) + 20 * noise(&state);
}

/* The y of the direction from a head to the eye of a view. tissue: whether it is the scan of a body.
 * at_upper_y: where its face is. */
static double eye_of_head(hl_context *context, bool tissue, bool at_upper_y, hl_side side) {
  static float values[N * N * N];
  hl_view view;
  write_head(values, false);
  cut_face(values, at_upper_y);
  if (tissue) make_tissue(values);
  hl_volume *volume = make_volume(context, N, values);
  hl_scene *scene = NULL;
  assert_int_equal(hl_scene_for_volume(context, volume, NULL, &scene, NULL), HL_OK);
  assert_int_equal(hl_view_choose(hl_scene_describe(scene), side, NULL, &view, NULL), HL_OK);
  const vec3 front = vec3_of(view.front), right = vec3_cross(vec3_of(view.up), front);
  const double azimuth = view.azimuth_deg * HL_PI / 180;
  hl_scene_release(scene);
  hl_volume_release(volume);
  return front.y * cos(azimuth) + right.y * sin(azimuth);
}

/* In the scan of a body, the side with the face is the front, wherever it lies. */
static void the_front_of_a_body_is_its_face(void **state) {
  (void)state;
  hl_context *context = make_context();
  for (int at_upper_y = 0; at_upper_y < 2; at_upper_y++) {
    const double face = at_upper_y ? 1 : -1;
    assert_true(face * eye_of_head(context, true, at_upper_y, HL_SIDE_AUTOMATIC) > 0.5);
    assert_true(face * eye_of_head(context, true, at_upper_y, HL_SIDE_FRONT) > 0.999);
    assert_true(face * eye_of_head(context, true, at_upper_y, HL_SIDE_BACK) < -0.999);
    assert_true(eye_of_head(context, false, at_upper_y, HL_SIDE_FRONT) < -0.999);
  }
  assert_int_equal(hl_context_memory_held(context), 0);
  hl_context_destroy(context);
}

/* A field that the grid cuts off at an end of x is seen from the other end. */
static void fields_are_seen_from_the_side_that_is_whole(void **state) {
  (void)state;
  static float values[N * N * N];
  hl_context *context = make_context();
  for (int end = 0; end < 2; end++) {
    for (int v = 0; v < N * N * N; v++) {
      const double x = v % N - (end ? N - 1 : 0), y = v / N % N - 20, z = v / N / N - 20;
      values[v] = (float)exp(-(x * x / 200 + (y * y + z * z) / 60));
    }
    hl_volume *volume = make_volume(context, N, values);
    vec3 up;
    const hl_camera camera = camera_of(context, volume, &up);
    assert_true((camera.position[0] < camera.target[0] - 10) == (end == 1));
    assert_true((camera.position[0] > camera.target[0] + 10) == (end == 0));
    hl_volume_release(volume);
  }
  assert_int_equal(hl_context_memory_held(context), 0);
  hl_context_destroy(context);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(things_stand_upright),
      cmocka_unit_test(heads_do_not_hang),
      cmocka_unit_test(the_front_of_a_body_is_its_face),
      cmocka_unit_test(bodies_that_are_cut_off_are_seen_from_lower),
      cmocka_unit_test(fields_are_seen_from_their_wide_side),
      cmocka_unit_test(fields_are_seen_from_the_side_that_is_whole),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
