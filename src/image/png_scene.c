/* image/png_scene.c - the scene that a picture carries: a PNG's text chunk of the keyword "halflight:scene".
 *
 * In: the bytes of a file, which may be anything. Out: the text. Chunks are walked by hand, so that the
 * picture itself need not be decoded: tEXt, zTXt and iTXt (PNG specification, sections 11.3.4.3 to 11.3.4.5),
 * the latter two inflated within a limit.
 */
#include <string.h>
#include <zlib.h>

#include "core/error.h"
#include "core/memory.h"
#include "image/image.h"

enum { SCENE_BYTES_MOST = 16 << 20, MARK_BYTES = 8, CHUNK_EXTRA_BYTES = 12 };

static const char keyword[] = "halflight:scene";
static const unsigned char mark[MARK_BYTES] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};

static uint32_t load_32(const unsigned char *bytes) {
  return (uint32_t)bytes[0] << 24 | (uint32_t)bytes[1] << 16 | (uint32_t)bytes[2] << 8 | bytes[3];
}

static void *zlib_allocate(void *context, unsigned items, unsigned size) {
  return hl_allocate(context, items, size);
}
static void zlib_release(void *context, void *memory) { hl_release(context, memory); }

static hl_status copy_text(hl_context *context, const char *name, const unsigned char *bytes, size_t length,
                           char **text, hl_error *error) {
  if (length > SCENE_BYTES_MOST)
    return hl_fail(error, HL_ERROR_INPUT, "%s: its scene has %zu bytes: at most %d are read", name, length,
                   SCENE_BYTES_MOST);
  *text = hl_allocate(context, length + 1, 1);
  if (*text == NULL) return hl_fail_memory(error, length + 1, name);
  memcpy(*text, bytes, length);
  (*text)[length] = 0;
  return HL_OK;
}

/* Inflates into a buffer that doubles until the text ends or the limit is met. */
static hl_status inflate_text(hl_context *context, const char *name, const unsigned char *bytes,
                              size_t length, char **text, hl_error *error) {
  z_stream zlib = {.zalloc = zlib_allocate, .zfree = zlib_release, .opaque = context};
  if (inflateInit(&zlib) != Z_OK) return hl_fail_memory(error, 65536, name);
  size_t capacity = 65536, made = 0;
  char *buffer = hl_allocate(context, capacity, 1);
  zlib.next_in = (unsigned char *)bytes;
  zlib.avail_in = (unsigned)length;
  int code = Z_OK;
  while (buffer != NULL && code == Z_OK && capacity <= 2 * (size_t)SCENE_BYTES_MOST) {
    zlib.next_out = (unsigned char *)buffer + made;
    zlib.avail_out = (unsigned)(capacity - 1 - made);
    code = inflate(&zlib, Z_NO_FLUSH);
    made = capacity - 1 - zlib.avail_out;
    if (code != Z_OK || zlib.avail_out > 0) continue;
    char *larger = hl_reallocate(context, buffer, capacity * 2, 1);
    if (larger == NULL) hl_release(context, buffer);
    buffer = larger;
    capacity *= 2;
  }
  inflateEnd(&zlib);
  if (buffer == NULL) return hl_fail_memory(error, capacity, name);
  if (code == Z_STREAM_END) {
    buffer[made] = 0;
    *text = buffer;
    return HL_OK;
  }
  hl_release(context, buffer);
  if (code == Z_OK)
    return hl_fail(error, HL_ERROR_INPUT, "%s: its scene has more than %d bytes", name, SCENE_BYTES_MOST);
  return hl_fail(error, HL_ERROR_INPUT, "%s: the scene in it is damaged: zlib data expected", name);
}

/* The text of a chunk whose keyword is found; body: what follows the keyword's zero byte. */
static hl_status take_text(hl_context *context, const char *name, const char *type, const unsigned char *body,
                           size_t length, char **text, hl_error *error) {
  if (memcmp(type, "tEXt", 4) == 0) return copy_text(context, name, body, length, text, error);
  if (memcmp(type, "zTXt", 4) == 0 && length > 1)
    return inflate_text(context, name, body + 1, length - 1, text, error);
  /* iTXt: whether compressed, the method, language and translated keyword, each ended by a zero byte */
  const unsigned char *language_end = length > 2 ? memchr(body + 2, 0, length - 2) : NULL;
  const unsigned char *end = body + length;
  const unsigned char *start = language_end != NULL
                                   ? memchr(language_end + 1, 0, (size_t)(end - language_end - 1))
                                   : NULL;
  if (start == NULL)
    return hl_fail(error, HL_ERROR_INPUT, "%s: the scene in it is damaged: its chunk is cut short", name);
  start++;
  return body[0] != 0 ? inflate_text(context, name, start, (size_t)(end - start), text, error)
                      : copy_text(context, name, start, (size_t)(end - start), text, error);
}

hl_status hl_image_find_scene(hl_context *context, const char *name, const void *file, size_t file_bytes,
                              char **text, hl_error *error) {
  if (context == NULL || name == NULL || file == NULL || text == NULL)
    return hl_fail(error, HL_ERROR_ARGUMENT,
                   "hl_image_find_scene: context, name, bytes and text must not be null");
  *text = NULL;
  const unsigned char *bytes = file;
  if (file_bytes < MARK_BYTES || memcmp(bytes, mark, MARK_BYTES) != 0)
    return hl_fail_offset(error, HL_ERROR_INPUT, 0,
                          "%s: byte 0: not a PNG picture, which alone carries a scene", name);
  for (size_t at = MARK_BYTES; file_bytes - at >= CHUNK_EXTRA_BYTES;) {
    size_t length = load_32(bytes + at), left = file_bytes - at - CHUNK_EXTRA_BYTES;
    if (length > left) break;
    const char *type = (const char *)bytes + at + 4;
    const unsigned char *body = bytes + at + 8;
    bool is_text = memcmp(type, "tEXt", 4) == 0 || memcmp(type, "zTXt", 4) == 0 ||
                   memcmp(type, "iTXt", 4) == 0;
    if (is_text && length >= sizeof keyword && memcmp(body, keyword, sizeof keyword) == 0) {
      if (crc32(crc32(0, NULL, 0), bytes + at + 4, (unsigned)(length + 4)) != load_32(body + length))
        return hl_fail_offset(error, HL_ERROR_INPUT, (int64_t)at,
                              "%s: byte %zu: the scene in it is damaged: its sum is wrong", name, at);
      return take_text(context, name, type, body + sizeof keyword, length - sizeof keyword, text, error);
    }
    at += length + CHUNK_EXTRA_BYTES;
  }
  return hl_fail(error, HL_ERROR_INPUT,
                 "%s: a picture without a scene in it: those that halflight render writes as .png have one",
                 name);
}
