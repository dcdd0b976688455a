/* tests/unit/mesh_load.c - meshes from files and from memory: which are read, what is left out of them, and
 * which are refused. */
#define _GNU_SOURCE
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "../asserts.h"
#include "mesh/mesh.h"

static char folder[] = "/tmp/halflight-mesh-XXXXXX";

static int make_folder(void **state) {
  (void)state;
  return mkdtemp(folder) != NULL ? 0 : -1;
}
static int remove_folder(void **state) {
  (void)state;
  return rmdir(folder);
}

/* Loads a file that contains the text. mesh: null if the file must be refused, with `told` in the message. */
static hl_mesh *load(hl_context *context, const char *name, const char *text, size_t length,
                     const char *told) {
  char path[300];
  hl_mesh *mesh = NULL;
  hl_error error = {0};
  snprintf(path, sizeof path, "%s/%s", folder, name);
  FILE *file = fopen(path, "wb");
  assert_int_equal(fwrite(text, 1, length, file), length);
  fclose(file);
  hl_status status = hl_mesh_load(context, path, &mesh, &error);
  unlink(path);
  if (told == NULL && status != HL_OK) fail_msg("%s: %s", name, error.message);
  if (told != NULL) {
    assert_null(mesh);
    if (strstr(error.message, told) == NULL) fail_msg("%s: %s, not %s", name, error.message, told);
    assert_non_null(strstr(error.message, path));
  }
  return mesh;
}

#define PLY_HEAD(format) \
  "ply\nformat " format " 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
static const char PLY[] = PLY_HEAD("ascii") "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty "
                          "uchar alpha\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
                          "0 0 0 255 0 0 255\n2 0 0 0 255 0 51\n2 3 0 0 0 255 255\n0 3 1 188 188 188 255\n4 0 1 2 3\n";

static void test_ply(void **state) {
  (void)state;
  hl_context *context = NULL;
  assert_int_equal(hl_context_create(NULL, &context, NULL), HL_OK);
  hl_mesh *mesh = load(context, "a.ply", PLY, sizeof PLY - 1, NULL);
  const hl_mesh_description *d = hl_mesh_describe(mesh);
  assert_int_equal(d->vertex_count, 4);
  assert_int_equal(d->triangle_count, 2);
  assert_memory_equal(d->triangles[1], ((uint32_t[3]){0, 2, 3}), 12);
  assert_memory_equal(d->positions[3], ((float[3]){0, 3, 1}), 12);
  assert_true(d->colors[0][0] == 1 && d->colors[0][1] == 0 && d->colors[1][3] == 0.2f);
  /* the code 188 of sRGB is 0.503 in linear light */
  assert_true(d->colors[3][1] > 0.50f && d->colors[3][1] < 0.51f);
  double low[3], high[3];
  assert_int_equal(hl_mesh_get_box(mesh, low, high), HL_OK);
  assert_true(low[0] == 0 && high[0] == 2 && high[1] == 3 && high[2] == 1);
  assert_false(mesh->closed);
  hl_mesh_release(mesh);
  for (size_t length = 0; length < sizeof PLY - 9; length++) /* without the last face, the file is refused */
    assert_null(load(context, "a.ply", PLY, length, ""));
  assert_int_equal(hl_context_memory_held(context), 0);
  hl_context_destroy(context);
}

/* A file without faces is a cloud of points. Each point becomes a sphere whose radius is a 400th of the
 * diagonal of the points' box. */
static void test_ply_points(void **state) {
  (void)state;
  static const char text[] =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
      "property float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"
      "end_header\n0 0 0 255 0 0\n3 0 0 0 255 0\n0 4 12 0 0 255\n";
  hl_context *context = NULL;
  assert_int_equal(hl_context_create(NULL, &context, NULL), HL_OK);
  hl_mesh *mesh = load(context, "p.ply", text, sizeof text - 1, NULL);
  const hl_mesh_description *d = hl_mesh_describe(mesh);
  assert_int_equal(d->triangle_count, 0);
  assert_int_equal(d->sphere_count, 3);
  for (size_t n = 0; n < 3; n++) {
    assert_near(d->spheres[n][3], 13.0 / 400, 1e-7);
    for (size_t c = 0; c < 3; c++) assert_near(d->sphere_colors[n][c], c == n ? 1 : 0, 1e-7);
  }
  assert_true(d->spheres[2][0] == 0 && d->spheres[2][1] == 4 && d->spheres[2][2] == 12);
  hl_mesh_release(mesh);
  assert_int_equal(hl_context_memory_held(context), 0);
  hl_context_destroy(context);
}

