/* tests/robust/threads.c - contexts, scenes and renderers in several threads at once, in forked processes,
 * cancelled by another thread, and with fewer threads than were asked for. */
#define _GNU_SOURCE
#include "small_scenes.h"

#include <errno.h>
#include <pthread.h>
#include <semaphore.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmocka.h>

enum { THREADS = 4, RENDER_THREADS = 3, FLOATS = 24 * 20 * 4, SCENES = SMALL_SCENES_WITHOUT_FILES };

static float expected[SCENES][FLOATS];

static hl_context *make_context(void) {
  hl_context *context = NULL;
  if (hl_context_create(NULL, &context, NULL) != HL_OK) abort();
  return context;
}

static hl_scene *make_scene(hl_context *context, size_t index, int threads) {
  hl_scene *read = NULL, *made = NULL;
  if (small_scene_make(context, index, NULL, &read, NULL) != HL_OK) abort();
  hl_scene_description description = *hl_scene_describe(read);
  description.render.threads = threads;
  if (hl_scene_create(context, &description, &made, NULL) != HL_OK) abort();
  hl_scene_release(read);
  return made;
}

/* Returns whether the renderer makes the scene's picture. A failing assert must not leave a thread, so that
 * results are returned. */
static bool renders(hl_renderer *renderer, const hl_scene *scene, size_t index) {
  float *pixels = malloc(FLOATS * sizeof *pixels);
  bool right = pixels != NULL && hl_renderer_render(renderer, scene, pixels, 4 * 24, NULL, NULL) == HL_OK &&
               memcmp(pixels, expected[index], FLOATS * sizeof *pixels) == 0;
  free(pixels);
  return right;
}

static bool renders_afresh(hl_context *context, const hl_scene *scene, size_t index) {
  hl_renderer *renderer = NULL;
  bool right = hl_renderer_create(context, &renderer, NULL) == HL_OK && renders(renderer, scene, index);
  hl_renderer_destroy(renderer);
  return right;
}

static int find_expected(void **state) {
  (void)state;
  hl_context *context = make_context();
  for (size_t n = 0; n < SCENES; n++) {
    hl_scene *scene = make_scene(context, n, 1);
    hl_renderer *renderer = NULL;
    assert_int_equal(hl_renderer_create(context, &renderer, NULL), HL_OK);
    assert_int_equal(hl_renderer_render(renderer, scene, expected[n], 4 * 24, NULL, NULL), HL_OK);
    hl_renderer_destroy(renderer);
    hl_scene_release(scene);
  }
  hl_context_destroy(context);
  return 0;
}

/* ---- many at once ---- */

typedef struct visitor {
  pthread_t thread;
  int number;
  hl_context *context; /* null: its own */
  hl_scene **scenes;   /* [SCENES]; null: the thread makes its own */
  bool right;
} visitor;

static void *visit(void *data) {
  visitor *v = data;
  hl_context *context = v->context != NULL ? v->context : make_context();
  v->right = true;
  hl_renderer *renderer = NULL;
  if (hl_renderer_create(context, &renderer, NULL) != HL_OK) abort();
  for (size_t n = 0; n < SCENES; n++) {
    size_t index = (n + (size_t)v->number) % SCENES;
    hl_scene *scene = v->scenes != NULL ? v->scenes[index] : make_scene(context, index, RENDER_THREADS);
    v->right = v->right && renders(renderer, scene, index);
    if (v->scenes == NULL) hl_scene_release(scene);
  }
  hl_renderer_destroy(renderer);
  if (v->context == NULL) {
    v->right = v->right && hl_context_memory_held(context) == 0;
    hl_context_destroy(context);
  }
  return NULL;
}

static void visit_all(hl_context *context, hl_scene **scenes) {
  visitor visitors[THREADS];
  for (int i = 0; i < THREADS; i++) {
    visitors[i] = (visitor){.number = i, .context = context, .scenes = scenes};
    assert_int_equal(pthread_create(&visitors[i].thread, NULL, visit, &visitors[i]), 0);
  }
  for (int i = 0; i < THREADS; i++) pthread_join(visitors[i].thread, NULL);
  for (int i = 0; i < THREADS; i++) assert_true(visitors[i].right);
}

static void test_a_context_for_each_thread(void **state) {
  (void)state;
  visit_all(NULL, NULL);
}

static void test_one_context_for_all(void **state) {
  (void)state;
  hl_context *context = make_context();
  visit_all(context, NULL);
  assert_int_equal(hl_context_memory_held(context), 0);
  hl_context_destroy(context);
}

static void test_shared_scenes(void **state) {
  (void)state;
  hl_context *context = make_context();
  hl_scene *scenes[SCENES];
  for (size_t n = 0; n < SCENES; n++) scenes[n] = make_scene(context, n, RENDER_THREADS);
  visit_all(context, scenes);
  for (size_t n = 0; n < SCENES; n++) hl_scene_release(scenes[n]);
  assert_int_equal(hl_context_memory_held(context), 0);
  hl_context_destroy(context);
}

/* ---- cancelling ---- */

