/* cli/frames.c - implements functions for commands that make many pictures. A picture carries its scene. A
 * picture that carries the right scene is not rendered again. So a run continues where the last run stopped,
 * and several runs can share a folder. */
#define _GNU_SOURCE
#include "frames.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "overlay.h"
#include "ranks.h"

enum { MOST_PICTURE_BYTES = 1 << 30 };

static int read_rank(int *part, int *parts) {
  launcher by;
  if (!launcher_of_process(&by))
    return fail(EXIT_CODE_USAGE,
                "--frames-over-ranks: neither mpirun nor srun has started this process: start it so, or give "
                "--part K/N");
  int used = 0, used_of_size = 0;
  bool good = sscanf(by.rank, "%6d%n", part, &used) == 1 && by.rank[used] == '\0' &&
              sscanf(by.size, "%6d%n", parts, &used_of_size) == 1 && by.size[used_of_size] == '\0';
  if (good && *part >= 0 && *part < *parts) return EXIT_CODE_OK;
  return fail(EXIT_CODE_USAGE,
              "--frames-over-ranks: %s is '%s' and %s is '%s': the first must be a whole number from 0 on, "
              "and less than the second",
              by.rank_name, by.rank, by.size_name, by.size);
}

int frames_read_part(const cli_value *value, const cli_value *ranks, int *part, int *parts) {
  int used = 0;
  *part = 0, *parts = 1;
  if (ranks->given && value->given)
    return fail(EXIT_CODE_USAGE,
                "--part and --frames-over-ranks both share out the frames: give one of them");
  if (ranks->given) return read_rank(part, parts);
  if (!value->given) return EXIT_CODE_OK;
  bool good = sscanf(value->text, "%6d/%6d%n", part, parts, &used) == 2 && value->text[used] == '\0';
  if (!good || *part < 1 || *part > *parts)
    return fail(EXIT_CODE_USAGE, "--part: '%s' is no K/N with K from 1 to N, as 3/8", value->text);
  --*part;
  return EXIT_CODE_OK;
}

unsigned char *frames_read_picture(const char *path, size_t *length) {
  struct stat about;
  errno = 0;
  FILE *file = fopen(path, "rbe");
  unsigned char *bytes = NULL;
  if (file == NULL) return NULL;
  if (fstat(fileno(file), &about) == 0 && S_ISREG(about.st_mode) && about.st_size > 0 &&
      about.st_size <= MOST_PICTURE_BYTES)
    bytes = malloc((size_t)about.st_size);
  *length = bytes != NULL ? fread(bytes, 1, (size_t)about.st_size, file) : 0;
  fclose(file);
  return bytes;
}

int frames_fail_read(const char *path) {
  return fail(errno == ENOMEM ? EXIT_CODE_FAILURE : EXIT_CODE_INPUT, "%s: cannot be read: %s", path,
              errno != 0 ? strerror(errno) : "it is empty or no file");
}

/* The text of the scene from which a picture on disk was made; free it with hl_text_release(). Null if there
 * is none. */
static char *scene_of_picture(const cli_host *host, const char *path) {
  size_t length;
  char *text = NULL;
  unsigned char *bytes = frames_read_picture(path, &length);
  if (bytes == NULL) return NULL;
  if (hl_image_find_scene(host->context, path, bytes, length, &text, NULL) != HL_OK) text = NULL;
  free(bytes);
  return text;
}

bool frames_have_scene(const cli_host *host, const char *path, const hl_scene *scene) {
  char *text = scene_of_picture(host, path), *wanted = NULL;
  hl_error ignored;
  bool same = text != NULL && output_scene_text(host->context, scene, path, &wanted, &ignored) == HL_OK &&
              strcmp(text, wanted) == 0;
  hl_text_release(host->context, wanted);
  hl_text_release(host->context, text);
  return same;
}

void frames_draw_bar(cli_host *host, int done, int wanted, int rendered, double seconds) {
  char text[80], left[40];
  if (rendered == 0) {
    snprintf(text, sizeof text, "frame %d of %d", done + 1, wanted);
  } else {
    host_describe_time(seconds / rendered * (wanted - done), left, sizeof left);
    snprintf(text, sizeof text, "frame %d of %d, %s left", done + 1, wanted, left);
  }
  host_draw_bar(host, (double)done / wanted, text);
}

/* Writes a picture with its overlays. */
static hl_status write_picture(const cli_host *host, const hl_image *image, const hl_scene *scene,
                               const frames_style *style, const char *path, hl_image_write_options *options,
                               hl_error *error) {
  cli_overlay overlay;
  if (style->overlay == NULL) return overlay_write(host->context, NULL, image, scene, path, options, error);
  hl_status status = HL_ERROR_MEMORY;
  if (overlay_for_picture(style->overlay, style->number, style->file, &overlay))
    status = overlay_write(host->context, &overlay, image, scene, path, options, error);
  else snprintf(error->message, sizeof error->message, "out of memory for a text");
  overlay_release(&overlay);
  return status;
}

hl_status frames_render(const cli_host *host, hl_renderer *renderer, const hl_scene *scene,
                        frames_style style, const char *path, hl_error *error) {
  const hl_scene_description *d = hl_scene_describe(scene);
  hl_image *image = NULL;
  char *text = NULL;
  hl_status status = hl_image_create(host->context, d->width, d->height, &image, error);
  if (status == HL_OK)
    status = hl_renderer_render(renderer, scene, hl_image_pixels(image), 4 * (size_t)d->width, NULL, error);
  if (status == HL_OK && !style.no_metadata)
    status = output_scene_text(host->context, scene, path, &text, error);
  if (status == HL_OK) {
    hl_image_write_options options;
    hl_scene_write_options(scene, &options);
    options.scene_json = text;
    if (style.opaque) options.background_transparent = 0;
    status = host_interrupted() ? HL_ERROR_CANCELLED
                                : write_picture(host, image, scene, &style, path, &options, error);
  }
  hl_text_release(host->context, text);
  hl_image_destroy(image);
  return status;
}
