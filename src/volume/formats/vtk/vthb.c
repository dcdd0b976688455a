/* volume/formats/vtk/vthb.c - reads VTK's overlapping AMR (.vthb), which is an XML file that lists levels and
 * boxes of cells. The values of each box are in a .vti file of its own.
 *
 * The XML file names the .vti files relative to its own folder. A box is given by six numbers: for each of x,
 * y and z, the indices in the level of the box's first and last cell. The spacing of a level is the size of
 * the level's cells. The boxes of the first level are the domain. */
#include <math.h>
#include <string.h>

#include "core/context.h"
#include "core/memory.h"
#include "volume/formats/amr/amr.h"
#include "volume/formats/format.h"
#include "volume/formats/vtk/vtk_xml.h"
#include "volume/io/text.h"

enum { BOXES_MOST = 1 << 20 };

extern const hl_format hl_format_vti;

typedef struct amr_box {
  int level;
  ptrdiff_t first[3];
  size_t count[3];
  char *file; /* owned */
} amr_box;

typedef struct amr_list {
  hl_load_request *request;
  hl_vtk_xml xml;
  double origin[3];
  double spacing[HL_AMR_LEVELS_MOST][3]; /* for each level, the lengths of a cell's edges along x, y, z; 0 if
                                          * the .vthb file does not state them */
  int level;                             /* the level that the XML element Block names, while the tags inside
                                          * that element are read; -1 outside of such elements */
  int levels;
  amr_box *boxes; /* owned; [box_count] */
  size_t box_count, box_room;
} amr_list;

static hl_status refuse(const amr_list *list, const char *what, const char *value, hl_error *error) {
  return hl_vtk_xml_refuse(&list->xml, HL_ERROR_INPUT, what, value != NULL ? value : "", error);
}

/* ---- the list ---- */

static hl_status read_block_tag(amr_list *list, const hl_xml_tag *tag, hl_error *error) {
  const char *level = hl_xml_attribute(tag, "level"), *spacing = hl_xml_attribute(tag, "spacing");
  size_t number;
  if (level == NULL || hl_text_sizes(level, &number, 1) != 1 || number >= HL_AMR_LEVELS_MOST)
    return refuse(list, "a Block's level", level, error);
  list->level = (int)number;
  if (list->level >= list->levels) list->levels = list->level + 1;
  double *step = list->spacing[number];
  if (spacing == NULL || hl_text_numbers(spacing, step, 3) != 3 ||
      !(step[0] > 0 && step[1] > 0 && step[2] > 0))
    return refuse(list, "a Block's spacing", spacing, error);
  return HL_OK;
}

static hl_status read_box_tag(amr_list *list, const hl_xml_tag *tag, hl_error *error) {
  const char *box = hl_xml_attribute(tag, "amr_box"), *file = hl_xml_attribute(tag, "file");
  double numbers[6];
  amr_box made = {.level = list->level};
  if (list->level < 0) return refuse(list, "a DataSet outside of a Block", file, error);
  if (file == NULL) return HL_OK; /* a box without a file was written by another process */
  if (box == NULL || hl_text_numbers(box, numbers, 6) != 6)
    return refuse(list, "a DataSet's amr_box", box, error);
  for (int axis = 0; axis < 3; axis++) {
    double first = numbers[2 * axis], last = numbers[2 * axis + 1];
    if (!(fabs(first) < 1 << 30 && last >= first && last < 1 << 30) || first != floor(first) ||
        last != floor(last))
      return refuse(list, "a DataSet's amr_box", box, error);
    made.first[axis] = (ptrdiff_t)first;
    made.count[axis] = (size_t)(last - first) + 1;
  }
  if (list->box_count == BOXES_MOST)
    return hl_fail(error, HL_ERROR_UNSUPPORTED, "%s: more than %d boxes: save it with fewer",
                   list->xml.stream->path, BOXES_MOST);
  if (list->box_count == list->box_room) {
    size_t room = 2 * list->box_room + 64;
    amr_box *grown = hl_reallocate(list->request->context, list->boxes, room, sizeof *grown);
    if (grown == NULL) return hl_fail_memory(error, room * sizeof *grown, list->xml.stream->path);
    list->boxes = grown;
    list->box_room = room;
  }
  made.file = hl_copy_text(list->request->context, file);
  if (made.file == NULL) return hl_fail_memory(error, strlen(file), list->xml.stream->path);
  list->boxes[list->box_count++] = made;
  return HL_OK;
}

