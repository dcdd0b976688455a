/* server/requests.c - checks, collects and answers requests. libmicrohttpd gives each connection a thread. */
#define _GNU_SOURCE
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <microhttpd.h>

#include "parts.h"
#include "queries.h"

/* A request whose body is still arriving. */
typedef struct request {
  bool refused; /* whether the request was refused before its body was read */
  const char *path;
  char *body; /* owned; [length] */
  size_t length, capacity;
  bool uploads;
  server_upload upload; /* the file that arrives in the body */
} request;

static const char plain[] = "text/plain; charset=utf-8";

/* The headers of every answer: nothing is cached or shared, and the page runs only its own files. */
static const char *const headers[][2] = {
    {"Content-Security-Policy",
     "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob: data:; connect-src "
     "'self'; "
     "base-uri 'none'; form-action 'none'; frame-ancestors 'none'"},
    {"X-Content-Type-Options", "nosniff"},
    {"Referrer-Policy", "no-referrer"},
    {"Cross-Origin-Opener-Policy", "same-origin"},
    {"Cross-Origin-Resource-Policy", "same-origin"},
    {"Cache-Control", "no-store"},
};

static enum MHD_Result send_response(struct MHD_Connection *connection, unsigned status, const char *type,
                                     struct MHD_Response *response) {
  if (response == NULL) return MHD_NO;
  bool good = type == NULL || MHD_add_response_header(response, "Content-Type", type) == MHD_YES;
  for (size_t h = 0; h < sizeof headers / sizeof *headers; h++)
    good &= MHD_add_response_header(response, headers[h][0], headers[h][1]) == MHD_YES;
  enum MHD_Result result = good ? MHD_queue_response(connection, status, response) : MHD_NO;
  MHD_destroy_response(response);
  return result;
}

static enum MHD_Result send_line(struct MHD_Connection *connection, unsigned status, const char *line) {
  return send_response(connection, status, plain,
                       MHD_create_response_from_buffer(strlen(line), (void *)line, MHD_RESPMEM_MUST_COPY));
}

/* Adds a text as a header's value: letters, digits and a few other characters as they are, and the other
 * bytes as %XX. */
static bool add_encoded(struct MHD_Response *response, const char *name, const char *text) {
  char encoded[3 * sizeof((server_answer *)0)->seen + 1], *end = encoded;
  for (const unsigned char *c = (const unsigned char *)text; *c != '\0' && end < encoded + sizeof encoded - 4;
       c++) {
    const bool is_plain = (*c >= '0' && *c <= '9') || (*c >= 'A' && *c <= 'Z') || (*c >= 'a' && *c <= 'z') ||
                          strchr("-_.,:;/ ", *c) != NULL;
    if (is_plain) *end++ = (char)*c;
    else end += sprintf(end, "%%%02X", *c);
  }
  *end = '\0';
  return MHD_add_response_header(response, name, encoded) == MHD_YES;
}

static enum MHD_Result send_answer(server *s, struct MHD_Connection *connection, server_answer *answer) {
  const void *bytes = answer->borrowed;
  if (answer->bytes != NULL) bytes = answer->bytes;
  if (answer->text != NULL) bytes = answer->text;
  if (answer->from_malloc != NULL) bytes = answer->from_malloc;
  if (bytes == NULL) bytes = answer->problem, answer->length = strlen(answer->problem);
  struct MHD_Response *response;
  if (answer->from_malloc != NULL) {
    response = MHD_create_response_from_buffer(answer->length, answer->from_malloc, MHD_RESPMEM_MUST_FREE);
  } else {
    bool stays = bytes == answer->borrowed;
    response = MHD_create_response_from_buffer(answer->length, (void *)bytes,
                                               stays ? MHD_RESPMEM_PERSISTENT : MHD_RESPMEM_MUST_COPY);
  }
  hl_bytes_release(s->options.context, answer->bytes);
  hl_text_release(s->options.context, answer->text);
  if (response != NULL && answer->seconds_render > 0) {
    char times[200];
    snprintf(times, sizeof times,
             "read;dur=%.3f, render;dur=%.3f, encode;dur=%.3f, once;dur=%.3f, processor;dur=%.3f",
             1e3 * answer->seconds_read, 1e3 * answer->seconds_render, 1e3 * answer->seconds_encode,
             1e3 * answer->seconds_once, 1e3 * answer->seconds_processor);
    if (MHD_add_response_header(response, "Server-Timing", times) != MHD_YES) {
      MHD_destroy_response(response);
      return MHD_NO;
    }
  }
  if (response != NULL && answer->notes[0] != '\0' &&
      !add_encoded(response, "Halflight-Note", answer->notes)) {
    MHD_destroy_response(response);
    return MHD_NO;
  }
  if (response != NULL && answer->seen[0] != '\0' && !add_encoded(response, "Halflight-Seen", answer->seen)) {
    MHD_destroy_response(response);
    return MHD_NO;
  }
  return send_response(connection, answer->status, answer->type, response);
}

