/* mesh/gltf.c - reads glTF 2.0 files, as text (.gltf) and binary (.glb): the triangles of the scene, with
 * normals, colours of vertices, and the base colours of materials. Textures, skins and animations are
 * ignored.
 *
 * The format's specification is Khronos Group, glTF 2.0 (ISO/IEC 12113:2022). */
#include "mesh/gltf.h"

#include <math.h>
#include <string.h>

#include "core/context.h"
#include "core/memory.h"
#include "core/vector.h"
#include "text/plain_json.h"

enum { DEEPEST_NODE = 100, MODE_TRIANGLES = 4, MODE_STRIP = 5, MODE_FAN = 6 };

typedef struct gltf_reader {
  gltf_file file;
  mesh_parts *parts;
  unsigned char *visited; /* owned; [nodes]; whether a node was visited; a node must have only one parent */
  bool has_normals, has_colors;
  hl_error *error;
} gltf_reader;

static hl_status refuse(const gltf_reader *reader, const char *what) {
  return hl_fail(reader->error, HL_ERROR_INPUT, "%s: %s", reader->file.path, what);
}

static const json_t *item(const gltf_reader *reader, const char *list, size_t index) {
  return json_array_get(json_object_get(reader->file.root, list), index);
}

/* Reads an array of numbers from a JSON object. Returns false if the key has no array of this length. */
static bool read_numbers(const json_t *object, const char *key, size_t count, double *numbers) {
  const json_t *list = json_object_get(object, key);
  if (json_array_size(list) != count) return false;
  for (size_t n = 0; n < count; n++) numbers[n] = json_number_value(json_array_get(list, n));
  return true;
}

/* ---- the place of a node ---- */

/* The rotation of a unit quaternion. */
static mat3 rotation_of(const double q[4]) {
  double x = q[0], y = q[1], z = q[2], w = q[3];
  return (mat3){{{1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)},
                 {2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)},
                 {2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)}}};
}

static affine3 place_of(const json_t *node) {
  double m[16], move[3] = {0, 0, 0}, turn[4] = {0, 0, 0, 1}, scale[3] = {1, 1, 1};
  if (read_numbers(node, "matrix", 16, m))
    return (affine3){
        mat3_from_columns((vec3){m[0], m[1], m[2]}, (vec3){m[4], m[5], m[6]}, (vec3){m[8], m[9], m[10]}),
        {m[12], m[13], m[14]}};
  (void)read_numbers(node, "translation", 3, move);
  (void)read_numbers(node, "rotation", 4, turn);
  (void)read_numbers(node, "scale", 3, scale);
  mat3 sized = {{{scale[0], 0, 0}, {0, scale[1], 0}, {0, 0, scale[2]}}};
  return (affine3){mat3_multiply(rotation_of(turn), sized), vec3_of(move)};
}

/* ---- triangles ---- */

/* Finds an attribute of a primitive. The attribute must have `least` to `most` components. *found: whether
 * the primitive has it. */
static hl_status find_attribute(gltf_reader *reader, const json_t *primitive, const char *name, int least,
                                int most, gltf_accessor *accessor, bool *found) {
  size_t index;
  *found = hl_gltf_index(json_object_get(primitive, "attributes"), name, &index);
  if (!*found) return HL_OK;
  hl_status status = hl_gltf_find_accessor(&reader->file, index, accessor, reader->error);
  if (status == HL_OK && (accessor->components < least || accessor->components > most))
    status = refuse(reader, "an attribute has another number of components than its name says");
  return status;
}

/* The base colour of a primitive's material, linear. The colour is opaque unless the material blends. */
static void base_color(const gltf_reader *reader, const json_t *primitive, double color[4]) {
  size_t index = 0;
  for (int c = 0; c < 4; c++) color[c] = 1;
  if (!hl_gltf_index(primitive, "material", &index)) return;
  const json_t *material = item(reader, "materials", index);
  (void)read_numbers(json_object_get(material, "pbrMetallicRoughness"), "baseColorFactor", 4, color);
}

static bool blends(const gltf_reader *reader, const json_t *primitive) {
  size_t index = 0;
  if (!hl_gltf_index(primitive, "material", &index)) return false;
  const char *mode = json_string_value(json_object_get(item(reader, "materials", index), "alphaMode"));
  return mode != NULL && strcmp(mode, "BLEND") == 0;
}

