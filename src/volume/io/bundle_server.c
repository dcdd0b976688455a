/* volume/io/bundle_server.c - opens the files of a store on a server. The context's `fetch` callback fetches
 * the files.
 *
 * Many files are fetched at a time, on the caller's thread. Fetched files stay open until hl_bundle_forget()
 * is called, so that any thread can read them. A file of which only parts are fetched has an entry for each
 * part. */
#include <string.h>
#include <unistd.h>

#include "core/context.h"
#include "core/memory.h"
#include "volume/io/bundle.h"

typedef struct brought_file {
  char *name; /* owned */
  hl_fetched_file file;
} brought_file;

struct hl_brought {
  brought_file *files; /* owned; [capacity] */
  size_t count, capacity;
};

hl_status hl_bundle_open_server(hl_context *context, const char *url, hl_bundle *bundle, hl_error *error) {
  *bundle = (hl_bundle){.context = context, .listed = true, .path = hl_copy_text(context, url)};
  if (bundle->path == NULL) return hl_fail_memory(error, strlen(url), url);
  bundle->brought = hl_allocate_zeroed(context, 1, sizeof *bundle->brought);
  if (bundle->brought == NULL) return hl_fail_memory(error, sizeof *bundle->brought, url);
  return context->options.fetch != NULL ? HL_OK
                                        : hl_fail(error, HL_ERROR_UNSUPPORTED,
                                                  "%s: a store on a server, and this host of the library "
                                                  "gave it no way to ask servers: give the folder of a copy",
                                                  url);
}

void hl_brought_release(hl_bundle *bundle) {
  if (bundle->brought == NULL) return;
  hl_bundle_forget(bundle, 0);
  hl_release(bundle->context, bundle->brought->files);
  hl_release(bundle->context, bundle->brought);
  bundle->brought = NULL;
}

size_t hl_bundle_brought_count(const hl_bundle *bundle) {
  return bundle->brought != NULL ? bundle->brought->count : 0;
}

void hl_bundle_forget(const hl_bundle *bundle, size_t count) {
  hl_brought *brought = bundle->brought;
  while (brought != NULL && brought->count > count) {
    brought_file *last = &brought->files[--brought->count];
    if (last->file.descriptor >= 0) close(last->file.descriptor);
    hl_release(bundle->context, last->name);
  }
}

/* Finds a fetched file by its name. The search begins at the end of the list, because the files that were
 * fetched last are needed most often. */
static const brought_file *find(const hl_brought *brought, const char *name) {
  for (size_t n = brought->count; n > 0; n--)
    if (strcmp(brought->files[n - 1].name, name) == 0) return &brought->files[n - 1];
  return NULL;
}

bool hl_bundle_has_brought(const hl_bundle *bundle, const char *name) {
  return find(bundle->brought, name) != NULL;
}

static hl_status make_room(const hl_bundle *bundle, size_t count, hl_error *error) {
  hl_brought *brought = bundle->brought;
  if (brought->count + count <= brought->capacity) return HL_OK;
  size_t capacity = 2 * (brought->count + count);
  brought_file *larger = hl_reallocate(bundle->context, brought->files, capacity, sizeof *larger);
  if (larger == NULL) return hl_fail_memory(error, capacity * sizeof *larger, "a list of files");
  brought->files = larger;
  brought->capacity = capacity;
  return HL_OK;
}

/* Checks that a file has not changed since earlier parts of it were fetched. */
static hl_status check_state(const hl_bundle *bundle, const char *name, const hl_fetched_file *file,
                             hl_error *error) {
  const brought_file *known = find(bundle->brought, name);
  if (known == NULL || ((known->file.descriptor < 0) == (file->descriptor < 0) &&
                        known->file.whole == file->whole && known->file.state == file->state))
    return HL_OK;
  return hl_fail(error, HL_ERROR_IO, "%s/%s: the server's file has changed while it was read: read it again",
                 bundle->path, name);
}

/* Adds fetched files to the list of known files, which takes over the files. If memory for the list is short,
 * files that do not fit are closed. */
