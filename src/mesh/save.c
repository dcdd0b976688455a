/* mesh/save.c - hl_mesh_save: writes the triangles of a mesh as PLY (binary, little endian), STL (binary) or
 * OBJ. The files have the formats of the readers ply.c, stl.c and obj.c. */
#include <math.h>
#include <string.h>

#include "core/context.h"
#include "core/door.h"
#include "core/file.h"
#include "core/vector.h"
#include "image/srgb.h"
#include "mesh/mesh.h"
#include "text/plain.h"
#include "volume/io/text.h"

/* A mesh's file that is being written. hl_output_commit() detects short writes. */
typedef struct mesh_writing {
  const hl_mesh_description *mesh;
  FILE *file;
} mesh_writing;

static void put_byte(const mesh_writing *w, double fraction) {
  fputc((int)lround(255 * fmin(fmax(fraction, 0), 1)), w->file);
}

/* Writes a number in little endian. */
static void put_u32(const mesh_writing *w, uint32_t number) {
  for (int byte = 0; byte < 4; byte++) fputc((int)(number >> 8 * byte & 255), w->file);
}

static void put_floats(const mesh_writing *w, const float *values, int count) {
  for (int n = 0; n < count; n++) {
    uint32_t bits;
    memcpy(&bits, &values[n], sizeof bits);
    put_u32(w, bits);
  }
}

/* Writes a colour as bytes: sRGB and opacity. */
static void put_color(const mesh_writing *w, const float color[4]) {
  for (int c = 0; c < 3; c++) put_byte(w, hl_srgb_encode_number(fmax(color[c], 0)));
  put_byte(w, color[3]);
}

/* ---- PLY ---- */

static const char ply_colors[] =
    "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty uchar "
    "alpha\n";

static void write_ply(const mesh_writing *w) {
  const hl_mesh_description *mesh = w->mesh;
  fprintf(w->file, "ply\nformat binary_little_endian 1.0\ncomment Halflight %s\n", hl_version());
  fprintf(w->file, "element vertex %zu\nproperty float x\nproperty float y\nproperty float z\n",
          mesh->vertex_count);
  if (mesh->normals != NULL) fputs("property float nx\nproperty float ny\nproperty float nz\n", w->file);
  if (mesh->colors != NULL) fputs(ply_colors, w->file);
  fprintf(w->file, "element face %zu\nproperty list uchar uint vertex_indices\n", mesh->triangle_count);
  if (mesh->face_colors != NULL) fputs(ply_colors, w->file);
  fputs("end_header\n", w->file);
  for (size_t v = 0; v < mesh->vertex_count; v++) {
    put_floats(w, mesh->positions[v], 3);
    if (mesh->normals != NULL) put_floats(w, mesh->normals[v], 3);
    if (mesh->colors != NULL) put_color(w, mesh->colors[v]);
  }
  for (size_t t = 0; t < mesh->triangle_count; t++) {
    fputc(3, w->file);
    for (int corner = 0; corner < 3; corner++) put_u32(w, mesh->triangles[t][corner]);
    if (mesh->face_colors != NULL) put_color(w, mesh->face_colors[t]);
  }
}

/* ---- STL ---- */

static vec3 corner_of(const hl_mesh_description *mesh, size_t triangle, int corner) {
  const float *p = mesh->positions[mesh->triangles[triangle][corner]];
  return (vec3){p[0], p[1], p[2]};
}

static void write_stl(const mesh_writing *w) {
  const hl_mesh_description *mesh = w->mesh;
  char header[81];
  snprintf(header, sizeof header, "%-80s",
           "Halflight: binary STL"); /* a header must not begin with "solid" */
  fwrite(header, 1, 80, w->file);
  put_u32(w, (uint32_t)mesh->triangle_count);
  for (size_t t = 0; t < mesh->triangle_count; t++) {
    const vec3 a = corner_of(mesh, t, 0), b = corner_of(mesh, t, 1), c = corner_of(mesh, t, 2);
    float normal[3];
    vec3_store(normal, vec3_normalise(vec3_cross(vec3_subtract(b, a), vec3_subtract(c, a))));
    put_floats(w, normal, 3);
    for (int corner = 0; corner < 3; corner++) put_floats(w, mesh->positions[mesh->triangles[t][corner]], 3);
    fputc(0, w->file), fputc(0, w->file);
  }
}

