/* server/parts.h - declares the data and the functions that the files of the server share. */
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
  MOST_PAGES = 8, /* the greatest number of pages that keep a renderer; if there are more pages, a new page
                   * takes the place of the page that was idle for the longest time */
  QUICK_RENDERERS = 3, /* number of quick renderers of a page: one for each copy that a preview has of a
                        * volume */
  MOST_OPENED = 6,     /* the greatest number of open scenes; if there are more, the scene that was not used
                        * for the longest time is closed */
  MOST_SEEN = 2,       /* the greatest number of views whose finer voxels are kept */
  PATH_BYTES = 4096,   /* the greatest number of bytes of a path, which is Linux's PATH_MAX, as realpath()
                        * requires */
  MOST_FILM_KEYS = 32,
  MOST_FILM_FRAMES = 100000,
  IDLE_PAGE_SECONDS = 300,   /* the number of seconds after which a page that has requested nothing loses its
                              * renderer */
  MOST_BODY_BYTES = 4 << 20, /* the greatest number of bytes of a scene's text */
  MOST_PIXELS = 64 << 20,    /* the greatest number of pixels of a picture */
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

/* A renderer for frames while something moves. It renders volumes at one of the coarser resolutions. There is
 * one such renderer for each resolution, because a renderer prepares a volume anew when the volume
 * changes. */
typedef struct quick_renderer {
  hl_renderer *renderer;       /* owned; null if it is not made yet */
  const hl_volume *volume;     /* borrowed; the first volume of the scenes that the renderer renders; only its
                                * address is compared */
  unsigned long long last_use; /* the value of server_page's quick_uses at the last use */
} quick_renderer;

/* The stages of making a frame. Labels and sky are made before the picture. Later frames use them again. */
typedef enum frame_stage {
  STAGE_PICTURE = 0,
  STAGE_LABELS = 1,
  STAGE_SKY = 2,
  STAGE_VOXELS = 3 /* finer voxels of the matter that the picture shows are being read */
} frame_stage;

/* What the newest picture at rest of a page shows. */
typedef struct page_matter {
  hl_image *image;  /* owned; the opacities of the picture, with fewer pixels; null if there is no picture */
  char *scene;      /* owned; [length]; the text of the scene that the picture shows */
  size_t length;    /* number of bytes */
  long long opened; /* the number of the open scene whose volumes the picture shows */
} page_matter;

/* A page in a browser. Its frames are rendered one after the other. */
typedef struct server_page {
  char name[PAGE_NAME_LENGTH + 1];       /* "": the place is free */
  pthread_mutex_t rendering;             /* held while a frame of the page is rendered */
  hl_renderer *renderer;                 /* owned; guarded by `rendering`; null if it is not made yet */
  quick_renderer quick[QUICK_RENDERERS]; /* guarded by `rendering` */
  unsigned long long quick_uses;         /* guarded by `rendering` */
  atomic_ullong newest;                  /* the highest number of a requested frame */
  atomic_int frame_part; /* the part of the frame's current stage that is finished, in thousandths */
  atomic_int stage;      /* the current stage, a frame_stage */
  atomic_ullong frame; /* the number of the frame to which `frame_part` and `stage` belong; it is stored last,
                        * so that a new number is never seen with the part of the frame before */
  atomic_int film_done, film_frames; /* film_done: the number of finished frames of the film that the page
                                      * renders; film_frames: the number of all frames; 0 if the page renders
                                      * no film */
  int users;                         /* number of requests that hold the page; guarded by
                                      * server.pages_lock */
  bool leaving; /* whether the page was closed; its place becomes free when the last request that holds it
                 * ends; guarded by server.pages_lock */
  unsigned long long last_use; /* guarded by server.pages_lock */
  double last_seen;            /* the time of the page's last request, by hl_clock_seconds(); guarded by
                                * server.pages_lock */
  char *base; /* owned; the text of the newest scene that the page has sent as a whole; null if there is none;
               * guarded by server.pages_lock */
  unsigned long long base_number; /* number of the frame of `base`; guarded by server.pages_lock */
  page_matter matter;             /* guarded by server.pages_lock */
} server_page;

