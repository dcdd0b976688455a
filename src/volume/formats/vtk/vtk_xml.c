/* volume/formats/vtk/vtk_xml.c - functions that all readers of VTK's XML files share. */
#include "volume/formats/vtk/vtk_xml.h"

#include <stdio.h>
#include <string.h>

#include "core/memory.h"
#include "volume/formats/format.h"
#include "volume/io/decoders.h"
#include "volume/io/text.h"

bool hl_vtk_xml_has_content(const unsigned char *bytes, size_t length) {
  size_t n = length >= 3 && memcmp(bytes, "\xef\xbb\xbf", 3) == 0 ? 3 : 0; /* skips the byte order mark */
  while (n < length && hl_is_space((char)bytes[n])) n++;
  return (length - n >= 5 && memcmp(bytes + n, "<?xml", 5) == 0) ||
         (length - n >= 8 && memcmp(bytes + n, "<VTKFile", 8) == 0);
}

bool hl_vtk_xml_is_of(const unsigned char *bytes, size_t length, const char *const types[], size_t count) {
  char mark[HL_VTK_NAME_BYTES];
  if (!hl_vtk_xml_has_content(bytes, length)) return false;
  for (size_t n = 0; n < count; n++) {
    size_t mark_length = (size_t)snprintf(mark, sizeof mark, "type=\"%s\"", types[n]);
    for (size_t at = 0; at + mark_length <= length; at++)
      if (memcmp(bytes + at, mark, mark_length) == 0) return true;
  }
  return false;
}

hl_status hl_vtk_xml_read_tags(hl_vtk_xml *xml, hl_vtk_xml_tag_fn *read_tag, void *data, hl_error *error) {
  hl_xml_tag tag;
  bool ended = false;
  while (!ended && xml->appended == 0) {
    hl_status status = hl_xml_next_tag(xml->stream, &tag, &ended, error);
    if (status == HL_OK && !ended) status = read_tag(data, &tag, error);
    if (status != HL_OK) return status;
    if (!ended && tag.is_end && strcmp(tag.name, "VTKFile") == 0) xml->is_closed = true;
  }
  return HL_OK;
}

hl_status hl_vtk_xml_check_end(const hl_vtk_xml *xml, hl_error *error) {
  if (xml->is_closed || xml->appended != 0) return HL_OK;
  return hl_fail(error, HL_ERROR_INPUT, "%s: the file is cut short: it ends before </VTKFile>",
                 xml->stream->path);
}

hl_status hl_vtk_xml_count(const hl_vtk_xml *xml, const hl_xml_tag *tag, const char *name, size_t *count,
                           hl_error *error) {
  const char *value = hl_xml_attribute(tag, name);
  if (value == NULL || hl_text_sizes(value, count, 1) == 1) return HL_OK;
  return hl_vtk_xml_refuse(xml, HL_ERROR_INPUT, name, value, error);
}

void hl_vtk_xml_copy_name(char to[HL_VTK_NAME_BYTES], const char *name) {
  to[0] = 0;
  if (name != NULL && strlen(name) < HL_VTK_NAME_BYTES) strcpy(to, name);
}

hl_status hl_vtk_xml_grow(hl_context *context, const hl_vtk_xml *xml, void **list, size_t count, size_t *room,
                          size_t size, hl_error *error) {
  if (count < *room) return HL_OK;
  size_t wanted = 2 * count + 16;
  void *grown = hl_reallocate(context, *list, wanted, size);
  if (grown == NULL) return hl_fail_memory(error, wanted * size, xml->stream->path);
  *list = grown;
  *room = wanted;
  return HL_OK;
}

hl_status hl_vtk_xml_refuse(const hl_vtk_xml *xml, hl_status code, const char *what, const char *value,
                            hl_error *error) {
  char shown[HL_PRINTABLE_BYTES];
  return hl_fail_offset(
      error, code, (int64_t)xml->stream->offset, "%s, before byte %llu: %s \"%s\"%s", xml->stream->path,
      (unsigned long long)xml->stream->offset, what, hl_text_printable(shown, value),
      code == HL_ERROR_UNSUPPORTED ? " is not read: save it as image data (.vti), or a mesh (.vtp)"
                                   : " is impossible");
}

