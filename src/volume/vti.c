/* volume/vti.c - VTK XML image data (.vti): ascii, base64 and appended arrays, plain or in zlib blocks.
 *
 * A first pass over the tags lists the arrays. The volume is the array that the caller named; without a name
 * the active scalars, else the first array of one component at points, else at cells. A second pass goes to
 * the values. World: Origin + Direction * (Spacing * index), where indices count from the extent's start. */
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "volume/format.h"
#include "volume/text.h"
#include "volume/vtk_xml.h"

typedef enum section { SECTION_NONE, SECTION_POINTS, SECTION_CELLS } section;
typedef struct vti_header {
  hl_vtk_xml xml;
  double extent[6]; /* first and last point index along x, y, z */
  double origin[3], spacing[3], direction[9];
  bool has_extent, has_piece;
  bool is_whole; /* the section's last tag or the appended data has been seen */
  section section;
  char active[HL_VTK_NAME_BYTES];  /* name of the section's active scalars */
  hl_vtk_array *arrays;            /* owned; [HL_ARRAYS_MOST]; null before the first */
  int active_points, active_cells; /* index of the active scalars; -1: none */
  hl_load_request *request;        /* lists the same arrays */
} vti_header;

static hl_status read_numbers(const vti_header *header, const hl_xml_tag *tag, const char *name,
                              double *numbers, int count, hl_error *error) {
  const char *value = hl_xml_attribute(tag, name);
  if (value == NULL || hl_text_numbers(value, numbers, count) == count) return HL_OK;
  return hl_vtk_xml_refuse(&header->xml, HL_ERROR_INPUT, name, value, error);
}

static hl_status read_extent(vti_header *header, const hl_xml_tag *tag, const char *name, hl_error *error) {
  const char *value = hl_xml_attribute(tag, name);
  if (value == NULL) return HL_OK;
  hl_status status = read_numbers(header, tag, name, header->extent, 6, error);
  for (int axis = 0; status == HL_OK && axis < 3; axis++) {
    double first = header->extent[2 * axis], last = header->extent[2 * axis + 1];
    if (first != floor(first) || last != floor(last) || !(first >= -2147483648.0) ||
        !(last <= 2147483647.0) || last < first)
      status = hl_vtk_xml_refuse(&header->xml, HL_ERROR_INPUT, name, value, error);
  }
  header->has_extent = true;
  return status;
}

static hl_status read_image_tag(vti_header *header, const hl_xml_tag *tag, hl_error *error) {
  hl_status status = read_extent(header, tag, "WholeExtent", error);
  if (status == HL_OK) status = read_numbers(header, tag, "Origin", header->origin, 3, error);
  if (status == HL_OK) status = read_numbers(header, tag, "Spacing", header->spacing, 3, error);
  if (status == HL_OK) status = read_numbers(header, tag, "Direction", header->direction, 9, error);
  return status;
}

static hl_status read_piece_tag(vti_header *header, const hl_xml_tag *tag, hl_error *error) {
  if (header->has_piece)
    return hl_fail(error, HL_ERROR_UNSUPPORTED, "%s: images in several pieces are not read: save it as one",
                   header->xml.stream->path);
  header->has_piece = true;
  return read_extent(header, tag, "Extent", error);
}

static void begin_section(vti_header *header, const hl_xml_tag *tag, section which) {
  const char *active = hl_xml_attribute(tag, "Scalars");
  header->section = tag->is_end ? SECTION_NONE : which;
  header->active[0] = 0;
  if (active != NULL && strlen(active) < HL_VTK_NAME_BYTES) strcpy(header->active, active);
}

static hl_status read_array_tag(vti_header *header, const hl_xml_tag *tag, hl_error *error) {
  if (header->section == SECTION_NONE) return HL_OK;
  const char *name = hl_xml_attribute(tag, "Name"), *stated = hl_xml_attribute(tag, "NumberOfComponents");
  hl_vtk_array array;
  size_t components = 1, index = header->request->array_count;
  hl_voxel_type type = 0;
  bool cells = header->section == SECTION_CELLS;
  hl_status status = hl_vtk_xml_array_tag(&header->xml, tag, &array, error);
  if (status != HL_OK) return status;
  if (stated != NULL && (hl_text_sizes(stated, &components, 1) != 1 || components == 0))
    return hl_vtk_xml_refuse(&header->xml, HL_ERROR_INPUT, "NumberOfComponents", stated, error);
  hl_vtk_xml_find_type(array.type, &type);
  status = hl_arrays_add(header->request, name != NULL ? name : "", components, type, cells, error);
  if (status != HL_OK || header->request->array_count == index) return status;
  if (header->arrays == NULL) {
    header->arrays = hl_allocate(header->request->context, HL_ARRAYS_MOST, sizeof *header->arrays);
    if (header->arrays == NULL)
      return hl_fail_memory(error, HL_ARRAYS_MOST * sizeof array, header->xml.stream->path);
  }
  header->arrays[index] = array;
  int *active = cells ? &header->active_cells : &header->active_points;
  if (header->active[0] != 0 && name != NULL && strcmp(name, header->active) == 0 && *active < 0)
    *active = (int)index;
  return HL_OK;
}

