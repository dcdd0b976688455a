/* tests/unit/scene_camera.c - the camera's axes, and framing. */
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
  p.scene_volume.transfer_function = (hl_transfer_function){
      .unit_distance = 1, .opacity = points, .opacity_count = 2};
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
  const void *voxels = type == HL_VOXEL_U8    ? (const void *)bytes
                       : type == HL_VOXEL_U16 ? (const void *)words
                                              : floats;
  hl_volume_description d = describe_voxels(LONG, WIDE, HIGH, type, voxels);
  if (type == HL_VOXEL_U16) d.value_scale = -1.0 / 256, d.value_offset = 300;
  return create_volume(context, &d);
}

/* How far to one side visible voxels reach, of all of them: along a direction, or (perspective) as an angle
 * seen from the eye. */
static double greatest_reach(const hl_scene_volume *scene, vec3 along, vec3 forward, const vec3 *eye) {
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
    if (!inside || !isfinite(value) || hl_transfer_function_opacity(&scene->transfer_function, value) < 0.02)
      continue;
    vec3 p = affine3_apply(placement, (vec3){at[0], at[1], at[2]}),
         from = eye != NULL ? vec3_subtract(p, *eye) : p;
    double x = vec3_dot(from, along), z = vec3_dot(from, forward);
    greatest = fmax(greatest, eye != NULL ? atan2(x, z) + asin(radius / hypot(x, z)) : x + radius);
  }
  return greatest;
}

