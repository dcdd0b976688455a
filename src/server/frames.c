/* server/frames.c - renders the frames of pages, and stops outdated frames.
 *
 * Each page has a renderer of its own, which keeps everything that does not change from frame to frame. Other
 * pictures of a page, such as small pictures and pictures that will be saved, are made by lanes. A lane is
 * treated as a page of its own, with the name NAME-LANE. The lane's renderer ends when the page requests no
 * more of the lane's pictures. A frame makes all frames of its page with lower numbers outdated. An outdated
 * frame that is being rendered stops at its next check for cancellation; outdated frames that wait are not
 * begun. */
#define _GNU_SOURCE
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "parts.h"
#include "platform/clock.h"
#include "start/joined.h"

/* The work of this thread: a frame that it renders, or a file that it opens. */
static _Thread_local struct {
  server *server;
  int socket;        /* the socket of the client that has requested the frame */
  server_page *page; /* null if there is no page */
  unsigned long long number;
  const server_opened *opened; /* the open scene that this thread prepares; null if the thread prepares
                                * none */
  bool opening;                /* whether a file is being opened */
  server_answer *answer;       /* the answer that receives warnings; null if there is none */
} current;

void work_begin(server *s, int socket, server_answer *answer) {
  current.server = s;
  current.socket = socket;
  current.answer = answer;
}

void work_end(void) {
  current.server = NULL;
  current.answer = NULL;
  current.opened = NULL;
}

void work_begin_for(server *s, const server_opened *opened) {
  current.server = s;
  current.opened = opened;
}

bool server_is_outdated(void) {
  if (current.server == NULL) return false;
  if (current.server->options.stopped()) return true;
  if (current.opened != NULL) return atomic_load(&current.opened->leaving);
  if (peer_is_gone(current.socket)) return true;
  return current.page != NULL && atomic_load(&current.page->newest) > current.number;
}

/* The stage of a frame to which the library has given this name. */
static frame_stage stage_named(const char *name) {
  return strcmp(name, "prepare") == 0 ? STAGE_LABELS
         : strcmp(name, "sky") == 0   ? STAGE_SKY
         : strcmp(name, "load") == 0  ? STAGE_VOXELS
                                      : STAGE_PICTURE;
}

/* Notes how far this thread's frame is, unless the page makes a newer frame. */
static void note_progress(frame_stage stage, double fraction) {
  if (current.page == NULL || atomic_load(&current.page->frame) != current.number) return;
  atomic_store(&current.page->stage, (int)stage);
  atomic_store(&current.page->frame_part, (int)(1000 * fraction));
}

void work_enters(frame_stage stage) { note_progress(stage, 0); }

void server_progress(const char *stage, double fraction) {
  if (current.server == NULL || !(fraction >= 0 && fraction <= 1)) return;
  if (current.opening) atomic_store(&current.server->opening_part, (int)(1000 * fraction));
  else note_progress(stage_named(stage), fraction);
}

void server_warned(const char *message) {
  if (current.answer == NULL || strstr(current.answer->notes, message) != NULL) return;
  char *notes = current.answer->notes;
  size_t length = strlen(notes), room = sizeof current.answer->notes - length;
  snprintf(notes + length, room, "%s%s", length > 0 ? "; " : "", message);
}

bool pages_begin(server *s) {
  bool good = pthread_mutex_init(&s->pages_lock, NULL) == 0 && pthread_mutex_init(&s->seen_lock, NULL) == 0;
  for (int p = 0; p < MOST_PAGES; p++) good &= pthread_mutex_init(&s->pages[p].rendering, NULL) == 0;
  return good;
}

static void forget_renderers(server_page *page) {
  hl_renderer_destroy(page->renderer);
  page->renderer = NULL;
  for (int q = 0; q < QUICK_RENDERERS; q++) {
    hl_renderer_destroy(page->quick[q].renderer);
    page->quick[q] = (quick_renderer){0};
  }
}

static int count_renderers(const server_page *page) {
  int count = page->renderer != NULL;
  for (int q = 0; q < QUICK_RENDERERS; q++) count += page->quick[q].renderer != NULL;
  return count;
}

void pages_end(server *s) {
  for (int p = 0; p < MOST_PAGES; p++) {
    forget_renderers(&s->pages[p]);
    base_forget(&s->pages[p]);
    matter_forget(&s->pages[p]);
    pthread_mutex_destroy(&s->pages[p].rendering);
  }
  seen_forget(s, -1);
  pthread_mutex_destroy(&s->pages_lock);
}

