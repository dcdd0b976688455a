/* tests/unit/scene_compose.c - scenes composed by named options: one order, one meaning, errors that name
 * them. */
#include <halflight/compose.h>
#include <halflight/render.h>
#include <stdio.h>

#include "scene_parts.h"

enum { N = 24 };

static hl_context *context;

/* The scene of a bare ball. */
static hl_scene *make_bare(void) {
  static float values[N * N * N];
  for (int v = 0; v < N * N * N; v++) {
    double x = v % N - 11.5, y = v / N % N - 11.5, z = v / N / N - 11.5;
    values[v] = (float)fmax(0, 100 - 8 * sqrt(x * x + y * y + z * z));
  }
  hl_volume *volume = make_volume(context, N, values);
  hl_scene *scene = NULL;
  assert_int_equal(hl_scene_for_volume(context, volume, NULL, &scene, NULL), HL_OK);
  hl_volume_release(volume);
  return scene;
}

static char *text_of(const hl_scene *scene) {
  static char texts[2][100000];
  static int turn;
  hl_scene_description d = *hl_scene_describe(scene);
  hl_scene_volume volume = d.volumes[0];
  hl_scene *named = NULL;
  char *text = NULL, *kept = texts[turn = !turn];
  volume.file = "ball.nrrd";
  d.volumes = &volume;
  assert_int_equal(hl_scene_create(context, &d, &named, NULL), HL_OK);
  assert_int_equal(hl_scene_to_json(context, named, &text, NULL), HL_OK);
  snprintf(kept, sizeof texts[0], "%s", text);
  hl_text_release(context, text);
  hl_scene_release(named);
  return kept;
}

/* Composed of the bare ball and `count` options; null, with *error, where that is refused. */
static hl_scene *compose(const hl_option *options, size_t count, unsigned flags, hl_error *error) {
  hl_scene *bare = make_bare(), *made = NULL;
  hl_status status = hl_scene_compose(context, hl_scene_describe(bare), flags, options, count, &made, error);
  assert_true((status == HL_OK) == (made != NULL));
  hl_scene_release(bare);
  return made;
}

static void no_option_changes_nothing(void **state) {
  (void)state;
  hl_scene *bare = make_bare(), *made = compose(NULL, 0, HL_COMPOSE_BARE, NULL);
  assert_string_equal(text_of(made), text_of(bare));
  hl_scene_release(made);
  hl_scene_release(bare);
}

static void the_order_of_the_list_does_not_matter(void **state) {
  (void)state;
  static const hl_option options[] = {{"azimuth", "30"},   {"colormap", "viridis"}, {"range", "20,80"},
                                      {"shadows", "hard"}, {"ambient", "0.1"},      {"cut-box", "x=0.5:"},
                                      {"floor", NULL},     {"light", "10,20"}};
  enum { COUNT = sizeof options / sizeof *options };
  hl_option turned[COUNT];
  for (int n = 0; n < COUNT; n++) turned[n] = options[COUNT - 1 - n];
  hl_scene *one = compose(options, COUNT, HL_COMPOSE_BARE, NULL),
           *other = compose(turned, COUNT, HL_COMPOSE_BARE, NULL);
  const hl_scene_description *d = hl_scene_describe(one);
  assert_int_equal(d->mesh_count, 1);
  assert_int_equal(d->volumes[0].cut_count, 1);
  assert_int_equal(d->sky.type, HL_SKY_NONE); /* --ambient takes its place */
  assert_true(d->ambient[0] == 0.1);
  assert_int_equal(d->render.shadows, HL_SHADOWS_HARD);
  assert_string_equal(text_of(one), text_of(other));
  hl_scene_release(one);
  hl_scene_release(other);
}

