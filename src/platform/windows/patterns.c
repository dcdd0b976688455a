/* platform/windows/patterns.c - finds files by a pattern (platform/windows/include/glob.h). */
#include <dirent.h>
#include <glob.h>
#include <limits.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Moves past "[...]" in a pattern; *fits: set to whether the set of characters in the brackets contains the
 * character. Returns null if the set has no closing bracket. */
static const char *match_set(const char *set, char c, bool *fits) {
  bool other = set[1] == '!' || set[1] == '^', in = false;
  const char *at = set + 1 + other;
  do {
    if (*at == '\0') return NULL;
    bool range = at[1] == '-' && at[2] != ']' && at[2] != '\0';
    in = in || (range ? *at <= c && c <= at[2] : *at == c);
    at += range ? 3 : 1;
  } while (*at != ']');
  *fits = in != other;
  return at + 1;
}

static char lower(char c) { return c >= 'A' && c <= 'Z' ? (char)(c - 'A' + 'a') : c; }

/* Returns whether a name fits a pattern. The case of the letters A to Z is ignored, as in the system's own
 * comparisons. */
static bool matches(const char *pattern, const char *name) {
  for (; *pattern != '\0'; name++) {
    if (*pattern == '*') {
      do
        if (matches(pattern + 1, name)) return true;
      while (*name++ != '\0');
      return false;
    }
    if (*name == '\0') return false;
    bool fits = *pattern == '?' || lower(*pattern) == lower(*name);
    const char *next = *pattern == '[' ? match_set(pattern, *name, &fits) : NULL;
    if (!fits) return false;
    pattern = next != NULL ? next : pattern + 1;
  }
  return *name == '\0';
}

static int add(glob_t *found, const char *path) {
  char **larger = realloc(found->gl_pathv, (found->gl_pathc + 1) * sizeof *larger);
  if (larger == NULL) return GLOB_NOSPACE;
  found->gl_pathv = larger;
  if ((larger[found->gl_pathc] = strdup(path)) == NULL) return GLOB_NOSPACE;
  found->gl_pathc++;
  return 0;
}

/* Finds the files of a folder that fit a pattern, and adds the files to `found`. path: [PATH_MAX]; its first
 * `length` characters are the folder's name with a '/', or "" for the current folder; the function appends
 * names to it. */
static int find(char *path, size_t length, const char *pattern, glob_t *found);

/* Continues a search at a file or folder `name` in the folder `path`. rest: the rest of the pattern, from the
 * '/' after this name on; "" at the pattern's end. */
static int go_on(char *path, size_t length, const char *name, const char *rest, glob_t *found) {
  int written = snprintf(path + length, PATH_MAX - length, "%s%s", name, rest[0] != '\0' ? "/" : "");
  if (written < 0 || (size_t)written >= PATH_MAX - length || access(path, F_OK) != 0) return 0;
  return rest[0] != '\0' ? find(path, length + (size_t)written, rest + 1, found) : add(found, path);
}

static int find(char *path, size_t length, const char *pattern, glob_t *found) {
  size_t part = strcspn(pattern, "/");
  char name[NAME_MAX + 1];
  if (part > NAME_MAX) return 0;
  memcpy(name, pattern, part);
  name[part] = '\0';
  if (strpbrk(name, "*?[") == NULL) return go_on(path, length, name, pattern + part, found);
  path[length] = '\0';
  DIR *folder = opendir(length > 0 ? path : ".");
  int result = 0;
  for (struct dirent *entry; folder != NULL && result == 0 && (entry = readdir(folder)) != NULL;)
    if ((entry->d_name[0] != '.' || name[0] == '.') && matches(name, entry->d_name))
      result = go_on(path, length, entry->d_name, pattern + part, found);
  if (folder != NULL) closedir(folder);
  return result;
}

int glob(const char *pattern, int flags, int (*on_error)(const char *, int), glob_t *found) {
  char path[PATH_MAX];
  (void)flags, (void)on_error;
  *found = (glob_t){0};
  int result = find(path, 0, pattern, found);
  return result != 0 ? result : found->gl_pathc == 0 ? GLOB_NOMATCH : 0;
}

void globfree(glob_t *found) {
  for (size_t n = 0; n < found->gl_pathc; n++) free(found->gl_pathv[n]);
  free(found->gl_pathv);
  *found = (glob_t){0};
}