/* A face with a colour gives it to the triangles made of it. A face without an opacity is opaque. */
static void test_ply_faces(void **state) {
  (void)state;
  static const char text[] = PLY_HEAD("ascii") "element face 2\nproperty list uchar int vertex_indices\nproperty uchar "
                             "red\nproperty uchar green\nproperty uchar blue\nend_header\n"
                             "0 0 0\n2 0 0\n2 3 0\n0 3 1\n4 0 1 2 3 255 0 188\n3 0 1 3 0 255 0\n";
  hl_context *context = NULL;
  assert_int_equal(hl_context_create(NULL, &context, NULL), HL_OK);
  hl_mesh *mesh = load(context, "f.ply", text, sizeof text - 1, NULL);
  const hl_mesh_description *d = hl_mesh_describe(mesh);
  assert_int_equal(d->triangle_count, 3);
  assert_null(d->colors);
  for (int t = 0; t < 2; t++) {
    assert_true(d->face_colors[t][0] == 1 && d->face_colors[t][1] == 0 && d->face_colors[t][3] == 1);
    assert_true(d->face_colors[t][2] > 0.50f && d->face_colors[t][2] < 0.51f);
  }
  assert_memory_equal(d->face_colors[2], ((float[4]){0, 1, 0, 1}), 16);
  hl_mesh_release(mesh);
  assert_int_equal(hl_context_memory_held(context), 0);
  hl_context_destroy(context);
}

/* The six faces of a cube: as an OBJ of quads, as ASCII STL, and turned inside out from memory. */
static void test_cube_is_closed(void **state) {
  (void)state;
  static const int faces[6][4] = {{1, 3, 4, 2}, {5, 6, 8, 7}, {1, 2, 6, 5},
                                  {3, 7, 8, 4}, {1, 5, 7, 3}, {2, 4, 8, 6}};
  char obj[2000] = "", stl[4000] = "solid cube\n";
  uint32_t turned[12][3];
  hl_context *context = NULL;
  assert_int_equal(hl_context_create(NULL, &context, NULL), HL_OK);
  for (int v = 0; v < 8; v++) sprintf(obj + strlen(obj), "v %d %d %d\n", v & 1, v >> 1 & 1, v >> 2);
  for (int f = 0; f < 6; f++) {
    const int *q = faces[f];
    sprintf(obj + strlen(obj), "f %d %d %d %d\n", q[0], q[1], q[2], q[3]);
    for (int t = 0; t < 2; t++) {
      const int corner[3] = {q[0], q[1 + t], q[2 + t]};
      sprintf(stl + strlen(stl), "facet normal 0 0 0\nouter loop\n");
      for (int i = 0; i < 3; i++) {
        int v = corner[i] - 1;
        sprintf(stl + strlen(stl), "vertex %d %d %d\n", v & 1, v >> 1 & 1, v >> 2);
        turned[2 * f + t][2 - i] = (uint32_t)v;
      }
      sprintf(stl + strlen(stl), "endloop\nendfacet\n");
    }
  }
  strcat(stl, "endsolid cube\n");
  hl_mesh *of_obj = load(context, "c.obj", obj, strlen(obj), NULL),
          *of_stl = load(context, "c.stl", stl, strlen(stl), NULL);
  assert_int_equal(hl_mesh_describe(of_stl)->vertex_count, 8);
  assert_int_equal(hl_mesh_describe(of_obj)->triangle_count, 12);
  assert_true(of_obj->closed && of_stl->closed);
  hl_mesh_description d = *hl_mesh_describe(of_obj);
  d.triangles = (const uint32_t(*)[3])turned;
  hl_mesh *inside_out = NULL, *open = NULL;
  assert_int_equal(hl_mesh_create(context, &d, &inside_out, NULL), HL_OK);
  d.triangle_count = 11;
  assert_int_equal(hl_mesh_create(context, &d, &open, NULL), HL_OK);
  assert_false(inside_out->closed || open->closed);
  hl_mesh *all[] = {of_obj, of_stl, inside_out, open};
  for (int i = 0; i < 4; i++) hl_mesh_release(all[i]);
  assert_int_equal(hl_context_memory_held(context), 0);
  hl_context_destroy(context);
}