/* Things that were chosen for a volume are chosen anew, and things that a scene states stay the same. */
static void bare_scenes_follow(void **state) {
  (void)state;
  static const hl_option ambient = {"ambient", "0.1"}, size = {"size", "300x100"};
  hl_scene *bare = compose(&ambient, 1, HL_COMPOSE_BARE, NULL), *fixed = compose(&ambient, 1, 0, NULL);
  assert_int_equal(hl_scene_describe(bare)->sky.type, HL_SKY_NONE);
  assert_int_equal(hl_scene_describe(fixed)->sky.type, HL_SKY_GRADIENT);
  hl_scene_release(bare);
  hl_scene_release(fixed);
  bare = compose(&size, 1, HL_COMPOSE_BARE, NULL), fixed = compose(&size, 1, 0, NULL);
  hl_scene *kept = compose(&size, 1, HL_COMPOSE_BARE | HL_COMPOSE_CAMERA, NULL);
  const double *moved = hl_scene_describe(bare)->camera.position,
               *same = hl_scene_describe(fixed)->camera.position;
  assert_true(moved[0] != same[0]); /* framed anew */
  assert_memory_equal(hl_scene_describe(kept)->camera.position, same, 3 * sizeof(double));
  assert_int_equal(hl_scene_describe(kept)->width, 300);
  hl_scene_release(bare);
  hl_scene_release(fixed);
  hl_scene_release(kept);
}

static void errors_name_the_option(void **state) {
  (void)state;
  static const struct {
    hl_option option;
    hl_status status;
    const char *message;
  } wrong[] = {
      {{"isso", "3"}, HL_ERROR_ARGUMENT, "unknown option '--isso': did you mean --iso?"},
      {{"look", "surfaec"},
       HL_ERROR_ARGUMENT,
       "--look: 'surfaec' is not one of its choices: did you mean \"surface\"?"},
      {{"zoom", "much"}, HL_ERROR_ARGUMENT, "--zoom: 'much' is not numbers"},
      {{"range", "5,1"}, HL_ERROR_ARGUMENT, "--range: '5,1': LO must be below HI"},
      {{"size", "1e300x2"}, HL_ERROR_ARGUMENT, "--size: '1e300x2': give WxH in pixels, each from 1 to 65536"},
      {{"labels", "missing.nrrd"}, HL_ERROR_IO, "missing.nrrd: cannot open: No such file or directory"},
      {{"threads", "-1e300"}, HL_ERROR_INPUT, NULL},
      {{NULL, "x"}, HL_ERROR_ARGUMENT, "option number 1 has no name"},
  };
  for (size_t n = 0; n < sizeof wrong / sizeof *wrong; n++) {
    hl_error error = {0};
    hl_scene *bare = make_bare(), *made = NULL;
    assert_int_equal(hl_scene_compose(context, hl_scene_describe(bare), HL_COMPOSE_BARE, &wrong[n].option, 1,
                                      &made, &error),
                     wrong[n].status);
    if (wrong[n].message != NULL) assert_string_equal(error.message, wrong[n].message);
    assert_null(made);
    hl_scene_release(bare);
  }
}

/* The scene of a bare label map: a cube of labels 3 and 7 in air. */
static hl_scene *make_label_map(void) {
  static float values[N * N * N];
  for (int v = 0; v < N * N * N; v++) {
    const int x = v % N, y = v / N % N, z = v / N / N;
    const bool inside = x > 3 && x < 20 && y > 3 && y < 20 && z > 3 && z < 20;
    values[v] = !inside ? 0 : x < 12 ? 3 : 7;
  }
  hl_volume *volume = make_volume(context, N, values);
  hl_scene *scene = NULL;
  assert_int_equal(hl_scene_for_volume(context, volume, NULL, &scene, NULL), HL_OK);
  hl_volume_release(volume);
  return scene;
}

