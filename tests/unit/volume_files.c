/* tests/unit/volume_files.c - makes the files of volume_files.h. */
#define _GNU_SOURCE
#include "volume_files.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <zlib.h>

enum { TYPES = 10 };

static const hl_voxel_type all_types[TYPES] = {HL_VOXEL_U8,  HL_VOXEL_I8,  HL_VOXEL_U16, HL_VOXEL_I16,
                                               HL_VOXEL_U32, HL_VOXEL_I32, HL_VOXEL_F32, HL_VOXEL_F64,
                                               HL_VOXEL_U64, HL_VOXEL_I64};

/* The values are floats without rounding, and their bytes differ in both orders. */
double voxel_value(hl_voxel_type type, int n) {
  switch (type) {
    case HL_VOXEL_U8: return 23 * n;
    case HL_VOXEL_I8: return 23 * n - 128;
    case HL_VOXEL_U16: return 5957 * n;
    case HL_VOXEL_I16: return 5957 * n - 32768;
    case HL_VOXEL_U32: return 268435456.0 * n + 65536;
    case HL_VOXEL_I32: return 268435456.0 * (n - 7) + 65536;
    case HL_VOXEL_F32: return 0.25 * n - 1.5;
    case HL_VOXEL_F64: return 0.125 * n - 0.5;
    case HL_VOXEL_F16: return 0.25 * n - 1.5;
    case HL_VOXEL_U64: return 0x1p59 * n + 0x1p40;
    case HL_VOXEL_I64: return 0x1p59 * (n - 7) + 0x1p40;
  }
  return 0;
}

void add(byte_buffer *target, const void *source, size_t length) {
  assert_true(target->length + length <= sizeof target->data);
  memcpy(target->data + target->length, source, length);
  target->length += length;
}

void add_text(byte_buffer *target, const char *format, ...) {
  char text[2048];
  va_list arguments;
  va_start(arguments, format);
  int length = vsnprintf(text, sizeof text, format, arguments);
  va_end(arguments);
  assert_true(length >= 0 && (size_t)length < sizeof text);
  add(target, text, (size_t)length);
}

void add_integer(byte_buffer *target, uint64_t value, size_t length, bool big_endian) {
  unsigned char place[8];
  for (size_t n = 0; n < length; n++)
    place[big_endian ? length - 1 - n : n] = (unsigned char)(value >> (8 * n));
  add(target, place, length);
}

static void add_float(byte_buffer *target, double value, size_t length, bool big_endian) {
  uint64_t bits;
  if (length == 2) {
    /* of numbers that binary16 can hold: the float's exponent, and the first ten bits of its fraction */
    float narrow = (float)value;
    uint32_t wide;
    memcpy(&wide, &narrow, 4);
    bits = value == 0 ? 0 : (wide >> 16 & 0x8000) | (((wide >> 23 & 255) - 112) << 10) | (wide >> 13 & 0x3ff);
  } else if (length == 4) {
    float narrow = (float)value;
    uint32_t narrow_bits;
    memcpy(&narrow_bits, &narrow, 4);
    bits = narrow_bits;
  } else {
    memcpy(&bits, &value, 8);
  }
  add_integer(target, bits, length, big_endian);
}

void add_voxels(byte_buffer *target, hl_voxel_type type, bool big_endian) {
  for (int n = 0; n < VOXELS; n++)
    if (type == HL_VOXEL_F16 || type == HL_VOXEL_F32 || type == HL_VOXEL_F64)
      add_float(target, voxel_value(type, n), hl_voxel_type_bytes(type), big_endian);
    else add_integer(target, (uint64_t)(int64_t)voxel_value(type, n), hl_voxel_type_bytes(type), big_endian);
}

void add_voxels_as_text(byte_buffer *target, hl_voxel_type type, const char *separator) {
  for (int n = 0; n < VOXELS; n++)
    add_text(target, "%.20g%s", voxel_value(type, n), n % NI == NI - 1 ? "\n" : separator);
}

