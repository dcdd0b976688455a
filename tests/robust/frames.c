/* tests/robust/frames.c - many frames from one renderer: memory stays where it was, and the same scene gives
 * the same bytes at the end as at the beginning.
 *
 * usage: frames [--frames N] [--seconds S]     (0 frames: no end but that of time)
 *
 * Without options 200 frames, in TAP; 60 where a sanitizer looks at each. With --seconds a soak: between
 * those frames scenes are drawn in other sizes and from other sides, the renderer is made anew now and then,
 * and a line a minute tells the memory. */
#define _GNU_SOURCE
#include "small_scenes.h"

/* The address sanitizer keeps released memory for a while. With it, only the memory that the context holds
 * can be compared, which is the same from the second round on. */
/* the way in which clang tells that there is a sanitizer */
#if defined(__has_feature) && !defined(__SANITIZE_ADDRESS__)
#if __has_feature(address_sanitizer)
#define __SANITIZE_ADDRESS__
#endif
#endif
#if defined(__SANITIZE_ADDRESS__)
enum { KEEPS_RELEASED = 1, FRAMES = 60 };
#else
enum { KEEPS_RELEASED = 0, FRAMES = 200 };
#endif

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <time.h>
#include <unistd.h>

enum { SCENES = SMALL_SCENES_WITHOUT_FILES };

typedef struct soak {
  long frames;    /* the number of frames that is asked for; 0: no end */
  double seconds; /* the number of seconds that is asked for; 0: no end */
  hl_context *context;
  hl_renderer *renderer;
  hl_scene *scenes[SCENES];
  float *first[SCENES]; /* the pictures of the first round */
  float *pixels;
  uint64_t held_first; /* the bytes that the context holds after the second round */
  long resident_first; /* the bytes of the process after the second round */
  long done;
} soak;

