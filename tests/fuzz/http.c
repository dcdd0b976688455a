/* tests/fuzz/http.c - fuzz target: the viewer's server, which gets the input as the bytes of a connection.
 *
 * The first "TOKEN" of the input is replaced by the page's token. The client closes its side when it has sent
 * all, so that whatever is rendered for it ends soon; of frames it waits for the answer. */
#define _GNU_SOURCE
#include <arpa/inet.h>
#include <errno.h>
#include <poll.h>
#include <pthread.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

#include "server/server.h"
#include "target.h"

const uint64_t fuzz_memory_limit = 48 << 20;
enum { MOST_BYTES = 1 << 16, MOST_ANSWER = 1 << 22, TOKEN_BYTES = 32 };

/* The longest wait for an answer, in milliseconds: ten times as long as the server lets a connection be
 * silent, since other work may hold the server up. */
enum { DEADLINE = 200000 };

static int port;
static char token[TOKEN_BYTES + 1];
static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
static pthread_cond_t changed = PTHREAD_COND_INITIALIZER;

static const char volume_text[] =
    "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 3 3 3\nencoding: ascii\n\n"
    "0 9 0 9 40 9 0 9 0 9 40 9 40 255 40 9 40 9 0 9 0 9 40 9 0 9 0\n";

/* The server's threads hold memory whenever the leak sanitizer looks, so that it is off. The test
 * viewer_crowd counts the memory that is held. */
__attribute__((visibility("default"))) int __lsan_is_turned_off(void);
int __lsan_is_turned_off(void) { return 1; }

static int is_outdated(void *user_data) {
  (void)user_data;
  return server_is_outdated();
}

static bool never(void) { return false; }
static void on_visit(void *user_data) { (void)user_data; }

static void on_ready(void *user_data, const char *url) {
  (void)user_data;
  pthread_mutex_lock(&lock);
  REQUIRE(sscanf(url, "http://127.0.0.1:%d/%32[0-9a-f]/", &port, token) == 2);
  pthread_cond_signal(&changed);
  pthread_mutex_unlock(&lock);
}

static hl_status on_open(void *user_data, const server_file *file, hl_scene **scene, hl_error *error) {
  (void)user_data;
  hl_volume *volume = NULL;
  if (strstr(file->name, ".json") != NULL) return hl_scene_load(file->confined, file->name, scene, error);
  hl_status status = hl_volume_load(file->confined, file->name, &volume, error);
  if (status == HL_OK) status = hl_scene_for_volume(file->confined, volume, file->name, scene, error);
  hl_volume_release(volume);
  return status;
}

static void *serve(void *data) {
  char problem[300];
  hl_context_options options;
  hl_context *context = NULL;
  hl_volume *volume = NULL;
  hl_scene *scene = NULL;
  (void)data;
  hl_context_options_defaults(&options);
  options.memory_limit = fuzz_memory_limit;
  options.cancelled = is_outdated;
  REQUIRE(hl_context_create(&options, &context, NULL) == HL_OK);
  REQUIRE(hl_volume_load(context,
                         fuzz_write_file(0, "v.nrrd", (const uint8_t *)volume_text, sizeof volume_text - 1),
                         &volume, NULL) == HL_OK);
  REQUIRE(hl_scene_for_volume(context, volume, "v.nrrd", &scene, NULL) == HL_OK);
  server_options server = {.context = context,
                           .scene = scene,
                           .title = "v.nrrd",
                           .folder = fuzz_folder(),
                           .open = on_open,
                           .files_data = context,
                           .most_upload_bytes = 1 << 20,
                           .stopped = never,
                           .ready = on_ready,
                           .visited = on_visit};
  server_run(&server, problem, sizeof problem);
  fprintf(stderr, "%s\n", problem);
  abort();
}

static void begin(void) {
  pthread_t thread;
  if (port != 0) return;
  signal(SIGPIPE, SIG_IGN);
  setenv("TMPDIR", fuzz_folder(), 1);
  setenv("PATH", "", 1); /* no ffmpeg */
  REQUIRE(pthread_create(&thread, NULL, serve, NULL) == 0);
  pthread_mutex_lock(&lock);
  while (port == 0) pthread_cond_wait(&changed, &lock);
  pthread_mutex_unlock(&lock);
}

static int dial(void) {
  struct sockaddr_in address = {
      .sin_family = AF_INET, .sin_port = htons((uint16_t)port), .sin_addr.s_addr = htonl(INADDR_LOOPBACK)};
  int client = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  if (client >= 0 && connect(client, (struct sockaddr *)&address, sizeof address) == 0) return client;
  fprintf(stderr, "the server is not reached: %s\n", strerror(errno));
  abort();
}

static void send_all(int client, const char *bytes, size_t size) {
  for (size_t sent = 0; sent < size;) {
    ssize_t count = send(client, bytes + sent, size - sent, MSG_NOSIGNAL);
    if (count <= 0) return; /* the server has closed the connection */
    sent += (size_t)count;
  }
}

/* Returns whether a whole answer with a known length has arrived. */
static bool is_whole(const char *answer, size_t length) {
  const char *body = memmem(answer, length, "\r\n\r\n", 4),
             *field = strcasestr(answer, "\r\nContent-Length: ");
  if (body == NULL) return false;
  size_t wanted = field != NULL && field < body ? strtoul(field + 18, NULL, 10) : 0;
  return length - (size_t)(body + 4 - answer) >= wanted;
}

/* Reads the server's answer until the server closes the connection or, if the client waits, until the answer
 * is whole. */
static size_t receive(int client, bool waits, char *answer) {
  size_t length = 0;
  struct pollfd ready = {.fd = client, .events = POLLIN};
  while (length < MOST_ANSWER && poll(&ready, 1, waits ? 500 : DEADLINE) > 0) {
    ssize_t count = recv(client, answer + length, MOST_ANSWER - length, 0);
    if (count <= 0) return length;
    length += (size_t)count;
    answer[length] = 0;
    if (waits && is_whole(answer, length)) return length;
  }
  REQUIRE(waits || length == MOST_ANSWER); /* a failure: the connection has outlived its deadline */
  return length;
}

static void check(const char *answer, size_t length) {
  int status = 0;
  if (length == 0) return;
  REQUIRE(sscanf(answer, "HTTP/1.%*c %d", &status) == 1);
  REQUIRE(status >= 100 && status < 600 && status != 501);
  REQUIRE(memmem(answer, length, token, TOKEN_BYTES) == NULL);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  static char text[MOST_BYTES + TOKEN_BYTES + 1], answer[MOST_ANSWER + 1];
  if (size > MOST_BYTES) return 0;
  begin();
  if (memmem(data, size, token, TOKEN_BYTES) != NULL)
    return 0; /* the fuzzer has read the token in memory; such inputs are left out */
  const uint8_t *place = memmem(data, size, "TOKEN", 5);
  size_t before = place != NULL ? (size_t)(place - data) : size,
         after = place != NULL ? size - before - 5 : 0;
  memcpy(text, data, before);
  memcpy(text + before, token, TOKEN_BYTES);
  if (after > 0) memcpy(text + before + TOKEN_BYTES, place + 5, after);
  size_t length = place != NULL ? before + TOKEN_BYTES + after : size;
  bool waits = memmem(data, size, "/frame?", 7) != NULL;
  int client = dial();
  send_all(client, text, length);
  if (!waits) shutdown(client, SHUT_WR);
  check(answer, receive(client, waits, answer));
  close(client);
  return 0;
}
