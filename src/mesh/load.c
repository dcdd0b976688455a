/* mesh/load.c - hl_mesh_load: chooses the reader of a file by its content, or else by its name. */
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/context.h"
#include "core/door.h"
#include "core/endings.h"
#include "core/file.h"
#include "core/memory.h"
#include "mesh/mesh.h"
#include "volume/formats/vtk/legacy_arrays.h"
#include "volume/io/text.h"

static const struct {
  const char *name, *ending;
  mesh_reader *read;
} formats[] = {{"PLY", ".ply", hl_mesh_read_ply},          {"STL", ".stl", hl_mesh_read_stl},
               {"OBJ", ".obj", hl_mesh_read_obj},          {"glTF", ".gltf", hl_mesh_read_gltf},
               {"binary glTF", ".glb", hl_mesh_read_gltf}, {"VTK PolyData", ".vtp", hl_mesh_read_vtp},
               {"VTK .vtu", ".vtu", hl_mesh_read_vtp}};
enum { FORMAT_COUNT = sizeof formats / sizeof *formats };

hl_status hl_mesh_get_format(size_t index, hl_file_format *format) {
  if (format == NULL || format->struct_size != sizeof *format || index > FORMAT_COUNT)
    return HL_ERROR_ARGUMENT;
  /* the format after the last one of the table is .vtk; the content of a .vtk file tells whether it holds a
   * mesh or a volume */
  bool listed = index < FORMAT_COUNT;
  *format = (hl_file_format){
      .struct_size = sizeof *format, .name = listed ? formats[index].name : "VTK .vtk", .reads = 1};
  hl_endings_add(format->read_endings, listed ? formats[index].ending : ".vtk");
  format->writes = listed && hl_mesh_is_written(formats[index].ending);
  if (format->writes) hl_endings_add(format->written_endings, formats[index].ending);
  return HL_OK;
}

/* Returns whether a file's first bytes say that it is PolyData. Other .vtk files are volumes. */
static bool begins_as_polydata(hl_context *context, const char *path) {
  char bytes[1025];
  struct stat about;
  hl_error unused;
  int file;
  if (hl_file_open_again(context, path, &file, &unused) != HL_OK) return false;
  /* only regular files are looked at, because the bytes of a pipe can be read only once */
  bool regular = fstat(file, &about) == 0 && S_ISREG(about.st_mode);
  size_t length = 0, got = regular ? 1 : 0;
  for (; got > 0 && length < sizeof bytes - 1; length += got)
    if (hl_file_pull(context, file, path, bytes + length, sizeof bytes - 1 - length, &got, &unused) != HL_OK)
      got = 0;
  bytes[length] = 0;
  close(file);
  for (size_t n = 0; n + 16 < length; n++)
    if (hl_text_starts(bytes + n, "DATASET POLYDATA")) return true;
  return false;
}

int hl_mesh_reads_name(hl_context *context, const char *path) {
  if (context == NULL || path == NULL) return 0;
  for (size_t n = 0; n < FORMAT_COUNT; n++)
    if (hl_text_ends(path, formats[n].ending)) return 1;
  return hl_text_ends(path, ".vtk") && begins_as_polydata(context, path);
}

static mesh_reader *reader_of(const char *path, mesh_text text) {
  if (text.length >= 4 && memcmp(text.bytes, "ply", 3) == 0 && hl_is_space((char)text.bytes[3]))
    return hl_mesh_read_ply;
  if (text.length >= 4 && memcmp(text.bytes, "glTF", 4) == 0) return hl_mesh_read_gltf;
  if (hl_legacy_vtk_has_content(text.bytes, text.length)) return hl_mesh_read_legacy_vtk;
  for (size_t n = 0; n < FORMAT_COUNT; n++)
    if (hl_text_ends(path, formats[n].ending)) return formats[n].read;
  return hl_text_ends(path, ".vtk") ? hl_mesh_read_legacy_vtk : NULL;
}

hl_status hl_mesh_load(hl_context *context, const char *path, hl_mesh **mesh, hl_error *error) {
  HL_DOOR;
  if (context == NULL || path == NULL || mesh == NULL)
    return hl_fail(error, HL_ERROR_ARGUMENT, "hl_mesh_load: null context, path or mesh");
  *mesh = NULL;
  unsigned char *bytes = NULL;
  mesh_text text = {0};
  hl_status status = hl_file_read(context, path, SIZE_MAX - 1, &bytes, &text.length, error);
  if (status != HL_OK) return status;
  text.bytes = bytes;
  mesh_parts parts = {.context = context, .path = path};
  mesh_reader *reader = reader_of(path, text);
  if (reader == NULL)
    status = hl_fail(error, HL_ERROR_UNSUPPORTED,
                     "%s: is no mesh that is known: give .ply, .stl, .obj, .gltf, .glb, .vtp, .vtu or .vtk",
                     path);
  else status = reader(text, &parts, error);
  hl_release(context, bytes);
  if (status == HL_OK) status = hl_mesh_clip_polygons(&parts, error);
  if (status == HL_OK) {
    hl_error told;
    status = hl_mesh_of_parts(&parts, mesh, &told);
    if (status != HL_OK) hl_fail(error, status, "%s: %s", path, told.message);
  }
  hl_mesh_parts_release(&parts);
  return status;
}
