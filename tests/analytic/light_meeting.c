/* analytic/light_meeting.c - see light_meeting.h. */
#define _POSIX_C_SOURCE 200809L /* barriers */
#include <pthread.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "light_meeting.h"
#include "render/renderer_state.h"

enum { MOST_POSTS = 20000 };

/* A message that one part of the picture has sent. */
typedef struct sent_post {
  unsigned char *bytes; /* owned; [count] */
  size_t count;
} sent_post;

/* The meeting place of all parts of a picture. */
struct meeting {
  int parts;
  pthread_barrier_t barrier;
  const void *from[MOST_BANDS];
  pthread_mutex_t lock;
  pthread_cond_t arrived;
  sent_post posts[MOST_BANDS][MOST_POSTS];
  int post_count[MOST_BANDS];
};

static void gather_parts(void *data, const void *from, size_t bytes, void *to) {
  part_thread *part = data;
  meeting *meeting = part->meeting;
  part->gathered += bytes;
  meeting->from[part->exchange.part] = from;
  pthread_barrier_wait(&meeting->barrier);
  for (int i = 0; i < meeting->parts; i++)
    memcpy((unsigned char *)to + (size_t)i * bytes, meeting->from[i], bytes);
  pthread_barrier_wait(&meeting->barrier); /* no part changes bytes that other parts still read */
}

static void send_post(void *data, const light_post *post) {
  part_thread *part = data;
  meeting *meeting = part->meeting;
  int own = part->exchange.part, *number = post->memory;
  assert_true(post->bytes <= post->most && meeting->post_count[own] < MOST_POSTS);
  part->gathered += post->bytes;
  memset(post->to, 0xff, (size_t)meeting->parts * post->most); /* no part reads bytes that have not arrived */
  pthread_mutex_lock(&meeting->lock);
  *number = meeting->post_count[own]++;
  sent_post *sent = &meeting->posts[own][*number];
  *sent = (sent_post){malloc(post->bytes), post->bytes};
  memcpy(sent->bytes, post->from, post->bytes);
  pthread_cond_broadcast(&meeting->arrived);
  pthread_mutex_unlock(&meeting->lock);
}

static void look_at_post(void *data, const light_post *post) {
  (void)post;
  ((part_thread *)data)->looks++;
}

static void receive_post(void *data, const light_post *post) {
  part_thread *part = data;
  meeting *meeting = part->meeting;
  int number = *(int *)post->memory;
  pthread_mutex_lock(&meeting->lock);
  for (int i = 0; i < meeting->parts; i++) {
    while (meeting->post_count[i] <= number) pthread_cond_wait(&meeting->arrived, &meeting->lock);
    const sent_post *sent = &meeting->posts[i][number];
    if (i != part->exchange.part)
      memcpy((unsigned char *)post->to + (size_t)i * post->most, sent->bytes, sent->count);
    else part->spoiled = part->spoiled || memcmp(post->from, sent->bytes, sent->count) != 0;
  }
  pthread_mutex_unlock(&meeting->lock);
}

static void *render_exchanging(void *data) {
  part_thread *part = data;
  stage set;
  hl_scene *scene = NULL;
  hl_renderer *renderer = NULL;
  hl_render_statistics statistics = {.struct_size = sizeof statistics};
  stage_open(&set);
  part->prepare(&set);
  set.scene.width = part->width;
  set.scene.height = part->height;
  set.scene.render.threads = 1;
  set.scene.render.sheet_spacing = 1;
  part->status = hl_scene_create(set.context, &set.scene, &scene, NULL);
  if (part->status == HL_OK) part->status = hl_renderer_create(set.context, &renderer, NULL);
  if (part->status == HL_OK) hl_renderer_exchange(renderer, &part->exchange);
  for (int frame = 0; frame < part->frames && part->status == HL_OK; frame++)
    part->status = hl_renderer_render(renderer, scene, part->pixels, 4 * (size_t)part->width, &statistics,
                                      NULL);
  part->filled = statistics.pixels_filled_light;
  hl_renderer_destroy(renderer);
  hl_scene_release(scene);
  stage_close(&set);
  return NULL;
}

void render_together(part_thread *threads, int parts, exchange_way how, int width, int height, int frames,
                     void (*prepare)(stage *set), float *pixels) {
  static float kept[MOST_BANDS][TOGETHER_SIDE * TOGETHER_SIDE * 4];
  static meeting meeting;
  meeting = (struct meeting){.parts = parts};
  pthread_t running[MOST_BANDS];
  assert_true(parts <= MOST_BANDS && width <= TOGETHER_SIDE && height <= TOGETHER_SIDE);
  pthread_barrier_init(&meeting.barrier, NULL, (unsigned)parts);
  pthread_mutex_init(&meeting.lock, NULL);
  pthread_cond_init(&meeting.arrived, NULL);
  light_exchange exchange = {.parts = parts, .gather = gather_parts};
  if (how != WAITING) {
    exchange.send = send_post;
    exchange.look = look_at_post;
    exchange.receive = receive_post;
    exchange.post_bytes = sizeof(int);
    exchange.most_posted = how == LITTLE_POSTS ? 100000 : 0;
  }
  for (int i = 0; i < parts; i++) {
    threads[i] = (part_thread){.meeting = &meeting,
                               .exchange = exchange,
                               .prepare = prepare,
                               .pixels = kept[i],
                               .width = width,
                               .height = height,
                               .frames = frames};
    threads[i].exchange.part = i;
    threads[i].exchange.data = &threads[i];
    assert_int_equal(pthread_create(&running[i], NULL, render_exchanging, &threads[i]), 0);
  }
  size_t floats = (size_t)width * (size_t)height * 4;
  memset(pixels, 0, floats * sizeof *pixels);
  for (int i = 0; i < parts; i++) {
    pthread_join(running[i], NULL);
    assert_int_equal(threads[i].status, HL_OK);
    assert_false(threads[i].spoiled);
    for (size_t k = 0; k < floats; k++) pixels[k] += kept[i][k];
  }
  for (int i = 0; i < parts; i++)
    for (int n = 0; n < meeting.post_count[i]; n++) free(meeting.posts[i][n].bytes);
  pthread_barrier_destroy(&meeting.barrier);
  pthread_mutex_destroy(&meeting.lock);
  pthread_cond_destroy(&meeting.arrived);
}