/* ---- pages ---- */

/* Finds the page with this name. If there is none, returns an idle page, whose place the new page can take.
 * Returns null if all pages are busy. */
static server_page *find_page(server *s, const char *name) {
  server_page *best = NULL;
  for (int p = 0; p < MOST_PAGES; p++) {
    server_page *page = &s->pages[p];
    if (strcmp(page->name, name) == 0) return page;
    if (page->users == 0 && (best == NULL || page->last_use < best->last_use)) best = page;
  }
  return best;
}

/* Frees a page that no request holds. */
static void release_page(server *s, server_page *page) {
  if (count_renderers(page) > 0) atomic_store(&s->released, true);
  forget_renderers(page);
  base_forget(page);
  matter_forget(page);
  page->name[0] = '\0';
  /* The value 0 lets the next new page take this place, and not the place of an idle page. */
  page->last_use = 0;
  page->leaving = false;
  atomic_store(&page->newest, 0);
}

/* Finds the page with this name, or makes it in a free place, and holds it until leave_page(). Returns null
 * if all pages are busy. */
static server_page *enter_page(server *s, const char *name, unsigned long long number) {
  pthread_mutex_lock(&s->pages_lock);
  server_page *page = find_page(s, name);
  if (page != NULL && strcmp(page->name, name) != 0) {
    release_page(s, page);
    snprintf(page->name, sizeof page->name, "%s", name);
  }
  if (page != NULL) {
    page->users++;
    page->last_use = ++s->uses;
    page->last_seen = hl_clock_seconds();
    if (atomic_load(&page->newest) < number) atomic_store(&page->newest, number);
  }
  pthread_mutex_unlock(&s->pages_lock);
  return page;
}

static bool is_lane(const server_page *page) { return strchr(page->name, '-') != NULL; }

static void leave_page(server *s, server_page *page) {
  pthread_mutex_lock(&s->pages_lock);
  page->users--;
  page->last_seen = hl_clock_seconds();
  if ((page->leaving || is_lane(page)) && page->users == 0) release_page(s, page);
  pthread_mutex_unlock(&s->pages_lock);
}

void page_is_gone(server *s, const char *name) {
  size_t length = strlen(name);
  pthread_mutex_lock(&s->pages_lock);
  for (int p = 0; p < MOST_PAGES; p++) {
    server_page *page = &s->pages[p];
    if (strncmp(page->name, name, length) != 0 || (page->name[length] != '\0' && page->name[length] != '-'))
      continue;
    atomic_store(&page->newest, ULLONG_MAX);
    page->leaving = true;
    if (page->users == 0) release_page(s, page);
  }
  pthread_mutex_unlock(&s->pages_lock);
}

void pages_expire(server *s) {
  double now = hl_clock_seconds();
  pthread_mutex_lock(&s->pages_lock);
  for (int p = 0; p < MOST_PAGES; p++) {
    server_page *page = &s->pages[p];
    if (page->name[0] != '\0' && page->users == 0 && now - page->last_seen > IDLE_PAGE_SECONDS)
      release_page(s, page);
  }
  pthread_mutex_unlock(&s->pages_lock);
}

pages_state pages_count(server *s) {
  pages_state state = {0};
  pthread_mutex_lock(&s->pages_lock);
  for (int p = 0; p < MOST_PAGES; p++) {
    const server_page *page = &s->pages[p];
    state.pages += page->name[0] != '\0';
    state.rendering += page->users;
    if (page->users == 0) state.renderers += count_renderers(page);
  }
  pthread_mutex_unlock(&s->pages_lock);
  return state;
}

frame_progress page_progress(server *s, const char *name) {
  frame_progress progress = {.stage = STAGE_PICTURE};
  pthread_mutex_lock(&s->pages_lock);
  for (int p = 0; p < MOST_PAGES; p++) {
    server_page *page = &s->pages[p];
    if (page->users == 0) continue;
    if (strcmp(page->name, name) == 0) {
      progress.frame = atomic_load(&page->frame); /* before its part */
      progress.part = atomic_load(&page->frame_part);
      progress.stage = (frame_stage)atomic_load(&page->stage);
    } else {
      progress.others++;
    }
  }
  pthread_mutex_unlock(&s->pages_lock);
  return progress;
}

