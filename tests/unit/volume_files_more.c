/* tests/unit/volume_files_more.c - samples of volume_files.h: NumPy arrays, and voxels of several
 * components. */
#include "volume_files.h"

#include <stdio.h>
#include <string.h>

/* ---- NumPy ---- */

static const struct {
  hl_voxel_type type;
  const char *name;
} numpy_types[] = {{HL_VOXEL_U8, "u1"},  {HL_VOXEL_I8, "i1"},  {HL_VOXEL_U16, "u2"}, {HL_VOXEL_I16, "i2"},
                   {HL_VOXEL_U32, "u4"}, {HL_VOXEL_I32, "i4"}, {HL_VOXEL_U64, "u8"}, {HL_VOXEL_I64, "i8"},
                   {HL_VOXEL_F16, "f2"}, {HL_VOXEL_F32, "f4"}, {HL_VOXEL_F64, "f8"}};

/* version: 1 to 3; the text is padded to 64 bytes as NumPy does. */
static void add_numpy_header(byte_buffer *file, int version, const char *type, bool big, bool fortran,
                             const char *shape) {
  char text[200];
  int length = snprintf(text, sizeof text, "{'descr': '%s%s', 'fortran_order': %s, 'shape': %s, }",
                        type[1] == '1' ? "|"
                        : big          ? ">"
                                       : "<",
                        type, fortran ? "True" : "False", shape);
  size_t before = version == 1 ? 10 : 12, whole = (before + (size_t)length + 1 + 63) / 64 * 64;
  add(file, "\x93NUMPY", 6);
  add_integer(file, (uint64_t)version, 2, false);
  add_integer(file, whole - before, before - 8, false);
  add_text(file, "%s%*s\n", text, (int)(whole - before - (size_t)length - 1), "");
}

/* The voxels of add_voxels(), with z fastest and x slowest. */
static void add_turned_voxels(byte_buffer *file, hl_voxel_type type, bool big) {
  byte_buffer straight = {.length = 0};
  size_t bytes = hl_voxel_type_bytes(type);
  add_voxels(&straight, type, big);
  for (size_t x = 0; x < NI; x++)
    for (size_t y = 0; y < NJ; y++)
      for (size_t z = 0; z < NK; z++) add(file, straight.data + ((z * NJ + y) * NI + x) * bytes, bytes);
}

void for_each_numpy_sample(sample_function *function, void *data) {
  for (size_t t = 0; t < sizeof numpy_types / sizeof *numpy_types; t++)
    for (int variant = 0; variant < 12; variant++) {
      bool big = variant & 1, fortran = variant & 2;
      int version = 1 + variant / 4;
      volume_sample made = begin_sample(numpy_types[t].type, "%s_%d.npy", numpy_types[t].name, variant);
      add_numpy_header(&made.file, version, numpy_types[t].name, big, fortran, "(2, 2, 3)");
      if (fortran) add_turned_voxels(&made.file, made.type, big);
      else add_voxels(&made.file, made.type, big);
      function(&made, data);
    }
}

/* ---- MRC ---- */

static void put_word(byte_buffer *file, size_t place, uint32_t word, bool big) {
  for (int n = 0; n < 4; n++) file->data[place + (size_t)(big ? 3 - n : n)] = (unsigned char)(word >> 8 * n);
}

static void put_real(byte_buffer *file, size_t place, float value, bool big) {
  uint32_t bits;
  memcpy(&bits, &value, 4);
  put_word(file, place, bits, big);
}

/* VolVis: a small picture of two pixels, then two slices of 3 x 2 voxels, plain or packed. A packed slice is
 * a run of two bytes as they are, one byte that is repeated once, and three bytes as they are. */
