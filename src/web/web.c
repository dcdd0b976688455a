/* web/web.c - see web.h. */
#include "web.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <halflight/halflight.h>

#include "platform/wasi/threads.h"
#include "simd/lanes.h"
#include "start/composed.h"
#include "start/joined.h"
#include "start/places.h"
#include "start/start.h"

enum { MOST_PIXELS = 64 << 20 };

static struct {
  hl_context *context, *sealed;           /* owned; `sealed` opens no file */
  hl_scene *scene;                        /* owned; the scene that is open */
  hl_preview *preview;                    /* owned; null if not made yet */
  hl_renderer *renderer, *quick, *picker; /* owned; null if not made yet. `renderer` makes pictures, `quick`
                                           * makes frames while something moves, and `picker` finds depths by
                                           * tiny pictures */
  int threads;                            /* the greatest number of threads that make a picture */
  char *text;                             /* owned; from the page */
  unsigned char *answer;                  /* owned; from malloc */
  size_t answer_bytes;
} web;

/* ---- answers ---- */

static int answer(hl_status status, unsigned char *bytes, size_t count) {
  free(web.answer);
  web.answer = bytes;
  web.answer_bytes = count;
  return status;
}

static int answer_text(hl_status status, const char *text) {
  char *copy = text != NULL ? strdup(text) : NULL;
  if (copy == NULL) return answer(HL_ERROR_MEMORY, NULL, 0);
  return answer(status, (unsigned char *)copy, strlen(copy));
}

static int answer_error(hl_status status, const hl_error *error) {
  return answer_text(status, error->message);
}

const unsigned char *web_answer(void) { return web.answer; }

size_t web_answer_bytes(void) { return web.answer_bytes; }

char *web_text(size_t bytes) {
  free(web.text);
  web.text = malloc(bytes + 1);
  if (web.text != NULL) web.text[bytes] = '\0';
  return web.text;
}

/* ---- the beginning ---- */

int web_fuses(void) {
  /* (1 + 2^-12)^2 - 1 needs 25 bits: an engine that rounds the product before the addition loses the term
   * 2^-24 */
  volatile float factor = 1.0f + 0x1p-12f, addend = -1.0f;
  lanes sum = lanes_fma(lanes_set(factor), lanes_set(factor), lanes_set(addend));
  for (int lane = 0; lane < LANES; lane++)
    if (sum[lane] != 0x1p-11f + 0x1p-24f) return 0; /* NOLINT: exact */
  return 1;
}

static int cancelled(void *user_data) {
  (void)user_data;
  return web_cancelled();
}

static void progress(void *user_data, const char *stage, double fraction) {
  (void)user_data;
  if (strcmp(stage, "load") == 0) web_progress(fraction);
}

int web_begin(uint32_t mebibytes, int threads) {
  hl_error error = {0};
  web.threads = threads;
  hl_helpers_allow(threads);
  hl_context_options options;
  hl_context_options_defaults(&options);
  options.cancelled = cancelled;
  options.progress = progress;
  options.keep_unsmoothed = 1; /* for slices */
  options.memory_limit = (uint64_t)mebibytes << 20;
  hl_status status = hl_context_create(&options, &web.context, &error);
  if (status == HL_OK) status = hl_context_confine(web.context, NULL, &web.sealed, &error);
  return answer_error(status, &error);
}

int web_helper_arrive(int number) { return hl_helper_arrive(number); }

void web_helper_serve(int number) { hl_helper_serve(number); }

void *web_room(size_t bytes) { return malloc(bytes); }

void web_release(void *room) { free(room); }

double web_memory_held(void) { return (double)hl_context_memory_held(web.context); }

/* ---- the open scene and its objects ---- */

static void forget_renderers(void) {
  hl_renderer_destroy(web.renderer);
  hl_renderer_destroy(web.quick);
  hl_renderer_destroy(web.picker);
  web.renderer = web.quick = web.picker = NULL;
}