typedef struct patience {
  pthread_t owner;
  atomic_bool stop, strayed; /* whether a thread other than the owner asked */
  atomic_int questions;
} patience;

static int asked(void *data) {
  patience *p = data;
  if (!pthread_equal(pthread_self(), p->owner)) atomic_store(&p->strayed, true);
  atomic_fetch_add(&p->questions, 1);
  return atomic_load(&p->stop);
}

static void *say_stop(void *data) {
  patience *p = data;
  while (atomic_load(&p->questions) < 20) usleep(1000);
  atomic_store(&p->stop, true);
  return NULL;
}

static void test_cancelled_from_another_thread(void **state) {
  (void)state;
  patience p = {.owner = pthread_self()};
  hl_context_options options;
  hl_context_options_defaults(&options);
  options.user_data = &p;
  options.cancelled = asked;
  hl_context *context = NULL;
  hl_renderer *renderer = NULL;
  hl_error error = {0};
  pthread_t other;
  assert_int_equal(hl_context_create(&options, &context, NULL), HL_OK);
  hl_scene *small = make_scene(context, 0, RENDER_THREADS), *fine = NULL;
  hl_scene_description description = *hl_scene_describe(small);
  description.width = description.height = 1500;
  description.render.sheet_spacing = 0.05;
  assert_int_equal(hl_scene_create(context, &description, &fine, NULL), HL_OK);
  float *pixels = malloc(1500 * 1500 * 4 * sizeof *pixels);
  assert_int_equal(hl_renderer_create(context, &renderer, NULL), HL_OK);
  atomic_store(&p.questions, 0);
  assert_int_equal(pthread_create(&other, NULL, say_stop, &p), 0);
  assert_int_equal(hl_renderer_render(renderer, fine, pixels, 4 * 1500, NULL, &error), HL_ERROR_CANCELLED);
  assert_non_null(strstr(error.message, "cancelled"));
  pthread_join(other, NULL);
  assert_false(atomic_load(&p.strayed));
  atomic_store(&p.stop, false);
  assert_true(renders(renderer, small, 0));
  free(pixels);
  hl_renderer_destroy(renderer);
  hl_scene_release(small);
  hl_scene_release(fine);
  assert_int_equal(hl_context_memory_held(context), 0);
  hl_context_destroy(context);
}

/* ---- processes ---- */

#if defined(__SANITIZE_THREAD__)
#define UNDER_THREAD_SANITIZER 1
#elif defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define UNDER_THREAD_SANITIZER 1
#endif
#endif

#ifndef UNDER_THREAD_SANITIZER /* the option that allows no threads in a child process */
/* Called in a child process. Returns 0 if everything is right. */
static int render_in_child(hl_context *context, hl_renderer *idle, hl_scene *scene) {
  if (!renders(idle, scene, 0)) return 1;
  if (!renders_afresh(context, scene, 0)) return 2;
  hl_renderer_destroy(idle);
  hl_scene_release(scene);
  return hl_context_memory_held(context) == 0 ? 0 : 3;
}

static void assert_child_does_well(pid_t child) {
  int result = -1;
  assert_true(child > 0);
  assert_int_equal(waitpid(child, &result, 0), child);
  assert_true(WIFEXITED(result));
  assert_int_equal(WEXITSTATUS(result), 0);
}

static void test_after_fork(void **state) {
  (void)state;
  hl_context *context = make_context();
  hl_scene *scene = make_scene(context, 0, RENDER_THREADS);
  hl_renderer *renderer = NULL;
  assert_int_equal(hl_renderer_create(context, &renderer, NULL), HL_OK);
  assert_true(renders(renderer, scene, 0)); /* the renderer has made its threads by now */
  for (int i = 0; i < 3; i++) {
    pid_t child = fork();
    if (child == 0) _exit(render_in_child(context, renderer, scene));
    assert_true(renders(renderer, scene, 0));
    assert_child_does_well(child);
  }
  hl_renderer_destroy(renderer);
  hl_scene_release(scene);
  assert_int_equal(hl_context_memory_held(context), 0);
  hl_context_destroy(context);
}

/* Stops a frame at one of its questions whether to go on, until it may go on. Its other threads are at work,
 * or wait for it. */
typedef struct held_frame {
  pthread_t thread;
  int question;  /* the number of the question at which it stops, from 0 */
  int asked;     /* the number of questions of the frame so far */
  bool in_frame; /* false while the scene is made, which asks questions, too */
  sem_t reached, go_on;
  bool right;
} held_frame;

static int hold_frame(void *data) {
  held_frame *held = data;
  if (!held->in_frame || held->asked++ != held->question) return 0;
  sem_post(&held->reached);
  while (sem_wait(&held->go_on) != 0) continue;
  return 0;
}