static double now(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static long resident_bytes(void) {
  long pages = 0;
  FILE *file = fopen("/proc/self/statm", "r");
  if (file == NULL) return 0;
  if (fscanf(file, "%*s %ld", &pages) != 1) pages = 0;
  fclose(file);
  return pages * sysconf(_SC_PAGESIZE);
}

/* The system may join the small pages of a block to a large page at any time, and memory that was never
 * written then counts as resident. It must not do so here, so that only the frames' own memory is compared.
 */
static void keep_pages_small(void) { (void)prctl(PR_SET_THP_DISABLE, 1, 0, 0, 0); }

static void give_up(const char *why, const hl_error *error) {
  printf("Bail out! %s: %s\n", why, error != NULL ? error->message : "");
  exit(1);
}

static void must(hl_status status, const char *what, const hl_error *error) {
  if (status != HL_OK) give_up(what, error);
}

static void open_soak(soak *s) {
  hl_error error = {0};
  must(hl_context_create(NULL, &s->context, &error), "context", &error);
  must(hl_renderer_create(s->context, &s->renderer, &error), "renderer", &error);
  for (size_t n = 0; n < SCENES; n++) {
    must(small_scene_make(s->context, n, NULL, &s->scenes[n], &error), small_scenes[n].name, &error);
    s->first[n] = calloc(small_scene_floats(s->scenes[n]), sizeof(float));
  }
  s->pixels = calloc(small_scene_floats(s->scenes[0]), sizeof(float));
}

static void close_soak(soak *s) {
  for (size_t n = 0; n < SCENES; n++) {
    hl_scene_release(s->scenes[n]);
    free(s->first[n]);
  }
  free(s->pixels);
  hl_renderer_destroy(s->renderer);
  if (hl_context_memory_held(s->context) != 0) give_up("bytes are held at the end", NULL);
  hl_context_destroy(s->context);
}

/* Renders one frame of the round. The pictures of the first round are those that all later rounds must have.
 */
static void draw(soak *s, size_t n, bool first_round) {
  hl_error error = {0};
  size_t bytes = small_scene_floats(s->scenes[n]) * sizeof(float);
  float *pixels = first_round ? s->first[n] : s->pixels;
  must(hl_renderer_render(s->renderer, s->scenes[n], pixels, 4 * 24, NULL, &error), small_scenes[n].name,
       &error);
  if (!first_round && memcmp(pixels, s->first[n], bytes) != 0) give_up("the bytes have changed", NULL);
  s->done++;
}

/* Renders a frame that is like no other: a scene that is turned and has another size. */
static void draw_another(soak *s, long round) {
  hl_error error = {0};
  hl_scene *scene = NULL;
  hl_scene_description d = *hl_scene_describe(s->scenes[round % SCENES]);
  d.width = 16 + (int)(round * 37 % 113);
  d.height = 16 + (int)(round * 53 % 97);
  must(hl_camera_frame(&d, (double)(round * 29 % 360), (double)(round * 7 % 120) - 60, 1, &d.camera),
       "camera", &error);
  must(hl_scene_create(s->context, &d, &scene, &error), "scene", &error);
  float *pixels = calloc((size_t)d.width * (size_t)d.height * 4, sizeof *pixels);
  must(hl_renderer_render(s->renderer, scene, pixels, 4 * (size_t)d.width, NULL, &error), "another frame",
       &error);
  for (int i = 0; i < 4 * d.width * d.height; i++)
    if (!isfinite(pixels[i])) give_up("a pixel is no number", NULL);
  free(pixels);
  hl_scene_release(scene);
  s->done++;
}

static void report(const soak *s) {
  fprintf(stderr, "%8ld frames, held %llu bytes (%llu after the second round), resident %.1f MB (%.1f)\n",
          s->done, (unsigned long long)hl_context_memory_held(s->context), (unsigned long long)s->held_first,
          (double)resident_bytes() / 1e6, (double)s->resident_first / 1e6);
}

/* Without a renderer only the scenes hold memory, which is always the same. */
static void renew(soak *s, uint64_t *held) {
  hl_error error = {0};
  hl_renderer_destroy(s->renderer);
  if (*held == 0) *held = hl_context_memory_held(s->context);
  if (*held != hl_context_memory_held(s->context)) give_up("more bytes are held than before", NULL);
  must(hl_renderer_create(s->context, &s->renderer, &error), "renderer", &error);
}

/* Buffers are as large as the largest frame needed. If all rounds are alike, the memory that is held is
 * always the same. odd: whether there is a frame that is like no other between them. */
static void run(soak *s, bool odd) {
  enum { ROUNDS_OF_A_RENDERER = 200 };
  uint64_t held_by_scenes = 0;
  double start = now(), told = start;
  for (long round = 0;
       (s->frames == 0 || s->done < s->frames) && (s->seconds == 0 || now() - start < s->seconds); round++) {
    for (size_t n = 0; n < SCENES; n++) draw(s, n, round == 0);
    if (round == 1) {
      s->held_first = hl_context_memory_held(s->context);
      s->resident_first = resident_bytes();
    }
    if (round > 1 && !odd && hl_context_memory_held(s->context) != s->held_first)
      give_up("more bytes are held than before", NULL);
    if (odd) draw_another(s, round);
    if (odd && round % ROUNDS_OF_A_RENDERER == 0) renew(s, &held_by_scenes);
    if (now() - told < 60) continue;
    told = now();
    report(s);
  }
}

int main(int count, char **arguments) {
  soak s = {.frames = FRAMES};
  bool soaking = count > 1;
  if (soaking) s.frames = 0;
  for (int i = 1; i + 1 < count; i += 2) {
    if (strcmp(arguments[i], "--frames") == 0) s.frames = atol(arguments[i + 1]);
    if (strcmp(arguments[i], "--seconds") == 0) s.seconds = atof(arguments[i + 1]);
  }
  if (!soaking) printf("1..2\n");
  keep_pages_small();
  open_soak(&s);
  run(&s, s.seconds > 0);
  long grown = resident_bytes() - s.resident_first,
       most_grown = s.seconds > 0 ? 64000000 : 4000000; /* by larger frames */
  if (soaking) report(&s);
  else printf("ok 1 - bytes and memory are the same after %ld frames\n", s.done);
  bool flat = grown < most_grown || KEEPS_RELEASED; /* the system's allocator may keep a little */
  if (!soaking) printf("%s 2 - the process has grown by %ld bytes\n", flat ? "ok" : "not ok", grown);
  close_soak(&s);
  return flat ? 0 : 1;
}