/* A sample of a few voxels tells the same as all voxels. */
static void frames_by_the_farthest_voxels(void **state) {
  (void)state;
  parts p;
  parts_make(&p);
  hl_opacity_point points[] = {{20, 0}, {20, 1}, {120, 1}, {121, 0}, {215, 0}, {216, 0.5}, {219, 0.5}};
  for (int n = 0; n < 36; n++) {
    hl_scene_volume *scene = &p.scene_volume;
    hl_volume_release(p.volume);
    p.volume = scene->volume = scattered(p.context,
                                         n % 3 == 0   ? HL_VOXEL_U8
                                         : n % 3 == 1 ? HL_VOXEL_U16
                                                      : HL_VOXEL_F32,
                                         (unsigned)n);
    scene->transfer_function = (hl_transfer_function){
        .unit_distance = 1, .opacity = points, .opacity_count = n % 4 ? 4 : 7};
    scene->scale = 1 + 0.1 * n;
    scene->rotate_angle_deg = 23 * n;
    memcpy(scene->rotate_axis, (double[3]){0.3, 1, 0.2 * n}, sizeof scene->rotate_axis);
    scene->clipped = n % 5 == 4;
    memcpy(scene->clip_min, (double[3]){33, 2, -9}, sizeof scene->clip_min);
    memcpy(scene->clip_max, (double[3]){141, 99, 30}, sizeof scene->clip_max);
    p.description.width = p.description.height = 100;
    hl_camera c = {.type = n % 2 ? HL_CAMERA_ORTHOGRAPHIC : HL_CAMERA_PERSPECTIVE,
                   .fovy_deg = n % 4 ? 30 : 140};
    assert_int_equal(hl_camera_frame(&p.description, n * 31, n * 5 - 90, 1, &c), HL_OK);
    vec3 right, up, forward;
    assert_true(hl_camera_basis(&c, &right, &up, &forward));
    const vec3 eye = vec3_of(c.position), *from = n % 2 ? NULL : &eye;
    double reach[4];
    const vec3 along[4] = {right, vec3_scale(right, -1), up, vec3_scale(up, -1)};
    for (int side = 0; side < 4; side++) reach[side] = greatest_reach(scene, along[side], forward, from);
    double near = -greatest_reach(scene, vec3_scale(forward, -1), forward, NULL),
           far = greatest_reach(scene, forward, forward, NULL);
    assert_near(vec3_dot(vec3_of(c.target), forward), (near + far) / 2, 1e-8);
    if (n % 2) {
      assert_near(vec3_dot(vec3_of(c.target), right), (reach[0] - reach[1]) / 2, 1e-8);
      assert_near(vec3_dot(vec3_of(c.target), up), (reach[2] - reach[3]) / 2, 1e-8);
      assert_near(c.height, fmax(reach[0] + reach[1], reach[2] + reach[3]) / 0.92, 1e-8);
    } else {
      assert_near(reach[0], reach[1], 1e-8); /* in the middle, both ways, and as near as can be */
      assert_near(reach[2], reach[3], 1e-8);
      assert_near(tan(fmax(reach[0], reach[2])), 0.92 * tan(c.fovy_deg * HL_PI / 360), 1e-8);
    }
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

/* The corners of a camera's picture at a depth beyond its eye lie within another camera's picture. */
static bool holds(const hl_camera *camera, const hl_camera *other, double aspect) {
  vec3 right, up, forward;
  hl_camera_basis(other, &right, &up, &forward);
  bool within = true;
  for (int corner = 0; corner < 8; corner++) {
    const double depth = corner & 4 ? 1 : 100;
    const double half = other->type == HL_CAMERA_PERSPECTIVE ? depth * tan(other->fovy_deg * HL_PI / 360)
                                                             : other->height / 2;
    vec3 at = vec3_add(vec3_of(other->position), vec3_scale(forward, depth));
    at = vec3_add(at, vec3_scale(right, (corner & 1 ? half : -half) * aspect));
    at = vec3_add(at, vec3_scale(up, corner & 2 ? half : -half));
    double x, y;
    project(camera, aspect, at, &x, &y);
    within = within && fabs(x) <= 1 + 1e-9 && fabs(y) <= 1 + 1e-9;
  }
  return within;
}

/* Two cameras at -1 and 3 along the picture's width, at the same depth, need an eye at 1 that stands farther
 * back by 2 over the tangent of half the width's angle. */
static void joined_cameras_hold_all(void **state) {
  (void)state;
  const double aspect = 1.5, tangent = tan(15 * HL_PI / 180);
  hl_camera two[2] = {{.fovy_deg = 30, .position = {-1, 0, 0}, .target = {-1, 8, 0}, .up = {0, 0, 1}}}, all;
  two[1] = two[0];
  two[1].position[0] = two[1].target[0] = 3;
  assert_int_equal(hl_camera_join(two, 2, aspect, &all), HL_OK);
  assert_near(all.position[0], 1, 1e-12);
  assert_near(all.position[1], -2 / (aspect * tangent), 1e-12);
  assert_near(all.target[1], 8, 1e-12);
  for (int flat = 0; flat < 2; flat++) {
    for (int n = 0; n < 2; n++) two[n].type = flat ? HL_CAMERA_ORTHOGRAPHIC : HL_CAMERA_PERSPECTIVE;
    two[0].height = 3, two[1].height = 7;
    two[1].position[1] = 2.5, two[1].position[2] = two[1].target[2] = 0.7;
    assert_int_equal(hl_camera_join(two, 2, aspect, &all), HL_OK);
    assert_true(holds(&all, &two[0], aspect) && holds(&all, &two[1], aspect));
    assert_false(holds(&two[0], &two[1], aspect)); /* the test can fail */
    hl_camera again[2] = {all, two[1]}, same;      /* a camera that holds the other stays as it is */
    again[0].position[1] -= 1e-6;
    again[0].height += 1;
    assert_int_equal(hl_camera_join(again, 2, aspect, &same), HL_OK);
    assert_memory_equal(same.position, again[0].position, sizeof same.position);
    assert_memory_equal(same.target, again[0].target, sizeof same.target);
    assert_true(same.height == again[0].height);
  }
  two[1].fovy_deg = 31, two[1].type = two[0].type = HL_CAMERA_PERSPECTIVE;
  assert_int_equal(hl_camera_join(two, 2, aspect, &all), HL_ERROR_ARGUMENT);
  assert_int_equal(hl_camera_join(two, 0, aspect, &all), HL_ERROR_ARGUMENT);
  assert_int_equal(hl_camera_join(NULL, 1, aspect, &all), HL_ERROR_ARGUMENT);
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

/* A bent bar in a large grid, with one opaque voxel far away and faint noise all over. */
static hl_volume *bent_bar(hl_context *context, bool specks) {
  enum { N = 64 };
  static float values[N * N * N];
  unsigned seed = 1;
  for (int k = 0, v = 0; k < N; k++)
    for (int j = 0; j < N; j++)
      for (int i = 0; i < N; i++, v++) {
        seed = seed * 1664525u + 1013904223u;
        bool bar = (i > 8 && i < 50 && abs(j - 20) < 4 && abs(k - 25) < 5) ||
                   (abs(i - 12) < 4 && j >= 20 && j < 34 && abs(k - 25) < 5);
        values[v] = bar ? 1.0f : specks && (seed >> 8) % 8192 == 0 ? 0.6f : 0.0f;
      }
  if (specks) values[(60 * N + 60) * N + 60] = 1.0f;
  return make_volume(context, N, values);
}

static void parts_of_bar(parts *p, bool specks, hl_opacity_point points[2]) {
  parts_make(p);
  hl_volume_release(p->volume);
  p->volume = p->scene_volume.volume = bent_bar(p->context, specks);
  points[0] = (hl_opacity_point){0.5, 0};
  points[1] = (hl_opacity_point){1, 1};
  p->scene_volume.transfer_function = (hl_transfer_function){
      .unit_distance = 1, .opacity = points, .opacity_count = 2};
  p->description.width = p->description.height = 100;
}

/* Where the bar's voxels are in the picture: left, right, bottom, top, from -1 to 1. */
static void box_of_bar(const hl_camera *camera, double box[4]) {
  box[0] = box[2] = INFINITY, box[1] = box[3] = -INFINITY;
  for (int corner = 0; corner < 8; corner++) {
    const double low[2][3] = {{8.5, 16.5, 20.5}, {8.5, 20, 20.5}},
                 high[2][3] = {{49.5, 23.5, 29.5}, {15.5, 33.5, 29.5}};
    for (int part = 0; part < 2; part++) {
      double x, y;
      vec3 p = {corner & 1 ? high[part][0] : low[part][0], corner & 2 ? high[part][1] : low[part][1],
                corner & 4 ? high[part][2] : low[part][2]};
      project(camera, 1, p, &x, &y);
      box[0] = fmin(box[0], x), box[1] = fmax(box[1], x), box[2] = fmin(box[2], y), box[3] = fmax(box[3], y);
    }
  }
}

/* The visible voxels fill the picture and are in its middle, with specks and without. */
static void specks_do_not_count(void **state) {
  (void)state;
  for (int n = 0; n < 12; n++) {
    parts p;
    hl_opacity_point points[2];
    double box[4];
    parts_of_bar(&p, true, points);
    hl_camera camera = {.type = n % 2 ? HL_CAMERA_ORTHOGRAPHIC : HL_CAMERA_PERSPECTIVE, .fovy_deg = 30};
    assert_int_equal(hl_camera_frame(&p.description, n * 33, n * 13 - 70, 1, &camera), HL_OK);
    box_of_bar(&camera, box);
    assert_near(box[0] + box[1], 0, 0.02);
    assert_near(box[2] + box[3], 0, 0.02);
    assert_near(fmax(box[1] - box[0], box[3] - box[2]) / 2, 0.91, 0.03);
    parts_release(&p);
  }
}

/* In a CT scan what holds the patient, foam and its plastic shell, does not count. */
static void holders_do_not_count(void **state) {
  (void)state;
  enum { N = 64 };
  static float values[N * N * N];
  const hl_opacity_point points[] = {{-700, 0}, {-300, 0.5}, {40, 1}};
  for (int n = 0; n < 6; n++) {
    parts p;
    hl_opacity_point unused[2];
    double box[4];
    parts_of_bar(&p, false, unused);
    for (int v = 0; v < N * N * N; v++) {
      int i = v % N, j = v / N % N, k = v / (N * N);
      bool foam = i > 40 && j > 23 && j < 58 && abs(k - 25)<3, shell = i> 40 && j == 58 && abs(k - 25) < 2;
      values[v] = hl_volume_value(p.volume, (size_t)i, (size_t)j, (size_t)k) > 0.5 ? 40.0f
                  : shell                                                          ? 0.0f
                  : foam                                                           ? -500.0f
                                                                                   : -1000.0f;
    }
    values[(25 * N + 20) * N + 20] = 400; /* bone */
    hl_volume_release(p.volume);
    p.volume = p.scene_volume.volume = make_volume(p.context, N, values);
    p.scene_volume.transfer_function.opacity = points;
    p.scene_volume.transfer_function.opacity_count = 3;
    hl_camera camera = {.type = n % 2 ? HL_CAMERA_ORTHOGRAPHIC : HL_CAMERA_PERSPECTIVE, .fovy_deg = 30};
    assert_int_equal(hl_camera_frame(&p.description, n * 33, n * 13 - 30, 1, &camera), HL_OK);
    box_of_bar(&camera, box);
    assert_near(box[0] + box[1], 0, 0.2);
    assert_near(box[2] + box[3], 0, 0.2);
    assert_near(fmax(box[1] - box[0], box[3] - box[2]) / 2, 0.88, 0.06);
    parts_release(&p);
  }
}

/* All frames of a turn have one target and one distance and hold everything; the first one is filled and in
 * the middle. */
static void a_turn_keeps_target_and_distance(void **state) {
  (void)state;
  for (int n = 0; n < 8; n++) {
    parts p;
    hl_opacity_point points[2];
    double box[4];
    parts_of_bar(&p, n & 1, points);
    hl_camera first = {.type = n % 3 ? HL_CAMERA_PERSPECTIVE : HL_CAMERA_ORTHOGRAPHIC, .fovy_deg = 30};
    const double ups[4][3] = {{0, 0, 1}, {0, -1, 0}, {0.3, 1, 2}, {1, 0, 0}};
    hl_view view;
    assert_int_equal(
        hl_view_choose(&p.description, n % 2 ? HL_SIDE_AUTOMATIC : HL_SIDE_ISO, ups[n / 2], &view, NULL),
        HL_OK);
    assert_int_equal(hl_camera_frame_view(&p.description, &view, 1, &first, NULL), HL_OK);
    box_of_bar(&first, box);
    assert_near(box[0] + box[1], 0, 0.1); /* within 2.5 % of the picture */
    assert_near(box[2] + box[3], 0, 0.1);
    double distance = vec3_length(vec3_subtract(vec3_of(first.position), vec3_of(first.target)));
    for (int turn = 0; turn < 24; turn++) {
      hl_camera camera = first;
      hl_view turned = view;
      turned.azimuth_deg += 15 * turn;
      assert_int_equal(hl_camera_turn(&turned, &camera), HL_OK);
      assert_memory_equal(camera.target, first.target, sizeof first.target);
      assert_near(vec3_length(vec3_subtract(vec3_of(camera.position), vec3_of(camera.target))), distance,
                  1e-9);
      box_of_bar(&camera, box);
      assert_true(box[0] > -1.04 && box[1] < 1.04 && box[2] > -1.04 && box[3] < 1.04);
    }
    parts_release(&p);
  }
}

/* hl_camera_view returns the view that the camera was turned to, to the last bit of its angles; up and front
 * are unit vectors at a right angle. */
static void views_are_found_again(void **state) {
  (void)state;
  parts p;
  parts_make(&p);
  const double ups[][3] = {{0, 0, 1}, {0, 1, 0}, {0, 0, -1}, {-1, 0, 0}, {1, 2, -0.5}};
  for (int n = 0; n < 40; n++) {
    hl_view view, found;
    assert_int_equal(hl_view_choose(&p.description, HL_SIDE_FRONT, ups[n % 5], &view, NULL), HL_OK);
    assert_near(vec3_length(vec3_of(view.up)), 1, 1e-12);
    assert_near(vec3_dot(vec3_of(view.up), vec3_of(view.front)), 0, 1e-12);
    view.azimuth_deg = n * 8 - 170;
    view.elevation_deg = n * 4 - 80;
    p.description.camera = (hl_camera){
        .position = {3, 50, 2}, .target = {1, 2, 3}, .up = {0, 0, 1}, .fovy_deg = 30};
    assert_int_equal(hl_camera_turn(&view, &p.description.camera), HL_OK);
    assert_int_equal(hl_view_of_camera(&p.description, &found), HL_OK);
    assert_near(found.azimuth_deg, view.azimuth_deg, 1e-12);
    assert_near(found.elevation_deg, view.elevation_deg, 1e-12);
    assert_true(found.roll_deg == 0);
    for (int a = 0; a < 3; a++) assert_near(found.up[a], view.up[a], 1e-12);
  }
  hl_view upside = {.up = {0, 0, 2}, .front = {0, -1, 0}}, any;
  assert_int_equal(hl_camera_turn(&upside, &p.description.camera), HL_ERROR_ARGUMENT);
  assert_int_equal(hl_view_choose(&p.description, HL_SIDE_FRONT, (double[3]){0, 0, 0}, &any, NULL),
                   HL_ERROR_ARGUMENT);
  assert_int_equal(hl_view_choose(&p.description, (hl_side)9, NULL, &any, NULL), HL_ERROR_ARGUMENT);
  /* An up that is level with an axis, as older scenes have it, is that axis. */
  p.description.camera = (hl_camera){.position = {0, -3, 3}, .up = {0, 0.5, 0.5}, .fovy_deg = 30};
  assert_int_equal(hl_view_of_camera(&p.description, &any), HL_OK);
  assert_true(any.up[2] == 1 && any.elevation_deg == 45 && any.azimuth_deg == 0);
  parts_release(&p);
}

/* Sides are the body's own where the file knows them, else the viewer's. */
static void sides_are_the_bodys_own(void **state) {
  (void)state;
  static float values[8] = {0, 1, 1, 1, 1, 1, 1, 1};
  parts p;
  parts_make(&p);
  /* direction from the things to the eye */
  static const struct {
    hl_space space;
    hl_side side;
    double eye[3];
  } cases[] = {{HL_SPACE_UNKNOWN, HL_SIDE_FRONT, {0, -1, 0}}, {HL_SPACE_UNKNOWN, HL_SIDE_LEFT, {-1, 0, 0}},
               {HL_SPACE_UNKNOWN, HL_SIDE_RIGHT, {1, 0, 0}},  {HL_SPACE_UNKNOWN, HL_SIDE_TOP, {0, 0, 1}},
               {HL_SPACE_RAS, HL_SIDE_FRONT, {0, 1, 0}},      {HL_SPACE_RAS, HL_SIDE_LEFT, {-1, 0, 0}},
               {HL_SPACE_RAS, HL_SIDE_BACK, {0, -1, 0}},      {HL_SPACE_LPS, HL_SIDE_FRONT, {0, -1, 0}},
               {HL_SPACE_LPS, HL_SIDE_LEFT, {1, 0, 0}},       {HL_SPACE_LPS, HL_SIDE_BOTTOM, {0, 0, -1}},
               {HL_SPACE_LAS, HL_SIDE_FRONT, {0, 1, 0}},      {HL_SPACE_LAS, HL_SIDE_RIGHT, {-1, 0, 0}}};
  for (size_t n = 0; n < sizeof cases / sizeof *cases; n++) {
    hl_volume_description d = describe_voxels(2, 2, 2, HL_VOXEL_F32, values);
    d.space = cases[n].space;
    hl_volume_release(p.volume);
    p.scene_volume.volume = p.volume = create_volume(p.context, &d);
    hl_view view;
    hl_camera camera = {.position = {0, -9, 0}, .up = {0, 0, 1}, .fovy_deg = 30};
    assert_int_equal(hl_view_choose(&p.description, cases[n].side, (double[3]){0, 0, 1}, &view, NULL), HL_OK);
    assert_int_equal(hl_camera_turn(&view, &camera), HL_OK);
    for (int a = 0; a < 3; a++) assert_near(camera.position[a], 9 * cases[n].eye[a], 1e-9);
  }
  parts_release(&p);
}

/* A positive roll turns the picture clockwise: what was above the middle is to its right. */
static void roll_turns_the_picture(void **state) {
  (void)state;
  parts p;
  parts_make(&p);
  hl_view view;
  hl_camera camera = {.position = {0, -9, 0}, .up = {0, 0, 1}, .fovy_deg = 30};
  assert_int_equal(hl_view_choose(&p.description, HL_SIDE_FRONT, (double[3]){0, 0, 1}, &view, NULL), HL_OK);
  view.roll_deg = 90;
  assert_int_equal(hl_camera_turn(&view, &camera), HL_OK);
  double x, y;
  project(&camera, 1, (vec3){0, 0, 1}, &x, &y);
  assert_true(x > 0.1);
  assert_near(y, 0, 1e-12);
  parts_release(&p);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(basis_is_right_handed_and_falls_back),
      cmocka_unit_test(scene_mends_up),
      cmocka_unit_test(frames_what_is_visible),
      cmocka_unit_test(frames_by_the_farthest_voxels),
      cmocka_unit_test(angles_mean_what_they_say),
      cmocka_unit_test(fits_along_its_own_direction),
      cmocka_unit_test(joined_cameras_hold_all),
      cmocka_unit_test(frames_boxes_and_several_volumes),
      cmocka_unit_test(specks_do_not_count),
      cmocka_unit_test(holders_do_not_count),
      cmocka_unit_test(a_turn_keeps_target_and_distance),
      cmocka_unit_test(views_are_found_again),
      cmocka_unit_test(sides_are_the_bodys_own),
      cmocka_unit_test(roll_turns_the_picture),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
