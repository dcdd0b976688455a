/* tests/unit/volume_hostile.c - malformed, cut and damaged files, and memory that runs out, give clean
 * errors. */
#define _GNU_SOURCE
#include "volume_files.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "core/context.h"

#define NRRD       "NRRD0004\n"
#define NRRD_SIZES NRRD "dimension: 3\nsizes: 3 2 2\n"
#define VGI        "{volumeprimitive1}\n[geometry]\nresolution = 1 1 1\n{volume1}\n[file1]\nName = a\n"
#define META       "NDims = 3\nDimSize = 3 2 2\n"
#define VTK        "# vtk DataFile Version 3.0\nt\nASCII\nDATASET STRUCTURED_POINTS\nDIMENSIONS 3 2 2\n"
#define VTI        "<VTKFile type=\"ImageData\">"
#define IMAGE      VTI "<ImageData WholeExtent=\"0 2 0 1 0 1\"><PointData>"
/* At least the 257 bytes of a header whose length is "\1\1". */
#define SPACES_64 "                                                                "
#define LONG_LINE SPACES_64 SPACES_64 SPACES_64 SPACES_64 SPACES_64
#define NPY       "\x93NUMPY\1.\1\1{'descr': '<f4', 'fortran_order': False, "
#define TWELVE    "123456789012"

typedef struct malformed {
  const char *name, *content;
  hl_status status;
  const char *message; /* the text of which the message must have a part */
} malformed;

