/* tests/fuzz/corpus.c - runs a fuzz target over every file of a folder, as an ordinary test; results as TAP.
 *
 * A crash, a sanitizer's finding or a broken promise ends the program before its plan is fulfilled.
 */
#define _GNU_SOURCE
#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "target.h"

enum { MOST_BYTES = 1 << 20 };

static int is_input(const struct dirent *entry) { return entry->d_name[0] != '.'; }

/* The file is read into a block of its exact size, so that a sanitizer sees every read beyond it. */
static bool run(const char *folder, const char *name) {
  static uint8_t bytes[MOST_BYTES];
  char path[1024];
  snprintf(path, sizeof path, "%s/%s", folder, name);
  FILE *file = fopen(path, "rb");
  if (file == NULL) return false;
  size_t size = fread(bytes, 1, MOST_BYTES, file);
  bool whole = feof(file) != 0;
  fclose(file);
  uint8_t *exact = malloc(size > 0 ? size : 1);
  if (exact == NULL || !whole) return free(exact), false;
  memcpy(exact, bytes, size);
  LLVMFuzzerTestOneInput(exact, size);
  free(exact);
  return true;
}

int main(int argc, char **argv) {
  struct dirent **entries = NULL;
  int count = argc == 2 ? scandir(argv[1], &entries, is_input, alphasort) : -1;
  if (count <= 0) {
    printf("1..1\nnot ok 1 - a folder with inputs\n");
    return 1;
  }
  printf("1..%d\n", count);
  bool all = true;
  for (int n = 0; n < count; n++) {
    bool done = run(argv[1], entries[n]->d_name);
    printf("%s %d - %s\n", done ? "ok" : "not ok", n + 1, entries[n]->d_name);
    fflush(stdout);
    all = all && done;
    free(entries[n]);
  }
  free(entries);
  return all ? 0 : 1;
}
