/* fetch/fetch.c - fetches files of a store. The server is asked for each file, even if there is a copy. It is
 * asked again if a transfer failed for a reason that may be temporary.
 *
 * The server answers 304 if the copy is up to date. The answer is 404 or 410 if there is no file, 200 with a
 * whole file, and 206 with the wanted part of a file. The server may redirect to another URL of the same
 * server. Any other answer is an error, because an absent file has a meaning in a store. */
#define _GNU_SOURCE
#include "fetch.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "copies.h"
#include "curl.h"
#include "moves.h"
#include "text/hash.h"

enum { TRIES = 4, MOVES_MOST = 5 };

/* A file that is wanted. */
typedef struct wanted {
  const char *name;
  hl_fetch_range range;
  curl_transfer transfer;
  char key[COPIES_KEY_BYTES];   /* the key of its copy */
  char path[COPIES_PATH_BYTES]; /* the file that curl writes to; "" if there is none */
  hl_fetched_file copy;         /* the copy that an earlier run left; its descriptor is -1 if there is none */
  int moves;                    /* number of times that the server has redirected the request in this try */
  bool done, moved; /* moved: whether the server has redirected the request to another URL, at which it must
                     * be made again */
} wanted;

typedef struct fetching {
  const fetcher *f;
  const char *url;
  uint64_t most;
  wanted *files; /* owned; [count] */
  size_t count;
  hl_error *error;
} fetching;

/* ---- URLs ---- */

static bool is_unreserved(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
         (c != '\0' && strchr("-._~/", c) != NULL);
}

/* Returns whether a URL can be written into curl's list without escapes. */
static bool is_plain(const char *url) {
  for (const char *c = url; *c != '\0'; c++)
    if ((unsigned char)*c <= ' ' || (unsigned char)*c > '~' || *c == '"' || *c == '\\' || *c == '#')
      return false;
  return true;
}

/* Appends a name to the store's URL, before the URL's query. All but letters, digits, "-._~" and '/' is
 * escaped (RFC 3986, section 2.1). */
static bool join_url(const char *url, const char *name, char joined[FETCH_URL_BYTES]) {
  size_t base = strcspn(url, "?"), length;
  const char *query = url + base;
  while (base > 0 && url[base - 1] == '/') base--;
  length = (size_t)snprintf(joined, FETCH_URL_BYTES, "%.*s/", (int)base, url);
  for (const char *c = name; *c != '\0' && length + 4 < FETCH_URL_BYTES; c++)
    length += (size_t)snprintf(joined + length, FETCH_URL_BYTES - length, is_unreserved(*c) ? "%c" : "%%%02X",
                               (unsigned char)*c);
  if (length + strlen(query) + 4 >= FETCH_URL_BYTES) return false;
  strcpy(joined + length, query);
  return true;
}

/* Fails with a line that begins with the file's URL, without its query, which may be a secret. */
static hl_status fail(const fetching *t, const char *name, const char *what) {
  size_t base = strcspn(t->url, "?");
  while (base > 0 && t->url[base - 1] == '/') base--;
  snprintf(t->error->message, sizeof t->error->message, "%.*s%s%.200s: %.400s", base < 300 ? (int)base : 300,
           t->url, name[0] != '\0' ? "/" : "", name, what);
  return HL_ERROR_IO;
}

/* ---- transfers ---- */

static hl_status begin(fetching *t, wanted *file) {
  if (!is_plain(t->url) || !join_url(t->url, file->name, file->transfer.url))
    return fail(t, file->name, "no URL: give one of printable ASCII characters, others as %XX");
  if (!range_write(&file->range, file->transfer.range))
    return fail(t, file->name, "bytes beyond the greatest number of 64 bits are wanted");
  /* no URL that is sent has '#' */
  snprintf(file->key, sizeof file->key, "%s%s%s", file->transfer.url, file->range.count > 0 ? "#" : "",
           file->transfer.range);
  copies_find(t->f->folder, file->key, &file->copy, file->transfer.condition);
  hl_status status = copies_begin(t->f->folder, file->path, t->error);
  if (status != HL_OK) file->path[0] = '\0';
  file->transfer.output = file->path;
  return status;
}