static const malformed files[] = {
    /* NRRD */
    {"version.nrrd", "NRRD0009\ntype: uchar\n\n", HL_ERROR_UNSUPPORTED, "line 1: expected NRRD0001"},
    {"empty.nrrd", "", HL_ERROR_INPUT, "empty"},
    {"other.nrrd", "something else", HL_ERROR_INPUT, "does not begin with \"NRRD000\""},
    {"cut.nrrd", NRRD_SIZES "type: uchar\nencoding: raw\n", HL_ERROR_INPUT, "neither an empty line"},
    {"fields.nrrd", NRRD "sizes: 3 2 2\n", HL_ERROR_INPUT,
     "line 2: the field dimension must come before sizes"},
    {"kindless.nrrd", NRRD "kinds: domain\n\n", HL_ERROR_INPUT, "must come before kinds"},
    {"dimension.nrrd", NRRD "dimension: 17\n\n", HL_ERROR_INPUT, "line 2: dimension cannot be \"17\""},
    {"negative.nrrd", NRRD "dimension: 3\nsizes: 3 -2 2\n\n", HL_ERROR_INPUT,
     "sizes must be 3 whole numbers"},
    {"few.nrrd", NRRD "dimension: 3\nsizes: 3 2\n\n", HL_ERROR_INPUT, "sizes must be 3 whole numbers"},
    {"overflow.nrrd", NRRD "dimension: 3\nsizes: 99999999999999999999 2 2\n\n", HL_ERROR_INPUT,
     "sizes must be"},
    {"zero.nrrd", NRRD "dimension: 3\nsizes: 3 0 2\ntype: uchar\nencoding: raw\n\n", HL_ERROR_INPUT,
     "at least 1"},
    {"vast.nrrd",
     NRRD "dimension: 3\nsizes: 2000000000 2000000000 2000000000\ntype: uchar\nencoding: raw\n\n" TWELVE,
     HL_ERROR_INPUT, "more memory than this program can address"},
    {"terabyte.nrrd", NRRD "dimension: 3\nsizes: 10000 10000 10000\ntype: uchar\nencoding: raw\n\n" TWELVE,
     HL_ERROR_INPUT,
     "promises 1000000000000 bytes of voxels (10000 x 10000 x 10000 uint8), the file has only 12 bytes"},
    {"terazip.nrrd", NRRD "dimension: 3\nsizes: 10000 10000 10000\ntype: uchar\nencoding: gzip\n\n" TWELVE,
     HL_ERROR_INPUT, "promises 1000000000000 bytes"},
    {"teratext.nrrd", NRRD "dimension: 3\nsizes: 10000 10000 10000\ntype: uchar\nencoding: ascii\n\n1 2 3",
     HL_ERROR_INPUT, "promises 1999999999999 bytes of voxels as text or more"},
    {"type.nrrd", NRRD "type: quark\n\n", HL_ERROR_INPUT, "line 2: type \"quark\" is not read"},
    {"block.nrrd", NRRD "type: block\n\n", HL_ERROR_UNSUPPORTED, "\"block\" is not read"},
    {"typeless.nrrd", NRRD_SIZES "encoding: raw\n\n" TWELVE, HL_ERROR_INPUT, "without a field \"type\""},
    {"encoding.nrrd", NRRD "encoding: wax\n\n", HL_ERROR_INPUT, "encoding \"wax\" is not read"},
    {"zrl.nrrd", NRRD "encoding: zrl\n\n", HL_ERROR_UNSUPPORTED, "encoding \"zrl\" is not read"},
    {"not_bzip2.nrrd", NRRD_SIZES "type: uchar\nencoding: bzip2\n\n" TWELVE, HL_ERROR_INPUT, "damaged"},
    {"endian.nrrd", NRRD "endian: middle\n\n", HL_ERROR_INPUT, "endian cannot be \"middle\""},
    {"colon.nrrd", NRRD "dimension 3\n\n", HL_ERROR_INPUT, "line 2: expected \"field: value\""},
    {"spacing.nrrd", NRRD_SIZES "spacings: 1 2\n\n", HL_ERROR_INPUT, "line 4: spacings cannot be \"1 2\""},
    {"flat.nrrd", NRRD_SIZES "type: uchar\nencoding: raw\nspacings: 1 0 1\n\n" TWELVE, HL_ERROR_INPUT,
     "the spacing along axis 1 is 0: give"},
    {"vector.nrrd", NRRD_SIZES "space directions: (1,0,0) (0,1,0)\n\n", HL_ERROR_INPUT,
     "space directions cannot be"},
    {"planar.nrrd",
     NRRD_SIZES "type: uchar\nencoding: raw\nspace directions: (1,0,0) (0,1,0) (1,1,0)\n\n" TWELVE,
     HL_ERROR_INPUT, "the three axes lie in one plane"},
    {"infinite.nrrd",
     NRRD_SIZES "type: uchar\nencoding: raw\nspace directions: (inf,0,0) (0,1,0) (0,0,1)\n\n" TWELVE,
     HL_ERROR_INPUT, "the spacing along axis 0 is inf"},
    {"origin.nrrd", NRRD_SIZES "space origin: 1 2 3\n\n", HL_ERROR_INPUT, "space origin cannot be \"1 2 3\""},
    {"list.nhdr", NRRD_SIZES "type: uchar\nencoding: raw\ndata file: LIST\na.raw\n", HL_ERROR_IO,
     "cannot open"},
    {"pattern.nhdr", NRRD_SIZES "type: uchar\nencoding: raw\ndata file: a%02d.raw 1 5 1\n", HL_ERROR_INPUT,
     "no whole part for each of 5 files"},
    {"percent.nhdr", NRRD_SIZES "type: uchar\nencoding: raw\ndata file: a%s.raw 1 5 1\n", HL_ERROR_IO,
     "cannot open"},
    {"absent.nhdr", NRRD_SIZES "type: uchar\nencoding: raw\ndata file: no such file\n", HL_ERROR_IO,
     "no such file: cannot open"},
    {"folder.nhdr", NRRD_SIZES "type: uchar\nencoding: raw\ndata file: .\n", HL_ERROR_IO, "is a folder"},
    {"device.nhdr", NRRD_SIZES "type: uchar\nencoding: raw\ndata file: /dev/zero\n", HL_ERROR_IO,
     "is not a regular file"},
    {"skip.nrrd", NRRD_SIZES "type: uchar\nencoding: raw\nbyte skip: 1000000000000\n\n" TWELVE,
     HL_ERROR_INPUT, "the file ends"},
    {"skip_gzip.nrrd", NRRD_SIZES "type: uchar\nencoding: gzip\nbyte skip: -1\n\n" TWELVE, HL_ERROR_INPUT,
     "damaged"},
    {"skip_word.nrrd", NRRD "byte skip: some\n\n", HL_ERROR_INPUT, "byte skip cannot be \"some\""},
    {"not_gzip.nrrd", NRRD_SIZES "type: uchar\nencoding: gzip\n\n" TWELVE, HL_ERROR_INPUT, "damaged"},
    {"not_hex.nrrd", NRRD_SIZES "type: uchar\nencoding: hex\n\n0102030405060708090a0bxy", HL_ERROR_INPUT,
     "end after 11"},
    {"word.nrrd", NRRD_SIZES "type: uchar\nencoding: ascii\n\n1 2 3 4 five 6 7 8 9 10 11 12", HL_ERROR_INPUT,
     "expected a number"},
    {"large.nrrd", NRRD_SIZES "type: uchar\nencoding: ascii\n\n1 2 3 4 5 256 7 8 9 10 11 12", HL_ERROR_INPUT,
     "256 does not fit"},
    {"real.nrrd", NRRD_SIZES "type: short\nencoding: ascii\n\n1 2 3 4 5 6.5 7 8 9 10 11 12", HL_ERROR_INPUT,
     "6.5 does not fit"},
    {"nan.nrrd", NRRD_SIZES "type: int\nencoding: ascii\n\n1 2 3 4 5 nan 7 8 9 10 11 12", HL_ERROR_INPUT,
     "does not fit"},
    {"count.nrrd", NRRD_SIZES "type: uchar\nencoding: ascii\n\n123456 123456 123456 12345", HL_ERROR_INPUT,
     "does not fit"},
    {"short.nrrd", NRRD_SIZES "type: uchar\nencoding: ascii\n\n10 20 30 40 50 60 70 80 90", HL_ERROR_INPUT,
     "only 9 numbers follow"},
    {"vectors.nrrd",
     NRRD "dimension: 4\nsizes: 3 3 2 2\ntype: uchar\nencoding: raw\nkinds: vector domain domain domain\n\n",
     HL_ERROR_INPUT, "promises 36 bytes"},
    {"series.nrrd", NRRD "dimension: 4\nsizes: 7 2 2 7\ntype: uchar\nencoding: raw\n\n", HL_ERROR_INPUT,
     "promises 196 bytes"},
    {"apart.nrrd",
     NRRD "dimension: 5\nsizes: 3 2 2 2 3\ntype: uchar\nencoding: raw\n"
          "kinds: vector domain domain domain list\n\n",
     HL_ERROR_UNSUPPORTED, "do not follow each other"},
    {"components.nrrd",
     NRRD "dimension: 5\nsizes: 3 2 2 18446744073709551615 9\ntype: uchar\nencoding: raw\n"
          "kinds: domain domain domain vector vector\n\n",
     HL_ERROR_INPUT, "promises 18446744073709551615 bytes"},
    /* MetaImage */
    {"dims.mha", "NDims = 11\n", HL_ERROR_INPUT, "line 1: NDims cannot be \"11\""},
    {"size.mha", "NDims = 3\nDimSize = 3 2\n", HL_ERROR_INPUT, "line 2: DimSize cannot be \"3 2\""},
    {"sizeless.mha", "NDims = 3\nElementType = MET_UCHAR\nElementDataFile = LOCAL\n", HL_ERROR_INPUT,
     "no DimSize"},
    {"typeless.mha", META "ElementDataFile = LOCAL\n", HL_ERROR_INPUT, "no ElementType"},
    {"type.mha", META "ElementType = MET_STRING\n", HL_ERROR_UNSUPPORTED, "\"MET_STRING\" is not read"},
    {"order.mha", "ElementType = MET_UCHAR\nElementSpacing = 1 1 1\n", HL_ERROR_INPUT,
     "NDims must come before ElementSpacing"},
    {"spacing.mha", META "ElementSpacing = 1 1 x\n", HL_ERROR_INPUT, "ElementSpacing cannot be \"1 1 x\""},
    {"matrix.mha", META "TransformMatrix = 1 0 0 0 1 0\n", HL_ERROR_INPUT, "TransformMatrix cannot be"},
    {"endless.mha", META "ElementType = MET_UCHAR\n", HL_ERROR_INPUT, "without ElementDataFile"},
    {"line.mha", META "what is this\n", HL_ERROR_INPUT, "line 3: expected \"Key = value\""},
    {"rgb.mha", META "ElementNumberOfChannels = 3\nElementType = MET_UCHAR\nElementDataFile = LOCAL\n",
     HL_ERROR_INPUT, "promises 36 bytes"},
    {"channels.mha", META "ElementNumberOfChannels = 0\nElementType = MET_UCHAR\nElementDataFile = LOCAL\n",
     HL_ERROR_INPUT, "0 channels"},
    {"time.mha", "NDims = 4\nDimSize = 3 2 2 5\nElementType = MET_UCHAR\nElementDataFile = LOCAL\n",
     HL_ERROR_INPUT, "promises 60 bytes"},
    {"both.mha",
     "NDims = 4\nDimSize = 3 2 2 5\nElementNumberOfChannels = 3\nElementType = MET_UCHAR\nElementDataFile = "
     "LOCAL\n",
     HL_ERROR_UNSUPPORTED, "3 channels in each of 5 volumes"},
    {"list.mhd", META "ElementType = MET_UCHAR\nElementDataFile = LIST\na.raw\n", HL_ERROR_IO, "cannot open"},
    {"tube.mha", "ObjectType = Tube\n", HL_ERROR_INPUT, "ObjectType cannot be \"Tube\""},
    {"flag.mha", META "CompressedData = Perhaps\n", HL_ERROR_INPUT, "CompressedData cannot be \"Perhaps\""},
    {"short.mha", META "ElementType = MET_SHORT\nElementDataFile = LOCAL\n" TWELVE, HL_ERROR_INPUT,
     "promises 24 bytes of voxels (3 x 2 x 2 int16), the file has only 12"},
    {"zlib.mha", META "CompressedData = True\nElementType = MET_UCHAR\nElementDataFile = LOCAL\n" TWELVE,
     HL_ERROR_INPUT, "damaged"},
    /* VGStudio */
    {"nothing.vgi", "{volume1}\n[file1]\nName = a\n", HL_ERROR_INPUT, "needs a part {volume1}"},
    {"size.vgi", "{volume1}\n[file1]\nSize = 3 2\n", HL_ERROR_INPUT, "line 3: Size cannot be \"3 2\""},
    {"vast.vgi", VGI "Size = 18446744073709551615 9 9\nDatatype = float\nBitsPerElement = 32\n",
     HL_ERROR_INPUT, "more memory than this program can address"},
    {"zero.vgi", VGI "Size = 3 0 2\nDatatype = float\nBitsPerElement = 32\n", HL_ERROR_INPUT, "3 x 0 x 2"},
    {"type.vgi", VGI "Size = 3 2 2\nDatatype = float\nBitsPerElement = 8\n", HL_ERROR_UNSUPPORTED,
     "\"float\" of 8 bits"},
    {"packed.vgi", VGI "FileFormat = zip\n", HL_ERROR_UNSUPPORTED, "FileFormat \"zip\" is not read"},
    {"several.vgi", VGI "[file2]\nName = b\n", HL_ERROR_UNSUPPORTED, "voxels in several files"},
    {"sizes.vgi", "{volume1}\n[representation]\nsize = 3 2 1\n[file1]\nName = a\nSize = 3 2 2\n",
     HL_ERROR_UNSUPPORTED, "different sizes"},
    {"part.vgi", "{volume1}\n[file1\n", HL_ERROR_INPUT, "a section's name cannot be"},
    {"cut.vgi", "{volume1}\n[file1]\nName = a\nSize = 3 2 2\nDatatype = float\nBitsPerElement = 32\n",
     HL_ERROR_INPUT, "no resolution"},
    {"missing.vgi", VGI "Size = 3 2 2\nDatatype = signed integer\nBitsPerElement = 16\n", HL_ERROR_IO,
     "cannot open"},
    /* VolVis */
    {"bits.slc", "11111\n2 1 1 16\n1 1 1\n1 6 0 0\n0 0 Xab", HL_ERROR_UNSUPPORTED, "voxels of 16 bits"},
    {"packing.slc", "11111\n2 1 1 8\n1 1 1\n1 6 0 2\n0 0 Xab", HL_ERROR_UNSUPPORTED, "in the way 2"},
    {"spacing.slc", "11111\n2 1 1 8\n1 one 1\n1 6 0 0\n0 0 Xab", HL_ERROR_INPUT, "a spacing must stand"},
    {"mark.slc", "11111\n2 1 1 8\n1 1 1\n1 6 0 0\n0 0 Yab", HL_ERROR_INPUT, "an X must stand here"},
    {"vast.slc", "11111\n99999999 99999999 99999999 8\n1 1 1\n1 6 0 1\n0 0 X", HL_ERROR_INPUT,
     "more memory than this program can address"},
    {"picture.slc", "11111\n2 1 1 8\n1 1 1\n1 6 0 0\n99999999999 9 X", HL_ERROR_INPUT,
     "picture is too large"},
    {"word.slc", "11111\n2 1 1 8\n1 1 1\n1 6 0 0\n" LONG_LINE, HL_ERROR_INPUT, "a whole number must stand"},
    {"short.slc", "11111\n2 1 1 8\n1 1 1\n1 6 0 1\n0 0 X1 X\x82", HL_ERROR_INPUT, "slice is too short"},
    {"long.slc", "11111\n2 1 1 8\n1 1 1\n1 6 0 1\n0 0 X3 X\3a", HL_ERROR_INPUT, "slice is damaged"},
    {"ended.slc", "11111\n2 1 2 8\n1 1 1\n1 6 0 1\n0 0 X2 X\2a", HL_ERROR_INPUT, "number must stand"},
    /* NumPy: the mark, version 1.0, the header's length as two bytes */
    {"version.npy", "\x93NUMPY\4.\1\1", HL_ERROR_UNSUPPORTED, "version 4 of the format"},
    {"length.npy", "\x93NUMPY\1.\1a{", HL_ERROR_INPUT, "the file ends here"},
    {"list.npy", "\x93NUMPY\1.\1\1[1, 2]" LONG_LINE, HL_ERROR_INPUT, "begins with '{'"},
    {"record.npy", "\x93NUMPY\1.\1\1{'descr': [('a', '<f4')]}" LONG_LINE, HL_ERROR_UNSUPPORTED,
     "one plain type"},
    {"object.npy", "\x93NUMPY\1.\1\1{'descr': '|O'}" LONG_LINE, HL_ERROR_UNSUPPORTED,
     "not as elements of type \"|O\""},
    {"key.npy", "\x93NUMPY\1.\1\1{'order': 1}" LONG_LINE, HL_ERROR_INPUT, "not \"order\""},
    {"order.npy", "\x93NUMPY\1.\1\1{'fortran_order': Perhaps}" LONG_LINE, HL_ERROR_INPUT, "True or False"},
    {"lacks.npy", "\x93NUMPY\1.\1\1{'descr': '<f4', 'shape': (2, 2, 2)}" LONG_LINE, HL_ERROR_INPUT,
     "lacks fortran_order"},
    {"shape.npy", NPY "'shape': (2, -2, 2)}" LONG_LINE, HL_ERROR_INPUT, "expected a count"},
    {"line.npy", NPY "'shape': (8,)}" LONG_LINE, HL_ERROR_UNSUPPORTED, "1 axes"},
    {"five.npy", NPY "'shape': (2, 2, 2, 2, 2)}" LONG_LINE, HL_ERROR_UNSUPPORTED, "more than four axes"},
    {"zero.npy", NPY "'shape': (2, 0, 2)}" LONG_LINE, HL_ERROR_INPUT, "has a zero"},
    {"none.npy", NPY "'shape': (2, 2, 2, 0)}" LONG_LINE, HL_ERROR_INPUT, "has a zero"},
    {"vast.npy", NPY "'shape': (99999999999, 99999999999, 2)}" LONG_LINE, HL_ERROR_INPUT,
     "more memory than this program can address"},
    {"promise.npy", NPY "'shape': (999, 999, 999)}" LONG_LINE, HL_ERROR_INPUT, "promises 3988011996 bytes"},
    /* legacy VTK */
    {"coding.vtk", "# vtk DataFile Version 3.0\nt\nMORSE\n", HL_ERROR_INPUT,
     "line 3: expected ASCII or BINARY"},
    {"kind.vtk", "# vtk DataFile Version 3.0\nt\nASCII\nDATASET POLYDATA\n", HL_ERROR_UNSUPPORTED,
     "\"POLYDATA\" is not read"},
    {"sizes.vtk", "# vtk DataFile Version 3.0\nt\nASCII\nDATASET STRUCTURED_POINTS\nDIMENSIONS 3 2\n",
     HL_ERROR_INPUT, "three numbers"},
    {"dataless.vtk", VTK, HL_ERROR_INPUT, "without POINT_DATA"},
    {"count.vtk", VTK "POINT_DATA 13\nSCALARS a char\nLOOKUP_TABLE default\n1\n", HL_ERROR_INPUT,
     "POINT_DATA has 13 values"},
    {"points.vtk", VTK "POINT_DATA -1\n", HL_ERROR_INPUT, "expected the number of values"},
    {"type.vtk", VTK "POINT_DATA 12\nSCALARS a quark\n", HL_ERROR_INPUT, "\"quark\" are not read"},
    {"bit.vtk", VTK "POINT_DATA 12\nSCALARS a bit\n", HL_ERROR_UNSUPPORTED, "\"bit\" are not read"},
    {"scalars.vtk", VTK "POINT_DATA 12\nSCALARS a\n", HL_ERROR_INPUT, "expected \"SCALARS name type"},
    {"rgb.vtk", VTK "POINT_DATA 1\nSCALARS a char 3\nLOOKUP_TABLE default\n1 2 3\n", HL_ERROR_INPUT,
     "POINT_DATA has 1 values"},
    {"vectors.vtk", VTK "POINT_DATA 12\nVECTORS v float\n", HL_ERROR_INPUT,
     "promises 71 bytes of voxels as text"},
    {"pairs.vtk", VTK "POINT_DATA 12\nPAIRS v float\n", HL_ERROR_UNSUPPORTED, "\"PAIRS\" is not read"},
    {"field.vtk", VTK "POINT_DATA 12\nFIELD f many\n", HL_ERROR_INPUT, "expected \"FIELD name number\""},
    {"array.vtk", VTK "POINT_DATA 12\nFIELD f 1\na 1\n", HL_ERROR_INPUT,
     "expected \"name components tuples type\""},
    {"product.vtk", VTK "POINT_DATA 12\nFIELD f 1\na 9999999999 9999999999 char\n", HL_ERROR_INPUT,
     "impossible number"},
    {"sizeless.vtk",
     "# vtk DataFile Version 3.0\nt\nASCII\nPOINT_DATA 1\nSCALARS a char\nLOOKUP_TABLE d\n1\n",
     HL_ERROR_INPUT, "no DIMENSIONS"},
    /* VTK image data */
    {"root.vti", "<?xml version='1.0'?><svg/>", HL_ERROR_UNSUPPORTED, "first element is \"svg\""},
    {"kind.vti", "<VTKFile type=\"PolyData\">", HL_ERROR_UNSUPPORTED, "a mesh, not a volume"},
    {"order.vti", "<VTKFile type=\"ImageData\" byte_order=\"Middle\">", HL_ERROR_INPUT,
     "byte_order \"Middle\""},
    {"header.vti", "<VTKFile type=\"ImageData\" header_type=\"UInt7\">", HL_ERROR_INPUT,
     "header_type \"UInt7\""},
    {"lz4.vti", "<VTKFile type=\"ImageData\" compressor=\"vtkOtherDataCompressor\">", HL_ERROR_UNSUPPORTED,
     "\"vtkOtherDataCompressor\" is not read"},
    {"doctype.vti", "<?xml version='1.0'?><!DOCTYPE a [<!ENTITY b \"c\">]>", HL_ERROR_INPUT, "document type"},
    {"extent.vti", VTI "<ImageData WholeExtent=\"0 2 0 1 0\">", HL_ERROR_INPUT, "WholeExtent \"0 2 0 1 0\""},
    {"reverse.vti", VTI "<ImageData WholeExtent=\"0 2 5 1 0 1\">", HL_ERROR_INPUT, "WholeExtent"},
    {"nan.vti", VTI "<ImageData WholeExtent=\"nan 2 0 1 0 1\">", HL_ERROR_INPUT, "WholeExtent"},
    {"huge.vti", VTI "<ImageData WholeExtent=\"0 1e30 0 1 0 1\">", HL_ERROR_INPUT, "WholeExtent"},
    {"arrayless.vti", IMAGE "</PointData></ImageData></VTKFile>", HL_ERROR_INPUT, "no DataArray"},
    {"extentless.vti", VTI "<ImageData><PointData><DataArray type=\"Int8\"/>", HL_ERROR_INPUT,
     "no WholeExtent"},
    {"typeless.vti", IMAGE "<DataArray>1</DataArray>", HL_ERROR_INPUT, "DataArray's type"},
    {"type.vti", IMAGE "<DataArray type=\"Bit\">1</DataArray>", HL_ERROR_UNSUPPORTED, "\"Bit\" is not read"},
    {"quark.vti", IMAGE "<DataArray type=\"Quark\">1</DataArray>", HL_ERROR_INPUT, "\"Quark\" is impossible"},
    {"format.vti", IMAGE "<DataArray type=\"Int8\" format=\"wax\">1</DataArray>", HL_ERROR_INPUT,
     "format \"wax\""},
    {"rgb.vti", IMAGE "<DataArray type=\"Int8\" NumberOfComponents=\"3\">1</DataArray>", HL_ERROR_INPUT,
     "ends before </VTKFile>"},
    {"rgb_whole.vti",
     IMAGE
     "<DataArray type=\"Int8\" NumberOfComponents=\"3\">1</DataArray></PointData></ImageData></VTKFile>",
     HL_ERROR_INPUT, "promises 71 bytes of voxels as text"},
    {"offset.vti", IMAGE "<DataArray type=\"Int8\" format=\"appended\"/>", HL_ERROR_INPUT, "offset"},
    {"appended.vti", IMAGE "<DataArray type=\"Int8\" format=\"appended\" offset=\"0\"/></PointData>",
     HL_ERROR_INPUT, "AppendedData"},
    {"mark.vti",
     IMAGE "<DataArray type=\"Int8\" format=\"appended\" offset=\"0\"/><AppendedData encoding=\"raw\">x",
     HL_ERROR_INPUT, "must begin with '_'"},
    {"far.vti",
     IMAGE "<DataArray type=\"Int8\" format=\"appended\" offset=\"18446744073709551615\"/><AppendedData>_x",
     HL_ERROR_INPUT, "impossible offset"},
    {"length.vti",
     IMAGE "<DataArray type=\"Int8\" format=\"binary\">DQAAAAAAAAAAAAAAAAAAAAAAAAA=</DataArray>",
     HL_ERROR_INPUT, "promises 12 bytes of voxels, the array has 13"},
    {"blocks.vti",
     "<VTKFile type=\"ImageData\" compressor=\"vtkZLibDataCompressor\"><ImageData WholeExtent=\"0 2 0 1 0 "
     "1\">"
     "<PointData><DataArray type=\"Int8\" format=\"binary\">/////wEAAAAAAAAAAAAAAA==</DataArray>",
     HL_ERROR_INPUT, "hold another number"},
    {"short.vti", IMAGE "<DataArray type=\"Int8\">1 2 3 4 5 6 7 8 9 10 11</DataArray>", HL_ERROR_INPUT,
     "only 11 numbers"},
    {"pieces.vti", VTI "<ImageData WholeExtent=\"0 2 0 1 0 1\"><Piece/><Piece/>", HL_ERROR_INPUT,
     "no DataArray"},
    {"tag.vti", VTI "<ImageData WholeExtent=\"0 2 0 1 0 1\"", HL_ERROR_INPUT, "a tag does not end"},
    /* raw voxels, and a file that is no volume */
    {"3x2x2_uint8.raw", "1234567890123", HL_ERROR_INPUT,
     "its name promises 3 x 2 x 2 uint8, 12 bytes, but the data are longer"},
    {"3x2x2_uint16.raw", TWELVE, HL_ERROR_INPUT,
     "its name promises 24 bytes of voxels (3 x 2 x 2 uint16), the file has only 12"},
    {"0x2x2_uint8.raw", "1", HL_ERROR_INPUT, "at least 1"},
    {"nameless.raw", TWELVE, HL_ERROR_INPUT, "name_256x256x128_uint8.raw"},
    {"3x2_uint8.raw", TWELVE, HL_ERROR_INPUT, "name_256x256x128_uint8.raw"},
    {"3x2x2_uint9.raw", TWELVE, HL_ERROR_INPUT, "name_256x256x128_uint8.raw"},
    {"fieldless.dat", "ObjectFileName: a\n", HL_ERROR_INPUT, "needs the lines"},
    {"format.dat", "ObjectFileName: a\nFormat: QUARK\n", HL_ERROR_INPUT,
     "line 2: Format cannot be \"QUARK\""},
    {"notes.txt", "just some text", HL_ERROR_INPUT, "not a volume file that is known"},
    {"picture.png", "\x89PNG\r\n\x1a\n and so on", HL_ERROR_UNSUPPORTED, "a picture"},
    {"smoke.vdb", " BDV and so on", HL_ERROR_UNSUPPORTED, "halflight convert"},
    {"packed.nrrd.bz2", "BZh11AY", HL_ERROR_INPUT, "is it cut short?"},
    {"no.nii", "no header here", HL_ERROR_INPUT, "begins with 348 or 540"},
};

