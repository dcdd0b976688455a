/* server/parts.h - what the files of the server share. */
#ifndef HL_SERVER_PARTS_H
#define HL_SERVER_PARTS_H

#include <pthread.h>
#include <stdatomic.h>
#include <stddef.h>
#include <stdint.h>

#include "server.h"

enum {
  TOKEN_DIGITS = 32,
  PAGE_NAME_LENGTH = 32,
  MOST_PAGES =
      8, /* pages that keep a renderer; a new page takes the place of the one that was idle for longest */
  MOST_CONNECTIONS = 64,     /* at once */
  IDLE_SECONDS = 20,         /* after which a silent connection is closed */
  MOST_BODY_BYTES = 4 << 20, /* of a scene's text */
  MOST_PIXELS = 64 << 20,    /* of a picture */
  LEAST_QUALITY = 10,
  MOST_QUALITY = 100 /* of a JPEG */
};

/* A file of the page, embedded when the program is built (embed.py). */
typedef struct server_asset {
  const char *name; /* "main.js"; the page itself is "" */
  const char *type; /* of its content */
  const unsigned char *bytes;
  size_t length;
} server_asset;

extern const server_asset server_assets[];
extern const size_t server_asset_count;

/* One page in a browser: its frames are rendered one after the other. */
typedef struct server_page {
  char name[PAGE_NAME_LENGTH + 1]; /* "": free */
  pthread_mutex_t rendering;       /* held while a frame of the page is rendered */
  hl_renderer *renderer;           /* owned; under `rendering` */
  atomic_ullong newest;            /* the highest number of a requested frame */
  int users;                       /* requests that hold the page; under server.pages_lock */
  unsigned long long last_use;     /* under server.pages_lock */
} server_page;

typedef struct server {
  server_options options;
  char token[TOKEN_DIGITS + 1];
  char *start; /* owned; the text of start.json */
  pthread_mutex_t pages_lock;
  server_page pages[MOST_PAGES];
  unsigned long long uses;
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
      seconds_encode; /* seconds of a frame's steps; all 0: the answer is no frame */
} server_answer;

/* The parameters of a request for a frame. */
typedef struct frame_request {
  const char *page;
  unsigned long long number;
  const char *format; /* "jpeg", "png" or "exr" */
  int quality;        /* of a JPEG */
  int depth;          /* of a PNG: 8 or 16 */
  const char *text;   /* the scene */
  size_t length;
} frame_request;

/* frames.c */
bool pages_begin(server *s);
void pages_end(server *s);
void answer_frame(server *s, const frame_request *request, server_answer *answer);
void answer_scene(server *s, const char *text, size_t length, server_answer *answer);

/* start.c: the text of start.json (free()); null without memory. */
char *describe_start(const server_options *options);

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
