/* volume/io/bundle.c - lists and opens the files of a folder. bundle_zip.c lists and opens the files of an
 * archive. */
#define _GNU_SOURCE
#include "volume/io/bundle.h"

#include <dirent.h>
#include <fcntl.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/context.h"
#include "core/file.h"
#include "core/memory.h"
#include "platform/beneath.h"
#include "volume/io/bundle.h"

hl_status hl_bundle_open_folder(hl_context *context, const char *path, hl_bundle *bundle, hl_error *error) {
  *bundle = (hl_bundle){.context = context, .path = hl_copy_text(context, path)};
  return bundle->path != NULL ? HL_OK : hl_fail_memory(error, strlen(path), path);
}

hl_status hl_bundle_of_file(hl_context *context, const char *path, hl_bundle *bundle, hl_error *error) {
  hl_status status = hl_bundle_open_folder(context, path, bundle, error);
  bundle->is_file = bundle->listed = true;
  return status == HL_OK ? hl_bundle_add(bundle, (hl_bundle_entry){.name = (char *)path}, error) : status;
}

void hl_bundle_close(hl_bundle *bundle) {
  for (size_t n = 0; n < bundle->count; n++) hl_release(bundle->context, bundle->entries[n].name);
  hl_release(bundle->context, bundle->entries);
  hl_release(bundle->context, bundle->path);
  if (bundle->is_open) close(bundle->folder);
  hl_brought_release(bundle);
  *bundle = (hl_bundle){.context = bundle->context};
}

hl_status hl_bundle_add(hl_bundle *bundle, hl_bundle_entry entry, hl_error *error) {
  if (bundle->count == HL_BUNDLE_FILES_MOST)
    return hl_fail(error, HL_ERROR_INPUT, "%s: more than %d files: give a folder with fewer", bundle->path,
                   HL_BUNDLE_FILES_MOST);
  if (bundle->count == bundle->capacity) {
    size_t capacity = bundle->capacity > 0 ? 2 * bundle->capacity : 64;
    hl_bundle_entry *larger = hl_reallocate(bundle->context, bundle->entries, capacity, sizeof *larger);
    if (larger == NULL) return hl_fail_memory(error, capacity * sizeof *larger, "a list of files");
    bundle->entries = larger;
    bundle->capacity = capacity;
  }
  bundle->entries[bundle->count] = entry;
  bundle->entries[bundle->count].name = hl_copy_text(bundle->context, entry.name);
  if (bundle->entries[bundle->count].name == NULL)
    return hl_fail_memory(error, strlen(entry.name), "a list of files");
  bundle->count++;
  return HL_OK;
}

static int by_name(const void *a, const void *b) {
  return strcmp(((const hl_bundle_entry *)a)->name, ((const hl_bundle_entry *)b)->name);
}

void hl_bundle_sort(hl_bundle *bundle) {
  if (bundle->count > 0) qsort(bundle->entries, bundle->count, sizeof *bundle->entries, by_name);
  bundle->listed = true;
}

/* ---- a folder ---- */

typedef struct folder_walk {
  hl_bundle *bundle;
  char name[PATH_MAX]; /* path of the current entry, relative to the folder */
  dev_t device;        /* the folder's file system; folders on other file systems are not searched */
  size_t files, depth; /* files: number of entries of all kinds that were met so far */
} folder_walk;

/* Returns whether a name below the folder is a regular file, which is reached without a link that leads out
 * of the folder. */
static bool is_inside(const hl_bundle *bundle, const char *name, struct stat *about) {
  int file = hl_beneath_open(bundle->folder, name, O_PATH);
  bool inside = file >= 0 && fstat(file, about) == 0 && S_ISREG(about->st_mode);
  if (file >= 0) close(file);
  return inside;
}

static hl_status walk_folder(folder_walk *walk, hl_error *error);

static hl_status walk_entry(folder_walk *walk, hl_error *error) {
  hl_bundle *bundle = walk->bundle;
  struct stat about;
  bool known = fstatat(bundle->folder, walk->name, &about, AT_SYMLINK_NOFOLLOW) == 0;
  if (known && S_ISLNK(about.st_mode)) {
    known = is_inside(bundle, walk->name, &about);
    bundle->links_passed += !known;
  }
  if (!known) return HL_OK;
  if (S_ISDIR(about.st_mode)) return about.st_dev == walk->device ? walk_folder(walk, error) : HL_OK;
  hl_bundle_entry entry = {.name = walk->name, .size = about.st_size > 0 ? (uint64_t)about.st_size : 0};
  return S_ISREG(about.st_mode) ? hl_bundle_add(bundle, entry, error) : HL_OK;
}