static void check_clean_error(const hl_error *error, hl_status status, const char *path, const char *part) {
  if (error->code != status || strstr(error->message, part) == NULL)
    print_message("# %s: status %d, \"%s\", expected %d and \"%s\"\n", path, (int)error->code, error->message,
                  (int)status, part);
  assert_int_equal(error->code, status);
  assert_non_null(strstr(error->message, part));
  for (const char *c = error->message; *c != 0; c++)
    assert_true(*c >= ' ' && *c <= '~'); /* one printable line */
}

static void test_malformed_files(void **unused) {
  (void)unused;
  char folder[FOLDER_BYTES], path[PATH_BYTES];
  hl_context *context = NULL;
  make_folder(folder);
  assert_int_equal(hl_context_create(NULL, &context, NULL), HL_OK);
  for (size_t n = 0; n < sizeof files / sizeof *files; n++) {
    byte_buffer content = {.length = 0};
    hl_error error = {0};
    hl_volume *volume = NULL;
    add(&content, files[n].content, strlen(files[n].content));
    write_file(folder, files[n].name, &content, path);
    hl_status status = hl_volume_load(context, path, &volume, &error);
    assert_null(volume);
    assert_int_equal(status, error.code);
    check_clean_error(&error, files[n].status, path, files[n].message);
    assert_non_null(
        strstr(error.message, strstr(error.message, "/dev/zero") ? "/dev/zero" : folder)); /* the file */
    assert_int_equal(hl_context_memory_held(context), 0);
    /* no memory was taken for the size that the header claims */
    assert_true(hl_context_memory_peak(context) < 1 << 20);
    assert_int_equal(hl_volume_load(context, path, &volume, NULL), files[n].status);
  }
  hl_context_destroy(context);
  remove_folder(folder);
}

