/* fetch/moves.c - see moves.h. */
#define _GNU_SOURCE
#include "moves.h"

#include <string.h>

#include "text/plain.h"

/* The parts of a URL "scheme://user:password@host:port/...". */
typedef struct url_parts {
  bool secure;        /* whether the scheme is https */
  const char *server; /* host and port; borrowed */
  size_t length;      /* bytes of `server` */
} url_parts;

/* Reads the parts of a URL. Returns false if its scheme is neither http nor https. */
static bool read_parts(const char *url, url_parts *parts) {
  static const char plain[] = "http://", secure[] = "https://";
  parts->secure = hl_plain_equal_bytes(url, secure, sizeof secure - 1);
  if (!parts->secure && !hl_plain_equal_bytes(url, plain, sizeof plain - 1)) return false;
  const char *authority = url + (parts->secure ? sizeof secure : sizeof plain) - 1;
  size_t length = strcspn(authority, "/?#\\");
  const char *user = memrchr(authority, '@', length);
  parts->server = user != NULL ? user + 1 : authority;
  parts->length = length - (size_t)(parts->server - authority);
  return parts->length > 0;
}

bool move_is_allowed(const char *from, const char *to) {
  url_parts before, after;
  return read_parts(from, &before) && read_parts(to, &after) && (after.secure || !before.secure) &&
         before.length == after.length && hl_plain_equal_bytes(before.server, after.server, after.length);
}
