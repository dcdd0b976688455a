/* server/server.h - the viewer's server: one scene, looked at and changed by pages in browsers.
 *
 * It answers on 127.0.0.1 alone, under a path that begins with a random token:
 *
 *     GET  TOKEN/              the page, and the files it consists of (page/, embedded in the program)
 *     GET  TOKEN/start.json    what is open: the scene, its volumes' ranges and histograms, presets,
 * colormaps POST TOKEN/frame         a scene file's text in, its picture out
 * (?page=NAME&number=N&format=FORMAT) POST TOKEN/scene         a scene file's text in, the same scene with
 * all its defaults written out
 *
 * Scenes name the volumes and images that were open at the start: a page cannot open another file. A page's
 * frames are numbered; one with a higher number cancels those before it, which are answered with 204.
 */
#ifndef HL_SERVER_SERVER_H
#define HL_SERVER_SERVER_H

#include <stdbool.h>

#include <halflight/halflight.h>

typedef struct server_options {
  hl_context *context; /* its `cancelled` callback is server_is_outdated() */
  const hl_scene *scene;
  const char *title;     /* the input's name, for the page's title */
  int port;              /* 0: a free one */
  bool (*stopped)(void); /* asked some times a second; true ends server_run() */
  void *user_data;
  void (*ready)(void *user_data, const char *url); /* called once, when requests are answered */
} server_options;

/* Serves until options->stopped() returns true. False, with an error line in `problem`, if it could not
 * begin. */
bool server_run(const server_options *options, char *problem, size_t problem_size);

/* For the context's `cancelled` callback: whether the frame that this thread renders is no longer wanted. */
bool server_is_outdated(void);

#endif
