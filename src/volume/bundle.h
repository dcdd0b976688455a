/* volume/bundle.h - many files as one input: a folder, or a zip archive.
 *
 * A folder's files are those in it and in its folders, to a depth and a number that end every search.
 * Symbolic links to folders are not followed, nor links to files outside. */
#ifndef HL_VOLUME_BUNDLE_H
#define HL_VOLUME_BUNDLE_H

#include "volume/source.h"

typedef struct hl_bundle_entry {
  char *name;          /* owned; relative to the folder, with '/' */
  uint64_t size;       /* of archives: bytes as unpacked, as the archive claims */
  uint64_t packed, at; /* of archives: bytes as packed; position of the entry's own header */
  int method;          /* of archives: 0 stored, 8 deflated; others cannot be read */
} hl_bundle_entry;

typedef struct hl_bundle hl_bundle;

struct hl_bundle {
  hl_context *context;
  char *path; /* owned; of the folder or the archive */
  bool is_archive, is_file, listed;
  bool is_open; /* `folder` is open: hl_bundle_find_ready was called */
  int folder;   /* of a folder: its descriptor, owned */
  const unsigned char
      *memory; /* borrowed; [memory_size]: the content of the archive, or of the only file; null: in files */
  size_t memory_size;
  hl_bundle_entry *entries; /* owned; [count], sorted by name; a folder's are found by hl_bundle_list */
  size_t count, capacity;
  size_t links_passed; /* symbolic links that lead out of the folder or to folders */
  /* Of archives: hl_bundle_entry_open. */
  hl_status (*open_entry)(const hl_bundle *bundle, const hl_bundle_entry *entry, bool quiet,
                          hl_source **source, hl_error *error);
};

enum { HL_BUNDLE_FILES_MOST = 200000, HL_BUNDLE_DEPTH_MOST = 24 };

/* path: an existing folder. */
hl_status hl_bundle_open_folder(hl_context *context, const char *path, hl_bundle *bundle, hl_error *error);
/* A bundle of one file; the caller may set `memory` to its content. */
hl_status hl_bundle_of_file(hl_context *context, const char *path, hl_bundle *bundle, hl_error *error);
void hl_bundle_close(hl_bundle *bundle);

/* Finds a folder's files. Call it once; an archive's files are known without it. */
hl_status hl_bundle_list(hl_bundle *bundle, hl_error *error);

/* Add a copy of an entry and of its name, and sort the entries when all are added. */
hl_status hl_bundle_add(hl_bundle *bundle, hl_bundle_entry entry, hl_error *error);
void hl_bundle_sort(hl_bundle *bundle);

/* Opens the file of an entry. quiet: as for hl_source_open. May be called from several threads. */
hl_status hl_bundle_entry_open(const hl_bundle *bundle, const hl_bundle_entry *entry, bool quiet,
                               hl_source **source, hl_error *error);

/* Prepares hl_bundle_find, which then may be called from several threads. */
hl_status hl_bundle_find_ready(hl_bundle *bundle, hl_error *error);

/* Opens the file of that name (relative, with '/'), which need not be listed; *source is null where there is
 * none, or where a link leads out of the folder. */
hl_status hl_bundle_find(const hl_bundle *bundle, const char *name, bool quiet, hl_source **source,
                         hl_error *error);

#endif