static hl_status take(const hl_bundle *bundle, const char *const *names, size_t count,
                      const hl_fetched_file *files, hl_error *error) {
  hl_brought *brought = bundle->brought;
  hl_status status = HL_OK;
  for (size_t n = 0; n < count; n++) {
    if (status == HL_OK) status = check_state(bundle, names[n], &files[n], error);
    char *name = status == HL_OK ? hl_copy_text(bundle->context, names[n]) : NULL;
    if (name != NULL) brought->files[brought->count++] = (brought_file){name, files[n]};
    else if (files[n].descriptor >= 0) close(files[n].descriptor);
    if (name == NULL && status == HL_OK) status = hl_fail_memory(error, strlen(names[n]), "a list of files");
  }
  return status;
}

/* Requests files or parts of files from the server. ranges: [count]; null for whole files. */
static hl_status ask(const hl_bundle *bundle, const char *const *names, const hl_fetch_range *ranges,
                     size_t count, uint64_t most, hl_error *error) {
  const hl_context_options *options = &bundle->context->options;
  hl_error said = {0};
  hl_fetched_file *files = hl_allocate(bundle->context, count, sizeof *files);
  if (files == NULL) return hl_fail_memory(error, count * sizeof *files, "a list of files");
  for (size_t n = 0; n < count; n++) files[n] = (hl_fetched_file){.descriptor = -1};
  hl_status status = make_room(bundle, count, error);
  if (status == HL_OK) {
    status = options->fetch(options->user_data, bundle->path, names, ranges, count, most, files, &said);
    if (status != HL_OK) hl_fail(error, status, "%s", said.message);
  }
  for (size_t n = 0; n < count && status != HL_OK; n++)
    if (files[n].descriptor >= 0) close(files[n].descriptor);
  if (status == HL_OK) status = take(bundle, names, count, files, error);
  hl_release(bundle->context, files);
  return status;
}

hl_status hl_bundle_bring(const hl_bundle *bundle, const char *const *names, size_t count, uint64_t most,
                          hl_error *error) {
  size_t asked = 0;
  if (bundle->brought == NULL || count == 0) return HL_OK;
  const char **missing = hl_allocate(bundle->context, count, sizeof *missing);
  if (missing == NULL) return hl_fail_memory(error, count * sizeof *missing, "a list of files");
  for (size_t n = 0; n < count; n++)
    if (!hl_bundle_has_brought(bundle, names[n])) missing[asked++] = names[n];
  hl_status status = asked > 0 ? ask(bundle, missing, NULL, asked, most, error) : HL_OK;
  hl_release(bundle->context, missing);
  return status;
}

hl_status hl_bundle_bring_parts(const hl_bundle *bundle, const char *const *names,
                                const hl_fetch_range *ranges, size_t count, uint64_t most, hl_error *error) {
  return bundle->brought != NULL && count > 0 ? ask(bundle, names, ranges, count, most, error) : HL_OK;
}

static bool is_whole(const hl_fetched_file *file) { return file->begin == 0 && file->size == file->whole; }

bool hl_bundle_has_parts(const hl_bundle *bundle, const char *name) {
  const brought_file *known = find(bundle->brought, name);
  return known != NULL && known->file.descriptor >= 0 && !is_whole(&known->file);
}

/* Opens a file of which some parts were fetched. */
static hl_status open_parts(const hl_bundle *bundle, const char *name, uint64_t whole, hl_source **source,
                            hl_error *error) {
  const hl_brought *brought = bundle->brought;
  size_t count = 0;
  hl_source_part *parts = hl_allocate(bundle->context, brought->count, sizeof *parts);
  if (parts == NULL) return hl_fail_memory(error, brought->count * sizeof *parts, "a list of files");
  for (size_t n = 0; n < brought->count; n++) {
    const hl_fetched_file *file = &brought->files[n].file;
    if (file->descriptor < 0 || strcmp(brought->files[n].name, name) != 0) continue;
    parts[count++] = (hl_source_part){file->descriptor, file->begin, file->size};
  }
  hl_status status = hl_source_of_parts(bundle->context, bundle->path, parts, count, whole, source, error);
  hl_release(bundle->context, parts);
  return status;
}

hl_status hl_brought_find(const hl_bundle *bundle, const char *name, hl_source **source, hl_error *error) {
  const brought_file *known = find(bundle->brought, name);
  *source = NULL;
  if (known == NULL || known->file.descriptor < 0) return HL_OK;
  if (!is_whole(&known->file)) return open_parts(bundle, name, known->file.whole, source, error);
  return hl_source_of_descriptor(bundle->context, bundle->path, known->file.descriptor, known->file.size,
                                 source, error);
}