/* A bare label map is drawn by its labels, unless an option asks for its values or names a look. */
static void bare_label_maps_have_their_labels(void **state) {
  (void)state;
  static const struct {
    hl_option option;
    unsigned flags;
    size_t labels;
  } cases[] = {
      {{"view", "front"}, 0, 2},  {{"shadows", "hard"}, 0, 2},
      {{"look", "auto"}, 0, 2},   {{"colormap", "viridis"}, 0, 0},
      {{"tf", "ct-bone"}, 0, 0},  {{"range", "1,5"}, 0, 0},
      {{"threshold", "4"}, 0, 0}, {{"iso", "5"}, 0, 0},
      {{"look", "mip"}, 0, 0},    {{"view", "front"}, HL_COMPOSE_VALUES, 0},
  };
  hl_scene *bare = make_label_map(), *styled = NULL;
  const hl_scene_volume *volume = &hl_scene_describe(bare)->volumes[0];
  assert_int_equal(volume->label_count, 2);
  assert_true(volume->labels[0].value == 3 && volume->labels[1].value == 7);
  assert_int_equal(hl_scene_describe(bare)->render.kernel, HL_KERNEL_BSPLINE);
  for (size_t n = 0; n < sizeof cases / sizeof *cases; n++) {
    hl_scene *made = NULL;
    assert_int_equal(hl_scene_compose(context, hl_scene_describe(bare), HL_COMPOSE_BARE | cases[n].flags,
                                      &cases[n].option, 1, &made, NULL),
                     HL_OK);
    assert_int_equal(hl_scene_describe(made)->volumes[0].label_count, cases[n].labels);
    assert_int_equal(hl_scene_describe(made)->render.kernel,
                     cases[n].labels > 0 ? HL_KERNEL_BSPLINE : HL_KERNEL_LINEAR);
    hl_scene_release(made);
  }
  assert_int_equal(hl_scene_for_volume_look(context, volume->volume, NULL, "surface", &styled, NULL), HL_OK);
  assert_int_equal(hl_scene_describe(styled)->volumes[0].label_count, 0);
  hl_scene_release(styled);
  hl_scene_release(bare);
}

/* The eye stands at least 34 degrees above the face that a cut of a bare volume leaves, whichever side is cut
 * off. An option that chooses the view keeps it. */
static void views_turn_to_cuts(void **state) {
  (void)state;
  static const char *const cuts[] = {"x=0.5", "x=:0.5", "y=0.5", "y=:0.5", "z=0.5", "z=:0.5"},
                           *const clips[] = {"x=0:0.5", "x=0.5:1", "y=0:0.5",
                                             "y=0.5:1", "z=0:0.5", "z=0.5:1"};
  for (int n = 0; n < 18; n++) {
    const hl_option options[] = {
        n < 12 ? (hl_option){"cut-plane", cuts[n % 6]} : (hl_option){"clip", clips[n % 6]},
        {"azimuth", "17"}};
    const bool turned = n < 6 || n >= 12;
    hl_scene *made = compose(options, turned ? 1 : 2, HL_COMPOSE_BARE, NULL);
    const hl_camera *camera = &hl_scene_describe(made)->camera;
    const vec3 to_eye = vec3_normalise(vec3_subtract(vec3_of(camera->position), vec3_of(camera->target)));
    const double along[] = {to_eye.x, to_eye.y, to_eye.z}, seen = (n % 2 ? -1 : 1) * along[n % 6 / 2];
    if (turned) assert_true(seen > sin(34 * HL_PI / 180));
    else assert_true(fabs(atan2(to_eye.x, -to_eye.y) - 17 * HL_PI / 180) < 1e-6);
    hl_scene_release(made);
  }
}

static void options_are_described(void **state) {
  (void)state;
  size_t count = 0;
  for (; hl_option_name(count) != NULL; count++) {
    hl_option_kind kind = hl_option_kind_of(hl_option_name(count));
    if (kind == HL_OPTION_CHOICE) assert_non_null(hl_option_choices(hl_option_name(count)));
    if (kind == HL_OPTION_SWITCH) assert_null(hl_option_choices(hl_option_name(count)));
  }
  assert_true(count > 40);
  assert_string_equal(hl_option_choices("look")[0].name, "auto");
  assert_null(hl_option_choices("nothing"));
}

/* The brightest channel of a scene's picture of 64x64 pixels. */
static float brightest(const hl_scene *scene, float *least_alpha) {
  static float pixels[64 * 64 * 4];
  hl_renderer *renderer = NULL;
  float most = 0;
  assert_int_equal(hl_renderer_create(context, &renderer, NULL), HL_OK);
  assert_int_equal(hl_renderer_render(renderer, scene, pixels, 4 * 64, NULL, NULL), HL_OK);
  hl_renderer_destroy(renderer);
  *least_alpha = 1;
  for (int i = 0; i < 64 * 64; i++) {
    for (int c = 0; c < 3; c++) most = fmaxf(most, pixels[4 * i + c]);
    *least_alpha = fminf(*least_alpha, pixels[4 * i + 3]);
  }
  return most;
}

