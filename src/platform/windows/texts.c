/* platform/windows/texts.c - implements BSD's function strsep(). */
#include <string.h>

char *strsep(char **text, const char *separators) {
  char *begin = *text;
  if (begin == NULL) return NULL;
  char *end = begin + strcspn(begin, separators);
  *text = *end != '\0' ? end + 1 : NULL;
  *end = '\0';
  return begin;
}