/* ---- checks ---- */

static const char *header(struct MHD_Connection *connection, const char *name) {
  return MHD_lookup_connection_value(connection, MHD_HEADER_KIND, name);
}

static enum MHD_Result find_zero(void *found, enum MHD_ValueKind kind, const char *key, size_t key_length,
                                 const char *value, size_t length) {
  (void)kind;
  bool zero = memchr(key, 0, key_length) != NULL || (value != NULL && memchr(value, 0, length) != NULL);
  *(bool *)found |= zero;
  return zero ? MHD_NO : MHD_YES;
}

/* Returns whether a value in the query contains a zero byte, which would cut off a name. */
static bool has_zero(struct MHD_Connection *connection) {
  bool found = false;
  MHD_get_connection_values_n(connection, MHD_GET_ARGUMENT_KIND, find_zero, &found);
  return found;
}

/* Checks the upload of a file that was dropped on the page: the file's name, and whether there is room for
 * the file. */
static unsigned check_upload(const server *s, struct MHD_Connection *connection, request *r,
                             const char **line) {
  const char *name = query_text(connection, "name");
  *line = "this viewer opens no files\n";
  if (s->below == NULL) return 403;
  *line = "this is no file of volumes or scenes that Halflight reads\n";
  if (name == NULL || !upload_is_named(name)) return 400;
  *line = "the file cannot be stored: is the disk full?\n";
  if (!upload_begin(name, &r->upload)) return 500;
  const char *length = header(connection, "Content-Length");
  uint64_t most = s->options.most_upload_bytes;
  r->upload.room = most > 0 ? most : UINT64_MAX;
  *line = "the file is larger than the viewer's memory: open it by a path, or raise --max-memory\n";
  return length != NULL && strtoull(length, NULL, 10) > r->upload.room ? 413 : 0;
}

/* The HTTP status of a refused request, and its error line; if 0, the request is allowed. */
static unsigned check(const server *s, struct MHD_Connection *connection, const char *method, const char *url,
                      request *r, const char **line) {
  const char *host = header(connection, "Host"), *length = header(connection, "Content-Length");
  *line = "this address is another machine's: open the viewer's own URL\n";
  if (!host_is_local(host)) return 403;
  *line = "requests of other pages are refused\n";
  if (!origin_is_own(header(connection, "Origin"), header(connection, "Sec-Fetch-Site"), host)) return 403;
  *line = "the URL's token is wrong: open the URL that the viewer has printed\n";
  r->path = path_after_token(url, s->token);
  if (r->path == NULL) return 403;
  *line = "the query holds a zero byte\n";
  if (has_zero(connection)) return 400;
  *line = "only GET and POST are answered\n";
  bool posts = strcmp(method, "POST") == 0;
  if (!posts && strcmp(method, "GET") != 0) return 405;
  r->uploads = posts && strcmp(r->path, "upload") == 0;
  if (r->uploads) return check_upload(s, connection, r, line);
  *line = "the scene is too large for the viewer\n";
  if (length != NULL && strtoull(length, NULL, 10) > MOST_BODY_BYTES) return 413;
  return 0;
}

/* ---- bodies ---- */

/* Appends a piece of the body. Returns false if the body is too large, or there is no memory for it. */
static bool collect(request *r, const char *bytes, size_t count) {
  if (count > MOST_BODY_BYTES - r->length) return false;
  if (r->length + count > r->capacity) {
    size_t capacity = 2 * r->capacity + count + 4096;
    char *larger = realloc(r->body, capacity);
    if (larger == NULL) return false;
    r->body = larger;
    r->capacity = capacity;
  }
  memcpy(r->body + r->length, bytes, count);
  r->length += count;
  return true;
}

/* ---- answers ---- */

