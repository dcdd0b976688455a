/* volume/tiff_plan.h - which pages of which files make up the volume, by OME-XML, by ImageJ's description, or
 * one page after the other. */
#ifndef HL_VOLUME_TIFF_PLAN_H
#define HL_VOLUME_TIFF_PLAN_H

#include "volume/format.h"

/* A slice's page. */
typedef struct tiff_slice {
  uint32_t file; /* index into the plan's files */
  uint32_t page; /* index of the directory in its file */
  bool is_there;
} tiff_slice;

typedef struct tiff_plan {
  hl_context *context;
  tiff_slice *slices; /* owned; [slice_count]; the chosen time step and channel, along z */
  size_t slice_count;
  char *
      *files; /* owned; [file_count]; names of files beside the first one; files[0] is null: the first file */
  size_t file_count;
  double spacing[3]; /* 0: not told */
  bool is_told;      /* OME-XML or ImageJ's description states the order; else it is that of the pages */
} tiff_plan;

/* description: of the first page, or null. pages: of the first file, of all slices of its pages; components:
 * samples of a pixel; depth: slices of a page. resolution: pixels per unit along x and y of the first page;
 * 0: none. Release the plan in any case. */
hl_status tiff_plan_make(hl_load_request *request, const char *path, const char *description, size_t pages,
                         size_t components, size_t depth, const double resolution[2], tiff_plan *plan,
                         hl_error *error);

/* How many pictures ImageJ's or tifffile's description promises; 0: none is told. */
size_t tiff_plan_pages(const char *description, size_t components);

void tiff_plan_release(tiff_plan *plan);

#endif
