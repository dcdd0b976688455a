/* server/opened.c - keeps the open scenes: the program's input, and scenes that pages have opened.
 *
 * A frame's scene may name the volumes of one open scene. If another scene needs room, the scene whose last
 * use is the longest time ago is closed, unless a request holds it. A thread for each scene makes its
 * preview, and then reads finer resolutions of its volumes, if there are any. */
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
    if (opened_now(&s->opened[o]) != NULL && s->opened[o].number == number) return &s->opened[o];
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

/* Releases a state, and the states that it replaced. */
static void release_states(opened_state *state) {
  while (state != NULL) {
    opened_state *before = state->before;
    hl_preview_destroy(atomic_load(&state->preview));
    hl_scene_release(state->scene);
    free(state->start);
    free(state);
    state = before;
  }
}

static void release(server *s, server_opened *opened) {
  if (opened_now(opened) != NULL) atomic_store(&s->released, true);
  seen_forget(s, opened->number);
  release_states(atomic_load(&opened->state));
  free(opened->title);
  *opened = (server_opened){0};
}

/* Releases the states that were replaced. No request may use the scene. */
static void release_replaced(server *s, server_opened *opened) {
  opened_state *state = atomic_load(&opened->state);
  if (state == NULL || state->before == NULL) return;
  release_states(state->before);
  state->before = NULL;
  atomic_store(&s->released, true);
}