/* ---- OBJ ---- */

static void write_row(const mesh_writing *w, const char *word, const float values[3]) {
  char line[100];
  hl_plain_print(line, sizeof line, "%s %.9g %.9g %.9g\n", word, values[0], values[1], values[2]);
  fputs(line, w->file);
}

static void write_obj(const mesh_writing *w) {
  const hl_mesh_description *mesh = w->mesh;
  fprintf(w->file, "# Halflight %s\n", hl_version());
  for (size_t v = 0; v < mesh->vertex_count; v++) write_row(w, "v", mesh->positions[v]);
  for (size_t v = 0; mesh->normals != NULL && v < mesh->vertex_count; v++)
    write_row(w, "vn", mesh->normals[v]);
  for (size_t t = 0; t < mesh->triangle_count; t++) {
    const uint32_t *corner = mesh->triangles[t];
    const unsigned long a = corner[0] + 1ul, b = corner[1] + 1ul, c = corner[2] + 1ul; /* counted from 1 */
    if (mesh->normals != NULL) fprintf(w->file, "f %lu//%lu %lu//%lu %lu//%lu\n", a, a, b, b, c, c);
    else fprintf(w->file, "f %lu %lu %lu\n", a, b, c);
  }
}

/* ---- all steps together ---- */

static const struct {
  const char *ending;
  void (*write)(const mesh_writing *w);
  bool keeps_colors;
} writers[] = {{".ply", write_ply, true}, {".stl", write_stl, false}, {".obj", write_obj, false}};
enum { WRITERS = sizeof writers / sizeof *writers };

bool hl_mesh_is_written(const char *ending) {
  for (size_t n = 0; n < WRITERS; n++)
    if (strcmp(writers[n].ending, ending) == 0) return true;
  return false;
}

/* Warns of everything that the file cannot hold. */
static void tell_of_losses(hl_context *context, const hl_mesh_description *mesh, const char *path,
                           bool keeps_colors) {
  if (mesh->sphere_count > 0)
    hl_log(context, HL_LOG_WARNING, "%s: %zu spheres are left out: the format has triangles", path,
           mesh->sphere_count);
  if (!keeps_colors && (mesh->colors != NULL || mesh->face_colors != NULL))
    hl_log(context, HL_LOG_WARNING, "%s: colours are left out: .ply keeps them", path);
}

hl_status hl_mesh_save(hl_context *context, const hl_mesh *mesh, const char *path, hl_error *error) {
  HL_DOOR;
  size_t index = 0;
  if (context == NULL || mesh == NULL || path == NULL)
    return hl_fail(error, HL_ERROR_ARGUMENT, "hl_mesh_save: null context, mesh or path");
  while (index < WRITERS && !hl_text_ends(path, writers[index].ending)) index++;
  if (index == WRITERS)
    return hl_fail(error, HL_ERROR_UNSUPPORTED,
                   "%s: no mesh is written under this name: give .ply, .stl or .obj", path);
  const hl_mesh_description *described = hl_mesh_describe(mesh);
  if (described->triangle_count == 0)
    return hl_fail(error, HL_ERROR_UNSUPPORTED, "%s: the mesh has no triangles: give a mesh that has some",
                   path);
  tell_of_losses(context, described, path, writers[index].keeps_colors);
  hl_output output;
  hl_status status = hl_output_begin(context, path, &output, error);
  if (status != HL_OK) return status;
  writers[index].write(&(mesh_writing){described, output.file});
  return hl_output_commit(&output, error);
}