static hl_status read_tag(void *data, const hl_xml_tag *tag, hl_error *error) {
  amr_list *list = data;
  if (strcmp(tag->name, "Block") == 0 && !tag->is_start) list->level = -1;
  if (!tag->is_start) return HL_OK;
  if (strcmp(tag->name, "VTKFile") == 0) {
    const char *type = hl_xml_attribute(tag, "type");
    bool older = type != NULL && strcmp(type, "vtkHierarchicalBoxDataSet") == 0;
    return hl_vtk_xml_file_tag(&list->xml, tag, older ? "vtkHierarchicalBoxDataSet" : "vtkOverlappingAMR",
                               error);
  }
  const char *origin = hl_xml_attribute(tag, "origin");
  if (origin != NULL && strcmp(tag->name, "DataSet") != 0 && hl_text_numbers(origin, list->origin, 3) != 3)
    return refuse(list, "origin", origin, error);
  if (strcmp(tag->name, "Block") == 0) return read_block_tag(list, tag, error);
  return strcmp(tag->name, "DataSet") == 0 ? read_box_tag(list, tag, error) : HL_OK;
}

static hl_status read_tags(amr_list *list, hl_error *error) {
  hl_status status = hl_vtk_xml_read_tags(&list->xml, read_tag, list, error);
  if (status == HL_OK && list->box_count == 0)
    status = hl_fail(error, HL_ERROR_INPUT, "%s: lists no box with a file", list->xml.stream->path);
  return status == HL_OK ? hl_vtk_xml_check_end(&list->xml, error) : status;
}

/* ---- the shape ---- */

static hl_status find_shape(const amr_list *list, hl_amr_shape *shape, hl_error *error) {
  ptrdiff_t first[3] = {PTRDIFF_MAX, PTRDIFF_MAX, PTRDIFF_MAX},
            end[3] = {PTRDIFF_MIN, PTRDIFF_MIN, PTRDIFF_MIN};
  *shape = (hl_amr_shape){.levels = list->levels};
  for (size_t n = 0; n < list->box_count; n++)
    for (int axis = 0; axis < 3 && list->boxes[n].level == 0; axis++) {
      ptrdiff_t low = list->boxes[n].first[axis], high = low + (ptrdiff_t)list->boxes[n].count[axis];
      if (low < first[axis]) first[axis] = low;
      if (high > end[axis]) end[axis] = high;
    }
  if (end[0] <= first[0])
    return hl_fail(error, HL_ERROR_INPUT, "%s: lists no box of level 0 with a file", list->xml.stream->path);
  for (int axis = 0; axis < 3; axis++) {
    shape->first[axis] = first[axis];
    shape->count[axis] = (size_t)(end[axis] - first[axis]);
    shape->spacing[axis] = list->spacing[0][axis];
    shape->origin[axis] = list->origin[axis] + (double)first[axis] * list->spacing[0][axis];
  }
  for (int level = 0; level + 1 < list->levels; level++) {
    double ratio = list->spacing[level][0] / list->spacing[level + 1][0];
    shape->ratio[level] = ratio > 0 && ratio < 2000 ? (int)lrint(ratio) : 0;
  }
  return HL_OK;
}

/* ---- boxes ---- */

