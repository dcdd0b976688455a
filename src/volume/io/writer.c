/* volume/io/writer.c - writes the headers of the formats in which volumes are saved.
 *
 * In: the grid of a volume. Out: the bytes of the file before the voxels, whose numbers have the native byte
 * order. The world of NIfTI is right-anterior-superior. The world of MetaImage is left-posterior-superior.
 * The coordinates of a grid of another anatomical space are converted, so that each voxel stays at its
 * position in the body. */
#define _GNU_SOURCE
#include "volume/io/writer.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "core/error.h"
#include "elementary/elementary.h"
#include "text/plain.h"
#include "volume/convert.h"
#include "volume/io/text.h"

#define TYPE(name) (1u << HL_VOXEL_##name)
enum {
  PLAIN_TYPES = TYPE(U8) | TYPE(I8) | TYPE(U16) | TYPE(I16) | TYPE(U32) | TYPE(I32) | TYPE(U64) | TYPE(I64) |
                TYPE(F32) | TYPE(F64),
  ALL_TYPES = PLAIN_TYPES | TYPE(F16),
  MRC_TYPES = TYPE(I8) | TYPE(I16) | TYPE(U16) | TYPE(F16) | TYPE(F32)
};

static bool is_little(void) {
  const uint16_t one = 1;
  return *(const unsigned char *)&one == 1;
}

__attribute__((format(printf, 2, 3))) static void add(hl_written_header *header, const char *format, ...) {
  va_list arguments;
  va_start(arguments, format);
  int length = hl_plain_vprint((char *)header->bytes + header->length, sizeof header->bytes - header->length,
                               format, arguments);
  va_end(arguments);
  header->length += (size_t)length;
}

static void put_word(hl_written_header *header, size_t at, int value) {
  int16_t word = (int16_t)value;
  memcpy(header->bytes + at, &word, sizeof word);
}
static void put_integer(hl_written_header *header, size_t at, size_t value) {
  uint32_t integer = (uint32_t)value;
  memcpy(header->bytes + at, &integer, sizeof integer);
}
static void put_real(hl_written_header *header, size_t at, double value) {
  float real = (float)value;
  memcpy(header->bytes + at, &real, sizeof real);
}

/* Rotates a grid about z by half a turn, which changes the signs of x and y. */
static void turn(hl_volume_description *grid) {
  for (int row = 0; row < 2; row++) {
    grid->origin[row] = 0 - grid->origin[row];
    for (int axis = 0; axis < 3; axis++) grid->axis[axis][row] = 0 - grid->axis[axis][row];
  }
}

/* Converts a grid to the format's anatomical space, if the grid states its own space. */
static void bring_into(hl_space wanted, hl_volume_description *grid) {
  if (grid->space == HL_SPACE_LAS) { /* LAS differs from RAS only in the sign of x */
    grid->origin[0] = 0 - grid->origin[0];
    for (int axis = 0; axis < 3; axis++) grid->axis[axis][0] = 0 - grid->axis[axis][0];
    grid->space = HL_SPACE_RAS;
  }
  if (grid->space != HL_SPACE_UNKNOWN && grid->space != wanted) turn(grid);
}

static void find_steps(const hl_volume_description *grid, double length[3], double unit[3][3]) {
  for (int axis = 0; axis < 3; axis++) {
    length[axis] = vec3_length(vec3_of(grid->axis[axis]));
    for (int row = 0; row < 3; row++) unit[axis][row] = grid->axis[axis][row] / length[axis];
  }
}

/* ---- NRRD ---- */

/* The name of a unit in NRRD's documentation, such as "mm". */
static const char *short_name(const char *unit) {
  if (strcmp(unit, "metre") == 0) return "m";
  if (strcmp(unit, "millimetre") == 0) return "mm";
  return strcmp(unit, "micrometre") == 0 ? "um" : "A";
}

static const char *nrrd_type(hl_voxel_type type) {
  return type == HL_VOXEL_F32 ? "float" : type == HL_VOXEL_F64 ? "double" : hl_voxel_type_name(type);
}