void for_each_volvis_sample(sample_function *function, void *data) {
  for (int packed = 0; packed < 2; packed++) {
    volume_sample made = begin_sample(HL_VOXEL_U8, "a_%d.slc", packed);
    byte_buffer voxels = {.length = 0};
    add_voxels(&voxels, HL_VOXEL_U8, false);
    add_text(&made.file, "11111\n3 2 2 8\n1.000000 0.5 2\n1 6 0 %d\n2 1 XpIcTuR", packed);
    for (const unsigned char *v = voxels.data; packed && v < voxels.data + 12; v += 6) {
      const unsigned char slice[] = {0x82, v[0], v[1], 1, v[2], 0x83, v[3], v[4], v[5], 0};
      add_text(&made.file, v == voxels.data ? "10 X" : "12 X"); /* two bytes without a meaning */
      add(&made.file, slice, sizeof slice);
    }
    if (packed) add_text(&made.file, "zz");
    if (!packed) add(&made.file, voxels.data, voxels.length);
    made.axis[1][1] = 0.5;
    made.axis[2][2] = 2;
    function(&made, data);
  }
}

/* A header of one volume whose cell has intervals of 0.5, 2 and 3 along X, Y and Z. */
static void add_mrc_header(byte_buffer *file, int mode, const int axes[3], bool big) {
  static const uint32_t sizes[3] = {NI, NJ, NK};
  memset(file->data, 0, 1024);
  file->length = 1024;
  for (size_t n = 0; n < 3; n++) {
    put_word(file, 4 * n, sizes[n], big);
    put_word(file, 16 + 4 * n, (uint32_t)-1, big);
    put_word(file, 28 + 4 * n, 4 * sizes[n], big);
    put_real(file, 40 + 4 * n, 4 * (float)sizes[n] * (n == 0 ? 0.5F : 1 + (float)n), big);
    put_real(file, 52 + 4 * n, 90, big);
    put_word(file, 64 + 4 * n, (uint32_t)axes[n], big);
  }
  put_word(file, 12, (uint32_t)mode, big);
  put_word(file, 92, 80, big);
  memcpy(file->data + 208, big ? "MAP \x11\x11" : "MAP \x44\x44", 6);
}

/* The origin is ORIGIN, or, if that is off, one step back along each of the file's axes. */
static void mrc_samples(sample_function *function, void *data) {
  static const int modes[] = {0, 0, 1, 2, 6, 12};
  static const hl_voxel_type types[] = {HL_VOXEL_I8,  HL_VOXEL_U8,  HL_VOXEL_I16,
                                        HL_VOXEL_F32, HL_VOXEL_U16, HL_VOXEL_F16};
  static const int orders[4][3] = {{1, 2, 3}, {3, 1, 2}, {2, 1, 3}, {3, 3, 1}};
  static const double step[3] = {0.5, 2, 3};
  for (size_t t = 0; t < sizeof modes / sizeof *modes; t++)
    for (int variant = (int)t % 3; variant < 16; variant += 3) {
      /* the header is long, so that every third variant is tested */
      bool big = variant & 1, placed = variant & 2, series = variant == 12;
      const int *order = orders[variant / 4];
      volume_sample made = begin_sample(types[t], "%zu_%d.mrc", t, variant);
      add_mrc_header(&made.file, modes[t], order, big);
      if (types[t] == HL_VOXEL_U8) put_word(&made.file, 152, 1146047817, big); /* IMOD's unsigned bytes */
      for (size_t n = 0; n < 3; n++) {
        size_t axis = order[0] == order[1] ? n : (size_t)order[n] - 1;
        memset(made.axis[n], 0, sizeof made.axis[n]);
        made.axis[n][axis] = step[axis];
        made.origin[axis] = placed ? 7.5 * (double)(axis + 1) : -step[axis];
        if (placed) put_real(&made.file, 196 + 4 * axis, 7.5F * (float)(axis + 1), big);
      }
      if (series) { /* of three volumes, as wide as their cell */
        put_word(&made.file, 8, 3 * NK, big);
        put_word(&made.file, 36, NK, big);
        put_real(&made.file, 48, NK * 3, big);
        put_word(&made.file, 88, 401, big);
      }
      for (int n = 0; n < 80; n++) add_text(&made.file, "x");
      for (int volume = 0; volume < (series ? 3 : 1); volume++) add_voxels(&made.file, made.type, big);
      function(&made, data);
    }
}

/* ---- TIFF ---- */

#ifdef HL_WITH_TIFF

typedef struct tiff_kind {
  bool big_endian, wide, tiled, described; /* wide: BigTIFF; described: by ImageJ */
} tiff_kind;