/* The state of an open scene: the scene with the resolutions that have been read so far. Volumes of several
 * resolutions are read from coarse to fine; each time the whole state is replaced. */
typedef struct opened_state opened_state;

struct opened_state {
  hl_scene *scene;               /* owned */
  char *start;                   /* owned; the text of the scene's start.json */
  int refined;                   /* the number of times that a state was replaced by a finer one before this
                                  * state was made */
  _Atomic(hl_preview *) preview; /* owned; null until the preview is made; it stays null if the preview cannot
                                  * be made */
  atomic_bool prepared;          /* whether the preview was made, or cannot be made */
  opened_state *before;          /* owned; the state that this one replaced; requests may still use it */
};

/* A scene that is open. */
typedef struct server_opened {
  long long number; /* the number by which pages name the scene; if 0, the scene is the program's input */
  _Atomic(opened_state *) state; /* owned; if null, the place is free. A state that was loaded stays while the
                                  * scene is entered */
  char *title;                   /* owned */
  atomic_bool refining;          /* whether finer resolutions will still be read */
  char problem[1000];  /* the error line of finer resolutions that could not be read; "" if there was no
                        * error. It does not change any more when `refining` is false */
  int users;           /* number of requests that use the scene; guarded by server.pages_lock */
  atomic_bool leaving; /* whether the scene's page was closed; set while server.pages_lock is held */
  unsigned long long last_use; /* guarded by server.pages_lock */
} server_opened;

/* The voxels that pictures at rest see of a view (seen.c). */
typedef struct seen_voxels {
  hl_scene *of; /* owned; a scene of the view, with the volumes of the open scene; null: the place is free */
  hl_scene *with;   /* owned; the same scene with the finer volumes */
  long long opened; /* the number of the open scene */
  unsigned long long last_use;
} seen_voxels;

typedef struct server {
  server_options options;
  hl_context *sealed; /* owned; opens no files; for the scenes that pages send */
  hl_context *below;  /* owned; opens files below the server's folder; null if there is no such folder */
  char token[TOKEN_DIGITS + 1];
  server_opened opened[MOST_OPENED];
  long long next_opened; /* guarded by pages_lock */
  atomic_bool announced; /* whether options.ready has returned */
  atomic_bool visited;   /* whether options.visited was called */
  /* Whether renderers or scenes were released since freed memory was last given back to the system. */
  atomic_bool released;
  atomic_int opening_part; /* the part of the volume that has been read, in thousandths */
  atomic_int preparing;    /* number of threads that make previews */
  pthread_mutex_t pages_lock;
  server_page pages[MOST_PAGES];
  unsigned long long uses;
  pthread_mutex_t seen_lock;
  seen_voxels seen[MOST_SEEN];  /* guarded by seen_lock */
  unsigned long long seen_uses; /* guarded by seen_lock */
  connection_table connections;
} server;

/* An answer: bytes or a text, and its HTTP status. */
typedef struct server_answer {
  unsigned status;
  const char *type;
  const void *borrowed; /* valid until the server ends; or null */
  size_t length;
  unsigned char *bytes;       /* owned, hl_bytes_release(); or null */
  char *text;                 /* owned, hl_text_release(); or null */
  unsigned char *from_malloc; /* owned, free(); or null */
  char problem[1000];         /* an error line, if the answer has neither bytes nor a text */
  bool
      is_own_fault; /* whether an error has its cause in the server, as a full disk, and not in the request */
  char notes[1000]; /* the library's warnings about the answer, with "; " between them; "" if there are
                     * none */
  char seen[3000]; /* facts about the finer voxels that the picture shows, as JSON (seen_describe()); "" if it
                    * shows none and should show none */
  double seconds_read, seconds_render, seconds_encode; /* the times, in seconds, for reading, rendering and
                                                        * encoding a frame; all 0 if the answer is no frame */
  double seconds_once; /* the part of these times that later frames do not need again: the time for preparing
                        * a new renderer, and for waiting for coarser volumes */
  double seconds_processor; /* the processor time of the viewer while it rendered and encoded a frame; 0 if
                             * this included the preparation of a new renderer */
} server_answer;