void add_base64(byte_buffer *target, const unsigned char *source, size_t length) {
  static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  for (size_t n = 0; n < length; n += 3) {
    uint32_t group = (uint32_t)source[n] << 16;
    if (n + 1 < length) group |= (uint32_t)source[n + 1] << 8;
    if (n + 2 < length) group |= source[n + 2];
    const char text[4] = {digits[group >> 18], digits[group >> 12 & 63],
                          n + 1 < length ? digits[group >> 6 & 63] : '=',
                          n + 2 < length ? digits[group & 63] : '='};
    add(target, text, 4);
  }
}

void add_compressed(byte_buffer *target, const unsigned char *source, size_t length, bool gzip) {
  z_stream zlib = {0};
  assert_int_equal(deflateInit2(&zlib, 9, Z_DEFLATED, gzip ? 15 + 16 : 15, 8, Z_DEFAULT_STRATEGY), Z_OK);
  zlib.next_in = (unsigned char *)source;
  zlib.avail_in = (unsigned)length;
  zlib.next_out = target->data + target->length;
  zlib.avail_out = (unsigned)(sizeof target->data - target->length);
  assert_int_equal(deflate(&zlib, Z_FINISH), Z_STREAM_END);
  target->length += zlib.total_out;
  deflateEnd(&zlib);
}

static void add_hex(byte_buffer *target, const byte_buffer *source) {
  for (size_t n = 0; n < source->length; n++) add_text(target, n % 2 ? "%02X\n" : "%02x", source->data[n]);
}