static const char imagej[] = "ImageJ=1.53\nimages=2\nslices=2\nunit=um\nspacing=3\n";

/* type: 2: text; 3: 16 bits; 4: 32 bits; 5: a fraction. value: the number itself, or its place in the file.
 */
static void add_tiff_tag(byte_buffer *file, const tiff_kind *kind, unsigned tag, unsigned type,
                         uint64_t count, uint64_t value) {
  size_t room = kind->wide ? 8 : 4, bytes = type == 3 ? 2 : type == 4 ? 4 : room;
  add_integer(file, tag, 2, kind->big_endian);
  add_integer(file, type, 2, kind->big_endian);
  add_integer(file, count, room, kind->big_endian);
  add_integer(file, value, bytes, kind->big_endian);
  if (bytes < room) add_integer(file, 0, room - bytes, kind->big_endian);
}

/* A page's directory, what its tags point to, and its voxels, in one strip or one tile of 16 x 16. */
static void add_tiff_page(byte_buffer *file, const tiff_kind *kind, hl_voxel_type type, int page) {
  bool is_float = type == HL_VOXEL_F16 || type == HL_VOXEL_F32 || type == HL_VOXEL_F64;
  bool is_signed = type == HL_VOXEL_I8 || type == HL_VOXEL_I16 || type == HL_VOXEL_I32 ||
                   type == HL_VOXEL_I64;
  size_t room = kind->wide ? 8 : 4, voxel_bytes = hl_voxel_type_bytes(type);
  unsigned tags = (kind->tiled ? 11 : 10) + (kind->described ? 3 : 0);
  size_t text = file->length + (kind->wide ? 8 : 2) + tags * (kind->wide ? 20 : 12) + room;
  size_t fractions = kind->described ? text + sizeof imagej : text,
         data = fractions + (kind->described ? 16 : 0);
  size_t bytes = voxel_bytes * (kind->tiled ? 256 : NI * NJ), next = page + 1 < NK ? data + bytes : 0;
  add_integer(file, tags, kind->wide ? 8 : 2, kind->big_endian);
  add_tiff_tag(file, kind, 256, 4, 1, NI);
  add_tiff_tag(file, kind, 257, 4, 1, NJ);
  add_tiff_tag(file, kind, 258, 3, 1, 8 * voxel_bytes);
  add_tiff_tag(file, kind, 259, 3, 1, 1);
  add_tiff_tag(file, kind, 262, 3, 1, 1);
  if (kind->described) add_tiff_tag(file, kind, 270, 2, sizeof imagej, text);
  if (!kind->tiled) add_tiff_tag(file, kind, 273, 4, 1, data);
  add_tiff_tag(file, kind, 277, 3, 1, 1);
  if (!kind->tiled) add_tiff_tag(file, kind, 278, 3, 1, NJ), add_tiff_tag(file, kind, 279, 4, 1, bytes);
  for (unsigned axis = 0; kind->described && axis < 2; axis++) {
    if (!kind->wide) add_tiff_tag(file, kind, 282 + axis, 5, 1, fractions + 8 * axis);
    else { /* two numbers of 32 bits fit */ add_tiff_tag(file, kind, 282 + axis, 5, 1, 0);
      file->length -= 8;
      add_integer(file, axis == 0 ? 4 : 2, 4, kind->big_endian), add_integer(file, 1, 4, kind->big_endian);
    }
  }
  if (kind->tiled) {
    add_tiff_tag(file, kind, 322, 3, 1, 16), add_tiff_tag(file, kind, 323, 3, 1, 16);
    add_tiff_tag(file, kind, 324, 4, 1, data), add_tiff_tag(file, kind, 325, 4, 1, bytes);
  }
  add_tiff_tag(file, kind, 339, 3, 1, is_float ? 3 : is_signed ? 2 : 1);
  add_integer(file, next, room, kind->big_endian);
  if (kind->described) {
    add(file, imagej, sizeof imagej);
    add_integer(file, 4, 4, kind->big_endian), add_integer(file, 1, 4, kind->big_endian);
    add_integer(file, 2, 4, kind->big_endian), add_integer(file, 1, 4, kind->big_endian);
  }
  byte_buffer voxels = {.length = 0};
  add_voxels(&voxels, type, kind->big_endian);
  const unsigned char *first = voxels.data + (size_t)page * NI * NJ * voxel_bytes;
  static const unsigned char nothing[256 * 8] = {0};
  for (size_t row = 0; row < NJ; row++) {
    add(file, first + row * NI * voxel_bytes, NI * voxel_bytes);
    if (kind->tiled) add(file, nothing, (16 - NI) * voxel_bytes);
  }
  if (kind->tiled) add(file, nothing, 16 * (16 - NJ) * voxel_bytes);
}

