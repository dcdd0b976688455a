/* volume/formats/tiff/tiff_plan.h - finds which pages of which files make up the volume. The order follows
 * OME-XML or a description by ImageJ or tifffile; without a description, slices have the order of pages. */
#ifndef HL_VOLUME_TIFF_PLAN_H
#define HL_VOLUME_TIFF_PLAN_H

#include "volume/formats/format.h"

/* The page that holds a slice. */
typedef struct tiff_slice {
  uint32_t file; /* index of the slice's file in the plan's `files` */
  uint32_t page; /* index of the directory in its file */
  bool is_there;
} tiff_slice;

typedef struct tiff_plan {
  hl_context *context;
  tiff_slice *slices; /* owned; [slice_count]; the pages of the slices along z, at the chosen time step and
                       * channel */
  size_t slice_count;
  char **files; /* owned; [file_count]; names of the files, which lie in the folder of the first file;
                 * files[0] is null, and stands for the first file */
  size_t file_count;
  double spacing[3]; /* lengths of a voxel; 0 if not stated */
  bool is_told;      /* whether a description (OME-XML, or ImageJ's) states the order of pages; otherwise
                      * slices are in the order of pages */
} tiff_plan;

/* Makes the plan. description: the text of the first page's ImageDescription; null if the page has no text.
 * pages: number of slices in all pages of the first file. components: samples of a pixel. depth: slices of a
 * page. resolution: pixels per unit along x and y in the first page; 0 if the file does not state it. The
 * caller must release the plan also after a failure. */
hl_status tiff_plan_make(hl_load_request *request, const char *path, const char *description, size_t pages,
                         size_t components, size_t depth, const double resolution[2], tiff_plan *plan,
                         hl_error *error);

/* The number of pictures that a description by ImageJ or tifffile promises; 0 if the description promises
 * none. */
size_t tiff_plan_pages(const char *description, size_t components);

void tiff_plan_release(tiff_plan *plan);

#endif