static void add_color(gltf_reader *reader, const json_t *primitive, const gltf_accessor *own, size_t first,
                      size_t count) {
  double base[4];
  bool opaque = !blends(reader, primitive);
  base_color(reader, primitive, base);
  for (size_t n = 0; n < count; n++)
    for (int c = 0; c < 4; c++) {
      double value = base[c];
      if (own != NULL && c < own->components) value *= hl_gltf_number(own, n, c) / hl_gltf_whole(own);
      reader->parts->colors[first + n][c] = (float)(c == 3 && opaque ? 1 : value);
    }
}

/* Adds the vertices of a primitive. Normals are turned by the inverse transpose of the node's transform. */
static void add_vertices(gltf_reader *reader, const gltf_accessor *positions, const gltf_accessor *normals,
                         affine3 place) {
  mesh_parts *parts = reader->parts;
  mat3 inverse = affine3_identity().linear;
  bool turns = mat3_invert(place.linear, &inverse);
  for (size_t n = 0; n < positions->count; n++) {
    size_t at = parts->vertex_count + n;
    vec3 p = {hl_gltf_number(positions, n, 0), hl_gltf_number(positions, n, 1),
              hl_gltf_number(positions, n, 2)};
    vec3_store(parts->positions[at], affine3_apply(place, p));
    if (!reader->has_normals) continue;
    vec3 normal = {0, 0, 0};
    if (normals != NULL && turns)
      normal = mat3_apply(mat3_transpose(inverse),
                          (vec3){hl_gltf_number(normals, n, 0), hl_gltf_number(normals, n, 1),
                                 hl_gltf_number(normals, n, 2)});
    vec3_store(parts->normals[at], normal);
  }
}

/* Adds the triangles that `count` corners make. indices: the vertex of each corner; if null, corner n is
 * vertex n. flipped: whether the node's transform is a mirror, which turns triangles over. */
static hl_status add_faces(gltf_reader *reader, const gltf_accessor *indices, size_t count, size_t vertices,
                           size_t mode, bool flipped) {
  mesh_parts *parts = reader->parts;
  uint32_t first = (uint32_t)parts->vertex_count;
  hl_status status = HL_OK;
  size_t faces = mode == MODE_TRIANGLES ? count / 3 : count < 3 ? 0 : count - 2;
  for (size_t f = 0; f < faces && status == HL_OK; f++) {
    size_t corner[3] = {f, f + 1, f + 2};
    if (mode == MODE_TRIANGLES)
      for (size_t i = 0; i < 3; i++) corner[i] = 3 * f + i;
    if (mode == MODE_FAN) corner[0] = 0;
    bool turned = flipped != (mode == MODE_STRIP && f % 2 == 1);
    for (int i = 0; i < 3; i++) {
      if (indices != NULL) corner[i] = (size_t)hl_gltf_number(indices, corner[i], 0);
      if (corner[i] >= vertices) return refuse(reader, "a triangle names a vertex that is not there");
    }
    status = hl_mesh_add_triangle(parts, first + (uint32_t)corner[0],
                                  first + (uint32_t)corner[turned ? 2 : 1],
                                  first + (uint32_t)corner[turned ? 1 : 2], reader->error);
  }
  return status;
}

/* Returns whether a primitive with compressed positions also has uncompressed positions in a buffer. Files
 * have these for programs that cannot decompress. */
static bool has_plain_positions(const gltf_reader *reader, const json_t *primitive) {
  size_t index;
  return hl_gltf_index(json_object_get(primitive, "attributes"), "POSITION", &index) &&
         json_object_get(item(reader, "accessors", index), "bufferView") != NULL;
}

static hl_status fail_compressed(const gltf_reader *reader, const char *extension) {
  bool draco = strstr(extension, "draco") != NULL;
  return hl_fail(
      reader->error, HL_ERROR_UNSUPPORTED,
      "%s: its meshes are compressed%s (%.60s), which is not read: save it without, or unpack it (%s)",
      reader->file.path,
      draco                                  ? " by Draco"
      : strstr(extension, "meshopt") != NULL ? " by meshopt"
                                             : "",
      extension, draco ? "gltf-transform copy, gltfpack, Blender" : "gltf-transform copy");
}

