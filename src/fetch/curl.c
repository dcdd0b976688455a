/* fetch/curl.c - writes curl's list of transfers, runs curl, and reads what curl says of each transfer.
 *
 * Source: curl's manual, "CONFIG FILE", "--next", "--parallel" and "--write-out" (with "%header{...}" of curl
 * 7.84). Names and URLs reach curl as quoted texts of the list, never as words of a command line. */
#define _GNU_SOURCE
#include "curl.h"

#include <errno.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "process/process.h"

/* ---- the list of transfers ---- */

/* Writes an option and its text. Quotes and backslashes are escaped, as curl's lists require. */
static void write_option(FILE *list, const char *name, const char *text) {
  fprintf(list, "%s = \"", name);
  for (const char *c = text; *c != '\0'; c++) {
    if (*c == '"' || *c == '\\') fputc('\\', list);
    fputc(*c, list);
  }
  fputs("\"\n", list);
}

/* Writes curl's list: first the options of all transfers, then for each transfer the options of its own. */
static void write_list(FILE *list, const curl_transfer *transfers, size_t count, uint64_t most) {
  fputs("parallel\nparallel-max = 16\n", list);
  for (size_t n = 0; n < count; n++) {
    if (n > 0) fputs("next\n", list);
    /* A server that sends less than 1000 bytes a second for 10 seconds is given up. */
    fprintf(list,
            "no-progress-meter\nsilent\ngloboff\nproto = \"=http,https\"\n"
            "connect-timeout = 15\nspeed-limit = 1000\nspeed-time = 10\n"
            "max-filesize = %llu\n",
            (unsigned long long)most);
    write_option(list, "url", transfers[n].url);
    write_option(list, "output", transfers[n].output);
    if (transfers[n].condition[0] != '\0') write_option(list, "header", transfers[n].condition);
    if (transfers[n].range[0] != '\0') write_option(list, "range", transfers[n].range);
    fprintf(list,
            "write-out = \"%%{stderr}\\ntransfer %zu %%{exitcode} %%{http_code}\\n%%header{etag}\\n"
            "%%header{last-modified}\\n%%header{content-range}\\n%%{redirect_url}\\n%%{errormsg}\\n\"\n",
            n);
  }
}

static FILE *make_list(const curl_transfer *transfers, size_t count, uint64_t most) {
  FILE *list = tmpfile();
  if (list == NULL) return NULL;
  write_list(list, transfers, count, most);
  bool written = fflush(list) == 0 && ferror(list) == 0 && lseek(fileno(list), 0, SEEK_SET) == 0;
  if (written) return list;
  fclose(list);
  return NULL;
}

/* ---- curl's reports ---- */

/* Copies a line without its end. Returns false if it is too long or has unprintable bytes. */
static bool copy_line(const char *line, char *text, size_t size) {
  size_t length = strcspn(line, "\r\n");
  if (length >= size) return false;
  for (size_t n = 0; n < length; n++)
    if ((unsigned char)line[n] < ' ' || (unsigned char)line[n] > '~') return false;
  memcpy(text, line, length);
  text[length] = '\0';
  return true;
}

/* Makes the header line by which a later request asks for a file only if the file has changed. The line names
 * the file's tag if the server gave one, else the file's date. */
static void read_condition(const char *tag, const char *date, char condition[FETCH_CONDITION_BYTES]) {
  char text[FETCH_CONDITION_BYTES - 32];
  condition[0] = '\0';
  if ((tag[0] == '"' || strncmp(tag, "W/\"", 3) == 0) && copy_line(tag, text, sizeof text))
    snprintf(condition, FETCH_CONDITION_BYTES, "If-None-Match: %s", text);
  else if (date[0] >= 'A' && date[0] <= 'Z' && copy_line(date, text, sizeof text))
    snprintf(condition, FETCH_CONDITION_BYTES, "If-Modified-Since: %s", text);
}

enum { TAG, DATE, RANGE, MOVED, SAID, LINES };