static void light_rigs_expose_bare_volumes(void **state) {
  (void)state;
  float alpha;
  for (size_t n = 0; hl_light_rig_name(n) != NULL; n++) {
    const hl_option options[] = {{"light-rig", hl_light_rig_name(n)}, {"size", "64x64"}};
    hl_scene *made = compose(options, 2, HL_COMPOSE_BARE, NULL);
    const hl_scene_description *d = hl_scene_describe(made);
    assert_in_range(d->light_count, 1, HL_LIGHT_RIG_MOST);
    for (size_t l = 0; l < d->light_count; l++) assert_int_equal(d->lights[l].frame, HL_LIGHT_FRAME_CAMERA);
    assert_int_equal(d->sky.type, HL_SKY_GRADIENT);
    float most = brightest(made, &alpha);
    const hl_sky *sky = &hl_scene_describe(made)->sky;
    assert_int_equal(strcmp(hl_light_rig_name(n), "overcast") == 0, sky->horizon[0] == sky->horizon[2]);
    if (!(most > 0.5f && most < 1.5f)) fail_msg("%s: %g", options[0].value, (double)most);
    hl_scene_release(made);
  }
  hl_error error = {0};
  const hl_option both[] = {{"light-rig", "rim"}, {"light", "0,0"}};
  assert_null(compose(both, 2, HL_COMPOSE_BARE, &error));
  assert_non_null(strstr(error.message, "--light-rig and --light exclude each other"));
}

/* Behind a ball in the middle, all other pixels have the sky's one colour, with alpha 1. */
static void a_sky_is_seen_as_background(void **state) {
  (void)state;
  static float pixels[64 * 64 * 4];
  const hl_option options[] = {{"background", "sky"}, {"sky", "0.25,0.5,0.75"}, {"size", "64x64"}};
  hl_scene *made = compose(options, 3, HL_COMPOSE_BARE, NULL);
  hl_renderer *renderer = NULL;
  assert_int_equal(hl_renderer_create(context, &renderer, NULL), HL_OK);
  assert_int_equal(hl_renderer_render(renderer, made, pixels, 4 * 64, NULL, NULL), HL_OK);
  for (int i = 0; i < 64 * 64; i++) assert_true(pixels[4 * i + 3] == 1);
  for (int corner = 0; corner < 4; corner++) {
    const float *pixel = pixels + 4 * (64 * 63 * (corner / 2) + 63 * (corner % 2));
    for (int c = 0; c < 3; c++) assert_true(fabsf(pixel[c] - 0.25f * (float)(c + 1)) < 1e-6f);
  }
  hl_renderer_destroy(renderer);
  hl_scene_release(made);
  hl_error error = {0};
  const hl_option none[] = {{"background", "sky"}, {"sky", "0"}};
  assert_null(compose(none, 2, HL_COMPOSE_BARE, &error));
  assert_non_null(strstr(error.message, "the scene has no sky"));
}

static void scattering_is_multiple(void **state) {
  (void)state;
  const hl_option options[] = {{"scattering", "0.9,0.8,0.7"}};
  hl_scene *made = compose(options, 1, HL_COMPOSE_BARE, NULL);
  const hl_scene_volume *volume = &hl_scene_describe(made)->volumes[0];
  assert_true(volume->multiple_scattering && volume->albedo[0] == 0.9 && volume->albedo[2] == 0.7);
  hl_scene_release(made);
}

static int begin(void **state) {
  (void)state;
  context = make_context();
  return 0;
}

static int end(void **state) {
  (void)state;
  hl_context_destroy(context);
  return 0;
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(no_option_changes_nothing),
      cmocka_unit_test(the_order_of_the_list_does_not_matter),
      cmocka_unit_test(bare_scenes_follow),
      cmocka_unit_test(errors_name_the_option),
      cmocka_unit_test(views_turn_to_cuts),
      cmocka_unit_test(options_are_described),
      cmocka_unit_test(bare_label_maps_have_their_labels),
      cmocka_unit_test(light_rigs_expose_bare_volumes),
      cmocka_unit_test(a_sky_is_seen_as_background),
      cmocka_unit_test(scattering_is_multiple),
  };
  return cmocka_run_group_tests(tests, begin, end);
}
