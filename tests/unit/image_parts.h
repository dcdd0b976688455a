/* tests/unit/image_parts.h - what the picture tests share: contexts, pictures, folders, whole files. */
#ifndef IMAGE_PARTS_H
#define IMAGE_PARTS_H

#include <dirent.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

#include "core/file.h"
#include "core/memory.h"
#include "image/format.h"
#include "image/image.h"

static inline hl_context *make_context(void) {
  hl_context *context = NULL;
  assert_int_equal(hl_context_create(NULL, &context, NULL), HL_OK);
  return context;
}

/* Everything made must have been released by now. */
static inline void end_context(hl_context *context) {
  assert_int_equal(hl_context_memory_held(context), 0);
  hl_context_destroy(context);
}

static inline hl_image *make_image(hl_context *context, int width, int height) {
  hl_image *image = NULL;
  assert_int_equal(hl_image_create(context, width, height, &image, NULL), HL_OK);
  return image;
}

static inline float *pixel_at(hl_image *image, int x, int y) {
  return image->pixels + 4 * ((size_t)y * (size_t)image->width + (size_t)x);
}

/* A picture with structure in every channel, premultiplied: discs, a ramp and stripes. */
static inline hl_image *make_structured(hl_context *context, int width, int height) {
  hl_image *image = make_image(context, width, height);
  for (int y = 0; y < height; y++)
    for (int x = 0; x < width; x++) {
      double u = (x + 0.5) / width, v = (y + 0.5) / height, r = hypot(u - 0.4, v - 0.55);
      double alpha = r < 0.3 ? 1 : exp(-(r - 0.3) * 12);
      float *pixel = pixel_at(image, x, y);
      pixel[0] = (float)(alpha * (0.1 + 0.8 * u));
      pixel[1] = (float)(alpha * (0.5 + 0.4 * sin(20 * v)));
      pixel[2] = (float)(alpha * 0.3 * v * v);
      pixel[3] = (float)alpha;
    }
  return image;
}

/* A fresh empty folder; remove_folder takes it away with its files. */
static inline void make_folder(char path[64]) {
  snprintf(path, 64, "%s", "/tmp/halflight-image-XXXXXX");
  assert_non_null(mkdtemp(path));
}

static inline int count_files(const char *folder) {
  DIR *open = opendir(folder);
  assert_non_null(open);
  int count = 0;
  for (struct dirent *entry; (entry = readdir(open)) != NULL;) count += entry->d_name[0] != '.';
  closedir(open);
  return count;
}

static inline void remove_folder(const char *folder) {
  DIR *open = opendir(folder);
  assert_non_null(open);
  for (struct dirent *entry; (entry = readdir(open)) != NULL;) {
    char path[400];
    snprintf(path, sizeof path, "%s/%s", folder, entry->d_name);
    if (entry->d_name[0] != '.') remove(path);
  }
  closedir(open);
  rmdir(folder);
}

static inline unsigned char *read_bytes(hl_context *context, const char *path, size_t *length) {
  unsigned char *bytes = NULL;
  assert_int_equal(hl_file_read(context, path, 1 << 26, &bytes, length, NULL), HL_OK);
  return bytes;
}

static inline void write_bytes(const char *path, const void *bytes, size_t length) {
  FILE *file = fopen(path, "wb");
  assert_non_null(file);
  assert_int_equal(fwrite(bytes, 1, length, file), length);
  assert_int_equal(fclose(file), 0);
}

#endif