/* A glTF file with one triangle: 36 bytes of positions and 6 of indices, in base64. */
#define GLTF(node, more)                                                                                  \
  "{\"asset\": {\"version\": \"2.0\"}, \"scenes\": [{\"nodes\": [0]}], \"nodes\": [" node                 \
  "], \"meshes\": "                                                                                       \
  "[{\"primitives\": [{\"attributes\": {\"POSITION\": 0}, \"indices\": 1, \"material\": 0}]}], "          \
  "\"materials\": "                                                                                       \
  "[{\"alphaMode\": \"BLEND\", \"pbrMetallicRoughness\": {\"baseColorFactor\": [0.5, 0.25, 0.125, "       \
  "0.75]}}], "                                                                                            \
  "\"buffers\": [{\"byteLength\": 42, \"uri\": "                                                          \
  "\"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAABAAIA\"}], " \
  "\"bufferViews\": [{\"buffer\": 0, \"byteLength\": 36}, {\"buffer\": 0, \"byteOffset\": 36, "           \
  "\"byteLength\": "                                                                                      \
  "6}], \"accessors\": [{\"bufferView\": 0, \"componentType\": 5126, \"count\": 3, \"type\": \"VEC3\"}, " \
  "{\"bufferView\": 1, \"componentType\": 5123, \"count\": 3, \"type\": \"SCALAR\"}]" more "}"

/* Nodes of glTF place their meshes. A mirror reverses triangles. Vertices get the base colour. */
static void test_gltf(void **state) {
  (void)state;
  static const char *const texts[] = {
      GLTF("{\"mesh\": 0, \"translation\": [1, 2, 3], \"scale\": [2, 2, 2]}", ""),
      GLTF("{\"mesh\": 0, \"matrix\": [2, 0, 0, 0, 0, 2, 0, 0, 0, 0, -2, 0, 1, 2, 3, 1]}", "")};
  hl_context *context = NULL;
  assert_int_equal(hl_context_create(NULL, &context, NULL), HL_OK);
  for (int k = 0; k < 2; k++) {
    hl_mesh *mesh = load(context, "a.gltf", texts[k], strlen(texts[k]), NULL);
    const hl_mesh_description *d = hl_mesh_describe(mesh);
    const float corners[3][3] = {{1, 2, 3}, {3, 2, 3}, {1, 4, 3}}, color[4] = {0.5f, 0.25f, 0.125f, 0.75f};
    assert_int_equal(d->triangle_count, 1);
    assert_memory_equal(d->positions, corners, sizeof corners);
    assert_memory_equal(d->colors[2], color, sizeof color);
    const uint32_t expected[2][3] = {{0, 1, 2}, {0, 2, 1}};
    assert_memory_equal(d->triangles[0], expected[k], sizeof expected[k]);
    hl_mesh_release(mesh);
  }
  hl_context_destroy(context);
}

/* A glTF file that is cut at any length, or with any byte changed, is read or refused, and does nothing else.
 */
static void test_damaged_gltf(void **state) {
  (void)state;
  char text[2000];
  const char *whole = GLTF("{\"mesh\": 0}", "");
  size_t length = strlen(whole);
  hl_context *context = NULL;
  assert_int_equal(hl_context_create(NULL, &context, NULL), HL_OK);
  for (size_t n = 0; n < length; n++)
    for (int way = 0; way < 3; way++) {
      memcpy(text, whole, length);
      if (way > 0) text[n] = (char)(text[n] + (way == 1 ? 1 : -7));
      mesh_parts parts = {.context = context, .path = "a.gltf"};
      hl_error error;
      (void)hl_mesh_read_gltf((mesh_text){(const unsigned char *)text, way == 0 ? n : length}, &parts,
                              &error);
      hl_mesh_parts_release(&parts);
    }
  assert_int_equal(hl_context_memory_held(context), 0);
  hl_context_destroy(context);
}

#define EMPTY_PIECE                                                                      \
  "<Piece NumberOfPoints=\"0\" NumberOfPolys=\"0\"><Points><DataArray type=\"Float32\" " \
  "NumberOfComponents=\"3\" format=\"ascii\"></DataArray></Points></Piece>"
