/* server/parts.h - data and functions that the files of the server share. */
#ifndef HL_SERVER_PARTS_H
#define HL_SERVER_PARTS_H

#include <pthread.h>
#include <stdatomic.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <halflight/preview.h>

#include "connections.h"
#include "server.h"
#include "start/composed.h"
#include "start/places.h"

enum {
  TOKEN_DIGITS = 32,
  PAGE_NAME_LENGTH = 32,
  MOST_PAGES = 8, /* the most pages that keep a renderer; if there are more, a new page takes the place of the
                   * one that was idle for longest */
  QUICK_RENDERERS = 3, /* number of quick renderers of a page: one for each copy that a preview has of a
                        * volume */
  MOST_OPENED = 6,     /* the most open scenes; if there are more, the one that was not used for longest is
                        * closed */
  PATH_BYTES = 4096,   /* bytes of a path: Linux's PATH_MAX, which realpath() fills */
  MOST_FILM_KEYS = 32,
  MOST_FILM_FRAMES = 100000,
  IDLE_PAGE_SECONDS = 300,   /* seconds after which a page that has asked for nothing loses its renderer */
  MOST_BODY_BYTES = 4 << 20, /* the most bytes of a scene's text */
  MOST_PIXELS = 64 << 20,    /* the most pixels of a picture */
  LEAST_QUALITY = 10,
  MOST_QUALITY = 100 /* the greatest quality of a JPEG */
};

#define MOST_NUMBER 1000000000000LL /* the greatest number that a page may give to a frame */

/* A file of the page, embedded when the program is built (embed.py). */
typedef struct server_asset {
  const char *name; /* "main.js"; the name of the page itself is "" */
  const char *type; /* MIME type of its content */
  const unsigned char *bytes;
  size_t length;
} server_asset;

extern const server_asset server_assets[];
extern const size_t server_asset_count;

/* A renderer for frames while something moves, for volumes at one of the coarser resolutions. There is one
 * for each resolution, because a renderer prepares a volume anew when the volume changes. */
typedef struct quick_renderer {
  hl_renderer *renderer;       /* owned; null if it is not made yet */
  const hl_volume *volume;     /* borrowed; the first volume of the scenes that the renderer renders; only its
                                * address is compared */
  unsigned long long last_use; /* by server_page's quick_uses */
} quick_renderer;

/* What is made for a frame: first what the picture needs and later frames keep, then the picture. */
typedef enum frame_stage { STAGE_PICTURE = 0, STAGE_LABELS = 1, STAGE_SKY = 2 } frame_stage;

/* A page in a browser. Its frames are rendered one after the other. */
typedef struct server_page {
  char name[PAGE_NAME_LENGTH + 1];       /* "": the place is free */
  pthread_mutex_t rendering;             /* held while a frame of the page is rendered */
  hl_renderer *renderer;                 /* owned; guarded by `rendering`; null if it is not made yet */
  quick_renderer quick[QUICK_RENDERERS]; /* guarded by `rendering` */
  unsigned long long quick_uses;         /* guarded by `rendering` */
  atomic_ullong newest;                  /* the highest number of a requested frame */
  atomic_int frame_part; /* how much of the current stage of the frame is finished, in thousandths */
  atomic_int stage;      /* the current stage, a frame_stage */
  atomic_int film_done, film_frames; /* of the film that the page renders: number of finished frames, and
                                      * number of all frames; 0 frames in all: there is no film */
  int users;                         /* number of requests that hold the page; guarded by
                                      * server.pages_lock */
  bool leaving; /* the page was closed: its place becomes free when the last request that holds it ends;
                 * guarded by server.pages_lock */
  unsigned long long last_use; /* guarded by server.pages_lock */
  double last_seen;            /* when the page last asked for something, by server_seconds();
                                * guarded by server.pages_lock */
  char *base; /* owned; the text of the newest scene that the page has sent whole, or null; guarded by
               * server.pages_lock */
  unsigned long long base_number; /* number of the frame of `base`; guarded by server.pages_lock */
} server_page;

