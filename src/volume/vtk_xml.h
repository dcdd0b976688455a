/* volume/vtk_xml.h - shared by the readers of all of VTK's XML files: the first tag, the places of the values
 * of arrays, and their encoding. */
#ifndef HL_VOLUME_VTK_XML_H
#define HL_VOLUME_VTK_XML_H

#include "volume/decoders.h"
#include "volume/volume.h"
#include "volume/xml.h"

enum { HL_VTK_NAME_BYTES = 256 };

typedef struct hl_vtk_xml {
  hl_stream *stream; /* borrowed; the tags are read from it */
  bool big_endian;
  hl_vtk_packing packing; /* packing of binary values */
  size_t header_bytes;    /* bytes of each integer before binary values; 0 if the first tag has not been
                           * read */
  uint64_t appended;      /* position in the file of the appended data's first byte; 0 if there are none */
  bool appended_is_base64;
} hl_vtk_xml;

typedef enum hl_vtk_encoding { HL_VTK_ASCII, HL_VTK_BINARY, HL_VTK_APPENDED } hl_vtk_encoding;

/* An array of the file. */
typedef struct hl_vtk_array {
  char type[HL_VTK_NAME_BYTES];
  hl_vtk_encoding encoding;
  uint64_t place; /* position of the values: in the file for inline values, in the appended data for appended
                   * ones */
} hl_vtk_array;

/* Whether a file that starts with these bytes is an XML file, VTK's or any other. */
bool hl_vtk_xml_has_content(const unsigned char *bytes, size_t length);

/* Fails for a value that is impossible or, with HL_ERROR_UNSUPPORTED, not read. */
hl_status hl_vtk_xml_refuse(const hl_vtk_xml *xml, hl_status code, const char *what, const char *value,
                            hl_error *error);

/* Reads <VTKFile>, which must have the type `wanted`. */
hl_status hl_vtk_xml_file_tag(hl_vtk_xml *xml, const hl_xml_tag *tag, const char *wanted, hl_error *error);

/* Reads <DataArray>: the place of the values and their encoding. */
hl_status hl_vtk_xml_array_tag(const hl_vtk_xml *xml, const hl_xml_tag *tag, hl_vtk_array *array,
                               hl_error *error);

/* Reads <AppendedData>, up to the first byte of its arrays. */
hl_status hl_vtk_xml_appended_tag(hl_vtk_xml *xml, const hl_xml_tag *tag, hl_error *error);

/* Finds a type by its name in the file. False if there is no such type of numbers. */
bool hl_vtk_xml_find_type(const char *name, hl_voxel_type *type);
/* Finds a type like hl_vtk_xml_find_type(). Fails if there is none. */
hl_status hl_vtk_xml_type(const hl_vtk_xml *xml, const char *name, hl_voxel_type *type, hl_error *error);

/* Opens the file of *stream again at the array's values, and pushes the decoders of the array's encoding.
 * Binary values must have `promised` bytes. */
hl_status hl_vtk_xml_open_array(hl_stream **stream, const hl_vtk_xml *xml, const hl_vtk_array *array,
                                uint64_t promised, hl_error *error);

#endif