/* Frees memory by ending the renderers of all pages that no request holds. The next frames of these pages
 * make new renderers. */
static void spare_memory(server *s) {
  seen_forget(s, -1);
  pthread_mutex_lock(&s->pages_lock);
  for (int p = 0; p < MOST_PAGES; p++)
    if (s->pages[p].users == 0) release_page(s, &s->pages[p]);
  pthread_mutex_unlock(&s->pages_lock);
}

/* ---- answers ---- */

const char closed_line[] = "this volume is open no longer, as too many others are: open it again";

void refuse_line(server_answer *answer, unsigned status, const char *line) {
  answer->status = status;
  answer->type = "text/plain; charset=utf-8";
  snprintf(answer->problem, sizeof answer->problem, "%s", line);
}

/* Refuses a request with status 410 if the scene that its page has opened was closed meanwhile. The page then
 * opens the scene again. */
static bool refuse_closed(server *s, long long number, server_answer *answer) {
  server_opened *opened = opened_enter(s, number);
  if (opened != NULL) opened_leave(s, opened);
  else refuse_line(answer, 410, closed_line);
  return opened == NULL;
}

/* Answers with the error. The status is 204 if nobody waits for this frame any more. */
static void fail_frame(server_answer *answer, hl_status status, const hl_error *error) {
  bool is_own = answer->is_own_fault || status == HL_ERROR_MEMORY || status == HL_ERROR_INTERNAL;
  if (status == HL_ERROR_CANCELLED) answer->status = 204;
  else refuse_line(answer, is_own ? 500 : 400, error->message);
}

/* Makes the scene that is rendered while something moves. The result may be the given scene itself. The
 * function waits until the coarser volumes are made, which takes less time than a frame of a large volume. */
static hl_status make_quick(server *s, long long number, hl_scene *scene, hl_scene **quick, hl_error *error) {
  const struct timespec moment = {.tv_nsec = 2000000};
  server_opened *opened = opened_enter(s, number);
  const opened_state *now = opened != NULL ? opened_now(opened) : NULL;
  while (now != NULL && !atomic_load(&now->prepared) && !server_is_outdated()) nanosleep(&moment, NULL);
  hl_preview *preview = now != NULL ? atomic_load(&now->preview) : NULL;
  hl_status status = preview != NULL ? hl_preview_scene(preview, scene, quick, error) : HL_OK;
  if (opened != NULL) opened_leave(s, opened);
  return status;
}

static hl_status fail_finer(const char *problem, hl_error *error) {
  snprintf(error->message, sizeof error->message, "only a coarser resolution was read: %.900s", problem);
  return HL_ERROR_INPUT;
}

/* Waits until the finest resolutions of an open scene's volumes are read. */
static hl_status await_finest(server *s, long long number, hl_error *error) {
  const struct timespec moment = {.tv_nsec = 2000000};
  hl_status status = HL_OK;
  server_opened *opened = opened_enter(s, number);
  if (opened == NULL) return HL_OK; /* read_scene() tells it */
  while (atomic_load(&opened->refining) && !server_is_outdated()) nanosleep(&moment, NULL);
  if (atomic_load(&opened->refining)) status = HL_ERROR_CANCELLED;
  else if (opened->problem[0] != '\0') status = fail_finer(opened->problem, error);
  opened_leave(s, opened);
  return status;
}

static hl_status read_scene(server *s, long long number, const char *text, size_t length, hl_scene **scene,
                            hl_error *error) {
  server_opened *opened = opened_enter(s, number);
  if (opened == NULL) {
    snprintf(error->message, sizeof error->message, "%s", closed_line);
    return HL_ERROR_INPUT;
  }
  hl_status status = hl_scene_from_json_like(s->sealed, text, length, NULL, "scene",
                                             opened_now(opened)->scene, scene, error);
  opened_leave(s, opened);
  if (status != HL_OK) return status;
  const hl_scene_description *d = hl_scene_describe(*scene);
  if ((long long)d->width * d->height <= MOST_PIXELS) return HL_OK;
  snprintf(error->message, sizeof error->message, "/image: %d x %d pixels are more than the viewer's %d",
           d->width, d->height, (int)MOST_PIXELS);
  hl_scene_release(*scene);
  *scene = NULL;
  return HL_ERROR_INPUT;
}