static void test_absent_files_and_null_arguments(void **unused) {
  (void)unused;
  hl_context *context = NULL;
  hl_volume *volume = NULL;
  hl_error error = {0};
  assert_int_equal(hl_context_create(NULL, &context, NULL), HL_OK);
  assert_int_equal(hl_volume_load(context, "/no/such/file.nrrd", &volume, &error), HL_ERROR_IO);
  assert_non_null(strstr(error.message, "/no/such/file.nrrd: cannot open"));
  char folder[FOLDER_BYTES];
  make_folder(folder);
  assert_int_equal(hl_volume_load(context, folder, &volume, &error), HL_ERROR_INPUT);
  assert_non_null(strstr(error.message, "a folder in which no volume was found"));
  remove_folder(folder);
  assert_int_equal(hl_volume_load(context, NULL, &volume, &error), HL_ERROR_ARGUMENT);
  assert_int_equal(hl_volume_load(NULL, "a", &volume, &error), HL_ERROR_ARGUMENT);
  assert_int_equal(hl_volume_load(context, "a", NULL, &error), HL_ERROR_ARGUMENT);
  hl_context_destroy(context);
}

/* NIfTI headers in which one field is wrong: its offset and its new bytes. */
static void test_malformed_nifti(void **unused) {
  (void)unused;
  static const struct {
    size_t place;
    const char *value;
    size_t length;
    hl_status status;
    const char *message;
  } faults[] = {{40, "\0\0", 2, HL_ERROR_INPUT, "dim[0] is 0"},
                {40, "\x08\0", 2, HL_ERROR_INPUT, "dim[0] is 8"},
                {42, "\xff\xff", 2, HL_ERROR_INPUT, "dim[1] is -1"},
                {40, "\4\0\3\0\2\0\2\0\5\0", 10, HL_ERROR_INPUT, "promises 60 bytes"},
                {40, "\5\0\3\0\2\0\2\0\1\0\3\0", 12, HL_ERROR_INPUT, "promises 36 bytes"},
                {40, "\5\0\3\0\2\0\2\0\x03\0\3\0", 12, HL_ERROR_INPUT, "promises 108 bytes"},
                {70, "\x80\0", 2, HL_ERROR_INPUT, "promises 36 bytes"},
                {70, "\x00\x08", 2, HL_ERROR_UNSUPPORTED, "complex float128"},
                {70, "\x00\6", 2, HL_ERROR_UNSUPPORTED, "float128"},
                {70, "\x39\5", 2, HL_ERROR_INPUT, "no NIfTI datatype 1337"},
                {112, "\0\0\x80\x3f\0\0\xc0\x7f", 8, HL_ERROR_INPUT, "scl_inter is not a finite number"},
                {108, "\0\0\xc0\x7f", 4, HL_ERROR_INPUT, "vox_offset"},
                {108, "\0\0\xc8\xc2", 4, HL_ERROR_INPUT, "vox_offset is -100"},
                {108, "\0\0\xc8\x4b", 4, HL_ERROR_INPUT, "the file ends at byte"},
                {42, "\xff\x7f\xff\x7f\xff\x7f", 6, HL_ERROR_INPUT, "32767 x 32767 x 32767"},
                {344, "\0\0\0\0", 4, HL_ERROR_IO, "a.img: cannot open"}}; /* as ANALYZE */
  char folder[FOLDER_BYTES], path[PATH_BYTES];
  hl_context *context = NULL;
  make_folder(folder);
  assert_int_equal(hl_context_create(NULL, &context, NULL), HL_OK);
  for (size_t n = 0; n < sizeof faults / sizeof *faults; n++) {
    byte_buffer file = {.length = 0};
    static const unsigned char start[] = {0x5c, 1, 0, 0};
    add(&file, start, 4);
    file.length = 344;
    add(&file, "n+1\0\0\0\0\0" TWELVE, 20);
    static const unsigned char dimensions[] = {3, 0, 3, 0, 2, 0, 2, 0};
    memcpy(file.data + 40, dimensions, sizeof dimensions);
    file.data[70] = 2;
    memcpy(file.data + faults[n].place, faults[n].value, faults[n].length);
    write_file(folder, "a.nii", &file, path);
    hl_error error = {0};
    hl_volume *volume = NULL;
    assert_int_not_equal(hl_volume_load(context, path, &volume, &error), HL_OK);
    check_clean_error(&error, faults[n].status, path, faults[n].message);
  }
  hl_context_destroy(context);
  remove_folder(folder);
}