static bool ends_in(const char *text, const char *ending) {
  size_t length = strlen(text), end = strlen(ending);
  return length >= end && strcmp(text + length - end, ending) == 0;
}

static hl_status load_by_name(const char *path, hl_scene **scene, hl_error *error) {
  hl_volume *volume = NULL;
  hl_scene_mesh mesh;
  *scene = NULL;
  if (ends_in(path, ".json")) return hl_scene_load(web.context, path, scene, error);
  if (hl_mesh_reads_name(web.context, path) && !hl_volume_reads_cells(web.context, path)) {
    hl_status status = load_mesh(web.context, path, 0, &mesh, error);
    if (status == HL_OK) status = join_meshes(web.context, &mesh, 1, true, scene, error);
    hl_mesh_release(mesh.mesh);
    return status;
  }
  hl_status status = hl_volume_load(web.context, path, &volume, error);
  if (status == HL_OK) status = hl_scene_for_volume(web.context, volume, path, scene, error);
  hl_volume_release(volume);
  return status;
}

static hl_status load_alone(const char *path, hl_scene **scene, hl_error *error) {
  hl_helpers_allow(1); /* helpers have no files */
  hl_status status = load_by_name(path, scene, error);
  hl_helpers_allow(web.threads);
  return status;
}

/* Loads a file. If memory is short, lets the renderers release their memory, and loads the file once more. */
static hl_status load(const char *path, hl_scene **scene, hl_error *error) {
  hl_status status = load_alone(path, scene, error);
  if (status != HL_ERROR_MEMORY) return status;
  forget_renderers();
  return load_alone(path, scene, error);
}

/* Replaces the open scene by another scene, and answers with the start.json of the new scene. */
static int show(hl_scene *scene, const char *title) {
  forget_renderers();
  hl_preview_destroy(web.preview);
  web.preview = NULL;
  hl_scene_release(web.scene);
  web.scene = scene;
  const start_about about = {.title = title};
  char *start = describe_start(web.context, web.scene, &about);
  return start != NULL ? answer(HL_OK, (unsigned char *)start, strlen(start))
                       : answer_text(HL_ERROR_MEMORY, "no memory for what the page is told of a volume");
}

int web_open(const char *title) {
  hl_error error = {0};
  hl_scene *scene = NULL;
  hl_status status = load(web.text, &scene, &error);
  return status == HL_OK ? show(scene, title) : answer_error(status, &error);
}

static hl_status read_scene(size_t length, hl_scene **scene, hl_error *error) {
  hl_status status = hl_scene_from_json_like(web.sealed, web.text, length, NULL, "scene", web.scene, scene,
                                             error);
  if (status != HL_OK) return status;
  const hl_scene_description *d = hl_scene_describe(*scene);
  if ((long long)d->width * d->height <= MOST_PIXELS) return HL_OK;
  snprintf(error->message, sizeof error->message, "/image: %d x %d pixels are more than the page's %d",
           d->width, d->height, (int)MOST_PIXELS);
  hl_scene_release(*scene);
  return HL_ERROR_INPUT;
}

int web_join(size_t length, const char *path_and_title) {
  hl_error error = {0};
  hl_scene *base = NULL, *added = NULL, *joined = NULL;
  hl_status status = read_scene(length, &base, &error);
  if (status == HL_OK) status = load(path_and_title, &added, &error);
  if (status == HL_OK) status = join_scenes(web.context, base, added, &joined, &error);
  hl_scene_release(added);
  hl_scene_release(base);
  return status == HL_OK ? show(joined, path_and_title + strlen(path_and_title) + 1)
                         : answer_error(status, &error);
}