/* Reads the lines that curl writes about a transfer, except the first one. */
static void read_result(FILE *said, curl_transfer *transfer) {
  char *lines[LINES] = {NULL};
  size_t room[LINES] = {0};
  bool whole = true;
  for (int n = 0; n < LINES; n++) whole = getline(&lines[n], &room[n], said) > 0 && whole;
  if (whole) {
    read_condition(lines[TAG], lines[DATE], transfer->next_condition);
    if (!copy_line(lines[RANGE], transfer->content_range, sizeof transfer->content_range))
      transfer->content_range[0] = '\0';
    if (!copy_line(lines[MOVED], transfer->moved, sizeof transfer->moved)) transfer->moved[0] = '\0';
    snprintf(transfer->said, sizeof transfer->said, "%.*s", (int)strcspn(lines[SAID], "\r\n"), lines[SAID]);
  }
  for (int n = 0; n < LINES; n++) free(lines[n]);
}

/* Reads the first line that curl writes about a transfer: "transfer NUMBER PROBLEM ANSWER". Returns the
 * transfer, or null if the line has another form. */
static curl_transfer *read_first_line(const char *line, curl_transfer *transfers, size_t count) {
  static const char word[] = "transfer ";
  char *end;
  if (strncmp(line, word, sizeof word - 1) != 0) return NULL;
  unsigned long number = strtoul(line + sizeof word - 1, &end, 10);
  if (number >= count || *end != ' ') return NULL;
  long problem = strtol(end, &end, 10);
  if (*end != ' ' || problem < 0 || problem > 255) return NULL;
  transfers[number].problem = (int)problem;
  transfers[number].answer = (int)strtol(end, NULL, 10);
  return &transfers[number];
}

static void read_results(FILE *said, curl_transfer *transfers, size_t count) {
  char *line = NULL;
  size_t room = 0;
  rewind(said);
  while (getline(&line, &room, said) > 0) {
    curl_transfer *transfer = read_first_line(line, transfers, count);
    if (transfer != NULL) read_result(said, transfer);
  }
  free(line);
}

/* ---- the run ---- */

static hl_status fail(hl_error *error, const char *what) {
  snprintf(error->message, sizeof error->message, "files on a server: %.900s", what);
  return HL_ERROR_IO;
}

static hl_status await(const fetcher *f, process *p, hl_error *error) {
  const struct timespec pause = {.tv_nsec = 5000000};
  bool succeeded;
  while (!process_has_ended(p, &succeeded)) {
    if (f->cancelled != NULL && f->cancelled(f->user_data)) {
      fail(error, "cancelled");
      return HL_ERROR_CANCELLED;
    }
    nanosleep(&pause, NULL);
  }
  return HL_OK;
}

hl_status curl_run(const fetcher *f, curl_transfer *transfers, size_t count, uint64_t most, hl_error *error) {
  static const char *const words[] = {"curl", "-q", "--config", "-", NULL};
  const uint64_t memory_most = (uint64_t)2 << 30;
  for (size_t n = 0; n < count; n++) {
    transfers[n].problem = -1;
    transfers[n].answer = 0;
    transfers[n].next_condition[0] = transfers[n].content_range[0] = transfers[n].moved[0] = '\0';
    snprintf(transfers[n].said, sizeof transfers[n].said, "curl ended before");
  }
  FILE *list = make_list(transfers, count, most);
  if (list == NULL) return fail(error, "no room for temporary files");
  process curl;
  int problem = process_start(&curl, words, fileno(list));
  hl_status status = problem == 0        ? HL_OK
                     : problem == ENOENT ? fail(error, "there is no program curl: install it (Debian: curl)")
                                         : fail(error, strerror(problem));
  /* A server may send more bytes than it announced, so the length of files is limited here. */
  process_limit(&curl, memory_most, most);
  if (status == HL_OK) status = await(f, &curl, error);
  if (status == HL_OK) read_results(curl.messages, transfers, count);
  process_end(&curl);
  fclose(list);
  return status;
}