static void answer_problem(server_answer *answer, unsigned status, const char *line) {
  answer->status = status;
  answer->type = plain;
  snprintf(answer->problem, sizeof answer->problem, "%s", line);
}

/* Answers with a JSON text, which the answer then owns. Returns null if memory is short. */
static void answer_json(server_answer *answer, char *text) {
  if (text == NULL) {
    answer_problem(answer, 500, "out of memory\n");
    return;
  }
  answer->status = 200;
  answer->type = "application/json";
  answer->from_malloc = (unsigned char *)text;
  answer->length = strlen(text);
}

static void answer_folder(const server *s, struct MHD_Connection *connection, server_answer *answer) {
  const char *at = query_text(connection, "at");
  char *text = s->below != NULL ? describe_folder(s, at != NULL ? at : "") : NULL;
  if (text == NULL) answer_problem(answer, 404, "there is no such folder below the viewer's\n");
  else answer_json(answer, text);
}

static void answer_film_progress(server *s, struct MHD_Connection *connection, server_answer *answer) {
  const char *page = query_text(connection, "page");
  int done = 0, frames = 0;
  char *text = NULL;
  if (page != NULL) film_progress(s, page, &done, &frames);
  if (asprintf(&text, "{\"done\":%d,\"frames\":%d}", done, frames) < 0) text = NULL;
  answer_json(answer, text);
}

static void answer_progress(server *s, struct MHD_Connection *connection, server_answer *answer) {
  const char *page = query_text(connection, "page");
  char *text = NULL;
  static const char *const names[] = {"picture", "labels", "sky", "voxels"}; /* the names of the stages, in
                                                                              * the order of frame_stage */
  const frame_progress progress = page_progress(s, page != NULL ? page : "");
  if (asprintf(&text, "{\"frame\":%llu,\"part\":%.3f,\"stage\":\"%s\",\"others\":%d}", progress.frame,
               progress.part / 1000.0, names[progress.stage], progress.others) < 0)
    text = NULL;
  answer_json(answer, text);
}

/* Answers with the start.json of an open scene, or with the resolutions that were read of it. */
static void answer_opened(server *s, struct MHD_Connection *connection, bool start, server_answer *answer) {
  long long number = query_number(connection, "opened", 0, MOST_NUMBER, 0);
  server_opened *opened = number >= 0 ? opened_enter(s, number) : NULL;
  if (opened == NULL) {
    answer_problem(answer, 410,
                   number == 0 ? "the volume that the viewer began with is open no longer\n" : closed_line);
    return;
  }
  answer_json(answer, start ? strdup(opened_now(opened)->start) : describe_refinement(opened));
  opened_leave(s, opened);
}

static void answer_opening(server *s, server_answer *answer) {
  char *text = NULL;
  if (asprintf(&text, "{\"part\":%.3f}", atomic_load(&s->opening_part) / 1000.0) < 0) text = NULL;
  answer_json(answer, text);
}

static void answer_state(server *s, server_answer *answer) {
  char *text = NULL;
  int open, waiting;
  const pages_state now = pages_count(s);
  unsigned long long turned_away;
  connections_count(&s->connections, &open, &waiting, &turned_away);
  if (asprintf(&text,
               "{\"pages\":%d,\"rendering\":%d,\"renderers\":%d,\"opened\":%d,\"held\":%llu,\"peak\":%llu,"
               "\"connections\":%d,"
               "\"waiting\":%d,"
               "\"turned_away\":%llu}",
               now.pages, now.rendering, now.renderers, opened_count(s),
               (unsigned long long)hl_context_memory_held(s->options.context),
               (unsigned long long)hl_context_memory_peak(s->options.context), open, waiting,
               turned_away) < 0)
    text = NULL;
  answer_json(answer, text);
}

static void answer_asset(server *s, const char *path, server_answer *answer) {
  if (path[0] == '\0' && atomic_load(&s->announced) && !atomic_exchange(&s->visited, true))
    s->options.visited(s->options.user_data);
  for (size_t a = 0; a < server_asset_count; a++)
    if (strcmp(server_assets[a].name, path) == 0) {
      answer->status = 200;
      answer->type = server_assets[a].type;
      answer->borrowed = server_assets[a].bytes;
      answer->length = server_assets[a].length;
      return;
    }
  answer_problem(answer, 404, "there is nothing here\n");
}