void opened_leave(server *s, server_opened *opened) {
  pthread_mutex_lock(&s->pages_lock);
  opened->users--;
  if (opened->users == 0) release_replaced(s, opened);
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

/* ---- states ---- */

/* Makes a state of a scene, which is retained; null if there is no memory. */
static opened_state *make_state(const server *s, hl_scene *scene, const char *title, long long number,
                                int refined) {
  const start_about about = {title,
                             number,
                             s->below != NULL,
                             refined,
                             s->options.refine != NULL && hl_scene_is_coarse(hl_scene_describe(scene)),
                             s->options.unit};
  opened_state *state = calloc(1, sizeof *state);
  char *start = state != NULL ? describe_start(s->options.context, scene, &about) : NULL;
  if (start == NULL) {
    free(state);
    return NULL;
  }
  hl_scene_retain(scene);
  state->scene = scene;
  state->start = start;
  state->refined = refined;
  return state;
}

char *describe_refinement(const server_opened *opened) {
  char *text = NULL;
  size_t length = 0;
  bool refining = atomic_load(&opened->refining);
  FILE *out = open_memstream(&text, &length);
  if (out == NULL) return NULL;
  fprintf(out, "{\"refined\":%d,\"refining\":%s,\"problem\":", opened_now(opened)->refined,
          refining ? "true" : "false");
  put_json_text(out, refining ? "" : opened->problem);
  fputc('}', out);
  bool failed = ferror(out) != 0;
  if (fclose(out) == 0 && !failed) return text;
  free(text);
  return NULL;
}

/* ---- the work of the background thread for each scene ---- */

typedef struct preparation {
  server *server;
  long long number;
} preparation;

/* Makes the preview of a state. */
static void make_preview(server *s, opened_state *state) {
  hl_preview *made = NULL;
  if (hl_preview_create(s->options.context, state->scene, &made, NULL) == HL_OK)
    atomic_store(&state->preview, made);
  atomic_store(&state->prepared, true);
}

/* Replaces the state by a state that is finer by one resolution. */
static hl_status refine_once(server *s, server_opened *opened, hl_error *error) {
  opened_state *now = atomic_load(&opened->state);
  hl_scene *scene = NULL;
  hl_status status = s->options.refine(s->options.files_data, now->scene, &scene, error);
  opened_state *finer = scene != NULL ? make_state(s, scene, opened->title, opened->number, now->refined + 1)
                                      : NULL;
  if (status == HL_OK && scene == NULL) {
    snprintf(error->message, sizeof error->message, "the file of finer resolutions is not there any more");
    status = HL_ERROR_INPUT;
  } else if (status == HL_OK && finer == NULL) {
    snprintf(error->message, sizeof error->message, "out of memory for a finer resolution");
    status = HL_ERROR_MEMORY;
  }
  hl_scene_release(scene);
  if (status != HL_OK) return status;
  make_preview(s, finer);
  finer->before = now;
  atomic_store(&opened->state, finer);
  return HL_OK;
}

/* Reads finer resolutions until the finest one is read, or until one of them cannot be read. */
static void refine(server *s, server_opened *opened) {
  hl_error error = {0};
  hl_status status = HL_OK;
  while (status == HL_OK && hl_scene_is_coarse(hl_scene_describe(opened_now(opened)->scene)))
    status = refine_once(s, opened, &error);
  if (status != HL_OK) snprintf(opened->problem, sizeof opened->problem, "%s", error.message);
  atomic_store(&opened->refining, false);
}

static void *prepare(void *user_data) {
  const preparation about = *(preparation *)user_data;
  free(user_data);
  server *s = about.server;
  server_opened *opened = opened_enter(s, about.number);
  if (opened != NULL) {
    work_begin_for(s, opened);
    make_preview(s, atomic_load(&opened->state));
    if (atomic_load(&opened->refining)) refine(s, opened);
    work_end();
    opened_leave(s, opened);
  }
  atomic_fetch_sub(&s->preparing, 1);
  return NULL;
}

/* Begins to make the preview of an open scene, and to read finer resolutions. If no thread can be started or
 * memory is short, frames show the volumes as they are. */
static void begin_preparation(server *s, server_opened *opened) {
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
  snprintf(opened->problem, sizeof opened->problem, "no thread reads finer resolutions: memory is short");
  atomic_store(&opened->refining, false);
  atomic_store(&atomic_load(&opened->state)->prepared, true);
}

static void wait_for_preparations(server *s) {
  const struct timespec moment = {.tv_nsec = 1000000};
  while (atomic_load(&s->preparing) > 0) nanosleep(&moment, NULL);
}

/* Finds a place for another scene. If necessary, closes the scene whose last use is the longest time ago.
 * Returns null if requests hold all scenes. */
static server_opened *make_room(server *s) {
  server_opened *best = NULL;
  for (int o = 0; o < MOST_OPENED; o++) {
    server_opened *one = &s->opened[o];
    if (opened_now(one) == NULL) return one;
    if (one->users == 0 && (best == NULL || one->last_use < best->last_use)) best = one;
  }
  if (best != NULL) release(s, best);
  return best;
}

server_opened *opened_add(server *s, hl_scene *scene, const char *title) {
  pthread_mutex_lock(&s->pages_lock);
  long long number = s->next_opened++;
  pthread_mutex_unlock(&s->pages_lock);
  opened_state *state = make_state(s, scene, title, number, 0);
  char *own_title = strdup(title);
  if (state == NULL || own_title == NULL) {
    release_states(state);
    free(own_title);
    return NULL;
  }
  pthread_mutex_lock(&s->pages_lock);
  server_opened *opened = make_room(s);
  if (opened != NULL)
    *opened = (server_opened){
        .number = number,
        .state = state,
        .title = own_title,
        .refining = s->options.refine != NULL && hl_scene_is_coarse(hl_scene_describe(scene)),
        .users = 1,
        .last_use = ++s->uses};
  pthread_mutex_unlock(&s->pages_lock);
  if (opened == NULL) {
    release_states(state);
    free(own_title);
  } else {
    begin_preparation(s, opened);
  }
  return opened;
}

int opened_count(server *s) {
  int count = 0;
  pthread_mutex_lock(&s->pages_lock);
  for (int o = 0; o < MOST_OPENED; o++) count += opened_now(&s->opened[o]) != NULL;
  pthread_mutex_unlock(&s->pages_lock);
  return count;
}

void opened_end(server *s) {
  wait_for_preparations(s);
  for (int o = 0; o < MOST_OPENED; o++) release(s, &s->opened[o]);
  pthread_mutex_destroy(&s->seen_lock);
}
