/* tests/fuzz/picture.c - fuzz target: PNG (slides that lights project), OpenEXR, Radiance HDR and NPY
 * pictures. */
#include <string.h>
#include <zlib.h>

#include "target.h"

const uint64_t fuzz_memory_limit = 4 << 20;
enum { MOST_BYTES = 1 << 16, SIGNATURE = 8, FRAME = 12 /* length, type, checksum */ };

static uint32_t load(const uint8_t *bytes) {
  return (uint32_t)bytes[0] << 24 | (uint32_t)bytes[1] << 16 | (uint32_t)bytes[2] << 8 | bytes[3];
}

/* Makes the checksum of every chunk right, so that changed inputs are read beyond the check of checksums. */
static void mend_checksums(uint8_t *png, size_t size) {
  for (size_t at = SIGNATURE; size - at >= FRAME && load(png + at) <= size - at - FRAME;) {
    size_t length = load(png + at);
    uint32_t sum = (uint32_t)crc32(0, png + at + 4, (unsigned)length + 4);
    for (int n = 0; n < 4; n++) png[at + 8 + length + (size_t)n] = (uint8_t)(sum >> (24 - 8 * n));
    at += length + FRAME;
  }
}

static void check_picture(const hl_image *image) {
  hl_image_difference difference = {.struct_size = sizeof difference};
  REQUIRE(hl_image_width(image) > 0 && hl_image_height(image) > 0);
  REQUIRE(hl_image_compare(image, image, &difference, NULL) == HL_OK); /* reads every pixel */
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  static uint8_t mended[MOST_BYTES];
  if (size > MOST_BYTES) return 0;
  memcpy(mended, data, size);
  if (size > SIGNATURE && memcmp(data, "\x89PNG", 4) == 0) mend_checksums(mended, size);
  const char *path = fuzz_write_file(0, "p.png", mended, size);
  hl_image *image = NULL;
  hl_error error = {0};
  hl_status status = hl_image_read(fuzz_context(), path, &image, &error);
  if (fuzz_check_answer(status, &error, image != NULL)) check_picture(image);
  hl_image_destroy(image);
  char *text = NULL;
  status = hl_image_find_scene(fuzz_context(), "p.png", mended, size, &text, &error);
  if (fuzz_check_answer(status, &error, text != NULL)) REQUIRE(strlen(text) <= (size_t)16 << 20);
  hl_text_release(fuzz_context(), text);
  hl_image_about about = {.struct_size = sizeof about};
  status = hl_image_get_about("p.png", mended, size, &about, &error);
  fuzz_check_answer(status, &error, status == HL_OK);
  fuzz_check_nothing_held();
  return 0;
}