static void answer_get(server *s, struct MHD_Connection *connection, const char *path,
                       server_answer *answer) {
  if (strcmp(path, "start.json") == 0) answer_opened(s, connection, true, answer);
  else if (strcmp(path, "refined.json") == 0) answer_opened(s, connection, false, answer);
  else if (strcmp(path, "folder.json") == 0) answer_folder(s, connection, answer);
  else if (strcmp(path, "film.json") == 0) answer_film_progress(s, connection, answer);
  else if (strcmp(path, "progress.json") == 0) answer_progress(s, connection, answer);
  else if (strcmp(path, "opening.json") == 0) answer_opening(s, answer);
  else if (strcmp(path, "state.json") == 0) answer_state(s, answer);
  else answer_asset(s, path, answer);
}

static void post_frame(server *s, struct MHD_Connection *connection, const request *r,
                       server_answer *answer) {
  frame_request wanted = query_frame(connection, r->body, r->length);
  if (names_page(&wanted) && is_picture_format(wanted.format) && wanted.quality > 0 && wanted.metadata >= 0 &&
      wanted.moving >= 0 && wanted.coarse >= 0 && wanted.seen >= 0 && wanted.base >= 0 &&
      (wanted.depth == 8 || wanted.depth == 16) && overlay_fits(&wanted))
    answer_frame(s, &wanted, NULL, answer);
  else
    answer_problem(answer, 400,
                   "a frame needs ?page=NAME&number=N&format=jpeg|png|exr|npy (&quality=10..100, "
                   "&depth=8|16, &metadata=0|1, &moving=0|1, &coarse=0|1, &seen=0|1, "
                   "&base=N; of a png with 8 bits &scale_bar=0|1, "
                   "&legend=0|1, &marks=0|1, &axes=none|arrows|letters, &unit=TEXT)\n");
}

/* Answers with the depth of the surface that the middle pixel of a small picture of the scene shows. */
static void post_depth(server *s, struct MHD_Connection *connection, const request *r,
                       server_answer *answer) {
  frame_request wanted = query_frame(connection, r->body, r->length);
  wanted.format = "depth";
  wanted.coarse = 1;
  if (names_page(&wanted) && wanted.opened >= 0) answer_frame(s, &wanted, NULL, answer);
  else answer_problem(answer, 400, "a depth needs ?page=NAME&number=N (&opened=N)\n");
}

/* Answers with the overlays of a picture alone. */
static void post_overlay(server *s, struct MHD_Connection *connection, const request *r,
                         server_answer *answer) {
  frame_request wanted = query_frame(connection, r->body, r->length);
  wanted.format = "overlay";
  wanted.coarse = 1;
  if (names_page(&wanted) && wanted.opened >= 0 && names_overlay(&wanted))
    answer_frame(s, &wanted, NULL, answer);
  else
    answer_problem(
        answer, 400,
        "an overlay needs ?page=NAME&number=N (&opened=N, &scale_bar=0|1, &legend=0|1, &marks=0|1, "
        "&axes=none|arrows|letters, &unit=TEXT)\n");
}

static void post_slice(server *s, struct MHD_Connection *connection, server_answer *answer) {
  slice_request wanted = {0};
  if (query_slice(connection, &wanted)) answer_slice(s, &wanted, answer);
  else
    answer_problem(
        answer, 400,
        "a slice needs ?width=N&height=N (&depth=N&volume=N&of=voxels|mask|picture&origin=I,J,K&across=I,J,K"
        "&down=I,J,K&through=I,J,K&blend=maximum|minimum|mean&between=nearest|linear), of 8192 samples "
        "along a side and 16 million in all\n");
}

/* Answers with the scene, or with the scene at a frame of its film. */
static void post_scene(server *s, struct MHD_Connection *connection, const request *r,
                       server_answer *answer) {
  frame_request wanted = query_frame(connection, r->body, r->length);
  film_request film = query_film(connection, NULL);
  composed_choices choices = {query_text(connection, "look"), query_text(connection, "rig")};
  bool turns = query_text(connection, "frame") != NULL;
  int frame = (int)query_number(connection, "frame", 0, MOST_FILM_FRAMES, 0);
  if (frame >= 0 && film.turntable >= 0 && film.frames >= 0)
    answer_scene(s, &wanted, &choices, turns ? &film : NULL, frame, answer);
  else
    answer_problem(answer, 400,
                   "a scene of a film needs ?frame=N&frames=N&turntable=N&key0=... (32 keys at most)\n");
}