/* An open scene as it was read so far. Volumes of several resolutions are read from coarse to fine; each time
 * the whole state is replaced. */
typedef struct opened_state opened_state;

struct opened_state {
  hl_scene *scene;               /* owned */
  char *start;                   /* owned; the text of the scene's start.json */
  int refined;                   /* how often a state was replaced by a finer one before this one */
  _Atomic(hl_preview *) preview; /* owned; null until the preview is made, and where it cannot be made */
  atomic_bool prepared;          /* the preview is made, or cannot be made */
  opened_state *before;          /* owned; the state that this one replaced; requests may still use it */
};

/* A scene that is open. */
typedef struct server_opened {
  long long number; /* the number by which pages name the scene; if 0, the scene is the program's input */
  _Atomic(opened_state *) state; /* owned; if null, the place is free. A state that was loaded stays while the
                                  * scene is entered */
  char *title;                   /* owned */
  atomic_bool refining;          /* finer resolutions are still to be read */
  char problem[1000];  /* why they were not read, an error line; "" where they were. It does not change once
                        * `refining` is false */
  int users;           /* number of requests that use the scene; guarded by server.pages_lock */
  atomic_bool leaving; /* the scene's page has gone; set while server.pages_lock is held */
  unsigned long long last_use; /* guarded by server.pages_lock */
} server_opened;

typedef struct server {
  server_options options;
  hl_context *sealed; /* owned; opens no files; for the scenes that pages send */
  hl_context *below;  /* owned; opens files below the server's folder; null if there is no such folder */
  char token[TOKEN_DIGITS + 1];
  server_opened opened[MOST_OPENED];
  long long next_opened; /* guarded by pages_lock */
  atomic_bool announced; /* options.ready has returned */
  atomic_bool visited;   /* options.visited was called */
  /* Whether renderers or scenes were released since freed memory was last given back to the system. */
  atomic_bool released;
  atomic_int opening_part; /* the part of the volume that has been read, in thousandths */
  atomic_int preparing;    /* number of threads that make previews */
  pthread_mutex_t pages_lock;
  server_page pages[MOST_PAGES];
  unsigned long long uses;
  connection_table connections;
} server;

/* An answer: bytes or a text, and its HTTP status. */
typedef struct server_answer {
  unsigned status;
  const char *type;
  const void *borrowed; /* valid as long as the server; or null */
  size_t length;
  unsigned char *bytes;       /* owned, hl_bytes_release(); or null */
  char *text;                 /* owned, hl_text_release(); or null */
  unsigned char *from_malloc; /* owned, free(); or null */
  char problem[1000];         /* an error line, if the answer has neither bytes nor a text */
  double seconds_read, seconds_render, seconds_encode; /* seconds that reading, rendering and encoding a frame
                                                        * took; all 0 if the answer is no frame */
  double seconds_once; /* of these seconds, those that later frames need not spend again: preparing a new
                        * renderer, and waiting for coarser volumes */
} server_answer;

/* The parameters of a request for a frame. */
typedef struct frame_request {
  const char *page;
  unsigned long long number;
  long long opened;   /* the number of the open scene whose volumes the scene in the request uses */
  const char *format; /* "jpeg", "png", "exr" or "npy". "depth": not a picture, but the depth at its middle.
                       * "overlay": a PNG with only what is drawn over the picture */
  int quality;        /* quality of a JPEG */
  int depth;          /* bits of a PNG's channels: 8 or 16 */
  int metadata;       /* 1: a PNG carries its scene; 0: it does not */
  int scale_bar, legend, marks; /* 1: drawn over a PNG of 8 bits */
  int axes;                     /* an hl_axes; axes are drawn over a PNG of 8 bits, too */
  const char *unit; /* unit of lengths, used where the scene's files tell none; null if there is no such
                     * unit */
  int moving;     /* 1: a quick frame, of coarser volumes where the sheets are wide; 0: the scene as it is */
  int coarse;     /* 1: the volumes are taken as they were read so far; 0: the frame waits for the finest
                   * resolutions that are to be read, and fails where they cannot be read */
  long long base; /* 0: `text` is a whole scene; else `text` is a difference, from the scene of the page's
                   * frame with this number */
  const char *text; /* the scene */
  size_t length;
} frame_request;

