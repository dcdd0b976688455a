/* volume/io/bundle.h - makes one input of many files: a folder, a zip archive, or a store on a server.
 *
 * The files of a folder are the files in the folder and in the folders below it, down to a greatest depth and
 * up to a greatest number. Symbolic links to folders, and links to files outside, are not followed. */
#ifndef HL_VOLUME_BUNDLE_H
#define HL_VOLUME_BUNDLE_H

#include "volume/io/source.h"

typedef struct hl_bundle_entry {
  char *name;          /* owned; path relative to the folder, with '/' between folders */
  uint64_t size;       /* in archives: the length of the unpacked file, as the archive states it */
  uint64_t packed, at; /* in archives: length of the packed file; position of the entry's own header */
  int method;          /* in archives: 0 for stored, 8 for deflated; other methods cannot be read */
} hl_bundle_entry;

typedef struct hl_bundle hl_bundle;

/* The files of a store that have been fetched from a server (bundle_server.c). */
typedef struct hl_brought hl_brought;

struct hl_bundle {
  hl_context *context;
  char *path; /* owned; path of the folder or the archive */
  bool is_archive, is_file, listed;
  bool is_open;                /* whether the descriptor `folder` is open, as after hl_bundle_find_ready() */
  int folder;                  /* owned; a folder's descriptor */
  const unsigned char *memory; /* borrowed; [memory_size]; the content of the archive or of the only file;
                                * null if the content is not in memory */
  size_t memory_size;
  hl_bundle_entry *entries; /* owned; [count], sorted by name; a folder's entries are found by
                             * hl_bundle_list() */
  size_t count, capacity;
  hl_brought *brought; /* owned; the fetched files of a store on a server; else null */
  size_t links_passed; /* number of links that are not followed, because they lead out of the folder or to
                        * folders */
  /* Opens an entry of an archive; hl_bundle_entry_open() calls this function. */
  hl_status (*open_entry)(const hl_bundle *bundle, const hl_bundle_entry *entry, bool quiet,
                          hl_source **source, hl_error *error);
};

enum { HL_BUNDLE_FILES_MOST = 200000, HL_BUNDLE_DEPTH_MOST = 24 };

/* Makes a bundle of a folder. path: an existing folder. */
hl_status hl_bundle_open_folder(hl_context *context, const char *path, hl_bundle *bundle, hl_error *error);
/* Makes a bundle of one file. The caller may set `memory` to the file's content. */
hl_status hl_bundle_of_file(hl_context *context, const char *path, hl_bundle *bundle, hl_error *error);
void hl_bundle_close(hl_bundle *bundle);

/* Finds the files of a folder. The caller calls hl_bundle_list() once. Archives do not need the call, because
 * their files are known already. */
hl_status hl_bundle_list(hl_bundle *bundle, hl_error *error);

/* Adds a copy of an entry and of its name. After the last entry, the caller must call hl_bundle_sort(). */
hl_status hl_bundle_add(hl_bundle *bundle, hl_bundle_entry entry, hl_error *error);
void hl_bundle_sort(hl_bundle *bundle);

/* Opens the file of an entry. quiet: as for hl_source_open(). Several threads may call hl_bundle_entry_open()
 * at the same time. */
hl_status hl_bundle_entry_open(const hl_bundle *bundle, const hl_bundle_entry *entry, bool quiet,
                               hl_source **source, hl_error *error);

/* Makes a bundle of a store on a server. The files of a server cannot be listed, but are found by their
 * names. */
hl_status hl_bundle_open_server(hl_context *context, const char *url, hl_bundle *bundle, hl_error *error);
static inline bool hl_bundle_is_on_server(const hl_bundle *bundle) { return bundle->brought != NULL; }
/* Returns whether an earlier request has found out whether the file exists, so that hl_bundle_find() does not
 * need the server. */
bool hl_bundle_has_brought(const hl_bundle *bundle, const char *name);
/* Fetches files of a server in one request. Files that were fetched before are left out. most: the greatest
 * length of a file in bytes. Only the caller's thread may call hl_bundle_bring(). */
hl_status hl_bundle_bring(const hl_bundle *bundle, const char *const *names, size_t count, uint64_t most,
                          hl_error *error);
/* Fetches parts of files in one request: of file names[n] the bytes of ranges[n]. The source of a file
 * (hl_bundle_find()) contains all parts of the file that were fetched. A server may send whole files instead,
 * of at most `most` bytes. Fails if a file has changed between two parts. Only the caller's thread may call
 * hl_bundle_bring_parts(). */
hl_status hl_bundle_bring_parts(const hl_bundle *bundle, const char *const *names,
                                const hl_fetch_range *ranges, size_t count, uint64_t most, hl_error *error);
/* Returns whether the server has this file, and only parts of the file were fetched. */
bool hl_bundle_has_parts(const hl_bundle *bundle, const char *name);
/* hl_bundle_brought_count() returns the number of files that were fetched so far. hl_bundle_forget() closes
 * all fetched files except the first `count`; no source of such a file may be open. */
size_t hl_bundle_brought_count(const hl_bundle *bundle);
void hl_bundle_forget(const hl_bundle *bundle, size_t count);
/* hl_bundle_find() and hl_bundle_close() call these two functions for a store on a server. */
hl_status hl_brought_find(const hl_bundle *bundle, const char *name, hl_source **source, hl_error *error);
void hl_brought_release(hl_bundle *bundle);

/* Prepares hl_bundle_find(). Afterwards several threads may call hl_bundle_find() at the same time. */
hl_status hl_bundle_find_ready(hl_bundle *bundle, hl_error *error);

/* Opens a file by its path relative to the folder, with '/' between folders. The file need not be listed. A
 * file of a store on a server must have been fetched before. *source is null if the file does not exist, or
 * if a link leads out of the folder.
 */
hl_status hl_bundle_find(const hl_bundle *bundle, const char *name, bool quiet, hl_source **source,
                         hl_error *error);

#endif