static hl_status make_nrrd(const char *path, const hl_volume_description *grid, hl_written_header *header,
                           hl_error *error) {
  static const char *const spaces[] = {[HL_SPACE_RAS] = "right-anterior-superior",
                                       [HL_SPACE_LPS] = "left-posterior-superior",
                                       [HL_SPACE_LAS] = "left-anterior-superior"};
  (void)path, (void)error;
  add(header, "NRRD0004\ntype: %s\ndimension: 3\n", nrrd_type(grid->type));
  if (grid->space == HL_SPACE_UNKNOWN) add(header, "space dimension: 3\n");
  else add(header, "space: %s\n", spaces[grid->space]);
  add(header, "sizes: %zu %zu %zu\nspace directions:", grid->dimensions[0], grid->dimensions[1],
      grid->dimensions[2]);
  for (int axis = 0; axis < 3; axis++)
    add(header, " (%.17g,%.17g,%.17g)", grid->axis[axis][0], grid->axis[axis][1], grid->axis[axis][2]);
  add(header, "\nspace origin: (%.17g,%.17g,%.17g)\n", grid->origin[0], grid->origin[1], grid->origin[2]);
  if (header->unit != NULL) {
    const char *unit = short_name(header->unit);
    add(header, "space units: \"%s\" \"%s\" \"%s\"\n", unit, unit, unit);
  }
  if (hl_voxel_type_bytes(grid->type) > 1) add(header, "endian: %s\n", is_little() ? "little" : "big");
  add(header, "encoding: gzip\n\n");
  return HL_OK;
}

/* ---- MetaImage ---- */

static hl_status make_metaimage(const char *path, const hl_volume_description *given,
                                hl_written_header *header, hl_error *error) {
  static const char *const types[] = {
      [HL_VOXEL_U8] = "MET_UCHAR",       [HL_VOXEL_I8] = "MET_CHAR",       [HL_VOXEL_U16] = "MET_USHORT",
      [HL_VOXEL_I16] = "MET_SHORT",      [HL_VOXEL_U32] = "MET_UINT",      [HL_VOXEL_I32] = "MET_INT",
      [HL_VOXEL_U64] = "MET_ULONG_LONG", [HL_VOXEL_I64] = "MET_LONG_LONG", [HL_VOXEL_F32] = "MET_FLOAT",
      [HL_VOXEL_F64] = "MET_DOUBLE"};
  hl_volume_description grid = *given;
  double length[3], unit[3][3];
  (void)path, (void)error;
  bring_into(HL_SPACE_LPS, &grid);
  find_steps(&grid, length, unit);
  add(header, "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = %s\n",
      is_little() ? "False" : "True");
  add(header, "CompressedData = True\nCompressedDataSize = ");
  header->size_at = header->length;
  add(header, "%*s\nTransformMatrix =", HL_WRITER_SIZE_CHARACTERS, "");
  for (int axis = 0; axis < 3; axis++)
    for (int row = 0; row < 3; row++) add(header, " %.17g", unit[axis][row]);
  add(header, "\nOffset = %.17g %.17g %.17g\nCenterOfRotation = 0 0 0\n", grid.origin[0], grid.origin[1],
      grid.origin[2]);
  /* MetaIO calls LPS "RAI": its letters are the sides from which the axes come (right, anterior, inferior) */
  if (grid.space != HL_SPACE_UNKNOWN) add(header, "AnatomicalOrientation = RAI\n");
  add(header, "ElementSpacing = %.17g %.17g %.17g\nDimSize = %zu %zu %zu\n", length[0], length[1], length[2],
      grid.dimensions[0], grid.dimensions[1], grid.dimensions[2]);
  add(header, "ElementType = %s\nElementDataFile = LOCAL\n", types[grid.type]);
  return HL_OK;
}

/* ---- NIfTI-1: its header, nifti1.h of the NIfTI Data Format Working Group ---- */

