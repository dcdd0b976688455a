/* server/parts.h - what the files of the server share. */
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
  MOST_PAGES =
      8, /* pages that keep a renderer; a new page takes the place of the one that was idle for longest */
  QUICK_RENDERERS = 3, /* of a page: as many as a preview has copies of a volume */
  MOST_OPENED = 6,     /* scenes; the one that was not used for longest makes room */
  PATH_BYTES = 4096,   /* of a path: Linux's PATH_MAX, which realpath() fills */
  MOST_FILM_KEYS = 32,
  MOST_FILM_FRAMES = 100000,
  IDLE_PAGE_SECONDS = 300,   /* after which a page that asks for nothing loses its renderer */
  MOST_BODY_BYTES = 4 << 20, /* of a scene's text */
  MOST_PIXELS = 64 << 20,    /* of a picture */
  LEAST_QUALITY = 10,
  MOST_QUALITY = 100 /* of a JPEG */
};

#define MOST_NUMBER 1000000000000LL /* of a page's frames */

/* A file of the page, embedded when the program is built (embed.py). */
typedef struct server_asset {
  const char *name; /* "main.js"; the page itself is "" */
  const char *type; /* of its content */
  const unsigned char *bytes;
  size_t length;
} server_asset;

extern const server_asset server_assets[];
extern const size_t server_asset_count;

/* A renderer for frames while something moves, of the volumes at one coarser resolution. A renderer prepares
 * a volume anew when the volume changes, so that each resolution has its own. */
typedef struct quick_renderer {
  hl_renderer *renderer;   /* owned; null: not yet made */
  const hl_volume *volume; /* borrowed; only compared: the first volume of the scenes that it renders */
} quick_renderer;

/* One page in a browser: its frames are rendered one after the other. */
typedef struct server_page {
  char name[PAGE_NAME_LENGTH + 1];       /* "": free */
  pthread_mutex_t rendering;             /* held while a frame of the page is rendered */
  hl_renderer *renderer;                 /* owned; under `rendering`; null: not yet made */
  quick_renderer quick[QUICK_RENDERERS]; /* under `rendering` */
  atomic_ullong newest;                  /* the highest number of a requested frame */
  atomic_int frame_part;                 /* thousandths of the frame that is being rendered */
  atomic_int film_done, film_frames;     /* of the film that the page renders; 0 frames: none */
  int users;                             /* requests that hold the page; under server.pages_lock */
  bool leaving;                          /* it is free when the last of them ends; under server.pages_lock */
  unsigned long long last_use;           /* under server.pages_lock */
  double last_seen;                      /* by server_seconds(); under server.pages_lock */
  char *base; /* owned; the newest scene that came whole, or null; under server.pages_lock */
  unsigned long long base_number; /* of its frame; under server.pages_lock */
} server_page;

/* A scene that is open. */
typedef struct server_opened {
  long long number;              /* by which pages name it; 0: the program's input */
  hl_scene *scene;               /* owned; null: free */
  char *start;                   /* owned; the text of its start.json */
  _Atomic(hl_preview *) preview; /* owned; null until it is made, and where it cannot be */
  atomic_bool prepared;          /* the preview is made, or cannot be */
  int users;                     /* number of requests that use it; under server.pages_lock */
  atomic_bool leaving;           /* its page has gone; set under server.pages_lock */
  unsigned long long last_use;   /* under server.pages_lock */
} server_opened;

typedef struct server {
  server_options options;
  hl_context *sealed; /* owned; opens no file: for the scenes of pages */
  hl_context *below;  /* owned; opens what lies below the server's folder; null: there is none */
  char token[TOKEN_DIGITS + 1];
  server_opened opened[MOST_OPENED];
  long long next_opened;   /* under pages_lock */
  atomic_bool announced;   /* options.ready has returned */
  atomic_bool visited;     /* options.visited was called */
  atomic_bool released;    /* renderers or scenes since the system was given their memory back */
  atomic_int opening_part; /* thousandths of the volume that is being read */
  atomic_int preparing;    /* threads that make previews */
  pthread_mutex_t pages_lock;
  server_page pages[MOST_PAGES];
  unsigned long long uses;
  connection_table connections;
} server;