static hl_status fail_compressor(const hl_vtk_xml *xml, const char *compressor, hl_error *error) {
  char shown[HL_PRINTABLE_BYTES];
  return hl_fail(
      error, HL_ERROR_UNSUPPORTED,
      "%s: data compressed by \"%s\" is not read: save it with vtkZLibDataCompressor, vtkLZ4DataCompressor, "
      "vtkLZMADataCompressor, or without",
      xml->stream->path, hl_text_printable(shown, compressor));
}

hl_status hl_vtk_xml_file_tag(hl_vtk_xml *xml, const hl_xml_tag *tag, const char *wanted, hl_error *error) {
  const char *type = hl_xml_attribute(tag, "type"), *order = hl_xml_attribute(tag, "byte_order");
  const char *header_type = hl_xml_attribute(tag, "header_type"),
             *compressor = hl_xml_attribute(tag, "compressor");
  if (xml->header_bytes != 0)
    return hl_vtk_xml_refuse(xml, HL_ERROR_INPUT, "a second element", tag->name, error);
  if (type == NULL || strcmp(type, wanted) != 0)
    return hl_vtk_xml_refuse(xml, HL_ERROR_UNSUPPORTED, "a VTKFile of type", type == NULL ? "" : type, error);
  if (order != NULL && strcmp(order, "BigEndian") != 0 && strcmp(order, "LittleEndian") != 0)
    return hl_vtk_xml_refuse(xml, HL_ERROR_INPUT, "byte_order", order, error);
  xml->big_endian = order != NULL && strcmp(order, "BigEndian") == 0;
  if (header_type != NULL && strcmp(header_type, "UInt32") != 0 && strcmp(header_type, "UInt64") != 0)
    return hl_vtk_xml_refuse(xml, HL_ERROR_INPUT, "header_type", header_type, error);
  xml->header_bytes = header_type != NULL && strcmp(header_type, "UInt64") == 0 ? 8 : 4;
  static const char *const compressors[] = {[HL_VTK_PLAIN] = "",
                                            [HL_VTK_ZLIB] = "vtkZLibDataCompressor",
                                            [HL_VTK_LZ4] = "vtkLZ4DataCompressor",
                                            [HL_VTK_XZ] = "vtkLZMADataCompressor"};
  for (int n = HL_VTK_PLAIN; n <= HL_VTK_XZ; n++)
    if (strcmp(compressor != NULL ? compressor : "", compressors[n]) == 0) {
      xml->packing = (hl_vtk_packing)n;
      return HL_OK;
    }
  return fail_compressor(xml, compressor, error);
}

bool hl_vtk_xml_find_type(const char *name, hl_voxel_type *type) {
  static const hl_named_type types[] = {
      {"UInt8", HL_VOXEL_U8},   {"Int8", HL_VOXEL_I8},   {"UInt16", HL_VOXEL_U16},  {"Int16", HL_VOXEL_I16},
      {"UInt32", HL_VOXEL_U32}, {"Int32", HL_VOXEL_I32}, {"Float32", HL_VOXEL_F32}, {"Float64", HL_VOXEL_F64},
      {"UInt64", HL_VOXEL_U64}, {"Int64", HL_VOXEL_I64}};
  return hl_find_type(types, sizeof types / sizeof *types, name, type);
}

hl_status hl_vtk_xml_array_tag(const hl_vtk_xml *xml, const hl_xml_tag *tag, hl_vtk_array *array,
                               hl_error *error) {
  const char *type = hl_xml_attribute(tag, "type"), *format = hl_xml_attribute(tag, "format");
  const char *offset = hl_xml_attribute(tag, "offset");
  size_t appended = 0;
  *array = (hl_vtk_array){.place = xml->stream->offset};
  if (type == NULL || strlen(type) >= HL_VTK_NAME_BYTES)
    return hl_vtk_xml_refuse(xml, HL_ERROR_INPUT, "a DataArray's type", type == NULL ? "" : type, error);
  strcpy(array->type, type);
  array->encoding = format == NULL || strcmp(format, "ascii") == 0 ? HL_VTK_ASCII
                    : strcmp(format, "appended") == 0              ? HL_VTK_APPENDED
                                                                   : HL_VTK_BINARY;
  if (array->encoding == HL_VTK_BINARY && strcmp(format, "binary") != 0)
    return hl_vtk_xml_refuse(xml, HL_ERROR_INPUT, "a DataArray's format", format, error);
  if (array->encoding != HL_VTK_APPENDED) return HL_OK;
  if (offset == NULL || hl_text_sizes(offset, &appended, 1) != 1)
    return hl_vtk_xml_refuse(xml, HL_ERROR_INPUT, "an appended DataArray's offset",
                             offset == NULL ? "" : offset, error);
  array->place = appended;
  return HL_OK;
}

