/* server/folder.c - finds the files that a page may open: files below the folder in which the viewer was
 * started, and files that are dropped on the page. */
#define _GNU_SOURCE
#include <dirent.h>
#include <fcntl.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>

#include <halflight/formats.h>

#include "parts.h"
#include "platform/beneath.h"
#include "start/start.h"

enum { MOST_ENTRIES = 2000 };

/* Returns whether a name ends with one of some endings, after at least one other character. endings:
 * separated by blanks. *length: the name's length, which is replaced by the length without the ending. */
static bool ends_with_one(const char *name, size_t *length, const char *endings) {
  while (*(endings += strspn(endings, " ")) != '\0') {
    size_t end = strcspn(endings, " ");
    if (*length > end && strncasecmp(name + *length - end, endings, end) == 0) {
      *length -= end;
      return true;
    }
    endings += end;
  }
  return false;
}

/* Whether a name has an ending of the files that one of the formats reads. get: hl_volume_get_format() or a
 * function like it. */
static bool ends_as_read(const char *name, size_t *length, hl_status (*get)(size_t, hl_file_format *)) {
  hl_file_format format = {.struct_size = sizeof format};
  for (size_t f = 0; get(f, &format) == HL_OK; f++)
    if (format.reads && ends_with_one(name, length, format.read_endings)) return true;
  return false;
}

bool folder_can_open(const char *name) {
  size_t length = strlen(name);
  if (ends_with_one(name, &length, ".json .zip") || ends_as_read(name, &length, hl_volume_get_format) ||
      ends_as_read(name, &length, hl_mesh_get_format))
    return true;
  return ends_as_read(name, &length, hl_volume_get_packing) &&
         ends_as_read(name, &length, hl_volume_get_format);
}

static bool is_folder(const char *path) {
  struct stat about;
  return stat(path, &about) == 0 && S_ISDIR(about.st_mode);
}

/* Finds the absolute path of a file or folder below the server's folder. Returns false if it does not lie
 * there, after links were followed. */
static bool folder_resolve(const server *s, const char *inside, char path[PATH_BYTES]) {
  char asked[PATH_BYTES];
  const char *folder = s->options.folder;
  size_t length = strlen(folder);
  if (inside[0] == '/' || snprintf(asked, sizeof asked, "%s/%s", folder, inside) >= (int)sizeof asked ||
      realpath(asked, path) == NULL)
    return false;
  return strncmp(path, folder, length) == 0 && (path[length] == '\0' || path[length] == '/' || length == 1);
}

/* The part of a path of folder_resolve() that lies below the server's folder; "" for the folder itself. */
static const char *below_folder(const server *s, const char *path) {
  size_t length = strlen(s->options.folder);
  return path + (length == 1 ? 1 : length + (path[length] == '/'));
}

int folder_open(const server *s, const char *inside, int flags) {
  char path[PATH_BYTES];
  if (!folder_resolve(s, inside, path)) return -1;
  int folder = open(s->options.folder, O_PATH | O_DIRECTORY | O_CLOEXEC);
  int opened = folder >= 0 ? hl_beneath_open(folder, below_folder(s, path), flags) : -1;
  if (folder >= 0) close(folder);
  return opened;
}

bool folder_find(const server *s, const char *inside, char path[PATH_BYTES], server_file *file) {
  size_t length = strlen(s->options.folder);
  *file = (server_file){.name = "."};
  if (strncmp(inside, s->options.folder, length) == 0 && (length == 1 || inside[length] == '/'))
    inside += length == 1 ? 1 : length + 1; /* an absolute name */
  if (inside[0] == '\0' || !folder_resolve(s, inside, path)) return false;
  const char *below = below_folder(s, path);
  if (is_folder(path)) {
    file->folder = path;
    return hl_context_confine(s->below, below, &file->confined, NULL) == HL_OK;
  }
  if (!folder_can_open(inside)) return false;
  char *slash = strrchr(path, '/'); /* the last slash, before the file's name */
  *slash = '\0';
  file->name = slash + 1;
  file->folder = slash > path ? path : "/";
  return hl_context_confine(s->below, slash > below ? below : "", &file->confined, NULL) == HL_OK;
}