/* The parameters of a request for a frame. */
typedef struct frame_request {
  const char *page;
  unsigned long long number;
  long long opened;   /* the number of the open scene whose volumes the scene in the request uses */
  const char *format; /* "jpeg", "png", "exr" or "npy". "depth" asks for the depth at the picture's middle in
                       * place of a picture. "overlay" asks for a PNG with the overlays alone */
  int quality;        /* quality of a JPEG */
  int depth;          /* number of bits of a PNG's channels: 8 or 16 */
  int metadata;       /* 1 if a PNG carries its scene, else 0 */
  int scale_bar, legend, marks; /* 1 if this overlay is drawn over a PNG of 8 bits, else 0 */
  int axes;                     /* an hl_axes; axes are drawn over a PNG of 8 bits, too */
  const char *unit; /* unit of lengths, used where the scene's files tell none; null if there is no such
                     * unit */
  int moving;       /* 1 for a quick frame, which uses coarser volumes if the sheets are far apart; 0 for a
                     * frame of the scene as it is */
  int coarse;       /* 1 if the frame uses the volumes that were read so far; 0 if the frame waits for the
                     * finest resolutions, and fails if they cannot be read */
  int seen;         /* 1 if the picture shows the volumes' visible voxels at the resolutions that suit the
                     * picture's pixels; a picture that waits for the finest resolutions does so, too. If
                     * `coarse` is 1 and finer voxels cannot be read, the picture shows coarser voxels, and
                     * the answer says so */
  long long base;   /* 0 if `text` is a whole scene. Any other number is the number of a frame of the page;
                     * `text` is then a difference from that frame's scene */
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
  long long refined; /* the member `refined` of the state in whose voxels the plane is given; -1 if it is not
                      * stated */
  long long opened, volume; /* number of the open scene, and index of the volume in it */
  slice_source source;
  hl_reslice_options plane;
} slice_request;

/* A file that arrives from a page, in a temporary folder of its own. */
typedef struct server_upload {
  char folder[PATH_BYTES / 2], path[PATH_BYTES];
  FILE *file;
  uint64_t room;  /* number of bytes that may still arrive */
  bool is_broken; /* whether bytes could not be stored */
} server_upload;

/* frames.c */
bool pages_begin(server *s);
void pages_end(server *s);
/* Between work_begin() and work_end() this thread works for the client at the other end of the socket. Its
 * work is cancelled when the client has gone. The answer receives the library's warnings. */
void work_begin(server *s, int socket, server_answer *answer);
void work_end(void);
/* Notes that this thread works for an open scene from now on. The work is cancelled when the page that opened
 * the scene was closed. */
void work_begin_for(server *s, const server_opened *opened);
/* Notes which stage of its frame this thread begins. */
void work_enters(frame_stage stage);
/* This function must be called when a page was closed. It ends the frames of the page and of its lanes
 * (NAME-...), and their renderers. */
void page_is_gone(server *s, const char *name);
void pages_expire(server *s); /* ends the renderers of pages that have not sent a request for a long time;
                               * must be called from time to time */
/* The numbers of a server's pages, and of the frames and renderers of these pages. */
typedef struct pages_state {
  int pages;     /* number of pages that may hold a renderer */
  int rendering; /* number of frames that are being rendered or that wait */
  int renderers; /* number of renderers of pages that are rendering nothing now */
} pages_state;

pages_state pages_count(server *s);
/* How far a page's frame is. */
typedef struct frame_progress {
  unsigned long long frame; /* the frame's number; 0 if no frame of the page is being rendered */
  frame_stage stage;
  int part;   /* the finished part of the stage, in thousandths */
  int others; /* the number of other pages, and lanes of this page, whose frames are being rendered */
} frame_progress;

