/* tests/robust/faults_rendering.c - every allocation of a frame fails in turn, and every question whether to
 * stop is answered with yes. Each time there is a clean status and a message of one line, and no memory is
 * held. Once there is memory again, the frame has the same bytes. */
#include "faulty.h"
#include "small_scenes.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "volume_files.h"

static char folder[FOLDER_BYTES];

static int open_folder(void **state) {
  (void)state;
  make_folder(folder);
  hl_context *context = NULL;
  assert_int_equal(hl_context_create(NULL, &context, NULL), HL_OK);
  assert_int_equal(small_files_write(context, folder, NULL), HL_OK);
  hl_context_destroy(context);
  return 0;
}

static int close_folder(void **state) {
  (void)state;
  remove_folder(folder);
  return 0;
}

typedef struct render_work {
  hl_renderer *renderer; /* null: each frame has a new renderer */
  hl_scene *scene, *other;
  hl_image *expected;
  float *pixels;
  bool layers;
} render_work;

static hl_status render_once(faulty *f, render_work *work, hl_renderer *renderer, hl_error *error) {
  const hl_scene_description *scene = hl_scene_describe(work->scene);
  size_t pixels = (size_t)scene->width * (size_t)scene->height;
  float *memory = work->pixels + 4 * pixels;
  hl_light_layers lights[3];
  (void)f;
  for (size_t l = 0; l < scene->light_count; l++)
    lights[l] = (hl_light_layers){.picture = memory + 6 * l * pixels,
                                  .shadow = memory + (6 * l + 3) * pixels};
  float *rest = memory + 6 * scene->light_count * pixels;
  hl_layers layers = {.struct_size = sizeof layers,
                      .lights = lights,
                      .light_count = scene->light_count,
                      .ambient = rest,
                      .depth_first = rest + 3 * pixels,
                      .depth_mean = rest + 4 * pixels,
                      .normal = rest + 5 * pixels};
  return hl_renderer_render_layers(renderer, work->scene, work->pixels, 4 * (size_t)scene->width,
                                   work->layers ? &layers : NULL, NULL, error);
}

static hl_status render(faulty *f, void *data, hl_error *error) {
  render_work *work = data;
  if (work->renderer != NULL) return render_once(f, work, work->renderer, error);
  hl_renderer *renderer = NULL;
  hl_status status = hl_renderer_create(f->context, &renderer, error);
  if (status == HL_OK) status = render_once(f, work, renderer, error);
  hl_renderer_destroy(renderer);
  return status;
}

/* Renders again by the renderer that failed. The picture must be right. */
static hl_status render_again(faulty *f, void *data, hl_error *error) {
  render_work *work = data;
  memset(work->pixels, 0, small_scene_floats(work->scene) * sizeof(float));
  hl_status status = render_once(f, work, work->renderer, error);
  assert_memory_equal(work->pixels, hl_image_pixels(work->expected),
                      small_scene_floats(work->scene) * sizeof(float));
  return status;
}

static void open_render(faulty *f, size_t scene, render_work *work) {
  *work = (render_work){0};
  hl_error error = {0};
  hl_status status = small_scene_make(f->context, scene, folder, &work->scene, &error);
  if (status != HL_OK) fail_msg("%s", error.message);
  const hl_scene_description *d = hl_scene_describe(work->scene);
  work->layers = scene % 2 == 1 && d->render.compositing == HL_COMPOSITING_LIGHT; /* projections have none */
  work->pixels = calloc(small_scene_floats(work->scene) * 8, sizeof(float));
  assert_int_equal(hl_image_create(f->context, d->width, d->height, &work->expected, NULL), HL_OK);
  if (render(f, work, &error) != HL_OK) fail_msg("%s", error.message);
  memcpy(hl_image_pixels(work->expected), work->pixels, small_scene_floats(work->scene) * sizeof(float));
}

static void close_render(render_work *work) {
  hl_image_destroy(work->expected);
  hl_scene_release(work->scene);
  hl_scene_release(work->other);
  free(work->pixels);
}

static void test_rendering(void **state) {
  (void)state;
  faulty f;
  faulty_open(&f);
  for (size_t n = 0; n < small_scene_count; n++) {
    render_work work;
    open_render(&f, n, &work);
    assert_true(faulty_fail_each(&f, render, NULL, &work) >= 20);
    assert_true(faulty_stop_each(&f, render, NULL, &work) >= 40);
    close_render(&work);
  }
  faulty_close(&f);
}

/* The renderer draws another scene before every frame, so that it must make everything anew. */
static hl_status render_after_another(faulty *f, void *data, hl_error *error) {
  render_work *work = data;
  long allocations = atomic_exchange(&f->allocations_left, -1),
       questions = atomic_exchange(&f->questions_left, -1);
  assert_int_equal(hl_renderer_render(work->renderer, work->other, work->pixels, 4 * 24, NULL, NULL), HL_OK);
  atomic_store(&f->questions_left, questions);
  atomic_store(&f->allocations_left, allocations);
  return render_once(f, work, work->renderer, error);
}

static void test_the_renderer_goes_on(void **state) {
  (void)state;
  static const size_t scenes[] = {2, 0, 3, 6, 7, 8, 10, 12, 13, 14};
  faulty f;
  faulty_open(&f);
  for (size_t n = 0; n < sizeof scenes / sizeof scenes[0]; n++) {
    render_work work;
    open_render(&f, scenes[n], &work);
    assert_int_equal(hl_renderer_create(f.context, &work.renderer, NULL), HL_OK);
    assert_int_equal(small_scene_make(f.context, 5, folder, &work.other, NULL), HL_OK); /* "colors" */
    faulty_fail_each(&f, n == 0 ? render_after_another : render, render_again, &work);
    faulty_stop_each(&f, render, render_again, &work);
    hl_renderer_destroy(work.renderer);
    close_render(&work);
  }
  faulty_close(&f);
}

static hl_status render_reference(faulty *f, void *data, hl_error *error) {
  render_work *work = data;
  hl_reference_options options;
  hl_reference_options_defaults(&options);
  options.light_points = 2;
  options.step = 2;
  return hl_reference_render(f->context, work->scene, &options, work->pixels, 4 * 24, error);
}

static void test_the_reference(void **state) {
  (void)state;
  faulty f;
  faulty_open(&f);
  for (size_t n = 5; n < 7; n++) {
    render_work work;
    open_render(&f, n, &work);
    assert_true(faulty_fail_each(&f, render_reference, NULL, &work) >= 8);
    assert_true(faulty_stop_each(&f, render_reference, NULL, &work) >= 2);
    close_render(&work);
  }
  faulty_close(&f);
}

/* Argument: the name of one test; none: all. */
int main(int count, char **arguments) {
  if (count > 1) cmocka_set_test_filter(arguments[1]);
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_the_renderer_goes_on),
      cmocka_unit_test(test_rendering),
      cmocka_unit_test(test_the_reference),
  };
  return cmocka_run_group_tests(tests, open_folder, close_folder);
}
