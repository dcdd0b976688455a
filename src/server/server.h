/* server/server.h - the viewer's server: one scene, looked at and changed by pages in browsers.
 *
 * It answers on 127.0.0.1 alone, under a path that begins with a random token:
 *
 * - GET TOKEN/: the page, and the files it consists of (page/, embedded in the program)
 * - GET TOKEN/start.json: what is open: the scene, its volumes' ranges and histograms, presets, colormaps
 * - POST TOKEN/frame?page=NAME&number=N&format=FORMAT: a scene file's text in, its picture out
 * - POST TOKEN/scene: a scene file's text in, the same scene with all its defaults written out
 * - POST TOKEN/depth?page=NAME&number=N: a scene file's text in; how deep lies what the middle of its
 * picture, of 64 x 64 pixels at most, shows, as JSON
 * - POST TOKEN/slice?opened=N&volume=N&width=N&height=N&origin=I,J,K...: the values of a plane of voxels
 * - POST TOKEN/film: a scene file's text in, a film out (as a frame, &turntable=N&key0=PATH=...)
 * - GET TOKEN/progress.json?page=NAME: how far the page's frame is, and how many other frames are under way
 * - GET TOKEN/film.json?page=NAME: how far the page's film is
 * - POST TOKEN/cancel?page=NAME&number=N: makes frames and films of a page outdated
 * - POST TOKEN/leave?page=NAME&opened=N: a page was closed: its frames, its renderers and the file that it
 * had opened end
 * - GET TOKEN/folder.json?at=: what can be opened in a folder below the one that the viewer was started in
 * - POST TOKEN/open?file=PATH: opens a file there; upload?name=NAME: opens the file in the body. Its
 *   start.json, whose number &opened=N says whose volumes a scene has
 * - POST TOKEN/join?opened=N&with=M&title=TITLE: a scene file's text in, of what N is; the start.json of that
 *   scene with all that M is. M is open no longer
 * - GET TOKEN/opening.json: how far a file is read
 * - GET TOKEN/state.json: what the server holds: pages, open scenes, bytes, connections
 *
 * Scenes name the volumes and images of what is open: no other file is read for them. A file that a page
 * opens may name files below its own folder alone; a dropped one lies in a folder of its own. A page's
 * frames are numbered; one with a higher number cancels those before it, which are answered with 204.
 */
#ifndef HL_SERVER_SERVER_H
#define HL_SERVER_SERVER_H

#include <stdbool.h>

#include <halflight/halflight.h>

/* A file that a page opens. */
typedef struct server_file {
  hl_context *confined; /* to the file's folder, or to itself where it is a folder */
  const char *name;     /* in that folder; "." where it is a folder */
  const char *folder;   /* its absolute path, by which the scene names files; null: the file was dropped, and
                           its   scene can be saved beside it */
} server_file;

typedef struct server_options {
  hl_context *context; /* its `cancelled` callback is server_is_outdated() */
  hl_scene *scene;
  const char *title;  /* the input's name, for the page's title */
  const char *folder; /* absolute; pages may open what lies below it; null: nothing */
  hl_status (*open)(void *files_data, const server_file *file, hl_scene **scene, hl_error *error);
  /* One scene of what is open and what is added to it. */
  hl_status (*join)(void *files_data, hl_scene *base, hl_scene *added, hl_scene **scene, hl_error *error);
  void *files_data;           /* of `open` and `join` */
  uint64_t most_upload_bytes; /* of a file that is dropped; 0: no limit */
  int port;                   /* 0: a free one */
  bool (*token)(int port,
                char token[33]); /* the token of the URL, 32 hexadecimal digits, kept for `port`: asked for
                                  * when the port is this viewer's. Null, or false: a random one */
  bool (*stopped)(void);         /* asked some times a second; true ends server_run() */
  void *user_data;
  void (*ready)(void *user_data, const char *url); /* called once, as soon as the server answers requests */
  void (*visited)(void *user_data); /* called once after `ready`, by another thread: a browser has the page */
} server_options;

/* Serves until options->stopped() returns true. False, with an error line in `problem`, if it could not
 * begin. */
bool server_run(const server_options *options, char *problem, size_t problem_size);

/* For the context's `progress` callback: how far the file is read that this thread opens. */
void server_progress(double fraction);

/* For the context's `cancelled` callback: whether the frame that this thread renders is no longer wanted. */
bool server_is_outdated(void);

#endif