static void *render_held(void *data) {
  held_frame *held = data;
  hl_context_options options;
  hl_context_options_defaults(&options);
  options.user_data = held;
  options.cancelled = hold_frame;
  hl_context *context = NULL;
  hl_renderer *renderer = NULL;
  if (hl_context_create(&options, &context, NULL) != HL_OK ||
      hl_renderer_create(context, &renderer, NULL) != HL_OK)
    abort();
  hl_scene *scene = make_scene(context, 0, RENDER_THREADS);
  held->in_frame = true;
  held->right = renders(renderer, scene, 0) && held->asked > held->question + 1;
  if (held->asked <= held->question) sem_post(&held->reached); /* else the test would wait for ever */
  hl_renderer_destroy(renderer);
  hl_scene_release(scene);
  hl_context_destroy(context);
  return NULL;
}

/* A child process is made while another thread renders a frame: at the frame's first question, and at later
 * ones. */
static void test_fork_in_the_middle(void **state) {
  (void)state;
  for (int i = 0; i < 5; i++) {
    held_frame held = {.question = 4 * i};
    assert_int_equal(sem_init(&held.reached, 0, 0), 0);
    assert_int_equal(sem_init(&held.go_on, 0, 0), 0);
    assert_int_equal(pthread_create(&held.thread, NULL, render_held, &held), 0);
    while (sem_wait(&held.reached) != 0) continue;
    pid_t child = fork();
    if (child == 0) {
      hl_context *context = make_context();
      hl_scene *scene = make_scene(context, 1, RENDER_THREADS);
      _exit(renders_afresh(context, scene, 1) ? 0 : 1);
    }
    assert_child_does_well(child);
    sem_post(&held.go_on);
    pthread_join(held.thread, NULL);
    assert_true(held.right);
    sem_destroy(&held.reached);
    sem_destroy(&held.go_on);
  }
}
#endif

/* ---- threads that do not start, and signals ---- */

static atomic_int threads_left = -1; /* the number of threads that the system starts; negative: all */

int __real_pthread_create(pthread_t *thread, const pthread_attr_t *attributes, void *(*start)(void *),
                          void *data);
int __wrap_pthread_create(pthread_t *thread, const pthread_attr_t *attributes, void *(*start)(void *),
                          void *data);

int __wrap_pthread_create(pthread_t *thread, const pthread_attr_t *attributes, void *(*start)(void *),
                          void *data) {
  if (atomic_load(&threads_left) == 0) return EAGAIN;
  if (atomic_load(&threads_left) > 0) atomic_fetch_sub(&threads_left, 1);
  return __real_pthread_create(thread, attributes, start, data);
}

static void on_log(void *data, hl_log_level level, const char *message) {
  if (level == HL_LOG_WARNING) snprintf(data, 200, "%s", message);
}

static void test_fewer_threads(void **state) {
  (void)state;
  for (int started = 0; started < 4; started++) {
    char warning[200] = "";
    hl_context_options options;
    hl_context_options_defaults(&options);
    options.user_data = warning;
    options.log = on_log;
    hl_context *context = NULL;
    assert_int_equal(hl_context_create(&options, &context, NULL), HL_OK);
    hl_scene *scene = make_scene(context, 2, 4);
    atomic_store(&threads_left, started);
    bool right = renders_afresh(context, scene, 2);
    atomic_store(&threads_left, -1);
    assert_true(right);
    char wanted[40];
    snprintf(wanted, sizeof wanted, "only %d of 4 threads", started + 1);
    if (started < 3) assert_non_null(strstr(warning, wanted));
    else assert_int_equal(warning[0], 0);
    hl_scene_release(scene);
    hl_context_destroy(context);
  }
}

/* If all the program's threads block a signal, it stays pending: the library's own threads do not take it. */
static void test_signals_go_to_the_program(void **state) {
  (void)state;
  sigset_t one, pending, before;
  sigemptyset(&one);
  sigaddset(&one, SIGUSR2);
  hl_context *context = make_context();
  hl_scene *scene = make_scene(context, 0, RENDER_THREADS);
  hl_renderer *renderer = NULL;
  assert_int_equal(hl_renderer_create(context, &renderer, NULL), HL_OK);
  assert_true(renders(renderer, scene, 0));
  assert_int_equal(pthread_sigmask(SIG_BLOCK, &one, &before), 0);
  kill(getpid(), SIGUSR2); /* the handler ends the process if any thread takes the signal */
  assert_true(renders(renderer, scene, 0));
  sigpending(&pending);
  assert_true(sigismember(&pending, SIGUSR2));
  int taken = 0;
  assert_int_equal(sigwait(&one, &taken), 0);
  assert_int_equal(taken, SIGUSR2);
  pthread_sigmask(SIG_SETMASK, &before, NULL);
  hl_renderer_destroy(renderer);
  hl_scene_release(scene);
  hl_context_destroy(context);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_a_context_for_each_thread),
      cmocka_unit_test(test_one_context_for_all),
      cmocka_unit_test(test_shared_scenes),
      cmocka_unit_test(test_cancelled_from_another_thread),
#ifndef UNDER_THREAD_SANITIZER
      cmocka_unit_test(test_after_fork),
      cmocka_unit_test(test_fork_in_the_middle),
#endif
      cmocka_unit_test(test_fewer_threads),
      cmocka_unit_test(test_signals_go_to_the_program),
  };
  return cmocka_run_group_tests(tests, find_expected, NULL);
}