#define FULL_PIECE                                                                                     \
  "<Piece NumberOfPoints=\"3\" NumberOfPolys=\"1\"><Points><DataArray type=\"Float32\" "               \
  "NumberOfComponents=\"3\" format=\"ascii\">0 0 0 1 0 0 0 2 0</DataArray></Points><Polys><DataArray " \
  "type=\"Int32\" Name=\"connectivity\" format=\"ascii\">0 1 2</DataArray><DataArray type=\"Int32\" "  \
  "Name=\"offsets\" format=\"ascii\">3</DataArray></Polys></Piece>"
#define VTP(pieces) "<VTKFile type=\"PolyData\"><PolyData>" pieces "</PolyData></VTKFile>"

/* Programs that write in parallel leave empty pieces before and after the full one. */
static void test_empty_pieces(void **state) {
  (void)state;
  static const char *const texts[] = {VTP(FULL_PIECE), VTP(EMPTY_PIECE FULL_PIECE),
                                      VTP(FULL_PIECE EMPTY_PIECE),
                                      VTP(EMPTY_PIECE EMPTY_PIECE FULL_PIECE EMPTY_PIECE)};
  hl_context *context = NULL;
  assert_int_equal(hl_context_create(NULL, &context, NULL), HL_OK);
  for (size_t t = 0; t < sizeof texts / sizeof *texts; t++) {
    hl_mesh *mesh = load(context, "a.vtp", texts[t], strlen(texts[t]), NULL);
    assert_int_equal(hl_mesh_describe(mesh)->triangle_count, 1);
    assert_true(hl_mesh_describe(mesh)->positions[2][1] == 2);
    hl_mesh_release(mesh);
  }
  assert_int_equal(hl_context_memory_held(context), 0);
  hl_context_destroy(context);
}

#define ARRAY(type, name, components, values)                                       \
  "<DataArray type=\"" type "\" Name=\"" name "\" NumberOfComponents=\"" components \
  "\" format=\"ascii\">" values "</DataArray>"
#define CELLS(kind, points, ends) \
  "<" kind ">" ARRAY("Int64", "connectivity", "1", points) ARRAY("Int64", "offsets", "1", ends) "</" kind ">"

/* Two pieces with a triangle each: the first also has a strip, and the second two single vertices. */
#define TWO_PIECES(first_data, second_data)                                                    \
  VTP("<Piece NumberOfPoints=\"4\" NumberOfPolys=\"1\" NumberOfStrips=\"1\"><Points>" ARRAY(   \
      "Float32", "p", "3", "0 0 0 1 0 0 0 1 0 1 1 0") "</Points>" CELLS("Polys", "0 1 2", "3") \
          CELLS("Strips", "1 3 2", "3") first_data                                             \
      "</Piece>" EMPTY_PIECE                                                                   \
      "<Piece NumberOfPoints=\"3\" NumberOfPolys=\"1\" NumberOfVerts=\"2\"><Points>" ARRAY(    \
          "Float64", "p", "3", "5 0 0 6 0 0 5 1 0") "</Points>" CELLS("Verts", "2 0", "1 2")   \
          CELLS("Polys", "2 1 0", "3") second_data "</Piece>")

/* All pieces become one mesh. The cells of each kind are in the pieces' order, and each keeps its colour. */
static void test_several_pieces(void **state) {
  (void)state;
  static const char text[] = TWO_PIECES(
      "<CellData Scalars=\"c\">" ARRAY("UInt8", "c", "3", "255 0 0 0 255 0") "</CellData>",
      "<CellData Scalars=\"c\">" ARRAY("UInt8", "c", "3", "0 0 0 0 0 255 255 255 255") "</CellData>");
  static const uint32_t triangles[3][3] = {{0, 1, 2}, {6, 5, 4}, {1, 3, 2}};
  static const float colors[3][4] = {{1, 0, 0, 1}, {1, 1, 1, 1}, {0, 1, 0, 1}},
                     sphere_colors[2][4] = {{0, 0, 0, 1}, {0, 0, 1, 1}};
  hl_context *context = NULL;
  assert_int_equal(hl_context_create(NULL, &context, NULL), HL_OK);
  hl_mesh *mesh = load(context, "a.vtp", text, strlen(text), NULL);
  const hl_mesh_description *d = hl_mesh_describe(mesh);
  assert_int_equal(d->vertex_count, 7);
  assert_true(d->positions[3][1] == 1 && d->positions[4][0] == 5 && d->positions[6][1] == 1);
  assert_int_equal(d->triangle_count, 3);
  assert_memory_equal(d->triangles, triangles, sizeof triangles);
  assert_memory_equal(d->face_colors, colors, sizeof colors);
  assert_int_equal(d->sphere_count, 2);
  assert_true(d->spheres[0][1] == 1 && d->spheres[1][0] == 5);
  assert_memory_equal(d->sphere_colors, sphere_colors, sizeof sphere_colors);
  hl_mesh_release(mesh);
  assert_int_equal(hl_context_memory_held(context), 0);
  hl_context_destroy(context);
}