void answer_scene(server *s, const frame_request *request, const composed_choices *choices,
                  const film_request *film, int frame, server_answer *answer) {
  hl_scene *scene = NULL;
  hl_error error = {0};
  current.page = NULL;
  if (refuse_closed(s, request->opened, answer)) return;
  hl_status status = read_scene(s, request->opened, request->text, request->length, &scene, &error);
  if (status == HL_OK) status = compose_choices(s->sealed, choices, &scene, &error);
  if (status == HL_OK && film != NULL) status = turn_to_frame(s, &scene, film, frame, &error);
  if (status == HL_OK) status = hl_scene_to_json(s->options.context, scene, &answer->text, &error);
  hl_scene_release(scene);
  if (status != HL_OK) {
    fail_frame(answer, status, &error);
    return;
  }
  answer->status = 200;
  answer->type = "application/json";
  answer->length = strlen(answer->text);
}

/* The page's renderer for a scene of coarser volumes. If no place has a renderer for these volumes, the
 * renderer whose last use is the longest time ago is used. */
static hl_renderer **quick_renderer_of(server_page *page, const hl_scene *scene) {
  const hl_volume *volume = hl_scene_describe(scene)->volumes[0].volume;
  quick_renderer *found = &page->quick[0];
  for (int q = 1; q < QUICK_RENDERERS; q++)
    if (page->quick[q].last_use < found->last_use) found = &page->quick[q];
  for (int q = 0; q < QUICK_RENDERERS; q++)
    if (page->quick[q].volume == volume) found = &page->quick[q];
  found->volume = volume;
  found->last_use = ++page->quick_uses;
  return &found->renderer;
}

/* Answers with the overlays of a scene. If the scene is not the one of the page's newest picture, the lane's
 * own renderer finds out where the matter is. */
static hl_status make_overlay(server *s, server_page *page, const hl_scene *scene,
                              const frame_request *request, server_answer *answer, hl_error *error) {
  hl_render_statistics statistics = {.struct_size = sizeof statistics};
  double began = hl_clock_seconds();
  hl_status status = HL_OK;
  hl_image *matter = matter_find(s, request);
  if (matter == NULL) {
    if (page->renderer == NULL) status = hl_renderer_create(s->options.context, &page->renderer, error);
    if (status == HL_OK) status = render_small(s, page->renderer, scene, &matter, &statistics, error);
    answer->seconds_once += statistics.seconds_prepare;
    answer->seconds_render = hl_clock_seconds() - began;
  }
  if (status == HL_OK) status = write_overlay(s, matter, scene, request, answer, error);
  hl_image_destroy(matter);
  return status;
}

/* Renders a frame. renderer: the page's renderer for moving scenes, or for scenes at rest. */
static hl_status render(server *s, server_page *page, hl_renderer **renderer, const hl_scene *scene,
                        const frame_request *request, server_answer *answer, hl_error *error) {
  const hl_scene_description *d = hl_scene_describe(scene);
  hl_image *image = NULL;
  hl_render_statistics statistics = {.struct_size = sizeof statistics};
  const bool is_new = *renderer == NULL;
  double began = hl_clock_seconds(), worked = hl_processor_seconds();
  hl_status status = is_new ? hl_renderer_create(s->options.context, renderer, error) : HL_OK;
  if (status == HL_OK && strcmp(request->format, "depth") == 0)
    return render_depth(page, scene, answer, error);
  if (status == HL_OK) status = check_overlay(s, scene, request, error);
  if (status == HL_OK) status = hl_image_create(s->options.context, d->width, d->height, &image, error);
  if (status == HL_OK)
    status = hl_renderer_render(*renderer, scene, hl_image_pixels(image), 4 * (size_t)d->width, &statistics,
                                error);
  if (is_new) answer->seconds_once += statistics.seconds_prepare;
  double rendered = hl_clock_seconds();
  if (status == HL_OK && !request->moving && !is_lane(page)) matter_keep(s, page, request, image);
  if (status == HL_OK) status = write_picture(s, scene, image, request, answer, error);
  hl_image_destroy(image);
  answer->seconds_render = rendered - began;
  answer->seconds_encode = hl_clock_seconds() - rendered;
  if (!is_new) answer->seconds_processor = hl_processor_seconds() - worked;
  return status;
}

/* Reads the scene and renders it. The frames of a page are rendered one after the other. seen: the scene with
 * the finer voxels that the picture sees; null if the scene's own volumes are shown. */
