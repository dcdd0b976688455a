/* film/movie.c - runs ffmpeg: its options for each kind of film, the pipe into it, its messages. */
#define _GNU_SOURCE
#include "movie.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "process/process.h"
#include "text/plain.h"

enum { MOST_WORDS = 48, MOST_CODEC_WORDS = 12 };

struct movie {
  char *path, *unfinished; /* owned; the film's name, and the name of the file that is not finished */
  char *target; /* owned; "file:" and the name of the unfinished file. Without "file:", ffmpeg may take a part
                 * of the name for a protocol */
  int pipe;     /* a pipe into ffmpeg; -1 if closed */
  process ffmpeg;
};

const char *const movie_extensions[] = {".mp4", ".mov", ".mkv", ".webm", ".gif", NULL};

/* Options of films for players: players expect even widths and heights, colours at half the resolution, and a
 * mark that the colours are sRGB. */
#define FOR_PLAYERS                                                                                     \
  "pad=ceil(iw/2)*2:ceil(ih/2)*2,scale=in_range=pc:out_range=tv:out_color_matrix=bt709,format=yuv420p," \
  "setparams=color_primaries=bt709:color_trc=iec61966-2-1:colorspace=bt709"
#define H264 "-c:v", "libx264", "-crf", "16", "-preset", "medium"

static const struct kind {
  const char *muxer, *filter, *codec[MOST_CODEC_WORDS];
} kinds[] = {
    {"mp4", FOR_PLAYERS, {H264, "-movflags", "+faststart"}},
    {"mov", FOR_PLAYERS, {H264, "-movflags", "+faststart"}},
    {"matroska", FOR_PLAYERS, {H264}},
    {"webm", FOR_PLAYERS, {"-c:v", "libvpx-vp9", "-crf", "20", "-b:v", "0", "-row-mt", "1"}},
    {"gif",
     "split[a][b];[a]palettegen=stats_mode=diff[p];[b][p]paletteuse=dither=bayer:bayer_scale=4",
     {NULL}},
};

static const struct kind *kind_of(const char *path) {
  const char *dot = strrchr(path, '.');
  for (int k = 0; dot != NULL && movie_extensions[k] != NULL; k++)
    if (hl_plain_equal(dot, movie_extensions[k])) return &kinds[k];
  return NULL;
}

bool movie_available(void) { return process_is_there("ffmpeg"); }

static hl_status fail_io(hl_error *error, const char *path, const char *what) {
  snprintf(error->message, sizeof error->message, "%.300s: %.600s", path, what);
  return HL_ERROR_IO;
}

/* Sets the words of ffmpeg's command line. "-xerror": without it, ffmpeg 5 ends with status 0 after it could
 * not write the end of a film. words: [MOST_WORDS]; receives the words. */
static void command_line(const struct kind *kind, const char *rate, const char *file, const char **words) {
  const char *const first[] = {
      "ffmpeg",          "-hide_banner", "-nostdin", "-xerror",    "-loglevel", "error", "-y",     "-f",
      "image2pipe",      "-c:v",         "png",      "-framerate", rate,        "-i",    "pipe:0", "-an",
      "-filter_complex", kind->filter,   "-r",       rate};
  const char *const last[] = {"-fflags", "+bitexact", "-flags:v", "+bitexact", "-f", kind->muxer, file};
  size_t count = 0;
  for (size_t w = 0; w < sizeof first / sizeof *first; w++) words[count++] = first[w];
  for (size_t w = 0; w < MOST_CODEC_WORDS && kind->codec[w] != NULL; w++) words[count++] = kind->codec[w];
  for (size_t w = 0; w < sizeof last / sizeof *last; w++) words[count++] = last[w];
  words[count] = NULL;
}

static hl_status start(movie *m, double frames_per_second, hl_error *error) {
  const char *words[MOST_WORDS];
  char rate[40];
  int ends[2];
  snprintf(rate, sizeof rate, "%d/1000", (int)(1000 * frames_per_second + 0.5));
  command_line(kind_of(m->path), rate, m->target, words);
  if (pipe2(ends, O_CLOEXEC) != 0) return fail_io(error, m->path, strerror(errno));
  m->pipe = ends[1];
  int problem = process_start(&m->ffmpeg, words, ends[0]);
  close(ends[0]);
  if (problem == 0) return HL_OK;
  snprintf(error->message, sizeof error->message, "ffmpeg cannot be run: %s", strerror(problem));
  return problem == ENOENT ? HL_ERROR_UNSUPPORTED : HL_ERROR_IO;
}

hl_status movie_begin(const char *path, double frames_per_second, movie **result, hl_error *error) {
  movie *m = calloc(1, sizeof *m);
  *result = NULL;
  if (m == NULL || kind_of(path) == NULL) {
    free(m);
    snprintf(error->message, sizeof error->message, "%s", m == NULL ? "out of memory" : "no kind of film");
    return m == NULL ? HL_ERROR_MEMORY : HL_ERROR_ARGUMENT;
  }
  m->pipe = -1;
  m->path = strdup(path);
  hl_status status = HL_OK;
  if (m->path == NULL || asprintf(&m->unfinished, "%s.%d.unfinished", path, (int)getpid()) < 0)
    m->unfinished = NULL;
  if (m->unfinished == NULL || asprintf(&m->target, "file:%s", m->unfinished) < 0) {
    m->target = NULL;
    snprintf(error->message, sizeof error->message, "out of memory");
    status = HL_ERROR_MEMORY;
  }
  if (status == HL_OK) status = start(m, frames_per_second, error);
  if (status == HL_OK) *result = m;
  else movie_abandon(m);
  return status;
}

hl_status movie_add(movie *m, const unsigned char *png, size_t length, hl_error *error) {
  while (length > 0) {
    ssize_t taken = write(m->pipe, png, length);
    if (taken < 0 && errno == EINTR) continue;
    if (taken < 0) { /* ffmpeg has ended early; its messages tell the reason */
      hl_status status = movie_end(m, error);
      return status == HL_OK ? HL_ERROR_IO : status;
    }
    png += taken;
    length -= (size_t)taken;
  }
  return HL_OK;
}

static void close_pipe(movie *m) {
  if (m->pipe >= 0) close(m->pipe);
  m->pipe = -1;
}

static void release(movie *m) {
  process_end(&m->ffmpeg);
  free(m->path);
  free(m->unfinished);
  free(m->target);
  free(m);
}

/* Completes a film: closes the pipe, after which ffmpeg ends. */
hl_status movie_end(movie *m, hl_error *error) {
  char said[400];
  hl_status status = HL_OK;
  close_pipe(m);
  if (!process_wait(&m->ffmpeg)) {
    process_said(&m->ffmpeg, "ffmpeg", said, sizeof said);
    status = fail_io(error, m->path, said);
  } else if (rename(m->unfinished, m->path) != 0) status = fail_io(error, m->path, strerror(errno));
  if (status != HL_OK) unlink(m->unfinished);
  release(m);
  return status;
}

void movie_abandon(movie *m) {
  if (m == NULL) return;
  process_end(&m->ffmpeg);
  close_pipe(m);
  if (m->unfinished != NULL) unlink(m->unfinished);
  release(m);
}
