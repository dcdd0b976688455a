/* server/sessions.c - reads sessions that pages have saved below the viewer's folder.
 *
 * A session is a JSON object of the page (page/session.js). No other file is handed out. */
#define _GNU_SOURCE
#include <fcntl.h>
#include <jansson.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#include "parts.h"

enum { MOST_SESSION = 64 << 20 }; /* bytes; the small pictures of bookmarks are in it */

/* Reads a regular file and closes its descriptor. Returns null for anything else, or if there is no memory.
 * *length: its bytes. */
static char *read_regular(int descriptor, size_t *length) {
  struct stat about;
  if (descriptor < 0) return NULL;
  FILE *file = fstat(descriptor, &about) == 0 && S_ISREG(about.st_mode) && about.st_size <= MOST_SESSION
                   ? fdopen(descriptor, "rb")
                   : NULL;
  if (file == NULL) {
    close(descriptor);
    return NULL;
  }
  char *bytes = malloc((size_t)about.st_size + 1);
  *length = bytes != NULL ? fread(bytes, 1, (size_t)about.st_size, file) : 0;
  fclose(file);
  return bytes;
}

char *session_read(const server *s, const char *inside) {
  size_t length = 0;
  char *bytes = read_regular(folder_open(s, inside, O_RDONLY | O_NONBLOCK), &length);
  json_t *root = bytes != NULL ? json_loadb(bytes, length, 0, NULL) : NULL;
  char *text = json_is_integer(json_object_get(root, "halflight_session")) ? json_dumps(root, JSON_COMPACT)
                                                                           : NULL;
  json_decref(root);
  free(bytes);
  return text;
}