typedef struct damage_state {
  hl_context *context;
  char folder[FOLDER_BYTES];
  int loads, failures;
  uint64_t random;
} damage_state;

static damage_state begin_damage(void) {
  damage_state state = {.random = 7};
  hl_context_options options;
  hl_context_options_defaults(&options);
  options.memory_limit = 64 << 20;
  make_folder(state.folder);
  assert_int_equal(hl_context_create(&options, &state.context, NULL), HL_OK);
  return state;
}

static void end_damage(damage_state *state) {
  assert_int_equal(state->failures, 0);
  hl_context_destroy(state->context);
  remove_folder(state->folder);
}

/* Loads a damaged file. The call may fail with a message. A volume must not leak. Returns whether the first
 * voxels are those of before the damage. */
static bool load_damaged(damage_state *state, const char *path, const volume_sample *sample, int voxels,
                         hl_status *status) {
  hl_error error = {0};
  hl_volume *volume = NULL;
  *status = hl_volume_load(state->context, path, &volume, &error);
  bool same = *status == HL_OK && is_sample(volume, sample, voxels);
  bool clean = *status == HL_OK ? volume != NULL : volume == NULL && strlen(error.message) > 10;
  hl_volume_release(volume);
  if (!clean || hl_context_memory_held(state->context) != 0) state->failures++;
  state->loads++;
  return same;
}