/* Returns whether a transfer failed for a reason that may be temporary. */
static bool may_pass(const curl_transfer *transfer) {
  if (transfer->problem == CURL_TOO_LONG) return false;
  return transfer->problem != 0 || transfer->answer == 408 || transfer->answer == 429 ||
         transfer->answer >= 500;
}

static hl_status fail_transfer(const fetching *t, const wanted *file, bool tried_again) {
  const curl_transfer *transfer = &file->transfer;
  char what[400];
  if (transfer->problem == CURL_TOO_LONG)
    snprintf(what, sizeof what, "the server has a file of more than %llu bytes, the most that it can have",
             (unsigned long long)t->most);
  else if (transfer->problem != 0)
    snprintf(what, sizeof what, "it does not arrive, after %d tries: %.200s", TRIES, transfer->said);
  else
    snprintf(what, sizeof what, "the server answers %d%s%s", transfer->answer,
             tried_again ? ", also when asked again" : "",
             transfer->answer == 401 || transfer->answer == 403
                 ? ": it wants a permission, or has no such file and does not say so"
                 : "");
  return fail(t, file->name, what);
}

/* A number that stands for the state of a server's file, made from the condition that names this state; 0 if
 * there is no condition. */
static uint64_t state_of(const char *condition) {
  if (condition[0] == '\0') return 0;
  const uint64_t hash = hl_hash_bytes(HL_HASH_BEGIN, condition, strlen(condition));
  return hash != 0 ? hash : 1;
}

/* Makes a copy of the bytes that were received, if they are the wanted bytes. */
static hl_status keep(fetching *t, wanted *file, hl_fetched_file *result) {
  const curl_transfer *transfer = &file->transfer;
  hl_fetched_file told = {.descriptor = -1};
  struct stat about;
  if (stat(file->path, &about) != 0) return fail(t, file->name, "its copy is gone");
  told.size = told.whole = (uint64_t)about.st_size;
  if (transfer->answer == 206 && (!range_is_answered(&file->range, transfer->content_range, &told) ||
                                  told.size != (uint64_t)about.st_size))
    return fail(t, file->name, "the server sends other bytes than the part that it was asked for");
  hl_status status = copies_keep(t->f->folder, file->key, transfer->next_condition, file->path, &told,
                                 t->error);
  if (status != HL_OK) return status;
  *result = told;
  result->state = state_of(transfer->next_condition);
  file->path[0] = '\0';
  file->done = true;
  return HL_OK;
}

static bool is_move(int answer) {
  return answer == 301 || answer == 302 || answer == 303 || answer == 307 || answer == 308;
}

/* Prepares the request to be made again at the URL to which the server redirects it. */
static hl_status follow(const fetching *t, wanted *file) {
  curl_transfer *transfer = &file->transfer;
  char what[300];
  if (!move_is_allowed(transfer->url, transfer->moved) || !is_plain(transfer->moved)) {
    snprintf(what, sizeof what, "the server redirects to %.*s: if you trust that server, give its URL",
             (int)(strcspn(transfer->moved, "?#") < 200 ? strcspn(transfer->moved, "?#") : 200),
             transfer->moved);
    return fail(t, file->name, what);
  }
  if (file->moves++ == MOVES_MOST) {
    snprintf(what, sizeof what, "the server redirects more than %d times", MOVES_MOST);
    return fail(t, file->name, what);
  }
  strcpy(transfer->url, transfer->moved);
  file->moved = true;
  return HL_OK;
}

/* Evaluates the result of a transfer. The file has been received, or is absent, or must be requested
 * again. */
static hl_status take(fetching *t, wanted *file, hl_fetched_file *result) {
  curl_transfer *transfer = &file->transfer;
  bool whole = transfer->problem == 0;
  if (whole && transfer->answer == 304 && file->copy.descriptor >= 0) {
    *result = file->copy;
    result->state = state_of(transfer->condition);
    file->copy.descriptor = -1;
    copies_touch(t->f->folder, file->key);
    file->done = true;
  } else if (whole && (transfer->answer == 200 || (transfer->answer == 206 && file->range.count > 0))) {
    return keep(t, file, result);
  } else if (whole && (transfer->answer == 404 || transfer->answer == 410)) {
    file->done = true;
  } else if (whole && is_move(transfer->answer) && transfer->moved[0] != '\0') {
    return follow(t, file);
  } else if (!may_pass(transfer)) {
    return fail_transfer(t, file, false);
  }
  return HL_OK;
}