static hl_status walk_entries(folder_walk *walk, DIR *folder, hl_error *error) {
  hl_bundle *bundle = walk->bundle;
  size_t length = strlen(walk->name);
  hl_status status = HL_OK;
  for (struct dirent *entry; status == HL_OK && (entry = readdir(folder)) != NULL;) {
    if (entry->d_name[0] == '.') continue;
    if (hl_cancelled(bundle->context))
      return hl_fail(error, HL_ERROR_CANCELLED, "%s: cancelled", bundle->path);
    if (++walk->files > 4 * (size_t)HL_BUNDLE_FILES_MOST)
      return hl_fail(error, HL_ERROR_INPUT, "%s: more than %d files and folders: give a folder with fewer",
                     bundle->path, 4 * HL_BUNDLE_FILES_MOST);
    if (length + strlen(entry->d_name) + 2 > sizeof walk->name) continue;
    if (length > 0) walk->name[length] = '/';
    strcpy(walk->name + length + (length > 0), entry->d_name);
    status = walk_entry(walk, error);
    walk->name[length] = 0;
  }
  return status;
}

/* Walks through a folder. Folders that cannot be opened, or that lie too deep, are ignored. */
static hl_status walk_folder(folder_walk *walk, hl_error *error) {
  hl_bundle *bundle = walk->bundle;
  if (walk->depth == HL_BUNDLE_DEPTH_MOST) return HL_OK;
  int descriptor = hl_beneath_open(bundle->folder, walk->name, O_RDONLY | O_DIRECTORY | O_NOFOLLOW);
  DIR *folder = descriptor >= 0 ? fdopendir(descriptor) : NULL;
  if (folder == NULL && descriptor >= 0) close(descriptor);
  if (folder == NULL) return HL_OK;
  walk->depth++;
  hl_status status = walk_entries(walk, folder, error);
  walk->depth--;
  closedir(folder);
  return status;
}

hl_status hl_bundle_list(hl_bundle *bundle, hl_error *error) {
  if (bundle->listed) return HL_OK;
  folder_walk *walk = hl_allocate_zeroed(bundle->context, 1, sizeof *walk);
  if (walk == NULL) return hl_fail_memory(error, sizeof *walk, bundle->path);
  walk->bundle = bundle;
  hl_status status = hl_bundle_find_ready(bundle, error);
  struct stat about;
  if (status == HL_OK && fstat(bundle->folder, &about) == 0) walk->device = about.st_dev;
  if (status == HL_OK) status = walk_folder(walk, error);
  hl_release(bundle->context, walk);
  hl_bundle_sort(bundle);
  return status;
}

hl_status hl_bundle_entry_open(const hl_bundle *bundle, const hl_bundle_entry *entry, bool quiet,
                               hl_source **source, hl_error *error) {
  *source = NULL;
  if (bundle->open_entry != NULL) return bundle->open_entry(bundle, entry, quiet, source, error);
  if (bundle->memory != NULL)
    return hl_source_of_memory(bundle->context, bundle->path, bundle->memory, bundle->memory_size, source,
                               error);
  if (bundle->is_file) return hl_source_open(bundle->context, entry->name, quiet, source, error);
  char *path = hl_path_join(bundle->context, bundle->path, entry->name);
  if (path == NULL) return hl_fail_memory(error, PATH_MAX, "a path");
  hl_status status = hl_source_open(bundle->context, path, quiet, source, error);
  hl_release(bundle->context, path);
  return status;
}

/* ---- a file of a known name ---- */

hl_status hl_bundle_find_ready(hl_bundle *bundle, hl_error *error) {
  if (bundle->is_archive || bundle->is_open || hl_bundle_is_on_server(bundle)) return HL_OK;
  hl_status status = hl_folder_open(bundle->context, bundle->path, &bundle->folder, error);
  bundle->is_open = status == HL_OK;
  return status;
}

static hl_status find_in_archive(const hl_bundle *bundle, const char *name, bool quiet, hl_source **source,
                                 hl_error *error) {
  const hl_bundle_entry wanted = {.name = (char *)name};
  if (bundle->count == 0) return HL_OK;
  const hl_bundle_entry *entry = bsearch(&wanted, bundle->entries, bundle->count, sizeof wanted, by_name);
  return entry != NULL ? hl_bundle_entry_open(bundle, entry, quiet, source, error) : HL_OK;
}

hl_status hl_bundle_find(const hl_bundle *bundle, const char *name, bool quiet, hl_source **source,
                         hl_error *error) {
  struct stat about;
  *source = NULL;
  if (bundle->is_archive) return find_in_archive(bundle, name, quiet, source, error);
  if (hl_bundle_is_on_server(bundle)) return hl_brought_find(bundle, name, source, error);
  if (!is_inside(bundle, name, &about)) return HL_OK;
  char *path = hl_path_join(bundle->context, bundle->path, name);
  if (path == NULL) return hl_fail_memory(error, PATH_MAX, "a path");
  hl_status status = hl_source_open(bundle->context, path, quiet, source, error);
  hl_release(bundle->context, path);
  return status;
}