int web_complete(size_t length, const char *look_and_rig) {
  hl_error error = {0};
  hl_scene *scene = NULL;
  char *json = NULL;
  hl_status status = read_scene(length, &scene, &error);
  if (status != HL_OK) return answer_error(status, &error);
  const char *look = look_and_rig, *rig = look_and_rig + strlen(look_and_rig) + 1;
  const composed_choices choices = {look[0] != '\0' ? look : NULL, rig[0] != '\0' ? rig : NULL};
  status = compose_choices(web.sealed, &choices, &scene, &error);
  if (status == HL_OK) status = hl_scene_to_json(web.context, scene, &json, &error);
  int answered = status == HL_OK ? answer_text(HL_OK, json) : answer_error(status, &error);
  hl_text_release(web.context, json);
  hl_scene_release(scene);
  return answered;
}

/* ---- frames ---- */

static hl_status encode_rgba(const hl_image *image, const hl_image_write_options *options, hl_error *error) {
  size_t row = 4 * (size_t)hl_image_width(image), bytes = row * (size_t)hl_image_height(image);
  hl_image_write_options opaque = *options;
  opaque.background_transparent = 0;
  unsigned char *rgba = malloc(bytes);
  if (rgba == NULL) {
    snprintf(error->message, sizeof error->message, "no memory for a picture");
    return HL_ERROR_MEMORY;
  }
  hl_status status = hl_image_to_srgb8(image, &opaque, rgba, row, error);
  if (status == HL_OK) answer(HL_OK, rgba, bytes);
  else free(rgba);
  return status;
}

/* Makes a picture's file with the bytes that `halflight render` writes for the scene. */
static hl_status encode_file(const hl_scene *scene, const hl_image *image, const char *format,
                             hl_image_write_options *options, bool metadata, hl_error *error) {
  char *json = NULL;
  unsigned char *bytes = NULL, *copy = NULL;
  size_t length = 0;
  hl_status status = metadata ? hl_scene_to_json(web.context, scene, &json, error) : HL_OK;
  options->scene_json = json;
  if (status == HL_OK) status = hl_image_encode(web.context, image, format, options, &bytes, &length, error);
  if (status == HL_OK && (copy = malloc(length)) == NULL) {
    snprintf(error->message, sizeof error->message, "no memory for a picture");
    status = HL_ERROR_MEMORY;
  }
  if (status == HL_OK) answer(HL_OK, memcpy(copy, bytes, length), length);
  hl_bytes_release(web.context, bytes);
  hl_text_release(web.context, json);
  return status;
}

/* Makes the scene that is rendered while something moves. The result may be the given scene itself. */
static hl_status make_quick(hl_scene *scene, hl_scene **quick, hl_error *error) {
  if (web.preview == NULL && hl_preview_create(web.context, web.scene, &web.preview, NULL) != HL_OK)
    return HL_OK;
  return hl_preview_scene(web.preview, scene, quick, error);
}

static hl_status render(hl_renderer **renderer, const hl_scene *scene, const char *format, int depth,
                        bool metadata, hl_error *error) {
  const hl_scene_description *d = hl_scene_describe(scene);
  hl_image *image = NULL;
  hl_status status = *renderer == NULL ? hl_renderer_create(web.context, renderer, error) : HL_OK;
  if (status == HL_OK) status = hl_image_create(web.context, d->width, d->height, &image, error);
  if (status == HL_OK)
    status = hl_renderer_render(*renderer, scene, hl_image_pixels(image), 4 * (size_t)d->width, NULL, error);
  if (status == HL_OK) {
    hl_image_write_options options;
    hl_scene_write_options(scene, &options);
    options.png_depth = depth;
    status = strcmp(format, "rgba") == 0 ? encode_rgba(image, &options, error)
                                         : encode_file(scene, image, format, &options, metadata, error);
  }
  hl_image_destroy(image);
  return status;
}