static hl_status read_tag(vti_header *header, const hl_xml_tag *tag, hl_error *error) {
  if (!tag->is_start) {
    if (strcmp(tag->name, "PointData") == 0 || strcmp(tag->name, "CellData") == 0)
      header->section = SECTION_NONE;
    if (strcmp(tag->name, "VTKFile") == 0) header->is_whole = true;
    return HL_OK;
  }
  if (header->xml.header_bytes == 0 && strcmp(tag->name, "VTKFile") != 0)
    return hl_vtk_xml_refuse(&header->xml, HL_ERROR_UNSUPPORTED, "an XML file whose first element is",
                             tag->name, error);
  if (strcmp(tag->name, "VTKFile") == 0) return hl_vtk_xml_file_tag(&header->xml, tag, "ImageData", error);
  if (strcmp(tag->name, "ImageData") == 0) return read_image_tag(header, tag, error);
  if (strcmp(tag->name, "Piece") == 0) return read_piece_tag(header, tag, error);
  if (strcmp(tag->name, "DataArray") == 0) return read_array_tag(header, tag, error);
  if (strcmp(tag->name, "AppendedData") == 0) return hl_vtk_xml_appended_tag(&header->xml, tag, error);
  if (strcmp(tag->name, "PointData") == 0) begin_section(header, tag, SECTION_POINTS);
  if (strcmp(tag->name, "CellData") == 0) begin_section(header, tag, SECTION_CELLS);
  return HL_OK;
}

static hl_status read_tags(vti_header *header, hl_error *error) {
  hl_xml_tag tag;
  bool ended = false;
  while (!ended && header->xml.appended == 0) {
    hl_status status = hl_xml_next_tag(header->xml.stream, &tag, &ended, error);
    if (status == HL_OK && !ended) status = read_tag(header, &tag, error);
    if (status != HL_OK) return status;
  }
  return HL_OK;
}

static void make_grid(const vti_header *header, bool cells, hl_volume_description *grid) {
  for (int axis = 0; axis < 3; axis++) {
    size_t points = (size_t)(header->extent[2 * axis + 1] - header->extent[2 * axis]) + 1;
    grid->dimensions[axis] = cells && points > 1 ? points - 1 : points;
    grid->origin[axis] = header->origin[axis];
    for (int row = 0; row < 3; row++)
      grid->axis[axis][row] = header->direction[3 * row + axis] * header->spacing[axis];
  }
  for (int axis = 0; axis < 3; axis++) {
    bool between = cells && header->extent[2 * axis + 1] > header->extent[2 * axis];
    double first = header->extent[2 * axis] + (between ? 0.5 : 0); /* cells are centred between points */
    for (int row = 0; row < 3; row++) grid->origin[row] += first * grid->axis[axis][row];
  }
}

/* The index of the active scalars at points; if no array at points has one component, of the active scalars
 * at cells. */
static int active_array(const vti_header *header) {
  if (header->active_points >= 0) return header->active_points;
  for (size_t n = 0; n < header->request->array_count; n++)
    if (!header->request->arrays[n].of_cells && header->request->arrays[n].components == 1) return -1;
  return header->active_cells;
}

static hl_status choose_array(const vti_header *header, hl_error *error) {
  if (header->request->array_count > 0 && header->has_extent) {
    hl_status status = hl_arrays_choose(header->request, header->xml.stream->path, active_array(header),
                                        error);
    const hl_array_entry *chosen = &header->request->arrays[header->request->chosen];
    bool is_last_resort = header->request->array == NULL && (chosen->of_cells || chosen->components > 1);
    if (status == HL_OK && is_last_resort && !header->is_whole && header->xml.appended == 0)
      return hl_fail(error, HL_ERROR_INPUT, "%s: the file is cut short: it ends before </VTKFile>",
                     header->xml.stream->path);
    return status;
  }
  return hl_fail(error, HL_ERROR_INPUT, "%s: the file has no %s", header->xml.stream->path,
                 header->has_extent ? "DataArray in PointData or CellData" : "WholeExtent or Extent");
}

/* Goes to the chosen array and reads it as the volume. */
static hl_status read_array(hl_stream **stream, const vti_header *header, hl_volume **volume,
                            hl_error *error) {
  hl_load_request *request = header->request;
  const hl_vtk_array *array = &header->arrays[request->chosen];
  const hl_array_entry *entry = &request->arrays[request->chosen];
  hl_payload payload;
  hl_payload_defaults(&payload);
  payload.trailing = HL_TRAILING_IGNORED;
  hl_status status = hl_vtk_xml_type(&header->xml, array->type, &payload.grid.type, error);
  if (status != HL_OK) return status;
  make_grid(header, entry->of_cells, &payload.grid);
  payload.big_endian = header->xml.big_endian;
  payload.text = array->encoding == HL_VTK_ASCII;
  payload.components = entry->components;
  payload.block = 1;
  if (payload.grid.type == HL_VOXEL_U8) payload.colors = HL_COLORS_MEANT; /* as VTK's mappers take bytes */
  status = hl_volume_check_grid(&payload.grid, (*stream)->path, error);
  if (status == HL_OK) status = hl_component_choose(request, (*stream)->path, false, &payload, error);
  if (status == HL_OK)
    status = hl_vtk_xml_open_array(stream, &header->xml, array, hl_payload_bytes(&payload), error);
  return status == HL_OK ? hl_payload_read(*stream, &payload, request->spacing, volume, error) : status;
}

static hl_status load(hl_stream **stream, hl_load_request *request, hl_volume **volume, hl_error *error) {
  vti_header header = {.xml.stream = *stream,
                       .spacing = {1, 1, 1},
                       .direction = {1, 0, 0, 0, 1, 0, 0, 0, 1},
                       .active_points = -1,
                       .active_cells = -1,
                       .request = request};
  hl_status status = read_tags(&header, error);
  if (status == HL_OK) status = choose_array(&header, error);
  if (status == HL_OK) status = read_array(stream, &header, volume, error);
  hl_release(request->context, header.arrays);
  return status;
}

const hl_format hl_format_vti = {
    .name = "VTK .vti",
    .endings = {".vti"},
    .beginning = "\"<VTKFile\"",
    .has_content = hl_vtk_xml_has_content,
    .load = load,
};