/* The letter by which a folder's list shows an entry: 'd' for a folder, 'f' for a file that can be opened,
 * and 0 for an entry that is not listed. */
static char kind_of(const server *s, const char *at, const char *name, off_t *bytes) {
  char inside[PATH_BYTES];
  struct stat about;
  bool fits = snprintf(inside, sizeof inside, "%s%s%s", at, at[0] != '\0' ? "/" : "", name) <
              (int)sizeof inside;
  int opened = name[0] != '.' && fits ? folder_open(s, inside, O_PATH) : -1;
  bool is_known = opened >= 0 && fstat(opened, &about) == 0;
  if (opened >= 0) close(opened);
  if (!is_known) return 0;
  *bytes = about.st_size;
  if (S_ISDIR(about.st_mode)) return 'd';
  return S_ISREG(about.st_mode) && folder_can_open(name) ? 'f' : 0;
}

static void put_entries(const server *s, FILE *out, const char *at, struct dirent **entries, int count) {
  const char *comma = "";
  for (int e = 0; e < count; e++) {
    off_t bytes = 0;
    char kind = kind_of(s, at, entries[e]->d_name, &bytes);
    if (kind == 0) continue;
    fprintf(out, "%s{\"folder\":%s,\"bytes\":%lld,\"name\":", comma, kind == 'd' ? "true" : "false",
            (long long)bytes);
    put_json_text(out, entries[e]->d_name);
    fputc('}', out);
    comma = ",";
  }
}

char *describe_folder(const server *s, const char *at) {
  char *text = NULL;
  size_t length = 0;
  struct dirent **entries = NULL;
  int folder = folder_open(s, at, O_RDONLY | O_DIRECTORY);
  if (folder < 0) return NULL;
  int count = scandirat(folder, ".", &entries, NULL, versionsort);
  close(folder);
  if (count < 0) return NULL;
  FILE *out = open_memstream(&text, &length);
  if (out != NULL) {
    fputs("{\"at\":", out);
    put_json_text(out, at);
    fputs(",\"entries\":[", out);
    put_entries(s, out, at, entries, count < MOST_ENTRIES ? count : MOST_ENTRIES);
    fputs("]}", out);
    if (fclose(out) != 0) {
      free(text);
      text = NULL;
    }
  }
  for (int e = 0; e < count; e++) free(entries[e]);
  free(entries);
  return text;
}

/* ---- files that are dropped ---- */

bool upload_folder(const char *name, server_upload *upload) {
  const char *folder = getenv("TMPDIR");
  if (folder == NULL || folder[0] != '/') folder = "/tmp";
  *upload = (server_upload){0};
  if (snprintf(upload->folder, sizeof upload->folder, "%s/halflight-view-XXXXXX", folder) >=
          (int)sizeof upload->folder ||
      mkdtemp(upload->folder) == NULL) {
    upload->folder[0] = '\0';
    return false;
  }
  snprintf(upload->path, sizeof upload->path, "%s/%s", upload->folder, name);
  return true;
}

bool upload_is_named(const char *name) {
  return folder_can_open(name) && strchr(name, '/') == NULL && name[0] != '.' && strlen(name) <= NAME_MAX;
}

bool upload_begin(const char *name, server_upload *upload) {
  if (!upload_folder(name, upload)) return false;
  upload->file = fopen(upload->path, "wbxe");
  if (upload->file == NULL) upload_end(upload);
  return upload->file != NULL;
}

bool upload_add(server_upload *upload, const char *bytes, size_t count) {
  if (upload->file == NULL || count > upload->room) return false;
  upload->room -= count;
  if (!upload->is_broken) upload->is_broken = fwrite(bytes, 1, count, upload->file) != count;
  return true;
}

bool upload_finish(server_upload *upload) {
  bool good = upload->file != NULL && fclose(upload->file) == 0 && !upload->is_broken;
  upload->file = NULL;
  return good;
}

void upload_end(server_upload *upload) {
  if (upload->file != NULL) fclose(upload->file);
  if (upload->path[0] != '\0') unlink(upload->path);
  if (upload->folder[0] != '\0') rmdir(upload->folder);
  *upload = (server_upload){0};
}