static hl_status add_primitive(gltf_reader *reader, const json_t *primitive, affine3 place) {
  gltf_accessor positions, normals, colors, indices;
  bool has_positions, has_normals, has_colors;
  size_t mode = MODE_TRIANGLES, index;
  (void)hl_gltf_index(primitive, "mode", &mode);
  const json_t *extensions = json_object_get(primitive, "extensions");
  if (json_object_get(extensions, "KHR_draco_mesh_compression") != NULL &&
      !has_plain_positions(reader, primitive))
    return fail_compressed(reader, "KHR_draco_mesh_compression");
  if (mode < MODE_TRIANGLES || mode > MODE_FAN) return HL_OK; /* points and lines are not shown */
  hl_status status = find_attribute(reader, primitive, "POSITION", 3, 3, &positions, &has_positions);
  if (status == HL_OK) status = find_attribute(reader, primitive, "NORMAL", 3, 3, &normals, &has_normals);
  if (status == HL_OK) status = find_attribute(reader, primitive, "COLOR_0", 3, 4, &colors, &has_colors);
  bool indexed = hl_gltf_index(primitive, "indices", &index);
  if (status == HL_OK && indexed)
    status = hl_gltf_find_accessor(&reader->file, index, &indices, reader->error);
  if (status != HL_OK || !has_positions) return status;
  if (indexed &&
      (indices.components != 1 || indices.type == 5126 || indices.type == 5120 || indices.type == 5122))
    return refuse(reader, "indices are no whole numbers from 0");
  if ((has_normals && normals.count < positions.count) || (has_colors && colors.count < positions.count))
    return refuse(reader, "an attribute is shorter than the positions");
  if (positions.count > UINT32_MAX - reader->parts->vertex_count)
    return refuse(reader, "has more than 2^32 vertices");
  status = hl_mesh_reserve_vertices(reader->parts, reader->parts->vertex_count + positions.count,
                                    reader->has_normals, reader->has_colors, reader->error);
  if (status != HL_OK) return status;
  add_vertices(reader, &positions, has_normals ? &normals : NULL, place);
  if (reader->has_colors)
    add_color(reader, primitive, has_colors ? &colors : NULL, reader->parts->vertex_count, positions.count);
  mat3 m = place.linear;
  bool flipped = vec3_dot(m.row[0], vec3_cross(m.row[1], m.row[2])) < 0;
  status = add_faces(reader, indexed ? &indices : NULL, indexed ? indices.count : positions.count,
                     positions.count, mode, flipped);
  reader->parts->vertex_count += positions.count;
  return status;
}

/* ---- the scene ---- */

static hl_status add_node(gltf_reader *reader, size_t index, affine3 place, int depth) {
  const json_t *node = item(reader, "nodes", index);
  size_t mesh;
  if (node == NULL || reader->visited[index] || depth > DEEPEST_NODE)
    return refuse(reader, "a node is not there, has two parents, or lies too deep");
  reader->visited[index] = 1;
  place = affine3_multiply(place, place_of(node));
  hl_status status = HL_OK;
  if (hl_gltf_index(node, "mesh", &mesh)) {
    const json_t *primitives = json_object_get(item(reader, "meshes", mesh), "primitives");
    for (size_t n = 0; n < json_array_size(primitives) && status == HL_OK; n++)
      status = add_primitive(reader, json_array_get(primitives, n), place);
  }
  const json_t *children = json_object_get(node, "children");
  for (size_t n = 0; n < json_array_size(children) && status == HL_OK; n++)
    status = add_node(reader, (size_t)json_integer_value(json_array_get(children, n)), place, depth + 1);
  return status;
}

/* Finds the attributes that at least one primitive has. All vertices then get these attributes. */
static void find_attributes(gltf_reader *reader) {
  const json_t *meshes = json_object_get(reader->file.root, "meshes");
  for (size_t m = 0; m < json_array_size(meshes); m++) {
    const json_t *primitives = json_object_get(json_array_get(meshes, m), "primitives");
    for (size_t p = 0; p < json_array_size(primitives); p++) {
      const json_t *primitive = json_array_get(primitives, p),
                   *own = json_object_get(primitive, "attributes");
      reader->has_normals = reader->has_normals || json_object_get(own, "NORMAL") != NULL;
      reader->has_colors = reader->has_colors || json_object_get(own, "COLOR_0") != NULL ||
                           json_object_get(primitive, "material") != NULL;
    }
  }
}