frame_progress page_progress(server *s, const char *name);
/* Answers with a frame. film: null for a picture. */
void answer_frame(server *s, const frame_request *request, const film_request *film, server_answer *answer);
/* Answers with the scene, its defaults written out and the page's choices applied. film: if not null, the
 * scene is the scene of the requested frame of this film. */
void answer_scene(server *s, const frame_request *request, const composed_choices *choices,
                  const film_request *film, int frame, server_answer *answer);
/* Marks the page's frames with lower numbers than this one as outdated. */
void cancel_frames(server *s, const char *page, unsigned long long number);
/* The progress of the page's film. Returns false if it has none. */
bool film_progress(server *s, const char *page, int *done, int *frames);
/* Opens a file, and answers with its start.json. */
void answer_open(server *s, const server_file *file, const char *title, server_answer *answer);

/* Joins the open scene with the number `with` to the request's scene, and closes it. Answers with the
 * start.json of the joined scene. */
void answer_join(server *s, const frame_request *request, long long with, const char *title,
                 server_answer *answer);

/* Sets the answer to an error line. */
extern const char closed_line[]; /* the error line for a scene that is not open any more; it is answered with
                                  * status 410 */
void refuse_line(server_answer *answer, unsigned status, const char *line);

/* These functions are in bases.c. They lock server.pages_lock, except base_forget(), whose caller must hold
 * the lock. */
void base_keep(server *s, server_page *page, const frame_request *request);
void base_forget(server_page *page);
/* Applies the request's difference to the page's base. Returns the text of the whole scene (free()). Returns
 * null if the request is refused; the status is 409 if the page has another base. */
char *base_changed(server *s, server_page *page, const frame_request *request, server_answer *answer);

/* places.c */
void answer_slice(server *s, const slice_request *request, server_answer *answer);
bool read_triple(const char *text, double numbers[3]);
/* Answers with the depth of the surface or matter that the picture's middle pixel shows. */
hl_status render_depth(server_page *page, const hl_scene *scene, server_answer *answer, hl_error *error);

/* matter.c */
/* Keeps the opacities of a picture at rest. */
void matter_keep(server *s, server_page *page, const frame_request *request, const hl_image *image);
void matter_forget(server_page *page); /* the caller must hold server.pages_lock */
/* Finds the opacities that the page, whose lane requests an overlay, has been shown of the overlay's scene.
 * Returns an image of opacities that the caller owns; null if this scene is not the scene of the page's
 * newest picture. */
hl_image *matter_find(server *s, const frame_request *request);

/* pictures.c */
/* Finds out, before the picture is made, whether the overlays that the request asks for can be drawn. */
hl_status check_overlay(const server *s, const hl_scene *scene, const frame_request *request,
                        hl_error *error);
/* Renders a small picture of a scene, which tells where the matter is. *image: owned by the caller, also
 * after a failure; may be null. */
hl_status render_small(const server *s, hl_renderer *renderer, const hl_scene *scene, hl_image **image,
                       hl_render_statistics *statistics, hl_error *error);
/* Answers with the overlays alone, as a transparent PNG of the picture's size. matter: a picture of the scene
 * of any size. */
hl_status write_overlay(const server *s, const hl_image *matter, const hl_scene *scene,
                        const frame_request *request, server_answer *answer, hl_error *error);
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
/* Returns a JSON text (free()) about the resolutions of an open scene that were read: {"refined": N,
 * "refining": BOOL, "problem": TEXT}. Returns null if memory is short. */
char *describe_refinement(const server_opened *opened);
void opened_leave(server *s, server_opened *opened);
/* Closes a scene that a page has opened, as soon as no request holds it. */
void opened_close(server *s, long long number);
/* Adds a scene, retains it, and holds it as opened_enter() does. Returns null if there is no memory or no
 * room. */
server_opened *opened_add(server *s, hl_scene *scene, const char *title);
int opened_count(server *s);
void opened_end(server *s);