static bool is_chosen(const volume_sample *sample) {
  return sample->type == HL_VOXEL_I16 || sample->type == HL_VOXEL_U8;
}

/* Each shorter file fails or gives the whole volume, since only the end of a compressed file may be missing.
 */
static void truncate_sample(const volume_sample *sample, void *data) {
  damage_state *state = data;
  if (!is_chosen(sample)) return;
  char path[PATH_BYTES], other[PATH_BYTES];
  write_sample(state->folder, sample, path);
  snprintf(other, sizeof other, "%s/%s", state->folder, sample->other_name);
  for (int which = 0; which < (sample->other_name[0] != 0 ? 2 : 1); which++)
    for (size_t length = which ? sample->other.length : sample->file.length; length-- > 0;) {
      assert_int_equal(truncate(which ? other : path, (off_t)length), 0);
      hl_status status;
      /* If the last number of a text has fewer digits, it is another number, which no reader can know. */
      int voxels = sample->is_text ? VOXELS - 1 : VOXELS;
      if (load_damaged(state, path, sample, voxels, &status) || status != HL_OK) continue;
      print_message("# %s cut to %zu bytes: other voxels\n", sample->name, length);
      state->failures++;
    }
  remove_sample(state->folder, sample);
}

static void test_truncation_at_every_length(void **unused) {
  (void)unused;
  damage_state state = begin_damage();
  for_each_sample(truncate_sample, &state);
  assert_true(state.loads > 50000);
  end_damage(&state);
}