static hl_status add_scene(gltf_reader *reader) {
  size_t scene = 0, nodes = json_array_size(json_object_get(reader->file.root, "nodes"));
  const json_t *required = json_object_get(reader->file.root, "extensionsRequired");
  for (size_t n = 0; n < json_array_size(required); n++) {
    const char *name = json_string_value(json_array_get(required, n));
    if (name != NULL && (strstr(name, "draco") != NULL || strstr(name, "meshopt") != NULL))
      return fail_compressed(reader, name);
  }
  (void)hl_gltf_index(reader->file.root, "scene", &scene);
  const json_t *roots = json_object_get(item(reader, "scenes", scene), "nodes");
  reader->visited = hl_allocate_zeroed(reader->file.context, nodes, 1);
  if (reader->visited == NULL) return hl_fail_memory(reader->error, nodes, "nodes");
  find_attributes(reader);
  hl_status status = HL_OK;
  for (size_t n = 0; n < json_array_size(roots) && status == HL_OK; n++)
    status = add_node(reader, (size_t)json_integer_value(json_array_get(roots, n)), affine3_identity(), 0);
  return status;
}

/* ---- the file ---- */

static uint32_t word_at(const unsigned char *at) {
  return (uint32_t)at[0] | (uint32_t)at[1] << 8 | (uint32_t)at[2] << 16 | (uint32_t)at[3] << 24;
}

/* Returns whether a chunk that is a buffer begins at `at`. */
static bool is_buffer(mesh_text text, size_t at) {
  return text.length >= 8 && at <= text.length - 8 && memcmp(text.bytes + at + 4, "BIN", 4) == 0;
}

/* Finds the chunks of a GLB file: the JSON text, then a buffer. */
static hl_status find_chunks(gltf_reader *reader, mesh_text text, mesh_text *json) {
  enum { HEADER = 12, CHUNK = 8 };
  if (text.length < HEADER + CHUNK) return refuse(reader, "is too short for a GLB file");
  size_t length = word_at(text.bytes + HEADER), after = HEADER + CHUNK;
  if (length > text.length - after) return refuse(reader, "its JSON is cut short");
  *json = (mesh_text){text.bytes + after, length};
  size_t padded = after + (length + 3) / 4 * 4;
  /* some programs leave the padding before the buffer out */
  after = is_buffer(text, after + length) ? after + length : padded;
  if (after > text.length || text.length - after < CHUNK) return HL_OK;
  length = word_at(text.bytes + after);
  after += CHUNK;
  if (length > text.length - after) return refuse(reader, "its buffer is cut short");
  reader->file.chunk = (gltf_buffer){text.bytes + after, length, false};
  return HL_OK;
}

static hl_status parse(gltf_reader *reader, mesh_text json) {
  json_error_t told;
  reader->file.root = hl_plain_json_load((const char *)json.bytes, json.length, 0, &told);
  if (reader->file.root != NULL && json_is_object(reader->file.root)) return HL_OK;
  return hl_fail(reader->error, HL_ERROR_INPUT, "%s: is no JSON object: line %d: %.100s", reader->file.path,
                 told.line, told.text);
}

/* Warns about content of the file that is ignored. */
static void tell_passed(const gltf_reader *reader) {
  const json_t *root = reader->file.root;
  bool textures = json_array_size(json_object_get(root, "textures")) > 0;
  bool moves = json_array_size(json_object_get(root, "animations")) > 0 ||
               json_array_size(json_object_get(root, "skins")) > 0;
  if (textures || moves)
    hl_log(reader->file.context, HL_LOG_WARNING, "%s: %s%s%s", reader->file.path,
           textures ? "its textures are not shown: colours are its materials' and vertices'" : "",
           textures && moves ? "; " : "",
           moves ? "its animations and skins are not read: it is shown at rest" : "");
}

hl_status hl_mesh_read_gltf(mesh_text text, mesh_parts *parts, hl_error *error) {
  gltf_reader reader = {
      .file = {.context = parts->context, .path = parts->path}, .parts = parts, .error = error};
  mesh_text json = text;
  hl_status status = HL_OK;
  if (text.length >= 4 && memcmp(text.bytes, "glTF", 4) == 0) status = find_chunks(&reader, text, &json);
  if (status == HL_OK) status = parse(&reader, json);
  if (status == HL_OK) status = hl_gltf_read_buffers(&reader.file, error);
  if (status == HL_OK) status = add_scene(&reader);
  if (status == HL_OK) tell_passed(&reader);
  hl_gltf_release_buffers(&reader.file);
  hl_release(parts->context, reader.visited);
  json_decref(reader.file.root);
  return status;
}