/* Pieces at the end of a large file: each has a triangle at a place of its own. */
static void test_many_pieces(void **state) {
  (void)state;
  enum { PIECES = 1000 };
  static char text[PIECES * 600];
  size_t length = (size_t)sprintf(text, "<VTKFile type=\"PolyData\"><PolyData>");
  for (int n = 0; n < PIECES; n++)
    length += (size_t)sprintf(
        text + length,
        "<Piece NumberOfPoints=\"3\" NumberOfPolys=\"1\"><Points>" ARRAY(
            "Float32", "p", "3", "0 0 %d 1 0 %d 0 1 %d") "</Points>" CELLS("Polys", "0 1 2", "3") "</Piece>",
        n, n, n);
  length += (size_t)sprintf(text + length, "</PolyData></VTKFile>");
  hl_context *context = NULL;
  assert_int_equal(hl_context_create(NULL, &context, NULL), HL_OK);
  hl_mesh *mesh = load(context, "a.vtp", text, length, NULL);
  const hl_mesh_description *d = hl_mesh_describe(mesh);
  assert_int_equal(d->triangle_count, PIECES);
  for (uint32_t n = 0; n < PIECES; n++)
    for (uint32_t i = 0; i < 3; i++) {
      assert_int_equal(d->triangles[n][i], 3 * n + i);
      assert_true(d->positions[3 * n + i][2] == (float)n);
    }
  hl_mesh_release(mesh);
  assert_int_equal(hl_context_memory_held(context), 0);
  hl_context_destroy(context);
}

/* The scalars of all pieces share one range. Arrays of only one piece are refused, as is a cell that names a
 * point of another piece. */
static void test_arrays_of_pieces(void **state) {
  (void)state;
  static const char
      text[] = TWO_PIECES("<PointData Scalars=\"c\">" ARRAY("Float32", "c", "1", "0 1 2 3") "</PointData>",
                          "<PointData Scalars=\"c\">" ARRAY("Float32", "c", "1", "6 6 3") "</PointData>"),
      absent[] = TWO_PIECES("<PointData Scalars=\"c\">" ARRAY("Float32", "c", "1", "0 1 2 3") "</PointData>",
                            ""),
      other[] = TWO_PIECES("<PointData>" ARRAY("UInt8", "c", "3", "0 1 2 3 4 5 6 7 8 9 0 1") "</PointData>",
                           "<PointData>" ARRAY("UInt8", "c", "4", "0 1 2 3 4 5 6 7 8 9 0 1") "</PointData>"),
      foreign[] = VTP(FULL_PIECE "<Piece NumberOfPoints=\"3\" NumberOfPolys=\"1\"><Points>" ARRAY(
          "Float32", "p", "3", "0 0 0 1 0 0 0 1 0") "</Points>" CELLS("Polys", "-1 1 2", "3") "</Piece>");
  hl_context *context = NULL;
  assert_int_equal(hl_context_create(NULL, &context, NULL), HL_OK);
  hl_mesh *mesh = load(context, "a.vtp", text, strlen(text), NULL);
  const hl_mesh_description *d = hl_mesh_describe(mesh);
  assert_memory_equal(d->colors[3], d->colors[6], sizeof *d->colors);
  assert_memory_equal(d->colors[4], d->colors[5], sizeof *d->colors);
  assert_true(d->colors[0][2] < d->colors[3][2] &&
              d->colors[4][0] > 0.9f); /* the colormap viridis: violet, teal, yellow */
  hl_mesh_release(mesh);
  assert_null(load(context, "a.vtp", absent, strlen(absent), "its pieces differ in their arrays"));
  assert_null(load(context, "a.vtp", other, strlen(other), "its pieces differ in their arrays"));
  assert_null(load(context, "a.vtp", foreign, strlen(foreign), "a cell names point -1: there are 3"));
  assert_int_equal(hl_context_memory_held(context), 0);
  hl_context_destroy(context);
}