/* A sample with unit axes; the rest of its name describes it in failing tests. */
volume_sample begin_sample(hl_voxel_type type, const char *name, ...) {
  volume_sample made = {.type = type, .scale = 1, .axis = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  va_list arguments;
  va_start(arguments, name);
  vsnprintf(made.name, sizeof made.name, name, arguments);
  va_end(arguments);
  return made;
}

/* ---- raw ---- */

static void raw_samples(sample_function *function, void *data) {
  for (size_t t = 0; t < TYPES; t++)
    for (int big = 0; big < 2; big++)
      for (int gzip = 0; gzip < 2; gzip++) {
        volume_sample made = begin_sample(all_types[t], "a4x4_3x2x2_%s%s.raw%s",
                                          hl_voxel_type_name(all_types[t]), big ? "_be" : "",
                                          gzip ? ".gz" : "");
        byte_buffer voxels = {.length = 0};
        add_voxels(&voxels, made.type, big);
        if (gzip) add_compressed(&made.file, voxels.data, voxels.length, true);
        else made.file = voxels;
        function(&made, data);
      }
  volume_sample made = begin_sample(HL_VOXEL_U16, "described.dat");
  add_text(&made.file,
           "ObjectFileName: voxels.raw\r\nTaggedFileName: ---\r\nResolution: 3 2 2\r\n"
           "SliceThickness: 0.5 1 1.5\r\nFormat: USHORT\r\n\r\n");
  strcpy(made.other_name, "voxels.raw");
  add_voxels(&made.other, HL_VOXEL_U16, false);
  made.axis[0][0] = 0.5;
  made.axis[2][2] = 1.5;
  function(&made, data);
}

/* ---- VGStudio ---- */

static void vgi_samples(sample_function *function, void *data) {
  static const struct {
    hl_voxel_type type;
    const char *name;
    int bits;
  } types[] = {{HL_VOXEL_U8, "unsigned integer", 8},
               {HL_VOXEL_U16, "unsigned integer", 16},
               {HL_VOXEL_U32, "unsigned integer", 32},
               {HL_VOXEL_I8, "signed integer", 8},
               {HL_VOXEL_I16, "signed integer", 16},
               {HL_VOXEL_I32, "signed integer", 32},
               {HL_VOXEL_F32, "float", 32}};
  for (size_t n = 0; n < sizeof types / sizeof *types; n++) {
    volume_sample made = begin_sample(types[n].type, "part_%zu.vgi", n);
    add_text(&made.file,
             "{volume1}\r\n[representation]\r\nsize = 3 2 2\r\ndatatype = %s\r\nbitsperelement = %d\r\n"
             "[file1]\r\nSkipHeader = %d\r\nFileFormat = raw\r\nSize = 3 2 2\r\nName = part.vol\r\n"
             "Datatype = %s\r\nBitsPerElement = %d\r\n{volumeprimitive12}\r\n[geometry]\r\n"
             "resolution = 0.5 1 2\r\nunit = mm\r\n[volume]\r\nvolume = volume1\r\n",
             types[n].name, types[n].bits, n % 2 == 0 ? 0 : 7, types[n].name, types[n].bits);
    strcpy(made.other_name, "part.vol");
    if (n % 2 != 0) add_text(&made.other, "7 bytes");
    add_voxels(&made.other, types[n].type, false);
    made.axis[0][0] = 0.5;
    made.axis[2][2] = 2;
    function(&made, data);
  }
}

/* ---- NRRD ---- */

static const char *nrrd_type(hl_voxel_type type) {
  static const char *const names[] = {
      "",      "uchar",  "int8",   "unsigned short int", "signed short", "uint32_t", "int",
      "float", "double", "uint64", "long long"};
  return names[type];
}

static void place_obliquely(volume_sample *made) {
  static const double axes[3][3] = {{0.5, -0.25, 0}, {0.25, 1, 0.5}, {0, 0.125, -2}};
  static const double origin[3] = {-12.5, 3.25, 100};
  memcpy(made->axis, axes, sizeof axes);
  memcpy(made->origin, origin, sizeof origin);
}

static void add_nrrd_header(volume_sample *made, const char *line_end, const char *encoding, bool big) {
  static const char *const lines[] = {"NRRD0005",
                                      "# a comment",
                                      "Dimension: 3",
                                      "sizes:  3 2 2",
                                      "key:=value: not a field",
                                      "space: left-posterior-superior",
                                      "space directions: (0.5,-0.25,0) ( .25 , 1,5e-1) (0,0.125,-2)",
                                      "space origin: (-12.5,3.25,100)",
                                      "kinds: domain domain space",
                                      "units: \"mm\" \"mm\" \"mm\""};
  for (size_t n = 0; n < sizeof lines / sizeof *lines; n++) add_text(&made->file, "%s%s", lines[n], line_end);
  add_text(&made->file, "type: %s%sendian: %s%sencoding: %s%s", nrrd_type(made->type), line_end,
           big ? "big" : "little", line_end, encoding, line_end);
  place_obliquely(made);
}

static void add_nrrd_payload(volume_sample *made, byte_buffer *target, const char *encoding, bool big) {
  byte_buffer voxels = {.length = 0};
  add_voxels(&voxels, made->type, big);
  if (strcmp(encoding, "raw") == 0) add(target, voxels.data, voxels.length);
  if (strcmp(encoding, "gzip") == 0) add_compressed(target, voxels.data, voxels.length, true);
  if (strcmp(encoding, "hex") == 0) add_hex(target, &voxels);
  if (strcmp(encoding, "ascii") == 0) add_voxels_as_text(target, made->type, made->type % 2 ? " " : ", ");
}

static void nrrd_samples(sample_function *function, void *data) {
  static const char *const encodings[] = {"raw", "gzip", "hex", "ascii"};
  static const char *const line_ends[] = {"\n", "\r\n", "\r"};
  for (size_t t = 0; t < TYPES; t++)
    for (size_t e = 0; e < 4; e++)
      for (int variant = 0; variant < 4; variant++) {
        bool big = variant & 1, detached = variant & 2;
        size_t line_end = (t + e + (size_t)variant) % 3;
        volume_sample made = begin_sample(all_types[t], "%s_%s_%zu_%d.%s", hl_voxel_type_name(all_types[t]),
                                          encodings[e], line_end, big, detached ? "nhdr" : "nrrd");
        add_nrrd_header(&made, line_ends[line_end], encodings[e], big);
        if (detached) {
          strcpy(made.other_name, "detached data");
          add_text(&made.file, "line skip: 2%sdata file: detached data%s", line_ends[line_end],
                   line_ends[line_end]);
          add_text(&made.other, "two lines%sto skip%s", line_ends[line_end], line_ends[line_end]);
        } else {
          add_text(&made.file, "%s", line_ends[line_end]);
        }
        made.is_text = e == 3;
        add_nrrd_payload(&made, detached ? &made.other : &made.file, encodings[e], big);
        function(&made, data);
      }
}

/* Headers that leave things out, or that say the same in another way. */
static void nrrd_variants(sample_function *function, void *data) {
  static const struct {
    const char *fields;
    double spacing[3], origin[3];
  } variants[] = {
      {"dimension: 3\nsizes: 3 2 2\n", {1, 1, 1}, {0, 0, 0}},
      {"dimension: 3\nsizes: 3 2 2\nspacings: 0.5 nan 3\n", {0.5, 1, 3}, {0, 0, 0}},
      {"dimension: 3\nsizes: 3 2 2\nspacings: 2 2 2\naxis mins: 0 NaN 10\n", {2, 2, 2}, {1, 0, 11}},
      {"dimension: 3\nsizes: 3 2 2\naxismins: 1 1 1\naxis maxs: 4 2 2\ncenters: cell node cell\n",
       {1, 1, 0.5},
       {1.5, 1, 1.25}},
      {"dimension: 4\nsizes: 1 3 2 2\nkinds: scalar domain domain domain\n", {1, 1, 1}, {0, 0, 0}},
      {"dimension: 5\nsizes: 3 2 2 1 1\nspacings: 1 1 2 1 1\n", {1, 1, 2}, {0, 0, 0}},
      {"dimension: 5\nsizes: 1 3 1 2 2\nspacings: 7 1 7 1 2\n", {1, 1, 2}, {0, 0, 0}},
      {"dimension: 4\nspace dimension: 3\nsizes: 1 3 2 2\nspace directions: none (2,0,0) (0,1,0) (0,0,1)\n",
       {2, 1, 1},
       {0, 0, 0}},
      {"dimension: 3\nsizes: 3 2 2\nspace directions: (1,0,0) (0,1,0) (0,0,1)\nspace origin: (0, 0, 0)\n",
       {1, 1, 1},
       {0, 0, 0}},
  };
  for (size_t n = 0; n < sizeof variants / sizeof *variants; n++) {
    volume_sample made = begin_sample(HL_VOXEL_U8, "variant_%zu.nrrd", n);
    add_text(&made.file, "NRRD000%zu\n%stype: uint8\nencoding: raw\n\n", n % 5 + 1, variants[n].fields);
    add_voxels(&made.file, HL_VOXEL_U8, false);
    memcpy(made.origin, variants[n].origin, sizeof made.origin);
    for (int axis = 0; axis < 3; axis++) made.axis[axis][axis] = variants[n].spacing[axis];
    function(&made, data);
  }
  for (int last = 0; last < 2; last++) {
    volume_sample made = begin_sample(HL_VOXEL_I16, "skip_%d.nhdr", last);
    add_text(
        &made.file,
        "NRRD0004\ntype: short\nendian: little\ndimension: 3\nsizes: 3 2 2\nencoding: raw\nbyteskip: %d\n"
        "datafile: skip.bin\n",
        last ? -1 : 7);
    strcpy(made.other_name, "skip.bin");
    add_text(&made.other, "7 bytes");
    add_voxels(&made.other, HL_VOXEL_I16, false);
    function(&made, data);
  }
}

/* ---- MetaImage ---- */

static void meta_samples(sample_function *function, void *data) {
  static const char *const names[] = {"",           "MET_UCHAR",      "MET_CHAR",     "MET_USHORT",
                                      "MET_SHORT",  "MET_UINT",       "MET_INT",      "MET_FLOAT",
                                      "MET_DOUBLE", "MET_ULONG_LONG", "MET_LONG_LONG"};
  for (size_t t = 0; t < TYPES; t++)
    for (int variant = 0; variant < 12; variant++) {
      bool big = variant & 1, detached = variant & 2;
      int coding = variant / 4; /* 0 raw, 1 zlib, 2 text */
      volume_sample made = begin_sample(all_types[t], "%s_%d.%s", hl_voxel_type_name(all_types[t]), variant,
                                        detached ? "mhd" : "mha");
      byte_buffer voxels = {.length = 0}, *target = detached ? &made.other : &made.file;
      add_text(&made.file,
               "ObjectType = Image\nNDims = 3\nBinaryData = %s\n%s = %s\nCompressedData = %s\n"
               "TransformMatrix = 1 -0.5 0  0.25 1 0.5  0 0.0625 -1\nOffset = -12.5 3.25 100\n"
               "ElementSpacing = 0.5 1 2\nDimSize = 3 2 2\nElementType = %s\n",
               coding == 2 ? "False" : "True", detached ? "ElementByteOrderMSB" : "BinaryDataByteOrderMSB",
               big ? "True" : "False", coding == 1 ? "True" : "False", names[made.type]);
      if (detached && coding == 0) add_text(&made.file, "HeaderSize = %d\n", big ? -1 : 5);
      add_text(&made.file, "ElementDataFile = %s\n", detached ? "some voxels.raw" : "LOCAL");
      if (detached) strcpy(made.other_name, "some voxels.raw");
      if (detached && coding == 0) add_text(target, "5byte");
      add_voxels(&voxels, made.type, big);
      if (coding == 0) add(target, voxels.data, voxels.length);
      if (coding == 1) add_compressed(target, voxels.data, voxels.length, false);
      made.is_text = coding == 2;
      if (coding == 2) add_voxels_as_text(target, made.type, " ");
      place_obliquely(&made);
      function(&made, data);
    }
  volume_sample made = begin_sample(HL_VOXEL_U8, "four dimensions.mha");
  add_text(
      &made.file,
      "NDims = 4\r\nDimSize = 3 2 2 1\r\nElementSize = 1 2 3 4\r\nElementToIntensityFunctionSlope = 2\r\n"
      "ElementToIntensityFunctionOffset = -7\r\nElementType = MET_UCHAR\r\nElementDataFile = LOCAL\r\n");
  add_voxels(&made.file, HL_VOXEL_U8, false);
  made.axis[1][1] = 2;
  made.axis[2][2] = 3;
  made.scale = 2;
  made.shift = -7;
  function(&made, data);
}

/* ---- NIfTI ---- */

typedef enum nifti_place { PLACE_NONE, PLACE_QFORM, PLACE_SFORM, PLACE_BOTH } nifti_place;

static void put(byte_buffer *target, size_t place, uint64_t value, size_t length, bool big) {
  size_t end = target->length;
  target->length = place;
  add_integer(target, value, length, big);
  target->length = end;
}

static void put_float(byte_buffer *target, size_t place, double value, size_t length, bool big) {
  size_t end = target->length;
  target->length = place;
  add_float(target, value, length, big);
  target->length = end;
}

/* A header of version 1 or 2 as nifti1.h and nifti2.h lay it out; the offsets are written out here once more,
 * on purpose. */
static void add_nifti_header(byte_buffer *file, int version, hl_voxel_type type, bool big, bool pair,
                             nifti_place place, double slope, double intercept) {
  static const int codes[] = {0, 2, 256, 512, 4, 768, 8, 16, 64, 1280, 1024};
  bool old = version == 1;
  size_t real = old ? 4 : 8, size = old ? 348 : 540, dim = old ? 40 : 16, pixdim = old ? 76 : 104;
  memset(file->data, 0, size);
  file->length = size;
  put(file, 0, size, 4, big);
  memcpy(file->data + (old ? 344 : 4), old ? pair ? "ni1" : "n+1" : pair ? "ni2" : "n+2", 4);
  static const int dims[8] = {3, NI, NJ, NK, 1, 1, 1, 1};
  for (int n = 0; n < 8; n++) put(file, dim + (size_t)n * (old ? 2 : 8), (uint64_t)dims[n], old ? 2 : 8, big);
  put(file, old ? 70 : 12, (uint64_t)codes[type], 2, big);
  put(file, old ? 72 : 14, 8 * hl_voxel_type_bytes(type), 2, big);
  static const double steps[4] = {-1, 0.5, 2, 3};
  for (int n = 0; n < 4; n++) put_float(file, pixdim + (size_t)n * real, steps[n], real, big);
  double offset = pair ? 0 : (double)size + 4;
  if (old) put_float(file, 108, offset, 4, big);
  else put(file, 168, (uint64_t)offset, 8, big);
  put_float(file, old ? 112 : 176, slope, real, big);
  put_float(file, old ? 116 : 184, intercept, real, big);
  put(file, old ? 252 : 344, place == PLACE_QFORM || place == PLACE_BOTH, old ? 2 : 4, big);
  put(file, old ? 254 : 348, place == PLACE_SFORM || place == PLACE_BOTH, old ? 2 : 4, big);
  /* A quarter turn about z: (a, b, c, d) = (cos 45, 0, 0, sin 45). The file holds b, c and d, and a follows
   * from them. */
  put_float(file, (old ? 256 : 352) + 2 * real, sqrt(0.5), real, big);
  static const double qoffset[3] = {10, 20, 30};
  for (int n = 0; n < 3; n++) put_float(file, (old ? 268 : 376) + (size_t)n * real, qoffset[n], real, big);
  static const double rows[12] = {0.5, 0.25, 0, -12.5, -0.25, 1, 0.125, 3.25, 0, 0.5, -2, 100};
  for (int n = 0; n < 12; n++) put_float(file, (old ? 280 : 400) + (size_t)n * real, rows[n], real, big);
  if (!pair) add_text(file, "%c%c%c%c", 0, 0, 0, 0);
}

static void place_nifti(volume_sample *made, nifti_place place) {
  static const double turned[3][3] = {
      {0, 0.5, 0}, {-2, 0, 0}, {0, 0, -3}}; /* a negative pixdim[0] mirrors k */
  static const double offset[3] = {10, 20, 30}, steps[3] = {0.5, 2, 3};
  if (place == PLACE_SFORM || place == PLACE_BOTH) place_obliquely(made);
  if (place == PLACE_QFORM) {
    memcpy(made->axis, turned, sizeof turned);
    memcpy(made->origin, offset, sizeof offset);
  }
  for (int axis = 0; place == PLACE_NONE && axis < 3; axis++) made->axis[axis][axis] = steps[axis];
}

static void nifti_samples(sample_function *function, void *data) {
  static const char *const endings[] = {".nii", ".nii.gz", ".hdr", ".img"};
  for (size_t t = 0; t < TYPES; t++)
    for (int variant = 0; variant < 16; variant++) {
      bool big = variant & 1;
      int version = variant & 2 ? 2 : 1, kind = variant / 4;
      nifti_place place = (nifti_place)((t + (size_t)variant) % 4);
      volume_sample made = begin_sample(all_types[t], "%s_%d%s", hl_voxel_type_name(all_types[t]), variant,
                                        endings[kind]);
      bool pair = kind >= 2, scaled = t % 3 == 0;
      made.scale = scaled ? 0.5 : 1;
      made.shift = scaled ? -3 : 0;
      byte_buffer header = {.length = 0}, voxels = {.length = 0};
      add_nifti_header(&header, version, made.type, big, pair, place,
                       scaled       ? 0.5
                       : t % 3 == 1 ? 0
                                    : NAN,
                       scaled       ? -3
                       : t % 3 == 1 ? 5
                                    : NAN);
      add_voxels(&voxels, made.type, big);
      if (!pair) add(&header, voxels.data, voxels.length);
      if (kind == 0) made.file = header;
      if (kind == 1) add_compressed(&made.file, header.data, header.length, true);
      if (kind == 2) made.file = header, made.other = voxels;
      if (kind == 3) made.other = header, made.file = voxels;
      if (pair)
        snprintf(made.other_name, sizeof made.other_name, "%s_%d%s", hl_voxel_type_name(all_types[t]),
                 variant, endings[5 - kind]);
      place_nifti(&made, place);
      function(&made, data);
    }
}

/* ---- VTK ---- */

static const char *vti_type(hl_voxel_type type) {
  static const char *const names[] = {"",      "UInt8",   "Int8",    "UInt16", "Int16", "UInt32",
                                      "Int32", "Float32", "Float64", "UInt64", "Int64"};
  return names[type];
}

/* The values after the header, plain or in zlib blocks that are two voxels shorter than all values. */
static void encode_vti(byte_buffer *target, hl_voxel_type type, bool big, size_t header_bytes,
                       bool compressed, bool base64) {
  byte_buffer voxels = {.length = 0}, header = {.length = 0}, body = {.length = 0};
  add_voxels(&voxels, type, big);
  if (!compressed) {
    add_integer(&header, voxels.length, header_bytes, big);
    add(&header, voxels.data, voxels.length); /* coded as one */
  } else {
    size_t block = 10 * hl_voxel_type_bytes(type), first;
    add_compressed(&body, voxels.data, block, false);
    first = body.length;
    add_compressed(&body, voxels.data + block, voxels.length - block, false);
    const uint64_t numbers[5] = {2, block, voxels.length - block, first, body.length - first};
    for (int n = 0; n < 5; n++) add_integer(&header, numbers[n], header_bytes, big);
  }
  if (base64) {
    add_base64(target, header.data, header.length);
    add_base64(target, body.data, body.length);
  } else {
    add(target, header.data, header.length);
    add(target, body.data, body.length);
  }
}

static void add_vti_head(byte_buffer *file, bool big, size_t header_bytes, bool compressed) {
  add_text(
      file,
      "<?xml version=\"1.0\"?>\n<!-- <VTKFile type='no'> -->\n<VTKFile type=\"ImageData\" version=\"1.0\" "
      "byte_order=\"%s\" header_type='UInt%d'%s>\n",
      big ? "BigEndian" : "LittleEndian", header_bytes == 8 ? 64 : 32,
      compressed ? " compressor=\"vtkZLibDataCompressor\"" : "");
  add_text(
      file,
      "<ImageData WholeExtent=\"2 4 -1 0 10 11\" Origin=\"-13.25 3.5 120.5\" Spacing=\"0.5 1 2\"\n"
      " Direction=\"1 0.25 0 -0.5 1 0.0625 0 0.5 -1\">\n<Piece Extent=\"2 4 -1 0 10 11\">\n"
      "<FieldData><DataArray type=\"String\" Name=\"note\" format=\"ascii\">65 66 0</DataArray></FieldData>\n"
      "<PointData Scalars=\"a&lt;b\">\n");
}

static void vti_samples(sample_function *function, void *data) {
  static const char *const codings[] = {"ascii", "binary", "appended", "appended"};
  for (size_t t = 0; t < TYPES; t++)
    for (int variant = 0; variant < 25; variant++) {
      bool big = variant & 1, wide = variant & 2, compressed = variant & 4;
      int coding = variant == 24 ? 0 : variant / 8 + 1; /* text, base64, appended base64, appended raw */
      size_t header_bytes = wide ? 8 : 4;
      volume_sample made = begin_sample(all_types[t], "%s_%d.vti", hl_voxel_type_name(all_types[t]), variant);
      add_vti_head(&made.file, big, header_bytes, compressed);
      bool appended = coding >= 2;
      /* Two arrays. The first is to be skipped, and the second is the active one. */
      add_text(&made.file, "<DataArray type=\"Int8\" Name=\"other\" format=\"%s\" %s/>\n", codings[coding],
               appended ? "offset=\"0\"" : "");
      add_text(&made.file,
               "<DataArray type=\"%s\" Name=\"a&lt;b\" NumberOfComponents=\"1\" format=\"%s\" %s>\n  ",
               vti_type(made.type), codings[coding], appended ? "offset=\"4\"" : "");
      made.is_text = coding == 0;
      if (coding == 0) add_voxels_as_text(&made.file, made.type, " ");
      if (coding == 1) encode_vti(&made.file, made.type, big, header_bytes, compressed, true);
      add_text(&made.file, "\n</DataArray></PointData><CellData></CellData></Piece></ImageData>\n");
      if (appended) {
        add_text(&made.file, "<AppendedData encoding=\"%s\">\n _skip", coding == 2 ? "base64" : "raw");
        encode_vti(&made.file, made.type, big, header_bytes, compressed, coding == 2);
        add_text(&made.file, "\n</AppendedData>\n");
      }
      add_text(&made.file, "</VTKFile>\n");
      place_obliquely(
          &made); /* Origin + 2 axis[0] - axis[1] + 10 axis[2], for the extent begins at 2 -1 10 */
      function(&made, data);
    }
}

static void legacy_samples(sample_function *function, void *data) {
  static const char *const names[] = {"",       "unsigned_char", "char",        "unsigned_short",
                                      "short",  "unsigned_int",  "int",         "float",
                                      "double", "unsigned_long", "vtktypeint64"};
  for (size_t t = 0; t < TYPES; t++)
    for (int variant = 0; variant < 6; variant++) {
      bool text = variant & 1;
      int kind = variant / 2; /* SCALARS with a lookup table, without, FIELD */
      volume_sample made = begin_sample(all_types[t], "%s_%d.vtk", hl_voxel_type_name(all_types[t]), variant);
      add_text(&made.file,
               "# vtk DataFile Version %s\ntitle\n%s%s\n%sDATASET STRUCTURED_POINTS\nDIMENSIONS 3 2 2\n%s "
               "0.5 1 3\n"
               "ORIGIN -1 2 1e1\n",
               kind == 1 ? "1.0" : "5.1", kind == 1 ? "\n" : "", text ? "ASCII" : "BINARY",
               kind == 1 ? "\n" : "", kind == 1 ? "ASPECT_RATIO" : "SPACING");
      if (kind == 2) { /* data sets may begin with fields, and with data of cells */
        add_text(&made.file, "FIELD FieldData 1\ntime 1 1 short\n");
        if (text) add_text(&made.file, "7\n");
        else add_text(&made.file, "%c%c\n", 0, 7);
        /* the grid has two cells; a file that ends here has no volume */
        add_text(&made.file,
                 "METADATA\nINFORMATION 0\n\nCELL_DATA 4\nSCALARS c unsigned_char\nLOOKUP_TABLE default\n");
        add_text(&made.file, "%s", text ? "1 2 3 4\n" : "abcd\n");
      }
      add_text(&made.file, "POINT_DATA 12\n");
      if (kind < 2) add_text(&made.file, "SCALARS density %s%s\n", names[made.type], kind == 0 ? " 1" : "");
      if (kind == 0) add_text(&made.file, "LOOKUP_TABLE default\n");
      if (kind == 2) {
        add_text(&made.file, "FIELD FieldData 2\nvectors 3 1 char\n");
        add_text(&made.file, "%s", text ? "1 2\n3\n" : "abc\n");
        add_text(&made.file, "density 1 12 %s\n", names[made.type]);
      }
      made.is_text = text;
      if (text) add_voxels_as_text(&made.file, made.type, " ");
      else add_voxels(&made.file, made.type, true);
      add_text(&made.file, "\nMETADATA\nINFORMATION 0\n\n");
      made.axis[0][0] = 0.5;
      made.axis[2][2] = 3;
      made.origin[0] = -1, made.origin[1] = 2, made.origin[2] = 10;
      function(&made, data);
    }
  for (int text = 0; text < 2; text++) {
    volume_sample made = begin_sample(HL_VOXEL_U8, "colors_%d.vtk", text);
    add_text(&made.file,
             "# vtk DataFile Version 3.0\n\n%s\nDATASET STRUCTURED_POINTS\nDIMENSIONS 3 2 2\nPOINT_DATA 12\n"
             "COLOR_SCALARS density 1\n",
             text ? "ASCII" : "BINARY");
    made.is_text = text;
    for (int n = 0; text && n < VOXELS; n++) add_text(&made.file, "%.6g ", voxel_value(HL_VOXEL_U8, n) / 255);
    if (!text) add_voxels(&made.file, HL_VOXEL_U8, true);
    function(&made, data);
  }
}

void for_each_sample(sample_function *function, void *data) {
  raw_samples(function, data);
  nrrd_samples(function, data);
  nrrd_variants(function, data);
  vgi_samples(function, data);
  meta_samples(function, data);
  nifti_samples(function, data);
  vti_samples(function, data);
  legacy_samples(function, data);
  for_each_numpy_sample(function, data);
  for_each_volvis_sample(function, data);
  for_each_microscope_sample(function, data);
  for_each_component_sample(function, data);
}