static hl_status make_nifti(const char *path, const hl_volume_description *given, hl_written_header *header,
                            hl_error *error) {
  enum {
    DIM = 40,
    DATATYPE = 70,
    BITPIX = 72,
    PIXDIM = 76,
    VOX_OFFSET = 108,
    SCL_SLOPE = 112,
    XYZT_UNITS = 123,
    SFORM_CODE = 254,
    SROW = 280,
    MAGIC = 344,
    HEADER_BYTES = 348,
    METRES = 1,
    MILLIMETRES = 2,
    MICROMETRES = 3,
    SCANNER = 1
  };
  static const int codes[] = {
      [HL_VOXEL_U8] = 2,    [HL_VOXEL_I8] = 256, [HL_VOXEL_U16] = 512,  [HL_VOXEL_I16] = 4,
      [HL_VOXEL_U32] = 768, [HL_VOXEL_I32] = 8,  [HL_VOXEL_U64] = 1280, [HL_VOXEL_I64] = 1024,
      [HL_VOXEL_F32] = 16,  [HL_VOXEL_F64] = 64};
  hl_volume_description grid = *given;
  for (int axis = 0; axis < 3; axis++)
    if (grid.dimensions[axis] > INT16_MAX)
      return hl_fail(error, HL_ERROR_ARGUMENT,
                     "%s: NIfTI holds %d voxels along an axis, not %zu: write .nrrd", path, INT16_MAX,
                     grid.dimensions[axis]);
  bring_into(HL_SPACE_RAS, &grid);
  header->length = HEADER_BYTES + 4; /* four zeros after the header mean that the file has no extensions */
  put_integer(header, 0, HEADER_BYTES);
  put_word(header, DIM, 3);
  put_word(header, DATATYPE, codes[grid.type]);
  put_word(header, BITPIX, 8 * (int)hl_voxel_type_bytes(grid.type));
  put_real(header, PIXDIM, 1);
  put_real(header, VOX_OFFSET, HEADER_BYTES + 4);
  put_real(header, SCL_SLOPE, 1);
  if (header->unit == NULL) header->bytes[XYZT_UNITS] = grid.space != HL_SPACE_UNKNOWN ? MILLIMETRES : 0;
  else if (strcmp(header->unit, "metre") == 0) header->bytes[XYZT_UNITS] = METRES;
  else header->bytes[XYZT_UNITS] = strcmp(header->unit, "millimetre") == 0 ? MILLIMETRES : MICROMETRES;
  put_word(header, SFORM_CODE, SCANNER);
  for (int axis = 0; axis < 3; axis++) {
    put_word(header, DIM + 2 + 2 * (size_t)axis, (int)grid.dimensions[axis]);
    put_real(header, PIXDIM + 4 + 4 * (size_t)axis, vec3_length(vec3_of(grid.axis[axis])));
    for (int row = 0; row < 3; row++)
      put_real(header, SROW + 16 * (size_t)row + 4 * (size_t)axis, grid.axis[axis][row]);
    put_real(header, SROW + 16 * (size_t)axis + 12, grid.origin[axis]);
  }
  for (size_t more = 3; more < 7; more++) put_word(header, DIM + 2 + 2 * more, 1);
  memcpy(header->bytes + MAGIC, "n+1", 4);
  return HL_OK;
}

/* ---- VTK's image data ---- */

static hl_status make_vti(const char *path, const hl_volume_description *grid, hl_written_header *header,
                          hl_error *error) {
  static const char *const types[] = {
      [HL_VOXEL_U8] = "UInt8",   [HL_VOXEL_I8] = "Int8",    [HL_VOXEL_U16] = "UInt16",
      [HL_VOXEL_I16] = "Int16",  [HL_VOXEL_U32] = "UInt32", [HL_VOXEL_I32] = "Int32",
      [HL_VOXEL_U64] = "UInt64", [HL_VOXEL_I64] = "Int64",  [HL_VOXEL_F32] = "Float32",
      [HL_VOXEL_F64] = "Float64"};
  const size_t *n = grid->dimensions;
  double length[3], unit[3][3];
  char extent[100];
  (void)path, (void)error;
  find_steps(grid, length, unit);
  snprintf(extent, sizeof extent, "0 %zu 0 %zu 0 %zu", n[0] - 1, n[1] - 1, n[2] - 1);
  add(header,
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"ImageData\" version=\"1.0\" byte_order=\"%s\" "
      "header_type=\"UInt64\">\n",
      is_little() ? "LittleEndian" : "BigEndian");
  add(header,
      "  <ImageData WholeExtent=\"%s\" Origin=\"%.17g %.17g %.17g\" Spacing=\"%.17g %.17g %.17g\" "
      "Direction=\"",
      extent, grid->origin[0], grid->origin[1], grid->origin[2], length[0], length[1], length[2]);
  for (int row = 0; row < 3; row++)
    for (int axis = 0; axis < 3; axis++) add(header, "%s%.17g", row + axis > 0 ? " " : "", unit[axis][row]);
  add(header, "\">\n    <Piece Extent=\"%s\">\n      <PointData Scalars=\"values\">\n", extent);
  add(header, "        <DataArray type=\"%s\" Name=\"values\" format=\"appended\" offset=\"0\"/>\n",
      types[grid->type]);
  add(header, "      </PointData>\n    </Piece>\n  </ImageData>\n  <AppendedData encoding=\"raw\">\n   _");
  uint64_t bytes = (uint64_t)n[0] * n[1] * n[2] * hl_voxel_type_bytes(grid->type);
  memcpy(header->bytes + header->length, &bytes, sizeof bytes);
  header->length += sizeof bytes;
  header->end = "\n  </AppendedData>\n</VTKFile>\n";
  return HL_OK;
}