/* seen.c */
/* Finds the voxels of a scene's volumes that a picture sees, at the resolutions that suit the picture's
 * pixels: among the kept voxels, or by reading files. opened: the number of the open scene. *seen: owned by
 * the caller; null if the scene's own volumes are fine enough, or are still read from coarse to fine. */
hl_status seen_read(server *s, long long opened, hl_scene *scene, hl_scene **seen, hl_error *error);
/* Replaces a scene by one that has the volumes of `seen`, which seen_read() has found for a scene of the same
 * view. */
hl_status seen_take(server *s, const hl_scene *seen, hl_scene **scene, hl_error *error);
/* Writes, as JSON, {"problem": TEXT, "volumes": [{"level": N, "absent_chunks": [N, N]}, ...]}. seen: null if
 * nothing was read. text: [size]; without the volumes if there is no room for them. */
void seen_describe(const hl_scene *seen, const char *problem, char *text, size_t size);
/* Releases the voxels that are kept of an open scene. opened: its number; if below 0, the voxels of all
 * scenes are released. */
void seen_forget(server *s, long long opened);

/* folder.c */
bool folder_can_open(const char *name); /* tells by a name's ending whether the file can be opened */
/* Finds a file below the server's folder. It may be a folder that holds a volume as slices, DICOM or Zarr.
 * The caller owns file->confined. path: set to the absolute path; file->name and file->folder point into it.
 * Returns false if the file does not lie there, after links were followed, or cannot be opened. */
bool folder_find(const server *s, const char *inside, char path[PATH_BYTES], server_file *file);
/* Opens a file or folder below the server's folder, with the flags of open(). Returns the file's
 * descriptor, or -1 if the file does not lie below the folder after links were followed. Nobody can lead
 * the name out of the folder by a link that is put into it meanwhile. */
int folder_open(const server *s, const char *inside, int flags);

/* ---- sessions.c ---- */

/* The text of a session of this name below the server's folder, owned by the caller (free()); null if there
 * is none. */
char *session_read(const server *s, const char *inside);
/* Lists, as JSON (free()), everything that can be opened in a folder below the server's folder; null if there
 * is no such folder. */
char *describe_folder(const server *s, const char *at);
bool upload_folder(const char *name, server_upload *upload); /* makes the folder alone, and not the file */
/* Returns whether a file of this name may be sent. */
bool upload_is_named(const char *name);
bool upload_begin(const char *name, server_upload *upload);
/* Stores bytes. Returns false if more bytes arrive than the request's head has stated. */
bool upload_add(server_upload *upload, const char *bytes, size_t count);
/* Completes the file. Returns false if some of its bytes could not be stored. */
bool upload_finish(server_upload *upload);
void upload_end(server_upload *upload); /* removes the file and its folder */

/* jpeg.c: makes a JPEG of a picture (free()). rgba: [height][width][4]. Null if there is no memory. */
unsigned char *encode_jpeg(const uint8_t *rgba, int width, int height, int quality, size_t *length);

/* guard.c */
/* Returns whether a Host header names this machine's own address: 127.0.0.1, localhost or [::1]. Any port is
 * accepted, because a tunnel may end at another port. The check refuses pages with other host names that
 * resolve to this machine. */
bool host_is_local(const char *host);
/* Returns whether an Origin header names the server's own page, or is absent (null). site: the header
 * Sec-Fetch-Site, which browsers alone can set; null if it is absent. Firefox tells no origin when the page
 * leaves, since the page hides its address from other servers; then `site` tells. */
bool origin_is_own(const char *origin, const char *site, const char *host);
/* The rest of a path after "/TOKEN/"; null if the token is wrong. The check takes the same time for all wrong
 * tokens. */
const char *path_after_token(const char *path, const char *token);

/* requests.c: sets up libmicrohttpd's callbacks for a server that listens on a socket. */
struct MHD_Daemon *listen_to_requests(server *s, int listening_socket);

#endif