/* One byte of the file is changed, at every place in turn. */
static void mutate_sample(const volume_sample *sample, void *data) {
  damage_state *state = data;
  if (sample->type != HL_VOXEL_U16) return;
  char path[PATH_BYTES];
  write_sample(state->folder, sample, path);
  FILE *file = fopen(path, "r+b");
  assert_non_null(file);
  setvbuf(file, NULL, _IONBF, 0);
  for (size_t place = 0; place < sample->file.length; place++) {
    state->random = state->random * 6364136223846793005u + 1442695040888963407u;
    static const unsigned char special[] = {0, 0xff, ' ', '\n', '9', '-', '<', '"'};
    unsigned kind = (unsigned)(state->random >> 60), old = sample->file.data[place];
    fseek(file, (long)place, SEEK_SET);
    fputc(kind < 8 ? special[kind] : (int)(state->random >> 32 & 255), file);
    hl_status status;
    load_damaged(state, path, sample, VOXELS, &status);
    fseek(file, (long)place, SEEK_SET);
    fputc((int)old, file);
  }
  fclose(file);
  remove_sample(state->folder, sample);
}

static void test_one_byte_changed(void **unused) {
  (void)unused;
  damage_state state = begin_damage();
  for_each_sample(mutate_sample, &state);
  assert_true(state.loads > 20000);
  end_damage(&state);
}