/* ---- MRC2014 (Cheng et al., J. Struct. Biol. 192, 2015, table 1) ---- */

/* Returns whether the grid's axes have the directions of a crystal's cell: the first axis along X, the second
 * axis in the plane of X and Y. */
static bool is_cell(const hl_volume_description *grid) {
  const double(*axis)[3] = grid->axis;
  double flat = 1e-6 * vec3_length(vec3_of(axis[0]));
  return axis[0][0] > 0 && axis[1][1] > 0 && axis[2][2] > 0 && fabs(axis[0][1]) < flat &&
         fabs(axis[0][2]) < flat && fabs(axis[1][2]) < flat;
}

static double degrees_between(const double a[3], const double b[3]) {
  double cosine = vec3_dot(vec3_of(a), vec3_of(b)) / (vec3_length(vec3_of(a)) * vec3_length(vec3_of(b)));
  return cosine == 0 ? 90 : hl_acos(cosine) * 180 / HL_PI;
}

static hl_status make_mrc(const char *path, const hl_volume_description *grid, hl_written_header *header,
                          hl_error *error) {
  enum {
    MODE = 12,
    INTERVALS = 28,
    CELL = 40,
    ANGLES = 52,
    AXES = 64,
    DMIN = 76,
    GROUP = 88,
    VERSION = 108,
    ORIGIN = 196,
    MARK = 208,
    STAMP = 212,
    HEADER_BYTES = 1024,
    VOLUME = 1
  };
  static const int modes[] = {
      [HL_VOXEL_I8] = 0, [HL_VOXEL_I16] = 1, [HL_VOXEL_F32] = 2, [HL_VOXEL_U16] = 6, [HL_VOXEL_F16] = 12};
  if (!is_cell(grid))
    return hl_fail(error, HL_ERROR_UNSUPPORTED,
                   "%s: the volume's axes are turned in its world, which MRC cannot tell: write .nrrd, .nii, "
                   ".mha or .vti",
                   path);
  header->length = HEADER_BYTES;
  for (size_t axis = 0; axis < 3; axis++) {
    double length = vec3_length(vec3_of(grid->axis[axis])) * (double)grid->dimensions[axis];
    put_integer(header, 4 * axis, grid->dimensions[axis]);
    put_integer(header, INTERVALS + 4 * axis, grid->dimensions[axis]);
    put_real(header, CELL + 4 * axis, length);
    put_real(header, ANGLES + 4 * axis,
             degrees_between(grid->axis[(axis + 1) % 3], grid->axis[(axis + 2) % 3]));
    put_integer(header, AXES + 4 * axis, axis + 1);
    put_real(header, ORIGIN + 4 * axis, grid->origin[axis]);
  }
  put_integer(header, MODE, (size_t)modes[grid->type]);
  /* these values mean that the statistics are unknown: minimum 0, maximum -1, mean -2, deviation -1 */
  put_real(header, DMIN + 4, -1);
  put_real(header, DMIN + 8, -2);
  put_real(header, DMIN + 140, -1);
  put_integer(header, GROUP, VOLUME);
  put_integer(header, VERSION, 20140);
  memcpy(header->bytes + MARK, "MAP ", 4);
  memset(header->bytes + STAMP, is_little() ? 0x44 : 0x11, 2);
  return HL_OK;
}

/* ---- NumPy's format 1.0 (NEP 1): the axes are [k][j][i] ---- */

