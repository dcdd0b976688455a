/* server/opened.c - scenes that are open: the program's input, and scenes that pages have opened.
 *
 * A frame's scene may name the volumes of one open scene. If there is no room for another scene, the one that
 * was used longest ago is closed, among those that no request holds. */
#define _GNU_SOURCE
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "parts.h"
#include "start/start.h"

static server_opened *find(server *s, long long number) {
  for (int o = 0; o < MOST_OPENED; o++)
    if (s->opened[o].scene != NULL && s->opened[o].number == number) return &s->opened[o];
  return NULL;
}

server_opened *opened_enter(server *s, long long number) {
  pthread_mutex_lock(&s->pages_lock);
  server_opened *opened = find(s, number);
  if (opened != NULL) {
    opened->users++;
    opened->last_use = ++s->uses;
  }
  pthread_mutex_unlock(&s->pages_lock);
  return opened;
}

static void release(server *s, server_opened *opened) {
  if (opened->scene != NULL) atomic_store(&s->released, true);
  hl_preview_destroy(atomic_load(&opened->preview));
  hl_scene_release(opened->scene);
  free(opened->start);
  *opened = (server_opened){0};
}

void opened_leave(server *s, server_opened *opened) {
  pthread_mutex_lock(&s->pages_lock);
  opened->users--;
  if (atomic_load(&opened->leaving) && opened->users == 0) release(s, opened);
  pthread_mutex_unlock(&s->pages_lock);
}

void opened_close(server *s, long long number) {
  pthread_mutex_lock(&s->pages_lock);
  server_opened *opened = number > 0 ? find(s, number) : NULL;
  if (opened != NULL) atomic_store(&opened->leaving, true);
  if (opened != NULL && opened->users == 0) release(s, opened);
  pthread_mutex_unlock(&s->pages_lock);
}

/* ---- previews: made once for each scene, by a thread in the background ---- */

typedef struct preparation {
  server *server;
  long long number;
} preparation;

static void *prepare(void *user_data) {
  const preparation about = *(preparation *)user_data;
  free(user_data);
  server *s = about.server;
  server_opened *opened = opened_enter(s, about.number);
  hl_preview *made = NULL;
  if (opened != NULL) {
    work_begin_for(s, opened);
    if (hl_preview_create(s->options.context, opened->scene, &made, NULL) == HL_OK)
      atomic_store(&opened->preview, made);
    atomic_store(&opened->prepared, true);
    work_end();
    opened_leave(s, opened);
  }
  atomic_fetch_sub(&s->preparing, 1);
  return NULL;
}

/* Begins to make the preview of an open scene. Without memory or another thread there is no preview, and
 * quick frames show the volumes as they are. */
static void begin_preview(server *s, server_opened *opened) {
  pthread_t thread;
  preparation *about = malloc(sizeof *about);
  if (about != NULL) {
    *about = (preparation){s, opened->number};
    atomic_fetch_add(&s->preparing, 1);
    if (pthread_create(&thread, NULL, prepare, about) == 0) {
      pthread_detach(thread);
      return;
    }
    atomic_fetch_sub(&s->preparing, 1);
    free(about);
  }
  atomic_store(&opened->prepared, true);
}

static void wait_for_previews(server *s) {
  const struct timespec moment = {.tv_nsec = 1000000};
  while (atomic_load(&s->preparing) > 0) nanosleep(&moment, NULL);
}

/* Finds a place for another scene. If necessary, closes the scene that was used longest ago. Null: requests
 * hold all scenes. */
static server_opened *make_room(server *s) {
  server_opened *best = NULL;
  for (int o = 0; o < MOST_OPENED; o++) {
    server_opened *one = &s->opened[o];
    if (one->scene == NULL) return one;
    if (one->users == 0 && (best == NULL || one->last_use < best->last_use)) best = one;
  }
  if (best != NULL) release(s, best);
  return best;
}

server_opened *opened_add(server *s, hl_scene *scene, const char *title) {
  pthread_mutex_lock(&s->pages_lock);
  long long number = s->next_opened++;
  pthread_mutex_unlock(&s->pages_lock);
  char *start = describe_start(s->options.context, scene, title, number, s->below != NULL);
  if (start == NULL) return NULL;
  pthread_mutex_lock(&s->pages_lock);
  server_opened *opened = make_room(s);
  if (opened != NULL) {
    hl_scene_retain(scene);
    *opened = (server_opened){
        .number = number, .scene = scene, .start = start, .users = 1, .last_use = ++s->uses};
  }
  pthread_mutex_unlock(&s->pages_lock);
  if (opened == NULL) free(start);
  else begin_preview(s, opened);
  return opened;
}

int opened_count(server *s) {
  int count = 0;
  pthread_mutex_lock(&s->pages_lock);
  for (int o = 0; o < MOST_OPENED; o++) count += s->opened[o].scene != NULL;
  pthread_mutex_unlock(&s->pages_lock);
  return count;
}

void opened_end(server *s) {
  wait_for_previews(s);
  for (int o = 0; o < MOST_OPENED; o++) release(s, &s->opened[o]);
}