/* An answer: bytes or a text, with its HTTP status. */
typedef struct server_answer {
  unsigned status;
  const char *type;
  const void *borrowed; /* valid as long as the server; or null */
  size_t length;
  unsigned char *bytes;       /* owned: hl_bytes_release(); or null */
  char *text;                 /* owned: hl_text_release(); or null */
  unsigned char *from_malloc; /* owned: free(); or null */
  char problem[1000];         /* an error line, where neither bytes nor text are given */
  double seconds_read, seconds_render,
      seconds_encode;  /* seconds of a frame's steps; all 0: the answer is no frame */
  double seconds_once; /* those of them that the next frames do not take: what a new renderer has prepared,
                        * and the wait for coarser volumes */
} server_answer;

/* The parameters of a request for a frame. */
typedef struct frame_request {
  const char *page;
  unsigned long long number;
  long long opened;   /* the open scene whose volumes it has */
  const char *format; /* "jpeg", "png", "exr" or "npy"; "depth": no picture, but how deep its middle lies */
  int quality;        /* of a JPEG */
  int depth;          /* of a PNG: 8 or 16 */
  int metadata;       /* 1: a PNG carries its scene; 0: it does not */
  int scale_bar, legend; /* 1: drawn over a PNG of 8 bits */
  const char *unit;      /* of lengths, where the scene's files tell none; null: it is not known */
  int moving; /* 1: a quick frame, of coarser volumes where the sheets are wide; 0: the scene as it is */
  long long
      base; /* the page's frame from whose scene the text tells the difference; 0: it is a whole scene */
  const char *text; /* the scene */
  size_t length;
} frame_request;

/* What a film's request asks for, besides a frame's. */
typedef struct film_request {
  const char *format; /* "mp4", "webm", "gif", or "zip" of numbered pictures */
  const char *keys[MOST_FILM_KEYS];
  size_t key_count;
  int turntable, frames;
  double frames_per_second;
} film_request;

/* A plane of voxels that a page asks for. */
typedef struct slice_request {
  long long opened, volume; /* the open scene, and which of its volumes */
  bool of_mask;             /* the label map that masks the volume in place of it */
  hl_reslice_options plane;
} slice_request;

/* A file that arrives from a page, in a temporary folder of its own. */
typedef struct server_upload {
  char folder[PATH_BYTES / 2], path[PATH_BYTES];
  FILE *file;
  uint64_t room; /* bytes that may still arrive */
} server_upload;

/* frames.c */
bool pages_begin(server *s);
void pages_end(server *s);
/* Between them the thread works for whoever is at the other end of the socket, as long as he is there. */
void work_begin(server *s, int socket);
void work_end(void);
/* The thread works for what is open, as long as its page is there. */
void work_begin_for(server *s, const server_opened *opened);
/* A page was closed: its frames, those of its lanes (NAME-...), and their renderers end. */
void page_is_gone(server *s, const char *name);
void pages_expire(server *s); /* renderers of pages that asked for nothing for long; call it now and then */
/* What the pages of a server are and do. */
typedef struct pages_state {
  int pages;     /* those that may hold a renderer */
  int rendering; /* frames that are rendered, or wait for it */
  int renderers; /* of pages that render nothing now */
} pages_state;

pages_state pages_count(server *s);
/* How far the page's frame is, in thousandths of its step; *others: pages, and lanes of this one, with frames
 * of theirs. */
int page_progress(server *s, const char *name, int *others);
/* film: null for a picture. */
void answer_frame(server *s, const frame_request *request, const film_request *film, server_answer *answer);
/* The scene with its defaults and the page's choices; with a film, as it is at that frame of the film. film:
 * null for none. */
void answer_scene(server *s, const frame_request *request, const composed_choices *choices,
                  const film_request *film, int frame, server_answer *answer);
/* Makes the page's frames below this number outdated. */
void cancel_frames(server *s, const char *page, unsigned long long number);
/* How far the page's film is; false: it has none. */
bool film_progress(server *s, const char *page, int *done, int *frames);
/* Opens a file, and answers with its start.json. */
void answer_open(server *s, const server_file *file, const char *title, server_answer *answer);