static hl_status make_npy(const char *path, const hl_volume_description *grid, hl_written_header *header,
                          hl_error *error) {
  enum { PREAMBLE_BYTES = 10, ALIGNMENT = 64 };
  static const char kinds[] = {
      [HL_VOXEL_U8] = 'u',  [HL_VOXEL_I8] = 'i',  [HL_VOXEL_U16] = 'u', [HL_VOXEL_I16] = 'i',
      [HL_VOXEL_U32] = 'u', [HL_VOXEL_I32] = 'i', [HL_VOXEL_U64] = 'u', [HL_VOXEL_I64] = 'i',
      [HL_VOXEL_F32] = 'f', [HL_VOXEL_F64] = 'f', [HL_VOXEL_F16] = 'f'};
  const size_t bytes = hl_voxel_type_bytes(grid->type), *n = grid->dimensions;
  (void)path, (void)error;
  memcpy(header->bytes, "\x93NUMPY\x01\x00", 8);
  header->length = PREAMBLE_BYTES;
  add(header, "{'descr': '%c%c%zu', 'fortran_order': False, 'shape': (%zu, %zu, %zu), }",
      bytes == 1    ? '|'
      : is_little() ? '<'
                    : '>',
      kinds[grid->type], bytes, n[2], n[1], n[0]);
  /* The header's text is padded with spaces and ends with a line feed, so that the voxels are aligned. */
  size_t end = (header->length + ALIGNMENT) / ALIGNMENT * ALIGNMENT;
  memset(header->bytes + header->length, ' ', end - header->length);
  header->bytes[end - 1] = '\n';
  header->length = end;
  header->bytes[8] = (unsigned char)((end - PREAMBLE_BYTES) & 0xff);
  header->bytes[9] = (unsigned char)((end - PREAMBLE_BYTES) >> 8);
  return HL_OK;
}

/* ---- TIFF 6.0: a page for each slice, with the voxels' lengths as ImageJ writes them ----
 *
 * The first page's directory is in the header, the pixels of all pages follow it, and the other pages'
 * directories follow the pixels. Since positions in a TIFF file have 32 bits, a file above 4 GB is written as
 * ImageJ writes it: with one page, whose description states the number of pictures that follow each other. */

enum { TIFF_ENTRIES = 14, TIFF_ENTRY_BYTES = 12, TIFF_HEADER_BYTES = 1024 };
/* positions in the header of the directory, of the two resolutions, and of the description */
enum { TIFF_DIRECTORY = 8, TIFF_RESOLUTIONS = 192, TIFF_DESCRIPTION = 208 };
/* the number of bytes of a directory, which holds the number of entries, the entries, and the position of the
 * next directory */
enum { TIFF_DIRECTORY_BYTES = 2 + TIFF_ENTRIES * TIFF_ENTRY_BYTES + 4 };

static uint64_t slice_bytes(const hl_volume_description *grid) {
  return (uint64_t)grid->dimensions[0] * grid->dimensions[1] * hl_voxel_type_bytes(grid->type);
}

/* The position of a page's directory after the voxels. Directories begin at even positions. */
static uint64_t directory_at(const hl_volume_description *grid, size_t page) {
  const uint64_t end = TIFF_HEADER_BYTES + slice_bytes(grid) * grid->dimensions[2];
  return end + end % 2 + (page - 1) * (uint64_t)TIFF_DIRECTORY_BYTES;
}

/* Returns whether all pages can have a directory, because the directories' positions fit into 32 bits. */
static bool has_all_pages(const hl_volume_description *grid) {
  return directory_at(grid, grid->dimensions[2]) <= UINT32_MAX;
}