int web_frame(size_t length, const char *format, int depth, int metadata, int moving) {
  hl_error error = {0};
  hl_scene *scene = NULL, *quick = NULL;
  hl_status status = read_scene(length, &scene, &error);
  if (status != HL_OK) return answer_error(status, &error);
  if (moving != 0) status = make_quick(scene, &quick, &error);
  bool coarser = quick != NULL && quick != scene;
  hl_renderer **renderer = coarser ? &web.quick : &web.renderer;
  const hl_scene *rendered = coarser ? quick : scene;
  if (status == HL_OK) status = render(renderer, rendered, format, depth, metadata != 0, &error);
  /* If memory is short, the renderers release their memory of earlier frames, and the picture is tried once
   * more. */
  if (status == HL_ERROR_MEMORY) {
    forget_renderers();
    status = render(renderer, rendered, format, depth, metadata != 0, &error);
  }
  hl_scene_release(quick);
  hl_scene_release(scene);
  return status == HL_OK ? HL_OK : answer_error(status, &error);
}

/* ---- places ---- */

enum { PLANE_NUMBERS = 15 };

static hl_status read_plane(const double numbers[PLANE_NUMBERS], hl_reslice_options *plane, hl_error *error) {
  bool fits = true;
  hl_reslice_options_defaults(plane);
  for (int side = 0; side < 3; side++) fits = fits && numbers[side] >= 1 && numbers[side] <= MOST_SLICE_SIDE;
  if (!fits || numbers[0] * numbers[1] > MOST_SLICE_SAMPLES ||
      numbers[0] * numbers[1] * numbers[2] > MOST_LAYERED_SAMPLES) {
    snprintf(error->message, sizeof error->message,
             "a slice has %d samples along a side at most, and %d in all", (int)MOST_SLICE_SIDE,
             (int)MOST_SLICE_SAMPLES);
    return HL_ERROR_INPUT;
  }
  plane->width = (size_t)numbers[0];
  plane->height = (size_t)numbers[1];
  plane->depth = (size_t)numbers[2];
  for (int axis = 0; axis < 3; axis++) {
    plane->origin[axis] = numbers[3 + axis];
    plane->across[axis] = numbers[6 + axis];
    plane->down[axis] = numbers[9 + axis];
    plane->through[axis] = numbers[12 + axis];
  }
  return HL_OK;
}

int web_slice(int number, int source, int blend, int interpolate) {
  hl_error error = {0};
  hl_reslice_options plane;
  double numbers[PLANE_NUMBERS];
  unsigned char *bytes = NULL;
  size_t count = 0;
  const hl_volume *volume = sliced_volume(web.scene, number, (slice_source)source);
  if (volume == NULL) return answer_text(HL_ERROR_INPUT, "the scene has no such volume or mask");
  memcpy(numbers, web.text, sizeof numbers);
  hl_status status = read_plane(numbers, &plane, &error);
  plane.blend = (hl_blend)blend;
  plane.interpolate = interpolate;
  if (status == HL_OK) status = slice_values(volume, &plane, &bytes, &count, &error);
  return status == HL_OK ? answer(HL_OK, bytes, count) : answer_error(status, &error);
}

static hl_status find_depth(const hl_scene *scene, char **text, hl_error *error) {
  hl_status status = web.picker == NULL ? hl_renderer_create(web.context, &web.picker, error) : HL_OK;
  return status == HL_OK ? middle_depth(web.picker, scene, text, error) : status;
}

int web_depth(size_t length) {
  hl_error error = {0};
  hl_scene *scene = NULL;
  char *text = NULL;
  hl_status status = read_scene(length, &scene, &error);
  if (status != HL_OK) return answer_error(status, &error);
  status = find_depth(scene, &text, &error);
  /* If memory is short, the renderers release their memory of earlier frames, and the depth is searched for
   * once more. */
  if (status == HL_ERROR_MEMORY) {
    forget_renderers();
    status = find_depth(scene, &text, &error);
  }
  hl_scene_release(scene);
  return status == HL_OK ? answer(HL_OK, (unsigned char *)text, strlen(text)) : answer_error(status, &error);
}