/* Normals of cells make a mesh flat: its vertices have no normals, so that triangles show their own. */
static void test_normals_of_cells(void **state) {
  (void)state;
#define CELL_NORMALS "<CellData Normals=\"n\">" ARRAY("Float32", "n", "3", "0 0 1 0 0 1") "</CellData>"
#define POINT_NORMALS \
  "<PointData Normals=\"n\">" ARRAY("Float32", "n", "3", "0 0 1 0 0 1 0 0 1 0 0 1") "</PointData>"
#define PIECE(data)                                                                                         \
  VTP("<Piece NumberOfPoints=\"4\" NumberOfPolys=\"2\"><Points>" ARRAY(                                     \
      "Float32", "p", "3", "0 0 0 1 0 0 0 1 0 1 1 0") "</Points>" CELLS("Polys", "0 1 2 1 3 2", "3 6") data \
      "</Piece>")
  static const char legacy[] =
      "# vtk DataFile Version 3.0\nt\nASCII\nDATASET POLYDATA\nPOINTS 3 float\n0 0 0 1 0 0 0 1 0\n"
      "POLYGONS 1 4\n3 0 1 2\nCELL_DATA 1\nNORMALS n float\n0 0 1\n";
  static const struct {
    const char *name, *text;
    bool has_normals;
    float z;
  } cases[] = {{"a.vtp", PIECE(""), false, 0},
               {"a.vtp", PIECE(CELL_NORMALS), true, 0},
               {"a.vtp", PIECE(CELL_NORMALS POINT_NORMALS), true, 1},
               {"a.vtk", legacy, true, 0}};
  hl_context *context = NULL;
  assert_int_equal(hl_context_create(NULL, &context, NULL), HL_OK);
  for (size_t c = 0; c < sizeof cases / sizeof *cases; c++) {
    hl_mesh *mesh = load(context, cases[c].name, cases[c].text, strlen(cases[c].text), NULL);
    const hl_mesh_description *d = hl_mesh_describe(mesh);
    assert_int_equal(d->normals != NULL, cases[c].has_normals);
    for (size_t v = 0; d->normals != NULL && v < d->vertex_count; v++)
      assert_true(d->normals[v][0] == 0 && d->normals[v][1] == 0 && d->normals[v][2] == cases[c].z);
    hl_mesh_release(mesh);
  }
  assert_int_equal(hl_context_memory_held(context), 0);
  hl_context_destroy(context);
}

static void test_refused(void **state) {
  (void)state;
  static const struct {
    const char *name, *text, *told;
  } cases[] = {
      {"a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n", "a.obj:4: a face names a vertex that is not there"},
      {"a.obj", "v 0 0\n", "a.obj:1: a vertex is three numbers"},
      {"a.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n", "the mesh has no triangle with an area"},
      {"a.stl", "solid x\nvertex 1 2 x\n", "a vertex is three numbers"},
      {"a.stl", "short", "is too short for an STL file"},
      {"a.ply", "ply\nformat ascii 1.0\nelement vertex 1\nproperty thing x\nend_header\n",
       "of an unknown type"},
      {"a.gltf", "[]", "is no JSON object"},
      {"a.glb", "glTF", "is too short for a GLB file"},
      {"a.gltf", GLTF("{\"mesh\": 0, \"children\": [0]}", ""), "a node is not there, has two parents"},
      {"a.gltf",
       "{\"scenes\": [{\"nodes\": [0]}], \"nodes\": [{\"mesh\": 0}], \"meshes\": [{\"primitives\": "
       "[{\"attributes\": {\"POSITION\": 0}}]}]}",
       "accessor 0 leads outside of the file's buffers"},
      {"a.gltf", "{\"buffers\": [{\"uri\": \"../secret\"}]}", "is no file beside it"},
      {"a.off", "OFF\n", "is no mesh that is known: give .ply, .stl, .obj, .gltf, .glb, .vtp, .vtu or .vtk"}};
  hl_context *context = NULL;
  assert_int_equal(hl_context_create(NULL, &context, NULL), HL_OK);
  for (size_t c = 0; c < sizeof cases / sizeof *cases; c++)
    assert_null(load(context, cases[c].name, cases[c].text, strlen(cases[c].text), cases[c].told));
  assert_int_equal(hl_context_memory_held(context), 0);
  hl_context_destroy(context);
}

