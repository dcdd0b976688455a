/* server/guard.c - checks whether a request is allowed. Every request must pass these checks before its body
 * is read. */
#define _GNU_SOURCE
#include <string.h>
#include <strings.h>

#include "parts.h"

/* Returns whether the text consists of one to five digits. */
static bool is_port(const char *text) {
  size_t digits = strspn(text, "0123456789");
  return digits >= 1 && digits <= 5 && text[digits] == '\0';
}

bool host_is_local(const char *host) {
  static const char *const names[] = {"127.0.0.1", "localhost", "[::1]"};
  if (host == NULL) return false;
  for (size_t n = 0; n < sizeof names / sizeof *names; n++) {
    size_t length = strlen(names[n]);
    if (strncasecmp(host, names[n], length) != 0) continue;
    const char *rest = host + length;
    if (rest[0] == '\0' || (rest[0] == ':' && is_port(rest + 1))) return true;
  }
  return false;
}

bool origin_is_own(const char *origin, const char *site, const char *host) {
  static const char scheme[] = "http://";
  if (origin == NULL) return true;
  if (strcmp(origin, "null") == 0) return site != NULL && strcmp(site, "same-origin") == 0;
  return strncmp(origin, scheme, sizeof scheme - 1) == 0 && strcasecmp(origin + sizeof scheme - 1, host) == 0;
}

const char *path_after_token(const char *path, const char *token) {
  if (strnlen(path, TOKEN_DIGITS + 2) < TOKEN_DIGITS + 2 || path[0] != '/' || path[TOKEN_DIGITS + 1] != '/')
    return NULL;
  unsigned different = 0;
  for (int digit = 0; digit < TOKEN_DIGITS; digit++)
    different |= (unsigned char)path[1 + digit] ^ (unsigned char)token[digit];
  return different == 0 ? path + TOKEN_DIGITS + 2 : NULL;
}