/* The parameters of a request for a film, beside the parameters for its frames. */
typedef struct film_request {
  const char *format; /* "mp4", "webm", "gif", or "zip" of numbered pictures */
  const char *keys[MOST_FILM_KEYS];
  size_t key_count;
  int turntable, frames;
  double frames_per_second;
} film_request;

/* A plane of voxels that a page asks for. */
typedef struct slice_request {
  long long refined; /* `refined` of the state whose voxels the plane is given in; -1: it is not told */
  long long opened, volume; /* number of the open scene, and index of the volume in it */
  slice_source source;
  hl_reslice_options plane;
} slice_request;

/* A file that arrives from a page, in a temporary folder of its own. */
typedef struct server_upload {
  char folder[PATH_BYTES / 2], path[PATH_BYTES];
  FILE *file;
  uint64_t room; /* number of bytes that may still arrive */
} server_upload;

/* frames.c */
bool pages_begin(server *s);
void pages_end(server *s);
/* Between work_begin() and work_end() this thread works for the client at the other end of the socket. Its
 * work is cancelled when the client has gone. */
void work_begin(server *s, int socket);
void work_end(void);
/* From now on, this thread works for an open scene. Its work is cancelled when the page that opened the scene
 * was closed. */
void work_begin_for(server *s, const server_opened *opened);
/* Must be called when a page was closed. Ends the frames of the page and of its lanes (NAME-...), and their
 * renderers. */
void page_is_gone(server *s, const char *name);
void pages_expire(server *s); /* ends the renderers of pages that have not asked for anything for long; must
                               * be called now and then */
/* Counts of the pages of a server and their work. */
typedef struct pages_state {
  int pages;     /* number of pages that may hold a renderer */
  int rendering; /* number of frames that are being rendered, or wait to be */
  int renderers; /* number of renderers of pages that are rendering nothing now */
} pages_state;

pages_state pages_count(server *s);
/* The progress of the page's frame, in thousandths of its stage. *others: the number of other pages, and of
 * lanes of this page, that have frames under way. */
int page_progress(server *s, const char *name, frame_stage *stage, int *others);
/* Answers with a frame. film: null for a picture. */
void answer_frame(server *s, const frame_request *request, const film_request *film, server_answer *answer);
/* Answers with the scene, its defaults written out and the page's choices applied. film: the scene is that of
 * this frame of the film; null if there is no film. */
void answer_scene(server *s, const frame_request *request, const composed_choices *choices,
                  const film_request *film, int frame, server_answer *answer);
/* Makes the page's frames with lower numbers than this one outdated. */
void cancel_frames(server *s, const char *page, unsigned long long number);
/* The progress of the page's film. Returns false if it has none. */
bool film_progress(server *s, const char *page, int *done, int *frames);
/* Opens a file, and answers with its start.json. */
void answer_open(server *s, const server_file *file, const char *title, server_answer *answer);

/* Joins the open scene with the number `with` to the request's scene, and closes it. Answers with the
 * start.json of the joined scene. */
void answer_join(server *s, const frame_request *request, long long with, const char *title,
                 server_answer *answer);

/* Sets an answer that is an error line. */
extern const char closed_line[]; /* the error line for a scene that is not open any more: status 410 */
void refuse_line(server_answer *answer, unsigned status, const char *line);

/* These functions are in bases.c. They lock server.pages_lock, except base_forget(), whose caller must hold
 * the lock. */
void base_keep(server *s, server_page *page, const frame_request *request);
void base_forget(server_page *page);
/* Applies the request's difference to the page's base. Returns the text of the whole scene (free()); if null,
 * the request is refused, with status 409 if the page has another base. */
char *base_changed(server *s, server_page *page, const frame_request *request, server_answer *answer);