/* Triangles that cannot be seen are left out. Triangles that name a missing vertex are refused. */
static void test_from_memory(void **state) {
  (void)state;
  const float positions[5][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {NAN, 0, 0}, {2, 0, 0}};
  const uint32_t triangles[4][3] = {{0, 1, 3}, {0, 1, 4}, {0, 1, 2}, {0, 1, 5}};
  hl_context *context = NULL;
  hl_mesh_description d;
  hl_mesh *mesh = NULL;
  hl_error error = {0};
  assert_int_equal(hl_context_create(NULL, &context, NULL), HL_OK);
  hl_mesh_description_defaults(&d);
  d.positions = positions, d.vertex_count = 5, d.triangles = triangles, d.triangle_count = 3;
  assert_int_equal(hl_mesh_create(context, &d, &mesh, NULL), HL_OK);
  assert_int_equal(hl_mesh_describe(mesh)->triangle_count, 1);
  assert_memory_equal(hl_mesh_describe(mesh)->triangles[0], triangles[2], sizeof triangles[2]);
  hl_mesh_release(mesh);
  d.triangle_count = 4;
  assert_int_equal(hl_mesh_create(context, &d, &mesh, &error), HL_ERROR_INPUT);
  assert_string_equal(error.message, "triangle 3 names vertex 5: the mesh has 5 vertices, counted from 0");
  assert_int_equal(hl_context_memory_held(context), 0);
  hl_context_destroy(context);
}

/* Tubes are closed. Lines of one point and lines without a radius are left out. Faces keep their colours. */
static void test_round(void **state) {
  (void)state;
  const float points[7][4] = {{0, 0, 0, 1}, {4, 0, 0, 1},   {4, 0, 0, 1},   {4, 4, 1, 1},
                              {9, 9, 9, 1}, {0, 0, NAN, 1}, {4, 4, 9, 0.5f}};
  const uint32_t lengths[3] = {4, 1, 2};
  const float spheres[3][4] = {{0, 0, 0, 2}, {0, 0, 0, 0}, {INFINITY, 0, 0, 1}};
  hl_context *context = NULL;
  hl_mesh_description d;
  hl_mesh *mesh = NULL;
  hl_error error = {0};
  assert_int_equal(hl_context_create(NULL, &context, NULL), HL_OK);
  hl_mesh_description_defaults(&d);
  d.line_points = points, d.line_point_count = 7, d.line_lengths = lengths, d.line_count = 3;
  d.spheres = spheres, d.sphere_count = 3;
  assert_int_equal(hl_mesh_create(context, &d, &mesh, &error), HL_OK);
  const hl_mesh_description *made = hl_mesh_describe(mesh);
  assert_int_equal(made->sphere_count, 1);
  assert_int_equal(made->line_count, 1);
  assert_int_equal(made->line_point_count, 3);
  assert_int_equal(made->triangle_count, 4 * 24 + 2 * 12); /* the two pieces have two rims and two ends */
  assert_true(mesh->closed);
  hl_mesh_release(mesh);
  d.line_point_count = 6;
  assert_int_equal(hl_mesh_create(context, &d, &mesh, &error), HL_ERROR_INPUT);
  assert_int_equal(hl_context_memory_held(context), 0);
  hl_context_destroy(context);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_ply),
                                     cmocka_unit_test(test_ply_points),
                                     cmocka_unit_test(test_ply_faces),
                                     cmocka_unit_test(test_cube_is_closed),
                                     cmocka_unit_test(test_empty_pieces),
                                     cmocka_unit_test(test_several_pieces),
                                     cmocka_unit_test(test_many_pieces),
                                     cmocka_unit_test(test_arrays_of_pieces),
                                     cmocka_unit_test(test_normals_of_cells),
                                     cmocka_unit_test(test_refused),
                                     cmocka_unit_test(test_from_memory),
                                     cmocka_unit_test(test_round),
                                     cmocka_unit_test(test_gltf),
                                     cmocka_unit_test(test_damaged_gltf)};
  return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