/* Adds what is open under the number `with`, and is closed then, to the request's scene; answers with the
 * start.json of both. */
void answer_join(server *s, const frame_request *request, long long with, const char *title,
                 server_answer *answer);

/* An answer that is an error line. */
extern const char closed_line[]; /* of what is open no longer: status 410 */
void refuse_line(server_answer *answer, unsigned status, const char *line);

/* bases.c: see there. They take server.pages_lock, but for base_forget(), whose caller holds it. */
void base_keep(server *s, server_page *page, const frame_request *request);
void base_forget(server_page *page);
/* The whole scene's text (free()); null: refused, status 409 where the page's base is another one. */
char *base_changed(server *s, server_page *page, const frame_request *request, server_answer *answer);

/* places.c */
void answer_slice(server *s, const slice_request *request, server_answer *answer);
bool read_triple(const char *text, double numbers[3]);
/* Answers how deep lies what the picture's middle pixel shows. */
hl_status render_depth(server_page *page, const hl_scene *scene, server_answer *answer, hl_error *error);

/* pictures.c */
/* Finds out whether what the request wants over its picture can be drawn, before the picture is made. */
hl_status check_overlay(const server *s, const hl_scene *scene, const frame_request *request,
                        hl_error *error);
/* Answers with the image as a file of the request's format. */
hl_status write_picture(const server *s, const hl_scene *scene, const hl_image *image,
                        const frame_request *request, server_answer *answer, hl_error *error);

/* films.c */
hl_status render_film(server *s, server_page *page, const hl_scene *scene, const film_request *request,
                      server_answer *answer, hl_error *error);

/* Replaces a scene by what it is at a frame of its film. */
hl_status turn_to_frame(server *s, hl_scene **scene, const film_request *film, int frame, hl_error *error);

/* opened.c: scenes that are open. An entered one is held until it is left; null: it is open no longer. */
server_opened *opened_enter(server *s, long long number);
void opened_leave(server *s, server_opened *opened);
/* Closes a scene that a page has opened, when no request holds it any longer. */
void opened_close(server *s, long long number);
/* Adds a scene, which is retained, and enters it; null without memory or room. */
server_opened *opened_add(server *s, hl_scene *scene, const char *title);
int opened_count(server *s);
void opened_end(server *s);

/* folder.c */
bool folder_can_open(const char *name); /* by its extension */
/* Finds a file below the server's folder, or a folder, which may hold a volume as slices, DICOM or Zarr.
 * file->confined is owned by the caller. path: its absolute path, to which file->name and file->folder
 * point. False: it does not lie there, by any link, or cannot be opened. */
bool folder_find(const server *s, const char *inside, char path[PATH_BYTES], server_file *file);
/* JSON of what can be opened in a folder below the server's (free()); null: it is none. */
char *describe_folder(const server *s, const char *at);
bool upload_folder(const char *name, server_upload *upload); /* the folder alone */
bool upload_begin(const char *name, server_upload *upload);
bool upload_add(server_upload *upload, const char *bytes, size_t count);
bool upload_finish(server_upload *upload);
void upload_end(server_upload *upload); /* removes the file and its folder */

/* jpeg.c: a picture as JPEG (free()); rgba: [height][width][4]. Null without memory. */
unsigned char *encode_jpeg(const uint8_t *rgba, int width, int height, int quality, size_t *length);

/* guard.c */
/* Whether a Host header names this machine's own address: 127.0.0.1, localhost or [::1]. Any port will do, as
 * a tunnel may end at another one. Refuses pages of other host names that resolve to this machine. */
bool host_is_local(const char *host);
/* Whether an Origin header is that of the server's own page, or absent (null). */
bool origin_is_own(const char *origin, const char *host);
/* The rest of a path after "/TOKEN/"; null if the token is wrong. Takes equally long for all wrong tokens. */
const char *path_after_token(const char *path, const char *token);

/* requests.c: libmicrohttpd's callbacks are set up for a server that listens on a socket. */
struct MHD_Daemon *listen_to_requests(server *s, int listening_socket);

#endif
