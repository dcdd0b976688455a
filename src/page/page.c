/* page/page.c - writes a page that shows a scene without a server (halflight/page.h). The page's own script
 * unpacks the files in the page's elements (src/web/page/parts.js). */
#define _GNU_SOURCE
#include <halflight/page.h>

#include <errno.h>
#include <limits.h>
#include <string.h>
#include <zlib.h>

#include "core/door.h"
#include "core/file.h"
#include "core/memory.h"
#include "page/held.h"

enum { MOST_VIEWER_BYTES = 64 << 20, PACKED_BYTES = 3 << 14, GZIP_WINDOW = 15 + 16 };

static const char own_title[] = "<title>Halflight</title>", end_of_head[] = "</head>";

/* ---- elements ---- */

/* Writes bytes as base64 (RFC 4648). Except for the last bytes, count must be a multiple of 3. */
static void put_base64(FILE *out, const unsigned char *bytes, size_t count) {
  static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  for (size_t n = 0; n < count; n += 3) {
    unsigned second = n + 1 < count ? bytes[n + 1] : 0, third = n + 2 < count ? bytes[n + 2] : 0;
    unsigned all = (unsigned)bytes[n] << 16 | second << 8 | third;
    char four[4] = {digits[all >> 18], digits[all >> 12 & 63], n + 1 < count ? digits[all >> 6 & 63] : '=',
                    n + 2 < count ? digits[all & 63] : '='};
    fwrite(four, 1, sizeof four, out);
  }
}

static void put_text(FILE *out, const char *text) {
  for (; *text != '\0'; text++) {
    if (*text == '<') fputs("&lt;", out);
    else if (*text == '>') fputs("&gt;", out);
    else if (*text == '&') fputs("&amp;", out);
    else if (*text == '"') fputs("&quot;", out);
    else fputc(*text, out);
  }
}

/* Writes bytes packed by gzip, as base64. */
static hl_status put_packed(hl_context *context, FILE *out, const unsigned char *bytes, size_t count,
                            hl_error *error) {
  unsigned char *packed = hl_allocate(context, PACKED_BYTES, 1);
  z_stream stream = {0};
  if (packed == NULL ||
      deflateInit2(&stream, Z_BEST_COMPRESSION, Z_DEFLATED, GZIP_WINDOW, 8, Z_DEFAULT_STRATEGY) != Z_OK) {
    hl_release(context, packed);
    return hl_fail_memory(error, PACKED_BYTES, "a page's data");
  }
  stream.next_in = (unsigned char *)bytes;
  size_t left = count;
  int state;
  do { /* All pieces except the last are full, so that their lengths are multiples of 3. */
    stream.next_out = packed;
    stream.avail_out = PACKED_BYTES;
    do {
      if (stream.avail_in == 0) {
        stream.avail_in = left < UINT_MAX ? (uInt)left : UINT_MAX;
        left -= stream.avail_in;
      }
      state = deflate(&stream, left > 0 ? Z_NO_FLUSH : Z_FINISH);
    } while (state == Z_OK && stream.avail_out > 0);
    put_base64(out, packed, PACKED_BYTES - stream.avail_out);
  } while (state == Z_OK);
  deflateEnd(&stream);
  hl_release(context, packed);
  return HL_OK;
}

static hl_status put_element(hl_context *context, FILE *out, const char *name, const unsigned char *bytes,
                             size_t count, hl_error *error) {
  fputs("<script type=\"text/plain\" data-file=\"", out);
  put_text(out, name);
  fputs("\">", out);
  hl_status status = put_packed(context, out, bytes, count, error);
  fputs("</script>\n", out);
  return status;
}

static hl_status put_files(const held_scene *held, FILE *out, hl_error *error) {
  hl_status status = put_element(held->context, out, "scene.json", (const unsigned char *)held->text,
                                 strlen(held->text), error);
  for (size_t n = 0; n < held->count && status == HL_OK; n++) {
    unsigned char *bytes = NULL;
    size_t count = 0;
    status = hl_file_read(held->context, held->files[n].path, SIZE_MAX - 1, &bytes, &count, error);
    if (status == HL_OK) status = put_element(held->context, out, held->files[n].name, bytes, count, error);
    hl_release(held->context, bytes);
  }
  return status;
}

/* ---- the page ---- */

/* Finds the positions of the title and of the end of the head in the text of the viewer's page, which has no
 * scene yet. */
static hl_status find_places(const char *viewer, const char *text, const char **title, const char **end,
                             hl_error *error) {
  *title = strstr(text, own_title);
  *end = *title != NULL ? strstr(*title, end_of_head) : NULL;
  if (*end != NULL && strstr(text, "data-part=\"worker.js\"") != NULL) return HL_OK;
  return hl_fail(error, HL_ERROR_INPUT, "%s: is not the page halflight.html that scripts/web makes", viewer);
}

static hl_status write_page(const held_scene *held, const char *text, const char *title_at, const char *end,
                            const char *title, const char *path, hl_error *error) {
  hl_output output = {0};
  hl_status status = hl_output_begin(held->context, path, &output, error);
  if (status != HL_OK) return status;
  const char *rest = title_at + strlen(own_title);
  fwrite(text, 1, (size_t)(title_at - text), output.file);
  fputs("<title>", output.file);
  put_text(output.file, title);
  fputs("</title>", output.file);
  fwrite(rest, 1, (size_t)(end - rest), output.file);
  status = put_files(held, output.file, error);
  fputs(end, output.file);
  if (status == HL_OK) return hl_output_commit(&output, error);
  hl_output_abort(&output);
  return status;
}

hl_status hl_scene_write_page(hl_context *context, const hl_scene *scene, const char *viewer,
                              const char *title, const char *path, hl_error *error) {
  HL_DOOR;
  if (context == NULL || scene == NULL || viewer == NULL || title == NULL || path == NULL)
    return hl_fail(error, HL_ERROR_ARGUMENT,
                   "hl_scene_write_page: null context, scene, viewer, title or path");
  held_scene held = {0};
  unsigned char *bytes = NULL;
  size_t count = 0;
  const char *title_at, *end;
  hl_status status = hl_file_read(context, viewer, MOST_VIEWER_BYTES, &bytes, &count, error);
  const char *text = (const char *)bytes;
  if (status == HL_OK) status = find_places(viewer, text, &title_at, &end, error);
  if (status == HL_OK) {
    status = held_scene_make(context, scene, &held, error);
    if (status == HL_OK) status = write_page(&held, text, title_at, end, title, path, error);
    held_scene_end(&held);
  }
  hl_release(context, bytes);
  return status;
}