static hl_status make_frame(server *s, server_page *page, const frame_request *request,
                            const film_request *film, const hl_scene *seen, server_answer *answer,
                            hl_error *error) {
  hl_scene *scene = NULL, *quick = NULL;
  double began = hl_clock_seconds();
  if (server_is_outdated()) return HL_ERROR_CANCELLED;
  hl_status status = request->coarse ? HL_OK : await_finest(s, request->opened, error);
  if (status == HL_OK) status = read_scene(s, request->opened, request->text, request->length, &scene, error);
  if (status == HL_OK && seen != NULL) status = seen_take(s, seen, &scene, error);
  double parsed = hl_clock_seconds();
  if (status == HL_OK && request->moving) status = make_quick(s, request->opened, scene, &quick, error);
  bool coarser = quick != NULL && quick != scene;
  answer->seconds_read = hl_clock_seconds() - began;
  answer->seconds_once = hl_clock_seconds() - parsed;
  if (status == HL_OK)
    status = film != NULL ? render_film(s, page, scene, film, answer, error)
             : strcmp(request->format, "overlay") == 0
                 ? make_overlay(s, page, scene, request, answer, error)
                 : render(s, page, coarser ? quick_renderer_of(page, quick) : &page->renderer,
                          coarser ? quick : scene, request, answer, error);
  hl_scene_release(quick);
  hl_scene_release(scene);
  return status;
}

/* If a request's text is a difference, replaces it by the text of the whole scene. If it is a whole scene, it
 * becomes the page's base. Returns false if the request is refused. *text: owned by the caller (free()), or
 * null. */
static bool complete_request(server *s, server_page *page, frame_request *request, char **text,
                             server_answer *answer) {
  *text = NULL;
  if (request->base == 0) {
    if (!is_lane(page)) base_keep(s, page, request);
    return true;
  }
  *text = base_changed(s, page, request, answer);
  request->text = *text;
  request->length = *text != NULL ? strlen(*text) : 0;
  return *text != NULL;
}

/* Reads the finer voxels that a picture at rest sees. Meanwhile other frames of the page are rendered. A
 * frame with a higher number cancels the reading. */
static hl_status read_seen(server *s, const frame_request *request, hl_scene **seen, hl_error *error) {
  hl_scene *scene = NULL;
  hl_status status = read_scene(s, request->opened, request->text, request->length, &scene, error);
  if (status == HL_OK) status = seen_read(s, request->opened, scene, seen, error);
  hl_scene_release(scene);
  return status;
}

/* Finds the finer voxels of a frame that shows them. If they cannot be read, a picture that is saved fails,
 * and other pictures are made of coarser voxels; the answer then says why. */
static hl_status find_seen(server *s, server_page *page, const frame_request *request, hl_scene **seen,
                           server_answer *answer, hl_error *error) {
  hl_status status = request->coarse ? HL_OK : await_finest(s, request->opened, error);
  if (status != HL_OK) return status;
  status = read_seen(s, request, seen, error);
  if (status == HL_ERROR_MEMORY) {
    spare_memory(s);
    pthread_mutex_lock(&page->rendering);
    forget_renderers(page);
    pthread_mutex_unlock(&page->rendering);
    status = read_seen(s, request, seen, error);
  }
  if (status == HL_ERROR_CANCELLED) return status;
  if (status != HL_OK && !request->coarse) {
    const hl_error of_voxels = *error;
    return fail_finer(of_voxels.message, error);
  }
  if (status != HL_OK || *seen != NULL)
    seen_describe(*seen, status != HL_OK ? error->message : "", answer->seen, sizeof answer->seen);
  return HL_OK;
}

/* Notes which frame of a page is being made. */
static void begin_frame(server_page *page, unsigned long long number) {
  atomic_store(&page->frame_part, 0);
  atomic_store(&page->stage, STAGE_PICTURE);
  atomic_store(&page->frame, number);
}