/* Returns whether a file is requested in the next run of curl. At the beginning of a try, these are all files
 * that are not done. Later they are the files whose requests were redirected in the run before. */
static bool takes_part(const wanted *file, bool begins) { return begins ? !file->done : file->moved; }

/* Runs curl on files that are not done. begins: whether curl runs on all of these files, at the store's URLs;
 * if not, it runs only on the files whose requests were redirected. */
static hl_status run(fetching *t, bool begins, hl_fetched_file *results) {
  curl_transfer *transfers = calloc(t->count, sizeof *transfers);
  size_t count = 0;
  hl_status problem = HL_OK;
  if (transfers == NULL) return fail(t, "", "out of memory");
  for (size_t n = 0; n < t->count; n++) {
    if (!takes_part(&t->files[n], begins)) continue;
    if (begins) join_url(t->url, t->files[n].name, t->files[n].transfer.url), t->files[n].moves = 0;
    transfers[count++] = t->files[n].transfer;
    if (truncate(t->files[n].path, 0) != 0)
      problem = fail(t, t->files[n].name, "its copy cannot be made anew");
  }
  hl_status status = problem != HL_OK ? problem : curl_run(t->f, transfers, count, t->most, t->error);
  count = 0;
  for (size_t n = 0; n < t->count && status == HL_OK; n++) {
    if (!takes_part(&t->files[n], begins)) continue;
    t->files[n].transfer = transfers[count++];
    t->files[n].moved = false;
    status = take(t, &t->files[n], &results[n]);
  }
  free(transfers);
  return status;
}

static const wanted *first_pending(const fetching *t) {
  for (size_t n = 0; n < t->count; n++)
    if (!t->files[n].done) return &t->files[n];
  return NULL;
}

static bool any_moved(const fetching *t) {
  for (size_t n = 0; n < t->count; n++)
    if (t->files[n].moved) return true;
  return false;
}

/* Waits before the next try. Each wait is longer than the wait before it. */
static hl_status pause_before(const fetching *t, int tries) {
  const struct timespec step = {.tv_nsec = 10000000};
  for (int n = 0; n < 25 << (tries - 1); n++) {
    if (t->f->cancelled != NULL && t->f->cancelled(t->f->user_data)) {
      fail(t, "", "cancelled");
      return HL_ERROR_CANCELLED;
    }
    nanosleep(&step, NULL);
  }
  return HL_OK;
}

static hl_status run_tries(fetching *t, hl_fetched_file *results) {
  hl_status status = HL_OK;
  for (int tries = 0; tries < TRIES && status == HL_OK && first_pending(t) != NULL; tries++) {
    if (tries > 0) status = pause_before(t, tries);
    if (status == HL_OK) status = run(t, true, results);
    while (status == HL_OK && any_moved(t)) status = run(t, false, results);
  }
  const wanted *left = first_pending(t);
  return status == HL_OK && left != NULL ? fail_transfer(t, left, true) : status;
}

hl_status fetch_files(const fetcher *f, const char *url, const char *const *names,
                      const hl_fetch_range *ranges, size_t count, uint64_t most, hl_fetched_file *files,
                      hl_error *error) {
  fetching t = {.f = f, .url = url, .most = most, .count = count, .error = error};
  for (size_t n = 0; n < count; n++) files[n] = (hl_fetched_file){.descriptor = -1};
  hl_status status = copies_open(f->folder, f->limit, error);
  if (status != HL_OK) return status;
  t.files = calloc(count, sizeof *t.files);
  if (t.files == NULL) return fail(&t, "", "out of memory");
  for (size_t n = 0; n < count; n++) {
    t.files[n].name = names[n], t.files[n].copy.descriptor = -1;
    if (ranges != NULL) t.files[n].range = ranges[n];
  }
  for (size_t n = 0; n < count && status == HL_OK; n++) status = begin(&t, &t.files[n]);
  if (status == HL_OK) status = run_tries(&t, files);
  for (size_t n = 0; n < count; n++) {
    if (t.files[n].copy.descriptor >= 0) close(t.files[n].copy.descriptor);
    if (t.files[n].path[0] != '\0') unlink(t.files[n].path);
  }
  free(t.files);
  return status;
}
