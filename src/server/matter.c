/* server/matter.c - keeps the opacities of the newest picture of each page, for the page's overlays. An
 * overlay keeps clear of the matter in the picture, and therefore needs the opacities. The page has this
 * picture made before it asks for the overlay. The opacities are kept with the text of the scene, so that the
 * overlay of this scene needs no renderer of its own, which would prepare the volumes once more. */
#define _GNU_SOURCE
#include <stdlib.h>
#include <string.h>

#include "parts.h"

enum { MOST_KEPT_ALONG = 512 }; /* pixels along a side; an overlay distinguishes no more */

void matter_forget(server_page *page) {
  hl_image_destroy(page->matter.image);
  free(page->matter.scene);
  page->matter = (page_matter){0};
}

static int least(int a, int b) { return a < b ? a : b; }

/* The mean opacity of the pixels of an image whose column is from left to right - 1, and whose row is from
 * top to bottom - 1. */
static float mean_opacity(const hl_image *image, int left, int right, int top, int bottom) {
  const size_t width = (size_t)hl_image_width(image);
  double sum = 0;
  for (int y = top; y < bottom; y++) {
    const float *row = hl_image_pixels_const(image) + 4 * width * (size_t)y;
    for (int x = left; x < right; x++) sum += (double)row[4 * x + 3];
  }
  return (float)(sum / ((double)(right - left) * (bottom - top)));
}

/* Sets the opacity of each pixel of `small` to the mean of the pixels of `image` there. side: the number of
 * pixels of `image` along one side of a pixel of `small`. */
static void average_opacities(const hl_image *image, int side, hl_image *small) {
  const int width = hl_image_width(image), height = hl_image_height(image);
  float *pixel = hl_image_pixels(small);
  for (int top = 0; top < height; top += side)
    for (int left = 0; left < width; left += side, pixel += 4) {
      memset(pixel, 0, 3 * sizeof *pixel);
      pixel[3] = mean_opacity(image, left, least(left + side, width), top, least(top + side, height));
    }
}

/* Makes an image of the opacities of an image, with at most MOST_KEPT_ALONG pixels along a side. Returns null
 * if memory is short. */
static hl_image *opacities_of(const server *s, const hl_image *image) {
  const int width = hl_image_width(image), height = hl_image_height(image);
  const int side = ((width > height ? width : height) + MOST_KEPT_ALONG - 1) / MOST_KEPT_ALONG;
  hl_image *small = NULL;
  hl_error error = {0};
  if (hl_image_create(s->options.context, (width + side - 1) / side, (height + side - 1) / side, &small,
                      &error) != HL_OK)
    return NULL;
  average_opacities(image, side, small);
  return small;
}

void matter_keep(server *s, server_page *page, const frame_request *request, const hl_image *image) {
  page_matter matter = {.image = opacities_of(s, image),
                        .scene = malloc(request->length > 0 ? request->length : 1),
                        .length = request->length,
                        .opened = request->opened};
  const bool whole = matter.image != NULL && matter.scene != NULL;
  if (whole) memcpy(matter.scene, request->text, request->length);
  pthread_mutex_lock(&s->pages_lock);
  page_matter before = page->matter;
  page->matter = whole ? matter : (page_matter){0};
  pthread_mutex_unlock(&s->pages_lock);
  hl_image_destroy(before.image);
  free(before.scene);
  if (whole) return;
  hl_image_destroy(matter.image);
  free(matter.scene);
}

static bool is_of(const page_matter *matter, const frame_request *request) {
  return matter->image != NULL && matter->opened == request->opened && matter->length == request->length &&
         memcmp(matter->scene, request->text, request->length) == 0;
}

static hl_image *copy_of(const server *s, const hl_image *image) {
  const int width = hl_image_width(image), height = hl_image_height(image);
  hl_image *copy = NULL;
  hl_error error = {0};
  if (hl_image_create(s->options.context, width, height, &copy, &error) != HL_OK) return NULL;
  memcpy(hl_image_pixels(copy), hl_image_pixels_const(image),
         4 * sizeof(float) * (size_t)width * (size_t)height);
  return copy;
}

hl_image *matter_find(server *s, const frame_request *request) {
  const size_t length = strcspn(request->page, "-"); /* the name of the lane's page */
  hl_image *found = NULL;
  pthread_mutex_lock(&s->pages_lock);
  for (int p = 0; p < MOST_PAGES && found == NULL; p++) {
    const server_page *page = &s->pages[p];
    if (strlen(page->name) == length && memcmp(page->name, request->page, length) == 0 &&
        is_of(&page->matter, request))
      found = copy_of(s, page->matter.image);
  }
  pthread_mutex_unlock(&s->pages_lock);
  return found;
}