/* Writes a page's directory. description: the text in the header, to which all pages point. */
static void put_directory(const hl_volume_description *grid, const char *description, size_t page,
                          unsigned char *bytes) {
  enum { SHORT = 3, LONG = 4, RATIONAL = 5, ASCII = 2 };
  const hl_voxel_type type = grid->type;
  const bool whole = type != HL_VOXEL_F16 && type != HL_VOXEL_F32 && type != HL_VOXEL_F64,
             is_signed = type == HL_VOXEL_I8 || type == HL_VOXEL_I16 || type == HL_VOXEL_I32 ||
                         type == HL_VOXEL_I64,
             last = page + 1 == grid->dimensions[2] || !has_all_pages(grid);
  const uint32_t next = last ? 0 : (uint32_t)directory_at(grid, page + 1),
                 height = (uint32_t)grid->dimensions[1];
  const struct {
    uint16_t tag, kind;
    uint32_t count, value;
  } entries[TIFF_ENTRIES] = {
      {256, LONG, 1, (uint32_t)grid->dimensions[0]},
      {257, LONG, 1, height},
      {258, SHORT, 1, 8 * (uint32_t)hl_voxel_type_bytes(type)}, /* bits of a sample */
      {259, SHORT, 1, 1},                                       /* no compression */
      {262, SHORT, 1, 1},                                       /* the value 0 is black */
      {270, ASCII, (uint32_t)strlen(description) + 1, TIFF_DESCRIPTION},
      {273, LONG, 1, (uint32_t)(TIFF_HEADER_BYTES + page * slice_bytes(grid))}, /* position of the pixels */
      {277, SHORT, 1, 1},                                                       /* samples of a pixel */
      {278, LONG, 1, height},                                                   /* rows of a strip */
      {279, LONG, 1, (uint32_t)slice_bytes(grid)},
      {282, RATIONAL, 1, TIFF_RESOLUTIONS},
      {283, RATIONAL, 1, TIFF_RESOLUTIONS + 8},
      {296, SHORT, 1, 1}, /* the resolution has no unit */
      {339, SHORT, 1,
       !whole      ? 3
       : is_signed ? 2
                   : 1}};
  const uint16_t count = TIFF_ENTRIES;
  memcpy(bytes, &count, sizeof count);
  for (size_t n = 0; n < TIFF_ENTRIES; n++) {
    unsigned char *at = bytes + 2 + n * TIFF_ENTRY_BYTES;
    const uint16_t word = (uint16_t)entries[n].value;
    memcpy(at, &entries[n].tag, 2);
    memcpy(at + 2, &entries[n].kind, 2);
    memcpy(at + 4, &entries[n].count, 4);
    if (entries[n].kind == SHORT) memcpy(at + 8, &word, 2);
    else memcpy(at + 8, &entries[n].value, 4);
  }
  memcpy(bytes + TIFF_DIRECTORY_BYTES - 4, &next, 4);
}

/* Writes the number of pixels in a length of 1 as a fraction of whole numbers of 32 bits. Derived: the larger
 * of the two numbers is near 2^31, so that the fraction's relative error is below 2^-31. Returns false if a
 * number of the fraction does not fit into 32 bits. */
static bool put_resolution(double spacing, unsigned char *bytes) {
  const double most = 0x1p31, pixels = 1 / spacing, below = pixels < 1 ? most : floor(most / pixels);
  const double above = pixels < 1 ? floor(most * pixels) : floor(pixels * below + 0.5);
  const double under = pixels < 1 ? floor(above * spacing + 0.5) : below;
  if (!(above >= 1 && under >= 1 && above <= UINT32_MAX && under <= UINT32_MAX)) return false;
  const uint32_t fraction[2] = {(uint32_t)above, (uint32_t)under};
  memcpy(bytes, fraction, sizeof fraction);
  return true;
}

static hl_status make_tiff(const char *path, const hl_volume_description *grid, hl_written_header *header,
                           hl_error *error) {
  double length[3], unit[3][3];
  const uint16_t mark = 42;
  const uint32_t first = TIFF_DIRECTORY;
  find_steps(grid, length, unit);
  if (slice_bytes(grid) > UINT32_MAX || grid->dimensions[0] > INT32_MAX || grid->dimensions[1] > INT32_MAX)
    return hl_fail(error, HL_ERROR_UNSUPPORTED,
                   "%s: a TIFF's page has less than 4 GiB: write .nrrd, or less by --crop or --shrink", path);
  memcpy(header->bytes, is_little() ? "II" : "MM", 2);
  memcpy(header->bytes + 2, &mark, sizeof mark);
  memcpy(header->bytes + 4, &first, sizeof first);
  if (!put_resolution(length[0], header->bytes + TIFF_RESOLUTIONS) ||
      !put_resolution(length[1], header->bytes + TIFF_RESOLUTIONS + 8))
    return hl_fail(error, HL_ERROR_UNSUPPORTED,
                   "%s: a TIFF states no voxels with edges of %.6g and %.6g: give a --unit, or write .nrrd",
                   path, length[0], length[1]);
  header->length = TIFF_DESCRIPTION;
  add(header, "ImageJ=1.54f\nimages=%zu\nslices=%zu\n", grid->dimensions[2], grid->dimensions[2]);
  if (header->unit != NULL) add(header, "unit=%s\n", short_name(header->unit));
  add(header, "spacing=%.17g\nloop=false\n", length[2]);
  put_directory(grid, (const char *)header->bytes + TIFF_DESCRIPTION, 0, header->bytes + TIFF_DIRECTORY);
  header->length = TIFF_HEADER_BYTES;
  return HL_OK;
}