/* An allocator whose n-th request fails. */
typedef struct failing_allocator {
  int requests, fail_at;
} failing_allocator;

static void *allocate_or_fail(void *user_data, size_t size, size_t alignment) {
  failing_allocator *allocator = user_data;
  if (++allocator->requests == allocator->fail_at) return NULL;
  return aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
}

static void release(void *user_data, void *memory) {
  (void)user_data;
  free(memory);
}

static void starve_sample(const volume_sample *sample, void *data) {
  damage_state *state = data;
  if (sample->type != HL_VOXEL_F32) return;
  char path[PATH_BYTES];
  write_sample(state->folder, sample, path);
  hl_status status = HL_ERROR_MEMORY;
  int fail_at = 2; /* the first allocation is the context's */
  for (; status == HL_ERROR_MEMORY && fail_at < 60; fail_at++) {
    failing_allocator allocator = {.fail_at = fail_at};
    hl_context_options options;
    hl_context_options_defaults(&options);
    options.user_data = &allocator;
    options.allocate = allocate_or_fail;
    options.release = release;
    hl_context *context = NULL;
    hl_volume *volume = NULL;
    assert_int_equal(hl_context_create(&options, &context, NULL), HL_OK);
    status = hl_volume_load(context, path, &volume, NULL);
    hl_volume_release(volume);
    if (hl_context_memory_held(context) != 0) state->failures++;
    hl_context_destroy(context);
    state->loads++;
  }
  if (status != HL_OK || fail_at < 6) {
    print_message("# %s: status %d with request %d failing\n", sample->name, (int)status, fail_at - 1);
    state->failures++;
  }
  remove_sample(state->folder, sample);
}

static void test_every_allocation_failing(void **unused) {
  (void)unused;
  damage_state state = begin_damage();
  for_each_sample(starve_sample, &state);
  assert_true(state.loads > 500);
  end_damage(&state);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_malformed_files),  cmocka_unit_test(test_absent_files_and_null_arguments),
      cmocka_unit_test(test_malformed_nifti),  cmocka_unit_test(test_truncation_at_every_length),
      cmocka_unit_test(test_one_byte_changed), cmocka_unit_test(test_every_allocation_failing),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