static void post_film(server *s, struct MHD_Connection *connection, const request *r, server_answer *answer) {
  frame_request wanted = query_frame(connection, r->body, r->length);
  film_request film = query_film(connection, wanted.format);
  if (names_page(&wanted) && is_film_format(film.format) && film.turntable >= 0 && film.frames >= 0 &&
      film.frames_per_second > 0)
    answer_frame(s, &wanted, &film, answer);
  else
    answer_problem(
        answer, 400,
        "a film needs ?page=NAME&number=N&format=mp4|webm|gif|zip (&turntable=N&frames=N&fps=N&key0=..., "
        "32 keys at most)\n");
}

static void post_cancel(server *s, struct MHD_Connection *connection, const request *r,
                        server_answer *answer) {
  frame_request wanted = query_frame(connection, r->body, r->length);
  answer->status = 204;
  if (names_page(&wanted)) cancel_frames(s, wanted.page, wanted.number);
  else answer_problem(answer, 400, "?page=NAME&number=N is missing\n");
}

/* Handles the message that a page was closed, or that it now shows another file. Ends the frames and
 * renderers of this page, and closes its scene. */
static void post_leave(server *s, struct MHD_Connection *connection, server_answer *answer) {
  const char *page = query_text(connection, "page");
  long long opened = query_number(connection, "opened", 0, MOST_NUMBER, 0);
  answer->status = 204;
  if (is_page_name(page) && opened >= 0) page_is_gone(s, page);
  else answer_problem(answer, 400, "?page=NAME (&opened=N) is missing\n");
  opened_close(s, opened);
}

static void post_open(server *s, struct MHD_Connection *connection, server_answer *answer) {
  const char *name = query_text(connection, "file");
  char path[PATH_BYTES];
  server_file file;
  if (name != NULL && s->below != NULL && folder_find(s, name, path, &file)) {
    const char *slash = strrchr(name, '/');
    file.series = query_text(connection, "series");
    answer_open(s, &file, slash != NULL ? slash + 1 : name, answer);
    hl_context_destroy(file.confined);
  } else {
    answer_problem(answer, 403, "no such file of volumes or scenes lies below the viewer's folder\n");
  }
}

/* Answers with a session that lies below the viewer's folder; with status 204 if the file is none. */
static void post_session(server *s, struct MHD_Connection *connection, server_answer *answer) {
  const char *name = query_text(connection, "file");
  char *text = name != NULL && s->below != NULL ? session_read(s, name) : NULL;
  if (text != NULL) answer_json(answer, text);
  else answer->status = 204;
}

/* Opens a file that was dropped on the page. The folder of this file contains no other file. */
static void open_upload(server *s, const server_upload *upload, const char *name, server_answer *answer) {
  server_file file = {.name = name};
  if (hl_context_confine(s->options.context, upload->folder, &file.confined, NULL) == HL_OK)
    answer_open(s, &file, name, answer);
  else answer_problem(answer, 500, "out of memory for another file\n");
  hl_context_destroy(file.confined);
}

static void post_upload(server *s, struct MHD_Connection *connection, request *r, server_answer *answer) {
  if (!upload_finish(&r->upload))
    answer_problem(answer, 500, "the file cannot be stored: is the disk full?\n");
  else open_upload(s, &r->upload, query_text(connection, "name"), answer);
  upload_end(&r->upload);
}

/* Joins a scene that the page has opened to the page's own scene. */
static void post_join(server *s, struct MHD_Connection *connection, const request *r, server_answer *answer) {
  frame_request wanted = query_frame(connection, r->body, r->length);
  long long with = query_number(connection, "with", 1, MOST_NUMBER, 0);
  const char *title = query_text(connection, "title");
  if (wanted.opened >= 0 && with > 0 && title != NULL && with != wanted.opened)
    answer_join(s, &wanted, with, title, answer);
  else answer_problem(answer, 400, "two files are joined by ?opened=N&with=N&title=TITLE\n");
}