static size_t make_tiff_piece(const hl_volume_description *grid, const hl_written_header *header, size_t n,
                              unsigned char bytes[HL_WRITER_HEADER_BYTES]) {
  if (!has_all_pages(grid) || n + 1 >= grid->dimensions[2]) return 0;
  const size_t gap = n > 0 ? 0 : slice_bytes(grid) * grid->dimensions[2] % 2;
  bytes[0] = 0;
  put_directory(grid, (const char *)header->bytes + TIFF_DESCRIPTION, n + 1, bytes + gap);
  return gap + TIFF_DIRECTORY_BYTES;
}

static hl_status make_raw(const char *path, const hl_volume_description *grid, hl_written_header *header,
                          hl_error *error) {
  (void)path, (void)grid, (void)header, (void)error;
  return HL_OK;
}

static const hl_writer writers[] = {
    {"NRRD", ".nrrd", HL_PACKING_GZIP_VOXELS, PLAIN_TYPES, make_nrrd, NULL,
     "metre|millimetre|micrometre|angstrom", NULL, NULL},
    {"NIfTI", ".nii", HL_PACKING_NONE, PLAIN_TYPES, make_nifti, NULL, "micrometre|millimetre|metre", NULL,
     "RAS"},
    {"NIfTI", ".nii.gz", HL_PACKING_GZIP_ALL, PLAIN_TYPES, make_nifti, NULL, "micrometre|millimetre|metre",
     NULL, "RAS"},
    {"MetaImage", ".mha", HL_PACKING_ZLIB_VOXELS, PLAIN_TYPES, make_metaimage, NULL, NULL, NULL, NULL},
    {"VTK .vti", ".vti", HL_PACKING_NONE, PLAIN_TYPES, make_vti, "space", NULL, NULL, NULL},
    {"MRC", ".mrc", HL_PACKING_NONE, MRC_TYPES, make_mrc, "space", "angstrom", NULL, NULL},
    {"MRC", ".mrc.gz", HL_PACKING_GZIP_ALL, MRC_TYPES, make_mrc, "space", "angstrom", NULL, NULL},
    {"TIFF", ".tif", HL_PACKING_NONE, ALL_TYPES, make_tiff, "origin", "micrometre|millimetre|metre",
     make_tiff_piece, NULL},
    {"TIFF", ".tiff", HL_PACKING_NONE, ALL_TYPES, make_tiff, "origin", "micrometre|millimetre|metre",
     make_tiff_piece, NULL},
    {"NumPy .npy", ".npy", HL_PACKING_NONE, ALL_TYPES, make_npy, "place", NULL, NULL, NULL},
    {"bare voxels", ".raw", HL_PACKING_NONE, ALL_TYPES, make_raw, "place", NULL, NULL, NULL},
    {"bare voxels", ".raw.gz", HL_PACKING_GZIP_ALL, ALL_TYPES, make_raw, "place", NULL, NULL, NULL},
};

const hl_writer *hl_writer_for(const char *path) {
  size_t length = strlen(path);
  for (size_t n = 0; n < sizeof writers / sizeof *writers; n++) {
    size_t tail = strlen(writers[n].ending);
    if (length > tail && hl_plain_equal(path + length - tail, writers[n].ending)) return &writers[n];
  }
  return NULL;
}

const hl_writer *hl_writer_at(size_t index) {
  return index < sizeof writers / sizeof *writers ? &writers[index] : NULL;
}

/* The exponent n of a unit that has 10^n metres. */
static int power_of(const char *unit) {
  if (hl_text_starts(unit, "metre")) return 0;
  if (hl_text_starts(unit, "centimetre")) return -2;
  if (hl_text_starts(unit, "millimetre")) return -3;
  if (hl_text_starts(unit, "nanometre")) return -9;
  return hl_text_starts(unit, "micrometre") ? -6 : -10;
}

const char *hl_written_unit(const hl_writer *writer, const char *unit, double *factor) {
  static const double tens[] = {1, 10, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10};
  *factor = 1;
  if (unit == NULL || writer->units == NULL) return NULL;
  if (hl_text_is_one_of(unit, writer->units)) return unit;
  const char *first = hl_text_starts(writer->units, "angstrom") ? "angstrom" : "micrometre";
  int powers = power_of(unit) - power_of(first);
  *factor = powers >= 0 ? tens[powers] : 1 / tens[-powers];
  return first;
}