/* Finds the position of the appended data, which begin after the first '_'. */
hl_status hl_vtk_xml_appended_tag(hl_vtk_xml *xml, const hl_xml_tag *tag, hl_error *error) {
  const char *encoding = hl_xml_attribute(tag, "encoding");
  xml->appended_is_base64 = encoding == NULL || strcmp(encoding, "base64") == 0;
  if (!xml->appended_is_base64 && strcmp(encoding, "raw") != 0)
    return hl_vtk_xml_refuse(xml, HL_ERROR_INPUT, "the encoding of AppendedData", encoding, error);
  for (;;) {
    const unsigned char *bytes;
    size_t available;
    hl_status status = hl_stream_peek(xml->stream, 1, &bytes, &available, error);
    if (status != HL_OK) return status;
    if (available == 0 || (bytes[0] != '_' && !hl_is_space((char)bytes[0])))
      return hl_fail_offset(error, HL_ERROR_INPUT, (int64_t)xml->stream->offset,
                            "%s, byte %llu: appended data must begin with '_'", xml->stream->path,
                            (unsigned long long)xml->stream->offset);
    bool begins = bytes[0] == '_';
    hl_stream_take(xml->stream, 1);
    if (begins) break;
  }
  xml->appended = xml->stream->offset;
  return HL_OK;
}

hl_status hl_vtk_xml_type(const hl_vtk_xml *xml, const char *name, hl_voxel_type *type, hl_error *error) {
  if (hl_vtk_xml_find_type(name, type)) return HL_OK;
  bool known = hl_text_is_one_of(name, "String|Bit");
  return hl_vtk_xml_refuse(xml, known ? HL_ERROR_UNSUPPORTED : HL_ERROR_INPUT, "a DataArray of type", name,
                           error);
}

/* Opens the file again, and skips everything before the encoded values of an array. */
static hl_status go_to_array(hl_stream **stream, const hl_vtk_xml *xml, const hl_vtk_array *array,
                             hl_error *error) {
  uint64_t place = array->place;
  if (array->encoding == HL_VTK_APPENDED) {
    if (xml->appended == 0)
      return hl_fail(error, HL_ERROR_INPUT,
                     "%s: the file ends without the AppendedData that its DataArray refers to",
                     (*stream)->path);
    if (__builtin_add_overflow(place, xml->appended, &place))
      return hl_fail(error, HL_ERROR_INPUT, "%s: impossible offset %llu of a DataArray", (*stream)->path,
                     (unsigned long long)array->place);
  }
  hl_status status = hl_stream_restart(stream, error);
  if (status == HL_OK) status = hl_stream_unpack(stream, error);
  return status == HL_OK ? hl_stream_skip(*stream, place, error) : status;
}

/* Reads the number of bytes that stands before uncompressed values. */
static hl_status read_length(hl_stream *stream, const hl_vtk_xml *xml, uint64_t promised, hl_error *error) {
  unsigned char bytes[8];
  hl_status status = hl_stream_read_all(stream, bytes, xml->header_bytes, error);
  if (status != HL_OK) return status;
  uint64_t length = 0;
  for (size_t n = 0; n < xml->header_bytes; n++)
    length = length << 8 | bytes[xml->big_endian ? n : xml->header_bytes - 1 - n];
  if (length == promised) return HL_OK;
  return hl_fail_offset(error, HL_ERROR_INPUT, (int64_t)stream->offset,
                        "%s: the extent promises %llu bytes of voxels, the array has %llu", stream->path,
                        (unsigned long long)promised, (unsigned long long)length);
}

hl_status hl_vtk_xml_open_array(hl_stream **stream, const hl_vtk_xml *xml, const hl_vtk_array *array,
                                uint64_t promised, hl_error *error) {
  hl_status status = go_to_array(stream, xml, array, error);
  if (status != HL_OK || array->encoding == HL_VTK_ASCII) return status;
  if (array->encoding == HL_VTK_BINARY || xml->appended_is_base64)
    status = hl_stream_push_base64(stream, error);
  if (status != HL_OK) return status;
  return xml->packing != HL_VTK_PLAIN ? hl_stream_push_vtk_blocks(stream, xml->packing, xml->header_bytes,
                                                                  xml->big_endian, promised, error)
                                      : read_length(*stream, xml, promised, error);
}