/* Answers with a frame of a page that this request holds. */
static void answer_page(server *s, server_page *page, const frame_request *request, const film_request *film,
                        server_answer *answer) {
  hl_error error = {0};
  hl_scene *seen = NULL;
  hl_status status = HL_OK;
  current.page = page;
  current.number = request->number;
  if (film == NULL && (request->seen || !request->coarse)) {
    if (atomic_load(&page->newest) == request->number) begin_frame(page, request->number);
    status = find_seen(s, page, request, &seen, answer, &error);
  }
  pthread_mutex_lock(&page->rendering);
  begin_frame(page, request->number);
  const bool is_read = status == HL_OK;
  if (is_read) status = make_frame(s, page, request, film, seen, answer, &error);
  /* If memory is short, releases the memory of idle pages and of this page's earlier frames, and tries once
   * more. */
  if (is_read && status == HL_ERROR_MEMORY) {
    spare_memory(s);
    forget_renderers(page);
    status = make_frame(s, page, request, film, seen, answer, &error);
  }
  current.page = NULL;
  pthread_mutex_unlock(&page->rendering);
  hl_scene_release(seen);
  if (status == HL_OK) answer->status = 200;
  else fail_frame(answer, status, &error);
}

void answer_frame(server *s, const frame_request *request, const film_request *film, server_answer *answer) {
  if (refuse_closed(s, request->opened, answer)) return;
  server_page *page = enter_page(s, request->page, request->number);
  if (page == NULL) {
    refuse_line(answer, 503, "too many pages render at once: close one");
    return;
  }
  frame_request whole = *request;
  char *text;
  if (complete_request(s, page, &whole, &text, answer)) answer_page(s, page, &whole, film, answer);
  free(text);
  leave_page(s, page);
}

void cancel_frames(server *s, const char *name, unsigned long long number) {
  pthread_mutex_lock(&s->pages_lock);
  for (int p = 0; p < MOST_PAGES; p++)
    if (strcmp(s->pages[p].name, name) == 0 && atomic_load(&s->pages[p].newest) < number)
      atomic_store(&s->pages[p].newest, number);
  pthread_mutex_unlock(&s->pages_lock);
}

bool film_progress(server *s, const char *name, int *done, int *frames) {
  bool found = false;
  pthread_mutex_lock(&s->pages_lock);
  for (int p = 0; p < MOST_PAGES; p++)
    if (strcmp(s->pages[p].name, name) == 0) {
      *done = atomic_load(&s->pages[p].film_done);
      *frames = atomic_load(&s->pages[p].film_frames);
      found = *frames > 0;
    }
  pthread_mutex_unlock(&s->pages_lock);
  return found;
}

/* Adds a scene to the open scenes, and answers with its start.json or with the error. Releases the scene. */
static void answer_opened(server *s, hl_scene *scene, const char *title, hl_status status, hl_error *error,
                          server_answer *answer) {
  if (status == HL_OK) {
    server_opened *opened = opened_add(s, scene, title);
    answer->from_malloc = opened != NULL ? (unsigned char *)strdup(opened_now(opened)->start) : NULL;
    if (opened != NULL) opened_leave(s, opened);
    if (answer->from_malloc == NULL) {
      snprintf(error->message, sizeof error->message, "no memory to open another file");
      status = HL_ERROR_MEMORY;
    }
  }
  hl_scene_release(scene);
  if (status != HL_OK) {
    fail_frame(answer, status, error);
    return;
  }
  answer->status = 200;
  answer->type = "application/json";
  answer->length = strlen((const char *)answer->from_malloc);
}

void answer_open(server *s, const server_file *file, const char *title, server_answer *answer) {
  hl_scene *scene = NULL;
  hl_error error = {0};
  current.page = NULL;
  current.opening = true;
  atomic_store(&s->opening_part, 0);
  hl_status status = s->options.open(s->options.files_data, file, &scene, &error);
  if (status == HL_ERROR_MEMORY) {
    spare_memory(s);
    status = s->options.open(s->options.files_data, file, &scene, &error);
  }
  current.opening = false;
  answer_opened(s, scene, title, status, &error, answer);
}

void answer_join(server *s, const frame_request *request, long long with, const char *title,
                 server_answer *answer) {
  hl_scene *base = NULL, *joined = NULL;
  hl_error error = {0};
  current.page = NULL;
  if (refuse_closed(s, request->opened, answer) || refuse_closed(s, with, answer)) return;
  hl_status status = read_scene(s, request->opened, request->text, request->length, &base, &error);
  server_opened *added = opened_enter(s, with);
  if (status == HL_OK && added != NULL)
    status = join_scenes(s->options.context, base, opened_now(added)->scene, &joined, &error);
  if (added != NULL) opened_leave(s, added);
  opened_close(s, with);
  hl_scene_release(base);
  answer_opened(s, joined, title, status, &error, answer);
}
