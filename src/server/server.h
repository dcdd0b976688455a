/* server/server.h - declares the viewer's server, by which pages in browsers show and change scenes.
 *
 * The server answers only on 127.0.0.1, under a path that begins with a random token:
 *
 * - GET TOKEN/: the page, and the files it consists of (page/, embedded in the program)
 * - GET TOKEN/start.json?opened=N: the open scene, its volumes' ranges and histograms, presets, colormaps
 * - GET TOKEN/refined.json?opened=N: how far volumes of several resolutions were read, from coarse to fine
 * - POST TOKEN/frame?page=NAME&number=N&format=FORMAT: a scene file's text in, its picture out
 * - POST TOKEN/scene: a scene file's text in, the same scene with all its defaults written out
 * - POST TOKEN/depth?page=NAME&number=N: a scene file's text in; as JSON, the depth of the place that the
 *   middle of its picture shows; the picture has at most 64 x 64 pixels
 * - POST TOKEN/slice?opened=N&volume=N&width=N&height=N&origin=I,J,K...: the values of a plane of voxels
 * - POST TOKEN/film: a scene file's text in, a film out (as a frame, &turntable=N&key0=PATH=...)
 * - GET TOKEN/progress.json?page=NAME: the progress of the page's frame, and the number of other frames under
 *   way
 * - GET TOKEN/film.json?page=NAME: the progress of the page's film
 * - POST TOKEN/cancel?page=NAME&number=N: makes frames and films of a page outdated
 * - POST TOKEN/leave?page=NAME&opened=N: a page was closed; ends its frames, its renderers and the file that
 *   it had opened
 * - GET TOKEN/folder.json?at=: the files and folders that can be opened in a folder, at or below the folder
 *   in which the viewer was started
 * - POST TOKEN/open?file=PATH&series=NAME: opens a file of the viewer's folder; series: the series to open in
 *   a folder with several DICOM series; PATH may be absolute. The answer is the start.json of the file. The
 *   number in start.json, given as &opened=N, says to which volumes the scene of a later request refers
 * - POST TOKEN/upload?name=NAME: opens the file in the body; the answer is as for open
 * - POST TOKEN/session?file=PATH: a session that a page has saved in the viewer's folder; 204 if the file is
 *   no session
 * - POST TOKEN/join?opened=N&with=M&title=TITLE: in, the text of a scene file with the volumes of scene N;
 *   out, the start.json of this scene joined with the open scene M; scene M is closed
 * - GET TOKEN/opening.json: the progress of reading a file
 * - GET TOKEN/state.json: the server's state: pages, open scenes, bytes, connections
 *
 * Frames with &coarse=1 show volumes of several resolutions at the resolutions that were read so far. Other
 * frames wait until all resolutions are read.
 *
 * A scene names volumes and images of an open scene; no other file is read for it. A file that a page opens
 * may name only files below its own folder; a dropped file lies in a folder of its own. A page's frames are
 * numbered. A frame with a higher number cancels the frames before it, which are answered with 204. */
#ifndef HL_SERVER_SERVER_H
#define HL_SERVER_SERVER_H

#include <stdbool.h>

#include <halflight/halflight.h>

/* A file that a page opens. */
typedef struct server_file {
  hl_context *confined; /* opens only files in the file's folder; if the file is a folder, only files in it */
  const char *name;     /* the file's name in that folder; "." if the file is a folder */
  const char *folder;   /* the folder's absolute path, by which the scene names files; null if the file was
                         * dropped on the page; its scene can then be saved beside it */
  const char *series;   /* the DICOM series that is read (hl_volume_selection.series); null stands for the
                         * largest series */
} server_file;

typedef struct server_options {
  hl_context *context; /* its `cancelled` callback is server_is_outdated() */
  hl_scene *scene;
  const char *title;  /* the input's name, for the page's title */
  const char *unit;   /* unit of lengths, where the files of open scenes tell none; null if there is no such
                       * unit */
  const char *folder; /* absolute path; pages may open files below it; if null, pages may open no files */
  hl_status (*open)(void *files_data, const server_file *file, hl_scene **scene, hl_error *error);
  /* Reads, for each volume whose file has finer resolutions than the resolution that was read
   * (hl_volume_selection.aim), the next finer resolution. *finer: the scene with these volumes; null if no
   * volume has a finer resolution. If the function is null, no scene has finer resolutions. */
  hl_status (*refine)(void *files_data, const hl_scene *scene, hl_scene **finer, hl_error *error);
  /* Reads the voxels of a scene's volumes that the scene's picture sees, at the resolutions that suit the
   * picture's pixels. *seen: the scene with these volumes and their levels; null if no volume has finer
   * voxels for the picture. If the function is null, no scene has finer voxels. */
  hl_status (*read_seen)(void *files_data, const hl_scene *scene, hl_scene **seen, hl_error *error);
  void *files_data;                        /* data for `open`, `refine` and `read_seen` */
  uint64_t most_upload_bytes;              /* the greatest number of bytes of a dropped file; 0 if there is no
                                            * limit */
  int port;                                /* 0 stands for any free port */
  bool (*token)(int port, char token[33]); /* sets the URL's token, 32 hexadecimal digits, to the token that
                                            * was kept for this port. The server calls the function when it
                                            * has the port. If the function is null or returns false, the
                                            * token is random */
  bool (*stopped)(void);                   /* called some times a second; the server ends when the function
                                            * returns true */
  void *user_data;
  void (*ready)(void *user_data, const char *url); /* called once, as soon as the server answers requests */
  void (*visited)(void *user_data); /* called once after `ready`, by another thread, when a browser has loaded
                                     * the page */
} server_options;

/* Serves until options->stopped() returns true. Returns false if the server could not begin, and `problem`
 * has an error line. */
bool server_run(const server_options *options, char *problem, size_t problem_size);

/* A function for the context's `progress` callback. fraction: the part that is finished of the file that this
 * thread opens, or of the current stage of the frame that it renders. */
void server_progress(const char *stage, double fraction);

/* A function for warnings of the context's `log` callback. The answer to the request for which this thread
 * works tells the warning to the page, in the header Halflight-Note. */
void server_warned(const char *message);

/* A function for the context's `cancelled` callback. Returns whether nobody wants the frame that this thread
 * renders any more. */
bool server_is_outdated(void);

#endif