static void answer_post(server *s, struct MHD_Connection *connection, request *r, server_answer *answer) {
  bool frame = strcmp(r->path, "frame") == 0, film = strcmp(r->path, "film") == 0,
       depth = strcmp(r->path, "depth") == 0, join = strcmp(r->path, "join") == 0,
       overlay = strcmp(r->path, "overlay") == 0;
  if (r->uploads) post_upload(s, connection, r, answer);
  else if (strcmp(r->path, "open") == 0) post_open(s, connection, answer);
  else if (strcmp(r->path, "session") == 0) post_session(s, connection, answer);
  else if (strcmp(r->path, "leave") == 0) post_leave(s, connection, answer);
  else if (strcmp(r->path, "cancel") == 0) post_cancel(s, connection, r, answer);
  else if (strcmp(r->path, "slice") == 0) post_slice(s, connection, answer);
  else if (!frame && !film && !depth && !join && !overlay && strcmp(r->path, "scene") != 0)
    answer_problem(answer, 404, "there is nothing here\n");
  else if (r->body == NULL) answer_problem(answer, 400, "the scene is missing\n");
  else if (frame) post_frame(s, connection, r, answer);
  else if (depth) post_depth(s, connection, r, answer);
  else if (overlay) post_overlay(s, connection, r, answer);
  else if (join) post_join(s, connection, r, answer);
  else if (film) post_film(s, connection, r, answer);
  else post_scene(s, connection, r, answer);
}

/* Answers a complete request. The connection does not count as idle while its picture is made. */
static enum MHD_Result answer(server *s, struct MHD_Connection *connection, const char *method, request *r) {
  server_answer a = {0};
  if (strcmp(method, "GET") == 0) {
    answer_get(s, connection, r->path, &a);
    return send_answer(s, connection, &a);
  }
  MHD_set_connection_option(connection, MHD_CONNECTION_OPTION_TIMEOUT, 0u);
  work_begin(s, connection_socket(connection), &a);
  answer_post(s, connection, r, &a);
  work_end();
  MHD_set_connection_option(connection, MHD_CONNECTION_OPTION_TIMEOUT, (unsigned)IDLE_SECONDS);
  return send_answer(s, connection, &a);
}

/* libmicrohttpd calls this after the headers, for each piece of the body, and at its end. */
static enum MHD_Result on_request(void *user_data, struct MHD_Connection *connection, const char *url,
                                  const char *method, const char *version, const char *upload,
                                  size_t *upload_size, void **own) {
  (void)version;
  server *s = user_data;
  request *r = *own;
  if (r == NULL) {
    const char *line = NULL;
    if ((r = calloc(1, sizeof *r)) == NULL) return MHD_NO;
    *own = r;
    unsigned refusal = check(s, connection, method, url, r, &line);
    r->refused = refusal != 0;
    if (refusal == 0) connection_sends(&s->connections, connection);
    return refusal != 0 ? send_line(connection, refusal, line) : MHD_YES;
  }
  if (*upload_size > 0) {
    connection_received(&s->connections, connection, *upload_size);
    bool taken = !r->refused && (r->uploads ? upload_add(&r->upload, upload, *upload_size)
                                            : collect(r, upload, *upload_size));
    *upload_size = 0;
    /* If the body is larger than the request's head states, the connection is ended. */
    return taken ? MHD_YES : MHD_NO;
  }
  r->path = path_after_token(url, s->token);
  if (r->refused || r->path == NULL) return MHD_NO;
  connection_is_answered(&s->connections, connection);
  return answer(s, connection, method, r);
}

static void on_end(void *user_data, struct MHD_Connection *connection, void **own,
                   enum MHD_RequestTerminationCode code) {
  (void)code;
  request *r = *own;
  if (r != NULL) {
    if (!r->refused) connection_is_idle(&((server *)user_data)->connections, connection);
    upload_end(&r->upload);
    free(r->body);
  }
  free(r);
  *own = NULL;
}

struct MHD_Daemon *listen_to_requests(server *s, int listening_socket) {
  return MHD_start_daemon(MHD_USE_THREAD_PER_CONNECTION | MHD_USE_INTERNAL_POLLING_THREAD | MHD_USE_POLL, 0,
                          NULL, NULL, on_request, s, MHD_OPTION_LISTEN_SOCKET, (MHD_socket)listening_socket,
                          MHD_OPTION_CONNECTION_LIMIT, (unsigned)MOST_CONNECTIONS,
                          MHD_OPTION_CONNECTION_TIMEOUT, (unsigned)IDLE_SECONDS, MHD_OPTION_NOTIFY_CONNECTION,
                          connection_changed, &s->connections, MHD_OPTION_NOTIFY_COMPLETED, on_end, s,
                          MHD_OPTION_END);
}