static void tiff_samples(sample_function *function, void *data) {
  for (size_t t = 0; t < sizeof numpy_types / sizeof *numpy_types; t++)
    for (unsigned variant = (unsigned)t % 3; variant < 16; variant += 3) {
      tiff_kind kind = {variant & 1, variant & 2, (variant & 4) && t < 2, variant & 8};
      volume_sample made = begin_sample(numpy_types[t].type, "%s_%u.tif", numpy_types[t].name, variant);
      add_text(&made.file, "%s", kind.big_endian ? "MM" : "II");
      add_integer(&made.file, kind.wide ? 43 : 42, 2, kind.big_endian);
      if (kind.wide) add_integer(&made.file, 8, 2, kind.big_endian), add_integer(&made.file, 0, 2, false);
      add_integer(&made.file, kind.wide ? 16 : 8, kind.wide ? 8 : 4, kind.big_endian);
      for (int page = 0; page < NK; page++) add_tiff_page(&made.file, &kind, made.type, page);
      static const double described[3] = {0.25, 0.5, 3};
      for (int axis = 0; axis < 3 && kind.described; axis++) made.axis[axis][axis] = described[axis];
      function(&made, data);
    }
}

#else

static void tiff_samples(sample_function *function, void *data) { (void)function, (void)data; }

#endif

void for_each_microscope_sample(sample_function *function, void *data) {
  mrc_samples(function, data);
  tiff_samples(function, data);
}

/* ---- several components ---- */

enum { COMPONENTS = 5 };

/* The voxels are component 0, and the others hold bytes of another kind. Components are side by side, or one
 * array after the other. */
static void add_components(byte_buffer *file, hl_voxel_type type, size_t components, bool side_by_side) {
  byte_buffer voxels = {.length = 0};
  size_t bytes = hl_voxel_type_bytes(type);
  add_voxels(&voxels, type, false);
  for (size_t n = 0; n < VOXELS * components; n++) {
    size_t voxel = side_by_side ? n / components : n % VOXELS,
           component = side_by_side ? n % components : n / VOXELS;
    if (component == 0) add(file, voxels.data + voxel * bytes, bytes);
    else
      for (size_t b = 0; b < bytes; b++) add_integer(file, 77 + component, 1, false);
  }
}

static void nrrd_components(sample_function *function, void *data) {
  static const struct {
    const char *fields;
    bool side_by_side;
    size_t components;
  } layouts[] = {{"dimension: 4\nsizes: 5 3 2 2\nkinds: vector domain domain domain\n", true, 5},
                 {"dimension: 4\nsizes: 3 2 2 5\nkinds: domain domain domain list\n", false, 5},
                 {"dimension: 4\nsizes: 5 3 2 2\nkinds: time space space space\n", true, 5},
                 {"dimension: 4\nsizes: 5 3 2 2\nspace directions: none (1,0,0) (0,1,0) (0,0,1)\n", true, 5},
                 {"dimension: 5\nsizes: 2 2 3 2 2\nkinds: vector vector domain domain domain\n", true, 4}};
  for (size_t n = 0; n < sizeof layouts / sizeof *layouts; n++) {
    volume_sample made = begin_sample(HL_VOXEL_I16, "components_%zu.nrrd", n);
    add_text(&made.file, "NRRD0005\ntype: short\nendian: little\nencoding: raw\n%s\n", layouts[n].fields);
    add_components(&made.file, made.type, layouts[n].components, layouts[n].side_by_side);
    function(&made, data);
  }
  /* a component axis between those of the grid */
  volume_sample made = begin_sample(HL_VOXEL_U8, "components_within.nrrd");
  add_text(&made.file,
           "NRRD0005\ntype: uchar\nencoding: raw\ndimension: 4\nsizes: 3 2 4 2\nkinds: domain domain vector "
           "domain\n\n");
  byte_buffer voxels = {.length = 0};
  add_voxels(&voxels, HL_VOXEL_U8, false);
  for (size_t k = 0; k < NK; k++)
    for (size_t c = 0; c < 4; c++)
      for (size_t n = 0; n < NI * NJ; n++) {
        if (c == 0) add(&made.file, voxels.data + k * NI * NJ + n, 1);
        else add_integer(&made.file, c, 1, false);
      }
  function(&made, data);
}

