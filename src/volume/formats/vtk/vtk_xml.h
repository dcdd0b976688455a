/* volume/formats/vtk/vtk_xml.h - functions that all readers of VTK's XML files share. The functions read the
 * first tag, and find the position and the encoding of an array's values. */
#ifndef HL_VOLUME_VTK_XML_H
#define HL_VOLUME_VTK_XML_H

#include "volume/io/decoders.h"
#include "volume/io/xml.h"
#include "volume/volume.h"

enum { HL_VTK_NAME_BYTES = 256 };

typedef struct hl_vtk_xml {
  hl_stream *stream; /* borrowed; the stream from which tags are read */
  bool big_endian;
  hl_vtk_packing packing; /* packing of binary values */
  size_t header_bytes;    /* size in bytes of the integers that stand before binary values; 0 until the first
                           * tag has been read */
  uint64_t appended;      /* position in the file of the appended data's first byte; 0 if the file has no
                           * appended data */
  bool appended_is_base64;
  bool is_closed; /* whether the end of the element VTKFile has been read */
} hl_vtk_xml;

typedef enum hl_vtk_encoding { HL_VTK_ASCII, HL_VTK_BINARY, HL_VTK_APPENDED } hl_vtk_encoding;

/* The type, the encoding and the position of an array in the file. */
typedef struct hl_vtk_array {
  char type[HL_VTK_NAME_BYTES];
  hl_vtk_encoding encoding;
  uint64_t place; /* position of the values: for inline values in the file, for appended values in the
                   * appended data */
} hl_vtk_array;

/* Returns whether a file that starts with these bytes is an XML file, of VTK or any other kind. */
bool hl_vtk_xml_has_content(const unsigned char *bytes, size_t length);

/* Returns whether the first bytes of a file are XML and name a type of VTK's files in the list. types:
 * [count], such as "ImageData". */
bool hl_vtk_xml_is_of(const unsigned char *bytes, size_t length, const char *const types[], size_t count);

/* Reads the tags up to the appended data, or to the file's end, and calls read_tag() for each tag. */
typedef hl_status hl_vtk_xml_tag_fn(void *data, const hl_xml_tag *tag, hl_error *error);
hl_status hl_vtk_xml_read_tags(hl_vtk_xml *xml, hl_vtk_xml_tag_fn *read_tag, void *data, hl_error *error);
/* Refuses a file that ends before its appended data and before its element VTKFile is closed. */
hl_status hl_vtk_xml_check_end(const hl_vtk_xml *xml, hl_error *error);

/* Reads an attribute that is a count. If the attribute is absent, *count is not changed. */
hl_status hl_vtk_xml_count(const hl_vtk_xml *xml, const hl_xml_tag *tag, const char *name, size_t *count,
                           hl_error *error);

/* Copies a name. The copy is empty if the name is null or too long. */
void hl_vtk_xml_copy_name(char to[HL_VTK_NAME_BYTES], const char *name);

/* Makes room for one more element of a list that has `count` elements. *list: owned, [*room] elements of
 * `size` bytes. */
hl_status hl_vtk_xml_grow(hl_context *context, const hl_vtk_xml *xml, void **list, size_t count, size_t *room,
                          size_t size, hl_error *error);

/* Fails with an error that names a wrong value of `what`. With HL_ERROR_UNSUPPORTED the error says that the
 * value is not supported, otherwise that it is impossible. */
hl_status hl_vtk_xml_refuse(const hl_vtk_xml *xml, hl_status code, const char *what, const char *value,
                            hl_error *error);

/* Reads the tag <VTKFile>, whose type must be `wanted`. */
hl_status hl_vtk_xml_file_tag(hl_vtk_xml *xml, const hl_xml_tag *tag, const char *wanted, hl_error *error);

/* Reads the tag <DataArray>, which states the position and the encoding of an array's values. */
hl_status hl_vtk_xml_array_tag(const hl_vtk_xml *xml, const hl_xml_tag *tag, hl_vtk_array *array,
                               hl_error *error);

/* Reads the tag <AppendedData>, and moves the stream to the first byte of the appended arrays. */
hl_status hl_vtk_xml_appended_tag(hl_vtk_xml *xml, const hl_xml_tag *tag, hl_error *error);

/* Finds a type by its name in the file. Returns false if the name is not the name of a type of numbers. */
bool hl_vtk_xml_find_type(const char *name, hl_voxel_type *type);
/* Does what hl_vtk_xml_find_type() does, but fails if no type has the name. */
hl_status hl_vtk_xml_type(const hl_vtk_xml *xml, const char *name, hl_voxel_type *type, hl_error *error);

/* Opens the file of *stream again, moves the stream to an array's values, and pushes the decoders of the
 * values' encoding. *stream is replaced. promised: the number of bytes that binary values must have. */
hl_status hl_vtk_xml_open_array(hl_stream **stream, const hl_vtk_xml *xml, const hl_vtk_array *array,
                                uint64_t promised, hl_error *error);

#endif
