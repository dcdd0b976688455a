/* server/serve.c - runs the server: opens its socket, makes its token, serves requests, and ends. */
#define _GNU_SOURCE
#include "server.h"

#include <errno.h>
#include <netinet/in.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/random.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>
#ifdef __GLIBC__
#include <malloc.h>
#endif

#include <microhttpd.h>

#include "parts.h"

/* Opens a socket that listens on 127.0.0.1. Returns -1, with an error line in `problem`, on failure. */
static int listen_on(int port, char *problem, size_t size) {
  enum { WAITING_CONNECTIONS = 64 };
  const int yes = 1;
  struct sockaddr_in address = {
      .sin_family = AF_INET, .sin_port = htons((uint16_t)port), .sin_addr.s_addr = htonl(INADDR_LOOPBACK)};
  int listening = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  bool good = listening >= 0 && setsockopt(listening, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes) == 0 &&
              bind(listening, (struct sockaddr *)&address, sizeof address) == 0 &&
              listen(listening, WAITING_CONNECTIONS) == 0;
  if (good) return listening;
  if (errno == EADDRINUSE)
    snprintf(problem, size, "port %d is taken by another program: give another --port, or none", port);
  else snprintf(problem, size, "cannot listen on 127.0.0.1, port %d: %s", port, strerror(errno));
  if (listening >= 0) close(listening);
  return -1;
}

static int port_of(int listening) {
  struct sockaddr_in address = {0};
  socklen_t size = sizeof address;
  return getsockname(listening, (struct sockaddr *)&address, &size) == 0 ? ntohs(address.sin_port) : 0;
}

static bool make_token(char token[TOKEN_DIGITS + 1]) {
  unsigned char bytes[TOKEN_DIGITS / 2];
  if (getrandom(bytes, sizeof bytes, 0) != (ssize_t)sizeof bytes) return false;
  for (size_t b = 0; b < sizeof bytes; b++) snprintf(token + 2 * b, 3, "%02x", bytes[b]);
  return true;
}

/* The GNU C library keeps freed memory for the thread that used it. With many threads this is a large amount.
 * By default it keeps up to 64 MiB at the end of each thread's memory, and malloc_trim() does not give these
 * back. With the settings here, each block of KEPT_BYTES or more is taken directly from the system, and of
 * smaller blocks no more than KEPT_BYTES are kept. */
static void keep_little_memory(void) {
#ifdef __GLIBC__
  enum { KEPT_BYTES = 1 << 22 };
  mallopt(M_MMAP_THRESHOLD, KEPT_BYTES);
  mallopt(M_TRIM_THRESHOLD, KEPT_BYTES);
#endif
}

/* Gives freed memory back to the system. */
static void give_back_memory(server *s) {
  if (!atomic_exchange(&s->released, false)) return;
#ifdef __GLIBC__
  malloc_trim(0);
#endif
}

static void wait_for_stop(server *s) {
  const struct timespec moment = {.tv_nsec = 100000000};
  while (!s->options.stopped()) {
    nanosleep(&moment, NULL);
    connections_expire(&s->connections);
    pages_expire(s);
    give_back_memory(s);
  }
}

/* Owns listening. */
static bool serve(server *s, int listening, char *problem, size_t size) {
  struct MHD_Daemon *daemon = listen_to_requests(s, listening);
  if (daemon == NULL) {
    close(listening);
    snprintf(problem, size, "the server cannot start its threads");
    return false;
  }
  char url[100];
  snprintf(url, sizeof url, "http://127.0.0.1:%d/%s/", port_of(listening), s->token);
  s->options.ready(s->options.user_data, url);
  atomic_store(&s->announced, true);
  wait_for_stop(s);
  MHD_stop_daemon(daemon); /* frames that are being rendered count as outdated now, and stop */
  return true;
}

bool server_run(const server_options *options, char *problem, size_t problem_size) {
  server *s = calloc(1, sizeof *s);
  int listening = -1;
  keep_little_memory();
  bool good = s != NULL && pages_begin(s) && connections_begin(&s->connections);
  if (good) {
    s->options = *options;
    good = hl_context_confine(options->context, NULL, &s->sealed, NULL) == HL_OK;
  }
  if (good && options->folder != NULL)
    (void)!hl_context_confine(options->context, options->folder, &s->below, NULL);
  if (good) {
    server_opened *first = opened_add(s, options->scene, options->title);
    good = first != NULL;
    if (good) opened_leave(s, first);
    /* Numbers of scenes begin with the time. So a page of an earlier viewer cannot ask for a scene of this
     * viewer by its number. */
    s->next_opened = (long long)time(NULL);
  }
  if (!good) snprintf(problem, problem_size, "out of memory for the viewer");
  if (good) listening = listen_on(options->port, problem, problem_size);
  good = listening >= 0;
  bool kept = good && options->token != NULL && options->port > 0 && options->token(options->port, s->token);
  if (good && !kept && !make_token(s->token)) {
    snprintf(problem, problem_size, "the system gives no random numbers");
    close(listening);
    good = false;
  }
  good = good && serve(s, listening, problem, problem_size);
  if (s != NULL) {
    pages_end(s);
    opened_end(s);
    connections_end(&s->connections);
    hl_context_destroy(s->sealed);
    hl_context_destroy(s->below);
  }
  free(s);
  return good;
}