/* places.c */
void answer_slice(server *s, const slice_request *request, server_answer *answer);
bool read_triple(const char *text, double numbers[3]);
/* Answers with the depth of the surface or matter that the picture's middle pixel shows. */
hl_status render_depth(server_page *page, const hl_scene *scene, server_answer *answer, hl_error *error);

/* pictures.c */
/* Finds out, before the picture is made, whether the overlays that the request asks for can be drawn. */
hl_status check_overlay(const server *s, const hl_scene *scene, const frame_request *request,
                        hl_error *error);
/* Answers with the overlays alone, as a transparent PNG of the picture's size. */
hl_status write_overlay(const server *s, const hl_scene *scene, const frame_request *request,
                        server_answer *answer, hl_error *error);
/* Answers with the image as a file of the request's format. */
hl_status write_picture(const server *s, const hl_scene *scene, const hl_image *image,
                        const frame_request *request, server_answer *answer, hl_error *error);

/* films.c */
hl_status render_film(server *s, server_page *page, const hl_scene *scene, const film_request *request,
                      server_answer *answer, hl_error *error);

/* Replaces a scene by the scene at a frame of its film. */
hl_status turn_to_frame(server *s, hl_scene **scene, const film_request *film, int frame, hl_error *error);

/* opened.c: open scenes. opened_enter() holds a scene until opened_leave(). Returns null if the scene is not
 * open any more. */
server_opened *opened_enter(server *s, long long number);
static inline const opened_state *opened_now(const server_opened *opened) {
  return atomic_load(&opened->state);
}
/* JSON of how far an open scene was read: {"refined": N, "refining": BOOL, "problem": TEXT} (free()); null if
 * there is no memory. */
char *describe_refinement(const server_opened *opened);
void opened_leave(server *s, server_opened *opened);
/* Closes a scene that a page has opened, as soon as no request holds it. */
void opened_close(server *s, long long number);
/* Adds a scene, retains it, and holds it as opened_enter() does. Returns null if there is no memory or no
 * room. */
server_opened *opened_add(server *s, hl_scene *scene, const char *title);
int opened_count(server *s);
void opened_end(server *s);

/* folder.c */
bool folder_can_open(const char *name); /* judges by the extension */
/* Finds a file below the server's folder. It may be a folder that holds a volume as slices, DICOM or Zarr.
 * The caller owns file->confined. path: set to the absolute path; file->name and file->folder point into it.
 * Returns false if the file does not lie there, after links were followed, or cannot be opened. */
bool folder_find(const server *s, const char *inside, char path[PATH_BYTES], server_file *file);
/* Lists, as JSON (free()), everything that can be opened in a folder below the server's folder; null if there
 * is no such folder. */
char *describe_folder(const server *s, const char *at);
bool upload_folder(const char *name, server_upload *upload); /* makes the folder only */
bool upload_begin(const char *name, server_upload *upload);
bool upload_add(server_upload *upload, const char *bytes, size_t count);
bool upload_finish(server_upload *upload);
void upload_end(server_upload *upload); /* removes the file and its folder */

/* jpeg.c: makes a JPEG of a picture (free()). rgba: [height][width][4]. Null where there is no memory. */
unsigned char *encode_jpeg(const uint8_t *rgba, int width, int height, int quality, size_t *length);

/* guard.c */
/* Whether a Host header names this machine's own address: 127.0.0.1, localhost or [::1]. Any port will do,
 * because a tunnel may end at another port. This refuses pages of other host names that resolve to this
 * machine. */
bool host_is_local(const char *host);
/* Whether an Origin header names the server's own page, or is absent (null). */
bool origin_is_own(const char *origin, const char *host);
/* The rest of a path after "/TOKEN/"; null if the token is wrong. The time that it takes is the same for all
 * wrong tokens. */
const char *path_after_token(const char *path, const char *token);

/* requests.c: sets up libmicrohttpd's callbacks for a server that listens on a socket. */
struct MHD_Daemon *listen_to_requests(server *s, int listening_socket);

#endif