static void meta_components(sample_function *function, void *data) {
  volume_sample made = begin_sample(HL_VOXEL_I16, "channels.mha");
  add_text(&made.file,
           "NDims = 3\nDimSize = 3 2 2\nElementNumberOfChannels = %d\nElementType = "
           "MET_SHORT\nElementDataFile = LOCAL\n",
           COMPONENTS);
  add_components(&made.file, made.type, COMPONENTS, true);
  function(&made, data);
  volume_sample series = begin_sample(HL_VOXEL_F32, "series.mha");
  add_text(&series.file, "NDims = 4\nDimSize = 3 2 2 %d\nElementType = MET_FLOAT\nElementDataFile = LOCAL\n",
           COMPONENTS);
  add_components(&series.file, series.type, COMPONENTS, false);
  function(&series, data);
}

static void vtk_components(sample_function *function, void *data) {
  for (int first = 0; first < 2;
       first++) { /* the volume stands before or after a vector; and an array that is not understood */
    /* A file of vectors that is cut before its scalars is still whole, so that its type keeps it out of the
     * test of cut files. */
    volume_sample made = begin_sample(first ? HL_VOXEL_U16 : HL_VOXEL_U8, "vectors_%d.vtk", first);
    add_text(&made.file,
             "# vtk DataFile Version 3.0\nt\nBINARY\nDATASET STRUCTURED_POINTS\nDIMENSIONS 3 2 2\nPOINT_DATA "
             "12\n");
    if (first) add_text(&made.file, "VECTORS v char\n123123123123123123123123123123123123\n");
    add_text(&made.file, "SCALARS density %s\nLOOKUP_TABLE default\n",
             first ? "unsigned_short" : "unsigned_char");
    add_voxels(&made.file, made.type, true);
    if (!first) add_text(&made.file, "\nNORMALS n char\n123123123123123123123123123123123123");
    add_text(&made.file, "\nSCALARS other unsigned_char\nLOOKUP_TABLE default\n123456789012\nGLOBAL_IDS x\n");
    function(&made, data);
  }
  volume_sample made = begin_sample(HL_VOXEL_U8, "arrays.vti");
  add_text(
      &made.file,
      "<VTKFile type=\"ImageData\"><ImageData WholeExtent=\"0 2 0 1 0 1\"><CellData><DataArray "
      "type=\"UInt8\" "
      "Name=\"c\">1 2</DataArray></CellData><PointData><DataArray type=\"String\" Name=\"s\">1</DataArray>"
      "<DataArray type=\"UInt8\" Name=\"v\" NumberOfComponents=\"3\">1</DataArray>"
      "<DataArray type=\"UInt8\" Name=\"density\">");
  add_voxels_as_text(&made.file, HL_VOXEL_U8, " ");
  add_text(
      &made.file,
      "</DataArray><DataArray type=\"UInt8\" Name=\"d\">7</DataArray></PointData></ImageData></VTKFile>");
  made.is_text = true;
  function(&made, data);
}

static void numpy_components(sample_function *function, void *data) {
  volume_sample last = begin_sample(HL_VOXEL_I16, "last.npy");
  add_numpy_header(&last.file, 1, "i2", false, false, "(2, 2, 3, 4)");
  add_components(&last.file, last.type, 4, true);
  function(&last, data);
}

void for_each_component_sample(sample_function *function, void *data) {
  nrrd_components(function, data);
  meta_components(function, data);
  vtk_components(function, data);
  numpy_components(function, data);
}