/* Adds the voxels of `piece`, which are a box's cells, to the adaptive grid. */
static hl_status add_voxels(amr_list *list, hl_amr *amr, const amr_box *box, const hl_volume *piece,
                            hl_error *error) {
  const size_t *n = box->count;
  for (int axis = 0; axis < 3; axis++)
    if (piece->dimension[axis] != n[axis])
      return hl_fail(error, HL_ERROR_INPUT,
                     "%s: the file \"%.100s\" has %zu x %zu x %zu values for %zu x %zu x %zu cells",
                     amr->subject, box->file, piece->dimension[0], piece->dimension[1], piece->dimension[2],
                     n[0], n[1], n[2]);
  hl_context *context = list->request->context;
  float *values = hl_allocate(context, n[0] * n[1] * n[2], sizeof *values), *at = values;
  void *buffer = hl_allocate(context, hl_volume_row_room(piece), 1);
  hl_status status = values != NULL && buffer != NULL
                         ? HL_OK
                         : hl_fail_memory(error, n[0] * n[1] * n[2] * sizeof *values, amr->subject);
  for (size_t k = 0; status == HL_OK && k < n[2]; k++)
    for (size_t j = 0; j < n[1]; j++) {
      hl_number_row row = hl_volume_numbers(piece, j, k, buffer);
      for (size_t i = 0; i < n[0]; i++)
        *at++ = (float)(piece->value_scale * hl_row_number(row, i) + piece->value_offset);
    }
  if (status == HL_OK) status = hl_amr_add(amr, box->level, box->first, n, values, error);
  hl_release(context, buffer);
  hl_release(context, values);
  return status;
}

/* Reads the file of a box. The array and the component that were chosen in the first file are read from all
 * files. */
static hl_status read_box(amr_list *list, hl_amr *amr, size_t index, hl_error *error) {
  hl_load_request *request = list->request;
  hl_load_request part = {.context = request->context,
                          .component = request->component,
                          .time = -1,
                          .channel = -1,
                          .level = -1,
                          .selection = {1, 1, 1, 0, 0, 0, 0}};
  hl_stream *stream = NULL;
  hl_volume *piece = NULL;
  part.array = index == 0 ? request->array : request->arrays[request->chosen].name;
  hl_status status = hl_stream_open_memory(request->context, amr->subject, "", 0, &stream, error);
  if (status == HL_OK) status = hl_stream_switch(&stream, list->boxes[index].file, error);
  if (status == HL_OK) status = hl_stream_unpack(&stream, error);
  if (status == HL_OK) status = hl_format_vti.load(&stream, &part, &piece, error);
  hl_stream_close(stream);
  if (index == 0) {
    request->arrays = part.arrays;
    request->array_count = part.array_count;
    request->chosen = part.chosen;
    request->chosen_component = part.chosen_component;
    memcpy(request->array_told, part.array_told, sizeof request->array_told);
    memcpy(request->component_told, part.component_told, sizeof request->component_told);
  } else {
    hl_arrays_release(request->context, part.arrays, part.array_count);
  }
  if (status == HL_OK) status = add_voxels(list, amr, &list->boxes[index], piece, error);
  hl_volume_release(piece);
  return status;
}

static hl_status load(hl_stream **stream, hl_load_request *request, hl_volume **volume, hl_error *error) {
  amr_list list = {.request = request, .xml.stream = *stream, .level = -1};
  hl_amr_shape shape;
  hl_amr amr = {.context = request->context};
  hl_status status = read_tags(&list, error);
  if (status == HL_OK) status = find_shape(&list, &shape, error);
  if (status == HL_OK) status = hl_amr_begin(request->context, &shape, (*stream)->path, &amr, error);
  if (status == HL_OK) hl_amr_set_spacing(&amr, request->spacing);
  for (size_t n = 0; n < list.box_count && status == HL_OK; n++) {
    status = read_box(&list, &amr, n, error);
    hl_progress(request->context, "load", (double)(n + 1) / (double)list.box_count);
    if (status == HL_OK && hl_cancelled(request->context))
      status = hl_fail(error, HL_ERROR_CANCELLED, "%s: cancelled", (*stream)->path);
  }
  if (status == HL_OK) status = hl_amr_finish(&amr, volume, error);
  hl_amr_close(&amr);
  for (size_t n = 0; n < list.box_count; n++) hl_release(request->context, list.boxes[n].file);
  hl_release(request->context, list.boxes);
  return status;
}

static bool has_content(const unsigned char *bytes, size_t length) {
  static const char *const types[] = {"vtkOverlappingAMR", "vtkHierarchicalBoxDataSet"};
  return hl_vtk_xml_is_of(bytes, length, types, 2);
}

const hl_format hl_format_vthb = {
    .name = "VTK .vthb",
    .endings = {".vthb", ".vth"},
    .beginning = "\"<VTKFile\" of type \"vtkOverlappingAMR\"",
    .has_content = has_content,
    .load = load,
};
